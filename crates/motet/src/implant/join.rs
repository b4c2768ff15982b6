//! Joins what is left of the host and everything new into one mesh, with its labels and arrays.

use super::layout::{Layout, Numbering, Pieces};
use super::names::{Names, label};
use super::origins::history;
use super::zone::Site;
use crate::base::{CellId, Result, Threads, absent};
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
    let layout = Layout::new(pieces);
    let numbering = Numbering::new(host, draft, &layout.cells);
    let points = numbering.to_draft.iter().map(|v| draft.points[v.index()]).collect();
    let mut mesh = Mesh::new(points, layout.cells.renumbered(&numbering.to_new));
    let history = history(pieces, &layout, &mesh, &numbering, threads)?;
    history.transfer(host, &mut mesh, rules)?;
    number_anew(&mut mesh, &absent(&numbering.kept), &absent(&layout.to_old));
    label(&mut mesh, pieces, &layout, &names);
    let zone_to_cell = draft.zone_to_site.iter().map(|site| match *site {
        Site::Host(t) => layout.host_to_cell[t],
        Site::New(i) => CellId::new(layout.n_host_cells + draft.triangles.len() + i),
    });
    let zone_to_cell = zone_to_cell.collect();
    Ok((Joined { mesh, history, zone_to_cell, first_new: CellId::new(layout.n_host_cells) }, names))
}

/// The total volume of the tets.
pub(super) fn volume_of(mesh: &Mesh) -> f64 {
    mesh.cells.tets().map(|(_, tet)| volume(tet.map(|v| mesh.points[v.index()])).abs()).sum()
}
