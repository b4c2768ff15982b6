//! The report of a step.

use std::sync::Arc;

use serde::Serialize;

use crate::base::{CellId, Point, percent};
use crate::mesh::Qualities;
use crate::mesh::history::History;
use crate::moving::shapes::Shape;
use crate::remesh::Counts;

/// The outcome of a step: the certificate of the mesh as it is now.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Step {
    /// Number of the step, from 1.
    pub step: usize,
    /// The time that was reached.
    pub time: f64,
    /// Whether the walls are at their requested places.
    pub complete: bool,
    /// The fraction of the way that was completed: 1 if complete.
    pub fraction: f64,
    /// The number of parts in which the step was made; usually 1.
    pub legs: usize,
    /// The changes of the mesh, in order.
    pub changes: Vec<Change>,
    /// Number of points of the mesh.
    pub points: usize,
    /// Number of tets.
    pub tets: usize,
    /// Number of bad tets: below the EAS limit, and not in a boundary layer.
    pub bad: usize,
    /// Number of bad tets that walls force: the angle or gap is too narrow for a good one.
    pub forced: usize,
    /// Number of tets that are flat or inverted.
    pub inverted: usize,
    /// The worst tet.
    pub worst: Option<WorstTet>,
    /// Quality statistics of all tets.
    pub quality: Qualities,
    /// If the step changed the mesh: tets that are flat or inverted at the positions that their vertices had
    /// when the step began. `None` if there are none.
    pub inverted_at_start: Option<InvertedAtStart>,
    /// The gaps between the watched patches.
    pub gaps: Option<Gaps>,
    /// Seconds by stage.
    pub seconds: Seconds,
}

impl Step {
    /// Why the walls are not at their requested places; `None` if they are.
    pub fn not_reached(&self) -> Option<String> {
        if !self.complete {
            let way = percent(self.fraction);
            return Some(format!("the step stopped after {way} of its way, where tets would be inverted"));
        }
        let patch = self.gaps.as_ref()?.cramped.as_ref()?;
        Some(format!("the patch {patch} has no room to keep its distance (hold) from the patches after it"))
    }
}

/// The worst tet of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct WorstTet {
    /// EAS of the tet.
    pub eas: f64,
    /// Id of the cell.
    pub cell: CellId,
    /// Centroid of the tet.
    pub place: Point,
}

/// Tets of a changed mesh that are flat or inverted at the positions that their vertices had when the step
/// began; for new vertices these positions are carried across the change like any point array. Schemes that
/// integrate over the mesh of an earlier time level (BDF2, a discrete geometric conservation law) find no
/// positive volume there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct InvertedAtStart {
    /// Number of such tets.
    pub tets: usize,
    /// The worst of them, with its EAS and place when the step began.
    pub worst: WorstTet,
}

/// Why a mesh changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Why {
    /// Tets were bad.
    Repair,
    /// Tets were divided, or divisions undone.
    Refinement,
    /// Walls have come back, and the first mesh was put back.
    Return,
}

/// A change of connectivity at one time.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Change {
    /// The time of the change.
    pub time: f64,
    /// The reason for the change.
    pub why: Why,
    /// Number of tets before.
    pub tets_before: usize,
    /// Number of tets after.
    pub tets_after: usize,
    /// The fraction of the old cells that are unchanged, to the bit.
    pub kept_share: f64,
    /// Number of bad tets before, by the limit of the step.
    pub bad_before: usize,
    /// The worst EAS before.
    pub worst_before: f64,
    /// How often each operation was applied, for repairs and coarsening.
    pub operations: Counts,
    /// By how much new tets took more or less than the volume of the old ones, relative to that volume: the
    /// largest over all regions.
    pub volume_deviation: f64,
    /// The history from the mesh before to the mesh after, both at this time.
    #[serde(skip)]
    pub history: Arc<History>,
    /// Positions of the old vertices at this time.
    #[serde(skip)]
    pub points_before: Vec<Point>,
}

impl Change {
    /// A change; `counts` are the tets before and after, `shape` is that of the tets before.
    pub(super) fn new(
        time: f64,
        why: Why,
        [tets_before, tets_after]: [usize; 2],
        shape: &Shape,
        history: Arc<History>,
        points_before: Vec<Point>,
    ) -> Self {
        let n_kept = history.cells.kept().iter().filter(|id| id.is_some()).count();
        let regions = history.ledger.regions.iter().filter(|region| region.volume_before > 0.0);
        Self {
            time,
            why,
            tets_before,
            tets_after,
            kept_share: n_kept as f64 / history.cells.n_old().max(1) as f64,
            bad_before: shape.bad.len(),
            worst_before: shape.worst.map_or(1.0, |(_, eas, _)| eas),
            operations: Counts::default(),
            volume_deviation: regions.map(|r| r.deviation / r.volume_before).fold(0.0, f64::max),
            history,
            points_before,
        }
    }
}

/// The gaps between watched patches.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Gaps {
    /// The least gap of all; `None` if nothing is within reach.
    pub least: Option<f64>,
    /// The nearest points of every pair.
    pub pairs: Vec<Closest>,
    /// Number of vertices within the warning distance.
    pub warned: usize,
    /// Number of nodes of the first mesh that are not at their requested place because they were stopped in
    /// front of another patch, or held back by one that was: see [`Watching::hold`](super::Watching::hold).
    pub held: usize,
    /// Of these nodes, the one farthest from its requested place.
    pub farthest_held: Option<Stopped>,
    /// A patch that is nearer to another one than the distance to keep, because it has no space to give way.
    pub cramped: Option<String>,
    /// Time from now before which nothing touches, at the velocities of this step: a lower bound. `None`:
    /// nothing touches within the horizon.
    pub touch_not_before: Option<f64>,
}

/// A node of a wall that was stopped in front of another one.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Stopped {
    /// The name of the patch that was stopped.
    pub patch: String,
    /// Distance of the node from its requested place.
    pub short: f64,
    /// Position of the node.
    pub place: Point,
}

/// The nearest points of two patches.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Closest {
    /// The names of the patches.
    pub patches: [String; 2],
    /// Their distance; `None` if it exceeds the search range.
    pub gap: Option<f64>,
    /// The nearest point on the first patch.
    pub place: Option<Point>,
    /// Number of pairs of triangles that cross.
    pub crossings: usize,
}

/// Seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Placing vertices.
    pub motion: f64,
    /// Finding bad and inverted tets.
    pub quality: f64,
    /// Repairing, and carrying arrays.
    pub repair: f64,
    /// Rebuilding the motion after a change.
    pub setup: f64,
    /// Keeping walls apart, and measuring gaps.
    pub contact: f64,
    /// The total.
    pub total: f64,
}

impl std::ops::AddAssign for Seconds {
    fn add_assign(&mut self, other: Self) {
        self.motion += other.motion;
        self.quality += other.quality;
        self.repair += other.repair;
        self.setup += other.setup;
        self.contact += other.contact;
        self.total += other.total;
    }
}
