//! Signed volumes of cells of any kind, by the divergence theorem over their facets.

use crate::base::{CellId, Point, VertexId};
use crate::geometry::tet;
use crate::geometry::vector::{add, cross, dot, scale, sub};
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::{CellKind, Cells};

/// The signed volume of one cell, its edges taken as straight: positive if its facets face outward. 0 for
/// cells that are not volume cells, or of a kind whose facets are not known.
///
/// A facet with more than three corners is divided into a fan around the mean of its corners, which both of
/// its cells see alike. The volumes of cells therefore add up to the volume that their common boundary
/// encloses, even where facets are warped.
pub fn cell_volume(facets: &Facets, cell: CellId, points: &[Point]) -> f64 {
    let cells = facets.cells();
    let vertices = cells.vertices(cell);
    if let (CellKind::TETRA, &[a, b, c, d]) = (cells.kind(cell), vertices) {
        return tet::volume([a, b, c, d].map(|v| points[v.index()]));
    }
    let Some(origin) = vertices.first().map(|v| points[v.index()]) else { return 0.0 };
    let locals = 0..facets.count(cell) as u32;
    locals.map(|local| cone_volume(facets.corners(FacetUse { cell, local }), points, origin)).sum()
}

/// The signed volume of the cone from `origin` over a ring of corners, positive
/// when the ring runs counter-clockwise seen from outside the cone.
pub fn cone_volume(
    ring: impl ExactSizeIterator<Item = VertexId> + Clone,
    points: &[Point],
    origin: Point,
) -> f64 {
    let n = ring.len();
    let at = |v: VertexId| sub(points[v.index()], origin);
    let following = ring.clone().cycle().skip(1);
    if n == 3 {
        let mut corners = ring.map(at);
        let mut next = || corners.next().unwrap_or_default();
        return dot(cross(next(), next()), next()) / 6.0;
    }
    let mean = scale(ring.clone().map(at).fold([0.0; 3], add), 1.0 / n as f64);
    ring.zip(following).map(|(a, b)| dot(cross(mean, at(a)), at(b)) / 6.0).sum()
}

/// The signed volume of every cell; see [`cell_volume`].
pub fn cell_volumes(cells: &Cells, points: &[Point]) -> Vec<f64> {
    let facets = Facets::of(cells);
    (0..cells.len()).map(|i| cell_volume(&facets, CellId::new(i), points)).collect()
}
