//! The handle: a mesh that is refined and coarsened again and again.

use super::fixed_edges::{Neighborhood, ends_of_split_fixed_edges};
use super::forest::{
    Closed, Extracted, Forest, MAX_GENERATION, MAX_NODES, ShapeBounds, close, extract, in_forest,
};
use super::inverted::vertices_of_inverted;
use super::true_surface::{OnSurface, put_on_surface};
use crate::base::{Error, ForestVertexId, NodeId, Point, Result, TetId, Threads};
use crate::geometry::predicates::orient3d;
use crate::geometry::quality::eas;
use crate::mesh::TetMesh;
use crate::spatial::NearestTriangle;

/// Options of division.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// No part of a tet falls below this fraction of the worst EAS of the first mesh, and no root that is not
    /// bad gets bad parts, if there is another way. For pieces of cuts this bound is capped at 0.55 of the
    /// median EAS. Default: 0.95.
    pub keep: f64,
    /// Tets are not cut into pieces below this fraction of the EAS that dividing them into eight would leave.
    /// Far above 0.6 even regular tets may not be cut, and refinement spreads far. Default: 0.55.
    pub share: f64,
    /// The diagonal along which a tet is divided. Default: the shortest.
    pub rule: Rule,
}

/// How to choose the diagonal of the inner octahedron along which a tet is divided into eight.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rule {
    /// The shortest diagonal, unless its parts are too bad: then the one with the best parts over three
    /// generations.
    #[default]
    Shortest,
    /// By the order of vertices: any tet gives rise to at most three shapes, but worse ones (Bey 1995).
    Bey,
}

impl Default for Options {
    fn default() -> Self {
        Self { keep: 0.95, share: 0.55, rule: Rule::Shortest }
    }
}

/// The result of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Summary {
    /// Number of tets of the mesh.
    pub n_tets: usize,
    /// Number of tets divided into eight without being marked, so that all fit.
    pub n_promoted: usize,
    /// Number of tets cut to fit their neighbours.
    pub n_cut: usize,
    /// Number of marked tets left as they are because edges that are [fixed](TetMesh::fixed_edges) would have
    /// to be split; when coarsening, number of divisions kept because a tet would be inverted.
    pub n_held: usize,
    /// Number of sweeps over all tets.
    pub n_sweeps: usize,
}

/// A tet that is worse than the options allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Left {
    /// The tet, as numbered in the mesh.
    pub tet: TetId,
    /// The EAS of the tet in the reference.
    pub eas: f64,
    /// The tet of the first mesh that it lies in.
    pub root: TetId,
}

/// A mesh with its memory: the tets it started with, and which of them and of their parts are to be divided.
///
/// ```
/// use motet::base::{TetId, Threads, VertexId};
/// use motet::mesh::TetMesh;
/// use motet::refine::{Options, Refinement};
/// # fn main() -> motet::Result<()> {
/// let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
/// let mesh = TetMesh::new(points, vec![[0, 1, 2, 3].map(VertexId)]);
/// let threads = Threads::single();
/// let mut refinement = Refinement::new(&mesh, Options::default(), &threads)?;
/// refinement.refine(&[TetId(0)], &threads)?;
/// assert_eq!(refinement.mesh().tets.len(), 8);
/// let all: Vec<_> = (0..8).map(TetId).collect();
/// refinement.coarsen(&all, &threads)?;
/// assert_eq!(refinement.mesh(), &mesh);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Refinement {
    pub(super) first_mesh: TetMesh,
    pub(super) forest: Forest,
    pub(super) bounds: ShapeBounds,
    pub(super) now: Extracted,
    pub(super) summary: Summary,
    /// Whether points have moved away from the reference.
    pub(super) is_moved: bool,
}

impl Refinement {
    /// Starts with a mesh whose tets become roots.
    pub fn new(mesh: &TetMesh, options: Options, threads: &Threads) -> Result<Self> {
        mesh.validate()?;
        check_roots(mesh, threads)?;
        let roots: Vec<_> = mesh.tets.iter().map(|tet| (tet.map(in_forest), false)).collect();
        let forest = Forest::new(&mesh.points, &roots, threads);
        let bounds = ShapeBounds::new(options, &forest);
        let mut refinement = Self {
            first_mesh: mesh.clone(),
            forest,
            bounds,
            now: Extracted::of_first(mesh),
            summary: Summary::default(),
            is_moved: false,
        };
        let closed = close(&mut refinement.forest, bounds, threads)?;
        refinement.update_mesh(closed, threads)?;
        Ok(refinement)
    }

    /// The current mesh. While nothing is divided it is the first mesh, except for points that have moved.
    pub fn mesh(&self) -> &TetMesh {
        &self.now.mesh
    }

    /// The first mesh, with its points at their current positions.
    pub fn first(&self) -> TetMesh {
        let n = self.forest.n_first_vertices;
        let mut points = vec![[0.0; 3]; n];
        for (v, &point) in self.now.vertices.iter().zip(&self.now.mesh.points).filter(|(v, _)| v.index() < n)
        {
            points[v.index()] = point;
        }
        TetMesh { points, ..self.first_mesh.clone() }
    }

    /// Puts boundary points made by divisions on the true surface, if they are near it and their edges lie on
    /// it. No tet is inverted, and no good tet becomes bad. Shapes continue to be judged by the positions of
    /// the points before.
    pub fn put_on_surface(&mut self, surface: &NearestTriangle) -> OnSurface {
        let (points, done) = put_on_surface(&self.now, &self.forest, surface);
        self.set_positions(&points);
        done
    }

    /// Whether any tet of the first mesh is divided, or cut.
    pub fn is_divided(&self) -> bool {
        self.now.mesh.tets.len() != self.first_mesh.tets.len()
    }

    /// The generation of each tet: how many divisions into eight it lies within. Pieces of a cut tet count as
    /// that tet.
    pub fn generations(&self) -> impl Iterator<Item = u8> + '_ {
        self.now.nodes.iter().map(|node| self.forest.states[node.index()].generation)
    }

    /// For each tet, the tet of the first mesh that it lies in.
    pub fn roots(&self) -> impl Iterator<Item = TetId> + '_ {
        self.now.nodes.iter().map(|&node| self.forest.root(node))
    }

    /// The tets whose shape in the reference is worse than the options allow, because no better way of
    /// dividing or cutting them was found.
    pub fn left(&self, threads: &Threads) -> Vec<Left> {
        let shape =
            threads.map(self.now.nodes.len(), |i| match self.forest.mask(self.now.nodes[i]) {
                0 => {
                    let shape = self.forest.nodes[self.now.nodes[i].index()].shape;
                    self.forest.classes[shape.class().index()].eas
                }
                _ => eas(self.now.mesh.tets[i]
                    .map(|v| self.forest.reference[self.now.vertices[v.index()].index()]))
                .abs(),
            });
        let floor = |i: u32| {
            let class = self.forest.nodes[self.now.nodes[i as usize].index()].shape.class();
            self.bounds.floor(self.forest.classes[class.index()].root_eas)
        };
        let bad = (0..).zip(shape).filter(|&(i, eas)| eas < floor(i));
        bad.map(|(i, eas): (u32, f64)| Left {
            tet: TetId(i),
            eas,
            root: self.forest.root(self.now.nodes[i as usize]),
        })
        .collect()
    }

    /// The result of the last step.
    pub fn summary(&self) -> Summary {
        self.summary
    }

    /// The size in bytes of the memory kept beside the mesh.
    pub fn memory(&self) -> usize {
        self.forest.memory() + size_of_val(&self.now.nodes[..])
    }

    /// Takes over points that moved. Shapes continue to be judged in the reference.
    ///
    /// # Errors
    /// When the number of points differs from that of the mesh.
    pub fn set_points(&mut self, points: &[Point]) -> Result<()> {
        let expected = self.now.mesh.points.len();
        if points.len() != expected {
            return Err(Error::input(format!("{} points, expected {expected}", points.len()))
                .remedy("give all points in the order of the mesh"));
        }
        self.set_positions(points);
        Ok(())
    }

    fn set_positions(&mut self, points: &[Point]) {
        self.is_moved = true;
        self.now.mesh.points.copy_from_slice(points);
    }

    /// Divides the marked tets into eight, once; a piece of a cut tet stands for the whole. Where that would
    /// split [fixed](TetMesh::fixed_edges) edges, tets near these are left as they are.
    ///
    /// # Errors
    /// When a marked tet does not exist, when one has already been divided twenty times over, or when ids
    /// would not suffice; then nothing has changed.
    pub fn refine(&mut self, marked: &[TetId], threads: &Threads) -> Result<Summary> {
        self.refine_from(marked, threads)?;
        Ok(self.summary)
    }

    /// Divides as [`refine`](Self::refine) does, and returns the state before.
    pub(super) fn refine_from(&mut self, marked: &[TetId], threads: &Threads) -> Result<Before> {
        self.check(marked)?;
        let is_deepest = |tet: &&TetId| {
            self.forest.states[self.now.nodes[tet.index()].index()].generation >= MAX_GENERATION
        };
        if let Some(tet) = marked.iter().find(is_deepest) {
            return Err(Error::options(format!(
                "tet {tet} has already been divided {MAX_GENERATION} times, the maximum"
            )));
        }
        self.or_restore(threads, |this, before| this.divide_all(marked, before, threads))
    }

    fn divide_all(&mut self, marked: &[TetId], before: &[bool], threads: &Threads) -> Result<Extracted> {
        let mut left = marked.to_vec();
        let mut neighborhood = Neighborhood::default();
        loop {
            self.request(&left);
            let closed = close(&mut self.forest, self.bounds, threads)?;
            let split = ends_of_split_fixed_edges(&self.forest, &self.first_mesh);
            if split.is_empty() {
                let was = self.update_mesh(closed, threads)?;
                self.summary.n_held = marked.len() - left.len();
                return Ok(was);
            }
            if left.is_empty() {
                return Err(Error::input("a fixed edge is already split before anything is divided"));
            }
            self.restore_requests(before);
            neighborhood.remove_marks(&self.forest, &self.now, &split, &mut left);
        }
    }

    /// Requests the division of the marked tets, and so of all tets they lie in.
    fn request(&mut self, marked: &[TetId]) {
        for tet in marked {
            let mut next = Some(self.now.nodes[tet.index()]);
            while let Some(node) = next.filter(|node| !self.forest.states[node.index()].is_requested) {
                self.forest.states[node.index()].is_requested = true;
                next = self.forest.parent(node);
            }
        }
    }

    /// Takes back divisions all of whose tets are marked and none of whose parts was requested to be divided
    /// again. A division stays if neighbours need it, or if the whole tet would be inverted at the current
    /// positions of its vertices.
    ///
    /// # Errors
    /// When a marked tet does not exist; then nothing has changed.
    pub fn coarsen(&mut self, marked: &[TetId], threads: &Threads) -> Result<Summary> {
        self.coarsen_from(marked, threads)?;
        Ok(self.summary)
    }

    /// Takes divisions back as [`coarsen`](Self::coarsen) does, and returns the state before.
    pub(super) fn coarsen_from(&mut self, marked: &[TetId], threads: &Threads) -> Result<Before> {
        self.check(marked)?;
        self.or_restore(threads, |this, before| {
            this.withdraw_requests(marked, before);
            this.keep_from_inverting(before, threads)
        })
    }

    /// Withdraws the requests for divisions all of whose tets are marked, unless a part was requested to be
    /// divided again.
    fn withdraw_requests(&mut self, marked: &[TetId], before: &[bool]) {
        let mut is_marked = vec![false; self.now.nodes.len()];
        marked.iter().for_each(|tet| is_marked[tet.index()] = true);
        let Forest { nodes, states, .. } = &mut self.forest;
        // For each tet of the forest, whether all tets within it are marked. Parts come after the whole.
        let mut is_whole = vec![true; nodes.len()];
        for (node, is_marked) in self.now.nodes.iter().zip(is_marked) {
            is_whole[node.index()] &= is_marked;
        }
        let parts = |node: usize| nodes[node].first_child.get().map(|first| first.index()..first.index() + 8);
        for node in (0..nodes.len()).rev().filter(|&node| states[node].is_divided) {
            let Some(parts) = parts(node) else { continue };
            is_whole[node] = is_whole[parts].iter().all(|&child| child);
        }
        for node in (0..nodes.len()).filter(|&node| is_whole[node] && before[node]) {
            let Some(parts) = parts(node) else { continue };
            states[node].is_requested = before[parts].iter().any(|&child| child);
        }
    }

    /// Builds the mesh of what is requested, restoring divisions where the whole tet would be inverted at the
    /// current positions.
    fn keep_from_inverting(&mut self, before: &[bool], threads: &Threads) -> Result<Extracted> {
        let inverted =
            |this: &Self, out: &Extracted| vertices_of_inverted(&this.forest, &this.first_mesh, out, threads);
        let known = if self.is_moved { inverted(self, &self.now) } else { Vec::new() };
        let mut n_held = 0;
        loop {
            let closed = close(&mut self.forest, self.bounds, threads)?;
            let now = extract(&self.forest, &self.first_mesh, &closed.cuts, &self.now, threads)?;
            let mut new = if self.is_moved { inverted(self, &now) } else { Vec::new() };
            new.retain(|v| known.binary_search(v).is_err());
            if new.is_empty() {
                let was = self.accept(closed, now);
                self.summary.n_held = n_held;
                return Ok(was);
            }
            let taken_back: Vec<NodeId> = (0..before.len())
                .filter(|&n| before[n] && !self.forest.states[n].is_requested)
                .map(NodeId::new)
                .collect();
            let is_new = |v: ForestVertexId| new.binary_search(&v).is_ok();
            let at = |&node: &NodeId| self.forest.local(node).iter().any(|v| v.get().is_some_and(is_new));
            let near: Vec<NodeId> = taken_back.iter().copied().filter(at).collect();
            let restored = if near.is_empty() { taken_back } else { near };
            if restored.is_empty() {
                return Ok(self.accept(closed, now));
            }
            n_held += restored.len();
            for node in restored {
                let mut next = Some(node);
                while let Some(node) = next {
                    self.forest.states[node.index()].is_requested = true;
                    next = self.forest.parent(node);
                }
            }
        }
    }

    fn check(&self, marked: &[TetId]) -> Result<()> {
        let n = self.now.mesh.tets.len();
        match marked.iter().find(|tet| tet.index() >= n) {
            None => Ok(()),
            Some(tet) => Err(Error::input(format!("tet {tet} is marked, but the mesh has only {n} tets"))),
        }
    }

    /// Restores the requests for division of an earlier state.
    fn restore_requests(&mut self, before: &[bool]) {
        let before = before.iter().chain(std::iter::repeat(&false));
        self.forest
            .states
            .iter_mut()
            .zip(before)
            .for_each(|(state, &is_requested)| state.is_requested = is_requested);
    }

    /// Runs a step, given the requests before it, which returns the mesh before; if it fails, restores the
    /// requests.
    fn or_restore(
        &mut self,
        threads: &Threads,
        step: impl FnOnce(&mut Self, &[bool]) -> Result<Extracted>,
    ) -> Result<Before> {
        let summary = self.summary;
        let requested: Vec<bool> = self.forest.states.iter().map(|state| state.is_requested).collect();
        match step(self, &requested) {
            Ok(was) => Ok(Before { was, requested, summary }),
            Err(error) => {
                self.restore_requests(&requested);
                let closed = close(&mut self.forest, self.bounds, threads)?;
                self.update_mesh(closed, threads)?;
                Err(error)
            }
        }
    }

    /// Returns to the state before a step.
    pub(super) fn undo(&mut self, before: Before, threads: &Threads) -> Result<()> {
        self.restore_requests(&before.requested);
        close(&mut self.forest, self.bounds, threads)?;
        (self.now, self.summary) = (before.was, before.summary);
        Ok(())
    }

    /// Returns the mesh before.
    fn update_mesh(&mut self, closed: Closed, threads: &Threads) -> Result<Extracted> {
        let now = extract(&self.forest, &self.first_mesh, &closed.cuts, &self.now, threads)?;
        Ok(self.accept(closed, now))
    }

    fn accept(&mut self, closed: Closed, now: Extracted) -> Extracted {
        self.summary = Summary {
            n_tets: now.mesh.tets.len(),
            n_promoted: closed.n_promoted,
            n_cut: closed.cuts.len(),
            n_held: 0,
            n_sweeps: closed.n_sweeps,
        };
        std::mem::replace(&mut self.now, now)
    }
}

/// The state before a step.
pub(super) struct Before {
    pub(super) was: Extracted,
    /// Whether the division of each tet of the forest was requested.
    requested: Vec<bool>,
    summary: Summary,
}

/// Rejects tets without volume, and more tets than a forest may have.
pub(super) fn check_roots(mesh: &TetMesh, threads: &Threads) -> Result<()> {
    if mesh.tets.len() > MAX_NODES {
        return Err(Error::input(format!(
            "{} tets exceed the maximum for refinement, {MAX_NODES}",
            mesh.tets.len()
        )));
    }
    let is_flat = threads.map(mesh.tets.len(), |i| {
        let [a, b, c, d] = mesh.tets[i].map(|v| mesh.points[v.index()]);
        orient3d(a, b, c, d) == 0
    });
    match is_flat.into_iter().position(|is_flat| is_flat) {
        None => Ok(()),
        Some(i) => Err(Error::input("has no volume")
            .at(format!("tet {i}"))
            .remedy("`motet remesh` repairs such tets")),
    }
}
