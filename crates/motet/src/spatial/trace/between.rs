//! The whole history between two meshes, given which vertices and cells are the same.

use super::{ChangedVertex, Labelled, LocalChange, quadratic_rows, trace};
use crate::base::{CellId, Error, Id, MaybeId, Result, Threads, VertexId};
use crate::mesh::history::{History, Origins};
use crate::mesh::{CellKind, Labels, Mesh};

/// Builds the history from `old` to `new`. `vertex_to_old` and `cell_to_old` give, for each vertex and each
/// cell of `new`, its id in `old`, or none if it is new.
///
/// A vertex with an old id but at another place counts as moved. Tets with a moved vertex count as changed;
/// other cells do not. New tets and triangles are traced within the regions and patches given by the arrays
/// of the meshes; new cells of other kinds cannot be traced.
///
/// # Errors
/// When the lists do not fit the meshes, when a new cell is neither a tet nor a triangle, and when [`trace`]
/// fails.
pub fn between(
    old: &Mesh,
    new: &Mesh,
    vertex_to_old: &[MaybeId<VertexId>],
    cell_to_old: &[MaybeId<CellId>],
    threads: &Threads,
) -> Result<History> {
    check(vertex_to_old, new.points.len(), old.points.len(), "vertex")?;
    check(cell_to_old, new.cells.len(), old.cells.len(), "cell")?;
    let mut vertices = vertex_to_old.to_vec();
    let mut cells = cell_to_old.to_vec();
    let changed_vertices = changed_vertices(old, new, &mut vertices);
    let is_changed: Vec<bool> = vertices.iter().map(|v| v.is_none()).collect();
    for (cell, tet) in new.cells.tets() {
        if tet.iter().any(|v| is_changed[v.index()]) {
            cells[cell.index()] = MaybeId::NONE;
        }
    }
    let mut is_removed = vec![true; old.cells.len()];
    cells.iter().filter_map(|c| c.get()).for_each(|c| is_removed[c.index()] = false);
    let is_new: Vec<bool> = cells.iter().map(|c| c.is_none()).collect();
    check_kinds(new, &is_new)?;
    let traced = trace(
        &LocalChange {
            old_points: &old.points,
            new_points: &new.points,
            removed_tets: &labelled(old, &is_removed, CellKind::TETRA, old.regions()),
            new_tets: &labelled(new, &is_new, CellKind::TETRA, new.regions()),
            removed_triangles: &labelled(old, &is_removed, CellKind::TRIANGLE, old.patches()),
            new_triangles: &labelled(new, &is_new, CellKind::TRIANGLE, new.patches()),
            changed_vertices: &changed_vertices,
        },
        threads,
    )?;
    let wide = quadratic_rows(old, &traced.vertices, threads);
    Ok(History {
        vertices: Origins::new(old.points.len(), vertices, traced.vertices)?.with_quadratic(wide)?,
        cells: Origins::new(old.cells.len(), cells, traced.cells)?,
        ledger: traced.ledger,
    })
}

/// The vertices that are new or moved, which lose their old id in `to_old`. A moved vertex that is in no tet
/// keeps its old id, since there is nothing to interpolate in.
fn changed_vertices(old: &Mesh, new: &Mesh, to_old: &mut [MaybeId<VertexId>]) -> Vec<ChangedVertex> {
    let mut has_tet = vec![false; new.points.len()];
    new.cells.tets().for_each(|(_, tet)| tet.iter().for_each(|v| has_tet[v.index()] = true));
    let mut changed = Vec::new();
    for (i, was) in to_old.iter_mut().enumerate() {
        let vertex = VertexId::new(i);
        let is_same = |was: VertexId| !has_tet[i] || new.points[i] == old.points[was.index()];
        if !was.get().is_some_and(is_same) {
            changed.push(ChangedVertex { vertex, was: was.get() });
            *was = MaybeId::NONE;
        }
    }
    changed
}

/// The cells of one kind for which `picked` is true, with their labels.
fn labelled<const N: usize>(
    mesh: &Mesh,
    picked: &[bool],
    kind: CellKind,
    labels: Option<Labels>,
) -> Vec<Labelled<N>> {
    let of_kind = mesh.cells.iter().filter(|(cell, k, _)| *k == kind && picked[cell.index()]);
    let with_label = |(cell, _, vertices): (CellId, CellKind, &[VertexId])| {
        let label = labels.as_ref().map_or(0, |l| l.ids[cell.index()]);
        vertices.first_chunk::<N>().map(|&vertices| Labelled { cell, vertices, label })
    };
    of_kind.filter_map(with_label).collect()
}

fn check<I: Id>(to_old: &[MaybeId<I>], n_new: usize, n_old: usize, what: &str) -> Result<()> {
    if to_old.len() != n_new {
        return Err(Error::input(format!(
            "{} old ids were given, but the new mesh has {n_new} {what} ids",
            to_old.len()
        )));
    }
    let mut known = to_old.iter().enumerate().filter_map(|(new, old)| Some((new, old.get()?)));
    match known.find(|(_, old)| old.place() >= n_old) {
        None => Ok(()),
        Some((new, old)) => {
            Err(Error::input(format!("has the old id {old}, but the old mesh has only {n_old}"))
                .at(format!("{what} {new}")))
        }
    }
}

fn check_kinds(new: &Mesh, is_new: &[bool]) -> Result<()> {
    let can = |kind: CellKind| kind == CellKind::TETRA || kind == CellKind::TRIANGLE;
    match new.cells.iter().find(|(cell, kind, _)| is_new[cell.index()] && !can(*kind)) {
        None => Ok(()),
        Some((cell, kind, _)) => {
            Err(Error::input(format!("is a new {}, but only tets and triangles can be traced", kind.label()))
                .at(format!("cell {cell}"))
                .remedy("give the old cell that it comes from"))
        }
    }
}
