//! A part of a mesh, cut out to be changed by itself, and put back.
//!
//! ```text
//!     o---o---o---o---o      s  seeds
//!    / \ / \ / \ / \ / \     1  their layer 1
//!   c---1---1---1---c---o    c  the cut: vertices that cells outside have, too
//!    \ / \s/s\ / \ / \ /
//!     c---1---1---c---o
//! ```

use std::ops::Range;

use crate::base::{CellId, Id, MaybeId, Point, Result, Threads, VertexId};
use crate::mesh::history::{History, Origins, Rows};
use crate::mesh::{Cells, Field, Mesh, TetPart};

/// The layer of a vertex outside.
const OUTSIDE: u8 = u8::MAX;

/// The number of cells that a thread looks at.
const CHUNK: usize = 1 << 14;

/// The cells around some others, as a mesh of their own.
#[derive(Debug)]
pub(crate) struct Cutout {
    /// The cells, in their order in the whole mesh, with its arrays.
    pub(crate) mesh: Mesh,
    /// The vertex of the whole mesh that each vertex is, in rising order.
    pub(crate) vertices: Vec<VertexId>,
    /// The cell of the whole mesh that each cell is, in rising order.
    pub(crate) cells: Vec<CellId>,
    /// For each vertex, by how many layers of cells it is separated from the seeds.
    layers: Vec<u8>,
    n_layers: u8,
}

/// A whole mesh into which a changed part has been put back.
#[derive(Debug)]
pub(crate) struct PutBack {
    /// Points and cells, without arrays.
    pub(crate) mesh: Mesh,
    /// Where the vertices and cells of the whole mesh came from.
    pub(crate) history: History,
    /// The vertex of the new whole mesh that each vertex of the changed part is.
    pub(crate) vertices: Vec<VertexId>,
    /// The cell of the new whole mesh that each cell of the changed part is.
    pub(crate) cells: Vec<CellId>,
}

impl Cutout {
    /// The cells within `n_layers` layers of the volume cells `seeds`, sharing a vertex from layer to layer,
    /// and all triangles, lines and points between their vertices. `None` if that are more than `max_cells`,
    /// or if the mesh has polyhedra.
    pub(crate) fn around(
        mesh: &Mesh,
        seeds: &[CellId],
        n_layers: u8,
        max_cells: usize,
        threads: &Threads,
    ) -> Option<Self> {
        let cells = &mesh.cells;
        if !cells.polyhedron_faces().is_empty() {
            return None;
        }
        let mut layers = vec![OUTSIDE; mesh.points.len()];
        let mut is_inside = vec![false; cells.len()];
        let mut inside: Vec<CellId> = Vec::new();
        let mark = |layers: &mut [u8], cells_of: &[CellId], layer: u8| {
            for v in cells_of.iter().flat_map(|&cell| cells.vertices(cell)) {
                layers[v.index()] = layers[v.index()].min(layer);
            }
        };
        mark(&mut layers, seeds, 0);
        for layer in 1..=n_layers {
            let touches = |cell: CellId| {
                !is_inside[cell.index()]
                    && cells.kind(cell).dim() == Some(3)
                    && cells.vertices(cell).iter().any(|v| layers[v.index()] != OUTSIDE)
            };
            let found = cells_such_that(cells.len(), touches, threads);
            found.iter().for_each(|cell| is_inside[cell.index()] = true);
            mark(&mut layers, &found, layer);
            inside.extend(found);
            if inside.len() > max_cells {
                return None;
            }
        }
        let is_between = |cell: CellId| {
            cells.kind(cell).dim() != Some(3)
                && cells.vertices(cell).iter().all(|v| layers[v.index()] != OUTSIDE)
        };
        inside.extend(cells_such_that(cells.len(), is_between, threads));
        inside.sort_unstable();
        let vertices: Vec<VertexId> =
            (0..layers.len()).filter(|&v| layers[v] != OUTSIDE).map(VertexId::new).collect();
        Some(Self {
            mesh: cut(mesh, &inside, &vertices),
            layers: vertices.iter().map(|v| layers[v.index()]).collect(),
            vertices,
            cells: inside,
            n_layers,
        })
    }

    /// The cells of the part that some cells of the whole mesh are; those outside are left out.
    pub(crate) fn inside(&self, cells: &[CellId]) -> Vec<CellId> {
        cells.iter().filter_map(|cell| self.cells.binary_search(cell).ok()).map(CellId::new).collect()
    }

    /// The values of the vertices of the part, from those of the whole mesh.
    pub(crate) fn pick<T: Copy>(&self, values: &[T]) -> Vec<T> {
        self.vertices.iter().map(|v| values[v.index()]).collect()
    }

    /// Whether a vertex of the part is within `n` layers of the cut.
    pub(crate) fn is_near_cut(&self, vertex: VertexId, n: u8) -> bool {
        self.layers[vertex.index()] + n >= self.n_layers
    }

    /// Fixes the cut of the part, whose tets are `part`, and the edges on it.
    pub(crate) fn fix_cut(&self, part: &mut TetPart) {
        let is_cut = |v: &VertexId| self.is_near_cut(*v, 0);
        let fixed = &mut part.mesh;
        fixed.cut_vertices = (0..self.vertices.len()).map(VertexId::new).filter(is_cut).collect();
        for tet in &fixed.tets {
            for (i, a) in tet.iter().enumerate().filter(|(_, v)| is_cut(v)) {
                fixed.fixed_edges.extend(tet[..i].iter().filter(|b| is_cut(b)).map(|&b| [*a, b]));
            }
        }
    }

    /// Puts the part, which has become `part`, back into the whole mesh that it was cut out of, whose
    /// vertices are at `points`. `vertex_to_old` has the vertex that each vertex of `part` was, moved or not,
    /// in rising order, none for an inserted one; `history` leads from the part as it was to `part`.
    ///
    /// What stayed keeps its order. Inserted vertices take the numbers of removed ones, the rest follow at
    /// the end; new cells follow at the end.
    ///
    /// # Errors
    /// If the history is not of the part.
    pub(crate) fn put_back(
        &self,
        whole: &Mesh,
        points: &[Point],
        part: &Mesh,
        vertex_to_old: &[MaybeId<VertexId>],
        history: &History,
    ) -> Result<PutBack> {
        let numbers = Numbers::of(points.len(), &self.vertices, vertex_to_old);
        let mut new_points = numbers.kept(points);
        new_points.resize(numbers.n_new, [0.0; 3]);
        let mut kept: Vec<MaybeId<VertexId>> = kept_ids(points.len(), &numbers.removed);
        kept.resize(numbers.n_new, MaybeId::NONE);
        for ((v, &point), old) in numbers.of_part.iter().zip(&part.points).zip(history.vertices.kept()) {
            new_points[v.index()] = point;
            if old.is_none() {
                kept[v.index()] = MaybeId::NONE;
            }
        }
        let (to_whole, to_new) = (|v: VertexId| self.vertices[v.index()], |v: VertexId| numbers.number(v));
        let renumbered = |rows: &Rows<VertexId>| rows.renumbered(to_new, to_whole);
        let vertices = Origins::new(points.len(), kept, renumbered(history.vertices.changed()))?
            .with_quadratic(renumbered(history.vertices.quadratic()))?;

        let mut is_kept = vec![false; self.cells.len()];
        let of_part = history.cells.kept();
        of_part.iter().filter_map(|old| old.get()).for_each(|old| is_kept[old.index()] = true);
        let removed: Vec<CellId> =
            self.cells.iter().zip(&is_kept).filter(|(_, is)| !**is).map(|(cell, _)| *cell).collect();
        let mut cells = whole.cells.without(&removed, &numbers.old_to_new);
        let n_kept = cells.len();
        for (i, kind, its) in part.cells.iter() {
            if of_part[i.index()].is_none() {
                cells.push(kind, its.iter().map(|&v| numbers.number(v)));
            }
        }
        let mut kept: Vec<MaybeId<CellId>> = kept_ids(whole.cells.len(), &removed);
        kept.resize(cells.len(), MaybeId::NONE);
        let mut n_new = 0;
        let new_cell = |old: &MaybeId<CellId>| match old.get() {
            Some(old) => {
                let old = self.cells[old.index()];
                CellId::new(old.index() - removed.partition_point(|removed| *removed < old))
            }
            None => {
                n_new += 1;
                CellId::new(n_kept + n_new - 1)
            }
        };
        let of_part: Vec<CellId> = of_part.iter().map(new_cell).collect();
        let rows = history.cells.changed();
        let rows = rows.renumbered(|cell| of_part[cell.index()], |cell| self.cells[cell.index()]);
        let origins = Origins::new(whole.cells.len(), kept, rows)?;
        Ok(PutBack {
            mesh: Mesh::new(new_points, cells),
            history: History { vertices, cells: origins, ledger: history.ledger.clone() },
            vertices: numbers.of_part,
            cells: of_part,
        })
    }
}

/// The numbers of the vertices of a whole mesh after a part of it has changed.
struct Numbers {
    n_new: usize,
    /// Old vertices that no longer exist, in rising order.
    removed: Vec<VertexId>,
    /// The new number of each old vertex, 0 for removed ones; empty where none was removed.
    old_to_new: Vec<VertexId>,
    /// The new number of each vertex of the changed part.
    of_part: Vec<VertexId>,
}

impl Numbers {
    /// `part` has the vertex of the whole mesh that each vertex of the part was; `to_old` the vertex of the
    /// part that each vertex of the changed part was.
    fn of(n_old: usize, part: &[VertexId], to_old: &[MaybeId<VertexId>]) -> Self {
        let mut next = 0;
        let slots: Vec<usize> = to_old
            .iter()
            .map(|old| {
                let slot = old.get().map_or(next, VertexId::index);
                next = slot + 1;
                slot
            })
            .collect();
        let mut is_used = vec![false; part.len()];
        slots.iter().filter(|&&slot| slot < part.len()).for_each(|&slot| is_used[slot] = true);
        let removed: Vec<VertexId> =
            part.iter().zip(&is_used).filter(|(_, is)| !**is).map(|(v, _)| *v).collect();
        let mut old_to_new = Vec::new();
        if !removed.is_empty() {
            old_to_new.resize(n_old, VertexId(0));
            let kept = runs_between(n_old, &removed).flatten();
            kept.enumerate().for_each(|(new, old)| old_to_new[old] = VertexId::new(new));
        }
        let mut n_new = n_old - removed.len();
        let new = |slot: usize| match part.get(slot) {
            Some(&v) if old_to_new.is_empty() => v,
            Some(&v) => old_to_new[v.index()],
            None => {
                n_new += 1;
                VertexId::new(n_new - 1)
            }
        };
        let of_part = slots.into_iter().map(new).collect();
        Self { n_new, removed, old_to_new, of_part }
    }

    fn number(&self, of_part: VertexId) -> VertexId {
        self.of_part[of_part.index()]
    }

    /// The values of the old vertices that still exist.
    fn kept<T: Copy>(&self, values: &[T]) -> Vec<T> {
        let mut kept = Vec::with_capacity(self.n_new);
        runs_between(values.len(), &self.removed).for_each(|run| kept.extend_from_slice(&values[run]));
        kept
    }
}

/// The ids below `n` without removed ones, which rise.
fn kept_ids<I: Id>(n: usize, removed: &[I]) -> Vec<MaybeId<I>> {
    runs_between(n, removed).flatten().map(|id| I::of(id).into()).collect()
}

/// The runs of ids below `n` between removed ones, which rise.
pub(super) fn runs_between<I: Id>(n: usize, removed: &[I]) -> impl Iterator<Item = Range<usize>> + '_ {
    let ends = removed.iter().map(|id| id.place()).chain([n]);
    let starts = [0].into_iter().chain(removed.iter().map(|id| id.place() + 1));
    starts.zip(ends).map(|(start, end)| start..end).filter(|run| !run.is_empty())
}

/// The cells below `n` that a test finds, in rising order.
pub(super) fn cells_such_that(
    n: usize,
    is_such: impl Fn(CellId) -> bool + Sync,
    threads: &Threads,
) -> Vec<CellId> {
    let chunk = |start: usize| -> Vec<CellId> {
        (start..(start + CHUNK).min(n)).map(CellId::new).filter(|&cell| is_such(cell)).collect()
    };
    threads.each((0..n).step_by(CHUNK).collect(), chunk).into_iter().flatten().collect()
}

/// Some cells of a mesh and the vertices that they have, as a mesh of their own.
fn cut(mesh: &Mesh, cells: &[CellId], vertices: &[VertexId]) -> Mesh {
    let mut new = vec![VertexId(0); mesh.points.len()];
    vertices.iter().enumerate().for_each(|(i, v)| new[v.index()] = VertexId::new(i));
    let mut part = Cells::new();
    for &cell in cells {
        part.push(mesh.cells.kind(cell), mesh.cells.vertices(cell).iter().map(|v| new[v.index()]));
    }
    let pick = |fields: &[Field], rows: &dyn Fn() -> Vec<usize>| -> Vec<Field> {
        fields.iter().map(|field| field.pick(rows())).collect()
    };
    Mesh {
        points: vertices.iter().map(|v| mesh.points[v.index()]).collect(),
        cells: part,
        point_data: pick(&mesh.point_data, &|| vertices.iter().map(|v| v.index()).collect()),
        cell_data: pick(&mesh.cell_data, &|| cells.iter().map(|cell| cell.index()).collect()),
        field_data: mesh.field_data.clone(),
        label_names: mesh.label_names.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::box_grid;

    /// A grid with an array on its points and one on its cells, and the part around one of its tets.
    fn grid_and_part() -> (Mesh, Cutout) {
        let mut mesh = box_grid([6; 3], [[0.0; 3], [6.0; 3]]);
        mesh.set_point_field(Field::scalars("x", mesh.points.iter().map(|p| p[0]).collect::<Vec<_>>()));
        mesh.set_cell_field(Field::scalars(
            "id",
            (0..mesh.cells.len()).map(|c| c as f64).collect::<Vec<_>>(),
        ));
        let middle = mesh.cells.tets().find(|(_, tet)| {
            tet.iter().all(|v| mesh.points[v.index()][2] == 3.0 || mesh.points[v.index()][2] == 2.0)
        });
        let seed = middle.expect("the grid has such a tet").0;
        let part = Cutout::around(&mesh, &[seed], 2, mesh.cells.len(), &Threads::single()).unwrap();
        (mesh, part)
    }

    #[test]
    fn a_part_holds_all_tets_of_the_vertices_inside_its_cut() {
        let (mesh, part) = grid_and_part();
        assert!(part.cells.len() < mesh.cells.len());
        let inner = (0..part.vertices.len()).filter(|&v| !part.is_near_cut(VertexId::new(v), 0));
        let inner: Vec<VertexId> = inner.map(|v| part.vertices[v]).collect();
        for (cell, tet) in mesh.cells.tets() {
            if tet.iter().any(|v| inner.contains(v)) {
                assert!(part.cells.contains(&cell));
            }
        }
        let whole = |v: &VertexId| part.vertices[v.index()];
        for (i, _, vertices) in part.mesh.cells.iter() {
            let cell = part.cells[i.index()];
            assert!(vertices.iter().map(whole).eq(mesh.cells.vertices(cell).iter().copied()));
            let id = part.mesh.cell_field("id").unwrap().values.get_f64(i.index());
            assert_eq!(id, Some(f64::from(cell.0)));
        }
        assert!(part.mesh.points.iter().zip(&part.vertices).all(|(p, v)| *p == mesh.points[v.index()]));
        assert!(Cutout::around(&mesh, &[part.cells[0]], 2, 10, &Threads::single()).is_none());
    }

    #[test]
    fn what_is_put_back_unchanged_changes_nothing() {
        let (mesh, part) = grid_and_part();
        let n = [part.vertices.len(), part.cells.len()];
        let same: Vec<MaybeId<VertexId>> = (0..n[0]).map(|v| VertexId::new(v).into()).collect();
        let history = History::identity(n[0], n[1]);
        let back = part.put_back(&mesh, &mesh.points, &part.mesh, &same, &history).unwrap();
        assert_eq!((back.mesh.points, back.mesh.cells), (mesh.points.clone(), mesh.cells.clone()));
        assert_eq!(back.history, History::identity(mesh.points.len(), mesh.cells.len()));
        assert_eq!((back.vertices, back.cells), (part.vertices.clone(), part.cells.clone()));
    }
}
