//! Merges the lines of a mesh again, as the edges of its tets are merged.

use std::collections::BTreeMap;

use hashbrown::HashMap;

use super::trees::Trees;
use super::unfit;
use crate::base::{LineId, Result, VertexId};
use crate::geometry::tet::EDGES;
use crate::mesh::TetMesh;

/// The lines before division.
pub(super) struct Gathered {
    pub(super) lines: Vec<[VertexId; 2]>,
    pub(super) labels: Vec<i32>,
    /// For each line of the mesh, which of these it is a part of.
    pub(super) part_of: Vec<LineId>,
}

/// No edge is halved more often than this.
const MAX_HALVINGS: usize = 32;

/// Returns the lines before division, in the order of their first parts.
///
/// # Errors
/// When only some parts of a divided edge are lines.
pub(super) fn gather(mesh: &TetMesh, trees: &Trees) -> Result<Gathered> {
    let mut gathered = Gathered { lines: Vec::new(), labels: Vec::new(), part_of: Vec::new() };
    if mesh.lines.is_empty() {
        return Ok(gathered);
    }
    let whole_of = whole_edges(trees);
    // Duplicate lines stay apart: of two on one edge, the second is a part of the second whole.
    let mut n_seen: BTreeMap<([VertexId; 2], i32), u32> = BTreeMap::new();
    let mut numbers: BTreeMap<([VertexId; 2], i32, u32), LineId> = BTreeMap::new();
    let mut shares: Vec<u64> = Vec::new();
    for (line, (&part, &label)) in mesh.lines.iter().zip(&mesh.line_labels).enumerate() {
        let seen = n_seen.entry((sorted(part), label)).or_default();
        let copy = std::mem::replace(seen, *seen + 1);
        let (whole, n_halvings) = undivided_edge(part, &whole_of)
            .ok_or_else(|| unfit(&format!("line {line} lies in an edge that was divided too often")))?;
        let next = LineId::new(gathered.lines.len());
        let number = *numbers.entry((sorted(whole), label, copy)).or_insert(next);
        if number == next {
            gathered.lines.push(whole);
            gathered.labels.push(label);
            shares.push(0);
        }
        gathered.part_of.push(number);
        shares[number.index()] += 1 << (MAX_HALVINGS - n_halvings);
    }
    match shares.iter().position(|&share| share != 1 << MAX_HALVINGS) {
        None => Ok(gathered),
        Some(_) => Err(unfit("only some parts of a divided edge are lines")),
    }
}

fn sorted([a, b]: [VertexId; 2]) -> [VertexId; 2] {
    [a.min(b), a.max(b)]
}

/// For each half of an edge of a whole node, that edge; both with the lower vertex first.
fn whole_edges(trees: &Trees) -> HashMap<[VertexId; 2], [VertexId; 2]> {
    let mut whole_of = HashMap::new();
    for node in trees.nodes.iter().filter(|node| node.is_whole) {
        for (e, [i, j]) in EDGES.into_iter().enumerate() {
            let [a, b] = [node.corners[i], node.corners[j]];
            if let Some(middle) = node.middles[e].get() {
                whole_of.extend([a, b].map(|end| (sorted([end, middle]), sorted([a, b]))));
            }
        }
    }
    whole_of
}

/// Returns the undivided edge that a part lies in, in the direction of the part, and how often it was halved
/// to give the part.
fn undivided_edge(
    mut part: [VertexId; 2],
    whole_of: &HashMap<[VertexId; 2], [VertexId; 2]>,
) -> Option<([VertexId; 2], usize)> {
    for n in 0..=MAX_HALVINGS {
        let Some(&[a, b]) = whole_of.get(&sorted(part)) else { return Some((part, n)) };
        let runs_up = part[0] == a || part[1] == b;
        part = if runs_up { [a, b] } else { [b, a] };
    }
    None
}
