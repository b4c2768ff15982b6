//! The certificate: the quality of the mesh that a motion returned, and what it took.

use serde::Serialize;

use crate::base::{CellId, Point, Threads, VertexId, percent};
use crate::geometry::quality::{eas, mean_ratio};
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
use crate::mesh::curved::LeastJacobian;
use crate::mesh::{BAD_EAS, Qualities};
use crate::motion::check::Check;
use crate::motion::slide::LeavesPlane;

/// What a motion reached, and how good the mesh is there.
#[derive(Clone, Debug, Default, Serialize)]
#[non_exhaustive]
pub struct Certificate {
    /// Whether the mesh is where it was requested to be.
    pub complete: bool,
    /// The fraction of the requested motion that was reached, from where the mesh was before: 1 when
    /// complete.
    pub fraction: f64,
    /// The largest fraction of it that one step from the reference can do; 1 when one step was enough.
    pub admissible_fraction: f64,
    /// Number of sub-steps, each with a new graph; 0 when one step was enough.
    pub substeps: usize,
    /// Iterations of linear solvers in total; 0 for the graph, which solves none.
    pub iterations: usize,
    /// Vertices of bad tets that were moved by smoothing.
    pub smoothed: usize,
    /// Volume cells that are inverted or flat; quadratic ones where the determinant of their Jacobian is not
    /// positive everywhere.
    pub inverted: usize,
    /// Volume cells of the reference that were inverted or flat before anything moved.
    pub inverted_before: usize,
    /// Cells that one step would have inverted, at most ten.
    pub blocked_by: Vec<CellId>,
    /// Tets of the graph that contain vertices and are inverted. Flat ones invert at once; where no cell is
    /// inverted, this has no significance.
    pub graph_tets_inverted: usize,
    /// Where the rim of a sliding patch is moved farthest out of its plane.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub leaves_plane: Option<LeavesPlane>,
    /// The quality of the cells.
    #[serde(flatten)]
    pub quality: Quality,
    /// Where the time went.
    pub seconds: Seconds,
}

/// The quality of cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Quality {
    /// Number of bad tets: with an EAS below [`BAD_EAS`], and not of a boundary layer (see
    /// [`crate::mesh::OrientedTets`]).
    pub bad: usize,
    /// Number of tets with an EAS below [`BAD_EAS`] that belong to a boundary layer.
    pub layers: usize,
    /// The worst equi-angle quality of a tet.
    pub worst_eas: Option<Worst>,
    /// The worst mean ratio of a tet.
    pub worst_mean_ratio: Option<Worst>,
    /// The distribution of quality over all tets; `None` where there is no tet.
    #[serde(rename = "quality", skip_serializing_if = "Option::is_none")]
    pub distribution: Option<Qualities>,
    /// For cells of other kinds: the worst scaled Jacobian at a corner, the volume that
    /// its three edges span over the product of their lengths (Knupp 2000).
    pub worst_scaled_jacobian: Option<Worst>,
    /// For quadratic cells: the least scaled Jacobian anywhere within, and where; see
    /// [`LeastJacobian::scaled`](crate::mesh::curved::LeastJacobian::scaled). 0 or less where a cell is
    /// folded.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst_curved_jacobian: Option<Worst>,
}

/// The worst cell by some measure.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Worst {
    /// The measure.
    pub value: f64,
    /// The cell.
    pub cell: CellId,
    /// The mean of the corners that were measured; for the Jacobian of a quadratic cell, the place where it
    /// is least.
    pub place: Point,
}

/// Seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Placing vertices, and smoothing.
    pub update: f64,
    /// Checking for inverted cells.
    pub check: f64,
    /// Rebuilding graphs.
    pub graph: f64,
    /// Measuring quality.
    pub quality: f64,
    /// The whole call.
    pub total: f64,
}

impl Certificate {
    /// Why the motion is incomplete; `None` where it is complete.
    pub fn not_reached(&self) -> Option<String> {
        let cells: Vec<String> = self.blocked_by.iter().map(ToString::to_string).collect();
        (!self.complete).then(|| {
            format!(
                "the motion stopped at {} of the way after {} sub-steps, where cells would be inverted \
                 (the first: {})",
                percent(self.fraction),
                self.substeps,
                cells.join(", ")
            )
        })
    }
}

const CHUNK: usize = 1 << 13;

/// Measures every cell of a mesh whose vertices are at `points`.
pub(crate) fn measure(check: &Check, points: &[Point], threads: &Threads) -> Quality {
    let n = check.corners.len();
    let chunk = |start: usize| measure_range(check, points, start..(start + CHUNK).min(n));
    let starts: Vec<usize> = (0..n).step_by(CHUNK).collect();
    let parts = threads.each(starts, chunk);
    let (mut low, mut eas, mut ratios) = (Vec::new(), Vec::with_capacity(n), 0.0);
    let all = parts.into_iter().fold(Quality::default(), |all, measured| {
        let part = measured.quality;
        low.extend(measured.low);
        eas.extend(measured.eas);
        ratios += measured.ratios;
        Quality {
            worst_eas: worse_of(all.worst_eas, part.worst_eas),
            worst_mean_ratio: worse_of(all.worst_mean_ratio, part.worst_mean_ratio),
            worst_scaled_jacobian: worse_of(all.worst_scaled_jacobian, part.worst_scaled_jacobian),
            ..all
        }
    });
    let place = |cell: &CellId| check.tets.cells.binary_search(cell).ok();
    let judged = check.tets.judge(points, low.iter().filter_map(place).collect(), BAD_EAS);
    let worst_curved_jacobian = worst_curved(check, points, threads);
    let distribution = Qualities::of_values(&mut eas, ratios);
    Quality { bad: judged.bad.len(), layers: judged.layers.len(), distribution, worst_curved_jacobian, ..all }
}

/// What was measured at some corners.
#[derive(Default)]
struct Measured {
    /// Without counts and distribution.
    quality: Quality,
    /// The tets below [`BAD_EAS`].
    low: Vec<CellId>,
    /// The EAS of each tet.
    eas: Vec<f64>,
    /// The sum of the mean ratios of tets.
    ratios: f64,
}

/// The worst quadratic cell. Chunks are the same for any number of threads, and so is what is skipped in
/// each.
fn worst_curved(check: &Check, points: &[Point], threads: &Threads) -> Option<Worst> {
    let n = check.curved.len();
    let runs: Vec<_> = (0..n).step_by(CHUNK).map(|start| start..(start + CHUNK).min(n)).collect();
    let worst = threads.each(runs, |run| check.curved.worst(run, points));
    let as_worst =
        |(cell, least): (CellId, LeastJacobian)| Worst { value: least.scaled, cell, place: least.place };
    worst.into_iter().map(|worst| worst.map(as_worst)).fold(None, worse_of)
}

fn measure_range(check: &Check, points: &[Point], corners: std::ops::Range<usize>) -> Measured {
    let mut measured = Measured { eas: Vec::with_capacity(corners.len()), ..Measured::default() };
    let quality = &mut measured.quality;
    for i in corners {
        let tet: [VertexId; 4] = check.corners.tets[i];
        let cell = check.corners.cells[i];
        let tet = tet.map(|v| points[v.index()]);
        let as_worst =
            |value| Some(Worst { value, cell, place: scale(tet.into_iter().fold([0.0; 3], add), 0.25) });
        if check.corners.is_cell[i] {
            let value = eas(tet);
            if value < BAD_EAS {
                measured.low.push(cell);
            }
            let ratio = mean_ratio(tet);
            measured.eas.push(value);
            measured.ratios += ratio;
            quality.worst_eas = worse_of(quality.worst_eas, as_worst(value));
            quality.worst_mean_ratio = worse_of(quality.worst_mean_ratio, as_worst(ratio));
        } else {
            quality.worst_scaled_jacobian =
                worse_of(quality.worst_scaled_jacobian, as_worst(scaled_jacobian(tet)));
        }
    }
    measured
}

/// The one with the smaller value; the first of equal ones.
fn worse_of(a: Option<Worst>, b: Option<Worst>) -> Option<Worst> {
    match (a, b) {
        (Some(a), Some(b)) if b.value < a.value => Some(b),
        (a, b) => a.or(b),
    }
}

fn scaled_jacobian([corner, a, b, c]: [Point; 4]) -> f64 {
    let [a, b, c] = [a, b, c].map(|p| sub(p, corner));
    let lengths = norm(a) * norm(b) * norm(c);
    if lengths > 0.0 { dot(cross(a, b), c) / lengths } else { 0.0 }
}
