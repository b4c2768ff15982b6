//! Divides triangles where they meet, so that what they have in common is vertices, edges and whole triangles
//! of both.
//!
//! | step | file | how |
//! |---|---|---|
//! | pairs | `common` | points that two triangles have in common, identified by their origin: a vertex, two edges, an edge and a triangle |
//! | points | `points` | each point once, whichever pairs have found it; assigned to edges and triangles |
//! | pieces | `plane` | each triangle, divided at its points and segments |
//!
//! Points have keys, so pieces match by their ids, whatever rounding does to coordinates. Points nearer than
//! a given distance are one place. If three triangles cross in one point, two of them are divided along one
//! segment first; the next round divides their pieces, of which that segment is an edge. Exact signs decide
//! at the end whether the pieces meet only in what they share.

mod common;
mod meeting;
mod plane;
mod points;

use std::sync::atomic::{AtomicUsize, Ordering};

use crate::base::{Csr, Point, Threads, VertexId, sorted_ids};
use crate::geometry::vector::distance;
use crate::preflight::crossing::crossings_of;
use crate::preflight::renamed;
use crate::spatial::runs::{bounding_box, corners, in_runs};
use crate::spatial::{BoxTree, expanded};
use common::{Common, NumberedTriangle};
pub(crate) use meeting::{Meeting, MeetingKind};
use points::Points;

/// Largest number of rounds: if pieces still meet then, dividing fails.
const ROUNDS: usize = 8;

/// Largest number of pairs of triangles that are divided: more take too much memory.
const MAX_PAIRS: usize = 2_000_000;

/// Limits of the check of divided triangles: it stops if the boxes of more pairs of pieces touch than the
/// first number per piece, or than the second number where that is more. So many touch only in a soup of
/// triangles that nearly all cross each other, and the exact signs of all these pairs take minutes.
const MAX_TOUCHING_PAIRS: (usize, usize) = (100, 200_000);

/// Which triangles are divided where they meet.
pub(crate) struct Rule<'a> {
    /// The group of each triangle.
    pub(crate) group_of: &'a [u32],
    /// Whether triangles of two groups are compared.
    pub(crate) admits: &'a (dyn Fn(u32, u32) -> bool + Sync),
    /// Points nearer than this are one place.
    pub(crate) near: f64,
    /// Whether triangles that cross are divided too, or only those that touch or overlap.
    pub(crate) crossings: bool,
}

/// The result of dividing triangles.
#[derive(Clone, Debug, Default)]
pub(crate) struct Cut {
    /// The given points, then new ones.
    pub(crate) points: Vec<Point>,
    /// The pieces, oriented like the triangles, each with the triangle that it is or is part of; in the order
    /// of the triangles.
    pub(crate) pieces: Vec<([VertexId; 3], u32)>,
    /// The vertex that each given point has become.
    pub(crate) vertex_to_kept: Vec<VertexId>,
    /// Where triangles met.
    pub(crate) meetings: Vec<Meeting>,
}

/// A pair of triangles, and what they have in common besides corners of both.
type Pair = ([u32; 2], Common);

impl Cut {
    /// Divides triangles by a rule. `None` if there are too many pairs, or if pieces of triangles that are
    /// compared would still meet in more than they share.
    ///
    /// Of two vertices at one place, the one of smaller id stays.
    pub(crate) fn new(
        points: &[Point],
        triangles: &[[VertexId; 3]],
        rule: &Rule,
        threads: &Threads,
    ) -> Option<Self> {
        let mut cut = Self {
            points: points.to_vec(),
            pieces: triangles.iter().copied().zip(0..).collect(),
            vertex_to_kept: (0..points.len()).map(VertexId::new).collect(),
            meetings: Vec::new(),
        };
        for _ in 0..ROUNDS {
            cut.join_vertices(rule);
            let pairs = cut.pairs(rule, threads)?;
            cut.round(&pairs, rule.near)?;
            let max_pairs = if pairs.is_empty() { usize::MAX } else { cut.max_compared_pairs() };
            if cut.is_sound(rule, max_pairs, threads)? {
                meeting::sort(&mut cut.meetings);
                return Some(cut);
            }
            if pairs.is_empty() {
                break;
            }
        }
        None
    }

    fn triangles(&self) -> Vec<[VertexId; 3]> {
        self.pieces.iter().map(|piece| piece.0).collect()
    }

    /// Divides all pieces once.
    fn round(&mut self, pairs: &[Pair], near: f64) -> Option<()> {
        if pairs.is_empty() {
            return Some(());
        }
        let (triangles, n_given) = (self.triangles(), self.vertex_to_kept.len());
        let found = Points::new(&self.points, &triangles, pairs, near);
        let origin = |number: u32| self.pieces[number as usize].1;
        self.meetings.extend(meeting::of_pairs(pairs, origin));
        self.meetings.extend(meeting::of_edges(&found, n_given, &self.points));
        let divided = found.divide(pairs)?;
        let pieces = divided.pieces.into_iter().map(|(piece, t)| (piece, self.pieces[t as usize].1));
        self.pieces = pieces.collect();
        self.points = divided.points;
        self.vertex_to_kept.iter_mut().for_each(|v| *v = divided.merged_into[v.index()]);
        Some(())
    }

    /// Merges vertices at one place, and removes pieces that this leaves without area.
    fn join_vertices(&mut self, rule: &Rule) {
        let vertex_to_kept = joined(&self.points, &self.pieces, rule);
        let renumbered = renamed(&self.triangles(), &vertex_to_kept);
        self.pieces.iter_mut().zip(renumbered).for_each(|(piece, new)| piece.0 = new);
        self.pieces.retain(|([a, b, c], _)| a != b && b != c && c != a);
        self.vertex_to_kept.iter_mut().for_each(|v| *v = vertex_to_kept[v.index()]);
    }

    /// The pairs of pieces that have to be divided. `None` if there are too many.
    fn pairs(&self, rule: &Rule, threads: &Threads) -> Option<Vec<Pair>> {
        let corners = |i: usize| corners(&self.points, self.pieces[i].0);
        let boxes: Vec<_> =
            (0..self.pieces.len()).map(|i| expanded(bounding_box(&corners(i)), rule.near)).collect();
        let (tree, n_found) = (BoxTree::new(&boxes), AtomicUsize::new(0));
        let triangle = |i: usize| {
            let (vertices, number) = (self.pieces[i].0, i as u32);
            NumberedTriangle { number, vertices, corners: corners(i) }
        };
        let group = |i: usize| rule.group_of[self.pieces[i].1 as usize];
        let found = in_runs(self.pieces.len(), threads, |touching, run| {
            let mut found = Vec::new();
            for i in run {
                tree.touching(bounding_box(&corners(i)), touching);
                for &j in
                    touching.iter().filter(|&&j| i < j as usize && (rule.admits)(group(i), group(j as usize)))
                {
                    if n_found.load(Ordering::Relaxed) > MAX_PAIRS {
                        return found;
                    }
                    let common = Common::of(&triangle(i), &triangle(j as usize), rule.near);
                    let wanted = |common: &Common| {
                        common.needs_division() && (rule.crossings || !common.is_crossing())
                    };
                    if let Some(common) = common.filter(wanted) {
                        n_found.fetch_add(1, Ordering::Relaxed);
                        found.push(([i as u32, j], common));
                    }
                }
            }
            found
        });
        (n_found.into_inner() <= MAX_PAIRS).then_some(found)
    }

    /// The largest number of pairs of pieces with touching boxes that are compared.
    fn max_compared_pairs(&self) -> usize {
        MAX_TOUCHING_PAIRS.1.max(MAX_TOUCHING_PAIRS.0 * self.pieces.len())
    }

    /// Whether pieces meet only in what they share, or are the same triangle; or cross, if the rule leaves
    /// crossings. `None` if the boxes of more than `max_pairs` pairs touch.
    fn is_sound(&self, rule: &Rule, max_pairs: usize, threads: &Threads) -> Option<bool> {
        let n_compared = AtomicUsize::new(0);
        let group = |i: u32| rule.group_of[self.pieces[i as usize].1 as usize];
        let all = self.triangles();
        let admit = |i: u32, j: u32| {
            i < j
                && n_compared.fetch_add(1, Ordering::Relaxed) < max_pairs
                && (rule.admits)(group(i), group(j))
        };
        let is_same = |&[i, j]: &[u32; 2]| sorted_ids(all[i as usize]) == sorted_ids(all[j as usize]);
        let crossings = crossings_of(&self.points, [&all, &all], threads, admit);
        let is_allowed = |pair: &[u32; 2]| is_same(pair) || !rule.crossings && self.crosses(*pair, rule.near);
        (n_compared.into_inner() <= max_pairs).then(|| crossings.iter().all(is_allowed))
    }

    /// Whether two pieces cross.
    fn crosses(&self, pair: [u32; 2], near: f64) -> bool {
        let [a, b] = pair.map(|number| {
            let vertices = self.pieces[number as usize].0;
            NumberedTriangle { number, vertices, corners: corners(&self.points, vertices) }
        });
        Common::of(&a, &b, near).is_some_and(|common| common.is_crossing())
    }
}

/// For each vertex that pieces use, the one that replaces it: the nearest of smaller id at its place, of a
/// group that is compared with its own.
fn joined(points: &[Point], pieces: &[([VertexId; 3], u32)], rule: &Rule) -> Vec<VertexId> {
    let mut groups: Vec<(VertexId, u32)> =
        pieces.iter().flat_map(|(t, origin)| t.map(|v| (v, rule.group_of[*origin as usize]))).collect();
    groups.sort_unstable();
    groups.dedup();
    let groups = Csr::from_pairs(points.len(), || groups.iter().map(|(v, group)| (v.index(), *group)));
    let used: Vec<usize> = (0..points.len()).filter(|&v| !groups.list(v).is_empty()).collect();
    let boxes: Vec<_> = used.iter().map(|&v| [points[v]; 2]).collect();
    let (tree, mut touching) = (BoxTree::new(&boxes), Vec::new());
    let mut vertex_to_kept: Vec<VertexId> = (0..points.len()).map(VertexId::new).collect();
    for &v in &used {
        tree.touching(expanded([points[v]; 2], rule.near), &mut touching);
        let admits =
            |w: usize| groups.list(v).iter().any(|&g| groups.list(w).iter().any(|&h| (rule.admits)(g, h)));
        let off = |w: usize| distance(points[v], points[w]);
        let others = touching.iter().map(|&i| used[i as usize]).filter(|&w| w < v && off(w) <= rule.near);
        let nearest = others.filter(|&w| admits(w)).min_by(|&w, &u| off(w).total_cmp(&off(u)));
        vertex_to_kept[v] = nearest.map_or(vertex_to_kept[v], |w| vertex_to_kept[w]);
    }
    vertex_to_kept
}
