//! Points for the space around devices and in them.

use std::collections::HashMap;

use super::carve::Carved;
use super::devices::Devices;
use super::options::{Inside, Options, Outside};
use crate::base::{Point, Result, Threads, VertexId};
use crate::contact::inside;
use crate::mesh::TetMesh;
use crate::meshing::{Grading, points_between};

/// Points in the cavity, and in devices that are filled, at the density that the surfaces call for before
/// they are divided.
pub(super) fn lattice(
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
        let own: Vec<_> = devices.triangles_of(k).map(|t| devices.triangles[t]).collect();
        for (needed, is_in) in is_needed.iter_mut().zip(is_in(&own)) {
            *needed = if is_filled { *needed || is_in } else { *needed && !is_in };
        }
    }
    Ok(lattice.into_iter().zip(is_needed).filter(|(_, is_needed)| *is_needed).map(|(p, _)| p).collect())
}
