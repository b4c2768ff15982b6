//! Radial basis functions of compact support (de Boer, van der Schoot, Bijl 2007), with centres added in each
//! step where the error on the boundary is largest (Rendall, Allen 2009).
//!
//! `d(x) = sum a_c phi(|x - c| / R)`, `phi(r) = (1 - r)^4 (4 r + 1)` below 1 and 0 beyond (Wendland 1995,
//! C2); `R` is half of the extent of the mesh. Boundary vertices move exactly by their displacements all the
//! same; those near them are off by as much as the basis is.

use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::vector::{add, distance, norm, scale, sub};
use crate::mesh::bounds;
use crate::motion::methods::{Follower, Prepare, Prepared, Scene};
use crate::motion::setup::Setup;
use crate::motion::update::Displacements;

/// Radial basis functions: nothing is taken from the mesh as it was given.
#[derive(Debug)]
pub(crate) struct Radial;

impl Prepare for Radial {
    fn prepare(&self, scene: &Scene<'_>, points: &[Point], _: &Threads) -> Result<Prepared> {
        let (free, staying) = scene.used();
        let follower = RadialFollower::new(&scene.nodes.vertices, free, points);
        Ok(Prepared { follower, staying, graph_tets: Vec::new(), setup: Setup::default() }.boxed())
    }
}

/// All nodes, from which each step chooses centres.
#[derive(Debug)]
struct RadialFollower {
    nodes: Vec<VertexId>,
    free: Vec<VertexId>,
    radius: f64,
}

/// Centres added at once.
const CENTRES_PER_ROUND: usize = 8;
/// Maximum number of centres: the work grows with its square, and overlapping supports couple their
/// equations.
const MAX_CENTRES: usize = 1000;
/// Error allowed on the boundary, relative to the largest displacement.
const MAX_ERROR: f64 = 1e-3;

/// Centres, and the Cholesky factor of their matrix, row by row.
#[derive(Default)]
struct Centres {
    nodes: Vec<usize>,
    rows: Vec<Vec<f64>>,
    /// The displacements after forward substitution.
    half_solved: Vec<Point>,
}

impl RadialFollower {
    fn new(nodes: &[VertexId], free: Vec<VertexId>, points: &[Point]) -> Self {
        let places: Vec<Point> = nodes.iter().map(|v| points[v.index()]).collect();
        let extent = bounds(&places).map_or(1.0, |[low, high]| norm(sub(high, low)));
        Self { nodes: nodes.to_vec(), free, radius: 0.5 * extent }
    }

    fn phi(&self, a: Point, b: Point) -> f64 {
        let r = distance(a, b) / self.radius;
        let rest = (1.0 - r).max(0.0);
        rest * rest * rest * rest * (4.0 * r + 1.0)
    }

    fn sum(&self, p: Point, centres: &Centres, places: &[Point], weights: &[Point]) -> Point {
        let parts = centres.nodes.iter().zip(weights);
        parts.fold([0.0; 3], |sum, (&c, &a)| add(sum, scale(a, self.phi(p, places[c]))))
    }
}

impl Follower for RadialFollower {
    fn follow(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let table = displacements.table();
        let places: Vec<Point> = self.nodes.iter().map(|v| from[v.index()]).collect();
        let wanted: Vec<Point> = table[..places.len()].iter().map(|d| d.point()).collect();
        let largest = wanted.iter().map(|d| norm(*d)).fold(0.0, f64::max);
        let mut centres = Centres::default();
        let mut weights: Vec<Point> = Vec::new();
        loop {
            let off = threads.map(places.len(), |i| {
                norm(sub(wanted[i], self.sum(places[i], &centres, &places, &weights)))
            });
            let mut order: Vec<usize> = (0..off.len()).filter(|&i| off[i] > MAX_ERROR * largest).collect();
            order.sort_by(|&i, &j| off[j].total_cmp(&off[i]).then(i.cmp(&j)));
            let before = centres.nodes.len();
            for &i in &order {
                if centres.nodes.len() < (before + CENTRES_PER_ROUND).min(MAX_CENTRES) {
                    centres.add(i, wanted[i], |j| self.phi(places[i], places[j]));
                }
            }
            if centres.nodes.len() == before {
                break;
            }
            weights = centres.solved();
        }
        let moved = threads.map(self.free.len(), |i| {
            let p = from[self.free[i].index()];
            add(p, self.sum(p, &centres, &places, &weights))
        });
        out.copy_from_slice(from);
        self.free.iter().zip(moved).for_each(|(v, p)| out[v.index()] = p);
        for (v, d) in self.nodes.iter().zip(&wanted) {
            out[v.index()] = add(from[v.index()], *d);
        }
        Ok(centres.nodes.len())
    }
}

impl Centres {
    /// Adds a row to the factor, unless the centre depends on those before it.
    fn add(&mut self, node: usize, wanted: Point, phi: impl Fn(usize) -> f64) {
        let mut row: Vec<f64> = Vec::with_capacity(self.nodes.len() + 1);
        for (other, &c) in self.rows.iter().zip(&self.nodes) {
            let known: f64 = row.iter().zip(other).map(|(a, b)| a * b).sum();
            row.push((phi(c) - known) / other[row.len()]);
        }
        let pivot = 1.0 - row.iter().map(|x| x * x).sum::<f64>();
        if pivot < 1e-12 {
            return;
        }
        let known = row.iter().zip(&self.half_solved).fold([0.0; 3], |s, (x, h)| add(s, scale(*h, *x)));
        let pivot = pivot.sqrt();
        self.half_solved.push(scale(sub(wanted, known), 1.0 / pivot));
        row.push(pivot);
        self.rows.push(row);
        self.nodes.push(node);
    }

    /// Backward substitution: the weights of the centres.
    fn solved(&self) -> Vec<Point> {
        let mut solved = self.half_solved.clone();
        for i in (0..solved.len()).rev() {
            solved[i] = scale(solved[i], 1.0 / self.rows[i][i]);
            for j in 0..i {
                solved[j] = sub(solved[j], scale(solved[i], self.rows[i][j]));
            }
        }
        solved
    }
}
