//! The operations tried for one bad tet, stage by stage.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::tet::{EDGES, FACETS, centroid};
use crate::geometry::triangle::{self, area_vector};
use crate::geometry::vector::{add, norm, scale, sub};
use crate::kernel::{Behind, Hold, Shell};
use crate::ops::{collapse, split_crossed, split_edge, split_onto};
use crate::remesh::classify::{Defect, classify};
use crate::remesh::repair::search::{Search, Tools};
use crate::remesh::report::Operation;
use crate::remesh::surface::SurfaceTrack;

/// The stages, tried one after the other until the tet is no longer bad.
pub(super) const STAGES: [fn(&mut Search, TetId); 6] = [
    |search, tet| search.reconnect(tet),
    |search, tet| search.by_type(tet),
    |search, tet| search.by_length(tet),
    |search, tet| search.smooth(tet),
    |search, tet| search.collapse_any(tet),
    |search, tet| search.insert(tet),
];
/// How many stages the first round tries. Each round that leaves bad tets adds one: many tets that seem to
/// need an inserted vertex no longer do once their neighbours are repaired.
pub(super) const FIRST_STAGES: usize = 3;

/// Heights above walls, relative to the square root of their area: the first is that of a regular tet on one
/// wall.
const HEIGHTS: [f64; 3] = [1.24, 0.62, 0.31];

impl Search<'_> {
    /// Stage one of the paper: removes an edge or a facet of the tet.
    fn reconnect(&mut self, tet: TetId) {
        let vertices = self.complex().vertices(tet);
        for edge in EDGES.map(|e| e.map(|i| vertices[i])) {
            let bar = self.bar(tet);
            let is_feature = |search: &mut Self, shell: &Shell| search.hold_on(shell, edge) == Hold::Edge;
            if self.repair.surface.is_some() && self.around(tet, edge, is_feature) {
                continue;
            }
            if self.tools.edge_removal.propose(
                self.complex(),
                tet,
                edge,
                bar,
                &mut self.tools.repairs.proposal,
            ) {
                self.offer(Operation::EdgeRemoval);
            }
        }
        for facet in 0..4 {
            let bar = self.bar(tet);
            if self.tools.face_removal.propose(
                self.complex(),
                tet,
                facet,
                bar,
                &mut self.tools.repairs.proposal,
            ) {
                self.offer(Operation::FaceRemoval);
            }
        }
    }

    /// Stage two of the paper: the repair for the type of the tet.
    fn by_type(&mut self, tet: TetId) {
        let vertices = self.complex().vertices(tet);
        match classify(self.complex().corners(tet)) {
            Defect::CrossedEdges { edge } => {
                self.cross(tet, EDGES[edge].map(|i| vertices[i]), EDGES[5 - edge].map(|i| vertices[i]))
            }
            Defect::VertexAtEdge { vertex, edge } => {
                self.around(tet, EDGES[edge].map(|i| vertices[i]), |search, shell| {
                    let (complex, bar) = (search.complex(), search.bar(tet));
                    let proposal = &mut search.tools.repairs.proposal;
                    if split_onto(complex, shell, vertices[vertex], bar, proposal) {
                        search.offer(Operation::SplitOnto);
                    }
                });
            }
            Defect::VertexOverFacet { vertex } => {
                for other in (0..4).filter(|&i| i != vertex) {
                    self.collapse(tet, vertices[vertex], vertices[other]);
                    self.collapse(tet, vertices[other], vertices[vertex]);
                }
            }
            Defect::ShortEdge { edge } => {
                let [a, b] = EDGES[edge].map(|i| vertices[i]);
                self.collapse(tet, a, b);
                self.collapse(tet, b, a);
            }
            Defect::Other => {}
        }
    }

    fn cross(&mut self, tet: TetId, [a, b]: [VertexId; 2], [c, d]: [VertexId; 2]) {
        let sum = [a, b, c, d].into_iter().fold([0.0; 3], |sum, v| add(sum, self.complex().point(v)));
        let middle = scale(sum, 0.25);
        self.around(tet, [a, b], |search, first| {
            search.around(tet, [c, d], |search, second| {
                let (complex, bar) = (search.complex(), search.bar(tet));
                let proposal = &mut search.tools.repairs.proposal;
                if split_crossed(complex, [first, second], middle, bar, proposal) {
                    search.offer(Operation::SplitCrossed);
                }
            });
        });
    }

    pub(super) fn collapse(&mut self, tet: TetId, removed: VertexId, kept: VertexId) {
        if !self.may_collapse(tet, removed, kept) {
            return;
        }
        self.gather(removed);
        let bar = self.bar(tet);
        if collapse(
            self.complex(),
            &self.tools.star.tets,
            removed,
            kept,
            bar,
            &mut self.tools.repairs.proposal,
        ) {
            self.offer(Operation::Collapse);
        }
    }

    /// Moves the vertices of a tet: anywhere if free; along the surface and its features if these may change.
    fn smooth(&mut self, tet: TetId) {
        for vertex in self.complex().vertices(tet) {
            let hold = self.complex().hold(vertex);
            if hold == Hold::Fixed || hold != Hold::Free && self.repair.surface.is_none() {
                continue;
            }
            self.gather(vertex);
            let repair = self.repair;
            let track = match &repair.surface {
                Some(surface) if hold != Hold::Free => self.with_shell(|search, shell| {
                    surface.track(&repair.complex, &search.tools.star.tets, vertex, shell)
                }),
                _ => Some(SurfaceTrack::Anywhere),
            };
            let Some(track) = track else { continue };
            let limits = [self.bar(tet), repair.target];
            let Tools { star, smoothing, repairs, .. } = &mut *self.tools;
            let proposal = &mut repairs.proposal;
            if smoothing.propose(&repair.complex, &star.tets, vertex, limits, &track, proposal) {
                self.offer(Operation::Smoothing);
            }
        }
    }

    /// Splits the edges of a tet that lie on the surface or are lines.
    fn split_surface(&mut self, tet: TetId) {
        if self.repair.surface.is_none() {
            return;
        }
        let vertices = self.complex().vertices(tet);
        for edge in EDGES.map(|e| e.map(|i| vertices[i])) {
            self.around(tet, edge, |search, shell| {
                let is_inside = shell.walls.is_empty() && search.complex().line(edge[0], edge[1]).is_none();
                if !is_inside {
                    search.split_at_middle(tet, shell, edge, search.hold_on(shell, edge));
                }
            });
        }
    }

    /// Offers to split an edge of a tet, with the tets `shell` around it, at its midpoint if it may be
    /// divided; `hold` is the constraint on the new vertex.
    pub(super) fn split_at_middle(&mut self, tet: TetId, shell: &Shell, edge: [VertexId; 2], hold: Hold) {
        let [a, b] = edge;
        if !self.complex().may_divide(a, b) {
            return;
        }
        let middle = scale(add(self.complex().point(a), self.complex().point(b)), 0.5);
        let (complex, bar) = (self.complex(), self.bar(tet));
        let proposal = &mut self.tools.repairs.proposal;
        if split_edge(complex, shell, edge, (middle, hold), bar, proposal) {
            self.offer(Operation::SplitEdge);
        }
    }

    /// Collapses any edge of a tet, in either direction.
    fn collapse_any(&mut self, tet: TetId) {
        let vertices = self.complex().vertices(tet);
        for removed in vertices {
            for kept in vertices.into_iter().filter(|&v| v != removed) {
                self.collapse(tet, removed, kept);
            }
        }
    }

    /// Inserts a vertex at the centroid of a tet, at the midpoint of an edge, or at the centroid of a facet.
    fn insert(&mut self, tet: TetId) {
        self.split_surface(tet);
        let corners = self.complex().corners(tet);
        self.insert_at(tet, &[tet], centroid(corners));
        let vertices = self.complex().vertices(tet);
        for [i, j] in EDGES {
            self.around(tet, [vertices[i], vertices[j]], |search, shell| {
                search.insert_at(tet, &shell.tets, scale(add(corners[i], corners[j]), 0.5));
            });
        }
        for (i, facet) in FACETS.into_iter().enumerate() {
            if let Behind::Tet(half) = self.complex().behind(tet, i) {
                let [a, b, c] = facet.map(|corner| corners[corner]);
                self.insert_at(tet, &[tet, half.tet()], scale(add(add(a, b), c), 1.0 / 3.0));
            }
        }
        self.insert_off_walls(tet);
    }

    /// Inserts a vertex above the walls of a tet, starting at the height of a regular tet: in a tet that lies
    /// flat on its walls, all the tet's own midpoints are too close to them.
    fn insert_off_walls(&mut self, tet: TetId) {
        let corners = self.complex().corners(tet);
        let (mut inwards, mut middle, mut area) = ([0.0; 3], [0.0; 3], 0.0);
        for facet in
            FACETS.into_iter().enumerate().filter_map(|(i, f)| self.complex().is_wall(tet, i).then_some(f))
        {
            let wall = facet.map(|corner| corners[corner]);
            let outwards = area_vector(wall);
            let of_wall = norm(outwards);
            (inwards, area) = (sub(inwards, outwards), area + of_wall);
            middle = add(middle, scale(triangle::centroid(wall), of_wall));
        }
        if area <= 0.0 {
            return;
        }
        let (inwards, middle) = (scale(inwards, 1.0 / area), scale(middle, 1.0 / area));
        for height in HEIGHTS {
            let height = height * area.sqrt();
            self.insert_at(tet, &[tet], add(middle, scale(inwards, height)));
        }
    }

    fn insert_at(&mut self, tet: TetId, seed: &[TetId], point: Point) {
        let (complex, limits) = (self.complex(), [self.bar(tet), self.repair.target]);
        let proposal = &mut self.tools.repairs.proposal;
        let is_better = self.tools.insertion.propose(complex, seed, point, limits, proposal);
        self.note_cavity();
        if is_better {
            self.offer(Operation::Insertion);
        }
    }
}
