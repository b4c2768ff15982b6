//! Triangles packed by eights, and boxes by eights above them.
//!
//! Triangles are ordered so that neighbours follow each other. The tree then needs no links: box `i` of a
//! level lies around boxes or triangles `8 i` to `8 i + 7` of the level below (packed R-trees: Kamel and
//! Faloutsos 1993, *On packing R-trees*). When points move, one pass from the leaves to the root refits it.

use pulp::{Arch, Simd, WithSimd};

use super::eights::{Boxes, Triangles, larger, smaller};
use super::oriented::OrientedBoxes;
use crate::base::{MaybeId, Point, Threads, TriangleId, VertexId};
use crate::geometry::vector::{add, is_finite, scale, sub};
use crate::spatial::bounding_box;
use crate::spatial::hilbert::{Curve, KEY_BITS, bounding_cube};

/// Coordinates in a frame are clamped to this, 2^30.
pub(super) const MAX_COORDINATE: f64 = 1_073_741_824.0;

/// The shift (subtract `centre`) and the factor (multiply by `scale`) that bring all coordinates between -1
/// and 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    pub(super) centre: Point,
    pub(super) scale: f64,
    /// The largest absolute coordinate.
    pub(super) largest: f64,
}

impl Frame {
    /// The frame of the finite points. Its scale is a power of two, so that multiplying does not round.
    fn around(points: &[Point]) -> Self {
        let [low, high] = bounding_box(points.iter().copied().filter(|p| is_finite(*p)));
        let half = (0..3).map(|k| 0.5 * high[k] - 0.5 * low[k]).fold(0.0, f64::max);
        let centre = [0, 1, 2].map(|k| 0.5 * low[k] + 0.5 * high[k]);
        let centre = if is_finite(centre) { centre } else { [0.0; 3] };
        let exponent = (half.log2().ceil() as i32).clamp(-1000, 1023);
        let ends = low.into_iter().chain(high).filter(|x| x.is_finite());
        let largest = ends.fold(0.0, |most: f64, x| most.max(x.abs()));
        Self { centre, scale: 2f64.powi(-exponent), largest }
    }

    /// Converts a point to units of the frame. It is clamped to 2^30, which brings it no farther from
    /// anything inside.
    #[inline(always)]
    pub(super) fn of(&self, p: Point) -> [f32; 3] {
        let x = scale(sub(p, self.centre), self.scale);
        [
            x[0].clamp(-MAX_COORDINATE, MAX_COORDINATE) as f32,
            x[1].clamp(-MAX_COORDINATE, MAX_COORDINATE) as f32,
            x[2].clamp(-MAX_COORDINATE, MAX_COORDINATE) as f32,
        ]
    }

    /// Converts a place in units of the frame back to a point.
    #[inline(always)]
    pub(super) fn point_of(&self, x: [f32; 3]) -> Point {
        add(scale(x.map(f64::from), 1.0 / self.scale), self.centre)
    }
}

/// Boxes of the lowest level, each with 512 triangles, that a thread fits at a time.
const BOXES_PER_TASK: usize = 8;

/// The tree. A triangle is known by its *place* in the order; leaf `i` has places `8 i` to `8 i + 7`.
#[derive(Clone, Debug)]
pub(super) struct Packed {
    pub(super) frame: Frame,
    /// The caller's ids of the triangles, by place.
    pub(super) ids: Vec<u32>,
    /// The place of each triangle, by the caller's id.
    pub(super) id_to_place: Vec<u32>,
    /// The vertices of each triangle, by place. They are numbered in the order of first use, so that
    /// neighbours lie together.
    triangles: Vec<[u32; 3]>,
    points: Vec<Point>,
    /// The caller's ids of the points.
    vertices: Vec<VertexId>,
    /// One more than the caller's largest id.
    n_points: usize,
    pub(super) leaves: Vec<Triangles>,
    /// For each leaf, a bit for each triangle whose corners are finite.
    pub(super) is_sound: Vec<u8>,
    /// The boxes around the leaves.
    pub(super) oriented: Vec<OrientedBoxes>,
    /// All boxes above, from the root down to those around eight leaves each.
    pub(super) boxes: Vec<Boxes>,
    /// Where in `boxes` each level starts, from the lowest up.
    levels: Vec<usize>,
    /// The first child of each of `boxes`, numbered through all `boxes`, then `oriented`, then leaves.
    pub(super) first_child: Vec<u32>,
    /// Points in units of the frame; kept as a buffer, since memory that was written before is cheaper.
    framed: Vec<[f32; 3]>,
}

impl Packed {
    pub(super) fn new(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Self {
        let ids = spatial_order(points, triangles, threads);
        let mut id_to_place = vec![0; ids.len()];
        for (&id, place) in ids.iter().zip(0..) {
            id_to_place[id as usize] = place;
        }
        let n_points = triangles.as_flattened().iter().map(|v| v.index() + 1).max().unwrap_or(0);
        let mut number = vec![0; n_points];
        let mut vertices = Vec::with_capacity(n_points.min(ids.len()));
        let mut own = Vec::with_capacity(ids.len());
        for &id in &ids {
            let mut triangle = [0; 3];
            for (own, v) in triangle.iter_mut().zip(triangles[id as usize]) {
                // One more than the number; 0 if there is none yet.
                let number = &mut number[v.index()];
                if *number == 0 {
                    vertices.push(v);
                    *number = vertices.len() as u32;
                }
                *own = *number - 1;
            }
            own.push(triangle);
        }
        let n_leaves = ids.len().div_ceil(8);
        let n_oriented = n_leaves.div_ceil(8);
        let (levels, n_boxes) = levels(n_oriented);
        let mut tree = Self {
            frame: Frame::around(&[]),
            ids,
            id_to_place,
            triangles: own,
            points: Vec::with_capacity(vertices.len()),
            framed: Vec::with_capacity(vertices.len()),
            vertices,
            n_points,
            leaves: vec![Triangles::NONE; n_leaves],
            is_sound: vec![0; n_leaves],
            oriented: vec![OrientedBoxes::EMPTY; n_oriented],
            boxes: vec![Boxes::EMPTY; n_boxes],
            first_child: first_child(&levels, n_boxes),
            levels,
        };
        tree.fit(points, threads);
        tree
    }

    /// Refits the tree to points that moved.
    pub(super) fn fit(&mut self, points: &[Point], threads: &Threads) {
        assert!(points.len() >= self.n_points, "{} points, not {}", points.len(), self.n_points);
        self.points.clear();
        self.points.extend(self.vertices.iter().map(|v| points[v.index()]));
        self.frame = Frame::around(&self.points);
        let frame = self.frame;
        self.framed.clear();
        self.framed
            .extend(self.points.iter().map(|p| if is_finite(*p) { frame.of(*p) } else { [f32::NAN; 3] }));
        self.fit_leaves(threads);
        for level in 1..self.levels.len() {
            let (start, below) = (self.levels[level], self.levels[level - 1]);
            for i in 0..self.n_at(level - 1) {
                let around = self.boxes[below + i].around();
                self.boxes[start + i / 8].set(i % 8, around);
            }
        }
    }

    /// How many groups of eight boxes a level has.
    fn n_at(&self, level: usize) -> usize {
        let end = if level == 0 { self.boxes.len() } else { self.levels[level - 1] };
        end - self.levels[level]
    }

    fn fit_leaves(&mut self, threads: &Threads) {
        let arch = Arch::new();
        let fit = |triangles, leaves, is_sound, oriented, boxes| {
            arch.dispatch(FitLeaves { triangles, framed: &self.framed, leaves, is_sound, oriented, boxes });
        };
        let boxes = &mut self.boxes[self.levels[0]..];
        let per_task = if threads.count() == 1 { boxes.len().max(1) } else { BOXES_PER_TASK };
        let leaves = self.leaves.chunks_mut(64 * per_task);
        let is_sound = self.is_sound.chunks_mut(64 * per_task);
        let oriented = self.oriented.chunks_mut(8 * per_task);
        let triangles = self.triangles.chunks(512 * per_task);
        let parts = triangles.zip(leaves).zip(is_sound).zip(oriented).zip(boxes.chunks_mut(per_task));
        threads.each(parts.collect(), |((((triangles, leaves), is_sound), oriented), boxes)| {
            fit(triangles, leaves, is_sound, oriented, boxes);
        });
    }

    /// The box around eight leaves.
    #[inline(always)]
    pub(super) fn around_oriented(&self, oriented: usize) -> [[f32; 3]; 2] {
        self.boxes[self.levels[0] + oriented / 8].get(oriented % 8)
    }

    /// The box around the sound triangles of a leaf; computed, since it is not stored.
    #[inline(always)]
    pub(super) fn around_leaf<S: Simd>(&self, simd: S, leaf: usize) -> [[f32; 3]; 2] {
        self.leaves[leaf].boxes(simd).around_some(self.is_sound[leaf].into())
    }

    pub(super) fn has_triangle(&self, id: TriangleId) -> bool {
        id.index() < self.ids.len()
    }

    /// Indices into `triangles` in the order of the triangles' places; those without a triangle, or of one
    /// that does not exist, come last.
    pub(super) fn order_by_place(&self, triangles: &[MaybeId<TriangleId>]) -> Vec<u32> {
        let known = |id: &MaybeId<TriangleId>| self.id_to_place.get(id.get()?.index()).copied();
        let place = |id: &MaybeId<TriangleId>| known(id).unwrap_or(u32::MAX).into();
        sorted_by_key(triangles.iter().map(place))
    }

    /// Bytes that the tree takes.
    pub(super) fn memory(&self) -> usize {
        size_of_val(&self.ids[..])
            + size_of_val(&self.id_to_place[..])
            + size_of_val(&self.triangles[..])
            + size_of_val(&self.points[..])
            + size_of_val(&self.vertices[..])
            + size_of_val(&self.leaves[..])
            + size_of_val(&self.is_sound[..])
            + size_of_val(&self.boxes[..])
            + size_of_val(&self.oriented[..])
            + size_of_val(&self.framed[..])
    }

    #[inline(always)]
    pub(super) fn corners(&self, place: usize) -> [Point; 3] {
        let [a, b, c] = self.triangles[place];
        [self.points[a as usize], self.points[b as usize], self.points[c as usize]]
    }
}

/// Some of the leaves, with the boxes around them.
struct FitLeaves<'a> {
    triangles: &'a [[u32; 3]],
    framed: &'a [[f32; 3]],
    leaves: &'a mut [Triangles],
    is_sound: &'a mut [u8],
    oriented: &'a mut [OrientedBoxes],
    boxes: &'a mut [Boxes],
}

impl WithSimd for FitLeaves<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        for i in 0..self.oriented.len() {
            let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
            for leaf in 8 * i..self.leaves.len().min(8 * i + 8) {
                let around = self.fit_leaf(leaf);
                self.oriented[i].set(simd, leaf % 8, &self.leaves[leaf], self.is_sound[leaf]);
                for axis in 0..3 {
                    low[axis] = smaller(around.0[axis], low[axis]);
                    high[axis] = larger(around.1[axis], high[axis]);
                }
            }
            self.boxes[i / 8].set(i % 8, (low, high));
        }
    }
}

impl FitLeaves<'_> {
    /// Fits a leaf, and returns the box around its sound triangles.
    #[inline(always)]
    fn fit_leaf(&mut self, leaf: usize) -> ([f32; 3], [f32; 3]) {
        let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
        let mut is_sound = 0;
        let triangles = &self.triangles[8 * leaf..self.triangles.len().min(8 * leaf + 8)];
        let out = &mut self.leaves[leaf].corners;
        for (lane, triangle) in triangles.iter().enumerate() {
            let corners = triangle.map(|v| self.framed[v as usize]);
            for k in 0..3 {
                for axis in 0..3 {
                    out[k][axis][lane] = corners[k][axis];
                }
            }
            if corners.as_flattened().iter().any(|x| x.is_nan()) {
                out.as_flattened_mut().iter_mut().for_each(|eight| eight[lane] = f32::NAN);
                continue;
            }
            is_sound |= 1 << lane;
            for [x, y, z] in corners {
                low = [smaller(x, low[0]), smaller(y, low[1]), smaller(z, low[2])];
                high = [larger(x, high[0]), larger(y, high[1]), larger(z, high[2])];
            }
        }
        self.is_sound[leaf] = is_sound;
        (low, high)
    }
}

/// Where each level starts, from the lowest up (the root is first in memory), and how many groups of eight
/// boxes there are.
fn levels(n_oriented: usize) -> (Vec<usize>, usize) {
    let mut counts = vec![n_oriented.div_ceil(8)];
    while counts[counts.len() - 1] > 1 {
        counts.push(counts[counts.len() - 1].div_ceil(8));
    }
    let mut n = 0;
    let mut starts: Vec<usize> = counts.iter().rev().map(|&count| (n, n += count).0).collect();
    starts.reverse();
    (starts, n)
}

/// The first child of each group of eight boxes.
fn first_child(levels: &[usize], n_boxes: usize) -> Vec<u32> {
    let mut first = vec![0; n_boxes];
    let mut start_below = n_boxes;
    let mut end = n_boxes;
    for &start in levels {
        for (i, first) in first[start..end].iter_mut().enumerate() {
            *first = (start_below + 8 * i) as u32;
        }
        (start_below, end) = (start, start);
    }
    first
}

/// The midpoint of the longest edge of a triangle, as integers of the same order, and the id of the triangle.
/// 32 bits suffice, since all that matters is which triangles are neighbours.
type Item = ([i32; 3], u32);

/// Maps the bits of a number to an integer, in the order of the numbers. It is its own inverse.
#[inline(always)]
fn ordered(bits: u32) -> i32 {
    let bits = bits as i32;
    bits ^ ((bits >> 31) as u32 >> 1) as i32
}

/// Ids of the triangles, neighbours together: halved across the longest side of the box of their midpoints,
/// down to eights.
///
/// A Hilbert curve takes a third of the time, but searches then examine twice as many boxes.
fn spatial_order(points: &[Point], triangles: &[[VertexId; 3]], threads: &Threads) -> Vec<u32> {
    let used = || triangles.iter().map(|t| points[t[0].index()]).filter(|p| is_finite(*p));
    let (corner, extent) = bounding_cube(used());
    let per_extent = 1.0 / extent.max(1e-300);
    let middle = |t: &[VertexId; 3]| {
        let corners = t.map(|v| scale(sub(points[v.index()], corner), per_extent).map(|x| x as f32));
        middle_of_longest(corners).map(|x| ordered(x.to_bits()))
    };
    let mut items = threads.map(triangles.len(), |i| (middle(&triangles[i]), i as u32));
    halve(&mut items, None, threads);
    items.into_iter().map(|item| item.1).collect()
}

/// Twice the midpoint of the longest edge. Triangles that share this edge, as the two of a quad do, have the
/// same midpoint to the bit, so halving keeps them together. With centroids instead, leaves overlap, and
/// searches near a tube take 10 % longer.
#[inline(always)]
fn middle_of_longest([a, b, c]: [[f32; 3]; 3]) -> [f32; 3] {
    let squared = |x: [f32; 3], y: [f32; 3]| {
        let [x, y, z] = [x[0] - y[0], x[1] - y[1], x[2] - y[2]];
        x * x + y * y + z * z
    };
    let (ab, bc, ca) = (squared(a, b), squared(b, c), squared(c, a));
    let (x, y) = if ab >= bc && ab >= ca {
        (a, b)
    } else if bc >= ca {
        (b, c)
    } else {
        (c, a)
    };
    [x[0] + y[0], x[1] + y[1], x[2] + y[2]]
}

/// Up to this many items are halved by one thread.
const MAX_SERIAL_ITEMS: usize = 2048;

/// Sorts by halving. The first half has eight times a power of two items, so that leaves and boxes of leaves
/// are halves, too.
///
/// On every other level the box is the one that the previous halving left, which saves 4 % of the time of a
/// build.
fn halve(items: &mut [Item], known: Option<[[i32; 3]; 2]>, threads: &Threads) {
    if items.len() <= 8 {
        return;
    }
    let [mut low, mut high] = known.unwrap_or([[i32::MAX; 3], [i32::MIN; 3]]);
    if known.is_none() {
        for (middle, _) in items.iter() {
            for k in 0..3 {
                (low[k], high[k]) = (middle[k].min(low[k]), middle[k].max(high[k]));
            }
        }
    }
    let back = |x: i32| f32::from_bits(ordered(x as u32) as u32);
    let side = [0, 1, 2].map(|k| back(high[k]) - back(low[k]));
    let axis = (0..3).fold(0, |most, k| if side[k] > side[most] { k } else { most });
    let half = 4 * items.len().div_ceil(8).next_power_of_two();
    // A single comparison of integers, no two of which are equal.
    items.select_nth_unstable_by_key(half, |x| i64::from(x.0[axis]) << 32 | i64::from(x.1));
    let cut = items[half].0[axis];
    let (left, right) = items.split_at_mut(half);
    let (mut below, mut above) = (high, low);
    (below[axis], above[axis]) = (cut, cut);
    let is_known = known.is_none();
    let is_shared = left.len() > MAX_SERIAL_ITEMS;
    let mut left = || halve(left, is_known.then_some([low, below]), threads);
    let mut right = || halve(right, is_known.then_some([above, high]), threads);
    if is_shared {
        threads.join(left, right);
    } else {
        left();
        right();
    }
}

/// Indices of the points in their order along a Hilbert curve through the finite ones.
pub(super) fn hilbert_order(points: &[Point], threads: &Threads) -> Vec<u32> {
    assert!(points.len() < 1 << (64 - KEY_BITS), "{} are too many", points.len());
    let (corner, extent) = bounding_cube(points.iter().copied().filter(|p| is_finite(*p)));
    let curve = Curve::new(corner, extent);
    sorted_by_key(threads.map(points.len(), |i| curve.key(points[i])).into_iter())
}

/// Indices in the order of the keys, which have at most [`KEY_BITS`] bits.
fn sorted_by_key(keys: impl Iterator<Item = u64>) -> Vec<u32> {
    let keyed = keys.zip(0u64..).map(|(key, id)| key << (64 - KEY_BITS) | id).collect();
    radix_sorted(keyed).into_iter().map(|x| (x & ((1 << (64 - KEY_BITS)) - 1)) as u32).collect()
}

/// Sorts by the upper [`KEY_BITS`] bits, least significant digit first; equal keys stay in order.
fn radix_sorted(mut keyed: Vec<u64>) -> Vec<u64> {
    const DIGIT: u32 = 11;
    if keyed.len() < 4096 {
        keyed.sort_unstable();
        return keyed;
    }
    let mut other = vec![0; keyed.len()];
    for pass in 0..KEY_BITS.div_ceil(DIGIT) {
        let digit = |x: u64| (x >> (64 - KEY_BITS + pass * DIGIT)) as usize & ((1 << DIGIT) - 1);
        let mut starts = [0usize; 1 << DIGIT];
        keyed.iter().for_each(|&x| starts[digit(x)] += 1);
        let mut sum = 0;
        starts.iter_mut().for_each(|s| sum += std::mem::replace(s, sum));
        for &x in &keyed {
            let place = &mut starts[digit(x)];
            other[*place] = x;
            *place += 1;
        }
        std::mem::swap(&mut keyed, &mut other);
    }
    keyed
}
