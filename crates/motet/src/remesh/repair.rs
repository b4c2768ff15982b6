//! The repair of one bad tet after another, worst first.

mod lengths;
mod sizing;

pub(super) use sizing::Sizing;

use crate::base::{Point, TetId, VertexId};
use crate::geometry::tet::{EDGES, FACETS, centroid};
use crate::geometry::vector::{add, scale};
use crate::kernel::{Behind, Complex, Hold, Shell, Star};
use crate::ops::{
    EdgeRemoval, FaceRemoval, Insertion, Smoothing, collapse, split_crossed, split_edge, split_onto,
};
use crate::remesh::candidate::Candidate;
use crate::remesh::classify::{Defect, classify};
use crate::remesh::left::forced;
use crate::remesh::options::SurfaceRule;
use crate::remesh::report::{Counts, Operation};
use crate::remesh::surface::{Crease, Surface, SurfaceTrack};

/// How much more than of bad tets is asked of those round the ones that nothing helps, time after time.
const WIDER: [f64; 3] = [0.1, 0.15, 0.2];

/// The targets of [`Repair::best`].
const BEST: [f64; 4] = [0.25, 0.3, 0.35, 0.4];

/// What is tried for a tet, one after the other until it is no longer bad.
const STAGES: [fn(&mut Repair, TetId); 6] = [
    Repair::reconnect,
    Repair::by_type,
    Repair::by_length,
    Repair::smooth,
    Repair::collapse_any,
    Repair::insert,
];
/// How many of them the first round tries. Each round that leaves bad tets tries one more: many of those that seem to need a vertex
/// inserted no longer do once their neighbours are repaired.
const FIRST_STAGES: usize = 3;

/// What is made of the bad tets that the first rounds leave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pass {
    /// The rounds once more.
    Again,
    /// What nothing helps is divided.
    Divide,
    /// Both, with no feature where walls meet at less than this angle.
    Soften(Crease),
}

/// The passes in which the surface may change as a rule says: one after the other as long as bad tets are left.
pub(super) fn passes(surface: SurfaceRule) -> &'static [Pass] {
    const ALL: [Pass; 5] =
        [Pass::Again, Pass::Divide, Pass::Soften(Crease::BLUNT), Pass::Divide, Pass::Soften(Crease::NONE)];
    match surface {
        SurfaceRule::Keep => &ALL[..1],
        SurfaceRule::Adapt { .. } => &ALL[..4],
        SurfaceRule::Loose { .. } => &ALL,
    }
}

/// What is repaired, and the room that it takes.
pub(super) struct Repair {
    pub(super) complex: Complex,
    pub(super) operations: Counts,
    pub(super) surface: Option<Surface>,
    /// Where sizes are asked for.
    pub(super) sizing: Option<Sizing>,
    pub(super) target: f64,
    n_stages: usize,
    pub(super) candidate: Candidate,
    edge_removal: EdgeRemoval,
    face_removal: FaceRemoval,
    smoothing: Smoothing,
    insertion: Insertion,
    pub(super) star: Star,
    pub(super) shells: [Shell; 2],
    /// Tets that came and are bad.
    pub(super) came_bad: Vec<TetId>,
}

impl Repair {
    pub(super) fn new(complex: Complex, surface: Option<Surface>, target: f64) -> Self {
        Self {
            complex,
            operations: Counts::default(),
            surface,
            sizing: None,
            target,
            n_stages: FIRST_STAGES,
            candidate: Candidate::default(),
            edge_removal: EdgeRemoval::default(),
            face_removal: FaceRemoval::default(),
            smoothing: Smoothing::default(),
            insertion: Insertion::default(),
            star: Star::default(),
            shells: Default::default(),
            came_bad: Vec::new(),
        }
    }

    /// Repairs the bad tets, round after round, as long as that gets on; those that are left.
    ///
    /// Where it does not get on, what lies round those that are left is made better first: a change that would repair one
    /// is often held up by a neighbour that is hardly better.
    pub(super) fn run(&mut self, mut bad: Vec<TetId>, rounds: usize) -> Vec<TetId> {
        let mut asked = WIDER.iter();
        for _ in 0..rounds {
            let is_on = self.round(&mut bad);
            if bad.is_empty() {
                break;
            }
            if self.n_stages < STAGES.len() {
                self.n_stages += 1;
                continue;
            }
            if is_on {
                continue;
            }
            let Some(more) = asked.next() else { break };
            self.improve_around(&bad, self.target + more);
        }
        bad.append(&mut self.came_bad);
        bad.retain(|&t| self.is_bad(t));
        self.sort(&mut bad);
        bad
    }

    /// Makes one pass over the bad tets that are left; those that are left then.
    pub(super) fn pass(&mut self, pass: Pass, left: Vec<TetId>, rounds: usize) -> Vec<TetId> {
        if let (Some(surface), Pass::Soften(crease)) = (&mut self.surface, pass) {
            surface.hold_features(&mut self.complex, crease);
        }
        let left = if pass == Pass::Divide { left } else { self.run(left, rounds) };
        if pass == Pass::Again { left } else { self.divide(left, rounds) }
    }

    /// Makes a pass over what is left while tets that are as good as the walls at them allow count as good: these can get no better, and
    /// would hold up what lies beside them. What is left then, these included.
    pub(super) fn beside_forced(
        &mut self,
        left: &[TetId],
        pass: impl Fn(&mut Self, Vec<TetId>) -> Vec<TetId>,
    ) -> Vec<TetId> {
        let forced = forced(&self.complex, self.surface.as_ref(), left);
        if forced.is_empty() {
            return pass(self, left.to_vec());
        }
        self.complex.spare(forced);
        pass(self, left.to_vec());
        self.complex.spare(Vec::new());
        self.below(self.target)
    }

    /// Makes the worst tets as good as they get: the target rises until it is out of reach everywhere.
    pub(super) fn best(&mut self, rounds: usize) {
        for target in BEST {
            self.target = target.max(self.target);
            self.n_stages = FIRST_STAGES;
            let bad = self.below(self.target);
            self.run(bad, rounds);
        }
    }

    /// Repairs each bad tet once, and leaves in the list those that are bad then; whether anything was done.
    fn round(&mut self, bad: &mut Vec<TetId>) -> bool {
        bad.retain(|&t| self.is_bad(t));
        self.sort(bad);
        let mut is_on = false;
        for &tet in bad.iter() {
            if self.is_bad(tet) {
                is_on |= self.repair(tet);
            }
        }
        bad.append(&mut self.came_bad);
        bad.retain(|&t| self.is_bad(t));
        is_on
    }

    /// Improves the tets that share a vertex with a bad one, up to a higher target.
    fn improve_around(&mut self, bad: &[TetId], target: f64) {
        let mut around = Vec::new();
        for &tet in bad {
            for vertex in self.complex.vertices(tet) {
                self.star.gather(&self.complex, vertex);
                around.extend_from_slice(&self.star.tets);
            }
        }
        let usual = std::mem::replace(&mut self.target, target);
        around.retain(|&t| self.is_bad(t));
        self.round(&mut around);
        self.target = usual;
        around.retain(|&t| self.is_bad(t));
        self.came_bad.append(&mut around);
    }

    fn sort(&self, bad: &mut Vec<TetId>) {
        bad.sort_unstable_by(|&a, &b| {
            self.complex.quality(a).total_cmp(&self.complex.quality(b)).then(a.cmp(&b))
        });
        bad.dedup();
    }

    /// The tets below a quality that may be changed, worst first.
    pub(super) fn below(&self, quality: f64) -> Vec<TetId> {
        let mut below = self.complex.below(quality);
        below.retain(|&t| !self.complex.is_locked(t));
        self.sort(&mut below);
        below
    }

    pub(super) fn is_bad(&self, tet: TetId) -> bool {
        self.complex.is_alive(tet) && !self.complex.is_locked(tet) && self.complex.quality(tet) < self.target
    }

    /// Makes the best change for one bad tet; whether there was one.
    fn repair(&mut self, tet: TetId) -> bool {
        self.candidate.begin();
        for stage in &STAGES[..self.n_stages] {
            stage(self, tet);
            if self.candidate.reaches(self.target) {
                break;
            }
        }
        let Some((operation, came)) = self.candidate.commit(&mut self.complex) else { return false };
        self.operations.add(operation);
        let (complex, target) = (&self.complex, self.target);
        self.came_bad.extend(came.iter().copied().filter(|&t| complex.quality(t) < target));
        true
    }

    fn bar(&self, tet: TetId) -> f64 {
        self.candidate.bar(self.complex.quality(tet), self.target)
    }

    fn offer(&mut self, operation: Operation) {
        if let Some(sizing) = &mut self.sizing
            && !sizing.field.accepts(&self.complex, &self.candidate.proposal)
        {
            return;
        }
        self.candidate.offer(&self.complex, self.surface.as_ref(), operation, self.target);
    }

    /// Stage one of the paper: its edges removed, and its facets.
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

    /// What holds a vertex on the edge whose shell was walked last.
    pub(super) fn hold_on(&self, edge: [VertexId; 2]) -> Hold {
        let shell = &self.shells[0];
        match &self.surface {
            _ if shell.is_free() => Hold::Free,
            Some(surface) if surface.is_smooth(&self.complex, edge, shell) => Hold::Surface,
            _ => Hold::Edge,
        }
    }

    /// Stage two of the paper: as its type asks.
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

    fn collapse(&mut self, tet: TetId, gone: VertexId, kept: VertexId) {
        if !self.may_go(tet, gone, kept) {
            return;
        }
        self.star.gather(&self.complex, gone);
        let bar = self.bar(tet);
        if collapse(&self.complex, &self.star.tets, gone, kept, bar, &mut self.candidate.proposal) {
            self.offer(Operation::Collapse);
        }
    }

    /// Whether what holds a vertex lets it be drawn into another: along the surface, along a feature.
    pub(super) fn may_go(&mut self, tet: TetId, gone: VertexId, kept: VertexId) -> bool {
        let hold = self.complex.hold(gone);
        let Some(surface) = self.surface.as_ref().filter(|_| hold != Hold::Free && hold != Hold::Fixed)
        else {
            return hold == Hold::Free;
        };
        let shell = &mut self.shells[0];
        shell.walk(&self.complex, tet, gone, kept);
        !shell.walls.is_empty()
            && (hold == Hold::Surface || !surface.is_smooth(&self.complex, [gone, kept], shell))
    }

    /// Its vertices moved: anywhere, or where the surface may change along the surface and along features.
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

    /// Its edges on the surface split.
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
            if shell.walls.is_empty() || self.complex.is_fixed_edge(a, b) {
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

    /// Its edges collapsed, either way.
    fn collapse_any(&mut self, tet: TetId) {
        let vertices = self.complex.vertices(tet);
        for gone in vertices {
            for kept in vertices.into_iter().filter(|&v| v != gone) {
                self.collapse(tet, gone, kept);
            }
        }
    }

    /// A vertex put into its middle, into the middle of its edges, of its facets.
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
    }

    fn insert_at(&mut self, tet: TetId, seed: &[TetId], point: Point) {
        let limits = [self.bar(tet), self.target];
        if self.insertion.propose(&self.complex, seed, point, limits, &mut self.candidate.proposal) {
            self.offer(Operation::Insertion);
        }
    }
}
