//! Flat facets grown from triangles that are coplanar up to the rounding of their coordinates.
//!
//! A facet that a program has rotated, translated, or written with few digits is no longer exactly flat. Such
//! a facet grows from its largest triangle: a vertex belongs to it if it could have been coplanar with the
//! corners of that triangle before all four were rounded. This decides only what is tried first: whether tets
//! are positive is always decided by exact signs.

use super::plane::Plane;
use super::sites::Sites;
use crate::base::{Csr, Point, VertexId, sorted_ids};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{cross, dot, norm, sub};

/// Facets of triangles coplanar up to rounding. A facet grows from its largest triangle, and its vertices
/// keep to the plane of that triangle.
pub(super) struct GrownFacets {
    /// The facet of each triangle.
    pub(super) number: Vec<u32>,
    /// The triangle from which each facet has grown.
    pub(super) firsts: Vec<u32>,
}

impl GrownFacets {
    /// Grows the facets, where each coordinate may be off by `rounding` along its axis.
    pub(super) fn find(sites: &Sites, triangles: &[[VertexId; 3]], rounding: Point) -> Self {
        let edges = by_edge(triangles);
        let pairs: Vec<Pair> = edges.chunk_by(|a, b| a.0 == b.0).filter_map(pair).collect();
        let neighbors = Csr::from_pairs(triangles.len(), || {
            pairs.iter().flat_map(|&(_, [i, j])| [(i as usize, j), (j as usize, i)])
        });
        let corners = |i: u32| triangles[i as usize].map(|v| sites.near(v));
        let mut seeds: Vec<(f64, u32)> =
            (0..triangles.len() as u32).map(|i| (norm(area_vector(corners(i))), i)).collect();
        seeds.sort_unstable_by(|s, t| t.0.total_cmp(&s.0).then(s.1.cmp(&t.1)));
        let (mut number, mut firsts) = (vec![u32::MAX; triangles.len()], Vec::new());
        for (_, seed) in seeds {
            if number[seed as usize] != u32::MAX {
                continue;
            }
            let facet = firsts.len() as u32;
            firsts.push(seed);
            number[seed as usize] = facet;
            let plane = Plane::new(sites, triangles[seed as usize]);
            let band = Band::new(corners(seed), rounding);
            let mut todo = vec![(seed, triangles[seed as usize])];
            while let Some((i, from)) = todo.pop() {
                for &j in neighbors.list(i as usize) {
                    let to = turned_alike(from, triangles[j as usize]);
                    if number[j as usize] == u32::MAX && band.holds(corners(j)) && plane.turn(to) > 0 {
                        number[j as usize] = facet;
                        todo.push((j, to));
                    }
                }
            }
        }
        Self { number, firsts }
    }

    /// Whether two triangles belong to the same facet.
    pub(super) fn is_one(&self, i: u32, j: u32) -> bool {
        self.number[i as usize] == self.number[j as usize]
    }

    /// The triangle from which the facet of `i` has grown.
    pub(super) fn first(&self, i: u32) -> u32 {
        self.firsts[self.number[i as usize] as usize]
    }
}

/// A triangle, reversed if necessary to have the orientation of its neighbour `from`.
fn turned_alike(from: [VertexId; 3], [a, b, c]: [VertexId; 3]) -> [VertexId; 3] {
    let edges = |[a, b, c]: [VertexId; 3]| [[a, b], [b, c], [c, a]];
    let runs_the_same_way = edges([a, b, c]).iter().any(|e| edges(from).contains(e));
    if runs_the_same_way { [a, c, b] } else { [a, b, c] }
}

/// The set of points that could have been in the plane of a triangle before coordinates were rounded.
struct Band {
    corners: [Point; 3],
    /// The normal, of length twice the area.
    normal: Point,
    /// The largest displacement by rounding along the normal.
    width: f64,
}

impl Band {
    fn new(corners: [Point; 3], rounding: Point) -> Self {
        let [a, b, c] = corners;
        let normal = cross(sub(b, a), sub(c, a));
        let length = norm(normal);
        let width = (0..3).map(|i| (normal[i] / length).abs() * rounding[i]).sum();
        Self { corners, normal, width }
    }

    fn holds(&self, triangle: [Point; 3]) -> bool {
        triangle.iter().all(|&p| self.has(p))
    }

    /// Whether a point lies in the band. The plane is off at `p` by the errors of its corners, weighted with
    /// their barycentric coordinates there.
    fn has(&self, p: Point) -> bool {
        if self.corners.contains(&p) {
            return true;
        }
        let [a, b, c] = self.corners.map(|corner| sub(corner, p));
        let weight = |[u, v]: [Point; 2]| dot(cross(u, v), self.normal).abs();
        let weights: f64 = [[a, b], [b, c], [c, a]].into_iter().map(weight).sum();
        let squared = dot(self.normal, self.normal);
        dot(a, self.normal).abs() <= self.width * (1.0 + weights / squared) * squared.sqrt()
    }
}

/// An edge shared by exactly two triangles, with these two.
pub(super) type Pair = ([VertexId; 2], [u32; 2]);

/// The edges of all triangles, each with its triangle; sorted, with ascending ends.
pub(super) fn by_edge(triangles: &[[VertexId; 3]]) -> Vec<([VertexId; 2], u32)> {
    let mut edges: Vec<([VertexId; 2], u32)> = Vec::with_capacity(3 * triangles.len());
    for (i, &[a, b, c]) in triangles.iter().enumerate() {
        edges.extend([[a, b], [b, c], [c, a]].map(|e| (sorted_ids(e), i as u32)));
    }
    edges.sort_unstable();
    edges
}

/// The two triangles of an edge, if it has exactly two.
pub(super) fn pair(run: &[([VertexId; 2], u32)]) -> Option<Pair> {
    match *run {
        [(edge, i), (_, j)] => Some((edge, [i, j])),
        _ => None,
    }
}
