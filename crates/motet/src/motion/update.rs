//! The step itself: one weighted sum of four displacements for every vertex.
//!
//! It has to run at the speed of memory, so the layout is what counts. Every vertex of the mesh, in the
//! caller's order, has four nodes (16 bytes) and three weights (24); the first weight is 1 less the others.
//! With the position it starts from and the position it goes to, that makes 88 bytes per vertex, in four
//! streams; the nodes' displacements stay in the cache. Alternatives that were measured: looking nodes up
//! through the index of a tet moves 76 bytes but takes a third longer (one more dependent load); vertices
//! sorted by tet need their results scattered.
//!
//! A vertex that is a node itself has that node four times, and so gets exactly its displacement: no branch,
//! no second pass. Vertices are independent: results do not depend on the number of threads.

use std::borrow::Cow;

use pulp::{NullaryFnOnce, f64x4};

use crate::base::four::FourLanes;
use crate::base::{Point, Threads, VertexId};

/// A displacement and a zero, so that four numbers load at once and from one cache line.
#[derive(Clone, Copy, Debug, Default, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(32))]
pub(crate) struct Padded([f64; 4]);

impl Padded {
    pub(crate) fn new([x, y, z]: Point) -> Self {
        Self([x, y, z, 0.0])
    }

    pub(crate) fn point(self) -> Point {
        let [x, y, z, _] = self.0;
        [x, y, z]
    }

    /// Whether two displacements have the same bits.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.0.map(f64::to_bits) == other.0.map(f64::to_bits)
    }

    #[inline(always)]
    pub(crate) fn load<F: FourLanes>(&self, machine: F::Machine) -> F {
        F::load(machine, &self.0)
    }

    #[inline(always)]
    pub(crate) fn of_lanes<F: FourLanes>(four: F) -> Self {
        Self(four.stored())
    }
}

/// Displacements of all nodes.
pub(crate) enum Displacements<'a> {
    /// All nodes are driven.
    Driven(&'a [Point]),
    /// Some are not; the last entry is that of the node that never moves.
    All(Vec<Padded>),
}

impl Displacements<'_> {
    /// The table that the update reads: four numbers per node, and a node at the end that never moves.
    pub(crate) fn table(&self) -> Cow<'_, [Padded]> {
        match self {
            Self::Driven(all) => {
                let mut table = Vec::with_capacity(all.len() + 1);
                table.extend(all.iter().map(|&d| Padded::new(d)));
                table.push(Padded::default());
                Cow::Owned(table)
            }
            Self::All(all) => Cow::Borrowed(all),
        }
    }
}

/// The nodes that each vertex follows, and their weights.
#[derive(Debug, Default)]
pub(crate) struct WeightTable {
    /// Four nodes for each vertex.
    pub(crate) nodes: Vec<[u32; 4]>,
    /// The weights of the last three of them.
    pub(crate) weights: Vec<[f64; 3]>,
}

/// With fewer vertices per part, a second thread takes longer to wake than to do its part.
const MIN_PART: usize = 2048;

/// Parts per thread.
const PARTS: usize = 16;

impl WeightTable {
    /// A table in which all of `n` vertices follow a node that never moves.
    pub(crate) fn fixed(node: u32, n: usize) -> Self {
        Self { nodes: vec![[node; 4]; n], weights: vec![[0.0; 3]; n] }
    }

    pub(crate) fn set(&mut self, v: VertexId, nodes: [u32; 4], w: [f64; 4]) {
        self.nodes[v.index()] = nodes;
        self.weights[v.index()] = [w[1], w[2], w[3]];
    }

    /// Computes `out = from + sum w_i d_i`.
    ///
    /// Every thread makes its own table: one that another thread read a step ago is slow to write (for 17,000
    /// nodes 90 us instead of 20, where the step takes 300).
    pub(crate) fn apply(
        &self,
        from: &[Point],
        displacements: &Displacements,
        out: &mut [Point],
        threads: &Threads,
    ) {
        let part = out.len().div_ceil(PARTS * threads.count()).max(MIN_PART);
        threads.fill(
            out,
            part,
            || displacements.table(),
            |table, start, out| {
                let vertices = start..start + out.len();
                let (nodes, weights) = (&self.nodes[vertices.clone()], &self.weights[vertices.clone()]);
                add_means(&from[vertices], nodes, weights, bytemuck::cast_slice(table), out);
            },
        );
    }

    /// The nodes that vertex `v` follows, and their weights.
    pub(crate) fn of(&self, v: usize) -> ([u32; 4], [f64; 4]) {
        let [b, c, d] = self.weights[v];
        (self.nodes[v], [1.0 - b - c - d, b, c, d])
    }
}

/// The loop. With four numbers per instruction it runs 1.5 times as fast as with two, and gives the same
/// bits: products are not fused with sums.
fn add_means(
    from: &[Point],
    nodes: &[[u32; 4]],
    weights: &[[f64; 3]],
    displacement: &[f64x4],
    out: &mut [Point],
) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = pulp::x86::V3::try_new() {
        return simd.vectorize(UpdateLoop { sum: Wide(simd), from, nodes, weights, displacement, out });
    }
    UpdateLoop { sum: Plain, from, nodes, weights, displacement, out }.call();
}

/// How `sum w_i d_i` is computed from the last three weights. It is a trait, since a closure is not certain
/// to be compiled into the loop for which the wide instructions are enabled (20 times slower where it is
/// not).
trait Sum: Copy {
    fn sum(self, w: &[f64; 3], d: [f64x4; 4]) -> f64x4;
}

#[cfg(target_arch = "x86_64")]
#[derive(Clone, Copy)]
struct Wide(pulp::x86::V3);

#[cfg(target_arch = "x86_64")]
impl Sum for Wide {
    #[inline(always)]
    fn sum(self, w: &[f64; 3], d: [f64x4; 4]) -> f64x4 {
        // The first weight in four lanes, too: computing it in one and spreading it takes four more
        // instructions, and a tenth more time for the loop.
        let simd = self.0;
        let [w1, w2, w3] = [simd.splat_f64x4(w[0]), simd.splat_f64x4(w[1]), simd.splat_f64x4(w[2])];
        let one = simd.splat_f64x4(1.0);
        let w0 = simd.sub_f64x4(simd.sub_f64x4(simd.sub_f64x4(one, w1), w2), w3);
        let left = simd.add_f64x4(simd.mul_f64x4(w0, d[0]), simd.mul_f64x4(w1, d[1]));
        let right = simd.add_f64x4(simd.mul_f64x4(w2, d[2]), simd.mul_f64x4(w3, d[3]));
        simd.add_f64x4(left, right)
    }
}

#[derive(Clone, Copy)]
struct Plain;

impl Sum for Plain {
    #[inline(always)]
    fn sum(self, &[w1, w2, w3]: &[f64; 3], [a, b, c, d]: [f64x4; 4]) -> f64x4 {
        let w = [1.0 - w1 - w2 - w3, w1, w2, w3];
        f64x4(
            (w[0] * a.0 + w[1] * b.0) + (w[2] * c.0 + w[3] * d.0),
            (w[0] * a.1 + w[1] * b.1) + (w[2] * c.1 + w[3] * d.1),
            (w[0] * a.2 + w[1] * b.2) + (w[2] * c.2 + w[3] * d.2),
            0.0,
        )
    }
}

/// The loop and what it runs over.
struct UpdateLoop<'a, S> {
    sum: S,
    from: &'a [Point],
    nodes: &'a [[u32; 4]],
    weights: &'a [[f64; 3]],
    displacement: &'a [f64x4],
    out: &'a mut [Point],
}

impl<S: Sum> NullaryFnOnce for UpdateLoop<'_, S> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let places = self.out.iter_mut().zip(self.from).zip(self.nodes).zip(self.weights);
        for (((out, from), &[i, j, k, l]), weights) in places {
            let of = self.displacement;
            let four = [of[i as usize], of[j as usize], of[k as usize], of[l as usize]];
            let f64x4(x, y, z, _) = self.sum.sum(weights, four);
            *out = [from[0] + x, from[1] + y, from[2] + z];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wide_and_plain_instructions_give_the_same_bits() {
        let number = |i: usize| ((i * 7919 + 13) % 1009) as f64 / 1009.0 - 0.5;
        let point = |i: usize| [number(3 * i), number(3 * i + 1), number(3 * i + 2)];
        let n = 1000;
        let from: Vec<Point> = (0..n).map(point).collect();
        let displacement: Vec<f64x4> =
            (0..50).map(|i| f64x4(number(i), number(i + 7), 1e3 * number(i + 9), 0.0)).collect();
        let nodes: Vec<[u32; 4]> = (0..n as u32).map(|i| [i % 50, (i * 3) % 50, (i * 7) % 50, 49]).collect();
        let weights: Vec<[f64; 3]> = (0..n).map(|i| point(i).map(|x| (x + 0.5) / 3.0)).collect();
        let mut wide = vec![[0.0; 3]; n];
        let mut plain = wide.clone();
        add_means(&from, &nodes, &weights, &displacement, &mut wide);
        let (from, nodes, weights, displacement) = (&from[..], &nodes[..], &weights[..], &displacement[..]);
        UpdateLoop { sum: Plain, from, nodes, weights, displacement, out: &mut plain }.call();
        assert_eq!(wide, plain);
    }
}
