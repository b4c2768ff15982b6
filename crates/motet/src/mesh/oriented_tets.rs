//! Judges the tets of a mesh: which are inverted, which are bad, and which are thin on purpose. Every command
//! that reports such a count takes it from here.
//!
//! - *Oriented*: two tets that share a facet see it from opposite sides, and each part of tets connected
//!   through facets has a positive total volume. However a file numbers its vertices, exactly those tets are
//!   found that a motion has turned inside out.
//! - *Inverted*: the volume of the oriented tet is not positive, by exact signs; flat tets count as well.
//! - *Bad*: the EAS is below a limit, and the tet is not a *layer* tet, which is thin on purpose (see
//!   [`layers`](super::layers)).

use crate::base::{CellId, Point, TetId, Threads, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::vector::in_range;
use crate::mesh::connectivity::AroundChange;
use crate::mesh::layers::are_layers;
use crate::mesh::orientation::{self, facet, orient, see_from_opposite_sides};
use crate::mesh::tet_facets::{Sharing, for_each_tet_facet, tet_facets_in_parts};
use crate::mesh::{CellKind, Cells, Field, HalfFacet, Labels, Mesh, TetMesh};

/// Facets are numbered only below this number of tets and triangles; more tets keep the orientation of the
/// file.
const MAX_TETS_AND_TRIANGLES: usize = 1 << 29;

/// Tets per chunk.
const CHUNK: usize = 1 << 14;

/// The tets of a mesh, oriented by their neighbours, and the facets that bound them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct OrientedTets {
    /// The vertices of each tet; of a quadratic one, the corners.
    pub tets: Vec<[VertexId; 4]>,
    /// The cell of each tet.
    pub cells: Vec<CellId>,
    /// Indices of the tets that the file numbers the other way around, in rising order.
    pub turned: Vec<usize>,
    /// Facets on the boundary, between two regions, or with a triangle, in rising order; of two tets that
    /// share one, the first.
    walls: Vec<HalfFacet>,
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
    pub fn of(mesh: &Mesh, threads: &Threads) -> Self {
        Self::of_kinds(mesh, &[CellKind::TETRA, CellKind::QUADRATIC_TETRA], threads)
    }

    /// The linear tets of a mesh.
    pub fn of_linear(mesh: &Mesh, threads: &Threads) -> Self {
        Self::of_kinds(mesh, &[CellKind::TETRA], threads)
    }

    fn of_kinds(mesh: &Mesh, kinds: &[CellKind], threads: &Threads) -> Self {
        let (mut oriented, triangles) = Self::as_numbered(&mesh.cells, kinds);
        let regions = oriented.regions(mesh.regions().as_ref());
        oriented.orient(&mesh.points, &regions, &triangles, threads);
        oriented
    }

    /// The tets of some kinds as the file numbers them, and the triangles beside them.
    fn as_numbered(cells: &Cells, kinds: &[CellKind]) -> (Self, Vec<[VertexId; 3]>) {
        let (mut numbered, mut triangles) = (Self::default(), Vec::new());
        for (cell, kind, vertices) in cells.iter() {
            match (kind, vertices) {
                (_, &[a, b, c, d, ..]) if kinds.contains(&kind) => {
                    numbered.tets.push([a, b, c, d]);
                    numbered.cells.push(cell);
                }
                (CellKind::TRIANGLE | CellKind::QUADRATIC_TRIANGLE, &[a, b, c, ..]) => {
                    triangles.push([a, b, c]);
                }
                _ => {}
            }
        }
        (numbered, triangles)
    }

    /// The region of each tet; 0 without labels.
    fn regions(&self, labels: Option<&Labels>) -> Vec<i32> {
        self.cells.iter().map(|cell| labels.map_or(0, |labels| labels.ids[cell.index()])).collect()
    }

    /// The linear tets of a mesh that these were the tets of, before some cells were replaced: what
    /// [`Self::of_linear`] returns for it, found from the changed cells and those around them. `labels` are
    /// the regions of the mesh, from the same array as before.
    ///
    /// `None` if more has to be looked at: where the numbering of the file is not that of positive tets.
    pub(crate) fn after(
        &self,
        mesh: &Mesh,
        around: &AroundChange,
        labels: Option<&Labels>,
        threads: &Threads,
    ) -> Option<Self> {
        let (mut new, mut triangles) = Self::as_numbered(&mesh.cells, &[CellKind::TETRA]);
        if is_too_large(new.tets.len(), triangles.len()) || !self.turned.is_empty() {
            return None;
        }
        let is_marked = |v: &VertexId| around.is_marked[v.index()];
        triangles.retain(|triangle| triangle.iter().all(is_marked));
        let near: Vec<usize> = around.near.iter().filter_map(|cell| new.place(*cell)).collect();
        let pick = |t: &usize| (new.tets[*t], new.cells[*t]);
        let (tets, cells) = near.iter().map(pick).unzip::<_, _, Vec<_>, Vec<_>>();
        let regions = Self { cells, ..Self::default() }.regions(labels);
        let shared = Shared::of(&tets, &regions, &triangles, |facet| facet.iter().all(is_marked), threads);
        if shared.is_one_sided || !new.is_positive(&mesh.points, threads) {
            return None;
        }
        let found = shared
            .walls
            .iter()
            .map(|wall| HalfFacet::new(TetId::new(near[wall.tet().index()]), wall.facet()));
        let kept = self.walls.iter().filter_map(|wall| {
            let cell = around.old_to_new[self.cells[wall.tet().index()].index()].get()?;
            let tet = new.place(cell)?;
            let is_far = !facet(&new.tets[tet], wall.facet()).iter().all(is_marked);
            is_far.then(|| HalfFacet::new(TetId::new(tet), wall.facet()))
        });
        let mut walls: Vec<HalfFacet> = kept.chain(found).collect();
        walls.sort_unstable();
        new.walls = walls;
        Some(new)
    }

    /// Whether all tets are positive, as they are numbered.
    pub(crate) fn is_positive(&self, points: &[Point], threads: &Threads) -> bool {
        let starts = (0..self.tets.len()).step_by(CHUNK).collect();
        let is_negative =
            |start: usize| (start..(start + CHUNK).min(self.tets.len())).any(|t| self.is_negative(t, points));
        !threads.any(starts, is_negative)
    }

    /// The index of the tet that a cell is.
    fn place(&self, cell: CellId) -> Option<usize> {
        // Most often, all cells before it are tets.
        match self.cells.get(cell.index()) {
            Some(&at) if at == cell => Some(cell.index()),
            _ => self.cells.binary_search(&cell).ok(),
        }
    }

    /// The tets of plain arrays; the cell of a tet is its index.
    pub fn of_tets(mesh: &TetMesh, threads: &Threads) -> Self {
        let cells = (0..mesh.tets.len()).map(CellId::new).collect();
        let mut oriented = Self { tets: mesh.tets.clone(), cells, ..Self::default() };
        oriented.orient(&mesh.points, &mesh.regions, &mesh.triangles, threads);
        oriented
    }

    /// Tets that are already oriented, each with its index as its cell, and their walls: see
    /// [`Sharing::is_wall`].
    pub(crate) fn given(tets: Vec<[VertexId; 4]>, mut walls: Vec<HalfFacet>) -> Self {
        let cells = (0..tets.len()).map(CellId::new).collect();
        walls.sort_unstable();
        Self { tets, cells, turned: Vec::new(), walls }
    }

    /// The facets on the boundary, between two regions, or with a triangle, in the order of the tets.
    pub(crate) fn walls(&self) -> impl ExactSizeIterator<Item = [VertexId; 3]> + '_ {
        self.walls.iter().map(|wall| facet(&self.tets[wall.tet().index()], wall.facet()))
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
        let walls: Vec<_> = if low.is_empty() { Vec::new() } else { self.walls().collect() };
        let is_thin = are_layers(points, &self.tets, &walls, &low, min_eas);
        let [bad, layers] = [false, true].map(|thin| {
            low.iter().zip(&is_thin).filter(|(_, is)| **is == thin).map(|(&tet, _)| tet).collect()
        });
        Judged { bad, layers }
    }

    fn orient(&mut self, points: &[Point], regions: &[i32], triangles: &[[VertexId; 3]], threads: &Threads) {
        if is_too_large(self.tets.len(), triangles.len()) {
            return;
        }
        let Shared { walls, is_one_sided } = Shared::of(&self.tets, regions, triangles, |_| true, threads);
        self.walls = walls;
        if is_one_sided || !self.is_positive(points, threads) {
            let across = across(&self.tets);
            let behind = |t: usize, i: usize| {
                let half = across[t][i];
                (!half.is_none()).then(|| (half.tet().index(), half.facet()))
            };
            // A mesh that cannot be oriented keeps the numbering of the file.
            let is_reversed = orient(&mut self.tets, behind, points).unwrap_or_default();
            self.turned = (0..is_reversed.len()).filter(|&t| is_reversed[t]).collect();
            for wall in self.walls.iter_mut() {
                if is_reversed.get(wall.tet().index()) == Some(&true) {
                    *wall = HalfFacet::new(wall.tet(), orientation::facet_after_turning(wall.facet()));
                }
            }
        }
        self.walls.sort_unstable();
    }

    /// Whether a tet, as it is numbered, is flat or inverted.
    fn is_negative(&self, tet: usize, points: &[Point]) -> bool {
        self.corners(tet, points).into_iter().all(in_range) && self.is_inverted(tet, points)
    }
}

/// What the tets that share facets say of these.
#[derive(Default)]
struct Shared {
    /// Walls, in no order.
    walls: Vec<HalfFacet>,
    /// Whether two tets see the facet between them from the same side.
    is_one_sided: bool,
}

impl Shared {
    /// Of all facets of `tets` for which `counts` is true.
    fn of(
        tets: &[[VertexId; 4]],
        regions: &[i32],
        triangles: &[[VertexId; 3]],
        counts: impl Fn([VertexId; 3]) -> bool + Sync,
        threads: &Threads,
    ) -> Self {
        let see = |shared: &mut Self, sharing: Sharing| {
            let Some(&(t, i)) = sharing.tets.first() else { return };
            if !counts(facet(&tets[t.index()], i)) {
                return;
            }
            if let [(t, i), (u, j)] = *sharing.tets {
                let [x, y] = [(t, i), (u, j)].map(|(t, i)| facet(&tets[t.index()], i));
                shared.is_one_sided |= !see_from_opposite_sides(x, y);
            }
            if sharing.is_wall(regions) {
                shared.walls.push(HalfFacet::new(t, i));
            }
        };
        let parts = tet_facets_in_parts(tets, triangles, threads, see);
        let one_sided = parts.iter().any(|part| part.is_one_sided);
        Self { walls: parts.into_iter().flat_map(|part| part.walls).collect(), is_one_sided: one_sided }
    }
}

/// Whether there are too many tets and triangles to number their facets.
fn is_too_large(n_tets: usize, n_triangles: usize) -> bool {
    n_tets + n_triangles >= MAX_TETS_AND_TRIANGLES
}

/// Whether an oriented tet is flat or inverted, by exact signs.
pub fn is_inverted([a, b, c, d]: [Point; 4]) -> bool {
    orient3d(a, b, c, d) <= 0
}

/// For each facet of each tet, the same facet of the neighbour; none on the boundary, and where more than two
/// tets share the facet.
fn across(tets: &[[VertexId; 4]]) -> Vec<[HalfFacet; 4]> {
    let mut across = vec![[HalfFacet::NONE; 4]; tets.len()];
    for_each_tet_facet(tets, &[], |sharing| {
        if let &[(t, i), (u, j)] = sharing.tets {
            across[t.index()][i] = HalfFacet::new(u, j);
            across[u.index()][j] = HalfFacet::new(t, i);
        }
    });
    across
}
