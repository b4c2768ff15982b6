//! What is inside of given surfaces, and where the inside ends.

use crate::base::{Point, Threads, VertexId};
use crate::geometry::triangle::{area, area_vector, centroid};
use crate::geometry::vector::{add, distance, scale, sub, unit};
use crate::spatial::{Closest, NearestTriangle, WindingNumber};

/// How near the end of the inside is found, over the allowed distance.
const FOUND_OVER_DISTANCE: f64 = 1.0 / 32.0;

/// The most halvings of a segment that crosses the surface.
const MAX_HALVINGS: usize = 60;

/// How often surfaces go around places behind triangles that enclose these.
const AROUND: f64 = 0.6;

/// The least share of the area of triangles behind which something is enclosed.
const LEAST_SHARE: f64 = 0.1;

/// At how many triangles that is measured, at most.
const MAX_SAMPLES: usize = 1000;

/// Surfaces, and what is inside of them.
pub(crate) struct Field {
    winding: WindingNumber,
    nearest: NearestTriangle,
    /// How far a new surface may stray.
    pub(crate) distance: f64,
}

impl Field {
    pub(crate) fn new(
        points: &[Point],
        triangles: &[[VertexId; 3]],
        distance: f64,
        threads: &Threads,
    ) -> Self {
        Self {
            winding: WindingNumber::new(points, triangles),
            nearest: NearestTriangle::new(points, triangles, threads),
            distance,
        }
    }

    pub(crate) fn is_inside(&self, p: Point) -> bool {
        self.winding.at(p) > 0.5
    }

    /// Whether triangles enclose something behind them. Behind a sheet that goes round nothing the surfaces
    /// go around half a time, and slightly more where it is bent.
    pub(crate) fn is_enclosing(&self, triangles: &[[Point; 3]], threads: &Threads) -> bool {
        let step = triangles.len().div_ceil(MAX_SAMPLES).max(1);
        let shares = threads.map_parts(triangles.len().div_ceil(step), 16, |i| {
            let corners = triangles[i * step];
            let is_around = unit(area_vector(corners)).is_some_and(|normal| {
                self.winding.at(add(centroid(corners), scale(normal, -self.distance))) > AROUND
            });
            (area(corners), is_around)
        });
        let all: f64 = shares.iter().map(|of| of.0).sum();
        let around: f64 = shares.iter().filter(|of| of.1).map(|of| of.0).sum();
        around > LEAST_SHARE * all
    }

    /// The nearest place on the given triangles.
    pub(crate) fn nearest(&self, p: Point) -> Option<Closest> {
        self.nearest.closest(p)
    }

    /// The nearest place on the given triangles within a length.
    pub(super) fn nearest_within(&self, p: Point, length: f64) -> Option<Point> {
        self.nearest.closest_within(p, length).map(|closest| closest.point)
    }

    /// A place between one inside and one outside where the inside ends: on a given triangle, unless the
    /// inside ends at a hole.
    pub(super) fn end(&self, mut inside: Point, mut outside: Point) -> Point {
        let found = FOUND_OVER_DISTANCE * self.distance;
        for _ in 0..MAX_HALVINGS {
            if distance(inside, outside) < found {
                break;
            }
            let middle = between(inside, outside);
            if self.is_inside(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        let middle = between(inside, outside);
        self.nearest_within(middle, 2.0 * found).unwrap_or(middle)
    }

    /// Whether some places around `p`, at `radius`, are inside and others are not.
    pub(crate) fn is_at_end(&self, p: Point, radius: f64) -> bool {
        let around = |i: usize| {
            let direction = [i / 9, i / 3 % 3, i % 3].map(|k| k as f64 - 1.0);
            add(p, scale(direction, radius / distance(direction, [0.0; 3])))
        };
        let mut answers = (0..27).filter(|&i| i != 13).map(|i| self.is_inside(around(i)));
        let first = answers.next();
        answers.any(|answer| Some(answer) != first)
    }
}

fn between(p: Point, q: Point) -> Point {
    add(p, scale(sub(q, p), 0.5))
}
