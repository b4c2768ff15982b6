//! The room between the carved host and the devices, and that within the devices, filled with tets; and whose each of them is.

use std::collections::{BTreeSet, VecDeque};

use super::carve::{Carved, Face};
use super::devices::Devices;
use super::options::{Inside, Options};
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::contact::inside;
use crate::delaunay::{Constrained, EdgePoints, constrain};
use crate::geometry::tet::{centroid, holds};
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

/// New tets. Vertices are those of the host, and behind them new ones.
#[derive(Debug, Default)]
pub(super) struct Gap {
    /// The new points.
    pub(super) points: Vec<Point>,
    pub(super) tets: Vec<[VertexId; 4]>,
    /// A region of the host, or a device, for each tet.
    pub(super) owners: Vec<Owner>,
    /// What became of the triangles of devices, and the triangle that each is, or is a part of.
    pub(super) triangles: Vec<([VertexId; 3], u32)>,
    /// Tets that devices came with, and the device of each.
    pub(super) own_tets: Vec<([VertexId; 4], u32)>,
    /// Faces of the room that lie in devices, and are there no more.
    pub(super) dropped: Vec<Face>,
}

/// Everything that the tets have to fit, over one list of points.
struct Frame {
    points: Vec<Point>,
    /// Triangles of the devices, then faces of the room.
    triangles: Vec<[VertexId; 3]>,
    faces: Vec<Face>,
    /// The vertex of the result that each point is.
    to_result: Vec<VertexId>,
}

impl Gap {
    /// `None` where a facet of a tet that stays would have to be divided.
    ///
    /// # Errors
    /// When there would be too many points, or triangles come too close to each other for the digits of their coordinates.
    pub(super) fn fill(
        host: &TetMesh,
        devices: &Devices,
        carved: &Carved,
        options: &Options,
        threads: &Threads,
    ) -> Result<Option<Self>> {
        let mut gap = Self { points: devices.points.clone(), ..Self::default() };
        let (faces, dropped) = faces_outside(host, devices, carved, threads);
        gap.dropped = dropped;
        let in_result = |v: VertexId| VertexId::new(host.points.len() + v.index());
        gap.own_tets = devices.own_tets.iter().map(|(tet, of)| (tet.map(in_result), *of)).collect();
        let frame = Frame::new(host, devices, faces);
        let grading = Grading { growth: options.growth, ..Grading::default() };
        let lattice = points_between(&frame.points, &frame.triangles, &grading, threads)?;
        let lattice = frame.needed(lattice, devices, threads);
        let all: Vec<Point> = frame.points.iter().chain(&lattice).copied().collect();
        let filled = constrain(&all, &frame.triangles, EdgePoints::MoveInside, threads)?;
        let n = devices.triangles.len();
        if (n..frame.triangles.len()).any(|t| filled.triangle_to_facets.list(t).len() != 1) {
            return Ok(None);
        }
        let within = within(devices, &frame, &filled);
        check_rooms(devices, &within)?;
        gap.take(&owners(host, carved, &frame, &filled, &within), host, devices, &frame, &filled);
        Ok(Some(gap))
    }

    fn take(
        &mut self,
        owners: &[Owner],
        host: &TetMesh,
        devices: &Devices,
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
        for t in 0..devices.triangles.len() {
            let parts = filled.triangle_to_facets.list(t).iter();
            self.triangles.extend(parts.map(|part| (part.map(|v| to_result[v.index()]), t as u32)));
        }
    }
}

/// The faces of the room; and those in devices, which go.
fn faces_outside(
    host: &TetMesh,
    devices: &Devices,
    carved: &Carved,
    threads: &Threads,
) -> (Vec<Face>, Vec<Face>) {
    // A face that bounds what stays cannot lie in a device.
    let is_asked = |face: &&Face| face.front.is_some();
    let mut points = devices.points.clone();
    points.extend(carved.faces.iter().filter(is_asked).map(|face| host.points[face.vertices[0].index()]));
    let queries: Vec<VertexId> = (devices.points.len()..points.len()).map(VertexId::new).collect();
    let mut is_inside = inside(&points, &queries, &[], &devices.triangles, &[], threads).into_iter();
    let is_outside = |face: &Face| face.front.is_none() || !is_inside.next().unwrap_or(false);
    carved.faces.iter().copied().partition(is_outside)
}

impl Frame {
    fn new(host: &TetMesh, devices: &Devices, faces: Vec<Face>) -> Self {
        let mut to_frame = vec![None; devices.points.len() + host.points.len()];
        let mut frame = Self { points: Vec::new(), triangles: Vec::new(), faces, to_result: Vec::new() };
        let n_host = host.points.len();
        // The result has the vertices of the host first.
        let mut add = |v: usize, frame: &mut Self| {
            *to_frame[v].get_or_insert_with(|| {
                let point = if v < n_host { host.points[v] } else { devices.points[v - n_host] };
                frame.points.push(point);
                frame.to_result.push(VertexId::new(v));
                VertexId::new(frame.points.len() - 1)
            })
        };
        for triangle in &devices.triangles {
            let triangle = triangle.map(|v| add(n_host + v.index(), &mut frame));
            frame.triangles.push(triangle);
        }
        for i in 0..frame.faces.len() {
            let triangle = frame.faces[i].vertices.map(|v| add(v.index(), &mut frame));
            frame.triangles.push(triangle);
        }
        frame
    }

    /// The points of a lattice that lie in the room, and not in devices that need none.
    fn needed(&self, lattice: Vec<Point>, devices: &Devices, threads: &Threads) -> Vec<Point> {
        let n = self.points.len();
        let mut points = self.points.clone();
        points.extend_from_slice(&lattice);
        let queries: Vec<VertexId> = (n..points.len()).map(VertexId::new).collect();
        let is_in = |surface: &[[VertexId; 3]]| inside(&points, &queries, &[], surface, &[], threads);
        let (of_devices, of_faces) = self.triangles.split_at(devices.triangles.len());
        let bounds = self.faces.iter().zip(of_faces).filter(|(face, _)| face.front.is_none());
        let mut is_needed = is_in(&bounds.map(|(_, triangle)| *triangle).collect::<Vec<_>>());
        for (device, _) in devices.insides.iter().enumerate().filter(|(_, inside)| **inside != Inside::Filled)
        {
            let is_of = |t: &usize| devices.of_triangle.list(*t).contains(&(device as u32));
            let own: Vec<_> = (0..of_devices.len()).filter(is_of).map(|t| of_devices[t]).collect();
            is_needed.iter_mut().zip(is_in(&own)).for_each(|(needed, is_in)| *needed &= !is_in);
        }
        lattice.into_iter().zip(is_needed).filter(|(_, is_needed)| *is_needed).map(|(p, _)| p).collect()
    }
}

/// The devices that each body lies in, rising; none where nobody can tell. Faces of the room lie outside of all; whoever crosses triangles of a device goes into it, or out.
fn within(devices: &Devices, frame: &Frame, filled: &Constrained) -> Vec<BTreeSet<u32>> {
    let n_bodies = filled.bodies.iter().max().map_or(0, |&b| b as usize + 1);
    let (of_devices, of_faces) = filled.triangle_to_bodies.split_at(devices.triangles.len());
    debug_assert_eq!(of_faces.len(), frame.faces.len());
    let mut beyond: Vec<Vec<(usize, u32)>> = vec![Vec::new(); n_bodies];
    for (t, sides) in of_devices.iter().enumerate() {
        if let [Some(front), Some(behind)] = *sides {
            beyond[front as usize].push((t, behind));
            beyond[behind as usize].push((t, front));
        }
    }
    let mut within: Vec<Option<BTreeSet<u32>>> = vec![None; n_bodies];
    let mut todo = VecDeque::new();
    for &body in of_faces.iter().flatten().flatten() {
        within[body as usize].get_or_insert_with(|| {
            todo.push_back(body);
            BTreeSet::new()
        });
    }
    while let Some(body) = todo.pop_front() {
        let here = within[body as usize].clone().unwrap_or_default();
        for &(t, other) in &beyond[body as usize] {
            within[other as usize].get_or_insert_with(|| {
                todo.push_back(other);
                &here ^ &devices.of_triangle.list(t).iter().copied().collect()
            });
        }
    }
    within.into_iter().map(Option::unwrap_or_default).collect()
}

/// Of devices within each other the last one has the room.
fn device_of(within: &BTreeSet<u32>) -> Option<u32> {
    within.last().copied()
}

/// Refuses devices that leave others no room.
fn check_rooms(devices: &Devices, within: &[BTreeSet<u32>]) -> Result<()> {
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
    match (0..devices.names.len() as u32).find(|k| !with_room.contains(k)) {
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
    let n_faces = frame.faces.len();
    let of_faces = &filled.triangle_to_bodies[filled.triangle_to_bodies.len() - n_faces..];
    for (face, [front, behind]) in frame.faces.iter().zip(of_faces) {
        let of_front = face.front.map_or(Owner::Taken, Owner::Host);
        for (body, owner) in [(front, of_front), (behind, Owner::Host(face.behind))] {
            if let Some(body) = *body {
                owners[body as usize] = Some(owner);
            }
        }
    }
    let of_host = |body| Owner::Host(region_at(host, carved, filled, body));
    owners.into_iter().enumerate().map(|(body, owner)| owner.unwrap_or_else(|| of_host(body))).collect()
}

/// The region of the host where a body lies that only devices bound.
fn region_at(host: &TetMesh, carved: &Carved, filled: &Constrained, body: usize) -> i32 {
    let first = filled.bodies.iter().position(|&b| b as usize == body);
    let place = first.map(|t| centroid(filled.tets[t].map(|v| filled.points[v.index()])));
    let is_there =
        |t: &usize| place.is_some_and(|place| holds(host.tets[*t].map(|v| host.points[v.index()]), place));
    carved.gone().find(is_there).map_or(0, |t| host.regions[t])
}
