//! The thickness of layers at each vertex: as requested, or less where there is no space.
//!
//! | limit | reason |
//! |---|---|
//! | gap | the largest ball that touches the wall at the vertex and contains no wall facing it: layers take a fraction of it, so that the core keeps the rest |
//! | edges | where the wall is concave, neighbouring columns converge |
//! | slope | if one vertex has thin layers, its neighbours cannot have much thicker ones |
//!
//! The ball is found by repeatedly shrinking it to the nearest point (Ma, Bae and Choi 2012, *3D medial axis
//! point approximation using nearest neighbors and the normal field*).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::directions::Directions;
use super::neighbors::NONE;
use super::skin::Skin;
use crate::base::{Csr, Point, Threads, VertexId};
use crate::geometry::vector::{add, distance, dot, scale, sub};
use crate::spatial::NearestTriangle;

/// How far columns go into the space around them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// The largest fraction of a ball's radius that a column may take.
    of_ball: f64,
    /// The largest fraction of an edge of the wall by which the columns at its ends may converge.
    of_edge: f64,
    /// By how much the thickness may grow per unit of distance along the wall.
    slope: f64,
}

impl Limits {
    /// Inside a vessel: three tenths of the way across, so that the core keeps the rest.
    pub(super) const INSIDE: Self = Self { of_ball: 0.6, of_edge: 0.6, slope: 0.3 };

    /// Outside, where nothing needs space beyond the columns.
    pub(super) const OUTSIDE: Self = Self { of_ball: 0.9, of_edge: 0.8, slope: 1.0 };

    /// The largest thickness that the columns at both ends of an edge allow each other.
    fn of_edge(&self, skin: &Skin, lifts: &[Point], [w, v]: [VertexId; 2]) -> f64 {
        let edge = sub(skin.points[v.index()], skin.points[w.index()]);
        let closing = dot(sub(lifts[w.index()], lifts[v.index()]), edge);
        if closing > 0.0 { self.of_edge * dot(edge, edge) / closing } else { f64::INFINITY }
    }
}

/// The largest ratio of the length of a leaning column to the requested thickness.
const STRETCH: f64 = 2.0;

/// A wall faces a column if the cosine between its inward normal and the column is below this: at least 60
/// degrees apart.
const FACING_WALL: f64 = 0.5;

/// The limit of that cosine for triangles without layers, along which adjacent columns rise.
const FACING_BARE: f64 = -0.3;

/// The largest number of times a ball is shrunk: hardly any takes ten.
const SHRINKS: usize = 30;

/// Direction and height of the columns.
#[derive(Clone, Debug)]
pub(super) struct Heights {
    /// For each vertex, the index of its stack in the skin; [`NONE`] where nothing can grow.
    pub(super) stack_of: Vec<u32>,
    /// The requested thickness.
    pub(super) requested: Vec<f64>,
    /// The actual thickness, normal to the wall.
    pub(super) heights: Vec<f64>,
    /// The displacement of a vertex per unit of thickness.
    pub(super) lifts: Vec<Point>,
    limits: Limits,
}

impl Heights {
    /// Finds the heights; `requested` returns the thickness at a vertex, given that of the stack there.
    pub(super) fn find(
        skin: &Skin,
        around: &Csr<VertexId>,
        limits: &Limits,
        requested: impl Fn(VertexId, f64) -> f64 + Sync,
        threads: &Threads,
    ) -> Self {
        let &limits = limits;
        let directions = Directions::find(skin, around, threads);
        let full: Vec<f64> = skin.stacks.iter().map(super::Stack::thickness).collect();
        let thinnest = |w: usize| {
            let of_walls = skin.walls(VertexId::new(w)).map(|t| skin.stack_of[t as usize]);
            of_walls.min_by(|&a, &b| full[a as usize].total_cmp(&full[b as usize])).unwrap_or(NONE)
        };
        let n = skin.points.len();
        let stack_of: Vec<u32> = (0..n).map(thinnest).collect();
        let requested: Vec<f64> = (0..n)
            .map(|w| match stack_of[w] {
                NONE => 0.0,
                stack => requested(VertexId::new(w), full[stack as usize]),
            })
            .collect();
        let lift = |w: usize| match directions.cosines[w] {
            cosine if cosine > 0.0 => scale(directions.ways[w], 1.0 / cosine),
            _ => [0.0; 3],
        };
        let lifts: Vec<Point> = (0..n).map(lift).collect();
        let tree = NearestTriangle::new(&skin.points, &skin.triangles, threads);
        let heights = threads.map(n, |w| {
            let stretch = dot(lifts[w], directions.ways[w]);
            if stretch.is_nan() || stretch <= 0.0 || stack_of[w] == NONE {
                return 0.0;
            }
            let ball = largest_ball(
                skin,
                &tree,
                VertexId::new(w),
                directions.ways[w],
                requested[w] * stretch / limits.of_ball,
            );
            let beside = around.list(w).iter().map(|v| limits.of_edge(skin, &lifts, [VertexId::new(w), *v]));
            let most = requested[w].min(requested[w] * STRETCH / stretch);
            beside.fold(most.min(limits.of_ball * ball / stretch), f64::min)
        });
        let mut all = Self { stack_of, requested, heights, lifts, limits };
        all.limit_slope(skin, around);
        all
    }

    /// The number of layers at a vertex.
    pub(super) fn count(&self, skin: &Skin, vertex: VertexId) -> usize {
        match self.stack_of[vertex.index()] {
            stack if self.heights[vertex.index()] > 0.0 => skin.stacks[stack as usize].count as usize,
            _ => 0,
        }
    }

    /// Reduces heights that exceed the slope limit relative to their neighbours, smallest heights first.
    pub(super) fn limit_slope(&mut self, skin: &Skin, around: &Csr<VertexId>) {
        // Heights are not negative, so their bit patterns sort in the same order.
        let key = |height: f64, w: usize| Reverse((height.to_bits(), w));
        let mut next: BinaryHeap<_> = self
            .heights
            .iter()
            .enumerate()
            .filter(|(w, _)| !around.list(*w).is_empty())
            .map(|(w, &h)| key(h, w))
            .collect();
        while let Some(Reverse((bits, w))) = next.pop() {
            let height = f64::from_bits(bits);
            if height > self.heights[w] {
                continue;
            }
            for &v in around.list(w) {
                let most = height + self.limits.slope * distance(skin.points[w], skin.points[v.index()]);
                if most < self.heights[v.index()] {
                    self.heights[v.index()] = most;
                    next.push(key(most, v.index()));
                }
            }
        }
    }
}

/// The radius of the largest ball that touches the skin at a vertex from inside and contains no wall facing
/// it; at most `radius`.
pub(super) fn largest_ball(
    skin: &Skin,
    tree: &NearestTriangle,
    vertex: VertexId,
    way: Point,
    mut radius: f64,
) -> f64 {
    let (from, star) = (skin.points[vertex.index()], skin.stars.list(vertex.index()));
    let body = star.first().map(|&t| skin.bodies[t as usize]);
    let is_facing = |t: u32| {
        let limit = if skin.has_stack(t) { FACING_WALL } else { FACING_BARE };
        let cosine = -dot(skin.normals[t as usize], way);
        cosine < limit && Some(skin.bodies[t as usize]) == body && !star.contains(&t)
    };
    for _ in 0..SHRINKS {
        let middle = add(from, scale(way, radius));
        let Some(met) = tree.closest_where(middle, radius, |t, _| is_facing(t)) else { break };
        let offset = sub(met.point, from);
        let smaller = dot(offset, offset) / (2.0 * dot(offset, way));
        if smaller.is_nan() || smaller >= radius * (1.0 - 1e-6) {
            break;
        }
        radius = smaller;
    }
    radius
}
