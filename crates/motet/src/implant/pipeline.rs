//! The whole implantation, step by step.

use std::collections::HashSet;
use std::time::Instant;

use super::adapt::adapt;
use super::carve::{Carved, Fate};
use super::devices::{Devices, surface};
use super::fill::{Filled, Gap};
use super::frame::Position;
use super::join::{Joined, join, volume_of};
use super::layout::Pieces;
use super::names::Names;
use super::options::{Device, Inside, Interface, Options, Outside};
use super::place::format_point;
use super::report::{DeviceReport, Fit, Report};
use super::resurface::resurface;
use super::starts;
use super::zone::Draft;
use crate::base::{CellId, Error, Result, TetId, Threads, VertexId, sorted_ids};
use crate::geometry::triangle::centroid;
use crate::mesh::check::{Defect, check};
use crate::mesh::history::{Changed, Rules};
use crate::mesh::{Mesh, TetPart};
use crate::meshing;
use crate::remesh;
use crate::spatial::NearestTriangle;

/// How often more of the host is carved around facets that stay but would have to be divided.
const RETRIES: usize = 8;

/// How far surfaces may stray where devices meet walls, as a fraction of the device's edge length.
const STRAY: f64 = 0.05;

/// Puts devices into a mesh of tets: every triangle of the devices is a facet of the result, and every tet of
/// the host beyond [`Options::reach`] stays, to the bit. Arrays are carried by `rules`.
///
/// In the result, cells of the host that stayed come first, in the order that they had; then triangles of the
/// devices, new tets, and tets that devices kept. What lies in a device comes from the host's tets there.
///
/// # Errors
/// When the host has no tets, or the devices are not closed surfaces without fault; when a device that keeps
/// its tets meets a wall, or any device lies outside of the host or contains it; when a number is out of
/// range, or asks for too many points.
pub fn implant(
    host: &Mesh,
    devices: &[Device],
    options: &Options,
    rules: &Rules,
    threads: &Threads,
) -> Result<Changed<Report>> {
    options.check()?;
    if devices.is_empty() {
        return Err(Error::options("there is no device to put in").remedy("give at least one device"));
    }
    let mut watch = Instant::now();
    let mut lap = || std::mem::replace(&mut watch, Instant::now()).elapsed().as_secs_f64();
    let mut report = Report::default();
    // Reports early what is no host.
    TetPart::of(host)?;
    starts::check(host, &options.starts)?;
    let (devices, fits) = &with_surfaces(devices, options, threads)?;
    let joined = Devices::join(devices, threads)?;
    report.seconds.devices = lap();

    let size = options.size.unwrap_or_else(|| joined.size());
    let adapted = adapt(host, &joined, size, options, rules, threads)?;
    let (host_now, before) = match &adapted {
        Some((mesh, history, _)) => (mesh, Some(history)),
        None => (host, None),
    };
    report.adapted = adapted.as_ref().map(|adapted| adapted.2);
    report.seconds.adapt = lap();

    let part = TetPart::of(host_now)?.with_lines_held();
    let (carved, gap) = carve_and_fill(&part, &joined, options, threads, &mut report, &mut lap)?;
    report.carved = carved.fates.iter().filter(|fate| **fate == Fate::Removed).count();

    let mut draft = Draft::new(&part.mesh, &carved, &gap);
    let stray = options.stray.unwrap_or_else(|| STRAY * joined.size());
    let improved = draft.improve(&part.mesh, &carved, &gap, &options.improve, stray, threads)?;
    report.kept = draft.is_removed.iter().filter(|is_removed| !**is_removed).count();
    report.host_tets = part.mesh.tets.len();
    report.kept_share = report.kept as f64 / report.host_tets.max(1) as f64;
    report.seconds.improve = lap();

    let pieces = Pieces { host: host_now, part: &part, devices: &joined, gap: &gap, draft: &draft };
    let (Joined { mut mesh, history, zone_to_cell, first_new }, names) = join(&pieces, rules, threads)?;
    starts::set(&mut mesh, &draft, gap.own_tets.len(), &options.starts);
    let history = before.map_or_else(|| history.clone(), |before| before.then(&history));
    report.seconds.join = lap();

    report_improved(&mut report, improved, &zone_to_cell, first_new);
    report.regions = meshing::bodies_of_mesh(&mesh);
    certify(&mut report, host, devices, &pieces, &mesh, &names, options.outside);
    report.devices.iter_mut().zip(fits).for_each(|(device, fit)| device.fit = *fit);
    report.seconds.check = lap();
    if !report.is_valid() {
        let defects: Vec<String> = report.defects.iter().map(Defect::to_string).collect();
        return Err(Error::input(format!("the result is not a valid mesh: {}", defects.join(", "))).remedy(
            "check the host with `motet info`; if the host is valid, please report this to the authors of \
             motet",
        ));
    }
    Ok(Changed { mesh, history, report })
}

/// The devices with the surfaces that they are put in with, and how well new surfaces fit.
fn with_surfaces(
    devices: &[Device],
    options: &Options,
    threads: &Threads,
) -> Result<(Vec<Device>, Vec<Option<Fit>>)> {
    let Interface::Conform { tolerance } = options.interface else {
        return Ok((devices.to_vec(), vec![None; devices.len()]));
    };
    let new = |device: &Device| {
        let made = resurface(surface(device), &device.name, tolerance, options.size, threads)?;
        let inside = if device.inside == Inside::Hollow { Inside::Hollow } else { Inside::Filled };
        let device = Device { mesh: made.mesh, name: device.name.clone(), inside };
        Ok((device, Some(made.fit)))
    };
    devices.iter().map(new).collect()
}

/// Carves the host as far as necessary, and fills the cavity.
fn carve_and_fill(
    part: &TetPart,
    devices: &Devices,
    options: &Options,
    threads: &Threads,
    report: &mut Report,
    lap: &mut impl FnMut() -> f64,
) -> Result<(Carved, Gap)> {
    let nearest = NearestTriangle::new(&devices.points, &devices.triangles, threads);
    let mut carved = Carved::new(&part.mesh, devices, &nearest, options, threads);
    let mut divided = Vec::new();
    for _ in 0..=RETRIES {
        threads.watch().report_and_check("making space for devices", 0, 0)?;
        carved.check_overlaps(&part.mesh, threads)?;
        report.seconds.carve += lap();
        let filled = Gap::fill(&part.mesh, devices, &carved, options, threads)?;
        report.seconds.fill += lap();
        divided = match filled {
            Filled::Done(gap) => return Ok((carved, *gap)),
            Filled::WouldDivide(faces) => faces,
        };
        if !carved.remove_around(&part.mesh, &divided) {
            break;
        }
    }
    let place = divided.first().map(|face| centroid(face.map(|v| part.mesh.points[v.index()])));
    Err(Error::input(format!(
        "the space between the host and the devices could not be filled without dividing {} facets that must \
         stay",
        divided.len()
    ))
    .at(place.map_or_else(String::new, |place| format!("one at {}", format_point(place))))
    .remedy(
        "carve farther (--carve) and reach farther (--reach), or refine the host there first (--adapt all, \
         --size)",
    ))
}

/// Reports what was improved by cells, with bad tets of the host apart from new ones.
fn report_improved(
    report: &mut Report,
    mut improved: remesh::Report<TetId>,
    zone_to_cell: &[CellId],
    first_new: CellId,
) {
    // These tets were never part of a mesh that the user saw.
    improved.before.worst = None;
    let cell = |tet: TetId| zone_to_cell[tet.index()];
    report.improved = improved.in_cells(cell, cell);
    (report.host_left, report.improved.left) =
        std::mem::take(&mut report.improved.left).into_iter().partition(|left| left.tet < first_new);
}

/// Reports volumes, how many triangles of each device were kept, and the defects of the result `mesh`. `host`
/// is the mesh as it was given.
fn certify(
    report: &mut Report,
    host: &Mesh,
    devices: &[Device],
    pieces: &Pieces<'_>,
    mesh: &Mesh,
    names: &Names,
    outside: Outside,
) {
    let Pieces { devices: joined, gap, draft, .. } = *pieces;
    report.tets = mesh.cells.tets().count();
    let whole = joined.volumes(devices);
    let is_there: HashSet<[VertexId; 3]> = draft.triangles.iter().map(|(t, _)| sorted_ids(*t)).collect();
    let is_kept =
        |t: usize| is_there.contains(&sorted_ids(joined.triangles[t].map(|v| gap.names[v.index()])));
    report.volume_expected = volume_of(host);
    for (k, device) in devices.iter().enumerate() {
        let own = joined.triangles_of(k);
        let regions = names.regions[k].clone();
        let bodies = report.regions.iter().filter(|body| regions.contains(&body.region));
        let volume = bodies.map(|body| body.volume).sum();
        let inside = if gap.positions.crosses_boundary[k] { gap.positions.volumes[k] } else { whole[k] };
        let n_at = |position: Position| {
            own.clone().filter(|&t| gap.positions.of_triangle[t] == position && !is_kept(t)).count()
        };
        match (device.inside, outside) {
            (Inside::Hollow, _) => report.volume_expected -= inside,
            (_, Outside::Keep) => report.volume_expected += whole[k] - inside,
            (_, Outside::Cut) => {}
        }
        report.devices.push(DeviceReport {
            name: device.name.clone(),
            regions,
            patch: names.patches[k],
            triangles: own.clone().count(),
            triangles_kept: own.clone().filter(|&t| is_kept(t)).count(),
            triangles_at_walls: n_at(Position::AtWall),
            triangles_outside: n_at(Position::Outside),
            contact_patch: names.contacts[k],
            fit: None,
            enclosed: if outside == Outside::Cut { inside } else { whole[k] },
            volume,
        });
    }
    report.volume = volume_of(mesh);
    report.defects = check(mesh);
}
