//! The creases of given surfaces, and the first sites on them.

use std::collections::BTreeMap;

use super::spaced::Spaced;
use crate::base::{Point, Threads, VertexId, sorted_ids};
use crate::geometry::triangle::{self, area_vector};
use crate::geometry::vector::{add, distance, dot, scale, sub, unit};
use crate::preflight::crossing::own_crossings;
use crate::spatial::NearestTriangle;

/// Triangles that meet at more than this angle have a crease between them: cosine of 40 degrees.
const CREASE: f64 = 0.766;

/// A crease goes on straight through a vertex if it bends by less than this: cosine of 30 degrees.
const STRAIGHT: f64 = 0.866;

/// The creases of surfaces.
pub(super) struct Creases {
    /// Segments, as triangles without area.
    nearest: Option<NearestTriangle>,
    /// Vertices where creases end, bend or branch.
    pub(super) corners: Vec<VertexId>,
}

impl Creases {
    pub(super) fn new(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Self {
        let normals: Vec<Option<Point>> =
            threads.map(triangles.len(), |t| unit(area_vector(triangles[t].map(|v| points[v.index()]))));
        let mut sides: Vec<([VertexId; 2], u32)> = (0u32..)
            .zip(triangles)
            .flat_map(|(t, [a, b, c])| [[*a, *b], [*b, *c], [*c, *a]].map(|side| (sorted_ids(side), t)))
            .collect();
        sides.sort_unstable();
        let is_crease = |same: &[([VertexId; 2], u32)]| match same {
            [x, y] => match (normals[x.1 as usize], normals[y.1 as usize]) {
                (Some(m), Some(n)) => dot(m, n).abs() < CREASE || dot(m, n) < 0.0,
                _ => false,
            },
            _ => true,
        };
        let edges: Vec<[VertexId; 2]> =
            sides.chunk_by(|x, y| x.0 == y.0).filter(|same| is_crease(same)).map(|same| same[0].0).collect();
        let mut ends: BTreeMap<VertexId, Vec<VertexId>> = BTreeMap::new();
        for &[u, v] in &edges {
            ends.entry(u).or_default().push(v);
            ends.entry(v).or_default().push(u);
        }
        let towards = |from: VertexId, to: VertexId| unit(sub(points[to.index()], points[from.index()]));
        let is_corner = |v: VertexId, ends: &[VertexId]| match *ends {
            [a, b] => !matches!((towards(a, v), towards(v, b)), (Some(m), Some(n)) if dot(m, n) > STRAIGHT),
            _ => true,
        };
        let corners = ends.iter().filter(|(v, ends)| is_corner(**v, ends)).map(|(v, _)| *v).collect();
        let mut segments: Vec<[Point; 2]> =
            edges.iter().map(|edge| edge.map(|v| points[v.index()])).collect();
        segments.extend(crossing_lines(points, triangles, threads));
        let ends: Vec<Point> = segments.as_flattened().to_vec();
        let segments: Vec<[VertexId; 3]> =
            (0..segments.len()).map(|i| [2 * i, 2 * i + 1, 2 * i + 1].map(VertexId::new)).collect();
        let nearest = (!segments.is_empty()).then(|| NearestTriangle::new(&ends, &segments, threads));
        Self { nearest, corners }
    }

    /// The nearest place on a crease within a length.
    pub(super) fn nearest(&self, p: Point, length: f64) -> Option<Point> {
        self.nearest.as_ref()?.closest_within(p, length).map(|closest| closest.point)
    }
}

/// The lines along which triangles cross, rounded.
fn crossing_lines(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Vec<[Point; 2]> {
    let pairs = own_crossings(points, triangles, threads);
    let corners = |t: u32| triangles[t as usize].map(|v| points[v.index()]);
    let line = |k: usize| {
        let [s, t] = pairs[k].map(corners);
        let mut places = pierced(s, t);
        places.extend(pierced(t, s));
        let far =
            |p: Point| places.iter().copied().max_by(|x, y| distance(p, *x).total_cmp(&distance(p, *y)));
        let first = far(*places.first()?)?;
        far(first).map(|last| [first, last]).filter(|[p, q]| p != q)
    };
    threads.map(pairs.len(), line).into_iter().flatten().collect()
}

/// The places where sides of a triangle go through another one.
fn pierced(triangle: [Point; 3], by: [Point; 3]) -> Vec<Point> {
    let normal = area_vector(triangle);
    let height = |p: Point| dot(normal, sub(p, triangle[0]));
    let through = |k: usize| {
        let [p, q] = [by[k], by[(k + 1) % 3]];
        let [from, to] = [height(p), height(q)];
        (from * to < 0.0).then(|| add(p, scale(sub(q, p), from / (from - to))))
    };
    let is_within = |p: &Point| {
        let near = triangle::at(triangle, triangle::closest(triangle, *p));
        distance(near, *p) <= 1e-9 * triangle::longest_side(triangle)
    };
    (0..3).filter_map(through).filter(is_within).collect()
}

/// Chooses vertices, in order, that are not nearer than `least` to one chosen before.
pub(super) fn apart(
    points: &[Point],
    vertices: impl IntoIterator<Item = VertexId>,
    least: f64,
) -> Vec<VertexId> {
    let mut spaced = Spaced::new(least);
    let mut is_chosen = |v: &VertexId| {
        let is_free = spaced.is_free(points[v.index()], least);
        if is_free {
            spaced.insert(points[v.index()]);
        }
        is_free
    };
    vertices.into_iter().filter(|v| is_chosen(v)).collect()
}
