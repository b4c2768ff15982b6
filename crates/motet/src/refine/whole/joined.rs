//! The cells of a whole mesh after a step: the parts of each root in its place, with cells of other kinds
//! unchanged between them.

use super::super::forest::Extracted;
use super::super::refinement::Refinement;
use super::Slot;
use crate::base::{CellId, Csr, ForestVertexId, Id, LineId, MaybeId, TetId, TriangleId, VertexId};
use crate::mesh::{CellKind, Cells, Mesh};

/// The cells of the new mesh, and for each the old cell it was.
pub(super) struct Joined {
    pub(super) cells: Cells,
    /// None for new cells.
    pub(super) cell_to_old: Vec<MaybeId<CellId>>,
    /// None for new vertices.
    pub(super) vertex_to_old: Vec<MaybeId<VertexId>>,
    pub(super) tet_to_cell: Vec<CellId>,
    pub(super) triangle_to_cell: Vec<CellId>,
    pub(super) line_to_cell: Vec<CellId>,
    pub(super) tets: Matched<TetId>,
    pub(super) triangles: Matched<TriangleId>,
    pub(super) lines: Matched<LineId>,
}

/// Correspondence between the tets, triangles or lines of two meshes.
pub(super) struct Matched<I> {
    /// For each item of the new mesh, the same item of the old one; none for new ones.
    to_old: Vec<MaybeId<I>>,
    /// Items of the old mesh that were removed, in ascending order.
    pub(super) removed: Vec<I>,
    /// New items, in ascending order.
    pub(super) inserted: Vec<I>,
}

impl Joined {
    /// Joins the cells. `cells` gives the cells of the tets, triangles and lines of the old mesh; the two
    /// refinements are those before and after.
    pub(super) fn of(
        old: &Mesh,
        slots: &[Slot],
        cells: [&[CellId]; 3],
        [before, after]: [&Refinement; 2],
    ) -> Self {
        let (was, is) = (&before.now, &after.now);
        let root_of = |of: &Refinement| -> Vec<TetId> { of.roots().collect() };
        let tet_roots = [before, after].map(root_of);
        let tets = matched([was, is].map(|out| names(out, &out.mesh.tets)), [&tet_roots[0], &tet_roots[1]]);
        let triangles =
            matched([was, is].map(|out| names(out, &out.mesh.triangles)), [&was.triangles, &is.triangles]);
        let lines = matched([was, is].map(|out| names(out, &out.mesh.lines)), [&was.lines, &is.lines]);
        let vertices = Vertices::of(was, is, after.forest.reference.len());
        let joined = Self {
            cells: Cells::new(),
            cell_to_old: Vec::new(),
            vertex_to_old: vertices.new_to_old,
            tet_to_cell: Vec::with_capacity(is.mesh.tets.len()),
            triangle_to_cell: Vec::with_capacity(is.mesh.triangles.len()),
            line_to_cell: Vec::with_capacity(is.mesh.lines.len()),
            tets,
            triangles,
            lines,
        };
        joined.fill(old, slots, cells, is, &tet_roots[1], &vertices.old_to_new)
    }

    fn fill(
        mut self,
        old: &Mesh,
        slots: &[Slot],
        [old_tets, old_triangles, old_lines]: [&[CellId]; 3],
        is: &Extracted,
        tet_roots: &[TetId],
        old_to_new: &[VertexId],
    ) -> Self {
        let new = |v: VertexId| old_to_new[v.index()];
        let mut others =
            old.cells.iter().filter(|(_, kind, vertices)| Slot::of(*kind, vertices) == Slot::Other);
        let mut faces = old.cells.polyhedron_faces().iter();
        let mut parts_of_tets = tet_roots.chunk_by(|x, y| x == y);
        let mut parts_of_triangles = is.triangles.chunk_by(|x, y| x == y);
        let mut parts_of_lines = is.lines.chunk_by(|x, y| x == y);
        for slot in slots {
            match slot {
                Slot::Tet => {
                    for _ in 0..parts_of_tets.next().map_or(0, <[_]>::len) {
                        let t = self.tet_to_cell.len();
                        let known = self.tets.old(t, old_tets);
                        let cell = self.push(CellKind::TETRA, known, is.mesh.tets[t]);
                        self.tet_to_cell.push(cell);
                    }
                }
                Slot::Triangle => {
                    for _ in 0..parts_of_triangles.next().map_or(0, <[_]>::len) {
                        let t = self.triangle_to_cell.len();
                        let known = self.triangles.old(t, old_triangles);
                        let cell = self.push(CellKind::TRIANGLE, known, is.mesh.triangles[t]);
                        self.triangle_to_cell.push(cell);
                    }
                }
                Slot::Line => {
                    for _ in 0..parts_of_lines.next().map_or(0, <[_]>::len) {
                        let l = self.line_to_cell.len();
                        let known = self.lines.old(l, old_lines);
                        let cell = self.push(CellKind::LINE, known, is.mesh.lines[l]);
                        self.line_to_cell.push(cell);
                    }
                }
                Slot::Other => {
                    let Some((cell, kind, vertices)) = others.next() else { continue };
                    let vertices = vertices.iter().map(|&v| new(v));
                    if kind == CellKind::POLYHEDRON {
                        let mut renamed = Csr::default();
                        let named = faces.next().into_iter().flat_map(|faces| faces.iter());
                        named.for_each(|face| renamed.push(face.iter().map(|&v| new(v))));
                        self.cells.push_polyhedron(vertices, renamed);
                    } else {
                        self.cells.push(kind, vertices);
                    }
                    self.cell_to_old.push(cell.into());
                }
            }
        }
        self
    }

    fn push<const N: usize>(
        &mut self,
        kind: CellKind,
        old: MaybeId<CellId>,
        vertices: [VertexId; N],
    ) -> CellId {
        let cell = CellId::new(self.cells.len());
        self.cells.push(kind, vertices);
        self.cell_to_old.push(old);
        cell
    }
}

impl<I: Id> Matched<I> {
    /// The old cell of an item of the new mesh, given the cells of the old items.
    fn old(&self, i: usize, cells: &[CellId]) -> MaybeId<CellId> {
        self.to_old[i].get().map(|old| cells[old.place()]).into()
    }
}

struct Vertices {
    new_to_old: Vec<MaybeId<VertexId>>,
    old_to_new: Vec<VertexId>,
}

impl Vertices {
    /// `n_vertices` is the number of vertices of the forest.
    fn of(was: &Extracted, is: &Extracted, n_vertices: usize) -> Self {
        let numbers = was.numbers(n_vertices);
        let new_to_old: Vec<_> = is.vertices.iter().map(|v| numbers[v.index()]).collect();
        let mut old_to_new = vec![Id::NONE; was.vertices.len()];
        for (new, old) in new_to_old.iter().enumerate() {
            if let Some(old) = old.get() {
                old_to_new[old.index()] = VertexId::new(new);
            }
        }
        Self { new_to_old, old_to_new }
    }
}

/// Names each tet, triangle or line by the forest ids of its vertices.
fn names<const N: usize>(out: &Extracted, of: &[[VertexId; N]]) -> Vec<[ForestVertexId; N]> {
    of.iter().map(|vertices| vertices.map(|v| out.vertices[v.index()])).collect()
}

/// Matches items with equal names that belong to the same root.
fn matched<I: Id, const N: usize>(names: [Vec<[ForestVertexId; N]>; 2], roots: [&[I]; 2]) -> Matched<I> {
    let [was, is] = names;
    let order = [by_root(roots[0]), by_root(roots[1])];
    let mut to_old = vec![MaybeId::NONE; is.len()];
    let mut stays = vec![false; was.len()];
    let mut olds = order[0].chunk_by(|x, y| roots[0][x.place()] == roots[0][y.place()]);
    for news in order[1].chunk_by(|x, y| roots[1][x.place()] == roots[1][y.place()]) {
        // Both meshes have the same roots, and each root has at least one part in each mesh.
        let Some(olds) = olds.next() else { break };
        let mut sorted: Vec<([ForestVertexId; N], I)> = olds.iter().map(|&t| (was[t.place()], t)).collect();
        sorted.sort_unstable();
        for &t in news {
            if let Ok(i) = sorted.binary_search_by_key(&is[t.place()], |(name, _)| *name) {
                to_old[t.place()] = sorted[i].1.into();
                stays[sorted[i].1.place()] = true;
            }
        }
    }
    let removed = (0..was.len()).filter(|&t| !stays[t]).map(I::of).collect();
    let inserted = (0..is.len()).filter(|&t| to_old[t].is_none()).map(I::of).collect();
    Matched { to_old, removed, inserted }
}

/// Returns all items sorted by root; items of one root keep their order.
fn by_root<I: Id>(roots: &[I]) -> Vec<I> {
    let mut order: Vec<I> = (0..roots.len()).map(I::of).collect();
    if !roots.is_sorted() {
        order.sort_by_key(|t| roots[t.place()]);
    }
    order
}
