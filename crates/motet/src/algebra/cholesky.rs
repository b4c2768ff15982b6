//! Cholesky factorisation of a sparse matrix, kept for many right-hand sides; it is computed by the crate
//! `faer`.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::perm::PermRef;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

use crate::algebra::dissection::nested_dissection;
use crate::algebra::{Block, SparseMatrix, Vector3};
use crate::base::{Error, Result};

/// A lower triangular factor of a symmetric positive definite matrix, its rows ordered by nested dissection.
#[derive(Debug)]
pub struct Cholesky {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
    /// Scalars per row of blocks: 1 where a block is a number (the three components are then three right-hand
    /// sides), else 3.
    width: usize,
}

impl Cholesky {
    /// Factorises `matrix`, whose rows lie at `places`; `None` when the factor would take more than
    /// `max_bytes`, which is known before it is computed.
    ///
    /// # Errors
    /// When the matrix is not positive definite, or there is not enough memory for the factor.
    pub fn new<B: Block>(
        matrix: &SparseMatrix<B>,
        places: &[Vector3],
        max_bytes: u64,
    ) -> Result<Option<Self>> {
        let width = B::WIDTH;
        let (starts, rows, values) = upper_triangle(matrix);
        let n = starts.len() - 1;
        let order = nested_dissection(matrix, places);
        let forward: Vec<usize> =
            order.iter().flat_map(|&row| (0..width).map(move |k| row as usize * width + k)).collect();
        let mut inverse = vec![0; n];
        forward.iter().enumerate().for_each(|(place, &row)| inverse[row] = place);
        let pattern = SymbolicSparseColMatRef::new_checked(n, n, &starts, None, &rows);
        let out_of_memory = |_| {
            Error::input("not enough memory for the factor of a linear system")
                .remedy("do not request a factor (factor memory 0)")
        };
        let symbolic = factorize_symbolic_cholesky(
            pattern,
            Side::Upper,
            SymmetricOrdering::Custom(PermRef::new_checked(&forward, &inverse, n)),
            CholeskySymbolicParams::default(),
        )
        .map_err(out_of_memory)?;
        let length = symbolic.len_val();
        if length as u64 > max_bytes / size_of::<f64>() as u64 {
            return Ok(None);
        }
        let mut factor = Vec::new();
        factor.try_reserve_exact(length).map_err(|_| out_of_memory(faer::sparse::FaerError::OutOfMemory))?;
        factor.resize(length, 0.0);
        let mut stack =
            MemBuffer::try_new(symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()))
                .map_err(|_| out_of_memory(faer::sparse::FaerError::OutOfMemory))?;
        symbolic
            .factorize_numeric_llt(
                &mut factor,
                SparseColMatRef::new(pattern, &values),
                Side::Upper,
                Default::default(),
                Par::Seq,
                MemStack::new(&mut stack),
                Default::default(),
            )
            .map_err(|_| {
                Error::input(
                    "the matrix of a linear system is not positive definite and cannot be factorised",
                )
            })?;
        Ok(Some(Self { symbolic, values: factor, width }))
    }

    /// Memory taken by the factor, in bytes.
    pub fn n_bytes(&self) -> u64 {
        size_of_val(&self.values[..]) as u64
    }

    /// Solves `matrix x = right` and returns `x`.
    ///
    /// Panics when `right` does not have one vector for each row of the matrix.
    pub fn solve(&self, right: &[Vector3]) -> Vec<Vector3> {
        let (n, columns) = (right.len() * self.width, 3 / self.width);
        assert_eq!(n, self.symbolic.nrows(), "a right side for each row");
        // Where a block is a number, the three components are columns, one after the other.
        let mut x: Vec<f64> = match columns {
            1 => right.as_flattened().to_vec(),
            _ => (0..3).flat_map(|k| right.iter().map(move |r| r[k])).collect(),
        };
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq);
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(&mut x, n, columns),
            Par::Seq,
            MemStack::new(&mut MemBuffer::new(scratch)),
        );
        match columns {
            1 => x.chunks_exact(3).map(|x| [x[0], x[1], x[2]]).collect(),
            _ => (0..n).map(|i| [x[i], x[n + i], x[2 * n + i]]).collect(),
        }
    }
}

/// The upper triangle of a symmetric matrix with its diagonal, scalar by scalar, in compressed columns:
/// starts, rows, values. It is read from the lower triangle, whose rows are these columns.
fn upper_triangle<B: Block>(matrix: &SparseMatrix<B>) -> (Vec<usize>, Vec<usize>, Vec<f64>) {
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for row in 0..matrix.n_rows() {
        let (columns, blocks) = matrix.row(row);
        for i in 0..B::WIDTH {
            let at = row * B::WIDTH + i;
            for (&column, block) in columns.iter().zip(blocks) {
                let first = column as usize * B::WIDTH;
                for j in (0..B::WIDTH).filter(|j| first + j <= at) {
                    rows.push(first + j);
                    values.push(block.entry(i, j));
                }
            }
            starts.push(rows.len());
        }
    }
    (starts, rows, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::algebra::Block3;

    /// A grid of springs, held at its sides: the matrix times the solution gives back the right-hand side.
    fn check<B: Block>(spring: B, twice: B) {
        let side = 12;
        let place = |i: usize| [i % side, i / side % side, i / side / side];
        let apart =
            |a: usize, b: usize| -> usize { place(a).iter().zip(place(b)).map(|(x, y)| x.abs_diff(y)).sum() };
        let n = side * side * side;
        let near = |i: usize| -> Vec<u32> {
            let steps = [1, side, side * side];
            let all = steps.iter().flat_map(|s| [i.wrapping_sub(*s), i + s]).chain([i]);
            all.filter(|&j| j < n && apart(i, j) <= 1).map(|j| j as u32).collect()
        };
        let mut matrix = SparseMatrix::<B>::with_pattern((0..n).map(near));
        for i in 0..n {
            for j in near(i) {
                matrix.add(i, j, if j as usize == i { twice } else { spring });
            }
        }
        let places: Vec<Vector3> = (0..n).map(|i| place(i).map(|x| x as f64)).collect();
        let right: Vec<Vector3> = (0..n).map(|i| [i as f64, (i * i % 17) as f64 - 8.0, 1.0]).collect();
        assert!(Cholesky::new(&matrix, &places, 1000).unwrap().is_none());
        let factor = Cholesky::new(&matrix, &places, u64::MAX).unwrap().unwrap();
        assert!(factor.n_bytes() > 8 * n as u64);
        let x = factor.solve(&right);
        for (row, right) in right.iter().enumerate() {
            let got = matrix.row_times(row, &x);
            assert!((0..3).all(|k| (got[k] - right[k]).abs() < 1e-8), "{got:?} {right:?}");
        }
    }

    #[test]
    fn what_comes_out_is_a_solution() {
        check::<f64>(-1.0, 6.1);
        let twice: Block3 = [[6.5, 0.3, 0.1], [0.3, 6.9, -0.2], [0.1, -0.2, 7.0]];
        check::<Block3>([[-1.0, 0.05, 0.0], [0.05, -1.0, 0.02], [0.0, 0.02, -1.1]], twice);
    }

    #[test]
    fn what_has_no_factor_is_refused() {
        let mut matrix = SparseMatrix::<f64>::with_pattern([vec![0, 1], vec![0, 1]].into_iter());
        for (row, column, number) in [(0, 0, 1.0), (0, 1, 2.0), (1, 0, 2.0), (1, 1, 1.0)] {
            matrix.add(row, column, number);
        }
        assert!(Cholesky::new(&matrix, &[[0.0; 3], [1.0; 3]], u64::MAX).is_err());
    }
}
