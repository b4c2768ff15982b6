//! Repairs of surfaces, requested one by one, each reported with ids and place.

mod degenerate;
mod divide;
mod fill;
mod holes;
mod merge;
mod orient;
mod report;
mod unite;
mod work;
mod wrap;

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
    /// The parts of each boundary become one, where they cross, touch or lie on each other: what lies inside
    /// is left out. This includes `imprint`. Closed parts that face inward stay so where they lie inside
    /// others: they bound voids. Where triangles cannot be divided otherwise, points are shifted by at most
    /// 1800 times the rounding of the coordinates, which is reported.
    pub unite: bool,
    /// Each boundary is replaced by a new closed surface within this distance, in the unit of the points,
    /// around what it encloses: boundaries may be open, torn, double, and cross themselves or each other. A
    /// place is inside if they go around it more than half a time. Walls and gaps thinner than the distance
    /// may be lost, which is reported. Nothing is divided or united first, and no hole is filled.
    pub wrap: Option<f64>,
}

impl Repairs {
    /// All repairs except `cut`, `unite` and `wrap`: points nearer than `merge` are merged, holes of at most
    /// `hole_edges` edges are filled.
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
            unite: false,
            wrap: None,
        }
    }
}

/// Repairs surfaces; [`preflight`](super::preflight) then reports whether they are fit.
///
/// The arguments are those of [`preflight`](super::preflight). Points stay as they are, and those that
/// nothing uses any more become orphans; new ones are appended.
///
/// # Errors
/// If the distance for merging is negative, too large or NaN. If the distance of a wrapped surface is not
/// positive, or too small for the size of the surfaces, or these enclose nothing. When a stop was requested.
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
    // One new surface is around all bodies.
    let repairs = &Repairs { unite: repairs.unite && repairs.wrap.is_none(), ..*repairs };
    let mut work = Work::new(&Surfaces::new(points, triangles, surface_of, roles));
    let mut vertex_to_kept = match repairs.merge {
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
    // Where bodies meet, it is not known any more which triangles are one body.
    if repairs.orient && repairs.unite {
        orient::orient(&mut work, repairs);
    }
    let mut origins = Vec::new();
    let is_dividing = (repairs.imprint || repairs.cut || repairs.unite) && repairs.wrap.is_none();
    let divided = is_dividing.then(|| divide::divide(&mut work, repairs, threads)).flatten();
    if let Some(divided) = &divided {
        work = divided.replace(work, &mut vertex_to_kept, &mut origins);
        if repairs.drop_degenerate {
            degenerate::drop_all(&mut work, threads);
        }
    }
    finish(&mut work, repairs, threads);
    let wrapped = match repairs.wrap {
        Some(distance) => wrap::wrap(&mut work, repairs, distance, threads)?,
        None => None,
    };
    if let Some(wrapped) = &wrapped {
        work = wrapped.replace(work, &mut vertex_to_kept, &mut origins);
        return Ok(work.finish(vertex_to_kept, origins));
    }
    let united = repairs.unite.then(|| unite::unite(&mut work, triangles, threads)).flatten();
    if let Some(united) = &united {
        work = united.replace(work, &mut vertex_to_kept, &mut origins);
        degenerate::drop_all(&mut work, threads);
    }
    // What could not be united is repaired like the rest.
    if repairs.unite && repairs.drop_duplicates {
        work.drop_duplicates();
    }
    if repairs.unite && repairs.orient && united.is_none() {
        orient::orient(&mut work, repairs);
    }
    Ok(work.finish(vertex_to_kept, origins))
}

/// The repairs that follow once triangles share what they have in common.
fn finish(work: &mut Work, repairs: &Repairs, threads: &Threads) {
    // For the union, winding numbers have to be those of whole bodies.
    if repairs.drop_duplicates && !repairs.unite {
        work.drop_duplicates();
    }
    if repairs.orient && !repairs.unite {
        orient::orient(work, repairs);
    }
    if let Some(longest) = repairs.close_holes.filter(|_| repairs.wrap.is_none()) {
        holes::close(work, longest, threads);
        if repairs.orient {
            orient::orient(work, repairs);
        }
    }
}
