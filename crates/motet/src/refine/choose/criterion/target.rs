//! A surface that refinement measures distances from: a device, a wall, a patch.

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::distance::triangle_triangle;
use crate::geometry::tet::{self, FACETS};
use crate::geometry::vector::{distance, in_range};
use crate::mesh::{Mesh, Surface};
use crate::spatial::{Closest, NearestTriangle};

/// Triangles with a search tree over them.
#[derive(Clone, Debug)]
pub struct Target {
    points: Vec<Point>,
    triangles: Vec<[VertexId; 3]>,
    tree: NearestTriangle,
}

impl Target {
    /// Builds a target from triangles over points.
    ///
    /// # Errors
    /// When there is no triangle, or a corner does not exist or has an invalid coordinate.
    pub fn new(points: Vec<Point>, triangles: Vec<[VertexId; 3]>, threads: &Threads) -> Result<Self> {
        if triangles.is_empty() {
            return Err(Error::input(
                "has no surface: neither surface cells nor volume cells with a boundary",
            )
            .remedy("give triangles or other surface cells"));
        }
        let is_invalid = |v: &&VertexId| points.get(v.index()).is_none_or(|p| !in_range(*p));
        if let Some(v) = triangles.as_flattened().iter().find(is_invalid) {
            return Err(Error::input("has an invalid position: a coordinate is missing or not finite")
                .at(format!("point {v}"))
                .remedy("remove the point and its cells, or correct its coordinates"));
        }
        let tree = NearestTriangle::new(&points, &triangles, threads);
        Ok(Self { points, triangles, tree })
    }

    /// Builds a target from the surface cells of a mesh, or from its boundary if it has none.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new).
    pub fn of_mesh(mesh: &Mesh, threads: &Threads) -> Result<Self> {
        let surface = Surface::own_or_boundary_of(mesh);
        Self::new(surface.points, surface.triangles, threads)
    }

    /// The points that the triangles refer to.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The triangles.
    pub fn triangles(&self) -> &[[VertexId; 3]] {
        &self.triangles
    }

    /// The tree over the triangles.
    pub fn tree(&self) -> &NearestTriangle {
        &self.tree
    }

    /// Whether a tet comes within `reach` of the surface.
    pub fn is_within(&self, reach: f64, corners: [Point; 4]) -> bool {
        let centre = tet::centroid(corners);
        // No point of the surface farther from the centre is near enough.
        let radius = corners.into_iter().map(|corner| distance(corner, centre)).fold(0.0, f64::max);
        // Slightly more, so that the checks below decide borderline cases, not rounding here.
        let far = (reach + radius) * (1.0 + 1e-12);
        let is_near = |triangle: u32, place: Point| {
            let nearest = tet::at(corners, tet::closest(corners, place));
            let triangle = self.triangles[triangle as usize].map(|v| self.points[v.index()]);
            distance(nearest, place) <= reach || is_within_triangle(reach, corners, triangle)
        };
        let admit = |triangle: u32, found: &Closest| is_near(triangle, found.point);
        self.tree.closest_where(centre, far, admit).is_some()
    }
}

/// Whether a tet comes within `reach` of a triangle: one of its facets does, or the tet contains the
/// triangle.
fn is_within_triangle(reach: f64, corners: [Point; 4], triangle: [Point; 3]) -> bool {
    let bound = (reach * reach).next_up();
    let is_near = |facet: [usize; 3]| {
        triangle_triangle::closest_below(facet.map(|i| corners[i]), triangle, bound).is_some()
    };
    tet::holds(corners, triangle[0]) || FACETS.into_iter().any(is_near)
}
