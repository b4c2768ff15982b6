//! Floor 6: tets divided many generations deep without loss of shape, and coarsened again.
//!
//! | step | folder or file | what it does |
//! |---|---|---|
//! | choose | `choose` | [`Criterion`]: by place, distance, size, error estimate, array or region; sizes from second derivatives; limits; which divisions may be taken back |
//! | divide and fit | `forest` | tets and their eight parts, edges, facets; cuts between divided and undivided tets; what preserves shape |
//! | hold | `fixed_edges` | tets whose edges must not be split, because cells of other kinds use them, are left as they are; line cells are divided with their edges |
//! | take back | `inverted` | where points have moved, no division is taken back if the whole tet would be inverted |
//! | true surface | `true_surface` | new boundary points are put on it, as far as no tet inverts |
//! | handle | `handle` | [`Refinement`]: a mesh that is refined and coarsened again and again |
//! | reach a goal | `reach` | generation after generation, until a mesh is as [`Wanted`] |
//! | remember | `memory` | what must be kept with the mesh so that a later run can continue, and what of it still holds after others have changed the mesh |
//! | whole meshes | `whole` | cells of other kinds put back, arrays transferred, the memory stored as arrays |
//! | words | `words` | what files, Python and other callers give |
//!
//! The mesh is a function of the first mesh and of the tets whose division was *requested*; nothing else is
//! remembered. A tet that was cut to fit its neighbours is never divided piecewise: when one of its pieces is
//! marked, the whole is divided into eight (Bank, Sherman and Weiser 1983, *Refinement algorithms and data
//! structures for regular local mesh refinement*; Bey 1995, *Tetrahedral grid refinement*). That the long
//! edges of the whole are split before the short ones, even for a piece at a border, is the memory of Moyle
//! and Ventikos 2008.

mod choose;
mod fixed_edges;
mod forest;
mod inverted;
mod memory;
mod reach;
mod refinement;
mod shapes;
mod true_surface;
mod whole;
mod words;

pub use choose::{
    Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Limits, Relation, Size, Target, estimate,
    fix_sizes, hessian, mark, marks_of_all, sizes, wish, wishes_of_all,
};
pub use memory::Memory;
pub use reach::{Reached, Step, Stop, Wanted};
pub use refinement::{Left, Options, Refinement, Rule, Summary};
pub use shapes::Shapes;
pub use true_surface::OnSurface;
pub use whole::MeshRefinement;
pub use words::RefineWords;
