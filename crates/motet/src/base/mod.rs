//! Floor 0: what every other module builds on.

mod choices;
mod csr;
mod error;
pub(crate) mod four;
mod ids;
mod lanewise;
mod percent;
mod reasons;
mod sets;
mod splitmix;
mod threads;
mod watch;
mod words;

#[doc(hidden)]
pub use choices::read_named;
pub use choices::{Choice, one_of};
pub use csr::Csr;
pub use error::{Error, ErrorKind, Result, printable};
pub use ids::{BodyId, CellId, Id, MaybeId, TetId, TriangleId, VertexId, rising_list};
pub(crate) use ids::{
    EdgeId, ForestVertexId, LineId, NodeId, absent, id, or_none, same_orientation, sorted_ids,
};
pub(crate) use lanewise::lanewise;
pub use percent::percent;
pub use reasons::reasons;
pub(crate) use sets::DisjointSets;
pub(crate) use splitmix::splitmix64;
pub use threads::Threads;
pub use watch::{Progress, Watch};
#[doc(hidden)]
pub use words::{NoWords, read_both};
pub use words::{Word, Words, nearest};

/// Coordinates of a point, or any other vector in space.
pub type Point = [f64; 3];
