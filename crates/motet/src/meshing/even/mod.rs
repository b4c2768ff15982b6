//! A surface alone, open or closed: even triangles within a distance, its arrays carried.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | clip | `clip` | parts cut off by planes and spheres, on request |
//! | repair | `pipeline`, [`crate::preflight`] | double points merged, triangles without area dropped; on request more |
//! | smooth | [`crate::surface`] | noise removed, on request |
//! | adapt | `super::adapt`, [`crate::surface`] | even triangles; rims, borders of patches and creases stay |
//! | origins | `origins` | where points and triangles lie on the given surface: by that, arrays are carried |
//! | report | `measured`, `report` | angles, edges, crossings and rims before and after, distances |
//! | words | `words` | options as callers write them |

mod clip;
mod measured;
mod options;
mod origins;
mod pipeline;
mod report;
mod words;

pub use clip::{Clipped, Cut, clip};
pub use measured::Measured;
pub use options::Options;
pub use pipeline::even_surface;
pub use report::{Report, Smoothed};
pub use words::SurfaceWords;
