//! The rims of holes: open edges, one after the other, as a triangle in the hole would run along them.

use std::fmt;

use serde::Serialize;

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, distance, in_range, scale};
use crate::preflight::sides::{Side, edges, sorted_sides};
use crate::preflight::surfaces::{Role, Surfaces};

/// An open edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct RimEdge {
    pub(super) surface: u32,
    pub(super) from: VertexId,
    pub(super) to: VertexId,
    /// The triangle beyond.
    pub(super) triangle: u32,
}

/// Rims that lead back to their start, without touching themselves, and the edges that lead nowhere.
#[derive(Debug, Default)]
pub(super) struct Rims {
    pub(super) closed: Vec<Vec<RimEdge>>,
    pub(super) torn: Vec<Vec<RimEdge>>,
}

/// A closed chain of open edges of a surface that has to be closed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rim {
    /// The surface.
    pub surface: u32,
    /// How many edges it has.
    pub edges: usize,
    /// The sum of their lengths.
    pub length: f64,
    /// The largest distance of its vertices from its centre, twice.
    pub diameter: f64,
    /// The mean of its vertices.
    pub centre: Point,
}

impl Rim {
    /// `None` where a vertex is not finite.
    fn of(points: &[Point], edges: &[RimEdge]) -> Option<Self> {
        let at = |v: VertexId| points[v.index()];
        if !edges.iter().all(|edge| in_range(at(edge.from)) && in_range(at(edge.to))) {
            return None;
        }
        let part = 1.0 / edges.len() as f64;
        let centre = edges.iter().fold([0.0; 3], |sum, edge| add(sum, scale(at(edge.from), part)));
        Some(Self {
            surface: edges.first()?.surface,
            edges: edges.len(),
            length: edges.iter().map(|edge| distance(at(edge.from), at(edge.to))).sum(),
            diameter: 2.0 * edges.iter().map(|edge| distance(at(edge.from), centre)).fold(0.0, f64::max),
            centre,
        })
    }
}

impl fmt::Display for Rim {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.centre;
        write!(
            f,
            "surface {}, {} edges, {:.6} long, {:.6} across, centre ({x:.6}, {y:.6}, {z:.6})",
            self.surface, self.edges, self.length, self.diameter
        )
    }
}

/// The closed rims of surfaces that have to be closed, the longest first; and how many open edges are in none.
pub(super) fn of_boundaries(surfaces: &Surfaces, sides: &[Side]) -> (Vec<Rim>, usize) {
    let found = rims(surfaces.points.len(), sides, |surface| surfaces.role(surface) == Role::Boundary);
    let mut rims: Vec<Rim> = found.closed.iter().filter_map(|rim| Rim::of(surfaces.points, rim)).collect();
    rims.sort_by(|a, b| b.length.total_cmp(&a.length));
    (rims, found.torn.iter().map(Vec::len).sum())
}

/// The rims of one surface: vertices in the order in which a triangle in the hole would have them, and those of open edges that lead nowhere, since triangles there
/// do not face the same side.
///
/// Panics when a triangle names a point that is not there.
pub fn open_rims(points: &[Point], triangles: &[[VertexId; 3]]) -> [Vec<Vec<VertexId>>; 2] {
    let surface_of = vec![0; triangles.len()];
    let surfaces = Surfaces::new(points, triangles, &surface_of, &[Role::Boundary]);
    let rims = rims(points.len(), &sorted_sides(&surfaces, |_| true), |_| true);
    let vertices = |rim: Vec<RimEdge>| rim.iter().map(|edge| edge.from).collect();
    [rims.closed, rims.torn].map(|all| all.into_iter().map(vertices).collect())
}

/// The rims of the surfaces that are asked about.
pub(super) fn rims(n_points: usize, sides: &[Side], is_asked: impl Fn(u32) -> bool) -> Rims {
    let mut open: Vec<RimEdge> = edges(sides)
        .filter(|same| same.len() == 1 && is_asked(same[0].surface))
        .map(|same| {
            let Side { surface, edge: [low, high], triangle, is_forward, .. } = same[0];
            let (from, to) = if is_forward { (high, low) } else { (low, high) };
            RimEdge { surface, from, to, triangle }
        })
        .collect();
    open.sort_unstable();
    let n = open.len();
    let mut walk = Walk { open, is_used: vec![false; n], n_passed: vec![0; n], place: vec![None; n_points] };
    let mut rims = Rims::default();
    for start in 0..walk.open.len() {
        walk.go(start, &mut rims);
    }
    rims
}

struct Walk {
    open: Vec<RimEdge>,
    is_used: Vec<bool>,
    /// For the first edge of a vertex: how many of the vertex's edges are known to be used, so that none is asked twice.
    n_passed: Vec<usize>,
    /// Where on the path its edge from a vertex stands.
    place: Vec<Option<usize>>,
}

impl Walk {
    /// Walks until nothing leads on; whenever the path comes back to itself, a rim is cut off.
    fn go(&mut self, start: usize, rims: &mut Rims) {
        if self.is_used[start] {
            return;
        }
        let mut path = Vec::new();
        let mut next = Some(start);
        while let Some(i) = next {
            self.is_used[i] = true;
            let edge = self.open[i];
            self.place[edge.from.index()] = Some(path.len());
            path.push(edge);
            if let Some(first) = self.place[edge.to.index()] {
                let rim = path.split_off(first);
                rim.iter().for_each(|edge| self.place[edge.from.index()] = None);
                rims.closed.push(rim);
            }
            next = if path.is_empty() { None } else { self.leading_on(edge) };
        }
        path.iter().for_each(|edge| self.place[edge.from.index()] = None);
        if !path.is_empty() {
            rims.torn.push(path);
        }
    }

    /// The first edge that starts where this one ends and is not used yet.
    fn leading_on(&mut self, edge: RimEdge) -> Option<usize> {
        let key = (edge.surface, edge.to);
        let start = self.open.partition_point(|x| (x.surface, x.from) < key);
        let starts_there = |i: usize| self.open.get(i).is_some_and(|x| (x.surface, x.from) == key);
        let mut i = start + self.n_passed.get(start).copied().unwrap_or(0);
        while starts_there(i) && self.is_used[i] {
            i += 1;
        }
        let leads_on = starts_there(i);
        if let Some(n_passed) = self.n_passed.get_mut(start) {
            *n_passed = i - start;
        }
        leads_on.then_some(i)
    }
}
