//! What a step says of itself.

use std::sync::Arc;

use serde::Serialize;

use crate::base::{CellId, Id, Point, percent};
use crate::mesh::Qualities;
use crate::mesh::history::History;
use crate::moving::shapes::Shape;
use crate::remesh::Counts;

/// What became of a step: the certificate of the mesh as it is now.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Step {
    /// Its number, from 1.
    pub step: usize,
    /// The time that was reached.
    pub time: f64,
    /// Whether the walls are where they were asked to be.
    pub complete: bool,
    /// The part of the way that was gone: 1 when complete.
    pub fraction: f64,
    /// In how many parts it was gone; 1 as a rule.
    pub legs: usize,
    /// What was changed, in order.
    pub changes: Vec<Change>,
    /// Points of the mesh.
    pub points: usize,
    /// Its tets.
    pub tets: usize,
    /// Tets that are bad: below the limit of EAS, and not of a boundary layer.
    pub bad: usize,
    /// Of these, tets that walls force: too narrow an angle or gap for a good one.
    pub forced: usize,
    /// Tets that are flat or inverted.
    pub inverted: usize,
    /// The worst tet.
    pub worst: Option<WorstTet>,
    /// How good all tets are.
    pub quality: Qualities,
    /// Where the step changed the mesh: tets that are flat or inverted where their vertices were as the step began. `None` where there is none.
    pub inverted_at_start: Option<InvertedAtStart>,
    /// How near the watched patches are.
    pub gaps: Option<Gaps>,
    /// Where the time went.
    pub seconds: Seconds,
}

impl Step {
    /// Why the walls are not where they were requested to be; `None` where they are.
    pub fn not_reached(&self) -> Option<String> {
        if !self.complete {
            let way = percent(self.fraction);
            return Some(format!("the step stopped at {way} of its way, where tets would turn over"));
        }
        let patch = self.gaps.as_ref()?.cramped.as_ref()?;
        Some(format!("the patch {patch} has no room to keep its distance (hold) from the patches after it"))
    }
}

/// The worst tet of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WorstTet {
    /// Its EAS.
    pub eas: f64,
    /// Which cell.
    pub cell: CellId,
    /// The mean of its corners.
    pub place: Point,
}

/// Tets of a changed mesh that are flat or inverted at the places that their vertices had as the step began; for new vertices these places are carried across the change as
/// any array of points. Schemes that integrate over the mesh of an earlier time level (BDF2, a discrete geometric conservation law) find no positive volume there.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct InvertedAtStart {
    /// How many.
    pub tets: usize,
    /// The worst of them, with its EAS and place as the step began.
    pub worst: WorstTet,
}

/// Why a mesh changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Why {
    /// Tets were bad.
    Repair,
    /// Tets were to be divided, or divisions taken back.
    Refinement,
    /// Walls have come back, and the first mesh was put back.
    Return,
}

/// A change of connectivity, at one time.
#[derive(Clone, Debug, Serialize)]
pub struct Change {
    /// When.
    pub time: f64,
    /// Why.
    pub why: Why,
    /// Tets before.
    pub tets_before: usize,
    /// Tets after.
    pub tets_after: usize,
    /// The part of the cells that are as they came, to the bit.
    pub kept_share: f64,
    /// Bad tets before, by the limit of the step.
    pub bad_before: usize,
    /// The worst EAS before.
    pub worst_before: f64,
    /// How often each operation was made; of repairs.
    pub operations: Counts,
    /// By how much new tets took more or less than the volume of old ones, as a part of what changed.
    pub volume_deviation: f64,
    /// From the mesh before to the mesh after, both at this time.
    #[serde(skip)]
    pub history: Arc<History>,
    /// Where the vertices of the mesh before were at this time.
    #[serde(skip)]
    pub points_before: Vec<Point>,
}

impl Change {
    /// `counts`: tets before and after; `shape`: how the tets before were.
    pub(super) fn new(
        (time, why): (f64, Why),
        [tets_before, tets_after]: [usize; 2],
        shape: &Shape,
        history: Arc<History>,
        points_before: Vec<Point>,
    ) -> Self {
        let n_kept = history.cells.kept().iter().filter(|id| **id != Id::NONE).count();
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

/// How near watched patches are to each other.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Gaps {
    /// The least gap of all; `None` where nothing is within reach.
    pub least: Option<f64>,
    /// Every pair.
    pub pairs: Vec<Closest>,
    /// Vertices that warn.
    pub warned: usize,
    /// Nodes of the first mesh that are not where they were requested to be, since they were stopped in front of another patch, or held back by one that was: see [`Watching::hold`](super::Watching::hold).
    pub held: usize,
    /// Of these the one that is farthest from where it was requested to be.
    pub farthest_held: Option<Stopped>,
    /// A patch that is nearer to another one than it is to be held: there is no room for it to give way.
    pub cramped: Option<String>,
    /// Nothing touches earlier, at the velocities of this step; `None`: not within the horizon.
    pub touch_not_before: Option<f64>,
}

/// A node of a wall that was stopped in front of another one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stopped {
    /// The name of the patch that was stopped.
    pub patch: String,
    /// How far it is from its requested place.
    pub short: f64,
    /// Where it is.
    pub place: Point,
}

/// The nearest places of two patches.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Closest {
    /// Their names.
    pub patches: [String; 2],
    /// How far apart; `None` where farther than is looked.
    pub gap: Option<f64>,
    /// The place on the first.
    pub place: Option<Point>,
    /// Triangles that cross.
    pub crossings: usize,
}

/// Seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Placing vertices.
    pub motion: f64,
    /// Looking for bad and inverted tets.
    pub quality: f64,
    /// Repairing, and carrying arrays.
    pub repair: f64,
    /// Setting the motion up again after a change.
    pub setup: f64,
    /// Keeping walls apart, and measuring gaps.
    pub contact: f64,
    /// All of it.
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
