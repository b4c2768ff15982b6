//! Floor 6: tets divided, many generations deep, without loss of shape; and the way back.
//!
//! | step | file | how |
//! |---|---|---|
//! | estimate | [`estimate`] | how badly a field is resolved in each tet; what turns where |
//! | size | [`hessian`], [`sizes`] | how much a field bends at each vertex; how long edges are to be for that |
//! | mark | [`mark`] | which tets to divide: by place, size, distance to a surface, estimate |
//! | choose | [`Criterion`], [`wish`] | the same for whole meshes, by words for their arrays, regions and patches; and what may be taken back |
//! | limit | `limits` | how far that goes: generations, sizes, the number of tets |
//! | Bey's rule | `bey` | another diagonal, for no more than three shapes |
//! | divide | `divide`, `eight` | the eight, and which edges each of them has |
//! | know | `forest`, `facets` | parents, children, edges and facets are remembered |
//! | shapes | `classes` | tets of one shape, which few are; what follows from the shape is found once |
//! | fit | `patterns` | what is left between divided and undivided tets is cut: all ways to do so, from a table |
//! | choose a way | `fills` | of these the one whose worst part is best; along which diagonal a tet is divided |
//! | close | `close` | cuts that would be badly shaped get more split edges, or the tet is divided, too: sweeps until nothing changes |
//! | give out | `extract` | the mesh, with the triangles of patches and where everything came from |
//! | hold | `held` | tets beside cells of other kinds, whose edges may not be split, are left as they are |
//! | the true surface | `true_surface` | new points of the boundary are put on it, as far as nothing inverts |
//! | take back | `inverted` | no division is taken back whose whole would be inverted, where points moved |
//! | remember | `memory` | what has to be kept with the mesh, so that a later run goes on, and what is still true of it when others changed the mesh |
//! | whole meshes | `whole`, `joined`, `origins`, `kept` | cells of other kinds put back, arrays carried across, the memory as arrays |
//!
//! The mesh is a function of the first mesh and of which tets are *asked* to be divided; nothing else is remembered. A tet that was cut
//! to fit its neighbours is never divided itself: asked for one of its pieces, the whole is divided into eight (Bank, Sherman and Weiser 1983,
//! *Refinement algorithms and data structures for regular local mesh refinement*; Bey 1995, *Tetrahedral grid refinement*). That a piece at a border gets the
//! long edges of the whole split before the short ones is the memory of Moyle and Ventikos 2008.

mod bey;
mod classes;
mod close;
mod criterion;
mod divide;
mod eight;
pub mod estimate;
mod extract;
mod facets;
mod fills;
mod forest;
mod handle;
mod held;
pub mod hessian;
mod inverted;
mod joined;
mod kept;
mod limits;
pub mod mark;
mod memory;
mod origins;
mod patterns;
mod shapes;
pub mod sizes;
mod true_surface;
mod whole;
pub mod wish;

pub use criterion::{
    Aim, Amount, Condition, Criterion, Estimator, HessianSizes, Relation, Size, Target, fix_sizes,
    marks_of_all, wishes_of_all,
};
pub use handle::{Left, Options, Refinement, Rule, Summary};
pub use limits::Limits;
pub use memory::{Memory, UNKNOWN};
pub use shapes::Shapes;
pub use true_surface::OnSurface;
pub use whole::MeshRefinement;
