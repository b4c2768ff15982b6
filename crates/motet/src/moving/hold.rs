//! Walls that are kept apart: what would come too near to another wall, or go through it, stops in front of it.
//!
//! ```text
//!      told to go                      kept
//!      o                   o           o                   o
//!         o             o                 o             o
//!    --------o-------o--------             o--o--o--o--o     at the distance
//!    ============o============         =========================  the other wall
//! ```
//!
//! A node that is told to go behind the other wall, or nearer to it than it may, is put at the distance, on the way from the nearest place of that wall: it slides
//! along it. Which side of a wall a node is on is that of its first place, so what is told once is stopped alike at any step.

use crate::base::{Csr, Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle;
use crate::geometry::vector::{add, dot, norm, scale, sub, unit};
use crate::spatial::{Closest, NearestTriangle};

/// In a corner a wall stops a node more than once: so often at most, each time nearer to the place that is far enough from all of it.
const CORNER: usize = 16;

/// What was put at the distance is not farther than this part of it from there.
const ROUNDING: f64 = 1e-12;

/// Walls of which each is kept away from all that follow it.
#[derive(Clone, Debug)]
pub(super) struct Hold {
    /// Each after the first, with what is kept away from it.
    stops: Vec<Stops>,
}

/// A wall that stops others.
#[derive(Clone, Debug)]
struct Stops {
    sheet: Sheet,
    tree: NearestTriangle,
    kept: Vec<Kept>,
}

/// A node that is kept away.
#[derive(Clone, Copy, Debug)]
struct Kept {
    node: VertexId,
    /// 1 in front of the triangles, -1 behind them.
    side: f64,
    /// How far away: no farther than it was at first, or what joins the wall would be torn off it.
    least: f64,
}

impl Hold {
    /// `bodies` are triangles between nodes; `places` where the nodes were at first. Of nodes that two bodies share neither is kept from the other.
    ///
    /// # Errors
    /// When the distance is not above 0.
    pub(super) fn new(
        distance: f64,
        places: &[Point],
        bodies: &[Vec<[VertexId; 3]>],
        threads: &Threads,
    ) -> Result<Self> {
        if !(distance > 0.0 && distance.is_finite()) {
            return Err(Error::options(format!("walls are to be kept {distance} apart"))
                .remedy("give a distance above 0"));
        }
        let stops = (1..bodies.len()).map(|last| {
            let sheet = Sheet::new(places.len(), bodies[last].clone());
            let tree = NearestTriangle::new(places, &sheet.triangles, threads);
            let mut nodes: Vec<VertexId> = bodies[..last].iter().flatten().flatten().copied().collect();
            nodes.retain(|v| sheet.stars.list(v.index()).is_empty());
            nodes.sort_unstable();
            nodes.dedup();
            let starts: Vec<Point> = nodes.iter().map(|v| places[v.index()]).collect();
            let found = tree.closest_all(&starts, None, threads);
            let kept = nodes.iter().zip(&starts).zip(found).filter_map(|((&node, &start), found)| {
                let found = found?;
                let off = sub(start, found.point);
                let side = if dot(off, sheet.normal(places, &found)) < 0.0 { -1.0 } else { 1.0 };
                Some(Kept { node, side, least: distance.min(norm(off)) })
            });
            let kept = kept.collect();
            Stops { sheet, tree, kept }
        });
        Ok(Self { stops: stops.collect() })
    }

    /// Stops what goes too far; how many nodes that is.
    pub(super) fn stop(&mut self, places: &[Point], displacement: &mut [Point], threads: &Threads) -> usize {
        let mut at: Vec<Point> = places.iter().zip(&*displacement).map(|(&p, &d)| add(p, d)).collect();
        let mut stopped = Vec::new();
        // A wall that gives way to a later one is where it will be when earlier ones give way to it.
        for Stops { sheet, tree, kept } in self.stops.iter_mut().rev() {
            tree.refit(&at, threads);
            let mut open: Vec<Kept> = kept.clone();
            for _ in 0..CORNER {
                let ends: Vec<Point> = open.iter().map(|kept| at[kept.node.index()]).collect();
                let found = tree.closest_all(&ends, None, threads);
                let ends = open.iter().zip(&ends).zip(found);
                let ends = ends.map(|((kept, &end), found)| kept.stop(sheet, &at, end, &found?));
                let ends: Vec<Option<Point>> = ends.collect();
                for (kept, end) in open.iter().zip(&ends) {
                    let Some(end) = *end else { continue };
                    let i = kept.node.index();
                    (displacement[i], at[i]) = (sub(end, places[i]), end);
                    stopped.push(kept.node);
                }
                let mut ends = ends.into_iter();
                open.retain(|_| ends.next().flatten().is_some());
            }
        }
        stopped.sort_unstable();
        stopped.dedup();
        stopped.len()
    }
}

impl Kept {
    /// Where the node stops that is told to go to `end`; `None` where it may go there.
    fn stop(&self, sheet: &Sheet, at: &[Point], end: Point, found: &Closest) -> Option<Point> {
        let off = sub(end, found.point);
        let facing = scale(sheet.normal(at, found), self.side);
        // Round a free edge there is no behind.
        let is_behind = dot(off, facing) < 0.0 && !sheet.is_at_rim(found);
        let gap = norm(off);
        if gap >= self.least * (1.0 - ROUNDING) && !is_behind {
            return None;
        }
        let way = unit(if is_behind { scale(off, -1.0) } else { off }).or_else(|| unit(facing))?;
        Some(add(found.point, scale(way, self.least)))
    }
}

/// Triangles, and those at each node.
#[derive(Clone, Debug)]
struct Sheet {
    triangles: Vec<[VertexId; 3]>,
    stars: Csr<u32>,
}

impl Sheet {
    fn new(n_nodes: usize, triangles: Vec<[VertexId; 3]>) -> Self {
        let stars = Csr::from_pairs(n_nodes, || {
            triangles.iter().zip(0..).flat_map(|(t, i)| t.map(|v| (v.index(), i)))
        });
        Self { triangles, stars }
    }

    /// The vertices of the triangle that the place lies between: one at a vertex, two on an edge.
    fn between(&self, found: &Closest) -> Vec<VertexId> {
        let corners = self.triangles[found.triangle].into_iter().zip(found.weights);
        corners.filter(|(_, w)| *w != 0.0).map(|(v, _)| v).collect()
    }

    /// The triangles that have all these vertices.
    fn round<'a>(&'a self, between: &'a [VertexId]) -> impl Iterator<Item = [VertexId; 3]> + 'a {
        let star = between.first().map_or(&[] as &[u32], |v| self.stars.list(v.index()));
        let triangles = star.iter().map(|&t| self.triangles[t as usize]);
        triangles.filter(|t| between.iter().all(|v| t.contains(v)))
    }

    /// The normal at the nearest place, not of unit length: that of the triangle, of both at an edge, of all at a vertex by their angles there. Its sign tells the side
    /// of what the place is nearest to (Baerentzen, Aanaes 2005).
    fn normal(&self, at: &[Point], found: &Closest) -> Point {
        let between = self.between(found);
        let of = |t: [VertexId; 3]| {
            let normal = unit(triangle::area_vector(t.map(|v| at[v.index()]))).unwrap_or_default();
            match between.as_slice() {
                &[v] => scale(normal, angle_at(t, v, at)),
                _ => normal,
            }
        };
        self.round(&between).map(of).fold([0.0; 3], add)
    }

    /// Whether the place is on an edge that one triangle alone has, or at an end of one.
    fn is_at_rim(&self, found: &Closest) -> bool {
        let between = self.between(found);
        let mut others: Vec<VertexId> = self.round(&between).flatten().collect();
        others.retain(|v| !between.contains(v));
        others.sort_unstable();
        match between.len() {
            1 => others.chunk_by(|a, b| a == b).any(|same| same.len() == 1),
            2 => others.len() == 1,
            _ => false,
        }
    }
}

fn angle_at(t: [VertexId; 3], v: VertexId, at: &[Point]) -> f64 {
    let k = t.iter().position(|w| *w == v).unwrap_or(0);
    let [a, b, c] = [0, 1, 2].map(|i| at[t[(k + i) % 3].index()]);
    match (unit(sub(b, a)), unit(sub(c, a))) {
        (Some(x), Some(y)) => dot(x, y).clamp(-1.0, 1.0).acos(),
        _ => 0.0,
    }
}
