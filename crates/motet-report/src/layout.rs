//! The order in which vertices, triangles and cells of a mesh are written to the page: neighbours next to
//! each other, so that differences are small, and the vertices visible from outside first.
//!
//! Frames of the same cells share one layout ([`Layouts`](crate::layouts::Layouts)), and so the same tables
//! of ids.

use motet::Mesh;
use motet::base::{CellId, Point, VertexId};
use motet::geometry::vector::is_finite;
use motet::mesh::adjacency::{FacetUse, Facets};
use motet::mesh::{CellKind, Cells, largest_extent};

use crate::skin::{NONE, Skin, pieces};

/// A mesh in the order of the page. Ids are positions in `vertices`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Layout {
    /// Every vertex shown; the first `n_skin` of them are visible from outside.
    pub(crate) vertices: Vec<VertexId>,
    pub(crate) n_skin: usize,
    pub(crate) triangles: Vec<[u32; 3]>,
    /// Which sides of each triangle are edges of the mesh.
    pub(crate) edges: Vec<u32>,
    /// The volume and the surface cell of each triangle.
    pub(crate) triangle_cells: Vec<[u32; 2]>,
    pub(crate) solids: Solids,
    /// The cell of each solid.
    pub(crate) solid_cells: Vec<CellId>,
    /// Triangles and volume cells left out because their points are not finite.
    pub(crate) not_finite: usize,
    /// Number of volume cells whose facets are not known.
    pub(crate) not_known: usize,
}

/// Volume cells by their vertices if all are tets, otherwise by the triangles that bound them.
#[derive(Clone, Debug)]
pub(crate) enum Solids {
    Tets(Vec<[u32; 4]>),
    Facets(Vec<Vec<([u32; 3], u8)>>),
}

impl Default for Solids {
    fn default() -> Self {
        Self::Tets(Vec::new())
    }
}

impl Solids {
    /// The vertices of one solid, some of them more than once.
    pub(crate) fn vertices(&self, i: usize) -> impl Iterator<Item = u32> + '_ {
        let (tet, facets): (&[u32], &[([u32; 3], u8)]) = match self {
            Self::Tets(tets) => (&tets[i], &[]),
            Self::Facets(solids) => (&[], &solids[i]),
        };
        tet.iter().copied().chain(facets.iter().flat_map(|(t, _)| t.iter().copied()))
    }
}

impl Layout {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let skin = Skin::of(mesh);
        let mut layout = Self { not_finite: skin.not_finite, ..Self::default() };
        let mut is_used = vec![false; mesh.points.len()];
        skin.triangles.as_flattened().iter().for_each(|v| is_used[v.index()] = true);
        layout.take(mesh, &is_used, &mut vec![false; mesh.points.len()]);
        layout.n_skin = layout.vertices.len();
        let mut is_taken = is_used.clone();
        let solids = layout.shown_solids(mesh);
        let facets = Facets::of(&mesh.cells);
        for &cell in &solids {
            each_vertex(&facets, cell, |v| is_used[v.index()] = true);
        }
        layout.take(mesh, &is_used, &mut is_taken);
        let mut place = vec![NONE; mesh.points.len()];
        layout.vertices.iter().zip(0..).for_each(|(v, i)| place[v.index()] = i);
        layout.put_triangles(&skin, &place);
        layout.put_solids(mesh, &facets, &solids, &place);
        layout
    }

    /// How many numbers it holds.
    pub(crate) fn n_ids(&self) -> usize {
        let of_solids = match &self.solids {
            Solids::Tets(tets) => 4 * tets.len(),
            Solids::Facets(solids) => solids.iter().map(|facets| 6 + 4 * facets.len()).sum(),
        };
        self.vertices.len() + 6 * self.triangles.len() + self.solid_cells.len() + of_solids
    }

    /// Adds the vertices that are used but not yet taken, along a space-filling curve.
    fn take(&mut self, mesh: &Mesh, is_used: &[bool], is_taken: &mut [bool]) {
        let Some([low, high]) = mesh.bounds() else { return };
        let new = (0..is_used.len()).filter(|&v| is_used[v] && !is_taken[v]);
        let mut new: Vec<(u64, u32)> =
            new.map(|v| (morton(mesh.points[v], low, high), VertexId::new(v).0)).collect();
        new.sort_unstable();
        self.vertices.extend(new.iter().map(|&(_, v)| VertexId(v)));
    }

    /// The volume cells with known facets and finite points.
    fn shown_solids(&mut self, mesh: &Mesh) -> Vec<CellId> {
        let facets = Facets::of(&mesh.cells);
        let mut shown = Vec::new();
        for (cell, ..) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3)) {
            let mut finite = true;
            each_vertex(&facets, cell, |v| finite &= is_finite(mesh.points[v.index()]));
            match facets.count(cell) {
                0 => self.not_known += 1,
                _ if finite => shown.push(cell),
                _ => self.not_finite += 1,
            }
        }
        shown
    }

    fn put_triangles(&mut self, skin: &Skin, place: &[u32]) {
        let rows = (0..skin.triangles.len()).map(|i| {
            let triangle = skin.triangles[i].map(|v| place[v.index()]);
            let (triangle, edges) = from_lowest(triangle, skin.edges[i]);
            (triangle, edges, [skin.volume_cell[i], skin.surface_cell[i]])
        });
        let mut rows: Vec<_> = rows.collect();
        rows.sort_unstable();
        self.triangles = rows.iter().map(|row| row.0).collect();
        self.edges = rows.iter().map(|row| row.1.into()).collect();
        self.triangle_cells = rows.iter().map(|row| row.2).collect();
    }

    fn put_solids(&mut self, mesh: &Mesh, facets: &Facets, solids: &[CellId], place: &[u32]) {
        if solids.iter().all(|&cell| mesh.cells.kind(cell) == CellKind::TETRA) {
            let tet = |cell: CellId| {
                let mut tet = [0; 4];
                tet.iter_mut().zip(mesh.cells.vertices(cell)).for_each(|(t, v)| *t = place[v.index()]);
                tet.sort_unstable();
                (tet, cell)
            };
            let mut rows: Vec<([u32; 4], CellId)> = solids.iter().map(|&cell| tet(cell)).collect();
            rows.sort_unstable();
            self.solids = Solids::Tets(rows.iter().map(|row| row.0).collect());
            self.solid_cells = rows.iter().map(|row| row.1).collect();
        } else {
            let of_cell = |&cell: &CellId| solid(mesh, facets, cell, place);
            self.solids = Solids::Facets(solids.iter().map(of_cell).collect());
            self.solid_cells = solids.to_vec();
        }
    }
}

/// Visits the vertices of a volume cell: those of its faces, since a polyhedron may list others.
fn each_vertex(facets: &Facets, cell: CellId, mut see: impl FnMut(VertexId)) {
    let cells: &Cells = facets.cells();
    if cells.kind(cell) == CellKind::TETRA {
        return cells.vertices(cell).iter().for_each(|&v| see(v));
    }
    for local in 0..facets.count(cell) as u32 {
        facets.vertices(FacetUse { cell, local }).1.for_each(&mut see);
    }
}

/// The triangles that bound a volume cell.
fn solid(mesh: &Mesh, facets: &Facets, cell: CellId, place: &[u32]) -> Vec<([u32; 3], u8)> {
    let mut triangles = Vec::new();
    for local in 0..facets.count(cell) as u32 {
        let (kind, vertices) = facets.vertices(FacetUse { cell, local });
        let vertices: Vec<VertexId> = vertices.collect();
        let local = pieces(mesh, kind, &vertices);
        triangles.extend(local.into_iter().map(|(t, edges)| from_lowest(t.map(|v| place[v.index()]), edges)));
    }
    triangles
}

/// The triangle rotated to start at its lowest id, with its edges.
fn from_lowest([a, b, c]: [u32; 3], edges: u8) -> ([u32; 3], u8) {
    match a.min(b).min(c) {
        low if low == a => ([a, b, c], edges),
        low if low == b => ([b, c, a], (edges >> 1 | edges << 2) & 7),
        _ => ([c, a, b], (edges >> 2 | edges << 1) & 7),
    }
}

/// The position of a point on the Morton curve through a box; points that are not finite come last.
fn morton(point: Point, low: Point, high: Point) -> u64 {
    if !is_finite(point) {
        return u64::MAX;
    }
    let size = largest_extent([low, high]);
    let cell = |i: usize| ((point[i] - low[i]) / size * 2_097_151.0) as u64;
    spread(cell(0)) | spread(cell(1)) << 1 | spread(cell(2)) << 2
}

/// Spreads 21 bits, with two zero bits between neighbours.
fn spread(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

#[cfg(test)]
mod tests {
    use motet::mesh::shapes::{ball, mixed, quadratic};

    use super::*;

    #[test]
    fn every_cell_and_every_vertex_of_it_is_there_once() {
        for mesh in [ball(3, 2), mixed(2), quadratic(&ball(2, 1))] {
            let layout = Layout::of(&mesh);
            let n_volume = mesh.cells.kinds().iter().filter(|kind| kind.dim() == Some(3)).count();
            assert_eq!(layout.solid_cells.len(), n_volume);
            let mut vertices = layout.vertices.clone();
            vertices.sort_unstable();
            vertices.dedup();
            assert_eq!(vertices.len(), layout.vertices.len());
            let seen = layout.triangles.as_flattened().iter().max().unwrap();
            assert_eq!(*seen as usize + 1, layout.n_skin);
            for (i, cell) in layout.solid_cells.iter().enumerate() {
                let mut ours: Vec<_> =
                    layout.solids.vertices(i).map(|v| layout.vertices[v as usize]).collect();
                let mut theirs = mesh.cells.vertices(*cell).to_vec();
                ours.sort_unstable();
                ours.dedup();
                theirs.sort_unstable();
                assert_eq!(ours, theirs);
            }
        }
    }

    #[test]
    fn edges_turn_with_their_triangle() {
        // Only the side from 9 to 4 is an edge.
        assert_eq!(from_lowest([9, 4, 7], 1), ([4, 7, 9], 4));
        assert_eq!(from_lowest([7, 9, 4], 2), ([4, 7, 9], 4));
        assert_eq!(from_lowest([4, 7, 9], 4), ([4, 7, 9], 4));
    }

    #[test]
    fn the_curve_goes_round_each_half_before_the_next() {
        let at = |p: Point| morton(p, [0.0; 3], [1.0; 3]);
        assert!(at([0.4, 0.4, 0.4]) < at([0.1, 0.1, 0.6]));
        assert_eq!(at([1.0; 3]), (1 << 63) - 1);
    }
}
