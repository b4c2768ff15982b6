//! Two moving triangles: a time before which they do not touch, as late as can be proved.
//!
//! *Conservative advancement* (Mirtich 1996, *Impulse-based dynamic simulation of rigid body systems*):
//! measure the distance, advance for as long as no contact is possible, measure again. The step follows from
//! the slab between the closest points: it lies between the triangles until a vertex of one and a vertex of
//! the other have closed up along its normal, each at its own speed (the directional bound of Zhang, Lee and
//! Kim 2006, *Interactive continuous collision detection for non-convex polyhedra*). That is never sooner
//! than the distance over the largest relative speed, which is the step of additive advancement (Li, Kaufman
//! and Jiang 2021, *Codimensional incremental potential contact*, ACCD), and for triangles that do not rotate
//! the first step ends at the contact. Only differences of velocities count.
//!
//! Positions and velocities are relative to one vertex. Each step subtracts the rounding errors from the
//! width of the slab and adds them to the speeds.

use crate::base::Point;
use crate::geometry::distance::Closest;
use crate::geometry::distance::triangle_triangle::{closest, closest_below};
use crate::geometry::vector::{add, dot, largest_coordinate, norm, scale, sub};

/// The error of a distance at a time, relative to the extent then: 4e-15 of the distance and 2e-15 of the
/// positions, and a margin.
const ROUNDING: f64 = 1e-14;

/// Contact is reached when the distance is this fraction of the way travelled or of the size of the
/// triangles, whichever is less. A contact at a hundredth of the fastest speed is then correct to a
/// ten-thousandth, and a grazing one, where the distance falls as the square of the time left, to a
/// thousandth.
const CONTACT_TOLERANCE: f64 = 1e-6;

/// The mean is two steps per pair. Where triangles rotate fast and close slowly, each step covers the same
/// small fraction of what is left: 100 steps were too few for 2 of 13,000 random pairs (27 % too early at
/// worst), 1000 for none (4e-5 too early).
const MAX_STEPS: usize = 1000;

/// Triangles that must stay apart, but are nearer at the start than allowed, must keep this fraction of their
/// distance then.
pub const SLACK: f64 = 0.75;

/// Triangles that must stay apart count as in contact at most this fraction of that distance too early.
const MAX_EARLY: f64 = 0.01;

/// Squares above this have all their digits.
const SMALLEST_SQUARE: f64 = 1e-290;

/// Two triangles, relative to the first vertex of the first one.
pub(super) struct Pair {
    origin: (Point, Point),
    places: [[Point; 3]; 2],
    velocities: [[Point; 3]; 2],
    /// The largest absolute coordinate of the places, and of the velocities.
    size: f64,
    speed: f64,
    /// The larger of the sizes of the two triangles.
    width: f64,
    /// They are in contact when their distance is at most this.
    clearance: f64,
}

impl Pair {
    /// `a` and `b` are corners with their velocities. They are in contact when their distance is at most
    /// `clearance`, but see [`SLACK`].
    pub(super) fn new(a: [(Point, Point); 3], b: [(Point, Point); 3], clearance: f64) -> Self {
        let origin = a[0];
        let places = [a, b].map(|t| t.map(|x| sub(x.0, origin.0)));
        let velocities = [a, b].map(|t| t.map(|x| sub(x.1, origin.1)));
        let size = largest_coordinate(places.as_flattened());
        let speed = largest_coordinate(velocities.as_flattened());
        let width = places
            .iter()
            .map(|t| largest_coordinate(&[sub(t[1], t[0]), sub(t[2], t[0])]))
            .fold(0.0, f64::max);
        Self { origin, places, velocities, size, speed, width, clearance }.within_slack()
    }

    fn within_slack(self) -> Self {
        if self.clearance == 0.0 {
            return self;
        }
        let near = self.closest_within(0.0, self.clearance);
        Self { clearance: near.map_or(self.clearance, |near| SLACK * near.distance()), ..self }
    }

    /// The most that triangles that must stay apart may be from contact when they stop: a small part of that
    /// distance.
    fn tolerance(&self) -> f64 {
        if self.clearance > 0.0 { MAX_EARLY * self.clearance } else { f64::INFINITY }
    }

    /// The largest relative speed of two vertices: no two points of the triangles have a larger one.
    fn fastest(&self) -> f64 {
        let [of_a, of_b] = self.velocities;
        let speeds = of_a.iter().flat_map(|u| of_b.iter().map(|v| norm(sub(*v, *u))));
        speeds.fold(0.0, f64::max) + ROUNDING * self.speed
    }

    /// A time before which there is no contact, given that there is none before `start`: by the slab between
    /// the centres, a cheap test that often suffices.
    pub(super) fn quick_bound(&self, start: f64) -> f64 {
        let [a, b] = self.places.map(|[p, q, r]| add(add(p, q), r));
        self.slab_closes_at(0.0, sub(b, a)).max(start)
    }

    /// A time before which there is no contact, given that there is none before
    /// [`quick_bound`](Self::quick_bound). `None` if it is not below `bound` or is beyond the horizon.
    /// Otherwise `bound` changes nothing: the search ends early only at a step that would have gone beyond
    /// it.
    pub(super) fn contact_time(&self, start: f64, bound: f64, horizon: f64) -> Option<f64> {
        let is_late = |time: f64| time >= bound || time > horizon;
        let last = bound.min(horizon);
        let fastest = self.fastest();
        let mut time = start;
        for _ in 0..MAX_STEPS {
            if is_late(time) {
                return None;
            }
            let rounding = ROUNDING * (self.size + time * self.speed);
            let touching =
                rounding + (CONTACT_TOLERANCE * self.width.min(time * fastest)).min(self.tolerance());
            // From farther than this, the next step goes beyond `last`, with a margin for rounding.
            let reach = (last - time) * fastest * (1.0 + 4.0 * ROUNDING) + 2.0 * rounding;
            let near = self.closest_within(time, self.clearance + reach.max(2.0 * touching))?;
            let distance = near.distance() - self.clearance;
            if distance <= touching {
                break;
            }
            let at_least = time + (distance - rounding) / fastest * (1.0 - ROUNDING);
            let next = self.slab_closes_at(time, near.offset).max(at_least);
            // Also false for NaN.
            let progressed = next > time;
            if !progressed {
                break;
            }
            time = next;
        }
        (!is_late(time)).then_some(time)
    }

    fn closest_within(&self, time: f64, reach: f64) -> Option<Closest<3, 3>> {
        let [a, b] = self.at(time);
        let reach_squared = reach * reach;
        // If the square underflows or overflows, only the distance itself will do.
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

    /// Until when a slab perpendicular to `direction` stays between the triangles, from `time` on; `time` if
    /// there is none.
    fn slab_closes_at(&self, time: f64, direction: Point) -> f64 {
        // At most 1 in each coordinate, so that only sizes count.
        let largest = direction.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        let along = direction.map(|x| x / largest);
        let at = self.at(time).map(|t| t.map(|p| dot(p, along)));
        let speeds = self.velocities.map(|t| t.map(|v| dot(v, along)));
        let rounding = ROUNDING * (self.size + time * self.speed) + self.clearance * norm(along);
        let mut left = f64::INFINITY;
        for (p, u) in at[0].iter().zip(speeds[0]) {
            for (q, v) in at[1].iter().zip(speeds[1]) {
                let (apart, closing) = (q - p - rounding, u - v + ROUNDING * self.speed);
                // False for NaN.
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
