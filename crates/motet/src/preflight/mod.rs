//! Floor 6: everything that prevents closed surfaces from being meshed, found exactly.
//!
//! | checked | faults |
//! |---|---|
//! | surfaces | without triangles |
//! | triangles | with a corner that is not finite, without area, duplicated |
//! | pairs of triangles | that meet in more than they share |
//! | edges | where a surface ends, branches, reverses its orientation |
//! | vertices | where a surface touches itself |
//! | closed parts | that face inward |
//!
//! [`preflight`] lists every fault, with ids and a place. Some are *fatal*: a conforming mesh of tets with
//! these triangles as facets cannot be made, or the inside is undefined. Others are notes. [`repair`] repairs
//! what is requested, and reports what it did; triangles that meet are divided by `cut`; [`culprits`] shows
//! the faults. All tests are exact, without tolerance.
//!
//! ```
//! use motet::base::{Threads, VertexId};
//! use motet::preflight::{FaultKind, Role, preflight};
//!
//! // A tetrahedron that lacks a side.
//! let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2]].map(|t| t.map(VertexId));
//! let report = preflight(&points, &triangles, &[0; 3], &[Role::Boundary], &Threads::single());
//! assert!(!report.is_fit());
//! assert_eq!(report.count(FaultKind::OpenEdge), 3);
//! ```

mod crossing;
mod culprits;
pub(crate) mod cut;
mod edges;
mod enclosed;
mod fault;
mod joined;
mod meeting;
mod narrow;
mod parts;
mod renamed;
mod repair;
mod report;
mod rims;
mod search;
mod sides;
mod single;
mod surfaces;
pub(crate) mod union;
pub(crate) mod wrap;

pub(crate) use crossing::meet;
pub use crossing::{crossings, own_crossings};
pub use culprits::culprits;
pub use fault::{Fault, FaultKind};
pub(crate) use joined::joined_surfaces;
pub use narrow::Narrow;
pub use renamed::renamed;
pub use repair::{Repair, RepairKind, Repaired, Repairs, repair};
pub use report::{FaultCount, Preflight};
pub use rims::{Rim, open_rims};
pub use search::preflight;
pub use surfaces::Role;
