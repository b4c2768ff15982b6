//! Floor 1: sparse matrices whose unknowns are 3-vectors, and solvers for them.
//!
//! Internal: public for tests, benchmarks and extensions, and may change with any version.
//!
//! | | |
//! |---|---|
//! | [`Block`] | an entry of a matrix: a number, or 3 x 3 numbers |
//! | [`SparseMatrix`] | blocks in compressed rows |
//! | [`conjugate_gradients`] | solves symmetric positive definite systems |
//! | [`Sgs`], [`TwoLevel`] | its preconditioners: sweeps over all rows, and these with a coarse correction of some thousand unknowns |
//! | [`Cholesky`] | a factor of such a matrix, kept for many right-hand sides |

mod block;
#[cfg(feature = "elasticity")]
mod cholesky;
mod conjugate_gradients;
#[cfg(feature = "elasticity")]
mod dissection;
mod sparse;
#[cfg(feature = "elasticity")]
mod two_level;

pub use block::{Block, Block3};
#[cfg(feature = "elasticity")]
pub use cholesky::Cholesky;
pub use conjugate_gradients::{Preconditioner, Sgs, Solved, Tolerance, conjugate_gradients};
pub use sparse::SparseMatrix;
#[cfg(feature = "elasticity")]
pub use two_level::TwoLevel;

/// An unknown, or its right-hand side: three numbers.
pub type Vector3 = [f64; 3];
