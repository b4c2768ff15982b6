//! Where devices lie in the host: refuses those that cannot be put in.

use super::devices::Devices;
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::contact::inside;
use crate::geometry::triangle::centroid;
use crate::mesh::TetMesh;

/// A point as text, for errors.
pub(super) fn format_point([x, y, z]: Point) -> String {
    format!("({x:.6}, {y:.6}, {z:.6})")
}

/// Refuses devices of which nothing lies inside the host; `has_inside` says for each device whether anything
/// does.
///
/// # Errors
/// Names a place on such a device.
pub(super) fn check_inside(
    host: &TetMesh,
    devices: &Devices,
    has_inside: &[bool],
    threads: &Threads,
) -> Result<()> {
    let Some(k) = has_inside.iter().position(|has_inside| !has_inside) else { return Ok(()) };
    let name = &devices.names[k];
    let first = devices.of_triangle.iter().position(|of| of.contains(&(k as u32))).unwrap_or_default();
    let place = format_point(centroid(devices.corners(first)));
    let mut points = devices.points.clone();
    points.extend(host.tets.first().map(|tet| host.points[tet[0].index()]));
    let query = VertexId::new(points.len() - 1);
    if inside(&points, &[query], &[], &devices.triangles, &[], threads)[0] {
        return Err(Error::input(format!("the device `{name}` contains the whole host"))
            .at(place)
            .remedy("give the host first, then the device, both in the same unit"));
    }
    Err(Error::input(format!("the device `{name}` lies outside of the host"))
        .at(place)
        .remedy("`motet info` shows where each lies; both must be in the same unit"))
}

/// Refuses devices that leave nothing of the host.
///
/// # Errors
/// When no tet of the host stays, and no new one takes its place.
pub(super) fn check_left(devices: &Devices, is_left: bool) -> Result<()> {
    if is_left {
        return Ok(());
    }
    let name = devices.names.first().map_or("", String::as_str);
    Err(Error::input(format!("the device `{name}` leaves nothing of the host"))
        .remedy("give the host first, then the device, both in the same unit"))
}
