//! A search for the best change at one place: what is proposed is judged, the best is kept and committed.

use crate::base::{TetId, VertexId};
use crate::kernel::{Change, Complex, VertexChange};
use crate::remesh::repair::Repair;
use crate::remesh::report::Operation;
use crate::remesh::sizes::SizesIn;
use crate::remesh::surface::Surface;

/// A search for the best change at one place. An operation writes each proposal into the buffer, which is
/// then offered; the best of those that are accepted is kept. To commit it ends the search, and the next
/// offer begins another.
///
/// `S` is the score by which the search compares changes; `()` where the first accepted one is taken.
#[derive(Debug)]
pub(super) struct Trial<S = f64> {
    /// Buffer for the next proposal.
    pub(super) proposal: Change,
    best: Change,
    /// The merit of the best change; `None` if none has been accepted.
    merit: Option<Merit<S>>,
    inserted: Vec<TetId>,
}

/// The best change of a search, and what is known of it.
#[derive(Debug, PartialEq)]
pub(super) struct Found<S> {
    change: Change,
    merit: Merit<S>,
    /// The id that the change gives to the vertex that it inserts, if it inserts one.
    next: VertexId,
}

impl<S> Found<S> {
    /// Gives the vertex that the change inserts the id that the next one gets now.
    pub(super) fn renumber(&mut self, complex: &Complex) {
        let before = std::mem::replace(&mut self.next, complex.next_vertex());
        if let VertexChange::Insert(..) = self.change.vertex {
            self.change.renumber(before, self.next);
        }
    }
}

/// What is known of an accepted change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Merit<S> {
    pub(super) operation: Operation,
    pub(super) score: S,
    /// The quality that each of its tets has to exceed.
    pub(super) bar: f64,
}

impl<S> Default for Trial<S> {
    fn default() -> Self {
        Self { proposal: Change::default(), best: Change::default(), merit: None, inserted: Vec::new() }
    }
}

impl<S: Copy> Trial<S> {
    /// The best change so far.
    pub(super) fn best(&self) -> Option<&Change> {
        self.merit.map(|_| &self.best)
    }

    /// Ends the search: takes the best change, if there is one.
    pub(super) fn take(&mut self, complex: &Complex) -> Option<Found<S>> {
        let merit = self.merit.take()?;
        Some(Found { change: std::mem::take(&mut self.best), merit, next: complex.next_vertex() })
    }

    /// Makes what a search has found the best change.
    pub(super) fn set(&mut self, found: Found<S>) {
        (self.best, self.merit) = (found.change, Some(found.merit));
    }

    /// The score of the best change so far.
    pub(super) fn score(&self) -> Option<S> {
        self.merit.map(|merit| merit.score)
    }

    /// Ends the search without a change.
    pub(super) fn give_up(&mut self) {
        self.merit = None;
    }

    /// Keeps the proposal as the best change if the rules accept it; returns whether they do. `weigh` gets
    /// the proposal and the score of the best so far, and returns `None` if the proposal is not better.
    pub(super) fn offer(
        &mut self,
        rules: Rules,
        weigh: impl FnOnce(&Change, Option<S>) -> Option<Merit<S>>,
    ) -> bool {
        let Rules { complex, lengths, walls, check } = rules;
        let Some(merit) = weigh(&self.proposal, self.score()) else { return false };
        let is_accepted = lengths.accept(&self.proposal)
            && walls.accept(complex, &self.proposal)
            && (check == Check::Best || complex.check_against(&self.proposal, merit.bar).is_ok());
        if is_accepted {
            std::mem::swap(&mut self.proposal, &mut self.best);
            self.merit = Some(merit);
        }
        is_accepted
    }

    /// Ends the search: commits the best change, if there is one and the kernel accepts it. Returns whether a
    /// change was made.
    pub(super) fn commit(&mut self, repair: &mut Repair) -> bool {
        let Some(merit) = self.merit.take() else { return false };
        repair.commit(&self.best, merit.operation, merit.bar, &mut self.inserted)
    }

    /// The tets that the last change inserted.
    pub(super) fn inserted(&self) -> &[TetId] {
        &self.inserted
    }

    /// What the change that was just committed did to a vertex.
    pub(super) fn vertex(&self) -> VertexChange {
        self.best.vertex
    }
}

/// What a proposal has to satisfy.
pub(super) struct Rules<'a> {
    complex: &'a Complex,
    lengths: LengthRule<'a>,
    walls: WallRule<'a>,
    check: Check,
}

/// Which changes the kernel checks before they are committed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Check {
    /// Each that is better than those before: if it refuses one, another may be made.
    Each,
    /// Only the best: if it refuses that one, none is made.
    Best,
}

/// How long the edges that a change makes may be.
enum LengthRule<'a> {
    Any,
    /// Neither too long nor too short.
    Fit(SizesIn<'a>),
    /// Not too long.
    NotLonger(SizesIn<'a>),
}

/// Where the walls and lines that a change makes may lie.
enum WallRule<'a> {
    /// Wherever the kernel allows it: walls stay.
    Any,
    /// Near those of the first mesh.
    Near(&'a Surface),
    /// Where walls and lines are now: they are only divided.
    InPlace(&'a Surface),
}

impl<'a> Rules<'a> {
    /// The rules of the kernel, which checks each proposal that is better than those before.
    pub(super) fn of(complex: &'a Complex) -> Self {
        Self { complex, lengths: LengthRule::Any, walls: WallRule::Any, check: Check::Each }
    }

    /// The rules of the kernel, which checks only the best change, when that is committed: one check instead
    /// of two where the first accepted change is taken.
    pub(super) fn at_commit(complex: &'a Complex) -> Self {
        Self { check: Check::Best, ..Self::of(complex) }
    }

    /// If there is a surface, the walls stay near it.
    pub(super) fn near(self, surface: Option<&'a Surface>) -> Self {
        Self { walls: surface.map_or(WallRule::Any, WallRule::Near), ..self }
    }

    /// If there is a surface, the walls are divided where they lie now.
    pub(super) fn in_place(self, surface: Option<&'a Surface>) -> Self {
        Self { walls: surface.map_or(WallRule::Any, WallRule::InPlace), ..self }
    }

    /// If there are sizes, no edge becomes too long or too short.
    pub(super) fn fit(self, sizes: Option<SizesIn<'a>>) -> Self {
        Self { lengths: sizes.map_or(LengthRule::Any, LengthRule::Fit), ..self }
    }

    /// No edge becomes longer than a collapse may make it.
    pub(super) fn not_longer(self, sizes: SizesIn<'a>) -> Self {
        Self { lengths: LengthRule::NotLonger(sizes), ..self }
    }
}

impl LengthRule<'_> {
    fn accept(&self, change: &Change) -> bool {
        match self {
            Self::Any => true,
            Self::Fit(sizes) => sizes.accepts(change),
            Self::NotLonger(sizes) => sizes.lengthens_none(change),
        }
    }
}

impl WallRule<'_> {
    fn accept(&self, complex: &Complex, change: &Change) -> bool {
        match self {
            Self::Any => true,
            Self::Near(surface) => surface.accepts(complex, change),
            Self::InPlace(surface) => surface.accepts_in_place(change),
        }
    }
}
