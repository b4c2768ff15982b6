//! Looking ahead: when surfaces will touch if all vertices continue in a straight line.

use std::sync::Mutex;

use serde::Serialize;

use super::body::{BodyView, PreparedBody};
use super::measure::Contact;
use super::rule::Rule;
use super::surface_graph::PathSearch;
use super::sweep::{Sweep, sweep, sweep_own};
use crate::base::{BodyId, Error, Point, Result, Threads};
use crate::geometry::distance::triangle_triangle;
use crate::geometry::vector::{is_finite, scale, sub};

/// When surfaces will touch. Times are safe: nothing touches earlier, rounding included, as long as every
/// vertex continues in a straight line at its velocity.
#[derive(Clone, Debug, PartialEq)]
pub struct Ahead {
    /// The first contact of all; `None` if nothing touches before the horizon.
    pub first: Option<FirstContact>,
    /// For each vertex of each body, in the order of [`BodyGaps::vertices`](super::BodyGaps): a time before
    /// which no triangle at it touches another surface; infinite if none does before the horizon.
    pub times: Vec<Vec<f64>>,
}

/// Where surfaces will touch first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FirstContact {
    /// A time before which they do not touch.
    pub time: f64,
    /// The bodies.
    pub bodies: [BodyId; 2],
    /// A triangle of each.
    pub triangles: [u32; 2],
    /// Where they will touch.
    pub place: Point,
}

impl Contact {
    /// Looks ahead as far as `horizon`, which may be infinite, with a velocity for each point. Pairs of
    /// triangles that [`measure`](Self::measure) leaves out as neighbours are left out here as well.
    ///
    /// Uses additive conservative advancement (Li, Kaufman and Jiang 2021, *Codimensional incremental
    /// potential contact*).
    ///
    /// # Errors
    /// When there is not one velocity for each point, or that of a body's vertex is not finite; when the
    /// horizon is not positive.
    pub fn look_ahead(&self, velocity: &[Point], horizon: f64, threads: &Threads) -> Result<Ahead> {
        self.check_velocity(velocity, horizon)?;
        let vertices = |body: &PreparedBody| vec![f64::INFINITY; body.vertices.len()];
        let mut ahead = Ahead { first: None, times: self.bodies.iter().map(vertices).collect() };
        for (ids, graph, options) in self.measured_pairs() {
            let bodies = self.view(ids);
            let rule = Rule::new(&self.points, bodies, graph, &options);
            let kept = Mutex::new(Vec::<PathSearch>::new());
            let take = || kept.lock().ok().and_then(|mut kept| kept.pop()).unwrap_or_default();
            let give = |paths| kept.lock().map(|mut kept| kept.push(paths)).unwrap_or_default();
            let admit = |i: u32, j: u32| {
                if !rule.may_admit([i, j]) {
                    return false;
                }
                rule.admits_all() || {
                    let corners = (rule.a.corners(&self.points, i), rule.b.corners(&self.points, j));
                    let closest = triangle_triangle::closest(corners.0, corners.1);
                    let mut paths = take();
                    let is_admitted = rule.admits([i, j], &closest, &mut paths);
                    give(paths);
                    is_admitted
                }
            };
            let (points, a, b) = (&self.points, &rule.a.triangles, &rule.b.triangles);
            let found = match ids[0] == ids[1] {
                true => sweep_own(points, velocity, a, horizon, admit, threads),
                false => sweep(points, velocity, a, b, horizon, admit, threads),
            };
            ahead.take(ids, bodies, found);
        }
        Ok(ahead)
    }

    /// Looks ahead on the way to the points `next`, which are reached in straight lines after the time `dt`.
    ///
    /// # Errors
    /// When `dt` is not positive and finite, and as [`look_ahead`](Self::look_ahead).
    pub fn look_ahead_to(&self, next: &[Point], dt: f64, threads: &Threads) -> Result<Ahead> {
        if !(dt > 0.0 && dt.is_finite()) {
            return Err(Error::options(format!("the time step is {dt}")).remedy("give a positive time step"));
        }
        let velocity: Vec<Point> =
            next.iter().zip(self.points()).map(|(to, from)| scale(sub(*to, *from), 1.0 / dt)).collect();
        self.look_ahead(&velocity, dt, threads)
    }

    fn check_velocity(&self, velocity: &[Point], horizon: f64) -> Result<()> {
        if velocity.len() != self.points.len() {
            return Err(Error::input(format!(
                "got {} velocities, expected {}",
                velocity.len(),
                self.points.len()
            ))
            .remedy("give one velocity for each point"));
        }
        let mut used = self.bodies.iter().flat_map(|body| &body.vertices);
        if let Some(v) = used.find(|v| !is_finite(velocity[v.index()])) {
            return Err(Error::input("the velocity is not finite").at(format!("point {v}")));
        }
        match horizon > 0.0 {
            true => Ok(()),
            false => Err(Error::options(format!("the horizon is {horizon}")).remedy("give a positive time")),
        }
    }
}

impl Ahead {
    fn take(&mut self, ids: [BodyId; 2], bodies: [BodyView<'_>; 2], found: Sweep) {
        let first = found.first.map(|f| FirstContact {
            time: f.time,
            bodies: ids,
            triangles: f.triangles,
            place: f.place,
        });
        let is_earlier = |f: &FirstContact| self.first.is_none_or(|known| f.time < known.time);
        if let Some(first) = first.filter(is_earlier) {
            self.first = Some(first);
        }
        for ((id, body), of_triangles) in ids.into_iter().zip(bodies).zip(found.times) {
            for (place, time) in self.times[id.index()].iter_mut().enumerate() {
                *time = body.star(place).iter().map(|&t| of_triangles[t as usize]).fold(*time, f64::min);
            }
        }
    }
}
