//! Floor 0: what every other module builds on.

mod changes;
mod csr;
mod error;
pub(crate) mod four;
mod ids;
mod lanewise;
#[cfg(feature = "suite")]
mod names;
mod percent;
mod pool;
mod reasons;
mod sets;
mod shared;
mod simulation;
mod splitmix;
mod threads;
mod watch;
#[cfg(feature = "suite")]
mod words;

pub(crate) use changes::{Changes, entry};
pub use csr::Csr;
pub use error::{Error, ErrorKind, Result, printable};
pub use ids::{BodyId, CellId, Id, MaybeId, TetId, TriangleId, VertexId, rising_list};
pub(crate) use ids::{EdgeId, ForestVertexId, LineId, NodeId, absent, id, same_orientation, sorted_ids};
pub(crate) use lanewise::lanewise;
#[cfg(feature = "suite")]
#[doc(hidden)]
pub use names::read_text;
#[cfg(feature = "suite")]
pub use names::{Names, one_of, suggestion};
pub use percent::percent;
pub use reasons::reasons;
pub(crate) use sets::DisjointSets;
pub(crate) use shared::Shared;
pub use simulation::Simulation;
pub(crate) use splitmix::splitmix64;
pub use threads::Threads;
pub use watch::{Progress, Watch};
#[cfg(feature = "suite")]
#[doc(hidden)]
pub use words::{NoWords, paragraph, read_both};
#[cfg(feature = "suite")]
pub use words::{Word, Words, nearest};

/// Coordinates of a point, or any other vector in space.
pub type Point = [f64; 3];
