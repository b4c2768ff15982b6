//! Floor 6: tets divided, many generations deep, without loss of shape; and the way back.
//!
//! | step | room | how |
//! |---|---|---|
//! | choose | `choose` | [`Criterion`]: by place, distance, size, estimate, words for arrays and regions; sizes from second derivatives; limits; what may be taken back |
//! | divide and fit | `forest` | tets and their eight, edges, facets; cuts between divided and undivided tets; what keeps shapes |
//! | hold | `held` | tets beside cells of other kinds, whose edges may not be split, are left as they are; line cells are divided with their edges |
//! | take back | `inverted` | no division is taken back whose whole would be inverted, where points moved |
//! | the true surface | `true_surface` | new points of the boundary are put on it, as far as nothing inverts |
//! | all of it | `handle` | [`Refinement`]: a mesh that is refined and coarsened again and again |
//! | all wishes | `reach` | generation after generation, until a mesh is as [`Wanted`] |
//! | remember | `memory` | what has to be kept with the mesh, so that a later run goes on, and what is still true of it when others changed the mesh |
//! | whole meshes | `whole` | cells of other kinds put back, arrays carried across, the memory as arrays |
//!
//! The mesh is a function of the first mesh and of which tets are *asked* to be divided; nothing else is remembered. A tet that was cut
//! to fit its neighbours is never divided itself: asked for one of its pieces, the whole is divided into eight (Bank, Sherman and Weiser 1983,
//! *Refinement algorithms and data structures for regular local mesh refinement*; Bey 1995, *Tetrahedral grid refinement*). That a piece at a border gets the
//! long edges of the whole split before the short ones is the memory of Moyle and Ventikos 2008.

mod choose;
mod forest;
mod handle;
mod held;
mod inverted;
mod memory;
mod reach;
mod shapes;
mod true_surface;
mod whole;

pub use choose::{
    Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Limits, Relation, Size, Target, estimate,
    fix_sizes, hessian, mark, marks_of_all, sizes, wish, wishes_of_all,
};
pub use handle::{Left, Options, Refinement, Rule, Summary};
pub use memory::{Memory, UNKNOWN};
pub use reach::{Reached, Step, Stop, Wanted};
pub use shapes::Shapes;
pub use true_surface::OnSurface;
pub use whole::MeshRefinement;
