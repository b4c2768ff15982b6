//! Joins what is left of the host and everything new into one mesh, with its labels and arrays.

use super::layout::{Laid, Numbers, Pieces};
use super::names::{Names, label};
use super::origins::history;
use super::zone::Site;
use crate::base::{CellId, Result, Threads};
use crate::geometry::tet::volume;
use crate::mesh::Mesh;
use crate::mesh::history::{History, Rules, number_anew};

/// The mesh, its history, and where the tets of the zone are in it.
pub(super) struct Joined {
    pub(super) mesh: Mesh,
    pub(super) history: History,
    /// The cell of each tet of the zone.
    pub(super) zone_to_cell: Vec<CellId>,
    /// The first new cell.
    pub(super) first_new: CellId,
}

/// Joins all pieces.
///
/// # Errors
/// When an array does not fit its rule.
pub(super) fn join(pieces: &Pieces, rules: &Rules, threads: &Threads) -> Result<(Joined, Names)> {
    let Pieces { host, devices, draft, .. } = *pieces;
    let names = Names::new(host, devices, &draft.triangles);
    let laid = Laid::new(pieces);
    let numbers = Numbers::new(host, draft, &laid.cells);
    let points = numbers.to_draft.iter().map(|v| draft.points[v.index()]).collect();
    let mut mesh = Mesh::new(points, laid.cells.renumbered(&numbers.to_new));
    let history = history(pieces, &laid, &mesh, &numbers, threads)?;
    history.transfer(host, &mut mesh, rules)?;
    let vertex_to_old: Vec<u32> = history.vertices.kept().iter().map(|v| v.0).collect();
    number_anew(&mut mesh, &vertex_to_old, &laid.to_old);
    label(&mut mesh, pieces, &laid, &names);
    let zone_to_cell = draft.of_zone.iter().map(|site| match *site {
        Site::Host(t) => laid.host_to_cell[t],
        Site::New(i) => CellId::new(laid.n_stay + draft.triangles.len() + i),
    });
    let zone_to_cell = zone_to_cell.collect();
    Ok((Joined { mesh, history, zone_to_cell, first_new: CellId::new(laid.n_stay) }, names))
}

/// The total volume of the tets.
pub(super) fn volume_of(mesh: &Mesh) -> f64 {
    mesh.cells.tets().map(|(_, tet)| volume(tet.map(|v| mesh.points[v.index()])).abs()).sum()
}
