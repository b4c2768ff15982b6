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
use crate::geometry::triangle::normal_where_they_meet;
use crate::geometry::vector::{add, dot, norm, scale, sub, unit};
use crate::moving::options::Watching;
use crate::moving::wall::Wall;
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
    /// Of patches that are watched and to be kept apart. A node that two of them share is kept from neither.
    ///
    /// # Errors
    /// When the distance is not above 0.
    pub(super) fn of(watch: &Watching, wall: &Wall, threads: &Threads) -> Result<Option<Self>> {
        let Some(distance) = watch.hold else { return Ok(None) };
        if !(distance > 0.0 && distance.is_finite()) {
            return Err(Error::options(format!("walls are to be kept {distance} apart"))
                .remedy("give a distance above 0"));
        }
        let bodies: Vec<_> = (0..watch.patches.len() as u32).map(|k| wall.body(k)).collect();
        let stops = (1..bodies.len()).map(|k| Stops::new(distance, wall, &bodies[..k], &bodies[k], threads));
        Ok(Some(Self { stops: stops.collect() }))
    }

    /// Stops what goes too far; how many nodes that is.
    pub(super) fn stop(&mut self, places: &[Point], displacement: &mut [Point], threads: &Threads) -> usize {
        let mut at: Vec<Point> = places.iter().zip(&*displacement).map(|(&p, &d)| add(p, d)).collect();
        let mut is_stopped = vec![false; at.len()];
        // A wall that gives way to a later one is where it will be when earlier ones give way to it.
        for Stops { sheet, tree, kept } in self.stops.iter_mut().rev() {
            tree.refit(&at, threads);
            let mut open = kept.clone();
            for _ in 0..CORNER {
                let ends: Vec<Point> = open.iter().map(|kept| at[kept.node.index()]).collect();
                let found = tree.closest_all(&ends, None, threads);
                let mut places = ends.iter().zip(found);
                open.retain(|kept| {
                    let Some((&end, Some(found))) = places.next() else { return false };
                    let stop = kept.stop(sheet, &at, end, &found);
                    at[kept.node.index()] = stop.unwrap_or(end);
                    stop.is_some()
                });
                open.iter().for_each(|kept| is_stopped[kept.node.index()] = true);
            }
        }
        for (i, d) in displacement.iter_mut().enumerate().filter(|(i, _)| is_stopped[*i]) {
            *d = sub(at[i], places[i]);
        }
        is_stopped.iter().filter(|is_stopped| **is_stopped).count()
    }
}

impl Stops {
    /// `earlier` walls are kept away from triangles of a `later` one.
    fn new(
        distance: f64,
        wall: &Wall,
        earlier: &[Vec<[VertexId; 3]>],
        later: &[[VertexId; 3]],
        threads: &Threads,
    ) -> Self {
        let places = &wall.places;
        let sheet = Sheet::new(places.len(), later.to_vec());
        let tree = NearestTriangle::new(places, later, threads);
        let mut nodes = earlier.concat().as_flattened().to_vec();
        nodes.retain(|v| sheet.stars.list(v.index()).is_empty());
        nodes.sort_unstable();
        nodes.dedup();
        let starts: Vec<Point> = nodes.iter().map(|v| places[v.index()]).collect();
        let found = tree.closest_all(&starts, None, threads);
        let kept = |((&node, &start), found): ((&VertexId, &Point), Option<Closest>)| {
            let found = found?;
            let off = sub(start, found.point);
            let side = if dot(off, sheet.normal(places, &found)) < 0.0 { -1.0 } else { 1.0 };
            Some(Kept { node, side, least: distance.min(norm(off)) })
        };
        let kept = nodes.iter().zip(&starts).zip(found).filter_map(kept).collect();
        Self { sheet, tree, kept }
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

    /// The normal at the nearest place, not of unit length.
    fn normal(&self, at: &[Point], found: &Closest) -> Point {
        let between = self.between(found);
        let corner = |t: [VertexId; 3]| match between.as_slice() {
            &[one] => t.iter().position(|v| *v == one),
            _ => None,
        };
        let corners = |t: [VertexId; 3]| t.map(|v| at[v.index()]);
        normal_where_they_meet(self.round(&between).map(|t| (corners(t), corner(t))))
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
