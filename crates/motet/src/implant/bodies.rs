//! Finds the owner of each body of new tets.

use std::collections::{BTreeSet, VecDeque};

use super::carve::Carved;
use super::devices::Devices;
use super::frame::{DevicePositions, Frame};
use super::options::Inside;
use super::owner::Owner;
use crate::base::{Error, Result};
use crate::delaunay::Constrained;
use crate::geometry::tet::{centroid, holds, volume};
use crate::mesh::TetMesh;

/// For each body, the devices that it lies in; none if that cannot be determined. Bodies at faces of the
/// cavity lie outside of all devices, except at faces that were found within one; crossing triangles of a
/// device leads into it, or out of it. If no such face can be reached, what lies around the devices is
/// outside.
pub(super) fn within(devices: &Devices, frame: &Frame, filled: &Constrained) -> Vec<BTreeSet<u32>> {
    let n_bodies = filled.bodies.iter().max().map_or(0, |&b| b as usize + 1);
    let of = |t: u32| devices.of_triangle.list(t as usize).iter().copied().collect::<BTreeSet<u32>>();
    let mut beyond: Vec<Vec<(u32, u32)>> = vec![Vec::new(); n_bodies];
    let (mut starts, mut last) = (Vec::new(), Vec::new());
    for (wall, &[front, behind]) in frame.walls.iter().zip(&filled.triangle_to_bodies) {
        match (wall.device, front, behind) {
            (Some(t), Some(front), Some(behind)) => {
                beyond[front as usize].push((t, behind));
                beyond[behind as usize].push((t, front));
            }
            // A hollow device may be open to everything around it.
            (Some(t), Some(body), None) | (Some(t), None, Some(body))
                if of(t).iter().all(|k| devices.insides[*k as usize] != Inside::Hollow) =>
            {
                last.push((body, of(t)));
            }
            (None, ..) if wall.within.is_none() => {
                starts.extend([front, behind].into_iter().flatten().map(|body| (body, BTreeSet::new())));
            }
            _ => {}
        }
    }
    let mut within: Vec<Option<BTreeSet<u32>>> = vec![None; n_bodies];
    for (body, room) in starts.into_iter().chain(last) {
        let mut todo = VecDeque::from([(body, room)]);
        while let Some((body, room)) = todo.pop_front() {
            if within[body as usize].is_none() {
                todo.extend(beyond[body as usize].iter().map(|&(t, other)| (other, &room ^ &of(t))));
                within[body as usize] = Some(room);
            }
        }
    }
    within.into_iter().map(Option::unwrap_or_default).collect()
}

/// The owner of a body, given the devices that it lies in: of devices within each other, the last one.
fn device_of(within: &BTreeSet<u32>) -> Option<u32> {
    within.last().copied()
}

/// Refuses devices that leave others no space.
pub(super) fn check_rooms(
    devices: &Devices,
    positions: &DevicePositions,
    within: &[BTreeSet<u32>],
) -> Result<()> {
    let name = |k: u32| &devices.names[k as usize];
    for room in within.iter().filter(|room| room.len() > 1) {
        if let Some(own) = room.iter().find(|k| devices.insides[**k as usize] == Inside::Own) {
            let other = room.iter().find(|k| *k != own).copied().unwrap_or_default();
            let what =
                format!("the device `{}` keeps its tets, but `{}` lies inside it", name(*own), name(other));
            return Err(Error::input(what)
                .at(format!("device {own}"))
                .remedy("make devices that contain others filled, and give each device only once"));
        }
    }
    let with_room: BTreeSet<u32> = within.iter().filter_map(device_of).collect();
    // A hollow device that passes through the boundary is open to what lies outside.
    let is_open =
        |k: u32| devices.insides[k as usize] == Inside::Hollow && positions.crosses_boundary[k as usize];
    match (0..devices.names.len() as u32).find(|&k| !with_room.contains(&k) && !is_open(k)) {
        None => Ok(()),
        Some(k) => Err(Error::input(format!("later devices take all the space of the device `{}`", name(k)))
            .at(format!("device {k}"))
            .remedy("give each device only once, and those that contain others first")),
    }
}

/// The owner of each body: a device, or what the faces of the cavity say.
pub(super) fn owners(
    host: &TetMesh,
    carved: &Carved,
    frame: &Frame,
    filled: &Constrained,
    within: &[BTreeSet<u32>],
) -> Vec<Owner> {
    let mut owners: Vec<Option<Owner>> =
        within.iter().map(|room| device_of(room).map(Owner::Device)).collect();
    for (wall, [front, behind]) in frame.walls.iter().zip(&filled.triangle_to_bodies) {
        let Some(face) = wall.face.map(|f| &carved.faces[f as usize]) else { continue };
        let of_front = face.front.map_or(Owner::Unfilled, Owner::Host);
        for (body, owner) in [(front, of_front), (behind, Owner::Host(face.behind))] {
            let Some(body) = *body else { continue };
            let known = &mut owners[body as usize];
            // A device ends at a wall that lies in it.
            let is_end = wall.within.is_some() && owner == Owner::Unfilled;
            if is_end || !matches!(known, Some(Owner::Device(_))) {
                *known = Some(owner);
            }
        }
    }
    let of_host = |body| region_at(host, carved, filled, body).map_or(Owner::Unfilled, Owner::Host);
    owners.into_iter().enumerate().map(|(body, owner)| owner.unwrap_or_else(|| of_host(body))).collect()
}

/// The region of the host in which a body bounded only by devices lies, by its largest tet; `None` outside of
/// what was carved.
fn region_at(host: &TetMesh, carved: &Carved, filled: &Constrained, body: usize) -> Option<i32> {
    let corners = |t: usize| filled.tets[t].map(|v| filled.points[v.index()]);
    let of_body = (0..filled.tets.len()).filter(|&t| filled.bodies[t] as usize == body);
    let largest = of_body.max_by(|&t, &u| volume(corners(t)).total_cmp(&volume(corners(u))))?;
    let place = centroid(corners(largest));
    let is_there = |t: &usize| holds(host.tets[*t].map(|v| host.points[v.index()]), place);
    carved.removed().find(is_there).map(|t| host.regions[t])
}
