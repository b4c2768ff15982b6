//! Which tets are divided and which edges split beyond what was asked, so that all fit together and none is badly shaped.
//!
//! What holds at the end follows from what was asked alone: each sweep looks at all tets as the sweep before left them. So no order of visiting, no
//! number of threads and no earlier division changes it, and taking back what was asked brings back the mesh that was there before.

use super::bey;
use super::forest::{Forest, NONE, with_middles};
use super::handle::{Options, Rule};
use super::patterns::{FACET_EDGES, FULL, ends, inner_tets, patterns};
use crate::base::{Error, Point, Result, Threads};
use crate::geometry::quality::eas;
use crate::geometry::vector::{dot, sub};

/// No more is asked of a piece than this part of the median EAS of the roots.
const OF_MEDIAN: f64 = 0.55;

/// What shapes closing may leave.
#[derive(Clone, Copy, Debug)]
pub(super) struct Need {
    /// No tet below this EAS.
    pub(super) floor: f64,
    /// No piece of a tet that is cut below this.
    of_pieces: f64,
    /// Nor below this part of what dividing the tet leaves.
    share: f64,
    rule: Rule,
}

impl Need {
    /// The floor is a part of the worst EAS of the roots. Of pieces no more is asked than of those of the median root: in a lattice all tets are as bad as the
    /// worst, no piece is as good as the whole, and everything would be divided.
    pub(super) fn new(options: Options, forest: &Forest) -> Self {
        let mut shapes: Vec<f64> = forest.nodes[..forest.n_roots].iter().map(|root| root.eas).collect();
        shapes.sort_unstable_by(f64::total_cmp);
        let (worst, median) = (shapes.first().unwrap_or(&0.0), shapes.get(shapes.len() / 2).unwrap_or(&0.0));
        let floor = options.keep * worst;
        Self { floor, of_pieces: floor.min(OF_MEDIAN * median), share: options.share, rule: options.rule }
    }

    /// What pieces of a tet have to be that could be divided into eight of this EAS or better.
    fn of(self, divided: f64) -> f64 {
        self.of_pieces.max(self.share * divided)
    }
}

/// A tet cut to fit its neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    pub(super) node: u32,
    pub(super) goal: Goal,
}

/// What a tet with some edges split needs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Goal {
    /// Which edges split: the same where it fits, more where it has to grow, all where it has to be divided.
    pub(super) mask: u8,
    /// The cuts of its facets, and which of the ways to fill it, where it fits.
    pub(super) cuts: u8,
    pub(super) way: u8,
}

/// What a sweep says of a tet with split edges.
#[derive(Clone, Copy, Debug)]
struct Verdict {
    /// Its place among the leaves.
    leaf: usize,
    mask: u8,
    goal: Goal,
    /// Whether shapes were looked at, which is worth remembering.
    is_new: bool,
}

/// Tets that a thread looks at in one go.
const RUN: usize = 4096;

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
///
/// # Errors
/// When the forest would have more tets than it may.
pub(super) fn close(forest: &mut Forest, need: Need, threads: &Threads) -> Result<Closed> {
    forest.begin_anew();
    for node in 0..forest.nodes.len() as u32 {
        if forest.states[node as usize].is_asked {
            forest.check_room()?;
            divide(forest, node, need);
        }
    }
    let mut leaves = forest.leaves();
    let mut closed = Closed::default();
    loop {
        closed.n_sweeps += 1;
        let shared: &Forest = forest;
        let verdicts = threads.in_runs(leaves.len(), RUN, |(): &mut (), run| {
            run.filter_map(|i| match shared.mask(leaves[i]) {
                0 => None,
                mask => Some(verdict(shared, i, leaves[i], mask, need)),
            })
            .collect()
        });
        let mut is_done = true;
        let mut gone = Vec::new();
        for &Verdict { leaf: i, mask, goal, is_new } in &verdicts {
            let leaf = leaves[i];
            if is_new {
                forest.goals.insert((leaf, mask), goal);
            }
            if goal.mask == FULL {
                closed.n_promoted += 1;
                forest.check_room()?;
                let first = divide(forest, leaf, need);
                leaves.extend(first..first + 8);
                gone.push(i);
            } else if goal.mask != mask {
                let edges = forest.edges_of[leaf as usize];
                for (_, edge) in edges.into_iter().enumerate().filter(|(e, _)| goal.mask >> e & 1 == 1) {
                    forest.middle(edge);
                    forest.is_split[edge as usize] = true;
                }
            }
            is_done &= goal.mask == mask && mask != FULL;
        }
        if is_done {
            let cut = |verdict: &Verdict| Cut { node: leaves[verdict.leaf], goal: verdict.goal };
            closed.cuts = verdicts.iter().map(cut).collect();
            closed.cuts.sort_unstable_by_key(|cut| cut.node);
            closed.cuts.iter().for_each(|cut| forest.states[cut.node as usize].is_cut = true);
            return Ok(closed);
        }
        gone.into_iter().rev().for_each(|i| _ = leaves.swap_remove(i));
    }
}

fn divide(forest: &mut Forest, node: u32, need: Need) -> u32 {
    let first = forest.divide(node, |forest| chosen_way(forest, node, &forest.places(node), need));
    for edge in forest.edges_of[node as usize] {
        forest.is_split[edge as usize] = true;
    }
    first
}

fn verdict(forest: &Forest, i: usize, leaf: u32, mask: u8, need: Need) -> Verdict {
    let known = |goal| Verdict { leaf: i, mask, goal, is_new: false };
    if mask == FULL || forest.is_split_within(leaf, mask) {
        return known(Goal { mask: FULL, cuts: 0, way: 0 });
    }
    match forest.goals.get(&(leaf, mask)) {
        Some(goal) => known(*goal),
        None => Verdict { leaf: i, mask, goal: goal(forest, leaf, mask, need), is_new: true },
    }
}

/// What a tet needs to be cut well. It follows from the reference alone. Pieces are held against what dividing would leave: were they held against the whole, a tet
/// whose inner parts are bad could never be cut well enough, and in a mesh of such tets division would spread without end.
fn goal(forest: &Forest, leaf: u32, mask: u8, need: Need) -> Goal {
    let places = forest.places(leaf);
    let whole = forest.nodes[leaf as usize].eas;
    // What is good enough beside the whole is so beside its parts.
    if let Some((cuts, way, _)) = best_cut(forest, leaf, mask, &places, need.of(whole)) {
        return Goal { mask, cuts, way };
    }
    let divided = chosen_way(forest, leaf, &places, need).worst(whole);
    let least = need.of(divided);
    if let Some((cuts, way, _)) = best_cut(forest, leaf, mask, &places, least) {
        return Goal { mask, cuts, way };
    }
    // The fewest edges more, then the best shape.
    let larger = (mask + 1..FULL).filter(|m| m & mask == mask);
    for n in mask.count_ones() + 1..6 {
        let good = larger.clone().filter(|m| m.count_ones() == n);
        let good =
            good.filter_map(|m| best_cut(forest, leaf, m, &places, least).map(|(_, _, worst)| (m, worst)));
        if let Some((mask, _)) = good.reduce(|x, y| if y.1 > x.1 { y } else { x }) {
            return Goal { mask, cuts: 0, way: 0 };
        }
    }
    let (cuts, way, worst) = best_cut(forest, leaf, mask, &places, f64::NEG_INFINITY).unwrap_or_default();
    Goal { mask: if divided > worst { FULL } else { mask }, cuts, way }
}

/// Of all ways to fill a tet with these edges split the one whose worst tet is best, with the cuts of the facets and that EAS; `None` where it is below
/// `least`.
fn best_cut(forest: &Forest, leaf: u32, mask: u8, places: &[Point; 10], least: f64) -> Option<(u8, u8, f64)> {
    let cuts = forest.cuts(leaf, mask);
    let mut best = None;
    let mut least = least;
    for (way, k) in patterns(mask, cuts).iter().zip(0u8..) {
        let mut worst = f64::INFINITY;
        for tet in way {
            worst = eas(corners_at(places, tet)).min(worst);
            if worst < least {
                break;
            }
        }
        if worst >= least && best.is_none_or(|(_, _, best)| worst > best) {
            (best, least) = (Some((cuts, k, worst)), worst);
        }
    }
    best
}

/// Which of the three ways to divide a tet into eight.
fn chosen_way(forest: &Forest, node: u32, places: &[Point; 10], need: Need) -> Way {
    match need.rule {
        Rule::Shortest => best_way(places, forest.nodes[node as usize].eas, need.floor),
        Rule::Bey => Way::new(places, bey::way(forest, node)),
    }
}

/// Which of the three ways to divide a tet of this EAS into eight: along the shortest diagonal of the octahedron (Zhang 1995, *Successive
/// subdivisions of tetrahedra and multigrid methods on tetrahedral meshes*), unless one of the eight, or of theirs, is then below
/// the floor: then along the one that leaves the best.
fn best_way(places: &[Point; 10], whole: f64, floor: f64) -> Way {
    let length = |place: usize| {
        let [p, q] = ends(place);
        let along = sub(places[q], places[p]);
        dot(along, along)
    };
    let shortest = (0..3).reduce(|x, y| if length(y) < length(x) { y } else { x }).unwrap_or(0);
    let way = Way::new(places, shortest);
    // Two generations hardly more than halve the quality.
    let worst = way.worst(whole);
    if worst >= 2.0 * floor || worst >= floor && worst_below(places, &way, whole, 1) >= floor {
        return way;
    }
    let below = |place: usize| {
        let way = Way::new(places, place);
        (worst_below(places, &way, whole, 2), way)
    };
    let [mut best, second, third] = [0, 1, 2].map(below);
    for other in [second, third] {
        best = if other.0 > best.0 { other } else { best };
    }
    best.1
}

/// The worst of the eight and of so many generations below, each along its best diagonal.
fn worst_below(places: &[Point; 10], way: &Way, whole: f64, generations: usize) -> f64 {
    let mut worst = way.worst(whole);
    if generations == 0 {
        return worst;
    }
    // Those at the corners have the shape of the whole.
    for tet in inner_tets(way.place) {
        let corners = corners_at(places, &tet[0]);
        let (shape, places) = (eas(corners), with_middles(corners));
        let below = |place| worst_below(&places, &Way::new(&places, place), shape, generations - 1);
        worst = (0..3).map(below).fold(f64::NEG_INFINITY, f64::max).min(worst);
    }
    worst
}

/// One of the three ways to divide a tet into eight.
pub(super) struct Way {
    /// Its place among the patterns.
    pub(super) place: usize,
    /// The EAS of [`inner_tets`]: the others of the eight have the shape of the whole.
    pub(super) inner: [f64; 2],
}

impl Way {
    pub(super) fn new(places: &[Point; 10], place: usize) -> Self {
        let [first, second] = inner_tets(place);
        Self { place, inner: [eas(corners_at(places, &first[0])), eas(corners_at(places, &second[0]))] }
    }

    fn worst(&self, whole: f64) -> f64 {
        self.inner.into_iter().fold(whole, f64::min)
    }
}

fn corners_at(places: &[Point; 10], tet: &[u8; 4]) -> [Point; 4] {
    let mut corners = [[0.0; 3]; 4];
    for (corner, v) in corners.iter_mut().zip(tet) {
        *corner = places[usize::from(*v)];
    }
    corners
}

impl Forest {
    /// Refuses to grow beyond all bounds.
    fn check_room(&self) -> Result<()> {
        if self.nodes.len() < self.most_nodes {
            return Ok(());
        }
        Err(Error::options(format!("more than {} tets would be divided or come of it", self.most_nodes))
            .remedy("mark fewer tets, or limit the generation"))
    }

    /// Nothing is divided, and no edge is split but those that stay so.
    fn begin_anew(&mut self) {
        self.is_split.fill(false);
        for &edge in &self.pinned {
            self.is_split[edge as usize] = true;
        }
        let mut n_new = 0;
        for (state, node) in self.states.iter_mut().zip(&self.nodes) {
            (state.is_divided, state.is_cut) = (false, false);
            n_new += usize::from(state.is_asked && node.first_child == NONE);
        }
        self.nodes.reserve(8 * n_new);
        self.states.reserve(8 * n_new);
        self.edges_of.reserve(8 * n_new);
    }

    /// The tets that are there and not divided, in their order.
    fn leaves(&self) -> Vec<u32> {
        let n_divided = self.states.iter().filter(|state| state.is_divided).count();
        let mut leaves = Vec::with_capacity(self.n_roots + 7 * n_divided);
        let is_whole = |node: &u32| !self.states[*node as usize].is_divided;
        leaves.extend((0..self.n_roots as u32).filter(is_whole));
        // Behind the roots are eight of one parent each time.
        for first in (self.n_roots as u32..self.nodes.len() as u32).step_by(8) {
            if self.states[self.nodes[first as usize].parent as usize].is_divided {
                leaves.extend((first..first + 8).filter(is_whole));
            }
        }
        leaves
    }

    /// Whether an edge is split that only appears when the tet is divided: half of a split edge, or one between the middles of
    /// two edges of a facet.
    fn is_split_within(&self, leaf: u32, mask: u8) -> bool {
        let edges = &self.edges_of[leaf as usize];
        let is_split = |edge: u32| edge != NONE && self.is_split[edge as usize];
        for (e, edge) in edges.iter().enumerate() {
            if mask >> e & 1 == 1 {
                let [first, second] = self.edges[*edge as usize].halves;
                if is_split(first) || is_split(second) {
                    return true;
                }
            }
        }
        // Only a tet that is divided has edges within a facet, and that splits all three around, unless these are edges of roots.
        let least = if self.pinned.is_empty() { 3 } else { 2 };
        for &[a, b, c] in &FACET_EDGES {
            if (mask >> a & 1) + (mask >> b & 1) + (mask >> c & 1) < least {
                continue;
            }
            let middle = |e: usize| self.edges[edges[e] as usize].middle;
            let middles = [middle(a), middle(b), middle(c)];
            if middles.contains(&NONE) {
                continue;
            }
            if let Some([x, y, z]) = self.inner_edges(middles)
                && (is_split(x) || is_split(y) || is_split(z))
            {
                return true;
            }
        }
        false
    }
}
