//! The vertices: points as they were given, corners of a box around them, and points on segments, which have no coordinates.
//!
//! Ties are broken as in the triangulation of the points: each vertex is lifted by an infinitesimal that grows with its rank, the place
//! in the order of insertion; points on segments come last.

use crate::base::{Point, VertexId};
use crate::geometry::predicates::spot::{Between, Spot, insphere_perturbed_of, orient3d_of};
use crate::geometry::predicates::{insphere_perturbed, orient3d};

/// An input edge, by its place in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct SegmentId(pub(super) u32);

/// Where a point lies on a segment.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnSegment {
    pub(super) segment: SegmentId,
    /// 0 at the segment's first end, 1 at its second.
    pub(super) share: f64,
}

/// All vertices.
pub(super) struct Sites {
    given: Vec<Point>,
    on: Vec<Between>,
    places: Vec<OnSegment>,
    ranks: Vec<u32>,
}

impl Sites {
    /// Points, and the order in which they were inserted, from place 1 on.
    pub(super) fn new(given: Vec<Point>, order: &[u32]) -> Self {
        let mut ranks = vec![0; given.len()];
        order.iter().enumerate().skip(1).for_each(|(rank, &id)| ranks[id as usize] = rank as u32);
        Self { given, on: Vec::new(), places: Vec::new(), ranks }
    }

    /// How many there are, those on segments included.
    pub(super) fn len(&self) -> usize {
        self.given.len() + self.on.len()
    }

    /// How many have been given.
    pub(super) fn n_given(&self) -> usize {
        self.given.len()
    }

    /// Four vertices far around all others, a positive tet: the last ones given.
    pub(super) fn around_all(&self) -> [VertexId; 4] {
        let n = self.given.len();
        [n - 4, n - 3, n - 2, n - 1].map(VertexId::new)
    }

    /// Adds a point on a segment between two given vertices.
    pub(super) fn add(&mut self, [from, to]: [VertexId; 2], place: OnSegment) -> VertexId {
        let vertex = VertexId::new(self.len());
        self.on.push(Between::new(self.given[from.index()], self.given[to.index()], place.share));
        self.places.push(place);
        self.ranks.push(vertex.0 + 1);
        vertex
    }

    /// Where a vertex lies, if it lies on a segment.
    pub(super) fn on_segment(&self, vertex: VertexId) -> Option<OnSegment> {
        vertex.index().checked_sub(self.given.len()).map(|i| self.places[i])
    }

    /// All points on segments, in the order of their numbers.
    pub(super) fn places(&self) -> &[OnSegment] {
        &self.places
    }

    /// Coordinates, rounded where they must be.
    pub(super) fn near(&self, vertex: VertexId) -> Point {
        match vertex.index().checked_sub(self.given.len()) {
            None => self.given[vertex.index()],
            Some(i) => self.on[i].rounded(),
        }
    }

    pub(super) fn spot(&self, vertex: VertexId) -> Spot<'_> {
        match vertex.index().checked_sub(self.given.len()) {
            None => Spot::Given(self.given[vertex.index()]),
            Some(i) => Spot::On(&self.on[i]),
        }
    }

    pub(super) fn rank(&self, vertex: VertexId) -> u32 {
        self.ranks[vertex.index()]
    }

    /// Sign of the volume of the tet of four vertices.
    #[inline]
    pub(super) fn orient3d(&self, v: [VertexId; 4]) -> i8 {
        let n = self.given.len();
        if v.iter().all(|v| v.index() < n) {
            let [a, b, c, d] = v.map(|v| self.given[v.index()]);
            return orient3d(a, b, c, d);
        }
        orient3d_of(v.map(|v| self.spot(v)))
    }

    /// Whether `query` lies inside the sphere through a positive tet; ties are broken, so there is always an answer.
    #[inline]
    pub(super) fn is_inside(&self, [a, b, c, d]: [VertexId; 4], query: VertexId) -> bool {
        let (v, n) = ([a, b, c, d, query], self.given.len());
        let ranks = v.map(|v| self.rank(v));
        if v.iter().all(|v| v.index() < n) {
            return insphere_perturbed(v.map(|v| self.given[v.index()]), ranks) > 0;
        }
        insphere_perturbed_of(v.map(|v| self.spot(v)), ranks) > 0
    }
}
