//! One search: what is known of the nearest triangle, and the way down the boxes that are near enough, the nearest first.

use pulp::Simd;

use super::Closest;
use super::eights::{ROUNDING, ROUNDING_OF_SQUARE};
use super::lanes::at_most;
use super::nearby::{N_EIGHTS, Nearby};
use super::packed::Packed;
use crate::base::Point;
use crate::geometry::triangle;
use crate::geometry::vector::{dot, is_finite, sub};

/// A tree over 2^31 triangles has eleven levels, each leaves up to seven boxes behind.
pub(super) const OPEN: usize = 8 * 12;

/// At most so many triangles wait for an exact look. For a point near a tube there are two or three.
const WAITING: usize = 16;

/// Rounding of exact distances, over the largest coordinates: `triangle::closest` is off by less than ten units in the last place
/// of those. With it, what the tree leaves out cannot be what a look at every triangle finds.
pub(super) const ROUNDING_OF_EXACT: f64 = 32.0 * f64::EPSILON;

/// Distances below this may have no square, and are all alike then.
pub(super) const UNDERFLOW: f64 = 1e-150;

/// Bounds are kept below this, so that boxes without an inside, which are infinitely far off, are beyond them.
const MOST: f64 = 1e38;

/// Points at least so far off are not where they are said to be in the frame.
const FAR: f64 = 1e9;

/// A part of the tree, or the place of a triangle, and a lower bound of its squared distance.
pub(super) struct Node(pub(super) u32, pub(super) f32);

impl Node {
    /// In the order of the bound: bits of numbers above zero rise as the numbers do.
    #[inline(always)]
    pub(super) fn packed(self) -> u64 {
        u64::from(self.1.to_bits()) << 32 | u64::from(self.0)
    }

    #[inline(always)]
    pub(super) fn of(packed: u64) -> Self {
        Self(packed as u32, f32::from_bits((packed >> 32) as u32))
    }
}

/// What is nearest goes last; the others stay where they are, or one place on.
#[inline(always)]
pub(super) fn put_nearest_on_top(nodes: &mut [u64]) {
    for i in 1..nodes.len() {
        let (x, y) = (nodes[i - 1], nodes[i]);
        (nodes[i - 1], nodes[i]) = (x.max(y), x.min(y));
    }
}

/// Takes the least out of the first `n`; `None` when there are none.
#[inline(always)]
fn take_least(all: &mut [u64; WAITING], n: &mut usize) -> Option<Node> {
    if *n == 0 {
        return None;
    }
    *n -= 1;
    let last = all[*n];
    let mut least = last;
    for x in &mut all[..*n] {
        // Exchanged with the least so far.
        (*x, least) = ((*x).max(least), (*x).min(least));
    }
    Some(Node::of(least))
}

/// Which triangles count.
pub(super) trait Admit {
    /// Whether all of them do.
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

/// Those of which the function says so.
pub(super) struct Where<F>(pub(super) F);

impl<F: FnMut(u32, &Closest) -> bool> Admit for Where<F> {
    const ALL: bool = false;

    #[inline(always)]
    fn admits(&mut self, id: u32, found: &Closest) -> bool {
        (self.0)(id, found)
    }
}

/// The search for the triangle nearest to a point, of those equally near the one of smallest id.
///
/// Bounds of 32 bits, below and above, say which triangles may be the nearest; of these, mostly one, exact looks are taken at the
/// end. That takes a sixth of the time of a search; with a look at each triangle that was the nearest so far there would be twice as many.
pub(super) struct Search<'a, S, A> {
    tree: &'a Packed,
    simd: S,
    framed: [f32; 3],
    /// What has a lower bound above this is farther than `reach` or than another triangle, whatever rounding did.
    bound: f32,
    admit: A,
    p: Point,
    /// How far a lower bound may be above the distance, in units of the frame.
    rounding: f64,
    /// Near enough for bounds above: not [`FAR`].
    is_near: bool,
    /// What is farther than its root does not count.
    reach: f64,
    /// The nearest bound above so far, squared.
    above: f32,
    /// A leaf that was looked into already.
    seen: usize,
    waiting: [u64; WAITING],
    n_waiting: usize,
    best: Option<Closest>,
}

impl<'a, S: Simd, A: Admit> Search<'a, S, A> {
    /// Within the square root of `reach`. `None` where there is nothing to find.
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
        let exact = (ROUNDING_OF_EXACT * (size + tree.frame.largest) + UNDERFLOW) * tree.frame.scale;
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
            above: f32::INFINITY,
            seen: usize::MAX,
            waiting: [0; WAITING],
            n_waiting: 0,
            best: None,
        })
    }

    /// Looks into the leaf of a triangle, by its id, to begin with: the nearer it is, the more that saves.
    #[inline(always)]
    pub(super) fn begin_at(&mut self, id: u32) {
        if let Some(&place) = self.tree.id_to_place.get(id as usize) {
            self.look_into(place as usize / 8);
            self.seen = place as usize / 8;
        }
    }

    /// What it came to.
    #[inline(always)]
    pub(super) fn finish(&mut self) -> Option<Closest> {
        self.look_at_waiting();
        self.best.filter(|best| best.distance_squared.is_finite())
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
    fn look_at_waiting(&mut self) {
        while let Some(Node(place, bound)) = take_least(&mut self.waiting, &mut self.n_waiting) {
            if bound > self.bound {
                self.n_waiting = 0;
                return;
            }
            self.look_at(place as usize);
        }
    }

    /// From the root.
    #[inline(always)]
    pub(super) fn descend(&mut self) {
        self.descend_from([0; OPEN], 1);
    }

    /// The same from boxes near by, where they are known to do.
    #[inline(always)]
    pub(super) fn descend_nearby(&mut self, nearby: &mut Nearby) {
        let mut open = [0; OPEN];
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
    fn descend_from(&mut self, mut open: [u64; OPEN], mut n_open: usize) {
        let n_boxes = self.tree.boxes.len();
        let n_above = n_boxes + self.tree.turned.len();
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
            put_nearest_on_top(&mut open[start..n_open]);
        }
    }

    /// Those triangles of a leaf that may be near enough wait; where some do not count, no longer than for each other.
    #[inline(always)]
    fn look_into(&mut self, leaf: usize) {
        if leaf == self.seen {
            return;
        }
        let (bounds, above) = self.tree.leaves[leaf].bounds_squared(self.simd, self.framed);
        if A::ALL && self.is_near && above < self.above {
            self.above = above;
            let distance = f64::from(above).sqrt() * (1.0 + ROUNDING_OF_SQUARE);
            let bound = bound(distance + 2.0 * self.rounding);
            self.bound = if bound < self.bound { bound } else { self.bound };
        }
        let mut near = at_most(self.simd, &bounds, self.bound) & u32::from(self.tree.is_sound[leaf]);
        while near != 0 {
            let lane = near.trailing_zeros() as usize & 7;
            near &= near - 1;
            if self.n_waiting == WAITING {
                self.look_at_waiting();
            }
            self.waiting[self.n_waiting] = Node((8 * leaf + lane) as u32, bounds[lane]).packed();
            self.n_waiting += 1;
        }
        if !A::ALL {
            self.look_at_waiting();
        }
    }
}

/// The bound for squares of this distance, which holds for rounded ones, too.
#[inline(always)]
pub(super) fn bound(distance: f64) -> f32 {
    let bound = distance * distance * (1.0 + 2.0 * ROUNDING_OF_SQUARE);
    if bound < MOST { bound as f32 } else { MOST as f32 }
}
