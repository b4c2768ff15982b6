//! What became of a surface that was made even.

use serde::Serialize;

use super::super::adapt::{lost, strayed};
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
        let Self { before, after, .. } = self;
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
        let n_lost = self.repairs.iter().filter(|repair| repair.kind == RepairKind::DroppedThin).count();
        let strays = strayed([self.to_given, self.from_given], self.allowed);
        reasons([is_apart.then(apart), lost(n_lost), strays, is_crossed.then(crosses)])
    }
}
