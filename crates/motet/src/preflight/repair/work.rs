//! Triangles under repair: where each comes from, and what has been done so far.

use super::report::{Repair, RepairKind, Repaired};
use crate::base::{Point, VertexId};
use crate::preflight::fault::mean;
use crate::preflight::sides::{Side, sorted_sides};
use crate::preflight::single::Duplicates;
use crate::preflight::surfaces::{Role, Surfaces};

/// The origin of a new point: the vertices of the triangle that it lies in, and their weights.
pub(super) type Origin = ([VertexId; 3], [f64; 3]);

/// A triangle, with its surface and where it comes from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    pub(super) vertices: [VertexId; 3],
    pub(super) surface: u32,
    /// The given triangle that it is part of, or whose labels it takes.
    pub(super) takes_after: u32,
    /// Whether it fills a hole.
    pub(super) is_new: bool,
    pub(super) is_reversed: bool,
}

pub(super) struct Work<'a> {
    pub(super) points: &'a [Point],
    pub(super) roles: &'a [Role],
    pub(super) pieces: Vec<Piece>,
    pub(super) done: Vec<Repair>,
}

/// Triangles and their surfaces, in the form that the search needs.
pub(super) struct Lists {
    triangles: Vec<[VertexId; 3]>,
    surface_of: Vec<u32>,
}

impl Lists {
    pub(super) fn surfaces<'a>(&'a self, work: &Work<'a>) -> Surfaces<'a> {
        Surfaces {
            points: work.points,
            triangles: &self.triangles,
            surface_of: &self.surface_of,
            roles: work.roles,
        }
    }
}

impl<'a> Work<'a> {
    pub(super) fn new(surfaces: &Surfaces<'a>) -> Self {
        let piece = |t: u32| Piece {
            vertices: surfaces.triangles[t as usize],
            surface: surfaces.surface(t),
            takes_after: t,
            is_new: false,
            is_reversed: false,
        };
        let pieces = surfaces.ids().map(piece).collect();
        Self { points: surfaces.points, roles: surfaces.roles, pieces, done: Vec::new() }
    }

    pub(super) fn lists(&self) -> Lists {
        Lists {
            triangles: self.pieces.iter().map(|piece| piece.vertices).collect(),
            surface_of: self.pieces.iter().map(|piece| piece.surface).collect(),
        }
    }

    /// The sides of the triangles that remain without duplicates, as the search has them.
    pub(super) fn sides(&self, lists: &Lists) -> Vec<Side> {
        let surfaces = Surfaces {
            points: self.points,
            triangles: &lists.triangles,
            surface_of: &lists.surface_of,
            roles: self.roles,
        };
        let duplicates = Duplicates::new(&surfaces);
        sorted_sides(&surfaces, |t| duplicates.remains[t as usize])
    }

    /// Records a repair, located at the mean of the vertices.
    pub(super) fn record(&mut self, kind: RepairKind, triangles: Vec<u32>, vertices: Vec<VertexId>) {
        let at = mean(&vertices, self.points);
        self.done.push(Repair { kind, triangles, vertices, at });
    }

    /// The given triangle that a piece comes from.
    pub(super) fn old(&self, piece: u32) -> u32 {
        self.pieces[piece as usize].takes_after
    }

    pub(super) fn reverse(&mut self, piece: u32) {
        let piece = &mut self.pieces[piece as usize];
        piece.vertices.swap(1, 2);
        piece.is_reversed = !piece.is_reversed;
    }

    /// Removes duplicate triangles of the same surface.
    pub(super) fn drop_duplicates(&mut self) {
        let lists = self.lists();
        let remains = Duplicates::new(&lists.surfaces(self)).remains;
        let has_repeated_vertex = |[a, b, c]: [VertexId; 3]| a == b || b == c || c == a;
        let is_removed: Vec<bool> = self
            .pieces
            .iter()
            .zip(remains)
            .map(|(p, remains)| !remains && !has_repeated_vertex(p.vertices))
            .collect();
        for t in (0..is_removed.len()).filter(|&t| is_removed[t]) {
            let (old, vertices) = (self.old(t as u32), self.pieces[t].vertices.to_vec());
            self.record(RepairKind::DroppedDuplicate, vec![old], vertices);
        }
        let mut is_removed = is_removed.into_iter();
        self.pieces.retain(|_| is_removed.next() != Some(true));
    }

    /// The result of the repair. `new_points` gives the place of each new point in the given surfaces.
    pub(super) fn finish(mut self, vertex_to_kept: Vec<VertexId>, new_points: Vec<Origin>) -> Repaired {
        for piece in self.pieces.clone().iter().filter(|piece| piece.is_reversed && !piece.is_new) {
            self.record(RepairKind::Turned, vec![piece.takes_after], piece.vertices.to_vec());
        }
        let lists = self.lists();
        Repaired {
            new_to_old: self.pieces.iter().map(|p| (!p.is_new).then_some(p.takes_after)).collect(),
            takes_after: self.pieces.iter().map(|piece| piece.takes_after).collect(),
            triangles: lists.triangles,
            surface_of: lists.surface_of,
            points: self.points.to_vec(),
            new_points,
            vertex_to_kept,
            done: self.done,
        }
    }
}
