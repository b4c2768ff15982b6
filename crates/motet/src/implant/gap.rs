//! The room between the carved host and the devices, and that within the devices, filled with tets; and whose each of them is.

use std::collections::{BTreeSet, HashMap, VecDeque};

use super::carve::{Carved, Face};
use super::devices::{Devices, OwnTet};
use super::frame::{Frame, Sites};
use super::options::{Inside, Options, Outside};
use super::place::check_left;
use crate::base::{Error, Point, Result, Threads, VertexId, rising};
use crate::contact::inside;
use crate::delaunay::{Constrained, EdgePoints, constrain};
use crate::geometry::tet::{centroid, holds, volume};
use crate::mesh::TetMesh;
use crate::meshing::{Grading, points_between};

/// What a body of new tets belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    /// A region of the host.
    Host(i32),
    /// A device, by its number.
    Device(u32),
    /// Tets of the host that stay, or nothing.
    Taken,
}

/// What a triangle that came is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Patch {
    /// The surface of a device.
    Device(u32),
    /// What a device and a wall of the host have in common.
    Contact(u32),
    /// A triangle of the host, by its patch.
    Host(i32),
    /// A wall of the host without triangles.
    Bare,
}

/// New tets. Vertices are those of the host, and behind them new ones.
#[derive(Debug, Default)]
pub(super) struct Gap {
    /// The new points.
    pub(super) points: Vec<Point>,
    pub(super) tets: Vec<[VertexId; 4]>,
    /// A region of the host, or a device, for each tet.
    pub(super) owners: Vec<Owner>,
    /// Triangles that came.
    pub(super) triangles: Vec<([VertexId; 3], Patch)>,
    /// Tets that devices came with.
    pub(super) own_tets: Vec<OwnTet>,
    /// Faces of the room that are not there any more, or not as they were.
    pub(super) dropped: Vec<Face>,
    /// Vertices of walls that may move or go, since they lie where a device meets a wall.
    pub(super) loose: BTreeSet<VertexId>,
    /// How devices lie to walls.
    pub(super) sites: Sites,
    /// What vertices of devices are called.
    pub(super) names: Vec<VertexId>,
}

impl Gap {
    /// `None` where a facet of a tet that stays would have to be divided.
    ///
    /// # Errors
    /// When there would be too many points, or triangles come too close to each other for the digits of their coordinates; when devices lie outside.
    pub(super) fn fill(
        host: &TetMesh,
        devices: &Devices,
        carved: &Carved,
        options: &Options,
        threads: &Threads,
    ) -> Result<Option<Self>> {
        let frame = Frame::new(host, devices, carved, options.outside, threads)?;
        let lattice = lattice(host, devices, carved, options, threads)?;
        let all: Vec<Point> = frame.points.iter().chain(&lattice).copied().collect();
        let filled = constrain(&all, &frame.triangles, EdgePoints::MoveInside, threads)?;
        let is_divided = |t: &usize| {
            let wall = &frame.walls[*t];
            wall.device.is_none() && wall.is_fixed && filled.triangle_to_facets.list(*t).len() != 1
        };
        if (0..frame.walls.len()).any(|t| is_divided(&t)) {
            return Ok(None);
        }
        let within = within(devices, &frame, &filled);
        check_rooms(devices, &frame.sites, &within)?;
        let owners = owners(host, carved, &frame, &filled, &within);
        let is_left = owners.iter().any(|owner| matches!(owner, Owner::Host(_)));
        check_left(devices, is_left || carved.gone().count() < host.tets.len())?;
        let mut gap = Self { points: devices.points.clone(), ..Self::default() };
        gap.points.extend(&frame.came);
        gap.own_tets.clone_from(&devices.own_tets);
        gap.own_tets.iter_mut().for_each(|tet| tet.vertices = tet.vertices.map(|v| frame.names[v.index()]));
        gap.take(&owners, host, devices, carved, &frame, &filled);
        (gap.dropped, gap.sites, gap.loose) = (frame.dropped, frame.sites, frame.loose);
        gap.names = frame.names;
        Ok(Some(gap))
    }

    fn take(
        &mut self,
        owners: &[Owner],
        host: &TetMesh,
        devices: &Devices,
        carved: &Carved,
        frame: &Frame,
        filled: &Constrained,
    ) {
        let is_wanted = |owner: Owner| match owner {
            Owner::Host(_) => true,
            Owner::Device(k) => devices.insides[k as usize] == Inside::Filled,
            Owner::Taken => false,
        };
        let mut to_result = frame.to_result.clone();
        for point in &filled.points[frame.points.len()..] {
            to_result.push(VertexId::new(host.points.len() + self.points.len()));
            self.points.push(*point);
        }
        for (tet, &body) in filled.tets.iter().zip(&filled.bodies) {
            let owner = owners[body as usize];
            if is_wanted(owner) {
                self.tets.push(tet.map(|v| to_result[v.index()]));
                self.owners.push(owner);
            }
        }
        let patches: HashMap<[VertexId; 3], i32> =
            host.triangles.iter().map(|t| rising(*t)).zip(host.patches.iter().copied()).collect();
        let is_solid = |owner: Owner| match owner {
            Owner::Device(k) => devices.insides[k as usize] != Inside::Hollow,
            owner => is_wanted(owner),
        };
        for (t, wall) in frame.walls.iter().enumerate() {
            let first = wall.device.map(|t| devices.of_triangle.list(t as usize)[0]);
            let of_face = || {
                let face = wall.face.map(|f| rising(carved.faces[f as usize].vertices));
                face.and_then(|face| patches.get(&face)).map_or(Patch::Bare, |patch| Patch::Host(*patch))
            };
            let patch = match (first, wall.within) {
                (Some(k), _) if wall.face.is_none() => Patch::Device(k),
                (Some(k), _) | (None, Some(k)) => Patch::Contact(k),
                (None, None) if wall.is_fixed => continue,
                (None, None) => of_face(),
            };
            let mut sides = filled.triangle_to_bodies[t].iter().flatten();
            if sides.any(|&body| is_solid(owners[body as usize])) {
                let parts = filled.triangle_to_facets.list(t).iter();
                self.triangles.extend(parts.map(|part| (part.map(|v| to_result[v.index()]), patch)));
            }
        }
    }
}

/// Points in the room, and in devices that are filled, as the surfaces ask for them before they were divided.
fn lattice(
    host: &TetMesh,
    devices: &Devices,
    carved: &Carved,
    options: &Options,
    threads: &Threads,
) -> Result<Vec<Point>> {
    let mut points = devices.points.clone();
    let mut to_new: HashMap<VertexId, VertexId> = HashMap::new();
    let mut of = |v: VertexId| {
        *to_new.entry(v).or_insert_with(|| {
            points.push(host.points[v.index()]);
            VertexId::new(points.len() - 1)
        })
    };
    let faces: Vec<[VertexId; 3]> = carved.faces.iter().map(|face| face.vertices.map(&mut of)).collect();
    let triangles: Vec<[VertexId; 3]> = devices.triangles.iter().chain(&faces).copied().collect();
    let grading = Grading { growth: options.growth, ..Grading::default() };
    let lattice = points_between(&points, &triangles, &grading, threads)?;
    let first = points.len();
    points.extend_from_slice(&lattice);
    let queries: Vec<VertexId> = (first..points.len()).map(VertexId::new).collect();
    let is_in = |surface: &[[VertexId; 3]]| inside(&points, &queries, &[], surface, &[], threads);
    let bounds = carved.faces.iter().zip(&faces).filter(|(face, _)| face.front.is_none());
    let mut is_needed = is_in(&bounds.map(|(_, triangle)| *triangle).collect::<Vec<_>>());
    for (k, inside) in devices.insides.iter().enumerate() {
        let is_filled = *inside == Inside::Filled;
        if is_filled && options.outside == Outside::Cut {
            continue;
        }
        let is_of = |t: &usize| devices.of_triangle.list(*t).contains(&(k as u32));
        let own: Vec<_> = (0..devices.triangles.len()).filter(is_of).map(|t| devices.triangles[t]).collect();
        for (needed, is_in) in is_needed.iter_mut().zip(is_in(&own)) {
            *needed = if is_filled { *needed || is_in } else { *needed && !is_in };
        }
    }
    Ok(lattice.into_iter().zip(is_needed).filter(|(_, is_needed)| *is_needed).map(|(p, _)| p).collect())
}

/// The devices that each body lies in, rising; none where nobody can tell. Faces of the room lie outside of all, but those that were found within one; whoever crosses
/// triangles of a device goes into it, or out. Where no such face is near, all round lies outside.
fn within(devices: &Devices, frame: &Frame, filled: &Constrained) -> Vec<BTreeSet<u32>> {
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
            // A hollow device may be open to all round.
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

/// Of devices within each other the last one has the room.
fn device_of(within: &BTreeSet<u32>) -> Option<u32> {
    within.last().copied()
}

/// Refuses devices that leave others no room.
fn check_rooms(devices: &Devices, sites: &Sites, within: &[BTreeSet<u32>]) -> Result<()> {
    let name = |k: u32| &devices.names[k as usize];
    for room in within.iter().filter(|room| room.len() > 1) {
        if let Some(own) = room.iter().find(|k| devices.insides[**k as usize] == Inside::Own) {
            let other = room.iter().find(|k| *k != own).copied().unwrap_or_default();
            let what =
                format!("the device `{}` keeps its tets, and `{}` lies in its room", name(*own), name(other));
            return Err(Error::input(what)
                .at(format!("device {own}"))
                .remedy("let devices that hold others be filled, and give each device once"));
        }
    }
    let with_room: BTreeSet<u32> = within.iter().filter_map(device_of).collect();
    // A hollow device that goes through the boundary is open to what lies outside.
    let is_open = |k: u32| devices.insides[k as usize] == Inside::Hollow && sites.is_through[k as usize];
    match (0..devices.names.len() as u32).find(|&k| !with_room.contains(&k) && !is_open(k)) {
        None => Ok(()),
        Some(k) => {
            Err(Error::input(format!("all the room of the device `{}` is that of later ones", name(k)))
                .at(format!("device {k}"))
                .remedy("give each device once, those that hold others first"))
        }
    }
}

/// Whose each body is: a device's, or as the faces of the room say.
fn owners(
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
        let of_front = face.front.map_or(Owner::Taken, Owner::Host);
        for (body, owner) in [(front, of_front), (behind, Owner::Host(face.behind))] {
            let Some(body) = *body else { continue };
            let known = &mut owners[body as usize];
            // A device ends at a wall that lies in it.
            let is_end = wall.within.is_some() && owner == Owner::Taken;
            if is_end || !matches!(known, Some(Owner::Device(_))) {
                *known = Some(owner);
            }
        }
    }
    let of_host = |body| region_at(host, carved, filled, body).map_or(Owner::Taken, Owner::Host);
    owners.into_iter().enumerate().map(|(body, owner)| owner.unwrap_or_else(|| of_host(body))).collect()
}

/// The region of the host where a body lies that only devices bound, by its largest tet; `None` outside of what was carved.
fn region_at(host: &TetMesh, carved: &Carved, filled: &Constrained, body: usize) -> Option<i32> {
    let corners = |t: usize| filled.tets[t].map(|v| filled.points[v.index()]);
    let of_body = (0..filled.tets.len()).filter(|&t| filled.bodies[t] as usize == body);
    let largest = of_body.max_by(|&t, &u| volume(corners(t)).total_cmp(&volume(corners(u))))?;
    let place = centroid(corners(largest));
    let is_there = |t: &usize| holds(host.tets[*t].map(|v| host.points[v.index()]), place);
    carved.gone().find(is_there).map(|t| host.regions[t])
}
