//! One search: its state, and the descent through the boxes that are near enough, the nearest first.

use pulp::Simd;

use super::Closest;
use super::eights::{ROUNDING, SQUARE_ROUNDING};
use super::lanes::at_most;
use super::nearby::{N_EIGHTS, Nearby};
use super::node::{Node, STACK_SIZE, put_nearest_on_top};
use super::packed::Packed;
use crate::base::{Point, TriangleId};
use crate::geometry::triangle;
use crate::geometry::vector::{dot, is_finite, sub};

/// How many triangles may wait for an exact computation. For a point near a tube there are two or three.
const MAX_WAITING: usize = 16;

/// The rounding error of exact distances, relative to the largest coordinates: `triangle::closest` is off by
/// less than ten units in the last place of those. With this allowance, the tree leaves out nothing that an
/// exhaustive search would find.
pub(super) const EXACT_ROUNDING: f64 = 32.0 * f64::EPSILON;

/// Distances below this may have squares that underflow, and all count as equal.
pub(super) const UNDERFLOW: f64 = 1e-150;

/// Bounds are kept below this, so that empty boxes, which are infinitely far off, are beyond them.
const MAX_BOUND: f64 = 1e38;

/// Points at least this far off in the frame may have been clamped.
const FAR: f64 = 1e9;

/// Removes the least of the first `n`; `None` if there are none.
#[inline(always)]
fn pop_min(all: &mut [u64; MAX_WAITING], n: &mut usize) -> Option<Node> {
    if *n == 0 {
        return None;
    }
    *n -= 1;
    let last = all[*n];
    let mut least = last;
    for x in &mut all[..*n] {
        // Swapped with the least so far.
        (*x, least) = ((*x).max(least), (*x).min(least));
    }
    Some(Node::of(least))
}

/// Decides which triangles count.
pub(super) trait Admit {
    /// Whether all triangles count.
    const ALL: bool;

    fn admits(&mut self, id: u32, found: &Closest) -> bool;
}

pub(super) struct All;

impl Admit for All {
    const ALL: bool = true;

    #[inline(always)]
    fn admits(&mut self, _: u32, _: &Closest) -> bool {
        true
    }
}

/// Counts the triangles for which the function returns true.
pub(super) struct Filtered<F>(pub(super) F);

impl<F: FnMut(u32, &Closest) -> bool> Admit for Filtered<F> {
    const ALL: bool = false;

    #[inline(always)]
    fn admits(&mut self, id: u32, found: &Closest) -> bool {
        (self.0)(id, found)
    }
}

/// The search for the triangle nearest to a point; among equally near ones, for that of smallest id.
///
/// Lower and upper bounds in 32 bits decide which triangles may be the nearest; exact distances are computed
/// for these, mostly one, at the end. That takes a sixth of the time of a search. Computing one for each
/// triangle that is the nearest so far would take twice as many.
pub(super) struct Search<'a, S, A> {
    tree: &'a Packed,
    simd: S,
    framed: [f32; 3],
    /// The threshold above which a lower bound proves that something is farther than `reach` or than another
    /// triangle, whatever rounding did.
    bound: f32,
    admit: A,
    p: Point,
    /// How far a lower bound may be above the distance, in units of the frame.
    rounding: f64,
    /// Whether the point is near enough for upper bounds: nearer than [`FAR`].
    is_near: bool,
    /// The squared distance beyond which nothing counts.
    reach: f64,
    /// The least upper bound so far, squared.
    upper: f32,
    /// A leaf that was examined already.
    seen: usize,
    waiting: [u64; MAX_WAITING],
    n_waiting: usize,
    best: Option<Closest>,
}

impl<'a, S: Simd, A: Admit> Search<'a, S, A> {
    /// Begins a search within the square root of `reach`; `None` if there is no triangle or `p` is not
    /// finite.
    #[inline(always)]
    pub(super) fn new(tree: &'a Packed, simd: S, p: Point, reach: f64, admit: A) -> Option<Self> {
        if tree.leaves.is_empty() || !is_finite(p) {
            return None;
        }
        let framed = tree.frame.of(p);
        let largest = |x: f64, y: f64| if x > y { x } else { y };
        let size = largest(largest(p[0].abs(), p[1].abs()), p[2].abs());
        let [x, y, z] = framed.map(|x| f64::from(x.abs()));
        let framed_size = largest(largest(x, y), z);
        let exact = (EXACT_ROUNDING * (size + tree.frame.largest) + UNDERFLOW) * tree.frame.scale;
        let rounding = ROUNDING * (1.0 + framed_size) + exact;
        let bound = bound(reach.sqrt() * tree.frame.scale + rounding);
        Some(Self {
            tree,
            simd,
            framed,
            bound,
            admit,
            p,
            rounding,
            is_near: framed_size < FAR,
            reach,
            upper: f32::INFINITY,
            seen: usize::MAX,
            waiting: [0; MAX_WAITING],
            n_waiting: 0,
            best: None,
        })
    }

    /// Examines the leaf of triangle `id` first: the nearer it is, the more this saves. Ids that do not exist
    /// are ignored.
    #[inline(always)]
    pub(super) fn try_first(&mut self, id: TriangleId) {
        if let Some(&place) = self.tree.id_to_place.get(id.index()) {
            self.visit_leaf(place as usize / 8);
            self.seen = place as usize / 8;
        }
    }

    /// Computes the distances still waiting, and returns the nearest triangle.
    #[inline(always)]
    pub(super) fn finish(&mut self) -> Option<Closest> {
        self.measure_waiting();
        self.best.filter(|best| best.distance_squared.is_finite())
    }

    /// Computes the exact distance of the triangle at `place`, and keeps it if it is the nearest so far.
    #[inline(always)]
    fn measure(&mut self, place: usize) {
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
            if !self.admit.admits(id, &found) {
                return;
            }
            self.best = Some(found);
            if distance_squared < self.reach {
                self.reach = distance_squared;
                let bound = bound(distance_squared.sqrt() * self.tree.frame.scale + self.rounding);
                self.bound = if bound < self.bound { bound } else { self.bound };
            }
        }
    }

    #[inline(always)]
    fn measure_waiting(&mut self) {
        while let Some(Node(place, bound)) = pop_min(&mut self.waiting, &mut self.n_waiting) {
            if bound > self.bound {
                self.n_waiting = 0;
                return;
            }
            self.measure(place as usize);
        }
    }

    /// Searches from the root.
    #[inline(always)]
    pub(super) fn descend(&mut self) {
        self.descend_from([0; STACK_SIZE], 1);
    }

    /// Searches from the boxes nearby if they suffice, else from the root.
    #[inline(always)]
    pub(super) fn descend_nearby(&mut self, nearby: &mut Nearby) {
        let mut open = [0; STACK_SIZE];
        let mut n_open = 1;
        if nearby.serves(self.tree, self.simd, self.framed, self.bound) {
            n_open = 0;
            for i in 0..N_EIGHTS {
                let bounds = nearby.boxes[i].distances_squared(self.simd, self.framed);
                let mut near = at_most(self.simd, &bounds, self.bound);
                while near != 0 {
                    let lane = near.trailing_zeros() as usize & 7;
                    near &= near - 1;
                    open[n_open] = Node(nearby.nodes[8 * i + lane], bounds[lane]).packed();
                    n_open += 1;
                }
            }
            put_nearest_on_top(&mut open[..n_open]);
        }
        self.descend_from(open, n_open);
    }

    #[inline(always)]
    fn descend_from(&mut self, mut open: [u64; STACK_SIZE], mut n_open: usize) {
        let n_boxes = self.tree.boxes.len();
        let n_above = n_boxes + self.tree.oriented.len();
        while n_open > 0 {
            n_open -= 1;
            let Node(node, bound) = Node::of(open[n_open]);
            if bound > self.bound {
                continue;
            }
            let node = node as usize;
            let (bounds, first) = if node < n_boxes {
                (self.tree.boxes[node].distances_squared(self.simd, self.framed), self.tree.first_child[node])
            } else if node < n_above {
                let oriented = &self.tree.oriented[node - n_boxes];
                let first = n_above + 8 * (node - n_boxes);
                (oriented.distances_squared(self.simd, self.framed), first as u32)
            } else {
                self.visit_leaf(node - n_above);
                continue;
            };
            let mut near = at_most(self.simd, &bounds, self.bound);
            let start = n_open;
            while near != 0 && n_open < STACK_SIZE {
                let lane = near.trailing_zeros();
                near &= near - 1;
                open[n_open] = Node(first + lane, bounds[lane as usize & 7]).packed();
                n_open += 1;
            }
            put_nearest_on_top(&mut open[start..n_open]);
        }
    }

    /// Queues those triangles of a leaf that may be near enough. If not all triangles count, the queue is
    /// emptied after each leaf.
    #[inline(always)]
    fn visit_leaf(&mut self, leaf: usize) {
        if leaf == self.seen {
            return;
        }
        let (bounds, upper) = self.tree.leaves[leaf].bounds_squared(self.simd, self.framed);
        if A::ALL && self.is_near && upper < self.upper {
            self.upper = upper;
            let distance = f64::from(upper).sqrt() * (1.0 + SQUARE_ROUNDING);
            let bound = bound(distance + 2.0 * self.rounding);
            self.bound = if bound < self.bound { bound } else { self.bound };
        }
        let mut near = at_most(self.simd, &bounds, self.bound) & u32::from(self.tree.is_sound[leaf]);
        while near != 0 {
            let lane = near.trailing_zeros() as usize & 7;
            near &= near - 1;
            if self.n_waiting == MAX_WAITING {
                self.measure_waiting();
            }
            self.waiting[self.n_waiting] = Node((8 * leaf + lane) as u32, bounds[lane]).packed();
            self.n_waiting += 1;
        }
        if !A::ALL {
            self.measure_waiting();
        }
    }
}

/// The threshold for squares of bounds, for a distance; it allows for the rounding of the squares.
#[inline(always)]
pub(super) fn bound(distance: f64) -> f32 {
    let bound = distance * distance * (1.0 + 2.0 * SQUARE_ROUNDING);
    if bound < MAX_BOUND { bound as f32 } else { MAX_BOUND as f32 }
}
