//! Rebuilds the forest from a stored memory.

use super::super::forest::{Extracted, Forest, ShapeBounds, close, extract, in_forest};
use super::super::refinement::{Options, Refinement, Summary, check_roots};
use super::trees::{TreeNodeId, Trees};
use super::triangles::Gathered;
use super::{Memory, dissolve, lines, triangles, unfit};
use crate::base::{
    EdgeId, ForestVertexId, LineId, MaybeId, NodeId, Point, Result, TetId, Threads, TriangleId, VertexId,
};
use crate::geometry::quality::eas;
use crate::mesh::TetMesh;

impl Refinement {
    /// Continues with a mesh that was refined before, from the [memory](Self::memory_to_keep) kept with it.
    /// The mesh may have moved since, and others may have changed tets and vertices; tets with unknown
    /// [roots](Memory::roots) are theirs. In that case shapes are judged as the mesh is now, and cuts that
    /// fit tets to their neighbours may change as soon as anything is divided or taken back.
    ///
    /// # Errors
    /// The errors of [`new`](Self::new), and when the memory belongs to another mesh.
    pub fn recall(mesh: &TetMesh, memory: &Memory, options: Options, threads: &Threads) -> Result<Self> {
        mesh.validate()?;
        memory.check(mesh)?;
        let mut trees = Trees::gather(mesh, memory, threads);
        let is_changed = trees.node_of.contains(&MaybeId::NONE);
        let reference = if is_changed { &mesh.points } else { &memory.reference };
        if is_changed {
            let shape = |t: usize| eas(mesh.tets[t].map(|v| mesh.points[v.index()])).abs();
            let worst = threads.map(mesh.tets.len(), shape).into_iter().fold(f64::INFINITY, f64::min);
            dissolve::misshapen(&mut trees, &memory.reference, reference, worst);
        }
        dissolve::bridged(&mut trees, mesh);
        dissolve::unmatched(&mut trees, mesh);
        let roots = Roots::of(mesh, memory, &trees)?;
        let is_changed = is_changed || roots.n_dissolved > 0;
        let recalled = roots.recall(mesh, reference, &trees, options, threads)?;
        if !is_changed && !recalled.is_as_given {
            return Err(unfit("its records of the tets give a different mesh"));
        }
        Ok(recalled.refinement)
    }
}

/// The tops of all trees.
struct Roots {
    /// The first mesh, with the vertex ids of the given mesh.
    first: TetMesh,
    /// For each root, its node in the trees; none if it is a single tet without one.
    tree_nodes: Vec<MaybeId<TreeNodeId>>,
    /// For each tet, its root.
    root_of: Vec<NodeId>,
    /// For each triangle of the mesh, its triangle of the first mesh.
    triangle_of: Vec<TriangleId>,
    /// For each line of the mesh, its line of the first mesh.
    line_of: Vec<LineId>,
    n_dissolved: usize,
}

impl Roots {
    fn of(mesh: &TetMesh, memory: &Memory, trees: &Trees) -> Result<Self> {
        let mut first = TetMesh { points: Vec::new(), tets: Vec::new(), regions: Vec::new(), ..mesh.clone() };
        let Gathered { triangles, patches, part_of } = triangles::gather(mesh, memory, trees)?;
        (first.triangles, first.patches) = (triangles, patches);
        let gathered = lines::gather(mesh, trees)?;
        (first.lines, first.line_labels) = (gathered.lines, gathered.labels);
        let mut tree_nodes = Vec::new();
        let mut root_of = Vec::with_capacity(mesh.tets.len());
        let mut root_of_tree_node: Vec<MaybeId<NodeId>> = vec![MaybeId::NONE; trees.nodes.len()];
        for (t, &tet) in mesh.tets.iter().enumerate() {
            let top = trees.top_of(TetId::new(t));
            if let Some(known) = top.and_then(|top| root_of_tree_node[top.index()].get()) {
                root_of.push(known);
                continue;
            }
            let root = NodeId::new(tree_nodes.len());
            root_of.push(root);
            tree_nodes.push(top.into());
            first.regions.push(mesh.regions[t]);
            first.tets.push(top.map_or(tet, |top| {
                root_of_tree_node[top.index()] = root.into();
                let tree_node = &trees.nodes[top.index()];
                let [a, b, c, d] = tree_node.corners;
                if tree_node.is_turned { [b, a, c, d] } else { [a, b, c, d] }
            }));
        }
        let n_dissolved = trees.nodes.iter().filter(|tree_node| !tree_node.is_whole).count();
        Ok(Self { first, tree_nodes, root_of, triangle_of: part_of, line_of: gathered.part_of, n_dissolved })
    }

    /// For each vertex of the mesh, whether it exists only because of a division.
    fn middles(&self, mesh: &TetMesh, trees: &Trees) -> Vec<bool> {
        let mut is_middle = vec![false; mesh.points.len()];
        let whole = trees.nodes.iter().filter(|tree_node| tree_node.is_whole);
        let middles = whole.flat_map(|tree_node| tree_node.middles).filter_map(MaybeId::get);
        middles.for_each(|v| is_middle[v.index()] = true);
        let stay = self.first.tets.iter().flatten().chain(&mesh.fixed_vertices);
        let stay = stay.chain(mesh.fixed_edges.iter().flatten()).chain(self.first.lines.iter().flatten());
        stay.for_each(|v| is_middle[v.index()] = false);
        is_middle
    }

    fn recall(
        mut self,
        mesh: &TetMesh,
        reference: &[Point],
        trees: &Trees,
        options: Options,
        threads: &Threads,
    ) -> Result<Recalled> {
        let is_middle = self.middles(mesh, trees);
        let mut to_forest = vec![MaybeId::NONE; mesh.points.len()];
        let firsts: Vec<usize> = (0..is_middle.len()).filter(|&v| !is_middle[v]).collect();
        firsts.iter().zip(0..).for_each(|(&v, number)| to_forest[v] = ForestVertexId(number).into());
        self.rename(&to_forest)?;
        self.first.points = firsts.iter().map(|&v| reference[v]).collect();
        check_roots(&self.first, threads)?;
        let turned = |tree_node: TreeNodeId| trees.nodes[tree_node.index()].is_turned;
        let root = |(tet, tree_node): (&[VertexId; 4], &MaybeId<TreeNodeId>)| match tet.map(in_forest) {
            [a, b, c, d] if tree_node.get().is_some_and(turned) => ([b, a, c, d], true),
            tet => (tet, false),
        };
        let roots: Vec<_> = self.first.tets.iter().zip(&self.tree_nodes).map(root).collect();
        let forest = Forest::new(&self.first.points, &roots, threads);
        let bounds = ShapeBounds::new(options, &forest);
        self.first.points = firsts.iter().map(|&v| mesh.points[v]).collect();

        let forest_node_of = vec![MaybeId::NONE; trees.nodes.len()];
        let mut building = Building { trees, forest, to_forest, forest_node_of };
        let divided = self.tree_nodes.iter().enumerate();
        let divided = divided.filter_map(|(root, tree_node)| Some((NodeId::new(root), tree_node.get()?)));
        building.build(divided.collect(), threads)?;
        let Building { mut forest, to_forest, forest_node_of, .. } = building;
        forest.pin();
        let node =
            |t: usize| trees.node_of[t].get().and_then(|tree_node| forest_node_of[tree_node.index()].get());
        let nodes: Vec<NodeId> = (0..mesh.tets.len()).map(|t| node(t).unwrap_or(self.root_of[t])).collect();
        let known =
            |v: &MaybeId<ForestVertexId>| v.get().ok_or_else(|| unfit("a point is not accounted for"));
        let vertices = to_forest.iter().map(known).collect::<Result<Vec<_>>>()?;
        let (triangles, lines) = (self.triangle_of, self.line_of);
        let now = Extracted { mesh: mesh.clone(), vertices, nodes, n_tets: Vec::new(), triangles, lines };
        // A memory of another mesh may request arbitrarily many divisions.
        let max_nodes = std::mem::replace(&mut forest.max_nodes, 100 * forest.nodes.len() + 100_000);
        let closed = close(&mut forest, bounds, threads).map_err(|_| unfit("its divisions do not end"))?;
        forest.max_nodes = max_nodes;
        let same = extract(&forest, &self.first, &closed.cuts, &now, threads)?;
        let is_as_given = is_same(&same, &now);
        let summary = Summary { n_tets: mesh.tets.len(), ..Summary::default() };
        let is_moved = mesh.points != reference;
        let refinement = Refinement { first_mesh: self.first, forest, bounds, now, summary, is_moved };
        Ok(Recalled { refinement, is_as_given })
    }

    /// Renames the vertices of the first mesh to those of the forest.
    ///
    /// # Errors
    /// When a triangle has a vertex that exists only because of a division.
    fn rename(&mut self, to_forest: &[MaybeId<ForestVertexId>]) -> Result<()> {
        let first = &mut self.first;
        let corners = first.tets.iter_mut().flatten().chain(first.triangles.iter_mut().flatten());
        let ends = first.lines.iter_mut().flatten().chain(first.fixed_edges.iter_mut().flatten());
        for v in corners.chain(ends).chain(&mut first.fixed_vertices) {
            let new = to_forest[v.index()].get().ok_or_else(|| unfit("a triangle is not accounted for"))?;
            *v = VertexId(new.0);
        }
        Ok(())
    }
}

struct Recalled {
    refinement: Refinement,
    /// Whether the forest reproduces the given mesh.
    is_as_given: bool,
}

fn is_same(one: &Extracted, other: &Extracted) -> bool {
    let same = |x: &[VertexId], y: &[VertexId]| {
        let of = |out: &Extracted, v: VertexId| out.vertices[v.index()];
        x.iter().zip(y).all(|(&x, &y)| of(one, x) == of(other, y))
    };
    // Writers may reorder lines.
    let lines = |out: &Extracted| {
        let of = |v: VertexId| out.vertices[v.index()];
        let parts = out
            .mesh
            .lines
            .iter()
            .zip(&out.lines)
            .map(|(&[a, b], &line)| (line, of(a).min(of(b)), of(a).max(of(b))));
        let mut parts: Vec<_> = parts.collect();
        parts.sort_unstable();
        parts
    };
    one.nodes == other.nodes
        && lines(one) == lines(other)
        && one.triangles == other.triangles
        && one.mesh.tets.len() == other.mesh.tets.len()
        && same(one.mesh.tets.as_flattened(), other.mesh.tets.as_flattened())
        && same(one.mesh.triangles.as_flattened(), other.mesh.triangles.as_flattened())
}

struct Building<'a> {
    trees: &'a Trees,
    forest: Forest,
    /// For each vertex of the mesh, its id in the forest, once it has one.
    to_forest: Vec<MaybeId<ForestVertexId>>,
    /// For each node of the trees, its tet in the forest, once it has one.
    forest_node_of: Vec<MaybeId<NodeId>>,
}

impl Building<'_> {
    /// Divides roots as their nodes in the trees are divided, generation by generation.
    fn build(&mut self, roots: Vec<(NodeId, TreeNodeId)>, threads: &Threads) -> Result<()> {
        let mut level = roots;
        while !level.is_empty() {
            let (mut tets, mut parts) = (Vec::new(), Vec::new());
            for (node, tree_node) in level {
                let of = &self.trees.nodes[tree_node.index()];
                self.forest_node_of[tree_node.index()] = node.into();
                for (e, middle) in of.middles.iter().enumerate() {
                    if let Some(middle) = middle.get() {
                        self.set_middle(self.forest.edges_of[node.index()][e], middle)?;
                    }
                }
                let Some((way, children)) = of.divided else { continue };
                self.forest.states[node.index()].is_requested = u32::from(of.n_requested) > of.generation;
                tets.push((node, way as u8));
                parts.push(children);
            }
            self.forest.finish_middles(threads);
            self.forest.divide(&tets, threads);
            let first = |(node, _): &(NodeId, u8)| self.forest.nodes[node.index()].first_child.get();
            let firsts = tets.iter().filter_map(first).zip(parts);
            level = firsts.flat_map(|(first, parts)| Forest::parts_from(first).zip(parts)).collect();
        }
        Ok(())
    }

    fn set_middle(&mut self, edge: EdgeId, middle: VertexId) -> Result<()> {
        let of_edge = self.forest.edges[edge.index()].middle.get();
        match (of_edge, self.to_forest[middle.index()].get()) {
            (None, None) => self.to_forest[middle.index()] = self.forest.middle(edge).into(),
            (None, Some(v)) if v.index() < self.forest.n_first_vertices => {
                self.forest.edges[edge.index()].middle = v.into();
            }
            (Some(known), Some(v)) if known == v => {}
            _ => return Err(unfit("a point is the middle of two edges")),
        }
        Ok(())
    }
}
