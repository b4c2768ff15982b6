//! How thick layers may be at each vertex: what is asked, less where there is no room.
//!
//! | limit | why |
//! |---|---|
//! | gap | the largest ball that touches the wall at the vertex and no wall that faces it: layers take a part of it, so that the core keeps the rest |
//! | edges | where the wall is hollow, columns side by side come together |
//! | slope | what one vertex cannot have its neighbors have little more of |
//!
//! The ball is found by shrinking it to the nearest point again and again (Ma, Bae and Choi 2012, *3D medial axis point approximation using
//! nearest neighbors and the normal field*).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::directions::Directions;
use super::neighbors::NONE;
use super::skin::Skin;
use crate::base::{Csr, Point, Threads, VertexId};
use crate::geometry::vector::{add, distance, dot, scale, sub};
use crate::spatial::NearestTriangle;

/// The most of a ball's radius that a column may take: three tenths of the way across a vessel.
const OF_BALL: f64 = 0.6;

/// The most of a wall's edge by which columns at its ends may come together.
const OF_EDGE: f64 = 0.6;

/// How much thicker layers may get, over the way along the wall.
const SLOPE: f64 = 0.3;

/// How many times as long as the asked thickness a column may be, where it leans.
const STRETCH: f64 = 2.0;

/// A wall faces a column when the cosine of its normal with it is less: 60 degrees and more apart.
const FACING_WALL: f64 = 0.5;

/// The same for what carries no layers: columns beside it rise along it.
const FACING_BARE: f64 = -0.3;

/// A ball is shrunk at most so often: hardly any takes ten.
const SHRINKS: usize = 30;

/// What columns rise by, and how high.
#[derive(Clone, Debug)]
pub(super) struct Heights {
    /// The stack of each vertex: its place in the skin's; [`NONE`] where nothing can grow.
    pub(super) stack_of: Vec<u32>,
    /// The thickness that is asked.
    pub(super) asked: Vec<f64>,
    /// The thickness that there is, at right angles to the wall.
    pub(super) heights: Vec<f64>,
    /// How a vertex moves for each unit of thickness.
    pub(super) lifts: Vec<Point>,
}

impl Heights {
    pub(super) fn find(skin: &Skin, around: &Csr<VertexId>, threads: &Threads) -> Self {
        let directions = Directions::find(skin, around, threads);
        let full: Vec<f64> = skin.stacks.iter().map(super::Stack::thickness).collect();
        let thinnest = |w: usize| {
            let of_walls = skin.walls(VertexId::new(w)).map(|t| skin.stack_of[t as usize]);
            of_walls.min_by(|&a, &b| full[a as usize].total_cmp(&full[b as usize])).unwrap_or(NONE)
        };
        let n = skin.points.len();
        let stack_of: Vec<u32> = (0..n).map(thinnest).collect();
        let asked: Vec<f64> =
            stack_of.iter().map(|&s| if s == NONE { 0.0 } else { full[s as usize] }).collect();
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
            let ball = room(skin, &tree, VertexId::new(w), directions.ways[w], asked[w] * stretch / OF_BALL);
            let beside = around.list(w).iter().map(|v| at_edge(skin, &lifts, [VertexId::new(w), *v]));
            let most = asked[w].min(asked[w] * STRETCH / stretch);
            beside.fold(most.min(OF_BALL * ball / stretch), f64::min)
        });
        let mut all = Self { stack_of, asked, heights, lifts };
        all.limit_slope(skin, around);
        all
    }

    /// How many layers stand on a vertex.
    pub(super) fn count(&self, skin: &Skin, vertex: VertexId) -> usize {
        match self.stack_of[vertex.index()] {
            stack if self.heights[vertex.index()] > 0.0 => skin.stacks[stack as usize].count as usize,
            _ => 0,
        }
    }

    /// Makes what is too thick beside thinner layers thinner, the thinnest first.
    pub(super) fn limit_slope(&mut self, skin: &Skin, around: &Csr<VertexId>) {
        // Heights are not negative, so their bits rise as they do.
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
                let most = height + SLOPE * distance(skin.points[w], skin.points[v.index()]);
                if most < self.heights[v.index()] {
                    self.heights[v.index()] = most;
                    next.push(key(most, v.index()));
                }
            }
        }
    }
}

/// The radius of the largest ball that touches the skin at a vertex from inside and holds no wall that faces it; `radius` at most.
fn room(skin: &Skin, tree: &NearestTriangle, vertex: VertexId, way: Point, mut radius: f64) -> f64 {
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

/// How thick layers may be for the columns at both ends of an edge not to come together.
fn at_edge(skin: &Skin, lifts: &[Point], [w, v]: [VertexId; 2]) -> f64 {
    let edge = sub(skin.points[v.index()], skin.points[w.index()]);
    let closing = dot(sub(lifts[w.index()], lifts[v.index()]), edge);
    if closing > 0.0 { OF_EDGE * dot(edge, edge) / closing } else { f64::INFINITY }
}
