//! Floor 5: the operations. Each examines a few tets and *proposes* a change; none of them makes it.
//!
//! Internal: public for tests, benchmarks and extensions, and may change with any version.
//!
//! | operation | removed | inserted |
//! |---|---|---|
//! | [`EdgeRemoval`] | the tets around an edge | the best tets that do without it |
//! | [`FaceRemoval`] | the tets on both sides of some facets | tets around a new edge through them |
//! | [`collapse`] | the tets of a vertex | those without the edge, with the other end in its place |
//! | [`split_edge`] | the tets around an edge | two for each, with a vertex on the edge |
//! | [`split_crossed`] | the tets around two opposite edges | tets that meet where the edges pass each other |
//! | [`Smoothing`] | the tets of a vertex | the same tets, with the vertex where the worst of them is best |
//! | [`Relaxation`] | the tets of a vertex | the same tets, with the vertex where they are better as a whole |
//! | [`Insertion`] | tets around a new vertex | tets that meet in it |
//!
//! `bar` is the quality that a proposal has to exceed: an operation that cannot exceed it stops as soon as it
//! knows. An [`Objective`] takes its place if not only the worst tet counts.

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
