//! Values of one surface at places of another: for walls whose displacements are given on triangles of their
//! own.

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::{add, scale};
use crate::spatial::NearestTriangle;

/// Carries vectors from the vertices of a surface to places on or near it.
///
/// Each place takes the value at the nearest point of the surface, which is linear in each triangle. A place
/// that equals a vertex to the bit takes the vertex's value to the bit.
#[derive(Clone, Debug)]
pub struct SurfaceCarrier {
    n_points: usize,
    links: Vec<Link>,
    farthest: f64,
}

/// The triangle and the weights that one place takes its value from.
#[derive(Clone, Copy, Debug)]
struct Link {
    vertices: [VertexId; 3],
    weights: [f64; 3],
}

impl SurfaceCarrier {
    /// Carries from the surface of `triangles` over `points` to `places`.
    ///
    /// # Errors
    /// When there is no triangle, or a place has none near it because a coordinate is not a number.
    pub fn new(
        points: &[Point],
        triangles: &[[VertexId; 3]],
        places: &[Point],
        threads: &Threads,
    ) -> Result<Self> {
        let tree = NearestTriangle::new(points, triangles, threads);
        let found = threads.map(places.len(), |i| tree.closest(places[i]));
        let (mut links, mut farthest) = (Vec::with_capacity(places.len()), 0.0_f64);
        for (i, closest) in found.into_iter().enumerate() {
            let closest = closest.ok_or_else(|| {
                Error::input("no surface was found near this point").at(format!("point {i}"))
            })?;
            let vertices = triangles[closest.triangle];
            let is_here = |v: VertexId| points[v.index()] == places[i];
            let weights = match vertices.iter().position(|&v| is_here(v)) {
                Some(corner) => [0, 1, 2].map(|k| if k == corner { 1.0 } else { 0.0 }),
                None => closest.weights,
            };
            farthest = farthest.max(closest.distance_squared.sqrt());
            links.push(Link { vertices, weights });
        }
        Ok(Self { n_points: points.len(), links, farthest })
    }

    /// The largest distance of a place from the surface.
    pub fn farthest(&self) -> f64 {
        self.farthest
    }

    /// The value at each place; `values` has one for each point of the surface.
    ///
    /// # Panics
    /// When the numbers of values and points differ.
    pub fn carry(&self, values: &[Point]) -> Vec<Point> {
        assert_eq!(values.len(), self.n_points, "a value for each point of the surface");
        let at = |v: VertexId| values[v.index()];
        let value = |link: &Link| match link.weights.iter().position(|&w| w == 1.0) {
            Some(corner) => at(link.vertices[corner]),
            None => {
                let parts = link.vertices.iter().zip(link.weights);
                parts.fold([0.0; 3], |sum, (&v, w)| add(sum, scale(at(v), w)))
            }
        };
        self.links.iter().map(value).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn vertices_get_their_own_values_and_other_places_what_is_linear() {
        let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [2.0, 2.0, 0.1]];
        let triangles = [[0, 1, 2].map(VertexId), [1, 3, 2].map(VertexId)];
        let places = [points[3], [0.5, 0.5, 0.25], points[1], [-1.0, 0.5, 0.0]];
        let threads = Threads::single();
        let carrier = SurfaceCarrier::new(&points, &triangles, &places, &threads).unwrap();
        let values = [[0.0, 0.1, 0.3], [0.7, 0.0, 0.0], [0.0, 0.9, 0.0], [0.1, 0.2, 0.3]];
        let carried = carrier.carry(&values);
        assert_eq!((carried[0], carried[2]), (values[3], values[1]));
        let middle = [0.25 * 0.7, 0.5 * 0.1 + 0.25 * 0.9, 0.5 * 0.3];
        (0..3).for_each(|k| assert!((carried[1][k] - middle[k]).abs() < 1e-15));
        assert!((carried[3][1] - (0.75 * 0.1 + 0.25 * 0.9)).abs() < 1e-15);
        assert_eq!(carrier.farthest(), 1.0);
    }

    #[test]
    fn a_place_that_is_none_is_reported() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let places = [[0.0; 3], [f64::NAN, 0.0, 0.0]];
        let triangles = [[0, 1, 2].map(VertexId)];
        let reported = SurfaceCarrier::new(&points, &triangles, &places, &Threads::single()).unwrap_err();
        assert!(reported.to_string().starts_with("point 1"));
        assert!(SurfaceCarrier::new(&points, &[], &places, &Threads::single()).is_err());
    }
}
