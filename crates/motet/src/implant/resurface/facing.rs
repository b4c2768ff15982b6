//! The orientation that a surface is meant to have: outward as a whole, cavities inward, neighbours alike.

use crate::base::{Csr, DisjointSets, Point, Result, Threads, VertexId, same_orientation, sorted_ids};
use crate::contact::is_closed;
use crate::geometry::triangle::{area, centroid};
use crate::geometry::vector::{add, scale};
use crate::mesh::{Surface, cone_volume};
use crate::preflight::{Repairs, Role, repair};
use crate::spatial::{Bounds, WindingNumber, bounding_box};

/// A vertex is inside a part above this winding number.
const INSIDE: f64 = 0.5;

/// Triangles connected by edges of two that enclose some space without an opening.
struct Part {
    triangles: Vec<usize>,
    corners: Vec<[VertexId; 3]>,
    bounds: Bounds,
    volume: f64,
    /// Whether it faced inward as given.
    was_inward: bool,
}

/// Turns triangles to face as they are meant to. Closed parts face outward, except for cavities: parts that
/// lie wholly in another part and were given facing the other way. Open parts face as given, or all the other
/// way if together they enclose a negative volume; for a single one of them, such as the inner wall of a
/// tube, that cannot be determined.
pub(super) fn face(surface: &mut Surface, threads: &Threads) -> Result<()> {
    let given = surface.triangles.clone();
    let orient = Repairs { orient: true, ..Repairs::default() };
    let of = vec![0; given.len()];
    let turned = repair(&surface.points, &given, &of, &[Role::Boundary], &orient, threads)?;
    for (triangle, old) in turned.triangles.iter().zip(&turned.new_to_old) {
        if let Some(old) = old {
            surface.triangles[*old as usize] = *triangle;
        }
    }
    let (mut closed, open) = parts(surface, &given);
    closed.sort_by(|p, q| q.volume.total_cmp(&p.volume));
    let mut faces_inward: Vec<bool> = Vec::new();
    for (k, part) in closed.iter().enumerate() {
        // The smallest part that contains it.
        let holder = (0..k).rev().find(|&holder| holds(&closed[holder], part, &surface.points));
        let differs = |holder: usize| closed[holder].was_inward != part.was_inward;
        faces_inward.push(holder.is_some_and(|holder| faces_inward[holder] != differs(holder)));
    }
    let inward = closed.iter().zip(&faces_inward).filter(|(_, inward)| **inward);
    let mut to_turn: Vec<usize> = inward.flat_map(|(part, _)| part.triangles.iter().copied()).collect();
    let of_open: Vec<[VertexId; 3]> = open.iter().map(|&t| surface.triangles[t]).collect();
    if volume(&surface.points, &of_open) < 0.0 {
        to_turn.extend(open);
    }
    to_turn.into_iter().for_each(|t| surface.triangles[t].swap(1, 2));
    Ok(())
}

/// The closed parts, and the triangles of all others.
fn parts(surface: &Surface, given: &[[VertexId; 3]]) -> (Vec<Part>, Vec<usize>) {
    let n = surface.triangles.len();
    let mut sides: Vec<([VertexId; 2], u32)> = (0..)
        .zip(&surface.triangles)
        .flat_map(|(t, &[a, b, c])| [[a, b], [b, c], [c, a]].map(|side| (sorted_ids(side), t)))
        .collect();
    sides.sort_unstable();
    let mut sets = DisjointSets::new(n);
    for same in sides.chunk_by(|x, y| x.0 == y.0) {
        if let [x, y] = same {
            sets.join(x.1, y.1);
        }
    }
    let roots: Vec<usize> = sets.roots().into_iter().map(|root| root as usize).collect();
    let members = Csr::from_pairs(n, || roots.iter().copied().zip(0..));
    let (mut closed, mut open) = (Vec::new(), Vec::new());
    for triangles in members.iter().filter(|list| !list.is_empty()) {
        let corners: Vec<[VertexId; 3]> = triangles.iter().map(|&t: &usize| surface.triangles[t]).collect();
        if !is_closed(&corners) {
            open.extend_from_slice(triangles);
            continue;
        }
        let n_turned =
            triangles.iter().filter(|&&t| !same_orientation(given[t], surface.triangles[t])).count();
        closed.push(Part {
            triangles: triangles.to_vec(),
            bounds: bounding_box(corners.as_flattened().iter().map(|v| surface.points[v.index()])),
            volume: volume(&surface.points, &corners),
            corners,
            was_inward: 2 * n_turned > triangles.len(),
        });
    }
    (closed, open)
}

/// Whether a part lies wholly within another.
fn holds(holder: &Part, part: &Part, points: &[Point]) -> bool {
    let ([low, high], [from, to]) = (holder.bounds, part.bounds);
    if !(0..3).all(|k| low[k] <= from[k] && to[k] <= high[k]) {
        return false;
    }
    let winding = WindingNumber::new(points, &holder.corners);
    part.corners.as_flattened().iter().all(|v| winding.at(points[v.index()]) > INSIDE)
}

/// The volume that triangles enclose, seen from the centroid of their area: open ones enclose what they would
/// if a cone from there closed them.
pub(super) fn volume(points: &[Point], triangles: &[[VertexId; 3]]) -> f64 {
    let corners = |t: &[VertexId; 3]| t.map(|v| points[v.index()]);
    let whole: f64 = triangles.iter().map(|t| area(corners(t))).sum();
    if whole <= 0.0 {
        return 0.0;
    }
    let weighted = |t: &[VertexId; 3]| scale(centroid(corners(t)), area(corners(t)));
    let middle = scale(triangles.iter().map(weighted).fold([0.0; 3], add), 1.0 / whole);
    triangles.iter().map(|t| cone_volume(t.iter().copied(), points, middle)).sum()
}
