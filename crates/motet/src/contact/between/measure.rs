//! How near two bodies come within one tet, by those of its features that really are on their surfaces.

use super::simplices::Simplex;
use super::sites::{SiteId, Sites};
use crate::base::{BodyId, MaybeId, Point, VertexId};
use crate::geometry::distance::{Closest, point_segment, point_triangle, segment_segment};
use crate::geometry::vector::{add, dot, scale, sub};

/// The part that one body has of a tet: its vertices there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) body: BodyId,
    /// The sites of the tet; none where this body has no vertex.
    pub(super) sites: Simplex,
    vertices: [MaybeId<VertexId>; 4],
    points: [Point; 4],
}

/// A pair of points of two parts, as weights of the four vertices.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pair {
    pub(super) distance_squared: f64,
    pub(super) on_a: [f64; 4],
    pub(super) on_b: [f64; 4],
}

const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 2, 3], [0, 1, 3], [0, 1, 2]];

impl Part {
    /// The part that `body` has of a tet.
    pub(super) fn new(tet: Simplex, body: BodyId, sites: &Sites, points: &[Point]) -> Self {
        let vertices: [MaybeId<VertexId>; 4] = tet.map(|s| sites.vertex(s, body).into());
        let mut own = tet;
        let mut places = [[0.0; 3]; 4];
        for i in 0..4 {
            match vertices[i].get() {
                None => own[i] = MaybeId::NONE,
                Some(v) => places[i] = points[v.index()],
            }
        }
        Self { body, sites: own, vertices, points: places }
    }

    /// The part with only the vertex at this place.
    pub(super) fn vertex(mut self, i: usize) -> Self {
        for k in (0..4).filter(|&k| k != i) {
            self.sites[k] = MaybeId::NONE;
        }
        self
    }

    /// The point with these weights.
    pub(super) fn at(&self, weights: &[f64; 4]) -> Point {
        (0..4)
            .filter(|&i| weights[i] != 0.0)
            .fold([0.0; 3], |sum, i| add(sum, scale(self.points[i], weights[i])))
    }

    /// The places at which this body has a vertex.
    pub(super) fn has(&self) -> impl Iterator<Item = usize> + Clone + '_ {
        (0..4).filter(|&i| self.sites[i].is_some())
    }

    /// The vertices of this body.
    pub(super) fn own_vertices(&self) -> impl Iterator<Item = VertexId> + Clone + '_ {
        self.has().filter_map(|i| self.vertices[i].get())
    }

    /// The sites of this body.
    pub(super) fn own_sites(&self) -> impl Iterator<Item = SiteId> + Clone + '_ {
        self.sites.into_iter().filter_map(MaybeId::get)
    }

    /// The vertex of the largest weight, the first of those equally large.
    pub(super) fn heaviest(&self, weights: &[f64; 4]) -> Option<VertexId> {
        let heaviest = (1..4).fold(0, |m, i| if weights[i] > weights[m] { i } else { m });
        self.vertices[heaviest].get()
    }

    fn is_vertex(&self) -> bool {
        self.has().count() == 1
    }

    /// The edges or facets of the tet that belong to this body and are features of its surface.
    fn real<'a, const N: usize>(
        &'a self,
        all: &'a [[usize; N]],
        sites: &'a Sites,
    ) -> impl Iterator<Item = [usize; N]> + 'a {
        let own = move |places: &&[usize; N]| {
            let own = places.map(|i| self.sites[i]);
            own.iter().all(|site| site.is_some())
                && sites.is_real(self.body, &own.map(|site| site.get().unwrap_or_default()))
        };
        all.iter().filter(own).copied()
    }

    fn points<const N: usize>(&self, places: [usize; N]) -> [Point; N] {
        places.map(|i| self.points[i])
    }
}

/// The nearest pair of points of the features that two bodies have in a tet: vertices, edges and facets of
/// the tet that are also features of their surfaces. An edge that is a chord across a dent, or a facet that
/// is no triangle, is left out: the body is not there.
pub(super) fn nearest(a: &Part, b: &Part, sites: &Sites) -> Pair {
    let mut best = Pair { distance_squared: f64::INFINITY, on_a: [0.0; 4], on_b: [0.0; 4] };
    for i in a.has() {
        for k in b.has() {
            let offset = sub(b.points[k], a.points[i]);
            best.offer(
                [i],
                [k],
                &Closest { distance_squared: dot(offset, offset), on_a: [1.0], on_b: [1.0], offset },
            );
        }
    }
    // Edges are collected, since each is used more than once, and there are rarely more than two.
    let edges_a: Vec<_> = if a.is_vertex() { Vec::new() } else { a.real(&EDGES, sites).collect() };
    let mut has_facet = false;
    for facet in b.real(&FACETS, sites) {
        has_facet = true;
        for i in a.has() {
            best.offer([i], facet, &point_triangle::closest(a.points[i], b.points(facet)));
        }
    }
    // A vertex against a whole triangle needs nothing else.
    if a.is_vertex() && has_facet && b.has().count() == 3 {
        return best;
    }
    let edges_b: Vec<_> = if b.is_vertex() { Vec::new() } else { b.real(&EDGES, sites).collect() };
    for &edge in &edges_b {
        for i in a.has() {
            best.offer([i], edge, &point_segment::closest(a.points[i], b.points(edge)));
        }
    }
    for k in b.has() {
        for &edge in &edges_a {
            best.offer(edge, [k], &point_segment::closest(b.points[k], a.points(edge)).swapped());
        }
        if !a.is_vertex() {
            for facet in a.real(&FACETS, sites) {
                best.offer(facet, [k], &point_triangle::closest(b.points[k], a.points(facet)).swapped());
            }
        }
    }
    for &of_a in &edges_a {
        for &of_b in &edges_b {
            best.offer(of_a, of_b, &segment_segment::closest(a.points(of_a), b.points(of_b)));
        }
    }
    best
}

impl Pair {
    fn offer<const A: usize, const B: usize>(&mut self, a: [usize; A], b: [usize; B], found: &Closest<A, B>) {
        if found.distance_squared < self.distance_squared {
            (self.on_a, self.on_b) = ([0.0; 4], [0.0; 4]);
            a.iter().zip(found.on_a).for_each(|(&i, w)| self.on_a[i] = w);
            b.iter().zip(found.on_b).for_each(|(&i, w)| self.on_b[i] = w);
            self.distance_squared = found.distance_squared;
        }
    }
}
