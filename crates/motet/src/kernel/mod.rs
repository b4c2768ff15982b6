//! Floor 4: the only code that changes the connectivity of tets.
//!
//! A [`Complex`] holds tets with what lies behind each of their facets. Whoever wants to change it *proposes* a
//! [`Change`]: the tets to go (the cavity), the tets to come (the fill), and what happens to a vertex. [`Complex::check`]
//! holds it against everything that must never happen, and answers with a [`Checked`] change or with a [`Reject`].
//! [`Complex::commit`] takes nothing but a checked one. What a journal has written down, [`Complex::undo`] takes back, to the bit.
//!
//! What must never happen: a tet of the fill that is not positive; a facet of the cavity's boundary that the fill
//! does not have, or the reverse; a wall (boundary, interface or labelled facet) or a line (labelled edge) that gets lost or appears; a tet that changes
//! sides; a vertex that gets lost unsaid; a worst quality that does not rise.

mod build;
mod change;
mod check;
mod commit;
mod complex;
mod extract;
mod invariants;
mod journal;
mod lines;
mod link;
mod news;
mod peel;
mod spare;
mod star;
mod vertex_move;

pub use change::{Change, Fill, NewLine, NewWall, VertexChange};
pub use check::{Checked, Reject};
pub use complex::{Complex, Hold};
pub use extract::{Extract, NEW};
pub use journal::Mark;
pub use lines::Line;
pub use link::{Behind, HalfFacet, Wall, WallId};
pub use spare::{FLATTEST, Side, best_at, is_reached};
pub use star::{Shell, Star};
