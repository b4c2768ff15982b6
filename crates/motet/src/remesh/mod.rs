//! Floor 6: bad tets found, classified and repaired, and nothing else touched.
//!
//! | step | file | how |
//! |---|---|---|
//! | find | `run` | tets with EAS below a limit; evaluated four at a time, recomputed only where that leaves a doubt |
//! | reconnect | `repair::stages` | edges removed by dynamic programming, facets removed: the paper's stage one |
//! | by type | `classify` | the paper's types I to IV, each with its own repair: stage two |
//! | by length | `repair::by_length` | edges far from the local average length collapsed or split, where the surface is kept: the paper's rule for type IV |
//! | beyond | `repair::stages` | vertices moved, collapsed, inserted; the surroundings of stubborn tets improved first |
//! | divide | `repair::divide` | tets that no operation repairs are divided, as long as that leaves fewer bad ones |
//! | improve | `repair::improve` | swaps and moved vertices that improve tets as a whole and leave none bad |
//! | density | `repair::density` | the number of vertices kept: long edges divided, short ones collapsed |
//! | thin | `repair::thin` | inserted vertices that lie close to others removed again where they are not needed |
//! | choose | `repair::trial`, `repair::score` | of the changes that repair a tet, the one that touches the fewest tets still untouched |
//! | surface | `surface` | kept to the bit, or within a distance of the input surface |
//! | lines | `lines` | labelled edges divided and merged along themselves, within the same distance |
//! | hold | `held` | named regions and patches, required entities and facets with a twin kept to the bit |
//! | sizes | `sizes`, `repair::sizing` | where edge lengths are requested: edges far longer split, far shorter collapsed |
//! | layers | [`crate::mesh::OrientedTets`] | tets of boundary layers are thin on purpose, and stay |
//! | explain | `left` | which bad tets are left, where, and why |
//! | whole meshes | `whole` | cells of other kinds put back, arrays carried across |
//! | words | `words` | options as callers write them, with names of the mesh |
//!
//! Every change goes through [`kernel`](crate::kernel) and is made only if it raises the worst quality of the
//! tets it touches. The method is that of Moyle and Ventikos 2008, *Local remeshing for large amplitude grid
//! deformations*, and goes beyond it.

pub mod classify;
mod held;
mod input_mesh;
mod left;
mod lengths;
mod lines;
mod options;
mod repair;
mod report;
mod run;
mod sizes;
mod surface;
mod whole;
mod words;

pub use held::Held;
pub use left::{Left, Reason};
pub use lengths::Lengths;
pub use options::{DEFAULT_DISTANCE, Density, Goal, Improve, Options, SurfaceRule, Whole};
pub use report::{Counts, Operation, Report, Seconds, SizesReport, State, Worst};
pub use run::{Outcome, remesh};
pub use sizes::{LONG, SHORT, Sizes};
pub(crate) use whole::remesh_cutout;
pub use whole::{has_only_labels, remesh_labelled, remesh_mesh, remesh_part};
pub use words::{EdgeLengths, GoalName, RemeshWords, SurfaceName};
