//! A tet mesh that can be changed: what lies behind each facet, where vertices are and what they may do, and
//! what has changed since the first mesh.

use crate::base::{Point, TetId, Threads, VertexId};
use crate::geometry::quality::eas;
use crate::kernel::hold::Hold;
use crate::kernel::journal::Journal;
use crate::kernel::lines::Lines;
use crate::kernel::link::{Behind, HalfFacet, Wall, WallId};
use crate::kernel::locks::Locks;
use crate::kernel::overlaps::Overlaps;
use crate::kernel::provenance::{Origin, Provenance};
use crate::kernel::qualities::Qualities;
use crate::kernel::tets::{NO_TET, Tets};
use crate::kernel::vertices::Vertices;
use crate::kernel::walls::Walls;

/// The number of tets that a thread sweeps at a time.
const SWEEP: usize = 1 << 14;

/// Tets with neighbours, walls and labels, and a record of which of them are unchanged.
///
/// Ids are valid while a tet or vertex exists; those of removed ones are reused.
#[derive(Clone, Debug)]
pub struct Complex {
    /// What lies behind each facet.
    pub(super) tets: Tets,
    /// The region of each tet.
    pub(super) regions: Vec<i32>,
    pub(super) vertices: Vertices,
    pub(super) walls: Walls,
    /// Labelled edges.
    pub(super) lines: Lines,
    pub(super) locks: Locks,
    pub(super) qualities: Qualities,
    pub(super) overlaps: Overlaps,
    pub(super) provenance: Provenance,
    pub(super) journal: Journal,
}

impl Complex {
    /// The number of tet slots, including free ones; tet ids are below it.
    pub fn n_slots(&self) -> usize {
        self.tets.n_slots()
    }

    /// The number of tets.
    pub fn n_tets(&self) -> usize {
        self.tets.n_slots() - self.tets.free_slots().len()
    }

    /// The number of vertex slots, including free ones; vertex ids are below it.
    pub fn n_vertex_slots(&self) -> usize {
        self.vertices.n_slots()
    }

    /// The number of vertices that belong to a tet.
    pub fn n_used_vertices(&self) -> usize {
        self.tets.tets_of_vertices().iter().filter(|&&t| t != NO_TET).count()
    }

    /// The number of free vertices that belong to a tet.
    pub fn n_free_vertices(&self) -> usize {
        let is_free = |(&tet, &hold): (&TetId, &Hold)| tet != NO_TET && hold == Hold::Free;
        self.tets.tets_of_vertices().iter().zip(self.vertices.holds()).filter(|pair| is_free(*pair)).count()
    }

    /// The ids of all tets, in rising order.
    pub fn tets(&self) -> impl Iterator<Item = TetId> + Clone + '_ {
        self.tets.iter().map(|(t, _)| t)
    }

    /// Whether a tet with this id exists.
    #[inline]
    pub fn is_alive(&self, tet: TetId) -> bool {
        self.tets.is_alive(tet)
    }

    /// Whether a vertex belongs to a tet.
    #[inline]
    pub fn is_used(&self, vertex: VertexId) -> bool {
        self.tets.tet_of(vertex) != NO_TET
    }

    /// Whether a vertex is not one of the first mesh.
    #[inline]
    pub fn is_inserted(&self, vertex: VertexId) -> bool {
        self.provenance.origin(vertex) == Origin::Inserted
    }

    /// The vertices of a tet, in positive orientation unless the tet was given inverted.
    #[inline(always)]
    pub fn vertices(&self, tet: TetId) -> [VertexId; 4] {
        self.tets.vertices(tet)
    }

    /// The positions of the vertices of a tet.
    #[inline]
    pub fn corners(&self, tet: TetId) -> [Point; 4] {
        let [a, b, c, d] = self.tets.vertices(tet);
        [self.point(a), self.point(b), self.point(c), self.point(d)]
    }

    /// The position of a vertex.
    #[inline(always)]
    pub fn point(&self, vertex: VertexId) -> Point {
        self.vertices.point(vertex)
    }

    /// The constraint on a vertex.
    #[inline(always)]
    pub fn hold(&self, vertex: VertexId) -> Hold {
        self.vertices.hold(vertex)
    }

    /// Overrides the constraint on a vertex.
    pub fn set_hold(&mut self, vertex: VertexId, hold: Hold) {
        self.vertices.set_hold(vertex, hold);
    }

    /// The region of a tet.
    #[inline]
    pub fn region(&self, tet: TetId) -> i32 {
        self.regions[tet.index()]
    }

    /// The quality of a tet: see [`Self::measure`], and [`Self::exempt`] for exempt tets.
    #[inline]
    pub fn quality(&self, tet: TetId) -> f64 {
        self.qualities.get(tet).unwrap_or_else(|| self.measure(self.corners(tet)))
    }

    /// The tets with quality below `bar`, in rising order of id.
    pub fn below(&self, bar: f64, threads: &Threads) -> Vec<TetId> {
        threads.in_runs(self.tets.n_slots(), SWEEP, |(): &mut (), range| {
            range.map(TetId::new).filter(|&t| self.is_alive(t) && self.quality(t) < bar).collect()
        })
    }

    /// The tet with the lowest quality, the first among equals; `None` if there are no tets.
    pub fn worst(&self) -> Option<(TetId, f64)> {
        self.tets().map(|t| (t, self.quality(t))).min_by(|x, y| x.1.total_cmp(&y.1))
    }

    /// The quality measure: EAS.
    #[inline]
    pub fn measure(&self, tet: [Point; 4]) -> f64 {
        eas(tet)
    }

    /// Whether a tet is one of the first mesh, with its vertices where they were.
    #[inline]
    pub fn is_original(&self, tet: TetId) -> bool {
        !self.provenance.is_new(tet)
    }

    /// What lies behind facet `i` of a tet.
    #[inline]
    pub fn behind(&self, tet: TetId, i: usize) -> Behind {
        self.tets.link(HalfFacet::new(tet, i)).behind()
    }

    /// The facet of the tet behind a facet, through walls; [`HalfFacet::NONE`] beyond the boundary.
    #[inline]
    pub fn across(&self, tet: TetId, i: usize) -> HalfFacet {
        match self.behind(tet, i) {
            Behind::Tet(half) => half,
            Behind::Wall(wall) => self.walls.across(wall, HalfFacet::new(tet, i)),
        }
    }

    /// The vertices of a facet, counter-clockwise seen from outside its tet.
    #[inline]
    pub fn facet(&self, half: HalfFacet) -> [VertexId; 3] {
        self.tets.outward(half)
    }

    /// Whether a facet of a tet is a wall.
    #[inline]
    pub fn is_wall(&self, tet: TetId, i: usize) -> bool {
        self.tets.link(HalfFacet::new(tet, i)).is_wall()
    }

    /// A wall.
    pub fn wall(&self, wall: WallId) -> &Wall {
        self.walls.get(wall)
    }

    /// All walls, in rising order.
    pub fn walls(&self) -> impl Iterator<Item = (WallId, &Wall)> + '_ {
        self.walls.iter()
    }

    /// A tet of a vertex; `NO_TET` if it has none.
    #[inline]
    pub fn tet_of(&self, vertex: VertexId) -> TetId {
        self.tets.tet_of(vertex)
    }

    /// The id that the next inserted vertex gets.
    #[inline]
    pub fn next_vertex(&self) -> VertexId {
        self.vertices.next_slot()
    }

    /// Whether walls, and the vertices on them, must stay as they are. Initially true.
    pub fn keeps_surface(&self) -> bool {
        self.locks.keeps_surface
    }

    /// Whether tets overlap, or parts of the mesh are connected at single vertices or edges.
    pub fn is_tangled(&self) -> bool {
        self.overlaps.is_tangled
    }

    /// Forbids changes to touch a tet.
    pub fn lock(&mut self, tet: TetId) {
        self.locks.add_tet(tet, self.n_slots());
    }

    /// Whether no change may touch a tet.
    #[inline]
    pub fn is_locked(&self, tet: TetId) -> bool {
        self.locks.has_tet(tet)
    }

    /// Forbids changes to remove a wall. The tets beside it may change, but its vertices stay where they are.
    pub fn fix_wall(&mut self, wall: WallId) {
        self.locks.add_wall(wall, self.walls.n_slots());
        for v in self.facet(self.wall(wall).sides[0]) {
            self.set_hold(v, Hold::Fixed);
        }
    }

    /// Whether no change may remove a wall.
    #[inline]
    pub fn is_fixed_wall(&self, wall: WallId) -> bool {
        self.locks.has_wall(wall)
    }

    /// Allows changes to modify walls and lines, and to move and remove vertices on them that are not fixed.
    pub fn adapt_surface(&mut self) {
        self.locks.keeps_surface = false;
    }

    /// Forbids changes to modify walls from now on.
    pub fn keep_surface(&mut self) {
        self.locks.keeps_surface = true;
    }

    /// The local number of a vertex in a tet that has it.
    #[inline]
    pub fn place(&self, tet: TetId, vertex: VertexId) -> usize {
        self.tets.place(tet, vertex)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_can_share_a_complex() {
        const fn is_shared<T: Send + Sync>() {}
        const { is_shared::<Complex>() }
    }
}
