//! Floor 6: bad tets found, classified, repaired, and only those.
//!
//! | step | file | how |
//! |---|---|---|
//! | find | `run` | EAS below a limit; four tets at a time, a closer look only where that leaves a doubt |
//! | reconnect | `repair::stages` | edges removed by dynamic programming, facets removed: the paper's stage one |
//! | by type | `classify` | the paper's types I to IV, each with its own repair: stage two |
//! | by length | `repair::by_length` | edges far from the local average length collapsed or split, where the surface is kept: the paper's rule for type IV |
//! | beyond | `repair::stages` | vertices moved, collapsed, inserted; what lies round the stubborn made better first |
//! | divide | `repair::divide` | what nothing helps is divided, as long as that leaves fewer |
//! | improve | `repair::improve` | swaps and moved vertices that make tets better on the whole, and none bad |
//! | density | `repair::density` | as many vertices as there were: long edges divided, short ones collapsed |
//! | thin | `repair::thin` | vertices that came and lie close to others go again where they are not needed |
//! | choose | `repair::candidate` | of the changes that repair a tet the one that touches the fewest that nothing has touched |
//! | surface | `surface` | kept to the bit, or within a distance of what it was |
//! | lines | `lines` | labelled edges divided and merged along themselves, within the same distance |
//! | hold | `held` | named regions and patches, required entities and facets with a twin stay to the bit |
//! | sizes | `sizes`, `repair::sizing` | where lengths are asked for: edges far longer split, far shorter collapsed |
//! | layers | [`crate::mesh::OrientedTets`] | tets of boundary layers are thin on purpose, and stay |
//! | explain | `left` | which tet is left, where, why |
//! | whole meshes | `whole` | cells of other kinds put back, arrays carried across |
//!
//! Every change goes through [`kernel`](crate::kernel): the worst quality of what it touches rises, or it is not made. The method is that of Moyle and
//! Ventikos 2008, *Local remeshing for large amplitude grid deformations*, and goes on where it ends.

pub mod classify;
mod given;
mod held;
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

pub use held::Held;
pub use left::{Left, Reason};
pub use lengths::Lengths;
pub use options::{DEFAULT_DISTANCE, Density, Goal, Improve, Options, SurfaceRule};
pub use report::{Counts, Operation, Report, Seconds, SizesReport, State, Worst};
pub use run::{Outcome, remesh};
pub use sizes::{LONG, SHORT, Sizes};
pub use whole::{MeshOutcome, has_only_labels, remesh_labelled, remesh_mesh, remesh_part};
