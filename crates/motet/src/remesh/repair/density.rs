//! Keeps the number of vertices: long edges are divided where vertices are lacking, short ones collapsed
//! where there are too many.
//!
//! Repair inserts and removes vertices where that repairs a tet. Without a record of how many there were, a
//! mesh that is repaired in each step would grow or thin out without end. Edge lengths are judged by
//! remembered sizes: those of the mesh as it was at first.

use crate::base::{Result, TetId, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, scale};
use crate::kernel::Hold;
use crate::ops::{collapse, defect};
use crate::remesh::input_mesh::InputMesh;
use crate::remesh::options;
use crate::remesh::repair::Repair;
use crate::remesh::repair::search::{Search, Tools, has_edge};
use crate::remesh::repair::trial::{Merit, Rules};
use crate::remesh::report::Operation;
use crate::remesh::sizes::{SHORT, SizeField, Sizes, SizesIn};

/// A surplus or lack of up to this many vertices is tolerated.
const TOLERANCE: isize = 2;
/// Where vertices are lacking, edges longer than this multiple of their size are divided, longest first; ...
const LONG_IF_LACKING: f64 = 1.2;
/// ... edges longer than this even where none is lacking, so that no collapse makes an edge longer. When
/// collapses made none longer than 1.5, a cylinder whose rims have edges a tenth as long as its sizes gained
/// 4.5 % of vertices per turn; ...
const LONG: f64 = 2.0;
/// ... and only edges longer than this where there are too many.
const LONG_IF_CROWDED: f64 = 3.0;
/// Where there are too many vertices, edges shorter than this fraction of their size are collapsed, shortest
/// first; those shorter than [`SHORT`] are collapsed anywhere.
const SHORT_IF_CROWDED: f64 = 0.95;
/// An insertion looks for a place where no tet is below this EAS.
const GOOD: f64 = 0.5;

/// The number of vertices to keep, and their distribution.
pub(in crate::remesh) struct Density {
    /// Requested edge lengths.
    field: SizeField,
    /// How many free vertices the mesh is to have.
    n_free: usize,
}

impl Density {
    /// The density with these sizes at the vertices of the given mesh, which has `n_free` free ones.
    pub(in crate::remesh) fn new(sizes: &[f64], input: &InputMesh, n_free: usize, lack: isize) -> Self {
        let sizes = Sizes::Vertices(sizes.to_vec());
        Self { field: SizeField::new(&sizes, input, LONG), n_free: n_free.saturating_add_signed(lack) }
    }
}

/// An edge, its length divided by its size, and a tet that has it or had it.
struct Edge {
    ratio: f64,
    ends: [VertexId; 2],
    tet: TetId,
}

impl Repair<'_> {
    /// Collapses and divides edges, near the tets of a zone if that is enough, until the number of vertices
    /// is as requested; adds the inserted tets to the zone. No tet falls below the EAS `floor`.
    pub(in crate::remesh) fn keep_density(
        &mut self,
        density: &mut Density,
        floor: f64,
        zone: &mut Vec<TetId>,
    ) -> Result<()> {
        let mut tools = self.toolbox.take();
        let field = &mut density.field;
        let mut lack = density.n_free as isize - self.complex.n_free_vertices() as isize;
        let n_outside = self.outside.map_or(0, |outside| outside.free_vertices);
        let edges = if options::Density::is_far_off(lack, density.n_free + n_outside) {
            self.sorted_edges(self.complex.tets(), field)
        } else {
            self.sorted_edges(zone.iter().copied().filter(|&t| self.complex.is_alive(t)), field)
        };
        for (i, edge) in edges.iter().enumerate() {
            let shortest = if lack < -TOLERANCE { SHORT_IF_CROWDED } else { SHORT };
            if edge.ratio >= shortest {
                break;
            }
            self.threads.watch().report_and_check("collapsing short edges", i, edges.len())?;
            Search::new(self, &mut tools).collapse_crowded(edge, floor, field);
            let trial = &mut tools.best;
            if trial.commit(self) {
                lack += 1;
                zone.extend_from_slice(trial.inserted());
            }
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
            self.threads.watch().report_and_check("splitting long edges", i, edges.len())?;
            Search::new(self, &mut tools).insert_on(edge, floor);
            let trial = &mut tools.first;
            if trial.commit(self) {
                lack -= 1;
                zone.extend_from_slice(trial.inserted());
            }
        }
        self.toolbox.put_back(tools);
        Ok(())
    }

    /// The edges of tets that may be changed, each once, by rising ratio of length to size.
    fn sorted_edges(&self, tets: impl Iterator<Item = TetId>, field: &mut SizeField) -> Vec<Edge> {
        let mut edges = Vec::new();
        for tet in tets.filter(|&t| !self.complex.is_locked(t)) {
            let vertices = self.complex.vertices(tet);
            field.learn(&self.complex, &self.input, [tet]);
            let sizes = SizesIn { field, input: &self.input, complex: &self.complex };
            for [a, b] in EDGES.map(|e| e.map(|i| vertices[i])) {
                let ends = [a.min(b), a.max(b)];
                edges.push(Edge { ratio: sizes.of_edge(ends), ends, tet });
            }
        }
        edges.sort_unstable_by_key(|edge| (edge.ends, edge.tet));
        edges.dedup_by_key(|edge| edge.ends);
        edges.sort_unstable_by(|x, y| x.ratio.total_cmp(&y.ratio).then(x.ends.cmp(&y.ends)));
        edges
    }
}

impl Search<'_> {
    /// Searches for the better of the collapses of an edge towards its ends for which the removed vertex is
    /// free and no edge becomes too long.
    fn collapse_crowded(&mut self, edge: &Edge, floor: f64, field: &SizeField) {
        let (complex, input) = (self.complex(), &self.repair.input);
        let sizes = SizesIn { field, input, complex };
        if !has_edge(complex, edge.tet, edge.ends) {
            return;
        }
        let [a, b] = edge.ends;
        for [removed, kept] in [[a, b], [b, a]] {
            if complex.hold(removed) != Hold::Free {
                continue;
            }
            self.gather(removed);
            let Tools { star, best, .. } = &mut *self.tools;
            let bar = complex.worst_of(&star.tets).min(floor).next_down();
            if collapse(complex, &star.tets, removed, kept, bar, &mut best.proposal) {
                best.offer(Rules::of(complex).not_longer(sizes), |proposal, least| {
                    let sum: f64 = proposal.fill.iter().map(|tet| defect(tet.quality)).sum();
                    let score = sum / proposal.fill.len() as f64;
                    let is_better = least.is_none_or(|least| score < least);
                    is_better.then_some(Merit { operation: Operation::Collapse, score, bar })
                });
            }
        }
    }

    /// Searches for an insertion near the midpoint of an edge inside the volume.
    fn insert_on(&mut self, edge: &Edge, floor: f64) {
        let ([a, b], complex) = (edge.ends, self.complex());
        if !has_edge(complex, edge.tet, edge.ends) || !complex.may_divide(a, b) {
            return;
        }
        let middle = scale(add(complex.point(a), complex.point(b)), 0.5);
        self.around(edge.tet, [a, b], |search, shell| {
            let Tools { insertion, first, .. } = &mut *search.tools;
            let bar_of = |tets: &[TetId]| complex.worst_of(tets).min(floor).next_down();
            let bars = [bar_of(&shell.tets), GOOD.max(floor)];
            if shell.is_free() && insertion.propose(complex, &shell.tets, middle, bars, &mut first.proposal) {
                first.offer(Rules::at_commit(complex), |proposal, _| {
                    let bar = bar_of(&proposal.cavity);
                    Some(Merit { operation: Operation::Insertion, score: (), bar })
                });
            }
        });
    }
}
