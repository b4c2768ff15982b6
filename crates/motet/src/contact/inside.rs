//! Which vertices lie inside a closed surface, decided exactly by the winding number.
//!
//! A ray along an axis passes through triangles from behind (+1) and from the front (-1). The sum is how
//! often the surface winds around its origin, and a point is inside if that is not 0 (so also inside a
//! surface that is turned inside out, and inside either of two that overlap). Exact signs decide each
//! passage. The origin counts as moved by (e, e^2) across the ray, for an e smaller than any number
//! (Edelsbrunner and Mücke 1990, *Simulation of simplicity*), so a ray through a vertex or along an edge
//! passes each sheet of the surface once.
//!
//! Not every vertex needs a ray: if a triangle does not meet the surface, all its corners are on the same
//! side.

use crate::base::{Point, Threads, VertexId};
use crate::geometry::distance::segment_triangle;
use crate::geometry::predicates::orient3d;
use crate::geometry::vector::is_finite;
use crate::mesh::open_edges;
use crate::spatial::runs::{bounding_box, corners, in_runs};
use crate::spatial::{Bounds, BoxTree};

/// Whether every edge is used as often one way as the other: such a surface has an inside, and it winds
/// around each point a whole number of times. Vertices are compared by id; for a surface with repeated
/// vertices, [`seams`](fn@crate::mesh::seams) finds which of them are one.
pub fn is_closed(triangles: &[[VertexId; 3]]) -> bool {
    open_edges(triangles).is_empty()
}

/// Which of `vertices` lie inside the closed surface `b`. Vertices on it do not.
///
/// `a` is the surface of these vertices, and `crossings` the result of
/// [`crossings`](crate::preflight::crossings) for `a` and `b`. Vertices in no triangle of `a` are allowed;
/// each of them gets a ray, the others one for each connected part that the crossings leave. A surface `b`
/// that is not [closed](is_closed) has no inside: the answer is then that of the rays.
///
/// Duplicate triangles, triangles without area and triangles that cross others count as in the winding
/// number. Triangles with a corner that is not finite are left out.
///
/// Panics when a triangle or `vertices` name a point beyond `points`.
pub fn inside(
    points: &[Point],
    vertices: &[VertexId],
    a: &[[VertexId; 3]],
    b: &[[VertexId; 3]],
    crossings: &[[u32; 2]],
    threads: &Threads,
) -> Vec<bool> {
    let locations = locations(points, vertices, a, b, crossings, threads);
    locations.into_iter().map(|location| location == Location::Inside).collect()
}

/// Where a vertex is relative to a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Location {
    Inside,
    On,
    Outside,
}

/// Where each of `vertices` is relative to the surface `b`; arguments are those of [`inside`].
pub(super) fn locations(
    points: &[Point],
    vertices: &[VertexId],
    a: &[[VertexId; 3]],
    b: &[[VertexId; 3]],
    crossings: &[[u32; 2]],
    threads: &Threads,
) -> Vec<Location> {
    let mut is_on = vec![false; points.len()];
    b.as_flattened().iter().for_each(|v| is_on[v.index()] = true);
    let part = parts(points.len(), a, crossings, &is_on);
    let mut queries: Vec<u32> =
        vertices.iter().filter(|v| !is_on[v.index()]).map(|v| part[v.index()]).collect();
    queries.sort_unstable();
    queries.dedup();
    let rays = Rays::new(points, b, queries.len());
    let answers = in_runs(queries.len(), threads, |near, run| {
        run.map(|i| match rays.winding(points[queries[i] as usize], near) {
            None => Location::On,
            Some(0) => Location::Outside,
            Some(_) => Location::Inside,
        })
        .collect()
    });
    let of_part = |part| queries.binary_search(&part).map_or(Location::Outside, |i| answers[i]);
    vertices.iter().map(|v| if is_on[v.index()] { Location::On } else { of_part(part[v.index()]) }).collect()
}

/// The smallest vertex of each vertex's part: corners of triangles that cross nothing belong together, except
/// those on `b`.
fn parts(n_points: usize, a: &[[VertexId; 3]], crossings: &[[u32; 2]], is_on: &[bool]) -> Vec<u32> {
    let mut is_cut = vec![false; a.len()];
    for &[i, _] in crossings {
        if let Some(is_cut) = is_cut.get_mut(i as usize) {
            *is_cut = true;
        }
    }
    let mut parent: Vec<u32> = (0..n_points as u32).collect();
    for (triangle, _) in a.iter().zip(is_cut).filter(|(_, is_cut)| !is_cut) {
        for k in 0..3 {
            let edge = [triangle[k], triangle[(k + 1) % 3]];
            if edge.iter().all(|v| !is_on[v.index()]) {
                let [u, v] = edge.map(|v| find_root(&mut parent, v.0));
                parent[u.max(v) as usize] = u.min(v);
            }
        }
    }
    // The entry above has a smaller id, so it is done already.
    for v in 0..n_points {
        parent[v] = parent[parent[v] as usize];
    }
    parent
}

/// The root of `v`; halves the path on the way (Tarjan and van Leeuwen 1984, *Worst-case analysis of set
/// union algorithms*).
fn find_root(parent: &mut [u32], mut v: u32) -> u32 {
    while parent[v as usize] != v {
        parent[v as usize] = parent[parent[v as usize] as usize];
        v = parent[v as usize];
    }
    v
}

/// Up to this many rays examine every triangle: building a tree takes as long as 22 rays without it.
const MAX_RAYS_WITHOUT_TREE: usize = 16;

/// A surface that rays pass through, along an axis that is called x.
struct Rays<'a> {
    points: &'a [Point],
    triangles: &'a [[VertexId; 3]],
    /// None if there are few rays.
    tree: Option<BoxTree>,
    /// The axis that is called x.
    axis: usize,
}

impl<'a> Rays<'a> {
    fn new(points: &'a [Point], triangles: &'a [[VertexId; 3]], n_rays: usize) -> Self {
        let mut rays = Self { points, triangles, tree: None, axis: 0 };
        if n_rays > MAX_RAYS_WITHOUT_TREE {
            rays.axis = sparsest_axis(&rays.boxes().collect::<Vec<_>>());
            rays.tree = Some(BoxTree::new(&rays.boxes().collect::<Vec<_>>()));
        }
        rays
    }

    /// The corners, with axes permuted so that rays run along x.
    fn corners(&self, j: u32) -> [Point; 3] {
        corners(self.points, self.triangles[j as usize]).map(|p| permuted(p, self.axis))
    }

    fn boxes(&self) -> impl Iterator<Item = Bounds> {
        (0..self.triangles.len() as u32).map(|j| bounding_box(&self.corners(j)))
    }

    /// The triangles with finite corners that the ray from `q` may pass.
    fn near(&self, q: Point, near: &mut Vec<u32>) {
        if let Some(tree) = &self.tree {
            return tree.touching([q, [f64::MAX, q[1], q[2]]], near);
        }
        let may_pass = |t: [Point; 3]| {
            t.iter().any(|p| p[0] >= q[0])
                && (1..3).all(|k| t.iter().any(|p| p[k] <= q[k]) && t.iter().any(|p| p[k] >= q[k]))
                && t.iter().all(|&p| is_finite(p))
        };
        near.clear();
        near.extend((0..self.triangles.len() as u32).filter(|&j| may_pass(self.corners(j))));
    }

    /// How often the surface winds around `q`; `None` if `q` is on the surface.
    fn winding(&self, q: Point, near: &mut Vec<u32>) -> Option<i64> {
        if !is_finite(q) {
            return Some(0);
        }
        let q = permuted(q, self.axis);
        self.near(q, near);
        let mut winding = 0;
        for &j in near.iter() {
            let triangle = self.corners(j);
            if triangle.iter().any(|p| p[0] <= q[0]) && segment_triangle::meet([q, q], triangle) {
                return None;
            }
            winding += crossing_sign(q, triangle);
        }
        Some(winding)
    }
}

/// A cyclic permutation of the axes, which keeps handedness.
fn permuted(p: Point, axis: usize) -> Point {
    [0, 1, 2].map(|k| p[(axis + k) % 3])
}

/// The axis along which a ray meets the fewest boxes: the one for which their areas add up to the least part
/// of the whole.
fn sparsest_axis(boxes: &[Bounds]) -> usize {
    let size = |[low, high]: Bounds| [0, 1, 2].map(|k| high[k] - low[k]);
    let finite = || boxes.iter().filter(|bounds| bounds[0][0].is_finite());
    let whole = size(bounding_box(&finite().copied().flatten().collect::<Vec<_>>()));
    let covers = |axis: usize| -> f64 {
        let [u, v] = [1, 2].map(|k| (axis + k) % 3);
        let part = |s: Point| (s[u] / whole[u]) * (s[v] / whole[v]);
        finite().map(|bounds| part(size(*bounds))).sum()
    };
    let covered = [0, 1, 2].map(covers);
    (0..3).min_by(|&i, &j| covered[i].total_cmp(&covered[j])).unwrap_or(0)
}

/// What the ray from `q` along x adds to the winding number at a triangle that does not contain `q`.
fn crossing_sign(q: Point, [a, b, c]: [Point; 3]) -> i64 {
    let turn = turn(a, b, q);
    if turn == 0 || turn != self::turn(b, c, q) || turn != self::turn(c, a, q) {
        return 0;
    }
    // The normal's x component has the sign of the turn: the triangle is ahead if `q` lies on the side of
    // smaller x.
    if orient3d(a, b, c, q) * turn < 0 { i64::from(turn) } else { 0 }
}

/// The exact sign of the turn from `a` to `b` to `q`, seen along x, with `q` moved by (e, e^2). 0 only for an
/// edge along x.
fn turn(a: Point, b: Point, q: Point) -> i8 {
    let flat = |p: Point, x: f64| [x, p[1], p[2]];
    let sign = orient3d(flat(a, 0.0), flat(b, 0.0), flat(q, 0.0), flat(a, 1.0));
    if sign != 0 {
        return sign;
    }
    // (b - a) x (q - a) grows by -(b - a)_z e + (b - a)_y e^2.
    if a[2] != b[2] { if b[2] < a[2] { 1 } else { -1 } } else { (b[1] > a[1]) as i8 - (b[1] < a[1]) as i8 }
}
