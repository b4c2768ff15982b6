//! Repairs of surfaces, requested one by one, each reported with ids and place.

mod degenerate;
mod divide;
mod fill;
mod holes;
mod merge;
mod orient;
mod report;
mod work;

use serde::{Deserialize, Serialize};

use super::surfaces::{Role, Surfaces};
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::LARGEST;
use work::Work;

pub use report::{Repair, RepairKind, Repaired};

/// What to repair; by default nothing. Repairs are made in the order of the fields, except that triangles
/// without area are removed before others are divided, and once more afterwards.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Repairs {
    /// Vertices nearer than this distance, in the unit of the points, to one of smaller id are merged into
    /// it; at 0, those at exactly the same place. No vertex moves farther than that: chains of near vertices
    /// do not collapse.
    pub merge: Option<f64>,
    /// Edges are divided at vertices that lie on them (T-junctions), and triangles where they touch or
    /// overlap, so that they share vertices, edges and whole triangles. Points that are nearer than the
    /// rounding of coordinates, as inferred from their digits, are one place. Of triangles of one surface
    /// that then face each other one remains, as the wall between two bodies.
    pub imprint: bool,
    /// Triangles that cross are divided along the line where they do; this includes `imprint`. Space that
    /// lies in two bodies becomes a body of its own.
    pub cut: bool,
    /// Triangles without area are removed. If three corners lie on a line, the other triangles of the longest
    /// edge are divided at the corner in the middle, so that closed surfaces stay closed and nothing moves.
    pub drop_degenerate: bool,
    /// Of triangles of one surface with the same vertices that face the same side one remains; two that face
    /// opposite sides are both removed, since they enclose nothing.
    pub drop_duplicates: bool,
    /// Triangles are reversed so that neighbours face the same side: in an open part as few as possible, in a
    /// closed part so that it faces outward, even within another part.
    pub orient: bool,
    /// With `orient`, closed parts that face inward stay so: they bound voids.
    pub keep_inward: bool,
    /// Holes of boundaries with a rim of at most this many edges are filled without new points; none with a
    /// rim of more than 1000 is. Neighbours have to face the same side.
    pub close_holes: Option<usize>,
}

impl Repairs {
    /// All repairs except `cut`: points nearer than `merge` are merged, holes of at most `hole_edges` edges
    /// are filled.
    pub fn all(merge: f64, hole_edges: usize) -> Self {
        Self {
            merge: Some(merge),
            imprint: true,
            cut: false,
            drop_degenerate: true,
            drop_duplicates: true,
            orient: true,
            keep_inward: false,
            close_holes: Some(hole_edges),
        }
    }
}

/// Repairs surfaces; [`preflight`](super::preflight) then reports whether they are fit.
///
/// The arguments are those of [`preflight`](super::preflight). Points stay as they are, and those that
/// nothing uses any more become orphans; new ones are appended.
///
/// # Errors
/// If the distance for merging is negative, too large or NaN.
///
/// Panics where [`preflight`](super::preflight) does.
pub fn repair(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    surface_of: &[u32],
    roles: &[Role],
    repairs: &Repairs,
    threads: &Threads,
) -> Result<Repaired> {
    let mut work = Work::new(&Surfaces::new(points, triangles, surface_of, roles));
    let vertex_to_kept = match repairs.merge {
        Some(distance) if !(0.0..=LARGEST).contains(&distance) => {
            return Err(Error::options(format!("the merge distance cannot be {distance}"))
                .remedy("give a distance of 0 or more"));
        }
        Some(distance) => merge::merge(&mut work, distance),
        None => (0..points.len()).map(VertexId::new).collect(),
    };
    if repairs.drop_degenerate {
        degenerate::drop_all(&mut work, threads);
    }
    let is_dividing = repairs.imprint || repairs.cut;
    let Some(divided) = is_dividing.then(|| divide::divide(&mut work, repairs.cut, threads)).flatten() else {
        finish(&mut work, repairs, threads);
        return Ok(work.finish(vertex_to_kept, Vec::new()));
    };
    let kept = vertex_to_kept.iter().map(|v| divided.vertex_to_kept[v.index()]);
    let vertex_to_kept = kept.chain((points.len()..divided.points.len()).map(VertexId::new)).collect();
    let mut work = Work { points: &divided.points, pieces: divided.pieces, ..work };
    if repairs.drop_degenerate {
        degenerate::drop_all(&mut work, threads);
    }
    finish(&mut work, repairs, threads);
    Ok(work.finish(vertex_to_kept, divided.origins))
}

/// The repairs that follow once triangles share what they have in common.
fn finish(work: &mut Work, repairs: &Repairs, threads: &Threads) {
    if repairs.drop_duplicates {
        work.drop_duplicates();
    }
    if repairs.orient {
        orient::orient(work, repairs.keep_inward);
    }
    if let Some(longest) = repairs.close_holes {
        holes::close(work, longest, threads);
        if repairs.orient {
            orient::orient(work, repairs.keep_inward);
        }
    }
}
