//! Vertices: where they are, and what they may do.

use crate::base::{Point, VertexId};
use crate::kernel::hold::Hold;

/// Points and their constraints, and which of their slots are free.
///
/// Ids are valid while a vertex exists; the slot that was freed last is reused first.
#[derive(Clone, Debug)]
pub(super) struct Vertices {
    points: Vec<Point>,
    holds: Vec<Hold>,
    free: Vec<VertexId>,
}

impl Vertices {
    /// Vertices without constraints.
    pub(super) fn new(points: Vec<Point>) -> Self {
        Self { holds: vec![Hold::Free; points.len()], points, free: Vec::new() }
    }

    /// The number of slots, free ones included; vertex ids are below it.
    #[inline]
    pub(super) fn n_slots(&self) -> usize {
        self.points.len()
    }

    /// The ids of all slots, free ones included, in rising order.
    pub(super) fn slots(&self) -> impl Iterator<Item = VertexId> + use<> {
        (0..self.points.len()).map(VertexId::new)
    }

    /// The free slots, in the order in which they were freed.
    #[inline]
    pub(super) fn free_slots(&self) -> &[VertexId] {
        &self.free
    }

    /// The slot that [`Self::take_slot`] takes next.
    #[inline]
    pub(super) fn next_slot(&self) -> VertexId {
        self.free.last().copied().unwrap_or_else(|| VertexId::new(self.points.len()))
    }

    /// The position of a vertex.
    #[inline(always)]
    pub(super) fn point(&self, vertex: VertexId) -> Point {
        self.points[vertex.index()]
    }

    /// The positions of all slots.
    #[inline]
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    /// The constraint on a vertex.
    #[inline(always)]
    pub(super) fn hold(&self, vertex: VertexId) -> Hold {
        self.holds[vertex.index()]
    }

    /// The constraints on all slots.
    #[inline]
    pub(super) fn holds(&self) -> &[Hold] {
        &self.holds
    }

    /// Moves a vertex.
    #[inline]
    pub(super) fn set_point(&mut self, vertex: VertexId, point: Point) {
        self.points[vertex.index()] = point;
    }

    /// Sets the constraint on a vertex.
    #[inline]
    pub(super) fn set_hold(&mut self, vertex: VertexId, hold: Hold) {
        self.holds[vertex.index()] = hold;
    }

    /// Takes the slot that was freed last, or a new one; what it held stays until it is set.
    pub(super) fn take_slot(&mut self) -> VertexId {
        self.free.pop().unwrap_or_else(|| {
            self.points.push([0.0; 3]);
            self.holds.push(Hold::Free);
            VertexId::new(self.points.len() - 1)
        })
    }

    /// Frees a slot.
    pub(super) fn free_slot(&mut self, vertex: VertexId) {
        self.free.push(vertex);
    }

    /// Takes the slot that was freed last off the list of free ones: undoes [`Self::free_slot`].
    pub(super) fn keep_last_freed(&mut self) {
        self.free.pop();
    }

    /// Drops all slots from the `n`-th: undoes [`Self::take_slot`] of new slots.
    pub(super) fn truncate(&mut self, n: usize) {
        self.points.truncate(n);
        self.holds.truncate(n);
    }
}
