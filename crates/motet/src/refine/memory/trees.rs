//! Merges tets of one origin: the pieces of a cut tet into that tet, eight parts into the tet they come from,
//! and so on.

use super::super::forest::patterns;
use super::super::forest::{IMAGES, eight};
use super::{Memory, generation, locals, step};
use crate::base::{MaybeId, TetId, Threads, VertexId, id};
use crate::mesh::TetMesh;

id!(
    /// A node of a tree of tets that are merged again.
    pub(super) TreeNodeId
);

/// A node of a tree: a tet of the mesh, several pieces of one, or eight such nodes.
#[derive(Clone, Debug)]
pub(super) struct TreeNode {
    pub(super) corners: [VertexId; 4],
    /// The middles of edges; none for edges that are not split.
    pub(super) middles: [MaybeId<VertexId>; 6],
    pub(super) parent: MaybeId<TreeNodeId>,
    /// Which of the eight parts of its parent it is.
    pub(super) place: usize,
    /// If it is divided, the index of the diagonal, and the eight parts.
    pub(super) divided: Option<(usize, [TreeNodeId; 8])>,
    /// A tet of the mesh that lies in it, the first.
    pub(super) tet: TetId,
    pub(super) generation: u32,
    /// How many divisions on the path down to it and below were requested.
    pub(super) n_requested: u8,
    /// Whether all tets in it have the opposite orientation.
    pub(super) is_turned: bool,
    pub(super) region: i32,
    /// Whether all tets that it consists of are there.
    pub(super) is_whole: bool,
}

impl TreeNode {
    /// This node after `n` others.
    fn after(self, n: usize) -> Self {
        let later = |node: TreeNodeId| TreeNodeId::new(n + node.index());
        Self {
            parent: self.parent.get().map(later).into(),
            divided: self.divided.map(|(way, parts)| (way, parts.map(later))),
            ..self
        }
    }

    /// The local number of a vertex: corners, then middles.
    pub(super) fn local(&self, v: VertexId) -> Option<usize> {
        let middle = || self.middles.iter().position(|middle| *middle == v.into()).map(|e| 4 + e);
        self.corners.iter().position(|corner| *corner == v).or_else(middle)
    }
}

/// All nodes; in each tree, parents come after their children.
#[derive(Debug, Default)]
pub(super) struct Trees {
    pub(super) nodes: Vec<TreeNode>,
    /// For each tet, the node that it is or is a piece of; none if unknown.
    pub(super) node_of: Vec<MaybeId<TreeNodeId>>,
}

impl Trees {
    pub(super) fn gather(mesh: &TetMesh, memory: &Memory, threads: &Threads) -> Self {
        let mut order: Vec<TetId> = (0..mesh.tets.len()).map(TetId::new).collect();
        order.retain(|t| memory.roots[t.index()].is_some() && memory.paths[t.index()] != 0);
        let key = |t: TetId| {
            let path = memory.paths[t.index()];
            (memory.roots[t.index()], path << path.leading_zeros() << 1, t)
        };
        order.sort_unstable_by_key(|&t| key(t));
        let trees: Vec<&[TetId]> =
            order.chunk_by(|s, t| memory.roots[s.index()] == memory.roots[t.index()]).collect();
        let gathered = threads.in_runs(trees.len(), RUN, |(): &mut (), run| {
            let mut gathering = Gathering { mesh, memory, nodes: Vec::new(), node_of: Vec::new() };
            for tree in &trees[run] {
                gathering.gather(tree, 0);
            }
            vec![(gathering.nodes, gathering.node_of)]
        });
        let mut all = Self { nodes: Vec::new(), node_of: vec![MaybeId::NONE; mesh.tets.len()] };
        for (nodes, node_of) in gathered {
            let n_before = all.nodes.len();
            for (t, node) in node_of {
                all.node_of[t.index()] = TreeNodeId::new(n_before + node.index()).into();
            }
            if n_before == 0 {
                all.nodes = nodes;
            } else {
                all.nodes.extend(nodes.into_iter().map(|node| node.after(n_before)));
            }
        }
        all
    }

    /// The largest whole node that a tet lies in.
    pub(super) fn top_of(&self, tet: TetId) -> Option<TreeNodeId> {
        let is_whole = |node: &TreeNodeId| self.nodes[node.index()].is_whole;
        let mut top = self.node_of[tet.index()].get().filter(is_whole)?;
        while let Some(parent) = self.nodes[top.index()].parent.get().filter(is_whole) {
            top = parent;
        }
        Some(top)
    }

    /// Marks a node, and all nodes that it lies in, as not whole.
    pub(super) fn dissolve(&mut self, node: TreeNodeId) {
        let mut next = Some(node);
        while let Some(node) = next.filter(|node| self.nodes[node.index()].is_whole) {
            self.nodes[node.index()].is_whole = false;
            next = self.nodes[node.index()].parent.get();
        }
    }
}

/// How many trees are gathered at a time.
const RUN: usize = 256;

/// Some trees, and the nodes of their tets.
struct Gathering<'a> {
    mesh: &'a TetMesh,
    memory: &'a Memory,
    nodes: Vec<TreeNode>,
    node_of: Vec<(TetId, TreeNodeId)>,
}

impl Gathering<'_> {
    /// Builds the node that these tets form; up to `depth` they have the same path.
    fn gather(&mut self, tets: &[TetId], depth: u32) -> Option<TreeNodeId> {
        let depth_of = |t: TetId| generation(self.memory.paths[t.index()]);
        if tets.iter().all(|&t| depth_of(t) == depth) {
            return self.leaf(tets, depth);
        }
        if tets.iter().any(|&t| depth_of(t) <= depth) {
            return None;
        }
        let memory = self.memory;
        let step_of = |t: TetId| {
            let path = memory.paths[t.index()];
            step(path, generation(path), depth)
        };
        let mut children = [None; 8];
        for part in tets.chunk_by(|&s, &t| step_of(s) == step_of(t)) {
            children[step_of(part[0])] = self.gather(part, depth + 1);
        }
        let [Some(a), Some(b), Some(c), Some(d), Some(e), Some(f), Some(g), Some(h)] = children else {
            return None;
        };
        self.whole([a, b, c, d, e, f, g, h], depth)
    }

    fn leaf(&mut self, tets: &[TetId], generation: u32) -> Option<TreeNodeId> {
        let (mesh, memory) = (self.mesh, self.memory);
        let mut vertices = [MaybeId::NONE; 10];
        let mut mask = 0;
        for &t in tets {
            for (place, v) in locals(memory.pieces[t.index()]).into_iter().zip(mesh.tets[t.index()]) {
                put(&mut vertices, usize::from(place), v)?;
                mask |= if place < 4 { 0 } else { 1 << (place - 4) };
            }
        }
        let is_turned = is_turned(tets, memory, mask)?;
        let first = tets[0].index();
        let (region, n_requested) = (mesh.regions[first], memory.n_requested[first]);
        let is_alike =
            |t: &TetId| mesh.regions[t.index()] == region && memory.n_requested[t.index()] == n_requested;
        if !tets.iter().all(is_alike) {
            return None;
        }
        let (corners, middles) = split(vertices)?;
        let id = TreeNodeId::new(self.nodes.len());
        self.node_of.extend(tets.iter().map(|&t| (t, id)));
        let tet = tets.iter().copied().min()?;
        self.nodes.push(TreeNode {
            corners,
            middles,
            parent: MaybeId::NONE,
            place: 0,
            divided: None,
            tet,
            generation,
            n_requested,
            is_turned,
            region,
            is_whole: true,
        });
        Some(id)
    }

    /// Builds the node that was divided into these eight.
    fn whole(&mut self, children: [TreeNodeId; 8], generation: u32) -> Option<TreeNodeId> {
        let nodes = &mut self.nodes;
        let of = |k: usize| &nodes[children[k].index()];
        let (region, is_turned) = (of(0).region, of(0).is_turned);
        let n_requested = (0..8).map(|k| of(k).n_requested).max()?;
        let is_alike = |k: usize| {
            let node = of(k);
            let is_requested = u32::from(node.n_requested.min(n_requested)) > generation;
            (node.region, node.is_turned ^ IMAGES.contains(&k)) == (region, is_turned)
                && is_requested == (u32::from(n_requested) > generation)
        };
        if !(0..8).all(is_alike) {
            return None;
        }
        let fitted = (0..3).find_map(|way| {
            let mut vertices = [MaybeId::NONE; 10];
            for (k, corners) in eight(way).iter().enumerate() {
                for (i, &place) in corners.iter().enumerate() {
                    put(&mut vertices, usize::from(place), of(k).corners[i])?;
                }
            }
            Some((way, split(vertices)?))
        });
        let (way, (corners, middles)) = fitted?;
        let tet = (0..8).map(|k| of(k).tet).min()?;
        let id = TreeNodeId::new(nodes.len());
        for (place, child) in children.into_iter().enumerate() {
            (nodes[child.index()].parent, nodes[child.index()].place) = (id.into(), place);
        }
        nodes.push(TreeNode {
            corners,
            middles,
            parent: MaybeId::NONE,
            place: 0,
            divided: Some((way, children)),
            tet,
            generation,
            n_requested,
            is_turned,
            region,
            is_whole: true,
        });
        Some(id)
    }
}

/// Sets a vertex, unless a different one is already there.
fn put(vertices: &mut [MaybeId<VertexId>; 10], place: usize, v: VertexId) -> Option<()> {
    let there = vertices.get_mut(place)?;
    if there.is_some() && *there != v.into() {
        return None;
    }
    *there = v.into();
    Some(())
}

/// The corners and the middles; `None` if a corner is missing.
fn split(vertices: [MaybeId<VertexId>; 10]) -> Option<([VertexId; 4], [MaybeId<VertexId>; 6])> {
    let [a, b, c, d, middles @ ..] = vertices;
    Some(([a.get()?, b.get()?, c.get()?, d.get()?], middles))
}

/// Whether the pieces, which must form one of the ways to fill a tet, have their first two vertices
/// exchanged; `None` if they form no such way.
fn is_turned(tets: &[TetId], memory: &Memory, mask: u8) -> Option<bool> {
    if mask == 0 {
        let &[tet] = tets else { return None };
        return match locals(memory.pieces[tet.index()]) {
            [0, 1, 2, 3] => Some(false),
            [1, 0, 2, 3] => Some(true),
            _ => None,
        };
    }
    let pieces: Vec<[u8; 4]> = tets.iter().map(|t| locals(memory.pieces[t.index()])).collect();
    let turned: Vec<[u8; 4]> = pieces.iter().map(|&[a, b, c, d]| [b, a, c, d]).collect();
    let mut ways = (0..16).flat_map(|cuts| patterns(mask, cuts));
    let way = ways.find(|way| **way == pieces || **way == turned)?;
    Some(*way == turned)
}
