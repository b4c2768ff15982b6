//! The search: down the boxes that are near enough, the nearest first.

use pulp::Simd;

use super::Closest;
use super::eights::{ROUNDING, ROUNDING_OF_SQUARE};
use super::lanes::at_most;
use super::packed::Packed;
use crate::base::Point;
use crate::geometry::triangle;
use crate::geometry::vector::{dot, is_finite, sub};

/// A tree over 2^31 triangles has eleven levels, each leaves up to seven boxes behind.
const OPEN: usize = 8 * 12;

/// Rounding of exact distances, over the largest coordinates: `triangle::closest` is off by less than ten units in the last place
/// of those. With it, what the tree leaves out cannot be what a look at every triangle finds.
pub(super) const ROUNDING_OF_EXACT: f64 = 32.0 * f64::EPSILON;

/// Distances below this may have no square, and are all alike then.
pub(super) const UNDERFLOW: f64 = 1e-150;

/// A part of the tree, and a lower bound of its squared distance.
struct Node(u32, f32);

impl Node {
    /// In the order of the bound: bits of numbers above zero rise as the numbers do.
    #[inline(always)]
    fn packed(self) -> u64 {
        u64::from(self.1.to_bits()) << 32 | u64::from(self.0)
    }

    #[inline(always)]
    fn of(packed: u64) -> Self {
        Self(packed as u32, f32::from_bits((packed >> 32) as u32))
    }
}

/// The nearest triangle so far.
struct Search<'a, S, F> {
    tree: &'a Packed,
    /// Which triangles count.
    admit: F,
    simd: S,
    p: Point,
    framed: [f32; 3],
    /// How far a lower bound may be above the distance, in units of the frame.
    rounding: f64,
    /// What is farther than its root does not count.
    reach: f64,
    /// What has a lower bound above this is farther than `reach`, whatever rounding did.
    bound: f32,
    best: Option<Closest>,
}

/// What there is to ask: the triangle nearest to `p` within the square root of `reach`, of those equally near the one of smallest
/// id. A `guess` costs one look and saves more the nearer it is.
#[derive(Clone, Copy)]
pub(super) struct Query {
    pub(super) p: Point,
    pub(super) reach: f64,
    pub(super) guess: u32,
}

/// The answer, of those triangles that `admit` admits; it is asked only for what is better than all that it admitted before.
#[inline(always)]
pub(super) fn nearest<S: Simd>(
    tree: &Packed,
    simd: S,
    Query { p, reach, guess }: Query,
    admit: impl FnMut(u32, &Closest) -> bool,
) -> Option<Closest> {
    if tree.leaves.is_empty() || !is_finite(p) {
        return None;
    }
    let framed = tree.frame.of(p);
    let largest = |x: f64, y: f64| if x > y { x } else { y };
    let size = largest(largest(p[0].abs(), p[1].abs()), p[2].abs());
    let framed_size = framed.iter().fold(0.0, |most, x| largest(f64::from(x.abs()), most));
    let exact = (ROUNDING_OF_EXACT * (size + tree.frame.largest) + UNDERFLOW) * tree.frame.scale;
    let rounding = ROUNDING * (1.0 + framed_size) + exact;
    let mut search = Search { tree, admit, simd, p, framed, rounding, reach, bound: 0.0, best: None };
    search.set_bound();
    if let Some(&place) = tree.id_to_place.get(guess as usize)
        && tree.is_sound[place as usize / 8] >> (place % 8) & 1 == 1
    {
        search.look_at(place as usize);
    }
    search.descend();
    search.best.filter(|best| best.distance_squared.is_finite())
}

impl<S: Simd, F: FnMut(u32, &Closest) -> bool> Search<'_, S, F> {
    #[inline(always)]
    fn set_bound(&mut self) {
        // Finite, so that boxes without an inside, which are infinitely far off, are beyond it.
        const MOST: f64 = 1e38;
        let reach = self.reach.sqrt() * self.tree.frame.scale + self.rounding;
        let bound = reach * reach * (1.0 + 2.0 * ROUNDING_OF_SQUARE);
        self.bound = if bound < MOST { bound as f32 } else { MOST as f32 };
    }

    /// The exact distance of one triangle.
    #[inline(always)]
    fn look_at(&mut self, place: usize) {
        let corners = self.tree.corners(place);
        let weights = triangle::closest(corners, self.p);
        let point = triangle::at(corners, weights);
        let offset = sub(point, self.p);
        let distance_squared = dot(offset, offset);
        let id = self.tree.ids[place];
        let triangle = id as usize;
        let is_better = |b: &Closest| (distance_squared, triangle) < (b.distance_squared, b.triangle);
        if distance_squared <= self.reach && self.best.as_ref().is_none_or(is_better) {
            let found = Closest { triangle, weights, point, distance_squared };
            if !(self.admit)(id, &found) {
                return;
            }
            self.best = Some(found);
            if distance_squared < self.reach {
                self.reach = distance_squared;
                self.set_bound();
            }
        }
    }

    #[inline(always)]
    fn descend(&mut self) {
        let n_boxes = self.tree.boxes.len();
        let n_above = n_boxes + self.tree.turned.len();
        let mut open = [0; OPEN];
        let mut n_open = 1;
        while n_open > 0 {
            n_open -= 1;
            let Node(node, bound) = Node::of(open[n_open]);
            if bound > self.bound {
                continue;
            }
            let node = node as usize;
            let (bounds, first) = if node < n_boxes {
                (
                    self.tree.boxes[node].distances_squared(self.simd, self.framed),
                    self.tree.first_within[node],
                )
            } else if node < n_above {
                let turned = &self.tree.turned[node - n_boxes];
                let first = n_above + 8 * (node - n_boxes);
                (turned.distances_squared(self.simd, self.framed), first as u32)
            } else {
                self.look_into(node - n_above);
                continue;
            };
            let mut near = at_most(self.simd, &bounds, self.bound);
            let start = n_open;
            while near != 0 && n_open < OPEN {
                let lane = near.trailing_zeros();
                near &= near - 1;
                open[n_open] = Node(first + lane, bounds[lane as usize & 7]).packed();
                n_open += 1;
            }
            // The nearest one goes on top.
            for i in start + 1..n_open {
                let (x, y) = (open[i - 1], open[i]);
                (open[i - 1], open[i]) = (x.max(y), x.min(y));
            }
        }
    }

    /// Exact looks at those triangles of a leaf that may be near enough.
    #[inline(always)]
    fn look_into(&mut self, leaf: usize) {
        let bounds = self.tree.leaves[leaf].bounds_squared(self.simd, self.framed);
        let mut near = at_most(self.simd, &bounds, self.bound) & u32::from(self.tree.is_sound[leaf]);
        while near != 0 {
            // The nearest first: the others are then mostly too far off.
            let mut lane = near.trailing_zeros() as usize & 7;
            let mut rest = near & (near - 1);
            while rest != 0 {
                let other = rest.trailing_zeros() as usize & 7;
                rest &= rest - 1;
                lane = if bounds[other] < bounds[lane] { other } else { lane };
            }
            near &= !(1 << lane);
            if bounds[lane] > self.bound {
                return;
            }
            let place = 8 * leaf + lane;
            if self.best.as_ref().is_none_or(|b| b.triangle != self.tree.ids[place] as usize) {
                self.look_at(place);
            }
        }
    }
}
