//! Pairs of triangles that meet in more than they share, each with a place where they do.

use super::crossing::own_crossings;
use super::fault::{Fault, FaultKind, mean};
use super::single::{Duplicates, Shape};
use super::surfaces::Surfaces;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::distance::triangle_triangle;
use crate::geometry::triangle;
use crate::geometry::vector::in_range;

/// The faults of all pairs of sound triangles that meet. Of several with the same vertices only the first is
/// tested, and none without area: those are reported elsewhere, and would meet everything around them.
pub(super) fn faults(
    surfaces: &Surfaces,
    shapes: &[Shape],
    duplicates: &Duplicates,
    threads: &Threads,
) -> Vec<Fault> {
    let counts = |t: &u32| shapes[*t as usize] == Shape::Sound && duplicates.first_in_all[*t as usize] == *t;
    let ids: Vec<u32> = surfaces.ids().filter(counts).collect();
    let triangles: Vec<[VertexId; 3]> = ids.iter().map(|&t| surfaces.triangles[t as usize]).collect();
    let pairs = own_crossings(surfaces.points, &triangles, threads);
    pairs.into_iter().map(|pair| fault_of(surfaces, pair.map(|t| ids[t as usize]))).collect()
}

fn fault_of(surfaces: &Surfaces, [i, j]: [u32; 2]) -> Fault {
    let [a, b] = [i, j].map(|t| surfaces.triangles[t as usize]);
    let shared: Vec<VertexId> = a.into_iter().filter(|v| b.contains(v)).collect();
    let at = match shared[..] {
        [] => common_point(surfaces.corners(i), surfaces.corners(j)),
        [_] => beyond_vertex(surfaces, [a, b]),
        // They overlap along the whole edge.
        _ => mean(&shared, surfaces.points),
    };
    Fault {
        kind: FaultKind::Crossing,
        is_fatal: true,
        surface: surfaces.surface(i),
        triangles: vec![i, j],
        vertices: shared,
        at,
    }
}

/// Another point in which triangles that share one vertex meet: on the edge opposite to it, of one of them.
fn beyond_vertex(surfaces: &Surfaces, [a, b]: [[VertexId; 3]; 2]) -> Option<Point> {
    let at = |v: VertexId| surfaces.points[v.index()];
    let opposite = |own: [VertexId; 3], other: [VertexId; 3]| {
        let mut rest = own.into_iter().filter(|v| !other.contains(v));
        let (p, q) = (at(rest.next()?), at(rest.next()?));
        triangle_triangle::meet([p, q, q], other.map(at)).then(|| common_point([p, q, q], other.map(at)))?
    };
    opposite(a, b).or_else(|| opposite(b, a))
}

/// A point that triangles have in common, up to rounding; `None` if it is not finite.
fn common_point(a: [Point; 3], b: [Point; 3]) -> Option<Point> {
    let at = triangle::at(a, triangle_triangle::closest(a, b).on_a);
    in_range(at).then_some(at)
}
