//! The vertices: the points as given, corners of a box around them, and points on segments, which have no
//! exact coordinates.
//!
//! Ties are broken as in the triangulation of the points: each vertex is lifted by an infinitesimal that
//! grows with its rank, its place in the order of insertion; points on segments come last.

use super::share::Share;
use crate::base::{Point, VertexId};
use crate::geometry::predicates::spot::{Between, Spot, insphere_perturbed_of, orient3d_of, volume_ratios};
use crate::geometry::predicates::{insphere_perturbed, orient3d};

/// An input edge, by its index in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct SegmentId(pub(super) u32);

/// Where a point lies on a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnSegment {
    pub(super) segment: SegmentId,
    /// 0 at the segment's first end, 1 at its second.
    pub(super) share: Share,
}

/// The place of a point that has no exact coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) enum Place {
    On(OnSegment),
    /// In a triangle of the surface, given by its number, at these fractions of the ways from its first
    /// corner to the others.
    In(u32, [f64; 2]),
}

/// All vertices.
pub(super) struct Sites {
    /// Coordinates, rounded where necessary.
    near: Vec<Point>,
    n_given: usize,
    /// For vertices after the given ones, their place in `on` if they lie on a segment or in a triangle.
    later: Vec<Option<u32>>,
    on: Vec<(VertexId, Place, Between)>,
    n_on_segments: usize,
    ranks: Vec<u32>,
}

impl Sites {
    /// Makes sites of the given points and the order in which they were inserted, from place 1 on.
    pub(super) fn new(given: Vec<Point>, order: &[u32]) -> Self {
        let mut ranks = vec![0; given.len()];
        order.iter().enumerate().skip(1).for_each(|(rank, &id)| ranks[id as usize] = rank as u32);
        Self { n_given: given.len(), near: given, later: Vec::new(), on: Vec::new(), n_on_segments: 0, ranks }
    }

    /// The number of vertices, those on segments included.
    pub(super) fn len(&self) -> usize {
        self.near.len()
    }

    /// The last four given vertices: a positive tet far around all others.
    pub(super) fn around_all(&self) -> [VertexId; 4] {
        let n = self.n_given;
        [n - 4, n - 3, n - 2, n - 1].map(VertexId::new)
    }

    /// Adds a point on a segment between two given vertices.
    pub(super) fn add(&mut self, [from, to]: [VertexId; 2], place: OnSegment) -> VertexId {
        let between = Between::new(self.near[from.index()], self.near[to.index()], place.share.parts());
        self.n_on_segments += 1;
        self.put(Place::On(place), between)
    }

    /// Adds a point in a triangle of given vertices, at these fractions of the ways from its first corner to
    /// the others.
    pub(super) fn add_in(&mut self, triangle: u32, corners: [VertexId; 3], shares: [f64; 2]) -> VertexId {
        let [from, to, third] = corners.map(|v| self.near[v.index()]);
        self.put(Place::In(triangle, shares), Between::within(from, [to, third], shares))
    }

    fn put(&mut self, place: Place, between: Between) -> VertexId {
        let vertex = self.push(between.rounded(), Some(self.on.len() as u32));
        self.on.push((vertex, place, between));
        vertex
    }

    /// Adds a point with the coordinates given.
    pub(super) fn add_point(&mut self, point: Point) -> VertexId {
        self.push(point, None)
    }

    /// Moves a vertex that was added by [`Self::add_point`].
    pub(super) fn move_to(&mut self, vertex: VertexId, point: Point) {
        self.near[vertex.index()] = point;
    }

    fn push(&mut self, near: Point, on: Option<u32>) -> VertexId {
        let vertex = VertexId::new(self.near.len());
        self.near.push(near);
        self.later.push(on);
        self.ranks.push(vertex.0 + 1);
        vertex
    }

    fn on(&self, vertex: VertexId) -> Option<&(VertexId, Place, Between)> {
        let later = vertex.index().checked_sub(self.n_given)?;
        self.later[later].map(|i| &self.on[i as usize])
    }

    /// Where a vertex lies, if it lies on a segment or in a triangle.
    pub(super) fn place(&self, vertex: VertexId) -> Option<Place> {
        self.on(vertex).map(|on| on.1)
    }

    /// Whether a vertex is a Steiner point off the surface, which may be removed.
    pub(super) fn is_steiner_inside(&self, vertex: VertexId) -> bool {
        vertex.index() >= self.n_given && self.place(vertex).is_none()
    }

    /// Where a vertex lies, if it lies on a segment.
    pub(super) fn on_segment(&self, vertex: VertexId) -> Option<OnSegment> {
        match self.place(vertex)? {
            Place::On(place) => Some(place),
            Place::In(..) => None,
        }
    }

    /// The number of points on segments.
    pub(super) fn n_on_segments(&self) -> usize {
        self.n_on_segments
    }

    /// All points on segments and in triangles, in the order of their numbers.
    pub(super) fn all_placed(&self) -> impl Iterator<Item = (VertexId, Place)> + '_ {
        self.on.iter().map(|on| (on.0, on.1))
    }

    /// The coordinates of a vertex, rounded where necessary.
    pub(super) fn near(&self, vertex: VertexId) -> Point {
        self.near[vertex.index()]
    }

    pub(super) fn spot(&self, vertex: VertexId) -> Spot<'_> {
        self.on(vertex).map_or_else(|| Spot::Given(self.near(vertex)), |on| Spot::On(&on.2))
    }

    pub(super) fn rank(&self, vertex: VertexId) -> u32 {
        self.ranks[vertex.index()]
    }

    /// The sign of the volume of the tet of four vertices.
    #[inline]
    pub(super) fn orient3d(&self, v: [VertexId; 4]) -> i8 {
        if v.iter().all(|v| v.index() < self.n_given) {
            let [a, b, c, d] = v.map(|v| self.near[v.index()]);
            return orient3d(a, b, c, d);
        }
        orient3d_of(v.map(|v| self.spot(v)))
    }

    /// The volumes of tets, all divided by one common number; accurate to the last digits.
    pub(super) fn volume_ratios<const N: usize>(&self, tets: [[VertexId; 4]; N]) -> [f64; N] {
        volume_ratios(tets.map(|tet| tet.map(|v| self.spot(v))))
    }

    /// Whether `query` lies inside the circumsphere of a positive tet; ties are broken, so there is always an
    /// answer.
    #[inline]
    pub(super) fn is_inside(&self, [a, b, c, d]: [VertexId; 4], query: VertexId) -> bool {
        let v = [a, b, c, d, query];
        let ranks = v.map(|v| self.rank(v));
        if v.iter().all(|v| v.index() < self.n_given) {
            return insphere_perturbed(v.map(|v| self.near[v.index()]), ranks) > 0;
        }
        insphere_perturbed_of(v.map(|v| self.spot(v)), ranks) > 0
    }
}
