//! One quality measure per file; each agrees with Verdict where Verdict has it.
//!
//! | measure | regular | flat | inverted |
//! |---|---|---|---|
//! | [`eas`] | 1 | 0 | negative |
//! | [`equiangle_skew`] | 0 | 1 | that of its mirror image |
//! | [`mean_ratio`], [`cubit_mean_ratio`], [`scaled_jacobian`] | 1 | 0 | negative |
//! | [`radius_ratio`], [`aspect_ratio`] | 1 | 1e30 | those of its mirror image |
//! | [`edge_ratio`] | 1 | any | any |
//! | [`dihedral::min`], [`dihedral::max`] | acos(1/3) | 0, pi | those of its mirror image |
//! | [`volume`] | edge^3 / sqrt(72) | 0 | negative |
//!
//! Every measure is finite for every tet of finite points. [`Measure`] has those that tables and arrays show,
//! by name.

mod angles;
mod cotangents;
mod cubit_mean_ratio;
pub mod dihedral;
mod eas;
mod edge_ratio;
mod equiangle_skew;
mod many;
mod mean_ratio;
#[cfg(feature = "suite")]
mod measure;
mod radii;
mod scaled;
mod scaled_jacobian;
mod volume;

pub use cubit_mean_ratio::cubit_mean_ratio;
pub use eas::{POSITIVE_EAS, eas, highest_eas};
pub use edge_ratio::edge_ratio;
pub use equiangle_skew::equiangle_skew;
pub use many::{EasStar, eas_and_mean_ratio_of_each, eas_of_each};
pub use mean_ratio::mean_ratio;
#[cfg(feature = "suite")]
pub use measure::Measure;
pub use radii::{aspect_ratio, radius_ratio};
pub use scaled_jacobian::scaled_jacobian;
pub use volume::volume;
