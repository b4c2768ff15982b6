//! Removes triangles without area; what was closed stays closed.
//!
//! A triangle that names a vertex twice is only an edge: the triangles on its other two sides meet there
//! without it. A triangle with its corners on a line has two short edges along its long one; the triangles on
//! the other side of the long one are divided at the middle corner, and then meet those of the short ones.
//! Their pieces may have no area either, so this is done in rounds.

use super::report::RepairKind;
use super::work::{Piece, Work};
use crate::base::{Threads, VertexId};
use crate::preflight::single::{Shape, shapes};

/// Number of rounds, more than chains of triangles on one line need; what is left then is reported by the
/// next search.
const ROUNDS: usize = 64;

pub(super) fn drop_all(work: &mut Work, threads: &Threads) {
    for _ in 0..ROUNDS {
        let lists = work.lists();
        let shapes = shapes(&lists.surfaces(work), threads);
        if !round(work, &shapes) {
            break;
        }
    }
    record_left(work, threads);
}

/// Removes triangles without area as long as no triangle is changed twice. Returns whether any was removed.
fn round(work: &mut Work, shapes: &[Shape]) -> bool {
    let edges = Edges::new(&work.pieces);
    let mut is_removed = vec![false; work.pieces.len()];
    let mut is_touched = is_removed.clone();
    let mut parts: Vec<Piece> = Vec::new();
    for t in (0..shapes.len()).filter(|&t| shapes[t] == Shape::Repeated) {
        (is_removed[t], is_touched[t]) = (true, true);
        let (old, vertices) = (work.old(t as u32), work.pieces[t].vertices.to_vec());
        work.record(RepairKind::DroppedRepeated, vec![old], vertices);
    }
    for t in (0..shapes.len()).filter(|&t| shapes[t] == Shape::Flat) {
        let Some([from, middle, to]) = along_line(work, t) else { continue };
        let around = || edges.around(from, to).map(|edge| edge.1 as usize);
        if around().any(|other| is_touched[other]) {
            continue;
        }
        let mut concerned = vec![work.old(t as u32)];
        for other in around() {
            (is_removed[other], is_touched[other]) = (true, true);
            if other != t {
                parts.extend(divided(&work.pieces[other], [from, to], middle));
                concerned.push(work.old(other as u32));
            }
        }
        work.record(RepairKind::DroppedFlat, concerned, vec![from, middle, to]);
    }
    let mut ids = 0..;
    work.pieces.retain(|_| ids.next().is_some_and(|t: usize| !is_removed[t]));
    work.pieces.extend(parts);
    is_removed.contains(&true)
}

/// The corners in their order along the line; `None` if two are at one place.
fn along_line(work: &Work, t: usize) -> Option<[VertexId; 3]> {
    let mut vertices = work.pieces[t].vertices;
    let at = |v: &VertexId| work.points[v.index()];
    // Points on a line are ordered like their coordinates.
    vertices.sort_by(|u, v| at(u).partial_cmp(&at(v)).unwrap_or(std::cmp::Ordering::Equal));
    let [a, b, c] = vertices;
    (at(&a) != at(&b) && at(&b) != at(&c)).then_some([a, b, c])
}

/// A triangle cut in two at a vertex on one of its edges.
fn divided(piece: &Piece, [from, to]: [VertexId; 2], middle: VertexId) -> [Piece; 2] {
    let with = |old: VertexId| {
        let vertices = piece.vertices.map(|v| if v == old { middle } else { v });
        Piece { vertices, ..*piece }
    };
    [with(to), with(from)]
}

/// The edges of all triangles, of whichever surface, sorted.
struct Edges(Vec<([VertexId; 2], u32)>);

impl Edges {
    fn new(pieces: &[Piece]) -> Self {
        let of = |(t, piece): (u32, &Piece)| {
            let [a, b, c] = piece.vertices;
            [[a, b], [b, c], [c, a]].map(|[u, v]| ([u.min(v), u.max(v)], t))
        };
        let mut edges: Vec<_> = (0..).zip(pieces).flat_map(of).collect();
        edges.sort_unstable();
        // A triangle that names a vertex twice has an edge twice.
        edges.dedup();
        Self(edges)
    }

    fn around(&self, u: VertexId, v: VertexId) -> impl Iterator<Item = &([VertexId; 2], u32)> {
        let edge = [u.min(v), u.max(v)];
        let start = self.0.partition_point(|x| x.0 < edge);
        self.0[start..].iter().take_while(move |x| x.0 == edge)
    }
}

/// Records the triangles that are left with their corners on a line.
fn record_left(work: &mut Work, threads: &Threads) {
    let lists = work.lists();
    let shapes = shapes(&lists.surfaces(work), threads);
    for t in (0..shapes.len()).filter(|&t| shapes[t] == Shape::Flat) {
        let (old, vertices) = (work.old(t as u32), work.pieces[t].vertices.to_vec());
        work.record(RepairKind::LeftFlat, vec![old], vertices);
    }
}
