//! Where devices lie in the host: what stops them from being put in.

use super::carve::{Carved, outward};
use super::devices::Devices;
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::contact::inside;
use crate::geometry::triangle;
use crate::mesh::TetMesh;
use crate::mesh::tet_facets::for_each_tet_facet;
use crate::preflight::crossings;

fn told([x, y, z]: Point) -> String {
    format!("({x:.6}, {y:.6}, {z:.6})")
}

/// Refuses devices that meet a wall of the host, or lie outside of it.
///
/// # Errors
/// With a place where that is so.
pub(super) fn check(host: &TetMesh, devices: &Devices, carved: &Carved, threads: &Threads) -> Result<()> {
    let n = devices.points.len();
    let mut points = devices.points.clone();
    points.extend_from_slice(&host.points);
    let in_host = |v: VertexId| VertexId::new(n + v.index());
    let triangles: Vec<[VertexId; 3]> = carved.faces.iter().map(|face| face.vertices.map(in_host)).collect();
    let met = crossings(&points, &devices.triangles, &triangles, threads);
    if let Some(&[t, _]) = met.first() {
        let device = &devices.names[devices.of_triangle.list(t as usize)[0] as usize];
        let what = format!(
            "the device `{device}` touches or cuts a wall of the host, which is not supported: {} pairs of triangles meet",
            met.len()
        );
        let place = told(triangle::centroid(devices.corners(t as usize)));
        return Err(Error::input(what)
            .at(format!("triangle {t} of the devices at {place}"))
            .remedy("move the device into the lumen, or cut off what sticks out"));
    }
    check_inside(host, devices, in_host, points, threads)
}

/// With no wall met, a part of a device lies inside the host or outside as a whole.
fn check_inside(
    host: &TetMesh,
    devices: &Devices,
    in_host: impl Fn(VertexId) -> VertexId,
    points: Vec<Point>,
    threads: &Threads,
) -> Result<()> {
    let mut boundary = Vec::new();
    for_each_tet_facet(&host.tets, &[], |sharing| {
        if let &[(t, i)] = sharing.tets {
            boundary.push(outward(host, t.index(), i).map(&in_host));
        }
    });
    let mut vertices = devices.triangles.as_flattened().to_vec();
    vertices.sort_unstable();
    vertices.dedup();
    let is_inside = inside(&points, &vertices, &devices.triangles, &boundary, &[], threads);
    let Some(out) = is_inside.iter().position(|is_inside| !is_inside) else { return Ok(()) };
    let name = device_at(devices, vertices[out]);
    let place = told(devices.points[vertices[out].index()]);
    if is_inside.contains(&true) {
        return Err(Error::input(format!("a part of the device `{name}` lies outside of the host"))
            .at(place)
            .remedy("leave that part out, or move the device"));
    }
    let first = host.tets.iter().flatten().next().map(|&v| in_host(v));
    let swallows = |v: VertexId| inside(&points, &[v], &[], &devices.triangles, &[], threads)[0];
    if first.is_some_and(swallows) {
        return Err(Error::input(format!("the device `{name}` holds the whole host"))
            .at(place)
            .remedy("give the host first, then the device; and both in the same unit"));
    }
    Err(Error::input(format!("the device `{name}` lies outside of the host"))
        .at(place)
        .remedy("`motet info` tells where each lies; both have to be in the same unit"))
}

fn device_at(devices: &Devices, v: VertexId) -> &str {
    let t = devices.triangles.iter().position(|t| t.contains(&v));
    t.map_or("", |t| &devices.names[devices.of_triangle.list(t)[0] as usize])
}
