//! The operations tried for one bad tet, stage by stage.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::tet::{EDGES, FACETS, centroid};
use crate::geometry::triangle::{self, area_vector};
use crate::geometry::vector::{add, norm, scale, sub};
use crate::kernel::{Behind, Hold};
use crate::ops::{collapse, split_crossed, split_edge, split_onto};
use crate::remesh::classify::{Defect, classify};
use crate::remesh::repair::Repair;
use crate::remesh::report::Operation;
use crate::remesh::surface::{Surface, SurfaceTrack};

/// The stages, tried one after the other until the tet is no longer bad.
pub(super) const STAGES: [fn(&mut Repair, TetId); 6] = [
    Repair::reconnect,
    Repair::by_type,
    Repair::by_length,
    Repair::smooth,
    Repair::collapse_any,
    Repair::insert,
];
/// How many stages the first round tries. Each round that leaves bad tets adds one: many tets that seem to
/// need an inserted vertex no longer do once their neighbours are repaired.
pub(super) const FIRST_STAGES: usize = 3;

/// Heights above walls, relative to the square root of their area: the first is that of a regular tet on one
/// wall.
const HEIGHTS: [f64; 3] = [1.24, 0.62, 0.31];

impl Repair {
    /// Stage one of the paper: removes an edge or a facet of the tet.
    fn reconnect(&mut self, tet: TetId) {
        let vertices = self.complex.vertices(tet);
        for edge in EDGES.map(|e| e.map(|i| vertices[i])) {
            let bar = self.bar(tet);
            if self.surface.is_some() {
                self.shells[0].walk(&self.complex, tet, edge[0], edge[1]);
                if self.hold_on(edge) == Hold::Edge {
                    continue;
                }
            }
            if self.edge_removal.propose(&self.complex, tet, edge, bar, &mut self.candidate.proposal) {
                self.offer(Operation::EdgeRemoval);
            }
        }
        for facet in 0..4 {
            let bar = self.bar(tet);
            if self.face_removal.propose(&self.complex, tet, facet, bar, &mut self.candidate.proposal) {
                self.offer(Operation::FaceRemoval);
            }
        }
    }

    /// The constraint on a vertex that lies on the edge whose shell was walked last.
    pub(super) fn hold_on(&self, edge: [VertexId; 2]) -> Hold {
        let shell = &self.shells[0];
        match &self.surface {
            _ if self.complex.line(edge[0], edge[1]).is_some() => Hold::Edge,
            _ if shell.is_free() => Hold::Free,
            Some(surface) if surface.is_smooth(&self.complex, edge, shell) => Hold::Surface,
            _ => Hold::Edge,
        }
    }

    /// Stage two of the paper: the repair for the type of the tet.
    fn by_type(&mut self, tet: TetId) {
        let vertices = self.complex.vertices(tet);
        match classify(self.complex.corners(tet)) {
            Defect::CrossedEdges { edge } => {
                self.cross(tet, EDGES[edge].map(|i| vertices[i]), EDGES[5 - edge].map(|i| vertices[i]))
            }
            Defect::VertexAtEdge { vertex, edge } => {
                let [a, b] = EDGES[edge].map(|i| vertices[i]);
                self.shells[0].walk(&self.complex, tet, a, b);
                let bar = self.bar(tet);
                if split_onto(
                    &self.complex,
                    &self.shells[0],
                    vertices[vertex],
                    bar,
                    &mut self.candidate.proposal,
                ) {
                    self.offer(Operation::SplitOnto);
                }
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
        let [first, second] = &mut self.shells;
        first.walk(&self.complex, tet, a, b);
        second.walk(&self.complex, tet, c, d);
        let middle = [a, b, c, d].into_iter().fold([0.0; 3], |sum, v| add(sum, self.complex.point(v)));
        let bar = self.bar(tet);
        let [first, second] = &self.shells;
        if split_crossed(
            &self.complex,
            [first, second],
            scale(middle, 0.25),
            bar,
            &mut self.candidate.proposal,
        ) {
            self.offer(Operation::SplitCrossed);
        }
    }

    pub(super) fn collapse(&mut self, tet: TetId, removed: VertexId, kept: VertexId) {
        if !self.may_collapse(tet, removed, kept) {
            return;
        }
        self.star.gather(&self.complex, removed);
        let bar = self.bar(tet);
        if collapse(&self.complex, &self.star.tets, removed, kept, bar, &mut self.candidate.proposal) {
            self.offer(Operation::Collapse);
        }
    }

    /// Whether the constraint on vertex `removed` lets it be collapsed into `kept`: along the surface, or
    /// along a feature.
    pub(super) fn may_collapse(&mut self, tet: TetId, removed: VertexId, kept: VertexId) -> bool {
        let hold = self.complex.hold(removed);
        let Some(surface) = self.surface.as_ref().filter(|_| hold != Hold::Free && hold != Hold::Fixed)
        else {
            return hold == Hold::Free;
        };
        let shell = &mut self.shells[0];
        shell.walk(&self.complex, tet, removed, kept);
        let is_line = self.complex.line(removed, kept).is_some();
        let is_feature = |surface: &Surface| !surface.is_smooth(&self.complex, [removed, kept], shell);
        is_line || !shell.walls.is_empty() && (hold == Hold::Surface || is_feature(surface))
    }

    /// Moves the vertices of a tet: anywhere if free; along the surface and its features if these may change.
    fn smooth(&mut self, tet: TetId) {
        for vertex in self.complex.vertices(tet) {
            let hold = self.complex.hold(vertex);
            if hold == Hold::Fixed || hold != Hold::Free && self.surface.is_none() {
                continue;
            }
            self.star.gather(&self.complex, vertex);
            let track = match &self.surface {
                Some(surface) if hold != Hold::Free => {
                    surface.track(&self.complex, &self.star.tets, vertex, &mut self.shells[0])
                }
                _ => Some(SurfaceTrack::Anywhere),
            };
            let Some(track) = track else { continue };
            let limits = [self.bar(tet), self.target];
            let (complex, star) = (&self.complex, &self.star.tets);
            if self.smoothing.propose(complex, star, vertex, limits, &track, &mut self.candidate.proposal) {
                self.offer(Operation::Smoothing);
            }
        }
    }

    /// Splits the edges of a tet that lie on the surface or are lines.
    fn split_surface(&mut self, tet: TetId) {
        if self.surface.is_none() {
            return;
        }
        let vertices = self.complex.vertices(tet);
        for edge in EDGES.map(|e| e.map(|i| vertices[i])) {
            let [a, b] = edge;
            let bar = self.bar(tet);
            let shell = &mut self.shells[0];
            shell.walk(&self.complex, tet, a, b);
            let is_inside = shell.walls.is_empty() && self.complex.line(a, b).is_none();
            if is_inside || !self.complex.may_divide(a, b) {
                continue;
            }
            let hold = self.hold_on(edge);
            let shell = &self.shells[0];
            let middle = scale(add(self.complex.point(a), self.complex.point(b)), 0.5);
            if split_edge(&self.complex, shell, edge, (middle, hold), bar, &mut self.candidate.proposal) {
                self.offer(Operation::SplitEdge);
            }
        }
    }

    /// Collapses any edge of a tet, in either direction.
    fn collapse_any(&mut self, tet: TetId) {
        let vertices = self.complex.vertices(tet);
        for removed in vertices {
            for kept in vertices.into_iter().filter(|&v| v != removed) {
                self.collapse(tet, removed, kept);
            }
        }
    }

    /// Inserts a vertex at the centroid of a tet, at the midpoint of an edge, or at the centroid of a facet.
    fn insert(&mut self, tet: TetId) {
        self.split_surface(tet);
        let corners = self.complex.corners(tet);
        self.insert_at(tet, &[tet], centroid(corners));
        let vertices = self.complex.vertices(tet);
        for [i, j] in EDGES {
            self.shells[0].walk(&self.complex, tet, vertices[i], vertices[j]);
            let seed = std::mem::take(&mut self.shells[0].tets);
            self.insert_at(tet, &seed, scale(add(corners[i], corners[j]), 0.5));
            self.shells[0].tets = seed;
        }
        for (i, facet) in FACETS.into_iter().enumerate() {
            if let Behind::Tet(half) = self.complex.behind(tet, i) {
                let [a, b, c] = facet.map(|corner| corners[corner]);
                self.insert_at(tet, &[tet, half.tet()], scale(add(add(a, b), c), 1.0 / 3.0));
            }
        }
        self.insert_off_walls(tet);
    }

    /// Inserts a vertex above the walls of a tet, starting at the height of a regular tet: in a tet that lies
    /// flat on its walls, all the tet's own midpoints are too close to them.
    fn insert_off_walls(&mut self, tet: TetId) {
        let corners = self.complex.corners(tet);
        let (mut inwards, mut middle, mut area) = ([0.0; 3], [0.0; 3], 0.0);
        for facet in
            FACETS.into_iter().enumerate().filter_map(|(i, f)| self.complex.is_wall(tet, i).then_some(f))
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
        let limits = [self.bar(tet), self.target];
        if self.insertion.propose(&self.complex, seed, point, limits, &mut self.candidate.proposal) {
            self.offer(Operation::Insertion);
        }
    }
}
