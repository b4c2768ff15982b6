//! Floor 5: the operations. Each looks at a few tets and *proposes* a change; none of them makes it.
//!
//! | operation | what goes | what comes |
//! |---|---|---|
//! | [`EdgeRemoval`] | the tets round an edge | the best tets that do without it |
//! | [`FaceRemoval`] | the tets on both sides of some facets | tets round a new edge through them |
//! | [`collapse`] | the tets of a vertex | the same with another vertex in its place |
//! | [`split_edge`] | the tets round an edge | two for each, with a vertex on the edge |
//! | [`split_crossed`] | the tets round two opposite edges | tets that meet where the edges pass each other |
//! | [`Smoothing`] | the tets of a vertex | the same, the vertex at a better place |
//! | [`Relaxation`] | the tets of a vertex | the same, the vertex where they are better on the whole |
//! | [`Insertion`] | the tets that see a new vertex well | tets that meet in it |
//!
//! `bar` is the quality that a proposal has to beat: an operation that cannot stops as soon as it knows. An [`Objective`] takes its place where not the worst tet alone counts.

mod collapse;
mod cone;
mod edge_removal;
mod face_removal;
mod insertion;
mod objective;
mod relaxation;
mod smoothing;
mod split;

pub use collapse::collapse;
pub use cone::cone;
pub use edge_removal::EdgeRemoval;
pub use face_removal::FaceRemoval;
pub use insertion::Insertion;
pub use objective::{Objective, WorstAbove};
pub use relaxation::{Reach, Relaxation, defect};
pub use smoothing::{Anywhere, Smoothing, Track};
pub use split::{split_crossed, split_edge, split_onto};
