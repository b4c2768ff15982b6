//! What to divide, and what may be taken back.
//!
//! | step | file | how |
//! |---|---|---|
//! | estimate | [`estimate`] | how badly a field is resolved in each tet; what turns where |
//! | size | [`hessian`], [`sizes`] | how much a field bends at each vertex; how long edges are to be for that |
//! | mark | [`mark`] | tets by place, size, distance to a surface, estimate |
//! | choose | [`Criterion`] | the same for whole meshes, by words for their arrays, regions and patches |
//! | wish | [`wish`] | of each tet, whether it is to be divided, how often, and whether it may be taken back |
//! | limit | [`Limits`] | how far that goes: generations, sizes, the number of tets |

mod criterion;
pub mod estimate;
pub mod hessian;
mod limits;
pub mod mark;
pub mod sizes;
pub mod wish;

pub use criterion::{
    Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Relation, Size, Target, fix_sizes,
    marks_of_all, wishes_of_all,
};
pub use limits::Limits;
