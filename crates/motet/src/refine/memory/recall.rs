//! Rebuilds the forest from a stored memory.

use super::super::forest::{Extracted, extract};
use super::super::forest::{Forest, NONE};
use super::super::forest::{ShapeBounds, close};
use super::super::refinement::{Options, Refinement, Summary, check_roots};
use super::trees::Trees;
use super::triangles::Gathered;
use super::{Memory, dissolve, lines, triangles, unfit};
use crate::base::{Id, Point, Result, Threads, VertexId};
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
        let mut trees = Trees::gather(mesh, memory);
        let is_changed = trees.node_of.contains(&NONE);
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
    /// For each root, its node in the trees; [`NONE`] if it is a single tet without one.
    tree_nodes: Vec<u32>,
    /// For each tet, its root.
    root_of: Vec<u32>,
    /// For each triangle of the mesh, its triangle of the first mesh.
    triangle_of: Vec<u32>,
    /// For each line of the mesh, its line of the first mesh.
    line_of: Vec<u32>,
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
        let mut root_of_tree_node = vec![NONE; trees.nodes.len()];
        for (t, &tet) in mesh.tets.iter().enumerate() {
            let top = trees.top_of(t);
            let known = top.map_or(NONE, |top| root_of_tree_node[top as usize]);
            if known != NONE {
                root_of.push(known);
                continue;
            }
            let root = tree_nodes.len() as u32;
            root_of.push(root);
            tree_nodes.push(top.unwrap_or(NONE));
            first.regions.push(mesh.regions[t]);
            first.tets.push(top.map_or(tet, |top| {
                root_of_tree_node[top as usize] = root;
                let tree_node = &trees.nodes[top as usize];
                let [a, b, c, d]: [VertexId; 4] = std::array::from_fn(|i| tree_node.vertices[i]);
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
        let middles = whole.flat_map(|tree_node| &tree_node.vertices[4..]).filter(|v| **v != VertexId::NONE);
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
        let mut to_forest = vec![NONE; mesh.points.len()];
        let firsts: Vec<usize> = (0..is_middle.len()).filter(|&v| !is_middle[v]).collect();
        firsts.iter().zip(0..).for_each(|(&v, number)| to_forest[v] = number);
        self.rename(&to_forest);
        self.first.points = firsts.iter().map(|&v| reference[v]).collect();
        check_roots(&self.first, threads)?;
        let turned = |tree_node: u32| tree_node != NONE && trees.nodes[tree_node as usize].is_turned;
        let roots =
            self.first.tets.iter().zip(&self.tree_nodes).map(|(tet, &tree_node)| match tet.map(|v| v.0) {
                [a, b, c, d] if turned(tree_node) => ([b, a, c, d], true),
                tet => (tet, false),
            });
        let forest = Forest::new(&self.first.points, roots);
        let bounds = ShapeBounds::new(options, &forest);
        self.first.points = firsts.iter().map(|&v| mesh.points[v]).collect();

        let mut building =
            Building { trees, forest, to_forest, forest_node_of: vec![NONE; trees.nodes.len()] };
        for (root, &tree_node) in (0..).zip(&self.tree_nodes).filter(|(_, tree_node)| **tree_node != NONE) {
            building.build(root, tree_node)?;
        }
        let Building { mut forest, to_forest, forest_node_of, .. } = building;
        forest.pin();
        let nodes = |t: usize| match trees.node_of[t] {
            tree_node if tree_node != NONE && forest_node_of[tree_node as usize] != NONE => {
                forest_node_of[tree_node as usize]
            }
            _ => self.root_of[t],
        };
        let nodes: Vec<u32> = (0..mesh.tets.len()).map(nodes).collect();
        let mut points = vec![[f64::NAN; 3]; forest.reference.len()];
        for (v, &known) in to_forest.iter().enumerate() {
            *points.get_mut(known as usize).ok_or_else(|| unfit("a point is not accounted for"))? =
                mesh.points[v];
        }
        let (triangles, lines) = (self.triangle_of, self.line_of);
        let now = Extracted { mesh: mesh.clone(), vertices: to_forest, nodes, triangles, lines };
        // A memory of another mesh may request arbitrarily many divisions.
        let max_nodes = std::mem::replace(&mut forest.max_nodes, 100 * forest.nodes.len() + 100_000);
        let closed = close(&mut forest, bounds, threads).map_err(|_| unfit("its divisions do not end"))?;
        forest.max_nodes = max_nodes;
        points.resize(forest.reference.len(), [f64::NAN; 3]);
        let same = extract(&forest, &self.first, &closed.cuts, &points, &now.vertices)?;
        let is_as_given = is_same(&same, &now);
        let summary = Summary { n_tets: mesh.tets.len(), ..Summary::default() };
        let is_moved = mesh.points != reference;
        let refinement =
            Refinement { first_mesh: self.first, forest, bounds, points, now, summary, is_moved };
        Ok(Recalled { refinement, is_as_given })
    }

    /// Renames the vertices of the first mesh to those of the forest.
    fn rename(&mut self, to_forest: &[u32]) {
        let new = |v: &mut VertexId| *v = VertexId(to_forest[v.index()]);
        self.first.tets.iter_mut().flatten().for_each(new);
        self.first.triangles.iter_mut().flatten().for_each(new);
        self.first.lines.iter_mut().flatten().for_each(new);
        self.first.fixed_vertices.iter_mut().for_each(new);
        self.first.fixed_edges.iter_mut().flatten().for_each(new);
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
    to_forest: Vec<u32>,
    /// For each node of the trees, its tet in the forest; [`NONE`] if it has none yet.
    forest_node_of: Vec<u32>,
}

impl Building<'_> {
    /// Divides a root as its node in the trees is divided.
    fn build(&mut self, root: u32, tree_node: u32) -> Result<()> {
        let mut open = vec![(root, tree_node)];
        while let Some((node, tree_node)) = open.pop() {
            let of = &self.trees.nodes[tree_node as usize];
            self.forest_node_of[tree_node as usize] = node;
            for (e, middle) in of.vertices[4..].iter().enumerate().filter(|(_, v)| **v != VertexId::NONE) {
                self.set_middle(self.forest.edges_of[node as usize][e], middle.index())?;
            }
            let Some((way, children)) = of.divided else { continue };
            let first = self.forest.divide(node, way);
            self.forest.states[node as usize].is_requested = u32::from(of.n_requested) > of.generation;
            open.extend((first..first + 8).zip(children));
        }
        Ok(())
    }

    fn set_middle(&mut self, edge: u32, middle: usize) -> Result<()> {
        let known = self.forest.edges[edge as usize].middle;
        let is_new = self.to_forest[middle] == NONE;
        match (known, is_new) {
            (NONE, true) => self.to_forest[middle] = self.forest.middle(edge),
            (NONE, false) if (self.to_forest[middle] as usize) < self.forest.n_first_vertices => {
                self.forest.edges[edge as usize].middle = self.to_forest[middle];
            }
            _ if known == self.to_forest[middle] => {}
            _ => return Err(unfit("a point is the middle of two edges")),
        }
        Ok(())
    }
}
