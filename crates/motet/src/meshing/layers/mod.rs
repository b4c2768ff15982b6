//! Boundary layers: thin prisms on walls, and less of them where there is no room.
//!
//! | step | file | how |
//! |---|---|---|
//! | what is asked | `options` | stacks of layers, by patch or everywhere but on caps |
//! | sides | `skin` | the surface of each body as seen from inside |
//! | caps | `flats` | flat parts, in which edges of layers slide |
//! | directions | `directions` | the most normal normal |
//! | thickness | `thickness` | the gap across, the edges of the wall, a slope along it |
//! | caps follow | `slide` | harmonic in their planes |
//! | prisms | `columns` | levels, and what is left where columns have fewer |
//! | core | `core` | the surfaces that the layers leave, to be filled |
//! | check | `tangles` | exact: what is off is made thinner, and all looked at again |
//! | one mesh | `glue`, `split` | prisms on the tets of the core, divided by the smallest number |

mod columns;
mod core;
mod directions;
mod flats;
mod glue;
mod grown;
mod neighbors;
mod options;
mod report;
mod skin;
mod slide;
mod split;
mod tangles;
mod thickness;

pub(super) use grown::Grown;
pub use options::{Layers, MOST_LAYERS, Stack};
pub use report::Report;
pub(super) use split::split;
