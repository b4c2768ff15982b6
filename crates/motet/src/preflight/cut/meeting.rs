//! Records of where triangles met, for a report.

use super::Pair;
use super::points::Points;
use crate::base::{Point, VertexId};

/// How triangles met.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum MeetingKind {
    /// A given vertex lies on an edge of which it is not an end.
    VertexOnEdge,
    /// Two triangles overlap in one plane.
    Overlap,
    /// Two triangles cross.
    Crossing,
}

/// One place where triangles met.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Meeting {
    pub(crate) kind: MeetingKind,
    /// The given triangles; none for a vertex on an edge.
    pub(crate) triangles: Vec<u32>,
    /// The vertex on an edge, and the ends of the edge; none for a pair of triangles.
    pub(crate) vertices: Vec<VertexId>,
    pub(crate) at: Point,
}

/// The pairs of different given triangles that overlap or cross.
pub(super) fn of_pairs(pairs: &[Pair], origin: impl Fn(u32) -> u32) -> Vec<Meeting> {
    let met = |(numbers, common): &Pair| {
        let kind = match () {
            () if common.is_overlap() => MeetingKind::Overlap,
            () if common.is_crossing() => MeetingKind::Crossing,
            () => return None,
        };
        let triangles = numbers.map(&origin);
        let are_apart = triangles[0] != triangles[1];
        are_apart.then(|| Meeting {
            kind,
            triangles: triangles.to_vec(),
            vertices: Vec::new(),
            at: common.middle(),
        })
    };
    pairs.iter().filter_map(met).collect()
}

/// The given vertices that lie on edges between given vertices.
pub(super) fn of_edges(found: &Points, n_given: usize, points: &[Point]) -> Vec<Meeting> {
    let is_given = |v: &VertexId| v.index() < n_given;
    let edges = found.on_edges().filter(|(ends, _)| ends.iter().all(is_given));
    let met = |(ends, list): ([VertexId; 2], &[VertexId])| {
        let of = |v: &VertexId| Meeting {
            kind: MeetingKind::VertexOnEdge,
            triangles: Vec::new(),
            vertices: vec![*v, ends[0], ends[1]],
            at: points[v.index()],
        };
        list.iter().filter(|v| is_given(v)).map(of).collect::<Vec<_>>()
    };
    edges.flat_map(met).collect()
}

/// Sorts the records, and leaves each pair and each vertex on an edge once, whichever rounds found it.
pub(super) fn sort(meetings: &mut Vec<Meeting>) {
    meetings.sort_by(|x, y| key(x).cmp(&key(y)));
    meetings.dedup_by(|x, y| key(x) == key(y));
}

fn key(meeting: &Meeting) -> (MeetingKind, &[u32], &[VertexId]) {
    (meeting.kind, &meeting.triangles, &meeting.vertices)
}
