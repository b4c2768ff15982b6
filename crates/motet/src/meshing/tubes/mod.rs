//! Wires given by their centre lines: one closed surface of round tubes.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | lines | `centre_lines` | segments of line cells, with radii; what is not finite or has no length is named |
//! | parts | `parts` | a tube along each chain, mitred at bends; chains end at sharp bends and branches, where a ball joins them |
//! | near wires | `bridges` | wires that nearly touch are joined by balls and tubes between them |
//! | union | `union` | divided where they meet, and the pieces inside others left out (`preflight::union`) |
//! | all | `pipeline`, `report` | retried with sections turned otherwise where dividing fails |
//! | words | `words` | options as callers write them |

mod bridges;
mod centre_lines;
mod options;
mod parts;
mod pipeline;
mod report;
mod union;
mod words;

pub use options::{MOST_SIDES, Options, Radius};
pub use pipeline::{even_tubes, tubes};
pub use report::{EvenReport, EvenTubes, Report, Tubes};
pub use words::{BraidWords, CoilWords, TubeWords};
