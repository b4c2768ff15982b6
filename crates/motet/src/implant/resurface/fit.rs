//! How far the new surface and the old one are apart.

use super::old::OriginalSurface;
use super::skin::Skin;
use crate::base::{Point, Threads, VertexId, sorted_ids};
use crate::geometry::triangle::{area_vector, centroid};
use crate::geometry::vector::{add, norm, scale};
use crate::implant::report::Fit;
use crate::spatial::{Closest, NearestTriangle};

/// How far in front of a triangle its surroundings are probed, as a fraction of the tolerance.
const PROBE_DISTANCE: f64 = 0.25;

impl OriginalSurface {
    pub(super) fn fit(&self, skin: &Skin, tolerance: f64, threads: &Threads) -> Fit {
        Fit {
            to_old: self.distance_to_old(skin, threads),
            from_old: self.distance_from_old(skin, tolerance, threads),
            tolerance,
        }
    }

    /// The largest distance of the new surface from the old one, at corners and at the middles of edges and
    /// triangles.
    fn distance_to_old(&self, skin: &Skin, threads: &Threads) -> f64 {
        let at = |v: VertexId| skin.points[v.index()];
        let mut places = skin.points.clone();
        places.extend(edges(&skin.triangles).into_iter().map(|[u, v]| scale(add(at(u), at(v)), 0.5)));
        places.extend(skin.triangles.iter().map(|t| centroid(t.map(at))));
        let found = self.nearest.closest_all(&places, None, threads);
        found.into_iter().map(far).fold(0.0, f64::max)
    }

    /// The largest distance of the old surface from the new one, at the middles of triangles and of their
    /// edges. Where the old surface lies in the device, such as where turns of a wire overlap, it does not
    /// bound it, and does not count.
    fn distance_from_old(&self, skin: &Skin, tolerance: f64, threads: &Threads) -> f64 {
        let of_triangle = |t: usize| {
            let [a, b, c] = self.surface.corners(t);
            let middles = [[a, b], [b, c], [c, a]].map(|[p, q]| scale(add(p, q), 0.5));
            [middles[0], middles[1], middles[2], centroid([a, b, c])].map(|p| (p, t))
        };
        let places: Vec<(Point, usize)> = (0..self.surface.triangles.len()).flat_map(of_triangle).collect();
        let tree = NearestTriangle::new(&skin.points, &skin.triangles, threads);
        let only: Vec<Point> = places.iter().map(|place| place.0).collect();
        let found = tree.closest_all(&only, None, threads);
        let mut far: Vec<(f64, Point, usize)> =
            found.into_iter().zip(places).map(|(found, (p, t))| (far(found), p, t)).collect();
        // Winding numbers are expensive: beginning with the farthest, the first that counts is the answer.
        far.sort_unstable_by(|x, y| y.0.total_cmp(&x.0));
        let counts = |&&(_, p, t): &&(f64, Point, usize)| {
            let normal = area_vector(self.surface.corners(t));
            let length = norm(normal);
            let before = add(p, scale(normal, PROBE_DISTANCE * tolerance / length));
            length > 0.0 && !self.is_inside(self.winding(before))
        };
        far.iter().find(counts).map_or(0.0, |farthest| farthest.0)
    }
}

fn far(found: Option<Closest>) -> f64 {
    found.map_or(f64::INFINITY, |found| found.distance_squared.sqrt())
}

/// The ends of every edge, each edge once, in ascending order.
fn edges(triangles: &[[VertexId; 3]]) -> Vec<[VertexId; 2]> {
    let mut edges: Vec<_> =
        triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]].map(sorted_ids)).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
