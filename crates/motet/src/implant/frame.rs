//! Everything that new tets have to fit: triangles of the devices and faces of the cavity, divided where they
//! meet.
//!
//! Where a device passes through a wall, what lies outside of the host is cut off, or kept. A wall within a
//! device then bounds the device's tets, or is removed. An interface of regions within a device is always
//! removed: the device takes the space of both.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::carve::{Carved, Face, Fate, outward};
use super::cut::Cut;
use super::devices::Devices;
use super::options::{Inside, Outside};
use super::parts::{Divided, common_edges};
use super::place::{check_inside, format_point};
use crate::base::{Error, Point, Result, Threads, VertexId, same_orientation, sorted_ids};
use crate::geometry::triangle::centroid;
use crate::mesh::tet_facets::for_each_tet_facet;
use crate::mesh::{TetMesh, cone_volume};

/// This many rings of triangles around where a device meets a wall may stray as well: narrow triangles there
/// are often held by their neighbours alone. (Of a stent across the neck of an aneurysm 55 bad tets were left
/// with none, 25 with one, 12 with two.)
const RINGS: usize = 2;

/// A triangle that tets have to fit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wall {
    /// Vertices of the result: those of the host, then those of devices, then new ones.
    pub(super) vertices: [VertexId; 3],
    /// The triangle of the devices that it is, or is a part of.
    pub(super) device: Option<u32>,
    /// The face of the cavity that it is, or is a part of.
    pub(super) face: Option<u32>,
    /// The device in which it lies.
    pub(super) within: Option<u32>,
    /// Whether it has to stay as it is: it has no corner where a device meets a wall.
    pub(super) is_fixed: bool,
}

/// Where a triangle of the devices lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Position {
    /// Inside the host.
    Inside,
    /// At a wall: it need not stay as it is.
    AtWall,
    /// Outside of the host.
    Outside,
}

/// Where devices lie relative to walls.
#[derive(Clone, Debug, Default)]
pub(super) struct DevicePositions {
    /// Where each triangle lies.
    pub(super) of_triangle: Vec<Position>,
    /// For each device, whether it meets a wall or lies outside in part.
    pub(super) crosses_boundary: Vec<bool>,
    /// The volume of each device within the host.
    pub(super) volumes: Vec<f64>,
}

/// The frame: walls over one list of points.
#[derive(Debug, Default)]
pub(super) struct Frame {
    /// The points that walls use, and the vertex of the result that each is.
    pub(super) points: Vec<Point>,
    pub(super) to_result: Vec<VertexId>,
    /// The walls as triangles over these points.
    pub(super) triangles: Vec<[VertexId; 3]>,
    pub(super) walls: Vec<Wall>,
    /// The new points where surfaces were divided.
    pub(super) new_points: Vec<Point>,
    /// Vertices of walls that may move or be removed, since they lie where a device meets a wall.
    pub(super) loose: BTreeSet<VertexId>,
    /// Faces that no longer exist, or not as they were.
    pub(super) dropped: Vec<Face>,
    pub(super) positions: DevicePositions,
    /// The vertex of the result that each vertex of the devices is now.
    pub(super) names: Vec<VertexId>,
}

impl Frame {
    /// Divides devices and faces where they meet, and collects the walls.
    ///
    /// # Errors
    /// When a device lies outside of the host or contains it, when one that keeps its tets meets a wall, and
    /// when surfaces come too close to each other.
    pub(super) fn new(
        host: &TetMesh,
        devices: &Devices,
        carved: &Carved,
        outside: Outside,
        threads: &Threads,
    ) -> Result<Self> {
        let n_host = host.points.len();
        let points: Vec<Point> = host.points.iter().chain(&devices.points).copied().collect();
        let in_result = |t: &[VertexId; 3]| t.map(|v| VertexId::new(n_host + v.index()));
        let of_devices: Vec<[VertexId; 3]> = devices.triangles.iter().map(in_result).collect();
        let faces: Vec<[VertexId; 3]> = carved.faces.iter().map(|face| face.vertices).collect();
        let cut = Cut::new(&points, [&of_devices, &faces], threads)?;
        let on_both = common_edges(&cut);
        let divided = Divided::new(&cut, &on_both);
        let mut frame = Self {
            new_points: cut.points[points.len()..].to_vec(),
            names: cut.names[n_host..].to_vec(),
            ..Self::default()
        };
        frame.loosen(host, devices, carved, &cut, &on_both);
        let mut walls = frame.of_devices(host, devices, carved, &divided, outside, threads)?;
        let within = |k: usize| {
            let own: Vec<_> = devices.triangles_of(k).map(|t| of_devices[t]).collect();
            divided.faces.are_inside(&cut, &own, threads)
        };
        let within: Vec<Vec<bool>> = (0..devices.names.len()).map(within).collect();
        frame.add_faces(devices, carved, &divided, &within, outside, &mut walls);
        frame.check_others(host, carved, &cut, &walls)?;
        frame.take(&cut, walls);
        Ok(frame)
    }

    /// Finds the vertices where devices meet walls, except those that are held by anything that stays.
    fn loosen(
        &mut self,
        host: &TetMesh,
        devices: &Devices,
        carved: &Carved,
        cut: &Cut,
        on_both: &BTreeSet<[VertexId; 2]>,
    ) {
        self.loose.extend(on_both.iter().flatten());
        for s in 0..2 {
            let same = cut.pieces[s].chunk_by(|x, y| x.1 == y.1).filter(|pieces| pieces.len() > 1);
            self.loose.extend(same.flatten().flat_map(|(t, _)| t));
        }
        if self.loose.is_empty() {
            return;
        }
        for _ in 0..RINGS {
            let pieces = cut.pieces.iter().flatten().map(|piece| piece.0);
            let touched = pieces.filter(|t| !self.is_fixed(*t)).flatten();
            let touched: Vec<VertexId> = touched.collect();
            self.loose.extend(touched);
        }
        let staying = host.tets.iter().zip(&carved.fates).filter(|(_, fate)| **fate != Fate::Removed);
        let own = devices.own_tets.iter().flat_map(|tet| tet.vertices.map(|v| self.names[v.index()]));
        let held: Vec<VertexId> = staying.flat_map(|(tet, _)| *tet).chain(own).collect();
        let held = held.iter().chain(&host.fixed_vertices).chain(host.fixed_edges.as_flattened());
        held.for_each(|v| {
            self.loose.remove(v);
        });
    }

    fn is_fixed(&self, triangle: [VertexId; 3]) -> bool {
        !triangle.iter().any(|v| self.loose.contains(v))
    }

    /// The pieces of devices that bound something.
    fn of_devices(
        &mut self,
        host: &TetMesh,
        devices: &Devices,
        carved: &Carved,
        Divided { cut, devices: parts, faces }: &Divided<'_>,
        outside: Outside,
        threads: &Threads,
    ) -> Result<Vec<Wall>> {
        let is_in = parts.are_inside(cut, &boundary(host), threads);
        let twins: HashMap<[VertexId; 3], ([VertexId; 3], u32)> =
            faces.pieces.iter().map(|piece| (sorted_ids(piece.0), *piece)).collect();
        let n = devices.names.len();
        let (mut has_inside, mut walls) = (vec![false; n], Vec::new());
        self.positions.volumes = vec![0.0; n];
        let mut positions = vec![None; devices.triangles.len()];
        for (&(vertices, t), &part) in parts.pieces.iter().zip(&parts.parts) {
            let twin = twins.get(&sorted_ids(vertices));
            // On the boundary, a device lies inside where it faces the same way as the wall.
            let is_inside = match twin {
                Some(&(face, f)) => {
                    carved.faces[f as usize].front.is_some() || same_orientation(vertices, face)
                }
                None => is_in[part],
            };
            let is_fixed = self.is_fixed(vertices);
            let position = match is_fixed {
                false => Position::AtWall,
                true if twin.is_some() || is_in[part] => Position::Inside,
                true => Position::Outside,
            };
            let known = positions[t as usize].replace(position);
            if known.is_some_and(|known| known != position) {
                positions[t as usize] = Some(Position::AtWall);
            }
            for &k in devices.of_triangle.list(t as usize).iter().filter(|_| is_inside) {
                has_inside[k as usize] = true;
                self.positions.volumes[k as usize] += cone(cut, vertices);
            }
            if twin.is_some() || is_in[part] || outside == Outside::Keep {
                walls.push(Wall {
                    vertices,
                    device: Some(t),
                    face: twin.map(|x| x.1),
                    within: None,
                    is_fixed,
                });
            }
        }
        check_inside(host, devices, &has_inside, threads)?;
        self.positions.of_triangle =
            positions.into_iter().map(|position| position.unwrap_or(Position::Inside)).collect();
        self.positions.crosses_boundary = vec![false; n];
        for (t, (of, &position)) in devices.of_triangle.iter().zip(&self.positions.of_triangle).enumerate() {
            for &k in of.iter().filter(|_| position != Position::Inside) {
                self.positions.crosses_boundary[k as usize] = true;
                if devices.insides[k as usize] == Inside::Own {
                    return Err(own_tets_cut(devices, k, t, position));
                }
            }
        }
        Ok(walls)
    }

    /// Adds the pieces of faces that bound something and are not pieces of devices.
    fn add_faces(
        &mut self,
        devices: &Devices,
        carved: &Carved,
        Divided { cut, faces, .. }: &Divided<'_>,
        within: &[Vec<bool>],
        outside: Outside,
        walls: &mut Vec<Wall>,
    ) {
        let with_device: HashSet<[VertexId; 3]> =
            walls.iter().filter(|wall| wall.face.is_some()).map(|wall| sorted_ids(wall.vertices)).collect();
        let mut is_dropped = vec![false; carved.faces.len()];
        for (&(vertices, f), &part) in faces.pieces.iter().zip(&faces.parts) {
            if with_device.contains(&sorted_ids(vertices)) {
                is_dropped[f as usize] = true;
                continue;
            }
            let is_boundary = carved.faces[f as usize].front.is_none();
            let holders: Vec<usize> = (0..within.len()).filter(|&k| within[k][part]).collect();
            if is_boundary {
                holders.iter().for_each(|&k| self.positions.volumes[k] += cone(cut, vertices));
            }
            let is_fixed = self.is_fixed(vertices);
            is_dropped[f as usize] |= !is_fixed || !holders.is_empty();
            let bounds =
                |k: usize| is_boundary && outside == Outside::Cut && devices.insides[k] != Inside::Hollow;
            if holders.last().is_none_or(|&k| bounds(k)) {
                let within = holders.last().map(|&k| k as u32);
                walls.push(Wall { vertices, device: None, face: Some(f), within, is_fixed });
            }
        }
        self.dropped = (0..is_dropped.len()).filter(|&f| is_dropped[f]).map(|f| carved.faces[f]).collect();
    }

    /// Refuses to divide or remove faces and edges of cells of other kinds, which stay as they are.
    fn check_others(&self, host: &TetMesh, carved: &Carved, cut: &Cut, walls: &[Wall]) -> Result<()> {
        let vertices: HashSet<VertexId> = host.fixed_vertices.iter().copied().collect();
        let edges: HashSet<[VertexId; 2]> = host.fixed_edges.iter().map(|edge| sorted_ids(*edge)).collect();
        if vertices.is_empty() && edges.is_empty() {
            return Ok(());
        }
        let of_faces = || walls.iter().filter(|wall| wall.face.is_some()).map(|wall| wall.vertices);
        let whole: HashSet<[VertexId; 3]> = of_faces().map(sorted_ids).collect();
        let sides = |[a, b, c]: [VertexId; 3]| [[a, b], [b, c], [c, a]].map(sorted_ids);
        let known: HashSet<[VertexId; 2]> = of_faces().flat_map(sides).collect();
        let is_lost = |face: &&Face| {
            let is_held = face.front.is_none() && face.vertices.iter().all(|v| vertices.contains(v));
            is_held && !whole.contains(&sorted_ids(face.vertices))
                || sides(face.vertices).iter().any(|edge| edges.contains(edge) && !known.contains(edge))
        };
        let Some(lost) = carved.faces.iter().find(is_lost) else { return Ok(()) };
        Err(Error::input("a device meets a wall at cells that are not tets, which cannot be divided")
            .at(format!(
                "triangle at {}",
                format_point(centroid(lost.vertices.map(|v| cut.points[v.index()])))
            ))
            .remedy("move the device, or remove those cells from the host"))
    }

    fn take(&mut self, cut: &Cut, walls: Vec<Wall>) {
        let mut to_frame: HashMap<VertexId, VertexId> = HashMap::new();
        for wall in &walls {
            let triangle = wall.vertices.map(|v| {
                *to_frame.entry(v).or_insert_with(|| {
                    self.points.push(cut.points[v.index()]);
                    self.to_result.push(v);
                    VertexId::new(self.points.len() - 1)
                })
            });
            self.triangles.push(triangle);
        }
        self.walls = walls;
    }
}

/// The error for a device that keeps its tets, which cannot be divided.
fn own_tets_cut(devices: &Devices, k: u32, t: usize, position: Position) -> Error {
    let is_met = position == Position::AtWall;
    let why = if is_met { "a wall of the host meets them" } else { "a part of it lies outside of the host" };
    Error::input(format!("the device `{}` keeps its tets, but {why}", devices.names[k as usize]))
        .at(format!("triangle of the device at {}", format_point(centroid(devices.corners(t)))))
        .remedy("make it filled or hollow: then it is cut where it meets the wall")
}

/// The signed volume between a triangle and one point common to all.
fn cone(cut: &Cut, triangle: [VertexId; 3]) -> f64 {
    cone_volume(triangle.into_iter(), &cut.points, cut.points[0])
}

/// The boundary of the host, oriented outward.
fn boundary(host: &TetMesh) -> Vec<[VertexId; 3]> {
    let mut boundary = Vec::new();
    for_each_tet_facet(&host.tets, &[], |sharing| {
        if let &[(t, i)] = sharing.tets {
            boundary.push(outward(host, t.index(), i));
        }
    });
    boundary
}
