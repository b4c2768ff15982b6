//! A search for the best change at one place: what is proposed is judged, the best is kept and committed.

use crate::base::TetId;
use crate::kernel::{Change, Complex, VertexChange};
use crate::remesh::repair::tried::Changes;
use crate::remesh::report::{Counts, Operation};
use crate::remesh::sizes::SizeField;
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

/// What is known of an accepted change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Merit<S> {
    pub(super) operation: Operation,
    pub(super) score: S,
    /// The quality that each of its tets has to exceed.
    pub(super) bar: f64,
}

impl<S: Copy> Trial<S> {
    pub(super) fn new() -> Self {
        Self { proposal: Change::default(), best: Change::default(), merit: None, inserted: Vec::new() }
    }

    /// The best change so far.
    pub(super) fn best(&self) -> Option<&Change> {
        self.merit.map(|_| &self.best)
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
    ///
    /// Sizes are checked first, for every proposal: a field of sizes evaluates anew what has moved since the
    /// last check, and a size interpolated at a vertex may differ from the given one by a rounding. So
    /// results depend on which proposals it has checked.
    pub(super) fn offer(
        &mut self,
        rules: Rules,
        weigh: impl FnOnce(&Change, Option<S>) -> Option<Merit<S>>,
    ) -> bool {
        let Rules { complex, lengths, walls, check } = rules;
        if !lengths.accept(complex, &self.proposal) {
            return false;
        }
        let Some(merit) = weigh(&self.proposal, self.score()) else { return false };
        let is_accepted = walls.accept(complex, &self.proposal)
            && (check == Check::Best || complex.check_against(&self.proposal, merit.bar).is_ok());
        if is_accepted {
            std::mem::swap(&mut self.proposal, &mut self.best);
            self.merit = Some(merit);
        }
        is_accepted
    }

    /// Ends the search: commits the best change, if there is one and the kernel accepts it, and counts its
    /// operation. Returns whether a change was made.
    ///
    /// `changes` records the inserted tets; it is `None` where every record of failed operations begins
    /// anew before it is read again.
    pub(super) fn commit(
        &mut self,
        complex: &mut Complex,
        operations: &mut Counts,
        changes: Option<&mut Changes>,
    ) -> bool {
        let Some(merit) = self.merit.take() else { return false };
        let Ok(checked) = complex.check_against(&self.best, merit.bar) else { return false };
        complex.commit(checked, &mut self.inserted);
        operations.add(merit.operation);
        if let Some(changes) = changes {
            changes.inserted(complex, &self.inserted);
        }
        true
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
    Fit(&'a mut SizeField),
    /// Not too long.
    NotLonger(&'a mut SizeField),
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
    pub(super) fn fit(self, field: Option<&'a mut SizeField>) -> Self {
        Self { lengths: field.map_or(LengthRule::Any, LengthRule::Fit), ..self }
    }

    /// No edge becomes longer than a collapse may make it.
    pub(super) fn not_longer(self, field: &'a mut SizeField) -> Self {
        Self { lengths: LengthRule::NotLonger(field), ..self }
    }
}

impl LengthRule<'_> {
    fn accept(self, complex: &Complex, change: &Change) -> bool {
        match self {
            Self::Any => true,
            Self::Fit(field) => field.accepts(complex, change),
            Self::NotLonger(field) => field.lengthens_none(complex, change),
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
