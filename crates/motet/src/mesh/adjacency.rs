//! Which cells share which facet, by their vertices: derived, never stored in files.
//!
//! Facets are put into buckets by their smallest vertex, and each bucket is sorted by the rest: flat arrays
//! and two passes, no hash map. One million tets (four million facets) take about 64 MB of temporary memory.

use crate::base::{CellId, Csr, VertexId};
use crate::mesh::facets::{FacetShape, facet_shapes};
use crate::mesh::{CellKind, Cells};

/// One cell's use of a facet: the cell, and which of its facets it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FacetUse {
    /// The cell.
    pub cell: CellId,
    /// Index of the facet in the cell: in VTK's order for the kinds that VTK numbers, in the order of the
    /// file for polyhedra.
    pub local: u32,
}

impl FacetUse {
    fn pack(self) -> u64 {
        u64::from(self.cell.0) << 32 | u64::from(self.local)
    }

    fn unpack(bits: u64) -> Self {
        Self { cell: CellId((bits >> 32) as u32), local: bits as u32 }
    }
}

/// The facets of all volume cells of a mesh, by cell and local index.
#[derive(Debug)]
pub struct Facets<'a> {
    cells: &'a Cells,
    /// The cell of each polyhedron, in rising order.
    polyhedra: Vec<CellId>,
}

impl<'a> Facets<'a> {
    /// The facets of the volume cells of `cells`.
    pub fn of(cells: &'a Cells) -> Self {
        let is_polyhedron = |&(_, kind, _): &(CellId, CellKind, &[VertexId])| kind == CellKind::POLYHEDRON;
        let polyhedra = if cells.polyhedron_faces().is_empty() {
            Vec::new()
        } else {
            cells.iter().filter(is_polyhedron).map(|(id, ..)| id).collect()
        };
        Self { cells, polyhedra }
    }

    /// The cells whose facets these are.
    pub fn cells(&self) -> &'a Cells {
        self.cells
    }

    /// Number of facets of a cell; 0 if it is not a volume cell, or of a kind whose facets are not known.
    pub fn count(&self, cell: CellId) -> usize {
        match self.faces_of_polyhedron(cell) {
            Some(faces) => faces.len(),
            None => facet_shapes(self.cells.kind(cell)).map_or(0, <[_]>::len),
        }
    }

    /// The corners of one facet, as a ring.
    pub fn corners(&self, facet: FacetUse) -> impl ExactSizeIterator<Item = VertexId> + Clone + 'a {
        self.nodes(facet, FacetShape::corners)
    }

    /// All vertices of one facet, and the kind of surface cell that they make.
    pub fn vertices(
        &self,
        facet: FacetUse,
    ) -> (CellKind, impl ExactSizeIterator<Item = VertexId> + Clone + 'a) {
        let kind = match self.faces_of_polyhedron(facet.cell) {
            Some(faces) if faces.list(facet.local as usize).len() == 3 => CellKind::TRIANGLE,
            Some(faces) if faces.list(facet.local as usize).len() == 4 => CellKind::QUAD,
            Some(_) => CellKind::POLYGON,
            None => self.shape(facet).kind,
        };
        (kind, self.nodes(facet, |shape| shape.nodes))
    }

    /// The vertices of a facet: those at the local indices that `pick` takes from its shape, or the whole
    /// face of a polyhedron.
    fn nodes(
        &self,
        facet: FacetUse,
        pick: fn(&FacetShape) -> &'static [u8],
    ) -> impl ExactSizeIterator<Item = VertexId> + Clone + 'a {
        let (ring, places): (&[VertexId], Option<&[u8]>) = match self.faces_of_polyhedron(facet.cell) {
            Some(faces) => (faces.list(facet.local as usize), None),
            None => (self.cells.vertices(facet.cell), Some(pick(&self.shape(facet)))),
        };
        (0..places.map_or(ring.len(), <[u8]>::len)).map(move |i| ring[places.map_or(i, |p| p[i] as usize)])
    }

    fn shape(&self, facet: FacetUse) -> FacetShape {
        let shapes = facet_shapes(self.cells.kind(facet.cell)).unwrap_or_default();
        shapes[facet.local as usize]
    }

    fn faces_of_polyhedron(&self, cell: CellId) -> Option<&'a Csr<VertexId>> {
        let place = self.polyhedra.binary_search(&cell).ok()?;
        self.cells.polyhedron_faces().get(place)
    }

    /// The distinct corners of a facet in rising order. Fewer than three mean that the cell is collapsed
    /// there and has no such facet.
    fn sorted_corners(&self, facet: FacetUse) -> Vec<VertexId> {
        let mut corners: Vec<_> = self.corners(facet).collect();
        corners.sort_unstable();
        corners.dedup();
        corners
    }

    /// Calls `see` once for every facet of the mesh, with all its uses, sorted: one use on the boundary, two
    /// inside, more where the mesh is not a manifold. Facets are visited in the order of their smallest
    /// vertex.
    pub fn for_each_shared(&self, mut see: impl FnMut(&[FacetUse])) {
        let mut uses = Vec::new();
        let all_triangles = self.cells.counts().iter().all(|(kind, _)| {
            *kind != CellKind::POLYHEDRON
                && facet_shapes(*kind).is_none_or(|shapes| shapes.iter().all(|s| s.n_corners == 3))
        });
        // Faces of a polyhedron may name vertices that its own list does not.
        let faces = self.cells.polyhedron_faces().iter().flat_map(|faces| faces.items());
        let all_ids = self.cells.connectivity().items().iter().chain(faces);
        let n_vertices = all_ids.map(|v| v.index() + 1).max().unwrap_or(0);
        let buckets = Buckets::fill(n_vertices, self);
        buckets.for_each_run(|run| {
            uses.clear();
            uses.extend(run.iter().map(|entry| FacetUse::unpack(entry.1)));
            if all_triangles || run.len() == 1 {
                see(&uses);
            } else {
                self.split_run(&uses, &mut see);
            }
        });
    }

    /// Splits uses whose facets have the same smallest, second and largest corner: they are the same facet
    /// only if they agree in the other corners, too.
    fn split_run(&self, uses: &[FacetUse], see: &mut impl FnMut(&[FacetUse])) {
        let mut keyed: Vec<_> = uses.iter().map(|&u| (self.sorted_corners(u), u)).collect();
        keyed.sort_unstable();
        for same in keyed.chunk_by(|x, y| x.0 == y.0) {
            see(&same.iter().map(|(_, u)| *u).collect::<Vec<_>>());
        }
    }
}

impl Facets<'_> {
    /// Calls `put` with every facet: its smallest corner, its second and largest corners packed together, and
    /// its packed use.
    fn put_all(&self, put: &mut impl FnMut(u32, u64, u64)) {
        for (cell, kind, vertices) in self.cells.iter() {
            if kind == CellKind::TETRA {
                let tet = [vertices[0].0, vertices[1].0, vertices[2].0, vertices[3].0];
                put_tet(cell.0, tet, VTK_TET_FACETS, put);
                continue;
            }
            for local in 0..self.count(cell) as u32 {
                let facet = FacetUse { cell, local };
                let corners = self.sorted_corners(facet);
                if let [first, second, .., last] = corners[..] {
                    put(first.0, pack(second.0, last.0), facet.pack());
                }
            }
        }
    }
}

/// VTK's facets of a tet, which leave out vertices 2, 0, 1 and 3 in turn.
pub(super) const VTK_TET_FACETS: [[usize; 3]; 4] = [[0, 1, 3], [1, 2, 3], [0, 2, 3], [0, 1, 2]];

pub(super) fn pack(second: u32, last: u32) -> u64 {
    u64::from(second) << 32 | u64::from(last)
}

#[inline]
fn put_tet(cell: u32, tet: [u32; 4], facets: [[usize; 3]; 4], put: &mut impl FnMut(u32, u64, u64)) {
    for (local, facet) in facets.into_iter().enumerate() {
        let [a, b, c] = facet.map(|i| tet[i]);
        let (low, high) = (a.min(b), a.max(b));
        let (first, rest, last) = (low.min(c), low.max(c), high.max(c));
        let middle = rest.min(high);
        if first < middle && middle < last {
            put(first, pack(middle, last), u64::from(cell) << 32 | local as u64);
        }
    }
}

/// Facets grouped by their smallest vertex: `(second and last corner, use)`, both packed.
struct Buckets {
    offsets: Vec<u32>,
    entries: Vec<(u64, u64)>,
}

impl Buckets {
    fn fill(n_vertices: usize, facets: &Facets) -> Self {
        let mut offsets = vec![0u32; n_vertices + 1];
        facets.put_all(&mut |first, _, _| offsets[first as usize + 1] += 1);
        for i in 0..n_vertices {
            offsets[i + 1] += offsets[i];
        }
        let mut next = offsets.clone();
        let mut entries = vec![(0, 0); offsets[n_vertices] as usize];
        facets.put_all(&mut |first, key, facet| {
            let place = &mut next[first as usize];
            entries[*place as usize] = (key, facet);
            *place += 1;
        });
        for list in offsets.windows(2) {
            entries[list[0] as usize..list[1] as usize].sort_unstable();
        }
        Self { offsets, entries }
    }

    /// Calls `see` with every maximal run of entries with the same key.
    fn for_each_run(&self, mut see: impl FnMut(&[(u64, u64)])) {
        for list in self.offsets.windows(2) {
            let bucket = &self.entries[list[0] as usize..list[1] as usize];
            bucket.chunk_by(|x, y| x.0 == y.0).for_each(&mut see);
        }
    }
}

/// The cells around each of `n_points` vertices, in rising order. A cell that names a vertex twice is listed
/// there twice.
///
/// Panics if a cell names a vertex beyond `n_points`: call [`Mesh::validate`](crate::mesh::Mesh::validate)
/// first.
pub fn vertex_to_cells(cells: &Cells, n_points: usize) -> Csr<CellId> {
    Csr::from_pairs(n_points, || {
        cells.iter().flat_map(|(cell, _, vertices)| vertices.iter().map(move |v| (v.index(), cell)))
    })
}
