//! How far the new surface and the old one are apart.

use super::old::OriginalSurface;
use super::skin::Skin;
use crate::base::{Point, Threads};
use crate::geometry::triangle::{area_vector, middles};
use crate::geometry::vector::{add, norm, scale};
use crate::implant::report::Fit;
use crate::spatial::{Closest, NearestTriangle};
use crate::surface::farthest;

/// How far in front of a triangle its surroundings are probed, as a fraction of the tolerance.
const PROBE_DISTANCE: f64 = 0.25;

impl OriginalSurface {
    pub(super) fn fit(&self, skin: &Skin, tolerance: f64, threads: &Threads) -> Fit {
        Fit {
            to_old: farthest(&skin.points, &skin.triangles, &self.nearest, threads),
            from_old: self.distance_from_old(skin, tolerance, threads),
            tolerance,
        }
    }

    /// The largest distance of the old surface from the new one, at the middles of triangles and of their
    /// edges. Where the old surface lies in the device, such as where turns of a wire overlap, it does not
    /// bound it, and does not count.
    fn distance_from_old(&self, skin: &Skin, tolerance: f64, threads: &Threads) -> f64 {
        let of_triangle = |t: usize| middles(self.surface.corners(t)).map(|p| (p, t));
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
