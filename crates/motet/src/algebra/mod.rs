//! Floor 1: sparse matrices whose unknowns are vectors of three, and solving with them.
//!
//! | | |
//! |---|---|
//! | [`Block`] | what a matrix is made of: a number, or 3 x 3 numbers |
//! | [`SparseMatrix`] | blocks in compressed rows |
//! | [`conjugate_gradients`] | solves where the matrix is symmetric and positive definite |
//! | [`Sgs`], [`TwoLevel`] | what makes that converge: sweeps over all rows, and with them a correction by some thousand unknowns |
//! | [`Cholesky`] | a factor of such a matrix, kept for many right sides |

mod block;
mod cholesky;
mod conjugate_gradients;
mod dissection;
mod sparse;
mod two_level;

pub use block::{Block, Block3};
pub use cholesky::Cholesky;
pub use conjugate_gradients::{Preconditioner, Sgs, Solved, Tolerance, conjugate_gradients};
pub use sparse::SparseMatrix;
pub use two_level::TwoLevel;

/// An unknown, or what it has to be equal to: three numbers.
pub type Vector3 = [f64; 3];
