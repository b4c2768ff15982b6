//! Unites the parts of each boundary: what lies inside of it is left out.

use super::divide::DividedSurfaces;
use super::report::{Repair, RepairKind};
use super::work::{Piece, Work};
use crate::base::{Point, Threads, VertexId};
use crate::geometry::{rounding, triangle};
use crate::preflight::single::{Shape, shapes};
use crate::preflight::surfaces::Role;
use crate::preflight::union::{Divided, Failure, unite as union};

/// Points nearer than this times the rounding of coordinates are one place; tried in turn.
const NEAR_OVER_ROUNDING: [f64; 2] = [1e-6, 2.0];

/// Unites the parts of each boundary; `given` are the triangles before any repair. `None` if nothing changes.
/// A boundary that cannot be united stays as it is, which is reported.
pub(super) fn unite(work: &mut Work, given: &[[VertexId; 3]], threads: &Threads) -> Option<DividedSurfaces> {
    let lists = work.lists();
    let shapes = shapes(&lists.surfaces(work), threads);
    let n_before = work.points.len();
    let mut points = work.points.to_vec();
    let mut vertex_to_kept: Vec<VertexId> = (0..n_before).map(VertexId::new).collect();
    let mut is_replaced = vec![false; work.pieces.len()];
    // Pieces, each with the place of the one that it is part of.
    let mut pieces: Vec<(usize, [VertexId; 3])> = Vec::new();
    for surface in 0..work.roles.len() as u32 {
        if work.roles[surface as usize] != Role::Boundary {
            continue;
        }
        let is_own = |i: &usize| work.pieces[*i].surface == surface && shapes[*i] == Shape::Sound;
        let own: Vec<usize> = (0..work.pieces.len()).filter(is_own).collect();
        let triangles: Vec<[VertexId; 3]> = own.iter().map(|&i| work.pieces[i].vertices).collect();
        let made = match united(&points, &triangles, threads) {
            Ok(made) => made,
            Err(failure) => {
                let at = match failure {
                    Failure::NotDivided(at) | Failure::Faulty(at) => Some(at),
                    Failure::Empty => None,
                };
                let kind = RepairKind::LeftApart;
                work.done.push(Repair { kind, triangles: Vec::new(), vertices: Vec::new(), at });
                continue;
            }
        };
        record(work, &own, &triangles, &made, &points);
        own.iter().for_each(|&i| is_replaced[i] = true);
        pieces.extend(made.pieces.iter().map(|&(t, origin)| (own[origin as usize], t)));
        // Surfaces share no vertices that are merged: each divides its own triangles.
        for v in (0..n_before).filter(|&v| made.vertex_to_kept[v].index() != v) {
            vertex_to_kept[v] = made.vertex_to_kept[v];
        }
        points = made.points;
    }
    if !is_replaced.contains(&true) {
        return None;
    }
    let origins = points[n_before..].iter().map(|_| ([VertexId(0); 3], [1.0, 0.0, 0.0]));
    let mut origins: Vec<_> = origins.collect();
    for &(i, t) in &pieces {
        let of = given[work.pieces[i].takes_after as usize];
        let corners = of.map(|v| work.points[v.index()]);
        for v in t.iter().filter(|v| v.index() >= n_before) {
            origins[v.index() - n_before] = (of, triangle::closest(corners, points[v.index()]));
        }
    }
    let renamed = |t: [VertexId; 3]| t.map(|v| vertex_to_kept[v.index()]);
    let others = (0..is_replaced.len()).filter(|&i| !is_replaced[i]);
    pieces.extend(others.map(|i| (i, renamed(work.pieces[i].vertices))));
    pieces.sort_by_key(|piece| piece.0);
    let pieces = pieces.into_iter().map(|(i, vertices)| Piece { vertices, ..work.pieces[i] }).collect();
    Some(DividedSurfaces { points, origins, vertex_to_kept, pieces })
}

/// The union of triangles, by the first distance of points that are one place for which there is one.
fn united(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Result<Divided, Failure> {
    let used: Vec<Point> = triangles.as_flattened().iter().map(|v| points[v.index()]).collect();
    let rounding = rounding::of(&used);
    let mut failure = None;
    for over_rounding in NEAR_OVER_ROUNDING {
        match union(points, triangles, over_rounding * rounding, threads) {
            Ok(made) => return Ok(made),
            Err(why) => failure = failure.or(Some(why)),
        }
    }
    Err(failure.unwrap_or(Failure::Empty))
}

/// Records the triangles that were left out, those that were divided, and the points that were shifted.
fn record(work: &mut Work, own: &[usize], triangles: &[[VertexId; 3]], made: &Divided, before: &[Point]) {
    let mut remains = vec![false; triangles.len()];
    made.pieces.iter().for_each(|(_, origin)| remains[*origin as usize] = true);
    let mut is_whole = vec![false; triangles.len()];
    for (t, origin) in &made.pieces {
        let of = triangles[*origin as usize].map(|v| made.vertex_to_kept[v.index()]);
        is_whole[*origin as usize] |= *t == of;
    }
    for (i, t) in triangles.iter().enumerate() {
        match (remains[i], is_whole[i]) {
            (false, _) => work.record(RepairKind::DroppedInside, vec![work.old(own[i] as u32)], t.to_vec()),
            (true, false) => work.record(RepairKind::United, vec![work.old(own[i] as u32)], t.to_vec()),
            (true, true) => {}
        }
    }
    for v in (0..before.len()).filter(|&v| before[v] != made.points[v]) {
        work.record(RepairKind::ShiftedVertex, Vec::new(), vec![VertexId::new(v)]);
    }
}
