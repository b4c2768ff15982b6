//! Conjugate gradients (Hestenes and Stiefel 1952), preconditioned by a symmetric Gauss-Seidel sweep over
//! blocks.

use serde::Serialize;

use crate::algebra::{Block, SparseMatrix, Vector3};
use crate::base::{Error, Result, Threads};

/// When an iteration stops.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tolerance {
    /// Residual in the norm of the preconditioner, relative to that of the right-hand side.
    pub residual: f64,
    /// Maximum number of iterations.
    pub iterations: usize,
}

/// How a solution was reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Solved {
    /// Number of iterations.
    pub iterations: usize,
    /// Final residual, measured as in [`Tolerance::residual`].
    pub residual: f64,
}

/// Symmetric Gauss-Seidel, a forward and a backward sweep: `(D + L) D^-1 (D + U)` in place of the matrix
/// `L + D + U`. For elastic matrices of 8,000 to 166,000 vertices it needed a third of the iterations of the
/// diagonal blocks alone, each at twice the cost.
#[derive(Clone, Debug)]
pub struct Sgs<B> {
    inverses: Vec<B>,
}

impl<B> Default for Sgs<B> {
    /// The preconditioner of a matrix without rows.
    fn default() -> Self {
        Self { inverses: Vec::new() }
    }
}

impl<B: Block> Sgs<B> {
    /// # Errors
    /// When a block on the diagonal is not positive definite.
    pub fn new(matrix: &SparseMatrix<B>) -> Result<Self> {
        let inverse = |row| {
            matrix.diagonal(row).inverse().ok_or_else(|| {
                Error::input(format!(
                    "row {row} of the matrix of a linear system has no positive definite diagonal block"
                ))
            })
        };
        Ok(Self { inverses: (0..matrix.n_rows()).map(inverse).collect::<Result<_>>()? })
    }

    pub(super) fn inverses(&self) -> &[B] {
        &self.inverses
    }

    /// A forward sweep from zero for `residual`; the result goes to `out`.
    pub(super) fn forward(&self, matrix: &SparseMatrix<B>, residual: &[Vector3], out: &mut [Vector3]) {
        for i in 0..residual.len() {
            let (columns, blocks) = matrix.row(i);
            let mut sum = [0.0; 3];
            for (&column, block) in
                columns.iter().zip(blocks).take_while(|(column, _)| (**column as usize) < i)
            {
                block.add_times(out[column as usize], &mut sum);
            }
            out[i] = self.inverses[i].times(minus(residual[i], sum));
        }
    }

    /// The residual that remains after a forward sweep: `-U x`.
    pub(super) fn remaining_residual(
        &self,
        matrix: &SparseMatrix<B>,
        x: &[Vector3],
        threads: &Threads,
    ) -> Vec<Vector3> {
        threads.map(x.len(), |i| {
            let mut sum = [0.0; 3];
            for_each_right_of_diagonal(matrix, i, |column, block| block.add_times(x[column], &mut sum));
            sum.map(|x| -x)
        })
    }

    /// A backward sweep that starts from `x`, in place.
    pub(super) fn backward(&self, matrix: &SparseMatrix<B>, residual: &[Vector3], x: &mut [Vector3]) {
        for i in (0..x.len()).rev() {
            let (columns, blocks) = matrix.row(i);
            let mut sum = [0.0; 3];
            for (&column, block) in columns.iter().zip(blocks).filter(|(column, _)| **column as usize != i) {
                block.add_times(x[column as usize], &mut sum);
            }
            x[i] = self.inverses[i].times(minus(residual[i], sum));
        }
    }
}

/// Calls `each` with the column and the block of every entry of row `i` right of the diagonal, last first.
#[inline(always)]
fn for_each_right_of_diagonal<B: Block>(matrix: &SparseMatrix<B>, i: usize, mut each: impl FnMut(usize, B)) {
    let (columns, blocks) = matrix.row(i);
    for (&column, block) in columns.iter().zip(blocks).rev().take_while(|(column, _)| (**column as usize) > i)
    {
        each(column as usize, *block);
    }
}

/// A preconditioner of conjugate gradients: a symmetric positive definite map close to the inverse of the
/// matrix.
pub trait Preconditioner<B> {
    /// Applies the map to `residual`; the result, in `out`, is the same to the bit with any number of
    /// threads.
    fn apply(&self, matrix: &SparseMatrix<B>, residual: &[Vector3], out: &mut [Vector3], threads: &Threads);
}

impl<B: Block> Preconditioner<B> for Sgs<B> {
    fn apply(&self, matrix: &SparseMatrix<B>, residual: &[Vector3], out: &mut [Vector3], _: &Threads) {
        self.forward(matrix, residual, out);
        for i in (0..residual.len()).rev() {
            let mut sum = [0.0; 3];
            for_each_right_of_diagonal(matrix, i, |column, block| block.add_times(out[column], &mut sum));
            out[i] = minus(out[i], self.inverses[i].times(sum));
        }
    }
}

/// Solves `matrix x = right` for a symmetric positive definite matrix. On entry `x` holds a guess, zeros
/// where there is none; on return it holds the solution. The iteration starts from the best multiple of the
/// guess. The result is the same to the bit with any number of threads.
///
/// # Errors
/// When the tolerance is not reached within the allowed iterations, or the watch stops the call; `x` then
/// holds the last iterate.
pub fn conjugate_gradients<B: Block>(
    matrix: &SparseMatrix<B>,
    preconditioner: &impl Preconditioner<B>,
    right: &[Vector3],
    x: &mut [Vector3],
    tolerance: Tolerance,
    threads: &Threads,
) -> Result<Solved> {
    let n = right.len();
    let mut z = vec![[0.0; 3]; n];
    preconditioner.apply(matrix, right, &mut z, threads);
    let right_squared = dot(right, &z);
    if right_squared == 0.0 {
        x.fill([0.0; 3]);
        return Ok(Solved::default());
    }
    let matrix_x = matrix.times(x, threads);
    let energy = dot(x, &matrix_x);
    let share = if energy > 0.0 { dot(x, right) / energy } else { 0.0 };
    x.iter_mut().for_each(|x| *x = x.map(|x| share * x));
    let mut residual: Vec<Vector3> =
        right.iter().zip(&matrix_x).map(|(b, ax)| minus(*b, ax.map(|ax| share * ax))).collect();
    preconditioner.apply(matrix, &residual, &mut z, threads);
    let mut rz = dot(&residual, &z);
    let mut direction = z.clone();
    let mut solved = Solved { iterations: 0, residual: (rz / right_squared).sqrt() };
    while solved.residual > tolerance.residual {
        threads.watch().report_and_check("solving a system", solved.iterations, 0)?;
        if solved.iterations == tolerance.iterations || !solved.residual.is_finite() {
            return Err(Error::input(format!(
                "after {} iterations the residual is {:.1e}; {:.1e} was requested",
                solved.iterations, solved.residual, tolerance.residual
            ))
            .remedy("allow a larger residual, or use a mesh whose cells are less flat"));
        }
        let matrix_direction = matrix.times(&direction, threads);
        let alpha = rz / dot(&direction, &matrix_direction);
        for i in 0..n {
            for k in 0..3 {
                x[i][k] += alpha * direction[i][k];
                residual[i][k] -= alpha * matrix_direction[i][k];
            }
        }
        preconditioner.apply(matrix, &residual, &mut z, threads);
        let next = dot(&residual, &z);
        let beta = next / rz;
        direction.iter_mut().zip(&z).for_each(|(p, z)| (0..3).for_each(|k| p[k] = z[k] + beta * p[k]));
        rz = next;
        solved = Solved { iterations: solved.iterations + 1, residual: (rz / right_squared).sqrt() };
    }
    Ok(solved)
}

fn minus(a: Vector3, b: Vector3) -> Vector3 {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn dot(a: &[Vector3], b: &[Vector3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::Block3;

    /// A chain of springs, held at both ends: the exact inverse is known.
    #[test]
    fn a_chain_takes_the_shape_of_a_parabola() {
        let n = 60;
        let near = |i: usize| (i.saturating_sub(1)..(i + 2).min(n)).map(|j| j as u32).collect();
        let mut matrix = SparseMatrix::<f64>::with_pattern((0..n).map(near));
        for i in 0..n {
            matrix.add(i, i as u32, 2.0);
            if i > 0 {
                matrix.add(i, i as u32 - 1, -1.0);
                matrix.add(i - 1, i as u32, -1.0);
            }
        }
        let sweeps = Sgs::new(&matrix).unwrap();
        let right = vec![[1.0, -2.0, 0.0]; n];
        let tolerance = Tolerance { residual: 1e-13, iterations: 1000 };
        for threads in [Threads::single(), Threads::new(2).unwrap()] {
            let mut x = vec![[0.0; 3]; n];
            let solved = conjugate_gradients(&matrix, &sweeps, &right, &mut x, tolerance, &threads).unwrap();
            assert!(solved.iterations > 0 && solved.residual <= 1e-13);
            for (i, x) in x.iter().enumerate() {
                let exact = (i + 1) as f64 * (n - i) as f64 / 2.0;
                assert!((x[0] - exact).abs() < 1e-9 && (x[1] + 2.0 * exact).abs() < 1e-9 && x[2] == 0.0);
            }
            // A multiple of the solution is as good as the solution.
            x.iter_mut().for_each(|x| *x = x.map(|x| 3.0 * x));
            let again = conjugate_gradients(&matrix, &sweeps, &right, &mut x, tolerance, &threads).unwrap();
            assert!(again.iterations <= 1, "{again:?}");
        }
        let few = Tolerance { iterations: 3, ..tolerance };
        let mut x = vec![[0.0; 3]; n];
        let error =
            conjugate_gradients(&matrix, &sweeps, &right, &mut x, few, &Threads::single()).unwrap_err();
        assert!(error.what().contains("3 iterations") && error.remedy_text().is_some());
    }

    #[test]
    fn blocks_are_inverted_or_refused() {
        let block: Block3 = [[4.0, 1.0, 0.5], [1.0, 3.0, -1.0], [0.5, -1.0, 2.0]];
        let inverse = block.inverse().unwrap();
        for k in 0..3 {
            let mut unit = [0.0; 3];
            unit[k] = 1.0;
            let back = inverse.times(block.times(unit));
            assert!((0..3).all(|i| (back[i] - unit[i]).abs() < 1e-15), "{back:?}");
        }
        assert!([[1.0, 2.0, 0.0], [2.0, 1.0, 0.0], [0.0, 0.0, 1.0]].inverse().is_none());
        assert!(0.0f64.inverse().is_none() && (-1.0f64).inverse().is_none());
        let empty = SparseMatrix::<f64>::with_pattern(std::iter::once(vec![]));
        assert!(Sgs::new(&empty).is_err());
    }
}
