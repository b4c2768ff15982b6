//! Stores the memory of a refined mesh as arrays of its file.

use super::super::memory::Memory;
use crate::base::{CellId, Error, Point, Result, TetId};
use crate::mesh::history::REFINE_ROOT;
use crate::mesh::{Field, Mesh, TetPart, Values};

const PATH: &str = "refine_path";
const PIECE: &str = "refine_piece";
const ASKED: &str = "refine_asked";
const REFERENCE: &str = "refine_reference";
const OF_CELLS: [&str; 4] = [REFINE_ROOT, PATH, PIECE, ASKED];

/// Reads the memory from the arrays of a mesh; `None` if it has none of them.
pub(super) fn memory(mesh: &Mesh, part: &TetPart) -> Result<Option<Memory>> {
    let is_there = OF_CELLS.map(|name| mesh.cell_field(name).is_some());
    let reference = mesh.point_field(REFERENCE);
    if !is_there.contains(&true) && reference.is_none() {
        return Ok(None);
    }
    let whole = |name: &str| -> Result<Vec<i64>> {
        let field = mesh.cell_field(name).ok_or_else(|| unfit(name, "is missing"))?;
        let values = field.values.to_i64().filter(|_| field.components == 1);
        values.ok_or_else(|| unfit(name, "is not an array of integers"))
    };
    let [roots, paths, pieces, n_requested] =
        [whole(REFINE_ROOT)?, whole(PATH)?, whole(PIECE)?, whole(ASKED)?];
    let reference = reference.ok_or_else(|| unfit(REFERENCE, "is missing"))?;
    let reference: Vec<Point> =
        reference.to_vectors().map_err(|_| unfit(REFERENCE, "does not have three components per point"))?;
    let tets = || part.tet_to_cell.iter().map(|cell| cell.index());
    Ok(Some(Memory {
        roots: tets().map(|c| u32::try_from(roots[c]).ok().map(TetId).into()).collect(),
        paths: tets().map(|c| u64::try_from(paths[c]).unwrap_or(0)).collect(),
        pieces: tets().map(|c| u16::try_from(pieces[c]).unwrap_or(u16::MAX)).collect(),
        n_requested: tets().map(|c| u8::try_from(n_requested[c]).unwrap_or(0)).collect(),
        corners: part.triangle_to_cell.iter().map(|c| u8::try_from(pieces[c.index()]).unwrap_or(0)).collect(),
        reference,
    }))
}

fn unfit(array: &str, what: &str) -> Error {
    Error::input(format!("array '{array}', which remembers how the mesh was refined, {what}"))
        .remedy("remove all arrays refine_*: the mesh then counts as unrefined")
}

/// Adds the arrays of the memory. Cells that are neither tet nor triangle get -1.
pub(super) fn store(mesh: &mut Mesh, memory: &Memory, tets: &[CellId], triangles: &[CellId]) {
    let n = mesh.cells.len();
    let mut whole = [vec![-1; n], vec![-1; n], vec![-1; n]];
    let mut paths = vec![-1; n];
    for (t, cell) in tets.iter().map(|cell| cell.index()).enumerate() {
        whole[0][cell] = memory.roots[t].get().map_or(-1, |root| root.0 as i32);
        whole[1][cell] = i32::from(memory.pieces[t]);
        whole[2][cell] = i32::from(memory.n_requested[t]);
        paths[cell] = memory.paths[t] as i64;
    }
    for (cell, corner) in triangles.iter().zip(&memory.corners) {
        whole[1][cell.index()] = i32::from(*corner);
    }
    let [roots, pieces, n_requested] = whole;
    let values: [Values; 4] = [roots.into(), paths.into(), pieces.into(), n_requested.into()];
    for (name, values) in OF_CELLS.into_iter().zip(values) {
        mesh.set_cell_field(Field::scalars(name, values));
    }
    mesh.set_point_field(Field::vectors(REFERENCE, &memory.reference));
}

/// Returns the mesh without the arrays of the memory.
pub(super) fn without(mesh: &Mesh) -> Mesh {
    let mut mesh = mesh.clone();
    mesh.cell_data.retain(|field| !OF_CELLS.contains(&field.name.as_str()));
    mesh.point_data.retain(|field| field.name != REFERENCE);
    mesh
}
