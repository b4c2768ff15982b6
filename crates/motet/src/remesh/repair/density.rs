//! The number of vertices kept: long edges divided where vertices lack, short ones collapsed where there are too many.
//!
//! Repair inserts vertices, and takes others out, where that mends a tet. Without a memory of how many there were, a mesh that is repaired in each step grows or thins without end.
//! How long an edge is is judged by the sizes that were remembered: those of the mesh as it was at first.

use std::sync::Arc;

use crate::base::{Result, TetId, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, scale};
use crate::kernel::{Change, Hold};
use crate::ops::{collapse, defect};
use crate::remesh::given::Given;
use crate::remesh::repair::Repair;
use crate::remesh::report::Operation;
use crate::remesh::sizes::{SHORT, SizeField, Sizes};

/// So many vertices too many, or too few, are no reason to act.
const TOLERANCE: isize = 2;
/// Where vertices lack, edges longer than this part of their size are divided, the longest first; ...
const LONG_IF_LACKING: f64 = 1.2;
/// ... longer than this also where none lacks, so no collapse makes an edge longer. While collapses made none longer than 1.5, a cylinder whose rims have edges a tenth as long as its
/// sizes gained 4.5 % of vertices in a turn; ...
const LONG: f64 = 2.0;
/// ... and only longer than this where there are too many.
const LONG_IF_CROWDED: f64 = 3.0;
/// Where there are too many vertices, edges shorter than this part of their size are collapsed, the shortest first; shorter than [`SHORT`] anywhere.
const SHORT_IF_CROWDED: f64 = 0.95;
/// With more than this part of the vertices too many, or too few, edges are looked for in all of the mesh and not near changes alone.
const FAR_OFF: f64 = 0.005;
/// An insertion looks for a place at which no tet is below this EAS.
const GOOD: f64 = 0.5;

/// What is to be kept.
pub(in crate::remesh) struct Density {
    /// How long edges are to be.
    field: SizeField,
    /// How many vertices that nothing holds there are to be.
    n_free: usize,
}

impl Density {
    /// `sizes`: of each vertex of the mesh that was given.
    pub(in crate::remesh) fn new(sizes: &[f64], given: &Arc<Given>, n_free: usize) -> Self {
        let sizes = Sizes::Vertices(sizes.to_vec());
        Self { field: SizeField::new(&sizes, || given.clone(), LONG), n_free }
    }
}

/// An edge, its length as a part of its size, and a tet that has it or had it.
struct Edge {
    ratio: f64,
    ends: [VertexId; 2],
    tet: TetId,
}

impl Repair {
    /// Collapses and divides edges, near the tets of a zone where that is enough, until there are as many vertices as there are to be; adds the tets that came to the zone. No tet goes below
    /// the EAS `floor`.
    pub(in crate::remesh) fn keep_density(
        &mut self,
        density: &mut Density,
        floor: f64,
        zone: &mut Vec<TetId>,
    ) -> Result<()> {
        let mut lack = density.n_free as isize - self.complex.n_free_vertices() as isize;
        let is_far_off = lack.unsigned_abs() as f64 > FAR_OFF * density.n_free as f64;
        let edges = if is_far_off {
            self.sorted_edges(self.complex.tets(), &mut density.field)
        } else {
            self.sorted_edges(zone.iter().copied().filter(|&t| self.complex.is_alive(t)), &mut density.field)
        };
        for (i, edge) in edges.iter().enumerate() {
            let shortest = if lack < -TOLERANCE { SHORT_IF_CROWDED } else { SHORT };
            if edge.ratio >= shortest {
                break;
            }
            self.watch.go_on("collapsing short edges", i, edges.len())?;
            lack += isize::from(self.collapse_crowded(edge, floor, &mut density.field, zone));
        }
        for (i, edge) in edges.iter().rev().enumerate() {
            let longest = match lack {
                _ if lack > TOLERANCE => LONG_IF_LACKING,
                _ if lack < -TOLERANCE => LONG_IF_CROWDED,
                _ => LONG,
            };
            if edge.ratio <= longest {
                break;
            }
            self.watch.go_on("splitting long edges", i, edges.len())?;
            lack -= isize::from(self.insert_on(edge, floor, zone));
        }
        Ok(())
    }

    /// The edges of tets that may be changed, each once, the shortest for its size first.
    fn sorted_edges(&self, tets: impl Iterator<Item = TetId>, field: &mut SizeField) -> Vec<Edge> {
        let mut edges = Vec::new();
        for tet in tets.filter(|&t| !self.complex.is_locked(t)) {
            let vertices = self.complex.vertices(tet);
            for [a, b] in EDGES.map(|e| e.map(|i| vertices[i])) {
                let ends = [a.min(b), a.max(b)];
                edges.push(Edge { ratio: field.of_edge(&self.complex, ends), ends, tet });
            }
        }
        edges.sort_unstable_by_key(|edge| (edge.ends, edge.tet));
        edges.dedup_by_key(|edge| edge.ends);
        edges.sort_unstable_by(|x, y| x.ratio.total_cmp(&y.ratio).then(x.ends.cmp(&y.ends)));
        edges
    }

    fn has(&self, &Edge { ends, tet, .. }: &Edge) -> bool {
        self.complex.is_alive(tet) && ends.iter().all(|v| self.complex.vertices(tet).contains(v))
    }

    /// Draws the end of an edge that nothing holds into the other one, the better of both ways, if no edge becomes too long.
    fn collapse_crowded(
        &mut self,
        edge: &Edge,
        floor: f64,
        field: &mut SizeField,
        zone: &mut Vec<TetId>,
    ) -> bool {
        if !self.has(edge) {
            return false;
        }
        let [a, b] = edge.ends;
        let mut best: Option<(f64, Change)> = None;
        for [removed, kept] in [[a, b], [b, a]] {
            if self.complex.hold(removed) != Hold::Free {
                continue;
            }
            self.star.gather(&self.complex, removed);
            let bar = self.complex.worst_of(&self.star.tets).min(floor).next_down();
            let mut change = Change::default();
            if collapse(&self.complex, &self.star.tets, removed, kept, bar, &mut change)
                && field.lengthens_none(&self.complex, &change)
                && self.complex.check_against(&change, bar).is_ok()
            {
                let sum: f64 = change.fill.iter().map(|tet| defect(tet.quality)).sum();
                let defects = sum / change.fill.len() as f64;
                if best.as_ref().is_none_or(|(least, _)| defects < *least) {
                    best = Some((defects, change));
                }
            }
        }
        let is_made = best.is_some_and(|(_, change)| self.commit_above(&change, floor, zone));
        if is_made {
            self.operations.add(Operation::Collapse);
        }
        is_made
    }

    /// Puts a vertex near the middle of an edge that lies inside.
    fn insert_on(&mut self, edge: &Edge, floor: f64, zone: &mut Vec<TetId>) -> bool {
        let [a, b] = edge.ends;
        if !self.has(edge) || !self.complex.may_divide(a, b) {
            return false;
        }
        self.shells[0].walk(&self.complex, edge.tet, a, b);
        if !self.shells[0].is_free() {
            return false;
        }
        let seed = &self.shells[0].tets;
        let bar = self.complex.worst_of(seed).min(floor).next_down();
        let middle = scale(add(self.complex.point(a), self.complex.point(b)), 0.5);
        let mut change = Change::default();
        let is_made =
            self.insertion.propose(&self.complex, seed, middle, [bar, GOOD.max(floor)], &mut change)
                && self.commit_above(&change, floor, zone);
        if is_made {
            self.operations.add(Operation::Insertion);
        }
        is_made
    }
}
