//! Floor 1: sparse matrices whose unknowns are vectors of three, and solving with them.
//!
//! | | |
//! |---|---|
//! | [`Block`] | what a matrix is made of: a number, or 3 x 3 numbers |
//! | [`SparseMatrix`] | blocks in compressed rows |
//! | [`conjugate_gradients`] | solves where the matrix is symmetric and positive definite |

mod block;
mod conjugate_gradients;
mod sparse;

pub use block::{Block, Block3};
pub use conjugate_gradients::{Sgs, Solved, Tolerance, conjugate_gradients};
pub use sparse::SparseMatrix;

/// An unknown, or what it has to be equal to: three numbers.
pub type Vector3 = [f64; 3];
