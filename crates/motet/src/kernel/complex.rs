//! A tet mesh that can be changed: it knows what lies behind each facet, and keeps free lists of unused
//! slots.

use std::cell::Cell;
use std::ops::Range;

use crate::base::{Point, TetId, VertexId};
use crate::geometry::quality::{ROUGH_EAS_ERROR, eas};
use crate::kernel::hold::Hold;
use crate::kernel::journal::Journal;
use crate::kernel::lines::Lines;
use crate::kernel::link::{Behind, HalfFacet, Wall, WallId};
use crate::kernel::tets::{NO_TET, Tets};

/// Tets with neighbours, walls and labels, and a record of which of them are unchanged.
///
/// Ids are valid while a tet or vertex exists; those of removed ones are reused.
#[derive(Clone, Debug)]
pub struct Complex {
    pub(super) points: Vec<Point>,
    pub(super) holds: Vec<Hold>,
    /// How many tets each vertex has: where tets overlap, more than are connected through facets at it.
    pub(super) vertex_to_n_tets: Vec<u32>,
    pub(super) tets: Tets,
    pub(super) regions: Vec<i32>,
    /// The quality of each tet; [`UNMEASURED`] until it is first requested.
    pub(super) qualities: Vec<Cell<f64>>,
    /// Approximate qualities of the tets of the first mesh.
    pub(super) rough: Vec<f32>,
    /// Whether a tet is not one of the first mesh, or has a vertex that moved.
    pub(super) is_new: Vec<bool>,
    /// Whether a vertex is not one of the first mesh, or has moved.
    pub(super) vertex_is_changed: Vec<bool>,
    /// Whether a vertex is not one of the first mesh.
    pub(super) vertex_is_inserted: Vec<bool>,
    pub(super) walls: Vec<Wall>,
    pub(super) free_vertices: Vec<VertexId>,
    pub(super) free_walls: Vec<WallId>,
    /// Marks tets that no change may touch; empty if there are none.
    pub(super) is_locked: Vec<bool>,
    /// Edges that stay although they are not on a wall, lower vertex first, sorted.
    pub(super) fixed_edges: Vec<[VertexId; 2]>,
    /// Labelled edges.
    pub(super) lines: Lines,
    /// Marks walls that no change may remove; empty if there are none.
    pub(super) is_fixed_wall: Vec<bool>,
    /// New tets of these qualities are exempt if walls force them; see [`Complex::exempt`].
    pub(super) exempt_range: Range<f64>,
    /// Tets of the first mesh that are folded over others, in rising order.
    pub(super) folded: Vec<TetId>,
    /// Whether walls stay as they are, and the vertices on them.
    pub(super) keeps_surface: bool,
    /// Whether a tet of the first mesh was flat or inverted, or the tets of a vertex were not all connected
    /// through facets: then tets may overlap.
    pub(super) is_tangled: bool,
    /// Whether most tets of the first mesh are numbered with the opposite orientation.
    pub(super) mostly_reversed: bool,
    /// Triangles of the first mesh that are no longer walls.
    pub(super) removed_triangles: Vec<u32>,
    pub(super) journal: Journal,
}

/// The quality of a tet that has not been measured.
pub(super) const UNMEASURED: f64 = f64::NAN;

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
        self.points.len()
    }

    /// The number of vertices that belong to a tet.
    pub fn n_used_vertices(&self) -> usize {
        self.tets.tets_of_vertices().iter().filter(|&&t| t != NO_TET).count()
    }

    /// The number of free vertices that belong to a tet.
    pub fn n_free_vertices(&self) -> usize {
        let is_free = |(&tet, &hold): (&TetId, &Hold)| tet != NO_TET && hold == Hold::Free;
        self.tets.tets_of_vertices().iter().zip(&self.holds).filter(|pair| is_free(*pair)).count()
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
        self.vertex_is_inserted[vertex.index()]
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
        [self.points[a.index()], self.points[b.index()], self.points[c.index()], self.points[d.index()]]
    }

    /// The position of a vertex.
    #[inline(always)]
    pub fn point(&self, vertex: VertexId) -> Point {
        self.points[vertex.index()]
    }

    /// The constraint on a vertex.
    #[inline(always)]
    pub fn hold(&self, vertex: VertexId) -> Hold {
        self.holds[vertex.index()]
    }

    /// The region of a tet.
    #[inline]
    pub fn region(&self, tet: TetId) -> i32 {
        self.regions[tet.index()]
    }

    /// The quality of a tet: see [`Self::measure`], and [`Self::exempt`] for exempt tets.
    #[inline]
    pub fn quality(&self, tet: TetId) -> f64 {
        let known = &self.qualities[tet.index()];
        if known.get().is_nan() {
            known.set(self.measure(self.corners(tet)));
        }
        known.get()
    }

    /// The tets with quality below `bar`, in rising order of id. For tets of the first mesh, the exact
    /// quality is computed only if the approximate one leaves a doubt.
    pub fn below(&self, bar: f64) -> Vec<TetId> {
        let limit = bar + ROUGH_EAS_ERROR;
        let is_doubtful = |t: &TetId| self.is_new[t.index()] || f64::from(self.rough[t.index()]) <= limit;
        let all = (0..self.tets.n_slots()).map(TetId::new).filter(is_doubtful);
        all.filter(|&t| self.is_alive(t) && self.quality(t) < bar).collect()
    }

    /// The tet with the lowest quality, the first among equals; `None` if there are no tets.
    pub fn worst(&self) -> Option<(TetId, f64)> {
        let rough = |t: TetId| match self.is_new[t.index()] {
            true => self.quality(t),
            false => f64::from(self.rough[t.index()]),
        };
        let lowest = self.tets().map(rough).fold(f64::INFINITY, f64::min);
        let nearly = self.tets().filter(|&t| rough(t) <= lowest + 2.0 * ROUGH_EAS_ERROR);
        nearly.map(|t| (t, self.quality(t))).min_by(|x, y| x.1.total_cmp(&y.1))
    }

    /// The quality measure: EAS.
    #[inline]
    pub fn measure(&self, tet: [Point; 4]) -> f64 {
        eas(tet)
    }

    /// Whether a tet is one of the first mesh, with its vertices where they were.
    #[inline]
    pub fn is_original(&self, tet: TetId) -> bool {
        !self.is_new[tet.index()]
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
            Behind::Wall(wall) => self.walls[wall.index()].other(HalfFacet::new(tet, i)),
        }
    }

    /// Whether a facet of a tet is a wall.
    #[inline]
    pub fn is_wall(&self, tet: TetId, i: usize) -> bool {
        self.tets.link(HalfFacet::new(tet, i)).is_wall()
    }

    /// A wall.
    pub fn wall(&self, wall: WallId) -> &Wall {
        &self.walls[wall.index()]
    }

    /// All walls, in rising order.
    pub fn walls(&self) -> impl Iterator<Item = (WallId, &Wall)> + '_ {
        let all = (0..).map(WallId).zip(&self.walls);
        all.filter(|(_, wall)| !wall.sides[0].is_none())
    }

    /// A tet of a vertex; `NO_TET` if it has none.
    #[inline]
    pub fn tet_of(&self, vertex: VertexId) -> TetId {
        self.tets.tet_of(vertex)
    }

    /// The id that the next inserted vertex gets.
    #[inline]
    pub fn next_vertex(&self) -> VertexId {
        match self.free_vertices.last() {
            Some(&vertex) => vertex,
            None => VertexId::new(self.points.len()),
        }
    }

    /// Whether walls, and the vertices on them, must stay as they are. Initially true.
    pub fn keeps_surface(&self) -> bool {
        self.keeps_surface
    }

    /// Forbids changes to touch a tet.
    pub fn lock(&mut self, tet: TetId) {
        if self.is_locked.is_empty() {
            self.is_locked = vec![false; self.n_slots()];
        }
        self.is_locked[tet.index()] = true;
    }

    /// Whether no change may touch a tet.
    #[inline]
    pub fn is_locked(&self, tet: TetId) -> bool {
        self.is_locked.get(tet.index()).is_some_and(|&locked| locked)
    }

    /// Forbids changes to remove a wall. The tets beside it may change, but its vertices stay where they are.
    pub fn fix_wall(&mut self, wall: WallId) {
        if self.is_fixed_wall.is_empty() {
            self.is_fixed_wall = vec![false; self.walls.len()];
        }
        self.is_fixed_wall[wall.index()] = true;
        for v in self.facet(self.walls[wall.index()].sides[0]) {
            self.holds[v.index()] = Hold::Fixed;
        }
    }

    /// Whether no change may remove a wall.
    #[inline]
    pub fn is_fixed_wall(&self, wall: WallId) -> bool {
        self.is_fixed_wall.get(wall.index()).is_some_and(|&fixed| fixed)
    }

    /// Allows changes to modify walls and lines, and to move and remove vertices on them that are not fixed.
    pub fn adapt_surface(&mut self) {
        self.keeps_surface = false;
    }

    /// Forbids changes to modify walls from now on.
    pub fn keep_surface(&mut self) {
        self.keeps_surface = true;
    }

    /// The local number of a vertex in a tet that has it.
    #[inline]
    pub fn place(&self, tet: TetId, vertex: VertexId) -> usize {
        self.tets.place(tet, vertex)
    }
}
