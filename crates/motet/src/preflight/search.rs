//! The search for everything that prevents surfaces from being meshed.

use super::fault::{Fault, FaultKind};
use super::narrow::Narrow;
use super::parts::Parts;
use super::report::Preflight;
use super::sides::sorted_sides;
use super::single::{Duplicates, shapes};
use super::surfaces::{Role, Surfaces};
use super::{edges, meeting, parts, rims, single};
use crate::base::{Point, Threads, VertexId};

/// Finds everything that prevents surfaces from being meshed, and what else is worth knowing of them.
///
/// Points at one place must have one id: use [`crate::mesh::firsts_at_place`]. `surface_of` gives the surface
/// of each triangle, `roles` the role of each surface. Edges are those of triangles with three distinct
/// vertices; of duplicates that face the same side one counts, and two that face opposite sides cancel, since
/// they enclose nothing. The answer is the same for any number of threads.
///
/// Panics if the lists do not match in length, or a triangle names a point or a surface that does not exist.
pub fn preflight(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    surface_of: &[u32],
    roles: &[Role],
    threads: &Threads,
) -> Preflight {
    let surfaces = Surfaces::new(points, triangles, surface_of, roles);
    let shapes = shapes(&surfaces, threads);
    let duplicates = Duplicates::new(&surfaces);
    let sides = sorted_sides(&surfaces, |t| duplicates.remains[t as usize]);
    let mut faults = empty(&surfaces);
    faults.extend(single::faults(&surfaces, &shapes, &duplicates));
    faults.extend(meeting::faults(&surfaces, &shapes, &duplicates, threads));
    faults.extend(edges::faults(&surfaces, &sides));
    faults.extend(parts::faults(&surfaces, &Parts::new(triangles.len(), &sides)));
    let narrow = Narrow::of(&surfaces, &shapes, threads);
    Preflight::new(&surfaces, faults, rims::of_boundaries(&surfaces, &sides), narrow)
}

/// A fault for each surface without triangles.
fn empty(surfaces: &Surfaces) -> Vec<Fault> {
    let mut is_empty = vec![true; surfaces.roles.len()];
    surfaces.surface_of.iter().for_each(|&s| is_empty[s as usize] = false);
    let fault = |s| Fault::new(FaultKind::EmptySurface, true, s, Vec::new(), &[], surfaces.points);
    (0u32..).zip(&is_empty).filter(|(_, is_empty)| **is_empty).map(|(s, _)| fault(s)).collect()
}
