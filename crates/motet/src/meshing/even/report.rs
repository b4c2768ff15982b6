//! What became of a surface that was made even.

use serde::Serialize;

use super::clip::Clipped;
use super::measured::Measured;
use crate::base::reasons;
use crate::preflight::{Repair, RepairKind};

/// What became of a surface that was made even.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// What was cut off first.
    pub cuts: Vec<Clipped>,
    /// The given surface, as cut, double points merged.
    pub before: Measured,
    /// The new surface.
    pub after: Measured,
    /// How far the new surface was allowed to stray, in the unit of the mesh.
    pub allowed: f64,
    /// The largest distance of the new surface from the given one, as repaired and smoothed; measured at
    /// vertices, middles of edges and centroids.
    pub to_given: f64,
    /// The largest distance of the given surface, as repaired and smoothed, from the new one, measured at
    /// such places.
    pub from_given: f64,
    /// What smoothing did before, if requested.
    pub smoothed: Option<Smoothed>,
    /// What was repaired first.
    pub repairs: Vec<Repair>,
    /// Whether the mesh had no surface cells, so that the surface is the boundary of its volume cells.
    pub is_boundary: bool,
    /// Cells that are left out: those beside the surface cells.
    pub left_out: usize,
}

/// What smoothing did.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Smoothed {
    /// How many passes were made.
    pub passes: usize,
    /// The largest distance of the smoothed surface from the given one, measured at vertices, middles of
    /// edges and centroids.
    pub to_given: f64,
    /// The largest distance of the given surface from the smoothed one, measured at such places.
    pub from_given: f64,
}

impl Report {
    /// Why the requested result was not reached; `None` if it was.
    pub fn not_reached(&self) -> Option<String> {
        let Self { before, after, allowed, to_given, from_given, .. } = self;
        let is_far = to_given.max(*from_given) > *allowed;
        let far = || {
            format!(
                "the new surface is up to {to_given:.3e} from the given one, and that up to {from_given:.3e} from it; {allowed:.3e} was allowed"
            )
        };
        let crosses = || {
            let cause = if self.smoothed.is_some() { ": smoothing made them" } else { "" };
            format!("{} pairs of triangles cross, none did before{cause}", after.crossings)
        };
        // Where triangles crossed before, their number says nothing: smaller ones cross in more pairs.
        let is_crossed = before.crossings == 0 && after.crossings > 0;
        let is_apart = self.repairs.iter().any(|repair| repair.kind == RepairKind::LeftApart);
        let apart = || {
            "the bodies could not be united: the surface is open, or its triangles could not be divided"
                .to_owned()
        };
        let n_thin = self.repairs.iter().filter(|repair| repair.kind == RepairKind::DroppedThin).count();
        let thin =
            || format!("{n_thin} triangles of walls or gaps thinner than the distance of the wrap were lost");
        reasons([is_apart.then(apart), (n_thin > 0).then(thin), is_far.then(far), is_crossed.then(crosses)])
    }
}
