//! Measures one pair of bodies: vertices against triangles both ways, the nearest triangles, what crosses,
//! what is inside.

use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

use super::body::BodyView;
use super::inside::inside;
use super::nearest::{distance_squared, mark_nearer, nearest};
use super::options::Options;
use super::results::{BodyGaps, Nearest, PairGap};
use super::rule::Rule;
use super::side::Side;
use super::surface_graph::{PathSearch, SurfaceGraph};
use crate::base::{BodyId, MaybeId, Point, Threads, TriangleId};
use crate::geometry::vector::{scale, sub};
use crate::preflight::{crossings, own_crossings};
use crate::spatial::Closest;
use crate::spatial::runs::in_runs;

/// What was nearest at the last step, as guesses for the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Guesses {
    /// The triangle nearest to each vertex of the first body, and of the second.
    of_vertices: [Vec<MaybeId<TriangleId>>; 2],
    /// The nearest pair of triangles.
    pair: Option<[u32; 2]>,
}

/// A bound above a distance by this factor finds it again.
const SLACK: f64 = 1.0 + 1e-9;

/// The triangles found.
fn triangles(found: &[Option<Closest>]) -> Vec<MaybeId<TriangleId>> {
    found.iter().map(|closest| triangle(closest).into()).collect()
}

fn triangle(found: &Option<Closest>) -> Option<TriangleId> {
    found.map(|closest| TriangleId(closest.triangle as u32))
}

/// Two bodies at one time.
pub(super) struct Scene<'a> {
    pub(super) points: &'a [Point],
    pub(super) bodies: [BodyView<'a>; 2],
    pub(super) ids: [BodyId; 2],
    pub(super) graph: Option<&'a SurfaceGraph>,
    pub(super) options: Options,
}

/// What was measured of one body against the other.
pub(super) struct OneWay {
    /// Which of the two bodies.
    own: usize,
    found: Vec<Option<Closest>>,
    /// Whether each vertex is where the other body does not allow it.
    is_wrong: Vec<bool>,
    /// Whether each triangle is nearer than the warning distance.
    is_near: Vec<bool>,
}

impl Scene<'_> {
    fn is_own(&self) -> bool {
        self.ids[0] == self.ids[1]
    }

    fn rule(&self, own: usize) -> Rule<'_> {
        Rule::new(self.points, [self.bodies[own], self.bodies[1 - own]], self.graph, &self.options)
    }

    /// Measures the pair; for a body with itself, nothing is found for the second half.
    pub(super) fn measure(&self, guesses: &mut Guesses, threads: &Threads) -> (PairGap, Vec<OneWay>) {
        let found = [0, 1].map(|own| match self.is_own() && own == 1 {
            true => Vec::new(),
            false => self.of_vertices(own, &mut guesses.of_vertices[own], threads),
        });
        let all = found.iter().flatten().flatten();
        let start = all.map(|closest| closest.distance_squared).fold(f64::INFINITY, f64::min);
        let nearest = self.nearest(start, guesses, threads);
        let crossings = self.crossings(nearest.as_ref(), threads);
        let mut sides = threads.each(vec![0, 1], |own| self.side(own, &crossings, threads));
        for (side, found) in sides.iter_mut().zip(found) {
            side.found = found;
            self.measure_depths(side);
        }
        self.warn(nearest.as_ref(), &mut sides, threads);
        let count = |flags: &[bool]| flags.iter().filter(|&&flag| flag).count();
        let gap = PairGap {
            bodies: self.ids,
            nearest,
            crossings,
            n_wrong: [0, 1].map(|own| count(&sides[own].is_wrong)),
            depth: sides.iter().map(OneWay::depth).fold(0.0, f64::max),
            n_warned: [0, 1].map(|own| count(&sides[own].is_near)),
        };
        (gap, sides)
    }

    /// The nearest points and nothing else. The pair that was nearest last time bounds the search; the first
    /// time, some vertex does.
    pub(super) fn nearest_only(&self, guesses: &mut Guesses, threads: &Threads) -> Option<Nearest> {
        let rule = self.rule(0);
        let place = || self.points[rule.a.vertices[0].index()];
        let start = match guesses.pair {
            None if rule.admits_all() => {
                rule.b.tree.closest(place()).map_or(f64::INFINITY, |c| c.distance_squared)
            }
            _ => f64::INFINITY,
        };
        self.nearest(start, guesses, threads)
    }

    /// The nearest points within the square root of `start` and within reach.
    fn nearest(&self, start: f64, guesses: &mut Guesses, threads: &Threads) -> Option<Nearest> {
        let rule = self.rule(0);
        let limit = self.options.within * self.options.within;
        let last = guesses.pair.and_then(|pair| distance_squared(&rule, pair));
        let found = nearest(&rule, start.min(last.unwrap_or(limit)).min(limit), threads);
        guesses.pair = found.map(|found| found.triangles);
        found
    }

    /// The nearest triangle of the other body for each vertex.
    fn of_vertices(
        &self,
        own: usize,
        guesses: &mut Vec<MaybeId<TriangleId>>,
        threads: &Threads,
    ) -> Vec<Option<Closest>> {
        let rule = self.rule(own);
        let place = |i: usize| self.points[rule.a.vertices[i].index()];
        let within = self.options.within;
        if !rule.admits_all() {
            let found = self.admitted_of_vertices(&rule, guesses, threads);
            *guesses = triangles(&found);
            return found;
        }
        let points: Vec<Point> = (0..rule.a.vertices.len()).map(place).collect();
        let last = (guesses.len() == points.len()).then_some(&guesses[..]);
        let mut found = rule.b.tree.closest_all(&points, last, threads);
        *guesses = triangles(&found);
        found.iter_mut().for_each(|c| *c = c.filter(|c| c.distance_squared <= within * within));
        found
    }

    /// For each vertex, the nearest triangle of the other body that the rule admits. What was nearest at the
    /// last step, or to the previous vertex, bounds the search: the rule need not be applied to anything
    /// farther.
    fn admitted_of_vertices(
        &self,
        rule: &Rule<'_>,
        guesses: &[MaybeId<TriangleId>],
        threads: &Threads,
    ) -> Vec<Option<Closest>> {
        let within = self.options.within;
        in_runs(rule.a.vertices.len(), threads, |paths: &mut PathSearch, run| {
            let (mut last, mut found) = (None, Vec::with_capacity(run.len()));
            for i in run {
                let place = self.points[rule.a.vertices[i].index()];
                let guess = guesses.get(i).map_or(last, |guess| guess.get());
                let known = guess.and_then(|guess| rule.distance(i, guess.0, paths));
                let bound = known.map_or(within, |d| within.min(d * SLACK));
                let closest = rule.b.tree.closest_where(place, bound, rule.at_vertex(i, paths));
                last = triangle(&closest);
                found.push(closest);
            }
            found
        })
    }

    /// The pairs of triangles that cross. If the nearest points are apart, nothing crosses, except for
    /// triangles that share a vertex, which are not measured.
    fn crossings(&self, nearest: Option<&Nearest>, threads: &Threads) -> Vec<[u32; 2]> {
        let [a, b] = [0, 1].map(|k| &self.bodies[k].joined);
        let is_apart = nearest.is_none_or(|nearest| nearest.distance > 0.0);
        match (self.is_own(), self.graph.is_some()) {
            (true, _) => own_crossings(self.points, a, threads),
            (_, false) if is_apart => Vec::new(),
            _ => crossings(self.points, a, b, threads),
        }
    }

    fn side(&self, own: usize, crossings: &[[u32; 2]], threads: &Threads) -> OneWay {
        let rule = self.rule(own);
        let mut side = OneWay { own, found: Vec::new(), is_wrong: Vec::new(), is_near: Vec::new() };
        if rule.b.is_closed && !self.is_own() && self.graph.is_none() {
            let crossings: Vec<_> = crossings.iter().map(|pair| [pair[own], pair[1 - own]]).collect();
            let (own, other) = (&rule.a.joined, &rule.b.joined);
            let is_inside =
                inside(self.points, &rule.a.representatives(self.points), own, other, &crossings, threads);
            side.is_wrong = is_inside.into_iter().map(|inside| inside != rule.b.is_room).collect();
        }
        side
    }

    /// Finds the depth of vertices that are where they must not be: their distance from the surface,
    /// whichever way that faces and however far it is.
    fn measure_depths(&self, side: &mut OneWay) {
        let rule = self.rule(side.own);
        for (i, found) in side.found.iter_mut().enumerate() {
            if side.is_wrong.get(i) == Some(&true) && (found.is_none() || !rule.admits_all()) {
                *found = rule.b.tree.closest(self.points[rule.a.vertices[i].index()]);
            }
        }
    }

    /// Marks the triangles nearer than the warning distance.
    fn warn(&self, nearest: Option<&Nearest>, sides: &mut [OneWay], threads: &Threads) {
        let Some(warn) = self.options.warn else { return };
        let near = self.bodies.map(|body| body.triangles.iter().map(|_| false.into()).collect());
        let both = [&near[0], &near[usize::from(!self.is_own())]].map(|near: &Vec<AtomicBool>| &near[..]);
        if nearest.is_some_and(|nearest| nearest.distance < warn) {
            if self.rule(0).admits_all() {
                sides.iter().for_each(|side| self.mark_around(side, warn, both));
            }
            mark_nearer(&self.rule(0), warn, both, threads);
        }
        for (side, near) in sides.iter_mut().zip(near) {
            side.is_near = near.into_iter().map(AtomicBool::into_inner).collect();
        }
    }

    /// Marks the triangles around vertices that are near, and the triangles nearest to these: most of all
    /// that are near.
    fn mark_around(&self, side: &OneWay, warn: f64, near: [&[AtomicBool]; 2]) {
        let own = self.bodies[side.own];
        for (i, found) in side.found.iter().enumerate() {
            if let Some(found) = found.filter(|found| found.distance_squared < warn * warn) {
                own.star(i).iter().for_each(|&t| near[side.own][t as usize].store(true, Relaxed));
                near[1 - side.own][found.triangle].store(true, Relaxed);
            }
        }
    }
}

impl OneWay {
    fn depth(&self) -> f64 {
        let wrong = self.found.iter().zip(&self.is_wrong).filter(|(_, wrong)| **wrong);
        wrong.filter_map(|(found, _)| *found).map(|found| found.distance_squared.sqrt()).fold(0.0, f64::max)
    }

    /// Takes over those gaps that are smaller than the known ones.
    pub(super) fn merge_into(&self, scene: &Scene<'_>, gaps: &mut BodyGaps) {
        let (own, other) = (scene.bodies[self.own], scene.bodies[1 - self.own]);
        for (i, found) in self.found.iter().enumerate() {
            let Some(found) = found else { continue };
            let is_wrong = self.is_wrong.get(i) == Some(&true);
            let sign = if is_wrong { -1.0 } else { 1.0 };
            let gap = sign * found.distance_squared.sqrt();
            gaps.warning[i] |= is_wrong && scene.options.warn.is_some();
            if gap >= gaps.gap[i] {
                continue;
            }
            let triangle = found.triangle as u32;
            let way = sub(found.point, scene.points[own.vertices[i].index()]);
            gaps.gap[i] = gap;
            gaps.normal[i] = match gap == 0.0 {
                true => scale(
                    other.normal(scene.points, triangle),
                    if other.free == Side::Inside { 1.0 } else { -1.0 },
                ),
                false => scale(way, 1.0 / gap),
            };
            gaps.closest_body[i] = scene.ids[1 - self.own].into();
            gaps.closest_triangle[i] = TriangleId(triangle).into();
            gaps.closest_point[i] = found.point;
        }
        for i in 0..own.vertices.len() {
            gaps.warning[i] |= own.star(i).iter().any(|&t| self.is_near.get(t as usize) == Some(&true));
        }
    }
}
