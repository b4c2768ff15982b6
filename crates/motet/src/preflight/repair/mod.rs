//! Repairs of surfaces that are asked for one by one, each told with ids and place.

mod degenerate;
mod fill;
mod holes;
mod joints;
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

/// What to repair. By default nothing; what is asked for is done in the order of the fields, but triangles without area go before others are divided, and once more then.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Repairs {
    /// Vertices nearer to one of smaller id than this distance, in the unit of the points, become one with it. At 0 those at exactly
    /// the same place do. No vertex moves farther than that: chains of near vertices do not run together.
    pub merge: Option<f64>,
    /// Edges are divided at vertices that lie on them (T-junctions), and triangles that touch or lie on each other where they do, so that they share vertices,
    /// edges and whole triangles. What is nearer than the rounding of coordinates, as their digits tell it, is one place. Of triangles of one surface that then face each other
    /// one stays, as the wall between two bodies.
    pub imprint: bool,
    /// Triangles that go through each other are divided along the line where they do; this imprints as well. What lies in two bodies becomes a body of its own.
    pub cut: bool,
    /// Triangles without area go. Where the middle one of three corners on a line divides the longest edge, the other triangles of that edge are
    /// divided there, so that what was closed stays closed and nothing moves.
    pub drop_degenerate: bool,
    /// Of triangles of one surface with the same vertices that face the same side one stays; two that face opposite sides go together, since
    /// they enclose nothing.
    pub drop_duplicates: bool,
    /// Triangles are turned so that neighbours face the same side; as few as can be of an open part, and a closed part outward, also within another.
    pub orient: bool,
    /// Closed parts that face inward stay so when triangles are turned: they bound voids.
    pub keep_inward: bool,
    /// Holes of boundaries with a rim of at most so many edges are filled without new points; of more than 1000 none is. Neighbours have to face the same side.
    pub close_holes: Option<usize>,
}

impl Repairs {
    /// All of them but `cut`: points nearer than `merge` become one, holes of at most so many edges are closed.
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

/// Repairs surfaces; whether they are fit then is for [`preflight`](super::preflight) to say.
///
/// Takes what [`preflight`](super::preflight) takes. Points stay as they are, and those that nothing uses any more are orphans; new ones stand behind them.
///
/// # Errors
/// When the distance to merge within is negative or no number.
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
            return Err(Error::options(format!("vertices nearer than {distance} cannot be merged"))
                .remedy("give a distance that is 0 or more"));
        }
        Some(distance) => merge::merge(&mut work, distance),
        None => (0..points.len()).map(VertexId::new).collect(),
    };
    if repairs.drop_degenerate {
        degenerate::drop_all(&mut work, threads);
    }
    let wants_joints = repairs.imprint || repairs.cut;
    let Some(divided) = wants_joints.then(|| joints::divide(&mut work, repairs.cut, threads)).flatten()
    else {
        finish(&mut work, repairs, threads);
        return Ok(work.finish(vertex_to_kept, Vec::new()));
    };
    let names = vertex_to_kept.iter().map(|v| divided.names[v.index()]);
    let vertex_to_kept = names.chain((points.len()..divided.points.len()).map(VertexId::new)).collect();
    let mut work = Work { points: &divided.points, pieces: divided.pieces, ..work };
    if repairs.drop_degenerate {
        degenerate::drop_all(&mut work, threads);
    }
    finish(&mut work, repairs, threads);
    Ok(work.finish(vertex_to_kept, divided.origins))
}

/// What comes once triangles share what they have in common.
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
