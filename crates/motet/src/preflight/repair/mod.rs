//! Repairs of surfaces that are asked for one by one, each told with ids and place.

mod degenerate;
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

/// What to repair. By default nothing; what is asked for is done in the order of the fields.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Repairs {
    /// Vertices nearer to one of smaller id than this distance, in the unit of the points, become one with it. At 0 those at exactly
    /// the same place do. No vertex moves farther than that: chains of near vertices do not run together.
    pub merge: Option<f64>,
    /// Triangles without area go. Where the middle one of three corners on a line divides the longest edge, the other triangles of that edge are
    /// divided there, so that what was closed stays closed and nothing moves.
    pub drop_degenerate: bool,
    /// Of triangles of one surface with the same vertices that face the same side one stays; two that face opposite sides go together, since
    /// they enclose nothing.
    pub drop_duplicates: bool,
    /// Triangles are turned so that neighbours face the same side; as few as can be of an open part, and a closed part outward, also within another.
    pub orient: bool,
    /// Holes of boundaries with a rim of at most so many edges are filled without new points; of more than 1000 none is. Neighbours have to face the same side.
    pub close_holes: Option<usize>,
}

impl Repairs {
    /// All of them: points nearer than `merge` become one, holes of at most so many edges are closed.
    pub fn all(merge: f64, hole_edges: usize) -> Self {
        Self {
            merge: Some(merge),
            drop_degenerate: true,
            drop_duplicates: true,
            orient: true,
            close_holes: Some(hole_edges),
        }
    }
}

/// Repairs surfaces; whether they are fit then is for [`preflight`](super::preflight) to say.
///
/// Takes what [`preflight`](super::preflight) takes. Points stay as they are: those that nothing uses any more are orphans.
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
    if repairs.drop_duplicates {
        work.drop_duplicates();
    }
    if repairs.orient {
        orient::orient(&mut work);
    }
    if let Some(longest) = repairs.close_holes {
        holes::close(&mut work, longest, threads);
        if repairs.orient {
            orient::orient(&mut work);
        }
    }
    Ok(work.finish(vertex_to_kept))
}
