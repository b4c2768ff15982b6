//! The shares of each vertex in a body's translation and in its rotation.
//!
//! Both are harmonic, 1 on the body and 0 at all other prescribed vertices, so that they vary smoothly and
//! never leave this range. What degrades cells is the slope of the share, for a rotation times the distance
//! from the body's centre; conductivities that follow a power of that slope spread it evenly. That is the
//! equation of the p-Laplacian, `p = 8`, solved with conductivities from the previous solution.
//! Conductivities also fall with the length of edges, for a translation with its square, so that small cells
//! are stiffer.
//!
//! Results for a sphere in a box: bad tets, [inverted ones], after two sweeps of smoothing; and the seconds
//! that the set-up of the second mesh takes.
//!
//! | p | rounds | uniform cells, 18,502 vertices: 1, 2, 3 radii | 90 degrees | growing cells, 31,736 vertices: 1, 2, 3 radii | 90 degrees | seconds |
//! |---|---|---|---|---|---|---|
//! | 4 | 6, by half | 1, 9, 431 [17] | 25 | 0, 0, 493 | 102 | 0.71 |
//! | 6 | 12, by a third | 1, 2, 202 | 25 | 0, 0, 425 | 94 | 1.04 |
//! | 8 | 16, by a quarter | 1, 1, 145 | 31 | 0, 0, 413 | 93 | 1.31 |
//!
//! All bodies share the conductivities: where several move alike, the shares between them add up to 1.

use crate::algebra::{Tolerance, conjugate_gradients};
use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::tet::centroid;
use crate::geometry::vector::{add, distance, dot, norm, scale, sub};
use crate::motion::elements::{Numbering, System, gradients, laplacian};
use crate::motion::methods::bodies::band;
use crate::motion::nodes::Nodes;

/// Shares of translation and rotation: for each vertex, those of all bodies.
#[derive(Debug)]
pub(super) struct Fields {
    n_bodies: usize,
    shares: Vec<[f64; 2]>,
}

/// Conductivities are proportional to the squared slope to this power: `(p - 2) / 2`.
const POWER: f64 = 3.0;
/// Number of solutions before the final one.
const ROUNDS: usize = 16;
/// Relaxation factor between these solutions: a full step oscillates.
const RELAXATION: f64 = 0.25;
/// The smallest slope that counts, relative to the mean.
const MIN_SLOPE: f64 = 1e-2;
const ROUGH: Tolerance = Tolerance { residual: 1e-3, iterations: 10_000 };
const FINE: Tolerance = Tolerance { residual: 1e-8, iterations: 10_000 };

/// The domain that both fields are solved on.
struct Domain<'a> {
    tets: Vec<[VertexId; 4]>,
    numbers: Vec<[u32; 4]>,
    /// For each tet, the mean edge length at its corners.
    lengths: Vec<f64>,
    points: &'a [Point],
    numbering: Numbering,
    /// Prescribed shares, three bodies at a time.
    given: Vec<Vec<Point>>,
    /// The centre of each body.
    centres: Vec<Point>,
    threads: &'a Threads,
}

impl Fields {
    pub(super) fn new(
        bodies: &[Vec<u32>],
        tets: &[[VertexId; 4]],
        points: &[Point],
        (free, nodes): (&[VertexId], &Nodes),
        threads: &Threads,
    ) -> Result<Self> {
        // A sliding vertex belongs to no wall.
        let sliding = nodes.sliding();
        let vertex = |n: &u32| nodes.vertices[*n as usize];
        let free: Vec<VertexId> = free.iter().copied().chain(sliding.iter().map(vertex)).collect();
        let held: Vec<u32> =
            (0..nodes.vertices.len() as u32).filter(|n| sliding.binary_search(n).is_err()).collect();
        let held_vertices: Vec<VertexId> = held.iter().map(vertex).collect();
        let index = |v: &VertexId| v.index();
        let numbering = Numbering::new(points.len(), free.iter().map(index), held_vertices.iter().map(index));
        let numbered = numbering.of_tets(tets);
        let of_nodes = |three: &[Vec<u32>]| {
            let mut on_driven = vec![[0.0; 3]; nodes.n_driven];
            for (k, body) in three.iter().enumerate() {
                body.iter().for_each(|&n| on_driven[n as usize][k] = 1.0);
            }
            let all = nodes.extended_to_layer(&on_driven);
            held.iter().map(|&n| all[n as usize]).collect()
        };
        let at = |n: &u32| points[nodes.vertices[*n as usize].index()];
        let centre =
            |body: &Vec<u32>| scale(body.iter().map(at).fold([0.0; 3], add), 1.0 / body.len().max(1) as f64);
        let domain = Domain {
            lengths: lengths(&numbered.vertices, points),
            tets: numbered.vertices,
            numbers: numbered.numbers,
            points,
            numbering,
            given: bodies.chunks(3).map(of_nodes).collect(),
            centres: bodies.iter().map(centre).collect(),
            threads,
        };
        let mut shares = vec![[0.0; 2]; points.len() * bodies.len()];
        for (kind, turn) in [false, true].into_iter().enumerate() {
            for (group, values) in domain.solve(turn)?.iter().enumerate() {
                let all = free.iter().zip(values).chain(held_vertices.iter().zip(&domain.given[group]));
                for (v, three) in all {
                    let of_vertex = &mut shares[v.index() * bodies.len()..][3 * group..];
                    for (share, value) in
                        of_vertex.iter_mut().zip(three).take((bodies.len() - 3 * group).min(3))
                    {
                        share[kind] = value.clamp(0.0, 1.0);
                    }
                }
            }
        }
        Ok(Self { n_bodies: bodies.len(), shares })
    }

    /// Shares that fall from 1 to 0 in a band around each body, equal for translation and rotation: see
    /// [`band`].
    pub(super) fn of_band(
        bodies: &[Vec<u32>],
        tets: &[[VertexId; 4]],
        points: &[Point],
        nodes: &Nodes,
    ) -> Self {
        let sliding = nodes.sliding();
        let vertex = |n: u32| nodes.vertices[n as usize];
        let held = (0..nodes.vertices.len() as u32).filter(|n| sliding.binary_search(n).is_err());
        let held: Vec<VertexId> = held.map(vertex).collect();
        let of_body = |body: &Vec<u32>| body.iter().map(|&n| vertex(n)).collect();
        let bodies: Vec<Vec<VertexId>> = bodies.iter().map(of_body).collect();
        let shares = band::shares(&bodies, &held, tets, points);
        Self { n_bodies: bodies.len(), shares: shares.into_iter().map(|share| [share; 2]).collect() }
    }

    /// Shares of a vertex in the translations and rotations of the bodies.
    #[inline]
    pub(super) fn of(&self, v: usize) -> &[[f64; 2]] {
        &self.shares[v * self.n_bodies..(v + 1) * self.n_bodies]
    }
}

impl Domain<'_> {
    /// Shares of each free vertex, for three bodies at a time.
    fn solve(&self, turn: bool) -> Result<Vec<Vec<Point>>> {
        let mut system = System::<f64>::with_pattern(&self.numbering, &self.numbers);
        let stiffness: Vec<f64> =
            self.lengths.iter().map(|h| if turn { 1.0 / h } else { 1.0 / (h * h) }).collect();
        let mut conductivities = stiffness.clone();
        let n_free = self.numbering.n_free();
        let mut shares = vec![vec![[0.0; 3]; n_free]; self.given.len()];
        for round in 0..=ROUNDS {
            system.fill(&self.numbers, |t| self.matrix(t, conductivities[t]))?;
            let tolerance = if round < ROUNDS { ROUGH } else { FINE };
            for (shares, given) in shares.iter_mut().zip(&self.given) {
                let right: Vec<Point> =
                    system.coupling.times(given, self.threads).into_iter().map(|f| f.map(|x| -x)).collect();
                let mut new = shares.clone();
                conjugate_gradients(
                    &system.inner,
                    &system.sweeps,
                    &right,
                    &mut new,
                    tolerance,
                    self.threads,
                )?;
                let part = if round == 0 || round == ROUNDS { 1.0 } else { RELAXATION };
                shares
                    .iter_mut()
                    .zip(new)
                    .for_each(|(old, new)| *old = add(*old, scale(sub(new, *old), part)));
            }
            let slopes = self.threads.map(self.tets.len(), |t| self.slope_squared(t, &shares, turn));
            let mean = slopes.iter().map(|s| s.sqrt()).sum::<f64>() / slopes.len().max(1) as f64;
            let min_slope = (MIN_SLOPE * mean).powi(2);
            conductivities = stiffness
                .iter()
                .zip(slopes)
                .map(|(k, s)| k * (s.max(min_slope) / (mean * mean)).powf(POWER))
                .collect();
        }
        Ok(shares)
    }

    fn corners(&self, t: usize) -> [Point; 4] {
        self.tets[t].map(|v| self.points[v.index()])
    }

    fn matrix(&self, t: usize, conductivity: f64) -> [[f64; 4]; 4] {
        let Some((g, volume)) = gradients(self.corners(t)) else { return [[0.0; 4]; 4] };
        laplacian(&g, conductivity * volume)
    }

    /// The sum of the squared slopes of all shares in a tet; those of rotations are multiplied by the squared
    /// distance from the body's centre.
    fn slope_squared(&self, t: usize, shares: &[Vec<Point>], turn: bool) -> f64 {
        let corners = self.corners(t);
        let Some((g, _)) = gradients(corners) else { return 0.0 };
        let n_free = self.numbering.n_free();
        let mut sum = 0.0;
        for (i, &centre) in self.centres.iter().enumerate() {
            let value = |number: u32| {
                let number = number as usize;
                let (of, number) = if number < n_free {
                    (&shares[i / 3], number)
                } else {
                    (&self.given[i / 3], number - n_free)
                };
                of[number][i % 3]
            };
            let slope = self.numbers[t].iter().zip(g).fold([0.0; 3], |s, (n, g)| add(s, scale(g, value(*n))));
            let arm = if turn { distance(centroid(corners), centre) } else { 1.0 };
            sum += arm * arm * dot(slope, slope);
        }
        sum
    }
}

/// The mean over the corners of each tet of the mean length of the edges there. An edge counts once for each
/// tet that contains it.
fn lengths(tets: &[[VertexId; 4]], points: &[Point]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); points.len()];
    for tet in tets {
        for i in 0..4 {
            for j in 0..i {
                let length = norm(sub(points[tet[i].index()], points[tet[j].index()]));
                for v in [tet[i], tet[j]] {
                    let (sum, count) = &mut sums[v.index()];
                    *sum += length;
                    *count += 1.0;
                }
            }
        }
    }
    let of_vertex = |v: VertexId| sums[v.index()].0 / sums[v.index()].1;
    tets.iter().map(|tet| 0.25 * tet.iter().map(|&v| of_vertex(v)).sum::<f64>()).collect()
}
