//! From the nodes of the graph to all vertices: the weighted mean of four affine maps.

use pulp::NullaryFnOnce;

#[cfg(target_arch = "x86_64")]
use crate::base::four::Wide;
use crate::base::four::{FourLanes, Plain};
use crate::base::{Point, Threads};
use crate::geometry::vector::{add, scale, sub};
use crate::motion::methods::guided::GraphTet;
use crate::motion::update::WeightTable;

/// The displacement near a node as a function of position: three columns, and the value at the origin. The
/// fourth number of each is 0.
pub(super) type Affine = [[f64; 4]; 4];

/// How vertices depend on nodes.
#[derive(Debug)]
pub(super) struct AffineBlend {
    table: WeightTable,
    /// For each node, 1 over the sum of the weights of its tets.
    shares: Vec<f64>,
}

/// Vertices per chunk.
const CHUNK: usize = 1 << 12;

impl AffineBlend {
    pub(super) fn new(table: WeightTable, tets: &[GraphTet], n_nodes: usize) -> Self {
        let mut sums = vec![0.0; n_nodes];
        for tet in tets {
            tet.nodes.iter().for_each(|n| sums[*n as usize] += tet.weight);
        }
        Self { table, shares: sums.into_iter().map(|s| if s > 0.0 { 1.0 / s } else { 0.0 }).collect() }
    }

    /// The affine map of every node, from displacements and the weighted sums of their gradients, as columns.
    /// The last map is that of a node that never moves.
    pub(super) fn affine(&self, places: &[Point], moved: &[Point], sums: &[[Point; 3]]) -> Vec<Affine> {
        let origin = places.first().copied().unwrap_or_default();
        let one = |i: usize| {
            // Half of the gradient: for motions of second order, all of it is off by as much as none, the
            // other way.
            let columns = sums[i].map(|column| scale(column, 0.5 * self.shares[i]));
            let from = sub(places[i], origin);
            let at_origin = (0..3).fold(moved[i], |d, j| sub(d, scale(columns[j], from[j])));
            let [a, b, c] = columns;
            [a, b, c, at_origin].map(|[x, y, z]| [x, y, z, 0.0])
        };
        (0..moved.len()).map(one).chain([Affine::default()]).collect()
    }

    pub(super) fn apply(
        &self,
        places: &[Point],
        from: &[Point],
        maps: &[Affine],
        out: &mut [Point],
        threads: &Threads,
    ) {
        let origin = places.first().copied().unwrap_or_default();
        let chunks = out.chunks_mut(CHUNK).enumerate().collect();
        threads.each(chunks, |(i, out): (usize, &mut [Point])| {
            let (first, table) = (i * CHUNK, &self.table);
            #[cfg(target_arch = "x86_64")]
            if let Some(machine) = pulp::x86::V3::try_new() {
                return machine.vectorize(Vertices::<Wide> {
                    machine,
                    table,
                    origin,
                    from,
                    maps,
                    first,
                    out,
                });
            }
            Vertices::<Plain> { machine: (), table, origin, from, maps, first, out }.call();
        });
    }
}

/// Moves consecutive vertices, beginning with `first`.
struct Vertices<'a, F: FourLanes> {
    machine: F::Machine,
    table: &'a WeightTable,
    origin: Point,
    from: &'a [Point],
    maps: &'a [Affine],
    first: usize,
    out: &'a mut [Point],
}

impl<F: FourLanes> NullaryFnOnce for Vertices<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { machine, table, origin, from, maps, first, out } = self;
        let vertices = first..first + out.len();
        let rows = table.nodes[vertices.clone()].iter().zip(&table.weights[vertices.clone()]);
        for ((out, &from), (&[i, j, k, l], &[w1, w2, w3])) in out.iter_mut().zip(&from[vertices]).zip(rows) {
            let splat = |x: f64| F::splat(machine, x);
            let weights = [splat(1.0 - w1 - w2 - w3), splat(w1), splat(w2), splat(w3)];
            let nodes = [&maps[i as usize], &maps[j as usize], &maps[k as usize], &maps[l as usize]];
            let [x, y, z] = sub(from, origin);
            let mut sum = splat(0.0);
            for (weight, map) in weights.into_iter().zip(nodes) {
                let column = |c: usize| F::load(machine, &map[c]);
                let change = column(0) * splat(x) + column(1) * splat(y) + column(2) * splat(z) + column(3);
                sum = sum + weight * change;
            }
            let [x, y, z, _] = sum.stored();
            *out = add(from, [x, y, z]);
        }
    }
}
