//! The nodes: vertices that something other than the graph moves: the caller, a wall, or a rim.

use std::collections::HashSet;

use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::vector::{add, sub};
use crate::mesh::{Boundary, Mesh};
use crate::motion::layer::Layer;
use crate::motion::options::{FacetSet, Options, RigidLayer};
use crate::motion::slide::{LeavesPlane, Rim, Slide, SlidingConstraints, SlidingPlane, key, worst_departure};
use crate::motion::update::{Displacements, Padded};

/// All nodes of a mesh, and what moves them.
#[derive(Debug, Default)]
pub(crate) struct Nodes {
    /// The vertex of each node: driven ones first, then those of the layer.
    pub(crate) vertices: Vec<VertexId>,
    pub(crate) n_driven: usize,
    /// Nodes that the graph is made of: driven ones, and the outer ones of the layer.
    pub(crate) of_graph: Vec<u32>,
    /// The nodes of those of its members that do not slide come after the driven ones, in its order.
    layer: Option<Layer>,
    /// The node of each member that slides, and the index into `slides`.
    sliding_members: Vec<(u32, u32)>,
    slides: Vec<Slide>,
    /// How the vertices of sliding patches are constrained.
    constraints: SlidingConstraints,
    /// The planes of sliding patches, as they are reported.
    pub(crate) planes: Vec<SlidingPlane>,
    rims: Vec<Rim>,
}

/// Where a motion in sub-steps has brought the nodes, and what the sliding ones follow from there on.
#[derive(Debug)]
pub(crate) struct SubstepStart {
    /// Displacements of all nodes from the reference, and that of the node that never moves.
    pub(crate) displacement: Vec<Padded>,
    slides: Vec<Slide>,
}

/// Marks a vertex that is no node.
const NONE: u32 = u32::MAX;

/// Nodes of the layer per part of the work of a thread.
const LAYER_PART: usize = 2048;

/// Nodes of the layer whose feet are moved before their offsets rotate: they are still in the nearest cache.
const LAYER_CHUNK: usize = 256;

impl Nodes {
    pub(crate) fn new(
        mesh: &Mesh,
        boundary: &Boundary,
        options: &Options,
        is_used: &[bool],
        threads: &Threads,
    ) -> Result<Self> {
        let mut vertices: Vec<VertexId> =
            boundary.vertices.iter().chain(&options.also_moved).copied().collect();
        vertices.sort_unstable();
        vertices.dedup();
        let n_driven = vertices.len();
        let mut nodes =
            Self { n_driven, vertices, of_graph: (0..n_driven as u32).collect(), ..Self::default() };
        if options.rigid_layer.is_none() && options.sliding.is_empty() {
            return Ok(nodes);
        }
        let mut node_of = vec![NONE; mesh.points.len()];
        (0..).zip(&nodes.vertices).for_each(|(i, v)| node_of[v.index()] = i);
        let mut driven = options.also_moved.clone();
        driven.sort_unstable();
        let constraints = SlidingConstraints::new(
            &mesh.points,
            &options.sliding,
            boundary,
            &driven,
            options.slide_tolerance.0,
        )?;
        let slide_of = constraints.constraint_of(mesh.points.len());
        if let Some(rigid) = &options.rigid_layer {
            let all = rigid.wall.is_none().then(|| not_sliding(boundary, &options.sliding));
            let wall = rigid.wall.as_ref().or(all.as_ref()).expect("one of the two is there");
            nodes.add_layer(mesh, rigid, wall, is_used, &node_of, &slide_of)?;
        }
        nodes.planes = constraints.planes();
        nodes.rims = constraints.rims(&mesh.points, |v| node_of[v.index()]);
        nodes.slides = nodes.slides_at(&constraints, &mesh.points, threads)?;
        nodes.constraints = constraints;
        Ok(nodes)
    }

    /// The vertices of the graph's nodes.
    pub(crate) fn graph_vertices(&self) -> Vec<VertexId> {
        self.of_graph.iter().map(|&n| self.vertices[n as usize]).collect()
    }

    /// What the sliding vertices follow, with all vertices at `points`; those of the layer follow their feet
    /// instead.
    fn slides_at(
        &self,
        constraints: &SlidingConstraints,
        points: &[Point],
        threads: &Threads,
    ) -> Result<Vec<Slide>> {
        let mut node_of = vec![NONE; points.len()];
        (0..).zip(&self.vertices[..self.n_driven]).for_each(|(i, v)| node_of[v.index()] = i);
        let mut in_layer = vec![false; points.len()];
        self.layer.iter().flat_map(|l| &l.members).for_each(|m| in_layer[m.vertex.index()] = true);
        let follows = |v: VertexId| !in_layer[v.index()];
        let node = |v: VertexId| node_of[v.index()];
        let slide =
            |constraint| Slide::new(points, &constraints.patch_planes, constraint, follows, node, threads);
        constraints.constraints.iter().map(slide).collect()
    }

    /// The start of a sub-step with the vertices at `points`, reached by the displacements `driven` of the
    /// driven nodes.
    ///
    /// # Errors
    /// When the vertices of a sliding patch cannot be triangulated there.
    pub(crate) fn start(
        &self,
        reference: &[Point],
        points: &[Point],
        driven: &[Point],
        threads: &Threads,
    ) -> Result<SubstepStart> {
        let mut displacement = self.displacements(driven, threads).table().into_owned();
        for &node in self.slides.iter().flat_map(|slide| &slide.sliding) {
            let v = self.vertices[node as usize].index();
            displacement[node as usize] = Padded::new(sub(points[v], reference[v]));
        }
        let slides = match self.slides.is_empty() {
            true => Vec::new(),
            false => self.slides_at(&self.constraints.refitted(points)?, points, threads)?,
        };
        Ok(SubstepStart { displacement, slides })
    }

    /// Makes nodes of the vertices near the wall that are not driven; sliding vertices, which are driven in
    /// name only, move with the wall as well.
    fn add_layer(
        &mut self,
        mesh: &Mesh,
        rigid: &RigidLayer,
        wall: &FacetSet,
        is_used: &[bool],
        node_of: &[u32],
        slide_of: &[Option<u32>],
    ) -> Result<()> {
        let is_driven = |v: VertexId| node_of[v.index()] != NONE;
        let can_join = |v: &VertexId| slide_of[v.index()].is_some() || (is_used[v.index()] && !is_driven(*v));
        let candidates: Vec<VertexId> = (0..mesh.points.len()).map(VertexId::new).filter(can_join).collect();
        let driven = &self.vertices[..self.n_driven];
        let slides = |v: VertexId| slide_of[v.index()].is_some();
        let layer = Layer::new(&mesh.points, &mesh.cells, wall, rigid.extent, &candidates, driven, slides)?;
        let is_outer = layer.outer(&mesh.cells, is_driven, mesh.points.len());
        for (member, is_outer) in layer.members.iter().zip(is_outer) {
            match slide_of[member.vertex.index()] {
                Some(slide) => self.sliding_members.push((node_of[member.vertex.index()], slide)),
                None => {
                    self.of_graph.extend(is_outer.then_some(self.vertices.len() as u32));
                    self.vertices.push(member.vertex);
                }
            }
        }
        self.layer = Some(layer);
        Ok(())
    }

    /// Displacements of all nodes, given those of the driven ones.
    pub(crate) fn displacements<'a>(&self, driven: &'a [Point], threads: &Threads) -> Displacements<'a> {
        if self.layer.is_none() && self.slides.is_empty() {
            return Displacements::Driven(driven);
        }
        let mut all = self.before_sliding(driven, threads);
        self.slides.iter().for_each(|slide| slide.apply(|_| [0.0; 3], &mut all));
        Displacements::All(all)
    }

    /// Displacements of all nodes from the reference, given those of the driven ones, when the motion
    /// continues from `start`.
    pub(crate) fn displacements_from(
        &self,
        start: &SubstepStart,
        driven: &[Point],
        threads: &Threads,
    ) -> Vec<Padded> {
        let mut all = self.before_sliding(driven, threads);
        start
            .slides
            .iter()
            .for_each(|slide| slide.apply(|node| start.displacement[node as usize].point(), &mut all));
        all
    }

    /// Displacements before sliding: of driven nodes as they are given, and of those of the layer.
    fn before_sliding(&self, driven: &[Point], threads: &Threads) -> Vec<Padded> {
        let mut all = Vec::with_capacity(self.vertices.len() + 1);
        all.extend(driven.iter().map(|&d| Padded::new(d)));
        all.resize(self.vertices.len() + 1, Padded::default());
        let Some(layer) = &self.layer else { return all };
        let (driven, held) = all.split_at_mut(self.n_driven);
        let n_held = self.vertices.len() - self.n_driven;
        let rotations = layer.rotations(driven, threads);
        threads.fill(
            &mut held[..n_held],
            LAYER_PART,
            || (),
            |(), first, held| {
                for (i, held) in held.chunks_mut(LAYER_CHUNK).enumerate() {
                    let first = first + i * LAYER_CHUNK;
                    layer.feet(driven, first, held);
                    layer.rotate_offsets(&rotations, first, held);
                }
            },
        );
        let mut feet = vec![Padded::default(); self.sliding_members.len()];
        let mut changes = feet.clone();
        layer.feet(driven, n_held, &mut feet);
        layer.rotate_offsets(&rotations, n_held, &mut changes);
        for (&(node, slide), (foot, change)) in self.sliding_members.iter().zip(feet.iter().zip(&changes)) {
            let change = change.point();
            let within = sub(change, self.slides[slide as usize].normal_component(change));
            all[node as usize] = Padded::new(add(foot.point(), within));
        }
        all
    }

    /// Where a rim of a sliding patch leaves its plane farthest, given the displacements of the driven nodes.
    pub(crate) fn worst_departure(&self, reference: &[Point], driven: &[Point]) -> Option<LeavesPlane> {
        worst_departure(&self.rims, &self.vertices, reference, driven)
    }

    /// Nodes that slide by following others, in rising order; those of the layer are not among them.
    pub(crate) fn sliding(&self) -> Vec<u32> {
        let mut sliding: Vec<u32> = self.slides.iter().flat_map(|s| s.sliding.iter().copied()).collect();
        sliding.sort_unstable();
        sliding
    }

    /// Whether the caller prescribes the position of each vertex of a mesh: it is driven and does not slide.
    pub(crate) fn prescribed(&self, n_points: usize) -> Vec<bool> {
        let mut is_prescribed = vec![false; n_points];
        self.vertices[..self.n_driven].iter().for_each(|v| is_prescribed[v.index()] = true);
        let members = self.sliding_members.iter().map(|(node, _)| node);
        let sliding = self.slides.iter().flat_map(|slide| &slide.sliding).chain(members);
        sliding.for_each(|&node| is_prescribed[self.vertices[node as usize].index()] = false);
        is_prescribed
    }

    /// Values at all nodes, given those at the driven ones: nodes of the layer have the values at their feet.
    pub(crate) fn extended_to_layer(&self, driven: &[Point]) -> Vec<Point> {
        let mut all = driven.to_vec();
        all.resize(self.vertices.len(), [0.0; 3]);
        if let Some(layer) = &self.layer {
            let held = (self.n_driven as u32..).take(self.vertices.len() - self.n_driven);
            let nodes = held.chain(self.sliding_members.iter().map(|(node, _)| *node));
            nodes.zip(layer.at_feet(driven)).for_each(|(node, value)| all[node as usize] = value);
        }
        all
    }

    pub(crate) fn n_sliding(&self) -> usize {
        self.sliding_members.len() + self.slides.iter().map(Slide::n_sliding).sum::<usize>()
    }

    /// Puts every node exactly where its displacement takes it.
    pub(crate) fn place(&self, reference: &[Point], displacement: &[Padded], out: &mut [Point]) {
        for (v, &d) in self.vertices.iter().zip(displacement) {
            out[v.index()] = add(reference[v.index()], d.point());
        }
    }
}

/// The boundary without the facets of sliding patches.
pub(crate) fn not_sliding(boundary: &Boundary, sliding: &[FacetSet]) -> FacetSet {
    let keys: HashSet<_> = sliding.iter().flat_map(|s| s.rings.iter().map(key)).collect();
    let rings = FacetSet::of_boundary(boundary, "", |_| true).rings;
    FacetSet::of_boundary(boundary, "boundary", |i| !keys.contains(&key(rings.list(i))))
}
