//! A two-level preconditioner: a Gauss-Seidel sweep, a correction by some thousand unknowns that span what
//! the sweep cannot reduce, and a sweep back.
//!
//! Smoothed aggregation (Vanek, Mandel, Brezina 1996): neighbouring rows form aggregates, each aggregate
//! moves as a rigid body (or by one number), and these motions are smoothed by one Jacobi step. The matrix of
//! the aggregates is factorised.

use std::collections::VecDeque;

use crate::algebra::{Block, Cholesky, Preconditioner, Sgs, SparseMatrix, Vector3};
use crate::base::{Result, Threads};

/// Rows per aggregate, approximately. Elastic matrices of meshes of 32,000 and 73,000 vertices were solved in
/// 0.50 and 1.57 s with 40 rows, 0.35 and 1.41 s with 80, 0.30 and 1.38 s with 160, 0.30 and 1.58 s with 320;
/// in 0.47 and 2.87 s by sweeps alone.
const ROWS_PER_AGGREGATE: usize = 160;
/// Approximate limit on the number of aggregates: a factor of more would take longer than it saves.
const MAX_AGGREGATES: usize = 2000;
/// Shift of the diagonal of the matrix of the aggregates, relative to its largest diagonal entry.
const DIAGONAL_SHIFT: f64 = 1e-10;
/// Maximum size of the factor, in bytes.
const MAX_FACTOR_BYTES: u64 = 1 << 31;

/// A two-level preconditioner.
#[derive(Debug)]
pub struct TwoLevel<B> {
    sweeps: Sgs<B>,
    /// Maps unknowns of the aggregates to rows.
    prolongation: SparseMatrix<B>,
    restriction: SparseMatrix<B>,
    factor: Cholesky,
}

impl<B: Block> TwoLevel<B> {
    /// The preconditioner of a symmetric positive definite matrix whose rows lie at `places`; `None` when the
    /// matrix of the aggregates has no factor, or one that is too large.
    ///
    /// # Errors
    /// When a block on the diagonal is not positive definite.
    pub fn new(matrix: &SparseMatrix<B>, places: &[Vector3], threads: &Threads) -> Result<Option<Self>> {
        let sweeps = Sgs::new(matrix)?;
        let aggregates = Aggregates::new(matrix, places);
        let (rigid, centres) = aggregates.motions::<B>(places);
        let inverses = sweeps.inverses();
        let damping = 4.0 / 3.0 / largest_eigenvalue(matrix, inverses, threads);
        // I - damping D^-1 A
        let mut prolongation = matrix.product(&rigid);
        prolongation.change_rows(|row, block| inverses[row].times_block(block).scaled(-damping));
        for row in 0..rigid.n_rows() {
            let (columns, blocks) = rigid.row(row);
            columns.iter().zip(blocks).for_each(|(&column, block)| prolongation.add(row, column, *block));
        }
        let restriction = prolongation.transposed(centres.len());
        let mut coarse = restriction.product(&matrix.product(&prolongation));
        // An aggregate whose rows are collinear does not respond to a rotation about their line.
        let largest = (0..coarse.n_rows()).map(|row| coarse.diagonal(row).entry(0, 0)).fold(0.0, f64::max);
        (0..coarse.n_rows()).for_each(|row| {
            coarse.add(row, row as u32, B::rigid([0.0; 3]).as_ref()[0].scaled(DIAGONAL_SHIFT * largest))
        });
        let factor = Cholesky::new(&coarse, &centres, MAX_FACTOR_BYTES).ok().flatten();
        Ok(factor.map(|factor| Self { sweeps, prolongation, restriction, factor }))
    }
}

impl<B: Block> Preconditioner<B> for TwoLevel<B> {
    fn apply(&self, matrix: &SparseMatrix<B>, residual: &[Vector3], out: &mut [Vector3], threads: &Threads) {
        self.sweeps.forward(matrix, residual, out);
        let remaining = self.sweeps.remaining_residual(matrix, out, threads);
        let coarse_solution = self.factor.solve(&self.restriction.times(&remaining, threads));
        let correction = self.prolongation.times(&coarse_solution, threads);
        out.iter_mut().zip(&correction).for_each(|(x, c)| (0..3).for_each(|k| x[k] += c[k]));
        self.sweeps.backward(matrix, residual, out);
    }
}

/// Rows grouped into aggregates.
struct Aggregates {
    of_row: Vec<u32>,
    n: usize,
}

impl Aggregates {
    /// Groups rows that the entries of the matrix connect.
    fn new<B: Block>(matrix: &SparseMatrix<B>, places: &[Vector3]) -> Self {
        const NONE: u32 = u32::MAX;
        let n_rows = places.len();
        let size = ROWS_PER_AGGREGATE.max(n_rows / MAX_AGGREGATES);
        let (mut of_row, mut n, mut front) = (vec![NONE; n_rows], 0, VecDeque::new());
        for first in 0..n_rows {
            if of_row[first] != NONE {
                continue;
            }
            let mut rows = vec![first];
            of_row[first] = n;
            front.clear();
            front.push_back(first);
            while let Some(row) = front.pop_front() {
                for &next in matrix.row(row).0 {
                    if rows.len() < size && of_row[next as usize] == NONE {
                        of_row[next as usize] = n;
                        rows.push(next as usize);
                        front.push_back(next as usize);
                    }
                }
            }
            // A small remainder between others joins one of them.
            let neighbour = || {
                let near = rows.iter().flat_map(|&row| matrix.row(row).0);
                near.map(|&c| of_row[c as usize]).find(|&aggregate| aggregate != NONE && aggregate != n)
            };
            match neighbour().filter(|_| 4 * rows.len() < size) {
                Some(aggregate) => rows.iter().for_each(|&row| of_row[row] = aggregate),
                None => n += 1,
            }
        }
        Self { of_row, n: n as usize }
    }

    /// The rigid motions of the aggregates, as a matrix from their unknowns to rows, and the position of each
    /// of these unknowns.
    fn motions<B: Block>(&self, places: &[Vector3]) -> (SparseMatrix<B>, Vec<Vector3>) {
        let (mut centres, mut counts) = (vec![[0.0; 3]; self.n], vec![0.0; self.n]);
        for (&aggregate, place) in self.of_row.iter().zip(places) {
            (0..3).for_each(|k| centres[aggregate as usize][k] += place[k]);
            counts[aggregate as usize] += 1.0;
        }
        centres.iter_mut().zip(&counts).for_each(|(c, n)| *c = c.map(|x| x / n));
        let from = |row: usize| -> Vector3 {
            let (p, c) = (places[row], centres[self.of_row[row] as usize]);
            std::array::from_fn(|k| p[k] - c[k])
        };
        // Rotations are scaled to be as large as translations.
        let mut radii = vec![0.0; self.n];
        for (row, &aggregate) in self.of_row.iter().enumerate() {
            radii[aggregate as usize] +=
                from(row).iter().map(|x| x * x).sum::<f64>() / counts[aggregate as usize];
        }
        let modes = |row: usize| {
            let radius = radii[self.of_row[row] as usize].sqrt();
            B::rigid(from(row).map(|x| if radius > 0.0 { x / radius } else { 0.0 }))
        };
        let width = modes(0).as_ref().len();
        let columns = |aggregate: u32| (0..width as u32).map(move |i| aggregate * width as u32 + i);
        let mut matrix =
            SparseMatrix::with_pattern(self.of_row.iter().map(|&aggregate| columns(aggregate).collect()));
        for (row, &aggregate) in self.of_row.iter().enumerate() {
            columns(aggregate)
                .zip(modes(row).as_ref())
                .for_each(|(column, block)| matrix.add(row, column, *block));
        }
        (matrix, centres.iter().flat_map(|c| std::iter::repeat_n(*c, width)).collect())
    }
}

/// A lower estimate of the largest eigenvalue of `D^-1 A`, by the power method.
fn largest_eigenvalue<B: Block>(matrix: &SparseMatrix<B>, inverses: &[B], threads: &Threads) -> f64 {
    const ROUNDS: usize = 12;
    let n = matrix.n_rows();
    // A start vector with components in all directions, the same in each run.
    let mut x: Vec<Vector3> = (0..n as u32)
        .map(|i| {
            [1, 2, 3]
                .map(|k: u32| f64::from(i.wrapping_mul(2_654_435_761).wrapping_mul(k) >> 16) / 32768.0 - 1.0)
        })
        .collect();
    let mut value = 1.0;
    for _ in 0..ROUNDS {
        let size = x.as_flattened().iter().map(|x| x * x).sum::<f64>().sqrt();
        x.iter_mut().for_each(|x| *x = x.map(|x| x / size));
        let image = matrix.times(&x, threads);
        x = image.iter().zip(inverses).map(|(y, inverse)| inverse.times(*y)).collect();
        value = x.as_flattened().iter().map(|x| x * x).sum::<f64>().sqrt();
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::{Block3, Tolerance, conjugate_gradients};

    /// A long rod of springs, held at one end, for which sweeps alone need many iterations.
    fn rod<B: Block>(spring: B) -> (SparseMatrix<B>, Vec<Vector3>) {
        let (length, side) = (600, 3);
        let place = |i: usize| [i / side / side, i / side % side, i % side];
        let n = length * side * side;
        let near = |i: usize| -> Vec<usize> {
            let steps = [1, side, side * side];
            let all = steps.iter().flat_map(|s| [i.wrapping_sub(*s), i + s]);
            let apart = |j: &usize| -> usize { (0..3).map(|k| place(i)[k].abs_diff(place(*j)[k])).sum() };
            all.filter(|j| *j < n && apart(j) == 1).collect()
        };
        let pattern = (0..n).map(|i| near(i).into_iter().chain([i]).map(|j| j as u32).collect());
        let mut matrix = SparseMatrix::<B>::with_pattern(pattern);
        for i in 0..n {
            for j in near(i) {
                matrix.add(i, j as u32, spring.scaled(-1.0));
                matrix.add(i, i as u32, spring);
            }
            if place(i)[0] == 0 {
                matrix.add(i, i as u32, spring);
            }
        }
        (matrix, (0..n).map(|i| place(i).map(|x| x as f64)).collect())
    }

    fn check<B: Block>(spring: B) {
        let (matrix, places) = rod(spring);
        let right: Vec<Vector3> = (0..places.len()).map(|i| [1.0, (i % 7) as f64, -2.0]).collect();
        fn solve<B: Block>(
            matrix: &SparseMatrix<B>,
            right: &[Vector3],
            preconditioner: &impl Preconditioner<B>,
            threads: &Threads,
        ) -> (usize, Vec<Vector3>) {
            let tolerance = Tolerance { residual: 1e-10, iterations: 10_000 };
            let mut x = vec![[0.0; 3]; right.len()];
            let solved =
                conjugate_gradients(matrix, preconditioner, right, &mut x, tolerance, threads).unwrap();
            (solved.iterations, x)
        }
        let sweeps = Sgs::new(&matrix).unwrap();
        let levels = TwoLevel::new(&matrix, &places, &Threads::single()).unwrap().unwrap();
        let (many, expected) = solve(&matrix, &right, &sweeps, &Threads::single());
        let (few, got) = solve(&matrix, &right, &levels, &Threads::single());
        assert!(3 * few < many, "{few} iterations, by sweeps alone {many}");
        let size = expected.as_flattened().iter().fold(0.0f64, |a, x| a.max(x.abs()));
        let off = expected.as_flattened().iter().zip(got.as_flattened()).map(|(a, b)| (a - b).abs());
        assert!(off.fold(0.0, f64::max) < 1e-6 * size);
        assert_eq!(solve(&matrix, &right, &levels, &Threads::new(2).unwrap()), (few, got));
    }

    #[test]
    fn two_levels_take_fewer_iterations_to_the_same() {
        check::<f64>(1.0);
        check::<Block3>([[1.0, 0.2, 0.0], [0.2, 1.5, 0.1], [0.0, 0.1, 2.0]]);
    }
}
