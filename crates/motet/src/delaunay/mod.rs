//! Floor 6: the Delaunay triangulation of any point set in space, exact.
//!
//! Points are inserted one after the other: the tets whose sphere holds the newcomer are removed, and the hole is filled
//! with tets that join it to the facets around (Bowyer 1981; Watson 1981). What makes it exact and fast:
//!
//! | step | file | how |
//! |---|---|---|
//! | input | `input` | scaled by a power of two so that no filter can overflow; what cannot be scaled exactly gets exact arithmetic only |
//! | order | `order` | biased random rounds (Amenta, Choi and Rote 2003), a Hilbert curve within each |
//! | records | `store`, `gauge` | a cache line a tet: vertices, links, and the minors of its in-sphere determinant with their error bound |
//! | walk | `walk` | from the last tet, stopping at the first one in conflict |
//! | test | `conflict` | 12 multiplications with the stored minors; pairs; whole numbers |
//! | cavity | `cavity` | in waves, without branches |
//! | new tets | `fill`, `edges` | linked through a small matrix over directed edges of the cavity |
//! | output | `finish` | ghosts and free slots left out, ids of the caller |
//!
//! *Ties.* Five points on one sphere would leave a choice. Here they do not: each point is lifted by an
//! infinitesimal that grows with its place in the order of insertion (Devillers and Teillaud 2011), so the newcomer of a tie lies outside,
//! and no flat tet ever arises. The order comes from the coordinates alone; so does, therefore, the triangulation.
//!
//! *The hull* is closed by ghost tets to a vertex at infinity, whose conflict test is the side of the
//! hull facet. A newcomer in the very plane of a hull facet conflicts with the ghost exactly when it does with the tet behind.
//!
//! *Signs.* On a mesh's boundary (a sphere, a box) a fifth to a half of all tests lie within the error of `f64`; nearly
//! all of them are settled by pairs of `f64`. True ties, 7 a point on a grid, are settled by whole numbers of fixed
//! width. See [`crate::geometry::predicates`].
//!
//! *Surfaces* become facets of tets in [`mod@constrain`].
//!
//! *Bounds.* Time and memory are those of the triangulations on the way: n log n for ordinary points, and quadratic where the result is
//! (points on two skew lines, on the moment curve). Coinciding points are set aside before anything is built.

mod cavity;
mod conflict;
pub mod constrain;
mod edges;
mod fill;
mod finish;
mod gauge;
mod input;
mod insert;
mod order;
mod start;
mod store;
mod triangulation;
mod walk;

pub(crate) use constrain::flat_facets;
pub use constrain::{Constrained, EdgePoints, PointInTriangle, PointOnEdge, constrain};
pub use triangulation::{HullFacet, Triangulation};
