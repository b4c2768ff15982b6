//! Tets that can be changed: with what lies behind each facet, and a free list.

use std::cell::Cell;
use std::ops::Range;

use crate::base::{Point, TetId, VertexId};
use crate::geometry::quality::{ROUGH_EAS_ERROR, eas};
use crate::kernel::journal::Journal;
use crate::kernel::lines::{Lines, rising};
use crate::kernel::link::{Behind, HalfFacet, Link, Wall, WallId};

/// What holds a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Hold {
    /// Nothing: it lies inside and may move or go.
    Free,
    /// A smooth part of a wall.
    Surface,
    /// A feature edge: between two patches, or where a wall has a crease.
    Edge,
    /// Everything: it stays.
    Fixed,
}

/// Tets with neighbours, walls and labels, and a memory of which of them are as they came.
///
/// Ids stay while a tet or vertex lives; those of the gone are given to later ones.
#[derive(Clone, Debug)]
pub struct Complex {
    pub(super) points: Vec<Point>,
    pub(super) holds: Vec<Hold>,
    /// A tet of each vertex; [`NO_TET`] for those without.
    pub(super) vertex_to_tet: Vec<TetId>,
    /// How many tets each vertex has: where tets overlap, more than hang together by facets at it.
    pub(super) vertex_to_n_tets: Vec<u32>,
    pub(super) tets: Vec<[VertexId; 4]>,
    pub(super) links: Vec<[Link; 4]>,
    pub(super) regions: Vec<i32>,
    /// [`UNMEASURED`] until somebody has asked.
    pub(super) qualities: Vec<Cell<f64>>,
    /// The first mesh's qualities, nearly.
    pub(super) rough: Vec<f32>,
    /// Whether a tet is not one of the first mesh; one whose vertex has moved is not.
    pub(super) is_new: Vec<bool>,
    /// Whether a vertex is not one of the first mesh, or has moved.
    pub(super) vertex_is_new: Vec<bool>,
    /// Whether a vertex is not one of the first mesh.
    pub(super) vertex_came: Vec<bool>,
    pub(super) walls: Vec<Wall>,
    pub(super) free_vertices: Vec<VertexId>,
    pub(super) free_tets: Vec<TetId>,
    pub(super) free_walls: Vec<WallId>,
    /// Tets that no change may touch; empty where there is none.
    pub(super) is_locked: Vec<bool>,
    /// Edges that stay although no wall holds them, lower vertex first, in rising order.
    pub(super) fixed_edges: Vec<[VertexId; 2]>,
    /// Labelled edges.
    pub(super) lines: Lines,
    /// Walls that no change may remove; empty where there is none.
    pub(super) is_fixed_wall: Vec<bool>,
    /// New tets of these qualities count as good where walls force them; see [`Complex::spare`].
    pub(super) spared: Range<f64>,
    /// Tets of the first mesh that are folded over others, in rising order.
    pub(super) folded: Vec<TetId>,
    /// Whether walls stay as they are, and the vertices on them.
    pub(super) keeps_surface: bool,
    /// Whether a tet of the first mesh was flat or inverted, or the tets of a vertex did not all hang together by facets: then tets may overlap.
    pub(super) is_tangled: bool,
    /// Whether most tets of the first mesh are numbered the other way round.
    pub(super) mostly_turned: bool,
    /// Triangles of the first mesh that are no walls any more.
    pub(super) gone_triangles: Vec<u32>,
    pub(super) journal: Journal,
}

/// The quality of a tet of the first mesh that nobody has measured.
pub(super) const UNMEASURED: f64 = f64::NAN;

/// No tet.
pub(crate) const NO_TET: TetId = TetId(u32::MAX);
/// Vertices of a free slot.
pub(super) const FREE: [VertexId; 4] = [VertexId(u32::MAX); 4];

impl Complex {
    /// How many slots for tets there are, free ones included: ids are below.
    pub fn n_slots(&self) -> usize {
        self.tets.len()
    }

    /// How many tets there are.
    pub fn n_tets(&self) -> usize {
        self.tets.len() - self.free_tets.len()
    }

    /// How many vertex ids there are, free ones included.
    pub fn n_vertex_slots(&self) -> usize {
        self.points.len()
    }

    /// How many vertices belong to a tet.
    pub fn n_used_vertices(&self) -> usize {
        self.vertex_to_tet.iter().filter(|&&t| t != NO_TET).count()
    }

    /// How many vertices of tets nothing holds.
    pub fn n_free_vertices(&self) -> usize {
        let is_free = |(&tet, &hold): (&TetId, &Hold)| tet != NO_TET && hold == Hold::Free;
        self.vertex_to_tet.iter().zip(&self.holds).filter(|pair| is_free(*pair)).count()
    }

    /// The tets that there are, in rising order.
    pub fn tets(&self) -> impl Iterator<Item = TetId> + Clone + '_ {
        (0..self.tets.len()).map(TetId::new).filter(|&t| self.is_alive(t))
    }

    /// Whether there is a tet of this id.
    #[inline]
    pub fn is_alive(&self, tet: TetId) -> bool {
        self.tets[tet.index()] != FREE
    }

    /// Whether a vertex belongs to a tet.
    #[inline]
    pub fn is_used(&self, vertex: VertexId) -> bool {
        self.vertex_to_tet[vertex.index()] != NO_TET
    }

    /// Whether a vertex is not one of the first mesh.
    #[inline]
    pub fn has_come(&self, vertex: VertexId) -> bool {
        self.vertex_came[vertex.index()]
    }

    /// The vertices of a tet: positive, unless it came inverted.
    #[inline(always)]
    pub fn vertices(&self, tet: TetId) -> [VertexId; 4] {
        self.tets[tet.index()]
    }

    /// The points of a tet.
    #[inline]
    pub fn corners(&self, tet: TetId) -> [Point; 4] {
        let [a, b, c, d] = self.tets[tet.index()];
        [self.points[a.index()], self.points[b.index()], self.points[c.index()], self.points[d.index()]]
    }

    /// Where a vertex is.
    #[inline(always)]
    pub fn point(&self, vertex: VertexId) -> Point {
        self.points[vertex.index()]
    }

    /// What holds a vertex.
    #[inline(always)]
    pub fn hold(&self, vertex: VertexId) -> Hold {
        self.holds[vertex.index()]
    }

    /// The region of a tet.
    #[inline]
    pub fn region(&self, tet: TetId) -> i32 {
        self.regions[tet.index()]
    }

    /// The quality of a tet: see [`Self::measure`], and [`Self::spare`] for those that count as good.
    #[inline]
    pub fn quality(&self, tet: TetId) -> f64 {
        let known = &self.qualities[tet.index()];
        if known.get().is_nan() {
            known.set(self.measure(self.corners(tet)));
        }
        known.get()
    }

    /// The tets whose quality is below `bar`, in rising order. The first mesh's are looked at closely only where a rough look leaves a doubt.
    pub fn below(&self, bar: f64) -> Vec<TetId> {
        let limit = bar + ROUGH_EAS_ERROR;
        let is_doubtful = |t: &TetId| self.is_new[t.index()] || f64::from(self.rough[t.index()]) <= limit;
        let all = (0..self.tets.len()).map(TetId::new).filter(is_doubtful);
        all.filter(|&t| self.is_alive(t) && self.quality(t) < bar).collect()
    }

    /// The tet of the lowest quality, the first of equal ones; `None` where there is no tet.
    pub fn worst(&self) -> Option<(TetId, f64)> {
        let rough = |t: TetId| match self.is_new[t.index()] {
            true => self.quality(t),
            false => f64::from(self.rough[t.index()]),
        };
        let lowest = self.tets().map(rough).fold(f64::INFINITY, f64::min);
        let nearly = self.tets().filter(|&t| rough(t) <= lowest + 2.0 * ROUGH_EAS_ERROR);
        nearly.map(|t| (t, self.quality(t))).min_by(|x, y| x.1.total_cmp(&y.1))
    }

    /// The measure that everything here is judged by: EAS.
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
        self.links[tet.index()][i].behind()
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
        self.links[tet.index()][i].is_wall()
    }

    /// A wall.
    pub fn wall(&self, wall: WallId) -> &Wall {
        &self.walls[wall.index()]
    }

    /// The walls that there are, in rising order.
    pub fn walls(&self) -> impl Iterator<Item = (WallId, &Wall)> + '_ {
        let all = (0..).map(WallId).zip(&self.walls);
        all.filter(|(_, wall)| !wall.sides[0].is_none())
    }

    /// Some tet of a vertex that belongs to one.
    #[inline]
    pub fn tet_of(&self, vertex: VertexId) -> TetId {
        self.vertex_to_tet[vertex.index()]
    }

    /// The id that the next vertex to be inserted gets.
    #[inline]
    pub fn next_vertex(&self) -> VertexId {
        match self.free_vertices.last() {
            Some(&vertex) => vertex,
            None => VertexId::new(self.points.len()),
        }
    }

    /// Whether walls, and the vertices on them, must stay as they are: so it is at first.
    pub fn keeps_surface(&self) -> bool {
        self.keeps_surface
    }

    /// Lets no change touch a tet any more.
    pub fn lock(&mut self, tet: TetId) {
        if self.is_locked.is_empty() {
            self.is_locked = vec![false; self.tets.len()];
        }
        self.is_locked[tet.index()] = true;
    }

    /// Whether no change may touch a tet.
    #[inline]
    pub fn is_locked(&self, tet: TetId) -> bool {
        self.is_locked.get(tet.index()).is_some_and(|&locked| locked)
    }

    /// Lets no change remove a wall any more. What lies beside it may change, but its vertices stay where they are.
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

    /// Lets no change remove these edges any more; their vertices stay where they are.
    pub fn fix_edges(&mut self, edges: impl IntoIterator<Item = [VertexId; 2]>) {
        for edge in edges {
            self.fixed_edges.push(rising(edge));
            edge.iter().for_each(|v| self.holds[v.index()] = Hold::Fixed);
        }
        self.fixed_edges.sort_unstable();
    }

    /// Lets changes change walls and lines, and move and remove the vertices on them that are not fixed.
    pub fn adapt_surface(&mut self) {
        self.keeps_surface = false;
    }

    /// Lets no wall change from now on.
    pub fn keep_surface(&mut self) {
        self.keeps_surface = true;
    }

    /// Whether an edge must stay although no wall holds it.
    #[inline]
    pub fn is_fixed_edge(&self, a: VertexId, b: VertexId) -> bool {
        !self.fixed_edges.is_empty() && self.fixed_edges.binary_search(&[a.min(b), a.max(b)]).is_ok()
    }

    /// Which place a vertex has in a tet that has it.
    #[inline]
    pub fn place(&self, tet: TetId, vertex: VertexId) -> usize {
        let vertices = self.tets[tet.index()];
        debug_assert!(vertices.contains(&vertex));
        // No search: three comparisons, no branch.
        usize::from(vertices[1] == vertex)
            + 2 * usize::from(vertices[2] == vertex)
            + 3 * usize::from(vertices[3] == vertex)
    }
}
