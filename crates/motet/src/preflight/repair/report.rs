//! What a repair did: the new triangles, where each came from, and every change by name.

use serde::Serialize;

use crate::base::{Point, VertexId};

/// What was done, or could not be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum RepairKind {
    /// A vertex became one with another.
    MergedVertex,
    /// An edge was divided at a vertex that lies on it: a T-junction. The vertex comes first, then the ends of the edge.
    TJunction,
    /// Two triangles that lie on each other, in one plane, were divided alike.
    Imprinted,
    /// Two triangles that go through each other were divided along the line where they do.
    CutCrossing,
    /// Of triangles that face each other one stayed, as the wall between two bodies.
    KeptWall,
    /// Triangles that meet stayed as they were: what would come of dividing them would meet in more than it shares.
    LeftMeeting,
    /// A triangle that named a vertex twice went.
    DroppedRepeated,
    /// A triangle whose corners lay on a line went; its neighbours at the longest edge were divided.
    DroppedFlat,
    /// A triangle whose corners lie on a line stayed: two of them are at one place and want to be merged, or very many lie on one line.
    LeftFlat,
    /// A triangle went that its surface had twice; where the other faced the opposite side both went.
    DroppedDuplicate,
    /// A triangle faces the other side now.
    Turned,
    /// A part of a surface stayed as it was, since it has only one side, as a Möbius strip does.
    LeftOneSided,
    /// A hole was filled.
    ClosedHole,
    /// A hole stayed, since its rim is too long.
    LeftLong,
    /// A hole stayed, since no triangles without new points fill it and touch nothing.
    LeftOpen,
    /// A hole stayed, since its rim leads nowhere: triangles there face different sides, or more than two meet at an edge.
    LeftTorn,
}

/// One change, or one that could not be made.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Repair {
    /// What.
    #[serde(rename = "name")]
    pub kind: RepairKind,
    /// The triangles concerned, by their ids before the repair: what went first, then those that were divided; round a hole its neighbours.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<u32>,
    /// The vertices concerned: the one that went and the one that stayed; corners; a rim.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<VertexId>,
    /// Where; `None` where that is not finite.
    pub at: Option<Point>,
}

/// Surfaces after a repair.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Repaired {
    /// The triangles.
    pub triangles: Vec<[VertexId; 3]>,
    /// The surface of each.
    pub surface_of: Vec<u32>,
    /// For each the triangle that it was, or is a part of; `None` where it fills a hole.
    pub new_to_old: Vec<Option<u32>>,
    /// For each the old triangle whose labels it takes: its own, or where it fills a hole one at the rim.
    pub takes_after: Vec<u32>,
    /// The points that were given, then new ones, where triangles were divided.
    pub points: Vec<Point>,
    /// For each new point the vertices of the triangle in which it lies, and their weights.
    pub new_points: Vec<([VertexId; 3], [f64; 3])>,
    /// For each vertex the one that stands for it now.
    pub vertex_to_kept: Vec<VertexId>,
    /// Everything that was done, in that order, and what could not be.
    pub done: Vec<Repair>,
}

impl Repaired {
    /// How often something was done.
    pub fn count(&self, kind: RepairKind) -> usize {
        self.done.iter().filter(|repair| repair.kind == kind).count()
    }

    /// Values at all points, from those at the points that were given: linear in the triangles where there are new ones.
    ///
    /// Panics when there are fewer values than there were points.
    pub fn at_points(&self, given: &[f64]) -> Vec<f64> {
        let of = |(vertices, weights): &([VertexId; 3], [f64; 3])| {
            vertices.iter().zip(weights).map(|(v, weight)| weight * given[v.index()]).sum()
        };
        given.iter().copied().chain(self.new_points.iter().map(of)).collect()
    }

    /// Labels of the new triangles, from those of the old ones.
    ///
    /// Panics when there are fewer labels than there were triangles.
    pub fn labels<T: Copy>(&self, old: &[T]) -> Vec<T> {
        self.takes_after.iter().map(|&t| old[t as usize]).collect()
    }
}
