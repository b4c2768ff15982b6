//! Which tets are divided and which edges split beyond what was asked, so that all fit together and none is badly shaped.
//!
//! What holds at the end follows from what was asked alone: each sweep looks at all tets as the sweep before left them. So no order of visiting, no
//! number of threads and no earlier division changes it, and taking back what was asked brings back the mesh that was there before.

use super::forest::{Forest, NONE, with_middles};
use super::patterns::{FULL, patterns};
use crate::base::{Point, Threads};
use crate::geometry::quality::eas;
use crate::geometry::vector::{dot, sub};

/// What shapes closing may leave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Need {
    /// No tet below this EAS.
    pub(super) floor: f64,
    /// Nor below this part of that of the tet that it is a piece of.
    pub(super) share: f64,
}

impl Need {
    fn of(self, whole: f64) -> f64 {
        self.floor.max(self.share * whole)
    }
}

/// A tet cut to fit its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    pub(super) node: u32,
    /// Its split edges, the cuts of its facets, and which of the ways to fill it.
    pub(super) mask: u8,
    pub(super) cuts: u8,
    pub(super) way: u8,
}

/// What one tet needs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Fits,
    /// More of its edges split.
    Grow(u8),
    Divide,
}

/// What closing came to.
#[derive(Debug, Default)]
pub(super) struct Closed {
    /// Tets that are cut, rising.
    pub(super) cuts: Vec<Cut>,
    /// How many were divided that nobody asked for.
    pub(super) n_promoted: usize,
    pub(super) n_sweeps: usize,
}

/// Divides what is asked, and what that asks for.
pub(super) fn close(forest: &mut Forest, need: Need, threads: &Threads) -> Closed {
    forest.edges.iter_mut().for_each(|edge| edge.is_split = false);
    forest.nodes.iter_mut().for_each(|node| node.is_divided = false);
    for node in 0..forest.nodes.len() as u32 {
        if forest.nodes[node as usize].is_asked {
            divide(forest, node, need);
        }
    }
    let mut leaves: Vec<u32> = (0..forest.nodes.len() as u32).filter(|&node| forest.is_leaf(node)).collect();
    let mut closed = Closed::default();
    // The split edges for which each tet was looked at last.
    let mut seen = vec![0u8; forest.nodes.len()];
    loop {
        closed.n_sweeps += 1;
        let shared: &Forest = forest;
        let verdicts =
            threads.map(leaves.len(), |i| verdict(shared, leaves[i], seen[leaves[i] as usize], need));
        if verdicts.iter().all(|verdict| *verdict == Verdict::Fits) {
            break;
        }
        for &leaf in &leaves {
            seen[leaf as usize] = forest.mask(leaf);
        }
        let mut came = Vec::new();
        for (&leaf, verdict) in leaves.iter().zip(&verdicts) {
            match *verdict {
                Verdict::Fits => {}
                Verdict::Grow(mask) => {
                    let edges = forest.nodes[leaf as usize].edges;
                    for (_, edge) in edges.into_iter().enumerate().filter(|(e, _)| mask >> e & 1 == 1) {
                        forest.middle(edge);
                        forest.edges[edge as usize].is_split = true;
                    }
                }
                Verdict::Divide => {
                    closed.n_promoted += 1;
                    let first = divide(forest, leaf, need);
                    came.extend(first..first + 8);
                }
            }
        }
        leaves.retain(|&leaf| !forest.nodes[leaf as usize].is_divided);
        leaves.extend(came);
        seen.resize(forest.nodes.len(), 0);
    }
    leaves.sort_unstable();
    let shared: &Forest = forest;
    let cuts = threads.map(leaves.len(), |i| cut(shared, leaves[i]));
    closed.cuts = cuts.into_iter().flatten().collect();
    closed
}

fn divide(forest: &mut Forest, node: u32, need: Need) -> u32 {
    let first = forest.divide(node, |forest| diagonal(&forest.places(node), need.floor));
    for edge in forest.nodes[node as usize].edges {
        forest.edges[edge as usize].is_split = true;
    }
    first
}

fn verdict(forest: &Forest, leaf: u32, seen: u8, need: Need) -> Verdict {
    let mask = forest.mask(leaf);
    if mask == 0 {
        return Verdict::Fits;
    }
    if mask == FULL || forest.is_split_within(leaf, mask) {
        return Verdict::Divide;
    }
    if mask == seen {
        return Verdict::Fits;
    }
    let places = forest.places(leaf);
    let whole = eas(forest.corners(leaf));
    let need = need.of(whole);
    let (_, _, worst) = best_cut(forest, leaf, mask, &places);
    if worst >= need {
        return Verdict::Fits;
    }
    // The fewest edges more, then the best shape.
    let larger = (mask + 1..FULL).filter(|m| m & mask == mask);
    let good = larger.map(|m| (m, best_cut(forest, leaf, m, &places).2)).filter(|(_, worst)| *worst >= need);
    let better = |x: (u8, f64), y: (u8, f64)| {
        let order = x.0.count_ones().cmp(&y.0.count_ones()).then(y.1.total_cmp(&x.1));
        if order.is_le() { x } else { y }
    };
    match good.reduce(better) {
        Some((mask, _)) => Verdict::Grow(mask),
        None if worst_of_eight(&places, diagonal(&places, need)) > worst => Verdict::Divide,
        None => Verdict::Fits,
    }
}

/// The cut of a tet that has split edges.
fn cut(forest: &Forest, leaf: u32) -> Option<Cut> {
    let mask = forest.mask(leaf);
    if mask == 0 {
        return None;
    }
    let (cuts, way, _) = best_cut(forest, leaf, mask, &forest.places(leaf));
    Some(Cut { node: leaf, mask, cuts, way })
}

/// Of all ways to fill a tet with these edges split the one whose worst tet is best, with the cuts of the facets and that EAS.
fn best_cut(forest: &Forest, leaf: u32, mask: u8, places: &[Point; 10]) -> (u8, u8, f64) {
    let cuts = forest.cuts(leaf, mask);
    let worst = |way: &Vec<[u8; 4]>| worst_of(places, way);
    let ways = patterns(mask, cuts).iter().zip(0u8..);
    let best = ways.map(|(way, k)| (k, worst(way))).reduce(|x, y| if y.1 > x.1 { y } else { x });
    let (way, worst) = best.unwrap_or((0, f64::NEG_INFINITY));
    (cuts, way, worst)
}

fn worst_of(places: &[Point; 10], tets: &[[u8; 4]]) -> f64 {
    tets.iter().map(|tet| eas(tet.map(|v| places[usize::from(v)]))).fold(f64::INFINITY, f64::min)
}

fn worst_of_eight(places: &[Point; 10], way: usize) -> f64 {
    worst_of(places, &patterns(FULL, 0)[way])
}

/// Which of the three ways to divide a tet into eight: along the shortest diagonal of the octahedron (Zhang 1995, *Successive
/// subdivisions of tetrahedra and multigrid methods on tetrahedral meshes*), unless one of the eight, or of theirs, is then below
/// the floor: then along the one that leaves the best.
fn diagonal(places: &[Point; 10], floor: f64) -> usize {
    let length = |way: usize| {
        let [p, q] = ends(way).map(|v| places[v]);
        let along = sub(q, p);
        dot(along, along)
    };
    let shortest = (0..3).reduce(|x, y| if length(y) < length(x) { y } else { x }).unwrap_or(0);
    // Two generations hardly more than halve the quality.
    let worst = worst_of_eight(places, shortest);
    if worst >= 2.0 * floor || worst >= floor && worst_below(places, shortest, 1) >= floor {
        return shortest;
    }
    let worst = [0, 1, 2].map(|way| worst_below(places, way, 2));
    (0..3).reduce(|x, y| if worst[y] > worst[x] { y } else { x }).unwrap_or(shortest)
}

/// The worst of the eight and of so many generations below, each along its best diagonal.
fn worst_below(places: &[Point; 10], way: usize, generations: usize) -> f64 {
    let pattern = &patterns(FULL, 0)[way];
    let worst = worst_of(places, pattern);
    if generations == 0 {
        return worst;
    }
    // Those at the corners have the shape of the whole.
    let inner = pattern.iter().filter(|tet| tet.iter().all(|v| *v >= 4));
    inner.fold(worst, |worst, tet| {
        let places = with_middles(tet.map(|v| places[usize::from(v)]));
        let below =
            (0..3).map(|way| worst_below(&places, way, generations - 1)).fold(f64::NEG_INFINITY, f64::max);
        worst.min(below)
    })
}

/// The local vertices at the ends of the diagonal of each way.
fn ends(way: usize) -> [usize; 2] {
    let pattern = &patterns(FULL, 0)[way];
    let has =
        |e: usize| pattern.iter().any(|tet| tet.contains(&(4 + e as u8)) && tet.contains(&(9 - e as u8)));
    (0..3).find(|&e| has(e)).map_or([4, 9], |e| [4 + e, 9 - e])
}

impl Forest {
    /// Whether a tet is there and not divided.
    pub(super) fn is_leaf(&self, node: u32) -> bool {
        let node = &self.nodes[node as usize];
        !node.is_divided && (node.parent == NONE || self.nodes[node.parent as usize].is_divided)
    }

    /// Whether an edge is split that only appears when the tet is divided: half of a split edge, or one between the middles of
    /// two edges of a facet.
    fn is_split_within(&self, leaf: u32, mask: u8) -> bool {
        let edges = self.nodes[leaf as usize].edges;
        let is_split = |edge: u32| edge != NONE && self.edges[edge as usize].is_split;
        let split = (0..6).filter(|e| mask >> e & 1 == 1);
        if split.clone().any(|e| self.edges[edges[e] as usize].halves.into_iter().any(is_split)) {
            return true;
        }
        (0..4).any(|facet| {
            let (split, n) = super::patterns::split_edges(facet, mask);
            (0..n).any(|i| {
                (0..i).any(|j| {
                    let ends = [split[i], split[j]].map(|e| self.edges[edges[e] as usize].middle);
                    self.known_edge(ends).is_some_and(is_split)
                })
            })
        })
    }
}
