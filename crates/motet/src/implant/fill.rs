//! Fills the space between the carved host and the devices, and that within the devices, with tets, and finds
//! their owners.

use std::collections::{BTreeSet, HashMap};

use super::bodies::{check_rooms, owners, within};
use super::carve::{Carved, Face};
use super::devices::{Devices, OwnTet};
use super::frame::{DevicePositions, Frame};
use super::lattice::lattice;
use super::options::{Inside, Options};
use super::owner::{Owner, Patch};
use super::place::check_left;
use crate::base::{Point, Result, Threads, VertexId, sorted_ids};
use crate::delaunay::{Constrained, EdgePoints, constrain};
use crate::mesh::{TetMesh, firsts_at_place};

/// New tets. Vertices are those of the host, then new ones.
#[derive(Debug, Default)]
pub(super) struct Gap {
    /// The new points.
    pub(super) points: Vec<Point>,
    pub(super) tets: Vec<[VertexId; 4]>,
    /// The owner of each tet: a region of the host, or a device.
    pub(super) owners: Vec<Owner>,
    /// New triangles.
    pub(super) triangles: Vec<([VertexId; 3], Patch)>,
    /// Tets that devices keep.
    pub(super) own_tets: Vec<OwnTet>,
    /// Faces of the cavity that no longer exist, or not as they were.
    pub(super) dropped: Vec<Face>,
    /// Vertices of walls that may move or be removed, since they lie where a device meets a wall.
    pub(super) loose: BTreeSet<VertexId>,
    /// Where devices lie relative to walls.
    pub(super) positions: DevicePositions,
    /// The vertex that each vertex of the devices is now.
    pub(super) names: Vec<VertexId>,
}

/// The result of filling the cavity.
pub(super) enum Filled {
    Done(Box<Gap>),
    /// These faces would have to be divided.
    WouldDivide(Vec<[VertexId; 3]>),
}

impl Gap {
    /// Fills the cavity, or returns those of its faces that would have to be divided although tets beside
    /// them stay.
    ///
    /// # Errors
    /// When there would be too many points, or triangles come too close to each other for the digits of their
    /// coordinates; when devices lie outside.
    pub(super) fn fill(
        host: &TetMesh,
        devices: &Devices,
        carved: &Carved,
        options: &Options,
        threads: &Threads,
    ) -> Result<Filled> {
        let frame = Frame::new(host, devices, carved, options.outside, threads)?;
        let lattice = lattice(host, devices, carved, options, threads)?;
        let all: Vec<Point> = frame.points.iter().chain(&lattice).copied().collect();
        let filled = constrain(&all, &frame.triangles, EdgePoints::MoveInside, threads)?;
        let divided = (0..frame.walls.len()).filter(|&t| is_divided(&frame, &filled, t));
        let divided: Vec<_> = divided.filter_map(|t| frame.walls[t].face).collect();
        if !divided.is_empty() {
            return Ok(Filled::WouldDivide(
                divided.iter().map(|&f| carved.faces[f as usize].vertices).collect(),
            ));
        }
        let within = within(devices, &frame, &filled);
        check_rooms(devices, &frame.positions, &within)?;
        let owners = owners(host, carved, &frame, &filled, &within);
        let is_left = owners.iter().any(|owner| matches!(owner, Owner::Host(_)));
        check_left(devices, is_left || carved.removed().count() < host.tets.len())?;
        let mut gap = Self { points: devices.points.clone(), ..Self::default() };
        gap.points.extend(&frame.new_points);
        gap.own_tets.clone_from(&devices.own_tets);
        gap.own_tets.iter_mut().for_each(|tet| tet.vertices = tet.vertices.map(|v| frame.names[v.index()]));
        gap.take(&owners, host, devices, carved, &frame, &filled);
        (gap.dropped, gap.positions, gap.loose) = (frame.dropped, frame.positions, frame.loose);
        gap.names = frame.names;
        Ok(Filled::Done(Box::new(gap)))
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
            Owner::Unfilled => false,
        };
        let mut to_result = frame.to_result.clone();
        // A point on an edge may have been rounded onto its end: then it becomes that vertex.
        let firsts = firsts_at_place(&filled.points);
        for (v, point) in filled.points.iter().enumerate().skip(frame.points.len()) {
            if firsts[v].index() < v {
                to_result.push(to_result[firsts[v].index()]);
                continue;
            }
            to_result.push(VertexId::new(host.points.len() + self.points.len()));
            self.points.push(*point);
        }
        for (tet, &body) in filled.tets.iter().zip(&filled.bodies) {
            let owner = owners[body as usize];
            let tet = tet.map(|v| to_result[v.index()]);
            if is_wanted(owner) && are_distinct(tet) {
                self.tets.push(tet);
                self.owners.push(owner);
            }
        }
        let patches: HashMap<[VertexId; 3], i32> =
            host.triangles.iter().map(|t| sorted_ids(*t)).zip(host.patches.iter().copied()).collect();
        let is_solid = |owner: Owner| match owner {
            Owner::Device(k) => devices.insides[k as usize] != Inside::Hollow,
            owner => is_wanted(owner),
        };
        for (t, wall) in frame.walls.iter().enumerate() {
            let first = wall.device.map(|t| devices.of_triangle.list(t as usize)[0]);
            let of_face = || {
                let face = wall.face.map(|f| sorted_ids(carved.faces[f as usize].vertices));
                face.and_then(|face| patches.get(&face))
                    .map_or(Patch::Unlabelled, |patch| Patch::Host(*patch))
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
                let parts = parts.map(|part| part.map(|v| to_result[v.index()]));
                self.triangles.extend(parts.filter(|part| are_distinct(*part)).map(|part| (part, patch)));
            }
        }
    }
}

/// Whether a facet or an edge of what stays of the host would be divided.
fn is_divided(frame: &Frame, filled: &Constrained, t: usize) -> bool {
    let (wall, parts) = (&frame.walls[t], filled.triangle_to_facets.list(t));
    if wall.device.is_some() || parts.len() == 1 {
        return false;
    }
    let sides = |[a, b, c]: [VertexId; 3]| [[a, b], [b, c], [c, a]].map(sorted_ids);
    let is_held =
        |edge: &[VertexId; 2]| !edge.iter().any(|v| frame.loose.contains(&frame.to_result[v.index()]));
    let is_whole = |edge: &[VertexId; 2]| parts.iter().any(|part| sides(*part).contains(edge));
    wall.is_fixed || sides(frame.triangles[t]).iter().any(|edge| is_held(edge) && !is_whole(edge))
}

fn are_distinct<const N: usize>(vertices: [VertexId; N]) -> bool {
    (1..N).all(|i| !vertices[..i].contains(&vertices[i]))
}
