//! The rims of holes: chains of open edges, in the direction in which a triangle in the hole would run along
//! them.

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
    /// The triangle that has the edge.
    pub(super) triangle: u32,
}

/// Rims that close without touching themselves, and chains of open edges that do not close.
#[derive(Debug, Default)]
pub(super) struct Rims {
    pub(super) closed: Vec<Vec<RimEdge>>,
    pub(super) unclosed: Vec<Vec<RimEdge>>,
}

/// A closed chain of open edges of a surface that has to be closed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Rim {
    /// The surface.
    pub surface: u32,
    /// Number of edges.
    pub edges: usize,
    /// Sum of the lengths of its edges.
    pub length: f64,
    /// Twice the largest distance of its vertices from its centre.
    pub diameter: f64,
    /// The mean of its vertices.
    pub centre: Point,
}

impl Rim {
    /// Measures a rim; `None` if a vertex is not finite.
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

/// The open edges of surfaces that have to be closed.
pub(super) struct OpenEdges {
    /// The closed rims, the longest first.
    pub(super) rims: Vec<Rim>,
    /// Number of open edges that are in no rim.
    pub(super) n_torn_edges: usize,
}

/// The open edges of surfaces that have to be closed.
pub(super) fn of_boundaries(surfaces: &Surfaces, sides: &[Side]) -> OpenEdges {
    let found = rims(surfaces.points.len(), sides, |surface| surfaces.role(surface) == Role::Boundary);
    let mut rims: Vec<Rim> = found.closed.iter().filter_map(|rim| Rim::of(surfaces.points, rim)).collect();
    rims.sort_by(|a, b| b.length.total_cmp(&a.length));
    OpenEdges { rims, n_torn_edges: found.unclosed.iter().map(Vec::len).sum() }
}

/// The rims of one surface: first the closed ones, with their vertices in the order in which a triangle in
/// the hole would have them; then the vertices of chains of open edges that do not close, since triangles
/// there do not face the same side.
///
/// Panics if a triangle names a point that does not exist.
pub fn open_rims(points: &[Point], triangles: &[[VertexId; 3]]) -> [Vec<Vec<VertexId>>; 2] {
    let surface_of = vec![0; triangles.len()];
    let surfaces = Surfaces::new(points, triangles, &surface_of, &[Role::Boundary]);
    let rims = rims(points.len(), &sorted_sides(&surfaces, |_| true), |_| true);
    let vertices = |rim: Vec<RimEdge>| rim.iter().map(|edge| edge.from).collect();
    [rims.closed, rims.unclosed].map(|all| all.into_iter().map(vertices).collect())
}

/// The rims of the surfaces for which `is_wanted` is `true`.
pub(super) fn rims(n_points: usize, sides: &[Side], is_wanted: impl Fn(u32) -> bool) -> Rims {
    let mut open: Vec<RimEdge> = edges(sides)
        .filter(|same| same.len() == 1 && is_wanted(same[0].surface))
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
        walk.trace(start, &mut rims);
    }
    rims
}

struct Walk {
    open: Vec<RimEdge>,
    is_used: Vec<bool>,
    /// For the first edge of a vertex: how many of the vertex's edges are known to be used, so that none is
    /// tested twice.
    n_passed: Vec<usize>,
    /// For each vertex, the index on the path of the edge that starts there.
    place: Vec<Option<usize>>,
}

impl Walk {
    /// Walks from an edge until no unused edge leads on; whenever the path returns to itself, a closed rim is
    /// cut off.
    fn trace(&mut self, start: usize, rims: &mut Rims) {
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
            next = if path.is_empty() { None } else { self.next_edge(edge) };
        }
        path.iter().for_each(|edge| self.place[edge.from.index()] = None);
        if !path.is_empty() {
            rims.unclosed.push(path);
        }
    }

    /// The first unused edge that starts where this one ends.
    fn next_edge(&mut self, edge: RimEdge) -> Option<usize> {
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
