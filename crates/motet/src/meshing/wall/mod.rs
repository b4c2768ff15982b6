//! Solid walls on the outer side of vessels: layers that share the vertices of the lumen.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | lumen | `lumen` | the surface, or the boundary of a volume mesh; open ends closed by caps that only show where they are |
//! | thickness | `options` | a length, an array, or a part of the local radius |
//! | layers | [`layers`](super::layers) | columns outward, thinner where there is no space, checked exactly; they end in the planes of caps |
//! | mesh | `join` | what was given with the wall as one more region, its outer side and ends as patches |
//! | words | `words` | options as callers write them |

mod join;
mod labels;
mod lumen;
mod options;
mod pipeline;
mod report;
mod words;

pub use options::{Options, Thickness};
pub use pipeline::wall;
pub use report::Report;
pub use words::{ThicknessWord, WallWords};
