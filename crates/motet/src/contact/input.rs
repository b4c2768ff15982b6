//! Checks of surfaces: there must be triangles, over points that exist and are finite.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::is_finite;

/// The vertices of a surface, in ascending order.
///
/// # Errors
/// When it has no triangles, or names a point that does not exist or whose coordinates are not finite.
/// Messages call the surface `name`.
pub(super) fn vertices_of(
    name: &str,
    triangles: &[[VertexId; 3]],
    points: &[Point],
) -> Result<Vec<VertexId>> {
    if triangles.is_empty() {
        return Err(Error::input(format!("{name} has no triangles"))
            .remedy("contact is measured between surfaces: give one with triangles, or leave it out"));
    }
    let is_beyond = |t: &[VertexId; 3]| t.iter().copied().find(|v| v.index() >= points.len());
    if let Some((i, v)) = (0..).zip(triangles).find_map(|(i, t): (usize, _)| Some((i, is_beyond(t)?))) {
        return Err(Error::input(format!("names point {v}, but there are only {} points", points.len()))
            .at(format!("{name}, triangle {i}"))
            .remedy("give all points that the triangles use"));
    }
    let mut is_used = vec![false; points.len()];
    triangles.as_flattened().iter().for_each(|v| is_used[v.index()] = true);
    let vertices: Vec<_> = (0..points.len()).filter(|&v| is_used[v]).map(VertexId::new).collect();
    check_finite(name, vertices.iter().copied(), points)?;
    Ok(vertices)
}

/// Checks that these points are finite.
///
/// # Errors
/// When one of them has coordinates that are not finite.
pub(super) fn check_finite(
    name: &str,
    mut vertices: impl Iterator<Item = VertexId>,
    points: &[Point],
) -> Result<()> {
    match vertices.find(|v| !is_finite(points[v.index()])) {
        None => Ok(()),
        Some(v) => Err(Error::input(format!("a coordinate is not finite: {:?}", points[v.index()]))
            .at(format!("{name}, point {v}"))
            .remedy("remove the point and its triangles, or give it finite coordinates")),
    }
}
