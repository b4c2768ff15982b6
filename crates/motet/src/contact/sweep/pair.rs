//! Two moving triangles: a time before which they do not touch, as late as can be told.
//!
//! *Conservative advancement* (Mirtich 1996, *Impulse-based dynamic simulation of rigid body systems*): measure the distance, go on for as long as no
//! contact can come, measure again. How long that is says the slab between the closest points: it lies between the triangles until a vertex of one and
//! a vertex of the other have closed up along its normal, each at its own speed (the directional bound of Zhang, Lee and Kim 2006,
//! *Interactive continuous collision detection for non-convex polyhedra*). That is never sooner than the distance over the largest
//! relative speed, as additive advancement goes on (Li, Kaufman and Jiang 2021, *Codimensional incremental potential contact*, ACCD),
//! and for triangles that do not turn the first step ends at the contact. Only differences of velocities count.
//!
//! Positions and velocities are taken relative to one vertex. Each step takes the errors of rounding off the width of the slab and adds them
//! to the speeds.

use crate::base::Point;
use crate::geometry::distance::Closest;
use crate::geometry::distance::triangle_triangle::{closest, closest_below};
use crate::geometry::vector::{add, dot, largest_coordinate, norm, scale, sub};

/// Error of a distance at a time, as a part of the extent then: 4e-15 of the distance and 2e-15 of the positions, and something to spare.
const ROUNDING: f64 = 1e-14;

/// Contact has come where the distance is this part of the way gone and of the size of the triangles. A contact at a speed that is a
/// hundredth of the fastest is then right to a ten thousandth; so is a grazing one to a thousandth, where the distance
/// ends as the square of the time left.
const ENOUGH: f64 = 1e-6;

/// Two steps a pair are the mean. Where triangles turn fast and close slowly, each step takes the same small part of what is left: 100 steps
/// were too few for 2 of 13,000 random pairs (27 of 100 too early at the worst), 1000 for none (4e-5 too early).
const MOST_STEPS: usize = 1000;

/// Triangles that are to stay apart, but are nearer at the start than they may come, keep this part of their distance then.
pub const SLACK: f64 = 0.75;

/// Triangles that are to stay apart are in contact no farther than this part of that length before.
const FAR: f64 = 0.01;

/// Squares above it have all their digits.
const SMALLEST_SQUARE: f64 = 1e-290;

/// Two triangles, relative to the first vertex of the first.
pub(super) struct Pair {
    origin: (Point, Point),
    places: [[Point; 3]; 2],
    velocities: [[Point; 3]; 2],
    /// The largest of each, by a coordinate.
    size: f64,
    speed: f64,
    /// The larger size of one triangle alone.
    width: f64,
    /// They are in contact where they are as near as this.
    apart: f64,
}

impl Pair {
    /// Of corners with their velocities; they are in contact where they are no farther `apart` than that, but see [`SLACK`].
    pub(super) fn new(a: [(Point, Point); 3], b: [(Point, Point); 3], apart: f64) -> Self {
        let origin = a[0];
        let places = [a, b].map(|t| t.map(|x| sub(x.0, origin.0)));
        let velocities = [a, b].map(|t| t.map(|x| sub(x.1, origin.1)));
        let size = largest_coordinate(places.as_flattened());
        let speed = largest_coordinate(velocities.as_flattened());
        let width = places
            .iter()
            .map(|t| largest_coordinate(&[sub(t[1], t[0]), sub(t[2], t[0])]))
            .fold(0.0, f64::max);
        Self { origin, places, velocities, size, speed, width, apart }.within_slack()
    }

    fn within_slack(self) -> Self {
        if self.apart == 0.0 {
            return self;
        }
        let near = self.closest_within(0.0, self.apart);
        Self { apart: near.map_or(self.apart, |near| SLACK * near.distance()), ..self }
    }

    /// What is to stay apart by little may not come to stop far from there.
    fn tolerance(&self) -> f64 {
        if self.apart > 0.0 { FAR * self.apart } else { f64::INFINITY }
    }

    /// The largest relative speed of two vertices: no two points of the triangles have a larger one.
    fn fastest(&self) -> f64 {
        let [of_a, of_b] = self.velocities;
        let speeds = of_a.iter().flat_map(|u| of_b.iter().map(|v| norm(sub(*v, *u))));
        speeds.fold(0.0, f64::max) + ROUNDING * self.speed
    }

    /// A time before which there is no contact, given that none comes before `start`: by the slab between the centres, a look that costs
    /// little and is often enough.
    pub(super) fn start(&self, start: f64) -> f64 {
        let [a, b] = self.places.map(|[p, q, r]| add(add(p, q), r));
        self.closed_at(0.0, sub(b, a)).max(start)
    }

    /// No contact comes before this time, given that none comes before [`start`](Self::start). `None` when it is not below `bound` or beyond the horizon;
    /// otherwise the bound changes nothing: whatever ends the search early is a step that would have gone beyond.
    pub(super) fn time(&self, start: f64, bound: f64, horizon: f64) -> Option<f64> {
        let is_late = |time: f64| time >= bound || time > horizon;
        let last = bound.min(horizon);
        let fastest = self.fastest();
        let mut time = start;
        for _ in 0..MOST_STEPS {
            if is_late(time) {
                return None;
            }
            let rounding = ROUNDING * (self.size + time * self.speed);
            let touching = rounding + (ENOUGH * self.width.min(time * fastest)).min(self.tolerance());
            // From beyond this the next step goes beyond `last`, with something to spare for rounding.
            let reach = (last - time) * fastest * (1.0 + 4.0 * ROUNDING) + 2.0 * rounding;
            let near = self.closest_within(time, self.apart + reach.max(2.0 * touching))?;
            let distance = near.distance() - self.apart;
            if distance <= touching {
                break;
            }
            let at_least = time + (distance - rounding) / fastest * (1.0 - ROUNDING);
            let next = self.closed_at(time, near.offset).max(at_least);
            // Nor where there are no numbers to go on with.
            let goes_on = next > time;
            if !goes_on {
                break;
            }
            time = next;
        }
        (!is_late(time)).then_some(time)
    }

    fn closest_within(&self, time: f64, reach: f64) -> Option<Closest<3, 3>> {
        let [a, b] = self.at(time);
        let reach_squared = reach * reach;
        // Where the square is good for nothing, the distance alone will do.
        if (SMALLEST_SQUARE..f64::INFINITY).contains(&reach_squared) {
            closest_below(a, b, reach_squared)
        } else {
            Some(closest(a, b))
        }
    }

    /// Halfway between the closest points at a time.
    pub(super) fn place(&self, time: f64) -> Point {
        let [a, b] = self.at(time);
        let Closest { on_a, on_b, .. } = closest(a, b);
        let weighted =
            |[p, q, r]: [Point; 3], w: [f64; 3]| add(add(scale(p, w[0]), scale(q, w[1])), scale(r, w[2]));
        let middle = scale(add(weighted(a, on_a), weighted(b, on_b)), 0.5);
        add(add(self.origin.0, scale(self.origin.1, time)), middle)
    }

    fn at(&self, time: f64) -> [[Point; 3]; 2] {
        [0, 1].map(|t| [0, 1, 2].map(|k| add(self.places[t][k], scale(self.velocities[t][k], time))))
    }

    /// Until when a slab at right angles to `direction` stays between the triangles, from a time on: that time where there is none.
    fn closed_at(&self, time: f64, direction: Point) -> f64 {
        // At most 1 in each coordinate, so that only sizes count.
        let largest = direction.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let along = direction.map(|x| x / largest);
        let at = self.at(time).map(|t| t.map(|p| dot(p, along)));
        let speeds = self.velocities.map(|t| t.map(|v| dot(v, along)));
        let rounding = ROUNDING * (self.size + time * self.speed) + self.apart * norm(along);
        let mut left = f64::INFINITY;
        for (p, u) in at[0].iter().zip(speeds[0]) {
            for (q, v) in at[1].iter().zip(speeds[1]) {
                let (apart, closing) = (q - p - rounding, u - v + ROUNDING * self.speed);
                // NaN is not.
                let is_apart = apart > 0.0;
                if !is_apart {
                    return time;
                }
                if closing > 0.0 {
                    left = left.min(apart / closing);
                }
            }
        }
        (time + left) * (1.0 - ROUNDING)
    }
}
