//! Judges the tets of a mesh: which are inverted, which are bad, and which are thin on purpose. Every command
//! that reports such a count takes it from here.
//!
//! - *Oriented*: two tets that share a facet see it from opposite sides, and each part of tets connected
//!   through facets has a positive total volume. However a file numbers its vertices, exactly those tets are
//!   found that a motion has turned inside out.
//! - *Inverted*: the volume of the oriented tet is not positive, by exact signs; flat tets count as well.
//! - *Bad*: the EAS is below a limit, and the tet is not a *layer* tet, which is thin on purpose (see
//!   [`layers`](super::layers)).

use crate::base::{CellId, MaybeId, Point, VertexId, id};
use crate::geometry::predicates::orient3d;
use crate::geometry::tet::FACETS;
use crate::geometry::vector::in_range;
use crate::mesh::layers::are_layers;
use crate::mesh::orientation::{facet, orient, see_from_opposite_sides};
use crate::mesh::tet_facets::{Sharing, for_each_tet_facet};
use crate::mesh::{CellKind, Field, Mesh, TetMesh};

/// Facets are numbered only below this number of tets and triangles; more tets keep the orientation of the
/// file.
const MAX_TETS_AND_TRIANGLES: usize = 1 << 29;

/// The tets of a mesh, oriented by their neighbours, and the facets that bound them.
#[derive(Clone, Debug, Default)]
pub struct OrientedTets {
    /// The vertices of each tet; of a quadratic one, the corners.
    pub tets: Vec<[VertexId; 4]>,
    /// The cell of each tet.
    pub cells: Vec<CellId>,
    /// Indices of the tets that the file numbers the other way around, in rising order.
    pub turned: Vec<usize>,
    /// Facets on the boundary, between two regions, or with a triangle.
    walls: Vec<[VertexId; 3]>,
}

/// The tets below a limit of EAS, as indices into [`OrientedTets::tets`], in rising order.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Judged {
    /// The bad tets.
    pub bad: Vec<usize>,
    /// The tets of boundary layers, which do not count as bad.
    pub layers: Vec<usize>,
}

impl OrientedTets {
    /// The linear and quadratic tets of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        Self::of_kinds(mesh, &[CellKind::TETRA, CellKind::QUADRATIC_TETRA])
    }

    /// The linear tets of a mesh.
    pub fn of_linear(mesh: &Mesh) -> Self {
        Self::of_kinds(mesh, &[CellKind::TETRA])
    }

    fn of_kinds(mesh: &Mesh, kinds: &[CellKind]) -> Self {
        let labels = mesh.regions();
        let region = |cell: CellId| labels.as_ref().map_or(0, |labels| labels.ids[cell.index()]);
        let (mut oriented, mut regions, mut triangles) = (Self::default(), Vec::new(), Vec::new());
        for (cell, kind, vertices) in mesh.cells.iter() {
            match (kind, vertices) {
                (_, &[a, b, c, d, ..]) if kinds.contains(&kind) => {
                    oriented.tets.push([a, b, c, d]);
                    oriented.cells.push(cell);
                    regions.push(region(cell));
                }
                (CellKind::TRIANGLE | CellKind::QUADRATIC_TRIANGLE, &[a, b, c, ..]) => {
                    triangles.push([a, b, c]);
                }
                _ => {}
            }
        }
        oriented.orient(&mesh.points, &regions, &triangles);
        oriented
    }

    /// The tets of plain arrays; the cell of a tet is its index.
    pub fn of_tets(mesh: &TetMesh) -> Self {
        let cells = (0..mesh.tets.len()).map(CellId::new).collect();
        let mut oriented = Self { tets: mesh.tets.clone(), cells, ..Self::default() };
        oriented.orient(&mesh.points, &mesh.regions, &mesh.triangles);
        oriented
    }

    /// Tets that are already oriented, each with its index as its cell, and their walls: see
    /// [`Sharing::is_wall`].
    pub(crate) fn given(tets: Vec<[VertexId; 4]>, walls: Vec<[VertexId; 3]>) -> Self {
        let cells = (0..tets.len()).map(CellId::new).collect();
        Self { tets, cells, turned: Vec::new(), walls }
    }

    /// The facets on the boundary, between two regions, or with a triangle.
    pub(crate) fn walls(&self) -> &[[VertexId; 3]] {
        &self.walls
    }

    /// The corner points of a tet, with the vertices of the mesh at `points`.
    #[inline]
    pub fn corners(&self, tet: usize, points: &[Point]) -> [Point; 4] {
        self.tets[tet].map(|v| points[v.index()])
    }

    /// Whether a tet is flat or inverted, by exact signs.
    pub fn is_inverted(&self, tet: usize, points: &[Point]) -> bool {
        is_inverted(self.corners(tet, points))
    }

    /// A cell array `name` for the mesh, with `measure` of each tet, and NaN for other cells.
    pub fn field(&self, mesh: &Mesh, name: &str, measure: impl Fn([Point; 4]) -> f64) -> Field {
        let mut values = vec![f64::NAN; mesh.cells.len()];
        for (i, cell) in self.cells.iter().enumerate() {
            values[cell.index()] = measure(self.corners(i, &mesh.points));
        }
        Field::scalars(name, values)
    }

    /// For each of `n_cells` cells, whether it is a tet that the file numbers the other way around.
    pub(crate) fn are_reversed(&self, n_cells: usize) -> Vec<bool> {
        let mut are_reversed = vec![false; n_cells];
        self.turned.iter().for_each(|&tet| are_reversed[self.cells[tet].index()] = true);
        are_reversed
    }

    /// Divides `low`, the tets whose EAS is below `min_eas`, into bad tets and tets of boundary layers.
    pub fn judge(&self, points: &[Point], low: Vec<usize>, min_eas: f64) -> Judged {
        let is_thin = are_layers(points, &self.tets, &self.walls, &low, min_eas);
        let [bad, layers] = [false, true].map(|thin| {
            low.iter().zip(&is_thin).filter(|(_, is)| **is == thin).map(|(&tet, _)| tet).collect()
        });
        Judged { bad, layers }
    }

    fn orient(&mut self, points: &[Point], regions: &[i32], triangles: &[[VertexId; 3]]) {
        if self.tets.len() + triangles.len() >= MAX_TETS_AND_TRIANGLES {
            return;
        }
        let (tets, walls) = (&self.tets, &mut self.walls);
        let mut is_one_sided = false;
        for_each_tet_facet(tets, triangles, |sharing: Sharing| {
            if let [(t, i), (u, j)] = *sharing.tets {
                let [x, y] = [(t, i), (u, j)].map(|(t, i)| facet(&tets[t.index()], i));
                is_one_sided |= !see_from_opposite_sides(x, y);
            }
            if sharing.is_wall(regions) {
                let (t, i) = sharing.tets[0];
                walls.push(FACETS[i].map(|corner| tets[t.index()][corner]));
            }
        });
        let is_negative =
            |t: usize| self.corners(t, points).into_iter().all(in_range) && self.is_inverted(t, points);
        if is_one_sided || (0..self.tets.len()).any(is_negative) {
            let across = across(&self.tets);
            let behind = |t: usize, i: usize| {
                let half = across[t][i].get()?.0;
                Some(((half >> 2) as usize, (half & 3) as usize))
            };
            // A mesh that cannot be oriented keeps the numbering of the file.
            let is_reversed = orient(&mut self.tets, behind, points).unwrap_or_default();
            self.turned = (0..is_reversed.len()).filter(|&t| is_reversed[t]).collect();
        }
    }
}

/// Whether an oriented tet is flat or inverted, by exact signs.
pub fn is_inverted([a, b, c, d]: [Point; 4]) -> bool {
    orient3d(a, b, c, d) <= 0
}

id!(
    /// A facet of a tet: four times the tet, plus the index of the facet there.
    TetFacetId
);

/// For each facet of each tet, the same facet of the neighbour; none on the boundary, and where more than two
/// tets share the facet.
fn across(tets: &[[VertexId; 4]]) -> Vec<[MaybeId<TetFacetId>; 4]> {
    let mut across = vec![[MaybeId::NONE; 4]; tets.len()];
    for_each_tet_facet(tets, &[], |sharing| {
        if let &[(t, i), (u, j)] = sharing.tets {
            across[t.index()][i] = TetFacetId(u.0 << 2 | j as u32).into();
            across[u.index()][j] = TetFacetId(t.0 << 2 | i as u32).into();
        }
    });
    across
}
