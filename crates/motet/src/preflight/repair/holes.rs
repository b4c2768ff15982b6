//! Fills small holes, if the fill touches nothing else.

use super::fill::fill;
use super::report::RepairKind;
use super::work::{Piece, Work};
use crate::base::{Threads, VertexId};
use crate::geometry::vector::in_range;
use crate::preflight::crossing::crossings;
use crate::preflight::rims::{RimEdge, rims};
use crate::preflight::sides::Side;
use crate::preflight::single::{Shape, shapes};
use crate::preflight::surfaces::Role;

/// The largest number of edges of a rim that is filled; filling it takes about a second and 16 MB.
const LONGEST: usize = 1000;

pub(super) fn close(work: &mut Work, longest: usize, threads: &Threads) {
    let lists = work.lists();
    let sides = work.sides(&lists);
    let rims = rims(work.points.len(), &sides, |surface| work.roles[surface as usize] == Role::Boundary);
    rims.unclosed.iter().for_each(|rim| record(work, RepairKind::LeftTorn, rim));
    let mut fills: Vec<(&[RimEdge], Vec<Piece>)> = Vec::new();
    for rim in &rims.closed {
        if rim.len() > longest.min(LONGEST) {
            record(work, RepairKind::LeftLong, rim);
            continue;
        }
        match filled(work, &sides, rim) {
            Some(pieces) => fills.push((rim, pieces)),
            None => record(work, RepairKind::LeftOpen, rim),
        }
    }
    let touches = touching(work, &fills, threads);
    for ((rim, pieces), touches) in fills.into_iter().zip(touches) {
        record(work, if touches { RepairKind::LeftOpen } else { RepairKind::ClosedHole }, rim);
        if !touches {
            work.pieces.extend(pieces);
        }
    }
}

fn record(work: &mut Work, kind: RepairKind, rim: &[RimEdge]) {
    let triangles = rim.iter().map(|edge| work.old(edge.triangle)).collect();
    work.record(kind, triangles, rim.iter().map(|edge| edge.from).collect());
}

/// The triangles that fill a rim; `None` if it cannot be filled. Each takes its labels from the triangle
/// across the rim at its first corner.
fn filled(work: &Work, sides: &[Side], rim: &[RimEdge]) -> Option<Vec<Piece>> {
    let ring: Vec<VertexId> = rim.iter().map(|edge| edge.from).collect();
    if !ring.iter().all(|v| in_range(work.points[v.index()])) {
        return None;
    }
    let surface = rim[0].surface;
    let is_forbidden = |u: VertexId, v: VertexId| {
        let edge = (surface, [u.min(v), u.max(v)]);
        sides.binary_search_by_key(&edge, |side| (side.surface, side.edge)).is_ok()
    };
    let piece = |places: [usize; 3]| Piece {
        vertices: places.map(|i| ring[i]),
        surface,
        takes_after: work.old(rim[places[0]].triangle),
        is_new: true,
        is_reversed: false,
    };
    Some(fill(work.points, &ring, is_forbidden)?.into_iter().map(piece).collect())
}

/// For each fill, whether its triangles meet others, of the surfaces or of any fill, in more than they share.
fn touching(work: &Work, fills: &[(&[RimEdge], Vec<Piece>)], threads: &Threads) -> Vec<bool> {
    let lists = work.lists();
    let shapes = shapes(&lists.surfaces(work), threads);
    let sound = work.pieces.iter().zip(&shapes).filter(|(_, shape)| **shape == Shape::Sound);
    let mut all: Vec<[VertexId; 3]> = sound.map(|(piece, _)| piece.vertices).collect();
    let n_sound = all.len();
    let new: Vec<[VertexId; 3]> = fills.iter().flat_map(|fill| &fill.1).map(|piece| piece.vertices).collect();
    all.extend(&new);
    let fill_of: Vec<usize> = fills.iter().enumerate().flat_map(|(i, fill)| vec![i; fill.1.len()]).collect();
    let mut touches = vec![false; fills.len()];
    for [i, j] in crossings(work.points, &new, &all, threads) {
        if j as usize != n_sound + i as usize {
            touches[fill_of[i as usize]] = true;
        }
    }
    touches
}
