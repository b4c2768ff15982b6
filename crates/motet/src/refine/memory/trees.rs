//! Merges tets of one origin: the pieces of a cut tet into that tet, eight parts into the tet they come from,
//! and so on.

use super::super::forest::NONE;
use super::super::forest::patterns;
use super::super::forest::{IMAGES, eight};
use super::{Memory, UNKNOWN, generation, locals, step};
use crate::base::{Id, VertexId};
use crate::mesh::TetMesh;

/// A node of a tree: a tet of the mesh, several pieces of one, or eight such nodes.
#[derive(Clone, Debug)]
pub(super) struct TreeNode {
    /// The corners, then the middles of split edges; [`Id::NONE`] for edges that are not split.
    pub(super) vertices: [VertexId; 10],
    pub(super) parent: u32,
    /// Which of the eight parts of its parent it is.
    pub(super) place: usize,
    /// If it is divided, the index of the diagonal, and the eight parts.
    pub(super) divided: Option<(usize, [u32; 8])>,
    /// A tet of the mesh that lies in it, the first.
    pub(super) tet: u32,
    pub(super) generation: u32,
    /// How many divisions on the path down to it and below were requested.
    pub(super) n_requested: u8,
    /// Whether all tets in it have the opposite orientation.
    pub(super) is_turned: bool,
    pub(super) region: i32,
    /// Whether all tets that it consists of are there.
    pub(super) is_whole: bool,
}

impl Default for TreeNode {
    fn default() -> Self {
        Self {
            vertices: [VertexId::NONE; 10],
            parent: NONE,
            place: 0,
            divided: None,
            tet: NONE,
            generation: 0,
            n_requested: 0,
            is_turned: false,
            region: 0,
            is_whole: true,
        }
    }
}

/// All nodes; in each tree, parents come after their children.
#[derive(Debug, Default)]
pub(super) struct Trees {
    pub(super) nodes: Vec<TreeNode>,
    /// For each tet, the node that it is or is a piece of; [`NONE`] if unknown.
    pub(super) node_of: Vec<u32>,
}

impl Trees {
    pub(super) fn gather(mesh: &TetMesh, memory: &Memory) -> Self {
        let mut order: Vec<u32> = (0..mesh.tets.len() as u32).collect();
        order.retain(|&t| memory.roots[t as usize] != UNKNOWN && memory.paths[t as usize] != 0);
        let key = |t: u32| {
            let path = memory.paths[t as usize];
            (memory.roots[t as usize], path << path.leading_zeros() << 1, t)
        };
        order.sort_unstable_by_key(|&t| key(t));
        let nodes = Vec::new();
        let mut gathering =
            Gathering { mesh, memory, trees: Self { nodes, node_of: vec![NONE; mesh.tets.len()] } };
        for tree in order.chunk_by(|&s, &t| memory.roots[s as usize] == memory.roots[t as usize]) {
            gathering.gather(tree, 0);
        }
        gathering.trees
    }

    /// The largest whole node that a tet lies in.
    pub(super) fn top_of(&self, tet: usize) -> Option<u32> {
        let is_whole = |node: &u32| *node != NONE && self.nodes[*node as usize].is_whole;
        let mut top = Some(self.node_of[tet]).filter(is_whole)?;
        while let Some(parent) = Some(self.nodes[top as usize].parent).filter(is_whole) {
            top = parent;
        }
        Some(top)
    }

    /// Marks a node, and all nodes that it lies in, as not whole.
    pub(super) fn dissolve(&mut self, mut node: u32) {
        while node != NONE && self.nodes[node as usize].is_whole {
            self.nodes[node as usize].is_whole = false;
            node = self.nodes[node as usize].parent;
        }
    }
}

struct Gathering<'a> {
    mesh: &'a TetMesh,
    memory: &'a Memory,
    trees: Trees,
}

impl Gathering<'_> {
    /// Builds the node that these tets form; up to `depth` they have the same path.
    fn gather(&mut self, tets: &[u32], depth: u32) -> Option<u32> {
        let depth_of = |t: u32| generation(self.memory.paths[t as usize]);
        if tets.iter().all(|&t| depth_of(t) == depth) {
            return self.leaf(tets, depth);
        }
        if tets.iter().any(|&t| depth_of(t) <= depth) {
            return None;
        }
        let memory = self.memory;
        let step_of = |t: u32| {
            let path = memory.paths[t as usize];
            step(path, generation(path), depth)
        };
        let mut children = [NONE; 8];
        for part in tets.chunk_by(|&s, &t| step_of(s) == step_of(t)) {
            if let Some(child) = self.gather(part, depth + 1) {
                children[step_of(part[0])] = child;
            }
        }
        if children.contains(&NONE) { None } else { self.whole(children, depth) }
    }

    fn leaf(&mut self, tets: &[u32], generation: u32) -> Option<u32> {
        let (mesh, memory) = (self.mesh, self.memory);
        let mut vertices = [VertexId::NONE; 10];
        let mut mask = 0;
        for &t in tets {
            for (place, v) in locals(memory.pieces[t as usize]).into_iter().zip(mesh.tets[t as usize]) {
                put(&mut vertices, usize::from(place), v)?;
                mask |= if place < 4 { 0 } else { 1 << (place - 4) };
            }
        }
        let is_turned = is_turned(tets, memory, mask)?;
        let first = tets[0] as usize;
        let (region, n_requested) = (mesh.regions[first], memory.n_requested[first]);
        let is_alike =
            |&t: &u32| mesh.regions[t as usize] == region && memory.n_requested[t as usize] == n_requested;
        if !tets.iter().all(is_alike) || vertices[..4].contains(&VertexId::NONE) {
            return None;
        }
        let id = self.trees.nodes.len() as u32;
        tets.iter().for_each(|&t| self.trees.node_of[t as usize] = id);
        let tet = tets.iter().copied().min()?;
        let node =
            TreeNode { vertices, tet, generation, n_requested, is_turned, region, ..TreeNode::default() };
        self.trees.nodes.push(node);
        Some(id)
    }

    /// Builds the node that was divided into these eight.
    fn whole(&mut self, children: [u32; 8], generation: u32) -> Option<u32> {
        let nodes = &mut self.trees.nodes;
        let of = |k: usize| &nodes[children[k] as usize];
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
            let mut vertices = [VertexId::NONE; 10];
            for (k, corners) in eight(way).iter().enumerate() {
                for (i, &place) in corners.iter().enumerate() {
                    put(&mut vertices, usize::from(place), of(k).vertices[i])?;
                }
            }
            Some((way, vertices))
        });
        let (way, vertices) = fitted?;
        let tet = (0..8).map(|k| of(k).tet).min()?;
        let id = nodes.len() as u32;
        for (place, child) in children.into_iter().enumerate() {
            (nodes[child as usize].parent, nodes[child as usize].place) = (id, place);
        }
        let divided = Some((way, children));
        nodes.push(TreeNode {
            vertices,
            divided,
            tet,
            generation,
            n_requested,
            is_turned,
            region,
            ..TreeNode::default()
        });
        Some(id)
    }
}

/// Sets a vertex, unless a different one is already there.
fn put(vertices: &mut [VertexId; 10], place: usize, v: VertexId) -> Option<()> {
    let there = vertices.get_mut(place)?;
    if *there != VertexId::NONE && *there != v {
        return None;
    }
    *there = v;
    Some(())
}

/// Whether the pieces, which must form one of the ways to fill a tet, have their first two vertices
/// exchanged; `None` if they form no such way.
fn is_turned(tets: &[u32], memory: &Memory, mask: u8) -> Option<bool> {
    let pieces: Vec<[u8; 4]> = tets.iter().map(|&t| locals(memory.pieces[t as usize])).collect();
    let turned: Vec<[u8; 4]> = pieces.iter().map(|&[a, b, c, d]| [b, a, c, d]).collect();
    if mask == 0 {
        let is_whole = |pieces: &[[u8; 4]]| pieces == [[0, 1, 2, 3]];
        return (is_whole(&pieces) || is_whole(&turned)).then(|| is_whole(&turned));
    }
    let mut ways = (0..16).flat_map(|cuts| patterns(mask, cuts));
    let way = ways.find(|way| **way == pieces || **way == turned)?;
    Some(*way == turned)
}
