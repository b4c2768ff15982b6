//! Floor 4: the only code that changes the connectivity of tets.
//!
//! Internal: public for tests, benchmarks and extensions, and may change with any version.
//!
//! A [`Complex`] holds tets, and for each of their facets what lies behind it. Code that wants to change it
//! *proposes* a [`Change`]: the tets to remove (the cavity), the tets to insert (the fill), and what happens
//! to one vertex. [`Complex::check`] tests it against everything that must never happen, and returns a
//! [`Checked`] change or a [`Reject`]. [`Complex::commit`] accepts only a checked change. [`Complex::undo`]
//! restores what a journal has recorded, to the bit.
//!
//! A complex is made of parts that know nothing of each other:
//!
//! | part | file |
//! |---|---|
//! | topology: what lies behind each facet, one tet of each vertex | `tets` |
//! | points of vertices, and constraints on them | `vertices`, `hold` |
//! | walls and lines, which change with the tets at them | `link`, `walls`, `lines` |
//! | what no change may touch | `locks` |
//! | qualities, and tets exempt from being judged by them | `qualities` |
//! | tets that may overlap | `overlaps` |
//! | what has changed since the first mesh | `provenance` |
//! | overwritten values, to undo changes | `journal` |
//!
//! The topology serves the recovery of surfaces in a Delaunay triangulation, too, where tets have no walls.
//!
//! What must never happen: a tet of the fill that is not positive; a facet of the cavity's boundary that the
//! fill lacks, or the reverse; a wall (boundary, interface or labelled facet) or a line (labelled edge) that
//! is lost or appears; a tet that changes its region; a vertex that is lost without being declared removed; a
//! worst quality that does not rise.

mod build;
mod change;
mod check;
mod commit;
mod complex;
mod edges;
mod exempt;
mod existing;
mod extract;
mod hold;
mod invariants;
mod journal;
mod lines;
mod link;
mod locks;
mod marks;
mod overlaps;
mod peel;
mod provenance;
mod qualities;
mod star;
mod tets;
mod undo;
mod vertex_move;
mod vertices;
mod walls;

pub use change::{Change, Fill, NewLine, NewWall, VertexChange};
pub use check::{Checked, Reject};
pub use complex::Complex;
pub use exempt::{FLATTEST, Side, is_reached};
pub use extract::Extract;
pub use hold::Hold;
pub use journal::Mark;
pub use lines::Line;
pub use link::{Behind, HalfFacet, Wall, WallId};
pub use star::{Shell, Star};
pub(crate) use tets::{NO_TET, Tets};
