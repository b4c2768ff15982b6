//! The state of one step in progress, and its result.

use std::time::Instant;

use crate::base::{Point, Threads};
use crate::moving::current::{Current, LeftBad};
use crate::moving::first_mesh::Returns;
use crate::moving::options::Options;
use crate::moving::shapes::Shape;
use crate::moving::sizes::SizeMap;
use crate::moving::step::{Change, Seconds};
use crate::moving::wall::Wall;

/// The progress of one step.
pub(super) struct StepRun<'a> {
    pub(super) options: &'a Options,
    pub(super) wall: &'a Wall,
    /// The record of returns so far.
    pub(super) returns: &'a Returns,
    /// Requested edge lengths.
    pub(super) sizes: &'a SizeMap,
    /// Displacement of each node of the wall from its first position.
    pub(super) displacement: &'a [Point],
    /// The times of the start and the end of the step.
    pub(super) times: [f64; 2],
    /// How many free vertices the mesh is to have; `None`: as many as it has when it first changes.
    pub(super) n_free: Option<usize>,
    pub(super) threads: &'a Threads,
    /// The new positions of the vertices: scratch space, and the result.
    pub(super) points: Vec<Point>,
    pub(super) seconds: Seconds,
    pub(super) changes: Vec<Change>,
    pub(super) legs: usize,
}

/// The result of a step.
pub(super) struct StepResult {
    /// The new mesh; `None`: the old one, with its vertices at [`StepRun::points`].
    pub(super) changed: Option<Current>,
    /// Bad tets that could not be repaired, if repair was tried last and changed nothing.
    pub(super) left: Option<Vec<LeftBad>>,
    /// The shape of the tets.
    pub(super) shape: Shape,
    /// The fraction of the step that was completed.
    pub(super) fraction: f64,
}

impl StepRun<'_> {
    /// The shape of the tets with the vertices at [`Self::points`].
    pub(super) fn shape_at(&mut self, now: &Current) -> Shape {
        let begin = Instant::now();
        let shape = now.tets.shape(&self.points, self.options.limit(), self.threads);
        self.seconds.quality += begin.elapsed().as_secs_f64();
        shape
    }

    /// The shape of the tets of a mesh as it is.
    pub(super) fn shape(&mut self, now: &Current) -> Shape {
        let begin = Instant::now();
        let shape = now.tets.shape(&now.mesh.points, self.options.limit(), self.threads);
        self.seconds.quality += begin.elapsed().as_secs_f64();
        shape
    }
}
