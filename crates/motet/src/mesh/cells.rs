//! The cells of a mesh, in the order of the file, whatever their kinds.

use crate::base::{CellId, Csr, Error, Result, Threads, VertexId};
use crate::mesh::CellKind;
use crate::mesh::cutout::runs_between;

/// Cells of any kind, mixed as in the file: the kind of each cell, and the vertices of all cells, end to end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cells {
    kinds: Vec<CellKind>,
    vertices: Csr<VertexId>,
    /// The faces of each polyhedron, each a list of vertices, in the order of the polyhedra among the cells.
    /// Empty in meshes without polyhedra.
    polyhedron_faces: Vec<Csr<VertexId>>,
}

impl Cells {
    /// An empty list of cells.
    pub fn new() -> Self {
        Self::default()
    }

    /// `n` cells of one kind, from their vertices end to end.
    ///
    /// # Errors
    /// If the kind has no fixed number of vertices, `vertices` is not a multiple of it, or there are too many
    /// ids.
    pub fn uniform(kind: CellKind, vertices: Vec<VertexId>) -> Result<Self> {
        let n = kind.n_vertices().filter(|&n| n > 0);
        let Some(n) = n.filter(|n| vertices.len().is_multiple_of(*n)) else {
            return Err(Error::input(format!(
                "{} vertex ids are not a whole number of cells of kind {}",
                vertices.len(),
                kind.label()
            )));
        };
        let n_cells = vertices.len() / n;
        if vertices.len() > VertexId::MAX_COUNT {
            return Err(too_many(vertices.len()));
        }
        let offsets = (0..=n_cells).map(|i| (i * n) as u32).collect();
        Self::from_parts(vec![kind; n_cells], offsets, vertices)
    }

    /// Cells from the kind of each, the offset at which each starts (and the last one ends), and the vertices
    /// of all. Polyhedra are refused: see [`Self::push_polyhedron`].
    ///
    /// # Errors
    /// If the arrays do not match; the place of the error is the first bad cell.
    pub fn from_parts(kinds: Vec<CellKind>, offsets: Vec<u32>, vertices: Vec<VertexId>) -> Result<Self> {
        if offsets.len() != kinds.len() + 1 {
            return Err(Error::input(format!(
                "{} cell types for {} cells",
                kinds.len(),
                offsets.len().saturating_sub(1)
            )));
        }
        let n_vertices = vertices.len();
        let vertices = Csr::new(offsets, vertices).ok_or_else(|| {
            Error::input(format!("the offsets do not ascend from 0 to {n_vertices}, the number of ids"))
        })?;
        for (i, kind) in kinds.iter().enumerate() {
            let n = vertices.list(i).len();
            if *kind == CellKind::POLYHEDRON {
                return Err(Error::input("a polyhedron must be given with its faces").at(format!("cell {i}")));
            }
            if let Some(expected) = kind.n_vertices().filter(|&e| e != n) {
                return Err(Error::input(format!(
                    "a {} has {expected} vertices, but this one has {n}",
                    kind.label()
                ))
                .at(format!("cell {i}")));
            }
        }
        Ok(Self { kinds, vertices, polyhedron_faces: Vec::new() })
    }

    /// Adds a cell.
    ///
    /// Panics for a polyhedron, and in debug builds if the number of vertices is not that of the kind:
    /// readers check it first.
    pub fn push(&mut self, kind: CellKind, vertices: impl IntoIterator<Item = VertexId>) {
        assert!(kind != CellKind::POLYHEDRON, "polyhedra come with their faces");
        self.kinds.push(kind);
        self.vertices.push(vertices);
        debug_assert!(kind.n_vertices().is_none_or(|n| n == self.vertices.list(self.kinds.len() - 1).len()));
    }

    /// Adds cells of one kind, which has `N` vertices.
    pub(crate) fn push_all<const N: usize>(
        &mut self,
        kind: CellKind,
        cells: &[[VertexId; N]],
        threads: &Threads,
    ) {
        debug_assert_eq!(kind.n_vertices(), Some(N));
        self.kinds.resize(self.kinds.len() + cells.len(), kind);
        self.vertices.push_all(cells, threads);
    }

    /// Adds a polyhedron by its vertices and its faces.
    pub fn push_polyhedron(&mut self, vertices: impl IntoIterator<Item = VertexId>, faces: Csr<VertexId>) {
        self.kinds.push(CellKind::POLYHEDRON);
        self.vertices.push(vertices);
        self.polyhedron_faces.push(faces);
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there is no cell.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// The kind of each cell.
    pub fn kinds(&self) -> &[CellKind] {
        &self.kinds
    }

    /// The kind of one cell.
    pub fn kind(&self, cell: CellId) -> CellKind {
        self.kinds[cell.index()]
    }

    /// The vertices of one cell, in VTK's order.
    #[inline]
    pub fn vertices(&self, cell: CellId) -> &[VertexId] {
        self.vertices.list(cell.index())
    }

    /// The vertices of all cells as a list of lists.
    pub fn connectivity(&self) -> &Csr<VertexId> {
        &self.vertices
    }

    /// The faces of the polyhedra, in the order of the polyhedra among the cells.
    pub fn polyhedron_faces(&self) -> &[Csr<VertexId>] {
        &self.polyhedron_faces
    }

    /// All cells: id, kind, vertices.
    pub fn iter(&self) -> impl Iterator<Item = (CellId, CellKind, &[VertexId])> + Clone + '_ {
        self.kinds
            .iter()
            .zip(self.vertices.iter())
            .enumerate()
            .map(|(i, (&kind, v))| (CellId::new(i), kind, v))
    }

    /// The linear tetrahedra: the cell and the vertices of each.
    pub fn tets(&self) -> impl Iterator<Item = (CellId, [VertexId; 4])> + Clone + '_ {
        self.iter()
            .filter(|(_, kind, _)| *kind == CellKind::TETRA)
            .map(|(id, _, v)| (id, [v[0], v[1], v[2], v[3]]))
    }

    /// Every kind that occurs, with its count, in the order of VTK's numbers.
    pub fn counts(&self) -> Vec<(CellKind, usize)> {
        let mut counts = [0usize; 256];
        self.kinds.iter().for_each(|k| counts[k.0 as usize] += 1);
        (0u8..=255).filter(|&k| counts[k as usize] > 0).map(|k| (CellKind(k), counts[k as usize])).collect()
    }

    /// The highest dimension of any cell; `None` if no cell has a known one.
    pub fn dim(&self) -> Option<usize> {
        self.counts().iter().filter_map(|(kind, _)| kind.dim()).max()
    }

    /// The cells with each vertex `v` replaced by `new[v]`.
    pub(crate) fn renumbered(&self, new: &[VertexId]) -> Self {
        let of_list = |lists: &Csr<VertexId>| lists.with_items(|v| new[v.index()]);
        Self {
            kinds: self.kinds.clone(),
            vertices: of_list(&self.vertices),
            polyhedron_faces: self.polyhedron_faces.iter().map(of_list).collect(),
        }
    }

    /// The cells without some, which rise, with each vertex `v` replaced by `new[v]`; if `new` is empty,
    /// vertices keep their numbers. There must be no polyhedra.
    pub(crate) fn without(&self, removed: &[CellId], new: &[VertexId]) -> Self {
        debug_assert!(self.polyhedron_faces.is_empty());
        let mut kinds = Vec::with_capacity(self.len());
        runs_between(self.len(), removed).for_each(|run| kinds.extend_from_slice(&self.kinds[run]));
        let runs = runs_between(self.len(), removed);
        let vertices = match new.is_empty() {
            true => self.vertices.runs(runs, |v| *v),
            false => self.vertices.runs(runs, |v| new[v.index()]),
        };
        Self { kinds, vertices, polyhedron_faces: Vec::new() }
    }

    /// Checks that every vertex id is below `n_points`.
    ///
    /// # Errors
    /// If an id is too large; the error names the first such cell.
    pub fn check_ids(&self, n_points: usize) -> Result<()> {
        let beyond = |v: &[VertexId]| v.iter().map(|v| v.index()).find(|&v| v >= n_points);
        // The largest id is found first, since a search for the first that is too large is several times
        // slower.
        if self.vertices.items().iter().max().is_none_or(|v| v.index() < n_points)
            && self.polyhedron_faces.iter().all(|f| beyond(f.items()).is_none())
        {
            return Ok(());
        }
        let (cell, id) = self
            .iter()
            .find_map(|(cell, _, v)| beyond(v).map(|id| (cell.to_string(), id)))
            .or_else(|| {
                self.polyhedron_faces
                    .iter()
                    .find_map(|f| beyond(f.items()).map(|id| ("of a polyhedron".into(), id)))
            })
            .expect("one was found above");
        Err(Error::input(format!("refers to point {id}, but there are {n_points} points, numbered from 0"))
            .at(format!("cell {cell}"))
            .remedy("the file is damaged, or its ids start at the wrong number: write it again"))
    }
}

fn too_many(n: usize) -> Error {
    Error::input(format!("{n} vertex ids are more than the {} that a mesh can hold", VertexId::MAX_COUNT))
        .remedy("split the mesh")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_of_one_kind_equals_the_same_cells_pushed() {
        let ids: Vec<_> = [0, 1, 2, 3, 1, 2, 3, 4].map(VertexId).to_vec();
        let mut pushed = Cells::new();
        pushed.push(CellKind::TETRA, ids[..4].iter().copied());
        pushed.push(CellKind::TETRA, ids[4..].iter().copied());
        assert_eq!(Cells::uniform(CellKind::TETRA, ids).unwrap(), pushed);
    }

    #[test]
    fn a_cell_with_the_wrong_number_of_vertices_is_named() {
        let ids = (0..7).map(VertexId).collect();
        let error =
            Cells::from_parts(vec![CellKind::TETRA, CellKind::TETRA], vec![0, 4, 7], ids).unwrap_err();
        assert_eq!(error.to_string(), "cell 1: a tetra has 4 vertices, but this one has 3");
    }

    #[test]
    fn an_id_beyond_the_points_is_named_with_its_cell() {
        let cells = Cells::uniform(CellKind::LINE, [0, 1, 1, 9].map(VertexId).to_vec()).unwrap();
        let error = cells.check_ids(5).unwrap_err().to_string();
        assert!(
            error.starts_with("cell 1: refers to point 9, but there are 5 points, numbered from 0"),
            "{error}"
        );
    }
}
