//! What a repair did: the new triangles, where each came from, and every change by name.

use serde::Serialize;

use crate::base::{Point, VertexId};

/// What a repair did, or could not do.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum RepairKind {
    /// A vertex was merged into another.
    MergedVertex,
    /// An edge was divided at a vertex that lies on it: a T-junction. The vertex comes first, then the ends
    /// of the edge.
    TJunction,
    /// Two triangles that overlap in one plane were divided alike.
    Imprinted,
    /// Two triangles that cross were divided along the line where they do.
    CutCrossing,
    /// Of triangles that face each other one was kept, as the wall between two bodies.
    KeptWall,
    /// A triangle, or a piece of a divided one, inside the union of bodies was left out.
    DroppedInside,
    /// A triangle that encloses nothing was left out.
    DroppedOutside,
    /// A triangle of a wall or a gap thinner than the distance, which is not there any more, was left out.
    DroppedThin,
    /// A surface was replaced by a new one around what it encloses.
    Wrapped,
    /// A triangle that met others was divided, and what is inside the union of bodies left out.
    United,
    /// A vertex was shifted by a tiny length, since triangles that meet there could not be divided otherwise.
    ShiftedVertex,
    /// Bodies were left as they were: their union would be empty, open or not free of crossings, or their
    /// triangles could not be divided.
    LeftApart,
    /// Triangles that meet were left as they were: their pieces would still meet in more than they share.
    LeftMeeting,
    /// A triangle that named a vertex twice was removed.
    DroppedRepeated,
    /// A triangle whose corners lay on a line was removed; its neighbours at the longest edge were divided.
    DroppedFlat,
    /// A triangle whose corners lie on a line was left: two of them are at one place and have to be merged,
    /// or very many lie on one line.
    LeftFlat,
    /// A duplicate triangle of a surface was removed; if the other one faced the opposite side, both were.
    DroppedDuplicate,
    /// A triangle was reversed.
    Turned,
    /// A part of a surface was left as it was, since it has only one side, as a Möbius strip does.
    LeftOneSided,
    /// A hole was filled.
    ClosedHole,
    /// A hole was left, since its rim is too long.
    LeftLong,
    /// A hole was left, since no triangles without new points fill it without touching others.
    LeftOpen,
    /// A hole was left, since its rim does not close: triangles there face different sides, or more than two
    /// meet at an edge.
    LeftTorn,
}

/// One repair, or one that could not be made.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Repair {
    /// The kind of repair.
    #[serde(rename = "name")]
    pub kind: RepairKind,
    /// The triangles concerned, by their ids before the repair: removed ones first, then those that were
    /// divided; for a hole, its neighbours.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<u32>,
    /// The vertices concerned: the one that was merged and the one that stays; corners; a rim.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<VertexId>,
    /// A place on it; `None` if that is not finite.
    pub at: Option<Point>,
}

/// Surfaces after a repair.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Repaired {
    /// The triangles.
    pub triangles: Vec<[VertexId; 3]>,
    /// The surface of each.
    pub surface_of: Vec<u32>,
    /// For each triangle, the given one that it is, or is part of; `None` if it fills a hole.
    pub new_to_old: Vec<Option<u32>>,
    /// For each triangle, the given one whose labels it takes: its own or, if it fills a hole, one at the
    /// rim.
    pub takes_after: Vec<u32>,
    /// The given points, then new ones where triangles were divided.
    pub points: Vec<Point>,
    /// For each new point, the vertices of the triangle in which it lies, and their weights.
    pub new_points: Vec<([VertexId; 3], [f64; 3])>,
    /// For each vertex, the one that stands for it now.
    pub vertex_to_kept: Vec<VertexId>,
    /// All repairs in the order in which they were made, and what could not be repaired.
    pub done: Vec<Repair>,
}

impl Repaired {
    /// Number of repairs of one kind.
    pub fn count(&self, kind: RepairKind) -> usize {
        self.done.iter().filter(|repair| repair.kind == kind).count()
    }

    /// Values at all points from values at the given points: at new points, linear in their triangles.
    ///
    /// Panics if there are fewer values than there were points.
    pub fn at_points(&self, given: &[f64]) -> Vec<f64> {
        let of = |(vertices, weights): &([VertexId; 3], [f64; 3])| {
            vertices.iter().zip(weights).map(|(v, weight)| weight * given[v.index()]).sum()
        };
        given.iter().copied().chain(self.new_points.iter().map(of)).collect()
    }

    /// Labels of the new triangles, from those of the old ones.
    ///
    /// Panics if there are fewer labels than there were triangles.
    pub fn labels<T: Copy>(&self, old: &[T]) -> Vec<T> {
        self.takes_after.iter().map(|&t| old[t as usize]).collect()
    }
}
