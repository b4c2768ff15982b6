//! What an operation proposes: tets to remove, tets to insert, and one vertex to insert, move or remove.

use crate::base::{Point, TetId, VertexId, sorted_ids};
use crate::geometry::tet::FACETS;
use crate::kernel::complex::Complex;
use crate::kernel::exempt::Side;
use crate::kernel::hold::Hold;

/// A tet to be inserted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fill {
    /// The vertices of the tet, which must be positive.
    pub vertices: [VertexId; 4],
    /// The region of the tet.
    pub region: i32,
    /// The quality of the tet, as returned by [`Change::judge`].
    pub quality: f64,
}

/// A facet that is to become a wall, where the surface may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewWall {
    /// The three vertices of the facet, in any order.
    pub vertices: [VertexId; 3],
    /// The label of the wall.
    pub patch: i32,
    /// The triangle of the first mesh that it inherits from.
    pub triangle: u32,
}

/// An edge of the fill that is to become a line, where lines may change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NewLine {
    /// The two vertices of the edge, in any order.
    pub vertices: [VertexId; 2],
    /// The source of the line that it inherits from.
    pub source: u32,
}

/// What a change does to a vertex.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum VertexChange {
    /// Nothing.
    #[default]
    None,
    /// A new vertex with the id [`Complex::next_vertex`] is inserted, with this constraint.
    Insert(Point, Hold),
    /// A vertex moves to this point.
    Move(VertexId, Point),
    /// A vertex is removed.
    Remove(VertexId),
}

/// A proposed change. Its lists can be reused for the next one: [`Self::clear`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Change {
    /// The tets to remove.
    pub cavity: Vec<TetId>,
    /// The tets to insert.
    pub fill: Vec<Fill>,
    /// What happens to a vertex.
    pub vertex: VertexChange,
    /// Walls to insert; the walls of the cavity for which the fill has no facet are removed. Empty if the
    /// surface stays.
    pub walls: Vec<NewWall>,
    /// Lines to insert; the lines of the cavity whose edge the fill does not have are removed.
    pub lines: Vec<NewLine>,
}

impl Change {
    /// Empties the change.
    pub fn clear(&mut self) {
        self.cavity.clear();
        self.fill.clear();
        self.walls.clear();
        self.lines.clear();
        self.vertex = VertexChange::None;
    }

    /// Gives a vertex another id in all that the change inserts.
    pub fn renumber(&mut self, before: VertexId, after: VertexId) {
        let tets = self.fill.iter_mut().flat_map(|tet| &mut tet.vertices);
        let walls = self.walls.iter_mut().flat_map(|wall| &mut wall.vertices);
        let lines = self.lines.iter_mut().flat_map(|line| &mut line.vertices);
        tets.chain(walls).chain(lines).filter(|v| **v == before).for_each(|v| *v = after);
    }

    /// The lowest quality of the fill.
    pub fn worst(&self) -> f64 {
        self.fill.iter().map(|tet| tet.quality).fold(f64::INFINITY, f64::min)
    }

    /// Adds a tet to the fill, with the quality that it has with its vertices where the change puts them.
    pub fn push(&mut self, complex: &Complex, vertices: [VertexId; 4], region: i32) {
        let quality = self.judge(complex, vertices, self.corners(complex, vertices));
        self.fill.push(Fill { vertices, region, quality });
    }

    /// The quality of a tet with these vertices at these `corners` after the change, given the cavity and the
    /// new walls; see [`Complex::judge`].
    #[inline]
    pub fn judge(&self, complex: &Complex, vertices: [VertexId; 4], corners: [Point; 4]) -> f64 {
        complex.judge(corners, |i| {
            let facet = sorted_ids(FACETS[i].map(|corner| vertices[corner]));
            match complex.side_of(&self.cavity, facet) {
                Side::Inside if self.walls.iter().any(|wall| sorted_ids(wall.vertices) == facet) => {
                    Side::Wall
                }
                side => side,
            }
        })
    }

    /// Adds a tet to the fill; returns whether it is better than `bar`.
    pub fn push_above(&mut self, complex: &Complex, vertices: [VertexId; 4], region: i32, bar: f64) -> bool {
        self.push(complex, vertices, region);
        self.fill.last().is_some_and(|tet| tet.quality > bar)
    }

    /// The positions of vertices after the change.
    #[inline]
    pub fn corners<const N: usize>(&self, complex: &Complex, vertices: [VertexId; N]) -> [Point; N] {
        let mut corners = [[0.0; 3]; N];
        for i in 0..N {
            corners[i] = self.point(complex, vertices[i]);
        }
        corners
    }

    /// The position of a vertex after the change.
    #[inline]
    pub fn point(&self, complex: &Complex, vertex: VertexId) -> Point {
        match self.vertex {
            VertexChange::Insert(point, _) if vertex == complex.next_vertex() => point,
            VertexChange::Move(moved, point) if vertex == moved => point,
            _ => complex.point(vertex),
        }
    }
}
