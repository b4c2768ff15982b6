//! The cells of a whole mesh after a step: the parts of each root in its place, with cells of other kinds
//! unchanged between them.

use super::super::forest::{Extracted, Forest};
use super::Slot;
use super::ancestry::Ancestry;
use crate::base::{
    CellId, Csr, ForestVertexId, Id, LineId, MaybeId, TetId, Threads, TriangleId, VertexId, absent,
};
use crate::mesh::{CellKind, Cells, Mesh};

/// The least number of cells that a thread takes at a time.
const MIN_PART: usize = 1 << 14;

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
    /// Joins the cells. `cells` gives the cells of the tets, triangles and lines of the old mesh, `ancestry`
    /// and the two extracts are of the meshes before and after.
    pub(super) fn of(
        old: &Mesh,
        slots: &[Slot],
        cells: [&[CellId]; 3],
        forest: &Forest,
        [was, is]: [&Extracted; 2],
        ancestry: &Ancestry<'_>,
        threads: &Threads,
    ) -> Self {
        let tets = if ancestry.is_grouped {
            let to_old = threads.map(is.mesh.tets.len(), |t| ancestry.same(TetId::new(t)));
            Matched::of(to_old, was.mesh.tets.len())
        } else {
            let roots = [was, is].map(|out| out.nodes.iter().map(|&node| forest.root(node)).collect());
            let [before, after]: [Vec<TetId>; 2] = roots;
            matched([was, is].map(|out| names(out, &out.mesh.tets)), [&before, &after])
        };
        let triangles =
            matched([was, is].map(|out| names(out, &out.mesh.triangles)), [&was.triangles, &is.triangles]);
        let lines = matched([was, is].map(|out| names(out, &out.mesh.lines)), [&was.lines, &is.lines]);
        let numbers = was.numbers(forest.reference.len());
        let joined = Self {
            cells: Cells::new(),
            cell_to_old: Vec::new(),
            vertex_to_old: threads.map(is.vertices.len(), |v| numbers[is.vertices[v].index()]),
            tet_to_cell: Vec::new(),
            triangle_to_cell: Vec::new(),
            line_to_cell: Vec::new(),
            tets,
            triangles,
            lines,
        };
        joined.fill(old, slots, cells, is, threads)
    }

    fn fill(
        mut self,
        old: &Mesh,
        slots: &[Slot],
        [old_tets, old_triangles, old_lines]: [&[CellId]; 3],
        is: &Extracted,
        threads: &Threads,
    ) -> Self {
        let has_others = slots.contains(&Slot::Other);
        let old_to_new = if has_others { self.old_to_new(old.points.len()) } else { Vec::new() };
        let new = |v: VertexId| old_to_new[v.index()];
        let mut others =
            old.cells.iter().filter(|(_, kind, vertices)| Slot::of(*kind, vertices) == Slot::Other);
        let mut faces = old.cells.polyhedron_faces().iter();
        let mut parts_of_tets = is.n_tets.iter().map(|&n| n as usize);
        let mut parts_of_triangles = is.triangles.chunk_by(|x, y| x == y).map(<[_]>::len);
        let mut parts_of_lines = is.lines.chunk_by(|x, y| x == y).map(<[_]>::len);
        for alike in slots.chunk_by(|x, y| x == y) {
            let (first, n) = (self.cells.len(), alike.len());
            match alike[0] {
                Slot::Tet => {
                    let n: usize = parts_of_tets.by_ref().take(n).sum();
                    let at = self.tet_to_cell.len();
                    self.cells.push_all(CellKind::TETRA, &is.mesh.tets[at..at + n], threads);
                    let known = |i: usize| self.tets.old(at + i, old_tets);
                    threads.append(&mut self.cell_to_old, n, MIN_PART, known);
                    threads.append(&mut self.tet_to_cell, n, MIN_PART, |i| CellId::new(first + i));
                }
                Slot::Triangle => {
                    let n: usize = parts_of_triangles.by_ref().take(n).sum();
                    let at = self.triangle_to_cell.len();
                    self.cells.push_all(CellKind::TRIANGLE, &is.mesh.triangles[at..at + n], threads);
                    self.cell_to_old.extend((at..at + n).map(|t| self.triangles.old(t, old_triangles)));
                    self.triangle_to_cell.extend((first..first + n).map(CellId::new));
                }
                Slot::Line => {
                    let n: usize = parts_of_lines.by_ref().take(n).sum();
                    let at = self.line_to_cell.len();
                    self.cells.push_all(CellKind::LINE, &is.mesh.lines[at..at + n], threads);
                    self.cell_to_old.extend((at..at + n).map(|l| self.lines.old(l, old_lines)));
                    self.line_to_cell.extend((first..first + n).map(CellId::new));
                }
                Slot::Other => {
                    for (cell, kind, vertices) in others.by_ref().take(n) {
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
        }
        self
    }

    /// For each of the `n` old vertices, its number in the new mesh.
    fn old_to_new(&self, n: usize) -> Vec<VertexId> {
        let mut old_to_new = vec![Id::NONE; n];
        for (new, old) in self.vertex_to_old.iter().enumerate() {
            if let Some(old) = old.get() {
                old_to_new[old.index()] = VertexId::new(new);
            }
        }
        old_to_new
    }
}

impl<I: Id> Matched<I> {
    /// Of the old item that each new one is, and the number of old items.
    fn of(to_old: Vec<MaybeId<I>>, n_old: usize) -> Self {
        let mut stays = vec![false; n_old];
        to_old.iter().filter_map(|old| old.get()).for_each(|old| stays[old.place()] = true);
        let removed = (0..n_old).filter(|&t| !stays[t]).map(I::of).collect();
        Self { removed, inserted: absent(&to_old), to_old }
    }

    /// The old cell of an item of the new mesh, given the cells of the old items.
    fn old(&self, i: usize, cells: &[CellId]) -> MaybeId<CellId> {
        self.to_old[i].get().map(|old| cells[old.place()]).into()
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
    let mut olds = order[0].chunk_by(|x, y| roots[0][x.place()] == roots[0][y.place()]);
    for news in order[1].chunk_by(|x, y| roots[1][x.place()] == roots[1][y.place()]) {
        // Both meshes have the same roots, and each root has at least one part in each mesh.
        let Some(olds) = olds.next() else { break };
        let mut sorted: Vec<([ForestVertexId; N], I)> = olds.iter().map(|&t| (was[t.place()], t)).collect();
        sorted.sort_unstable();
        for &t in news {
            if let Ok(i) = sorted.binary_search_by_key(&is[t.place()], |(name, _)| *name) {
                to_old[t.place()] = sorted[i].1.into();
            }
        }
    }
    Matched::of(to_old, was.len())
}

/// Returns all items sorted by root; items of one root keep their order.
fn by_root<I: Id>(roots: &[I]) -> Vec<I> {
    let mut order: Vec<I> = (0..roots.len()).map(I::of).collect();
    if !roots.is_sorted() {
        order.sort_by_key(|t| roots[t.place()]);
    }
    order
}
