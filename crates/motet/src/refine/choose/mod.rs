//! What to divide, and which divisions may be taken back.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | estimate | [`estimate`] | how badly a field is resolved in each tet; where a flow rotates |
//! | size | [`hessian`], [`sizes`] | the curvature of a field at each vertex, and the edge lengths it calls for |
//! | mark | [`mark`] | tets by place, size, distance to a surface, estimate |
//! | choose | [`Criterion`] | criteria for whole meshes, which name arrays, regions and patches |
//! | wish | [`wish`] | whether a tet is to be divided, how often, and whether its division may be taken back |
//! | limit | [`Limits`] | limits on generations, sizes and the number of tets |

mod criterion;
pub mod estimate;
pub mod hessian;
mod limits;
pub mod mark;
pub mod sizes;
pub mod wish;

pub(super) use criterion::Stated;
pub use criterion::{
    Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Relation, Size, Target, fix_sizes,
    marks_of_all, wishes_of_all,
};
pub use limits::Limits;
