//! Boundary layers: thin prisms on walls, fewer or thinner where there is no space.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | options | `options` | stacks of layers, by patch or everywhere except on caps |
//! | sides | `skin` | the surface of each body as seen from inside |
//! | caps | `flats` | flat parts, in which edges of layers slide |
//! | directions | `directions` | the most normal normal |
//! | thickness | `thickness` | limited by the gap across, the edges of the wall, and a slope along it |
//! | caps follow | `slide` | harmonic motion within their planes |
//! | prisms | `columns` | levels, and cells where columns have fewer of them |
//! | core | `core` | the surfaces around the core, to be filled |
//! | check | `tangles` | exact: which columns are at fault |
//! | settle | `growth`, `settle` | columns at fault are made thinner, and everything is checked again |
//! | outward | `outward`, `shell` | layers on the outer side, for the walls of vessels |
//! | one mesh | `glue`, `split` | prisms joined to the tets of the core, and divided by the smallest vertex number |

mod columns;
mod core;
mod directions;
mod flats;
mod glue;
mod growth;
mod neighbors;
mod options;
mod outward;
mod report;
mod settle;
mod shell;
mod skin;
mod slide;
mod split;
mod tangles;
mod thickness;

pub(super) use flats::is_on_cap;
pub use options::{Layers, MOST_LAYERS, Stack};
pub(super) use outward::{EndFacet, OutwardLayers, radii};
pub use report::Report;
pub(super) use settle::GrownLayers;
pub(super) use split::split;
