//! Floor 5: the exact Delaunay triangulation of any set of points in space.
//!
//! Points are inserted one by one: the tets whose circumsphere contains the new point are removed, and the
//! cavity is filled with tets that join the point to the facets around it (Bowyer 1981; Watson 1981). What
//! makes it exact and fast:
//!
//! | step | file | how |
//! |---|---|---|
//! | input | `input` | scaled by a power of two so that no filter can overflow; what cannot be scaled exactly gets exact arithmetic only |
//! | order | `order` | biased randomised rounds (Amenta, Choi and Rote 2003), a Hilbert curve within each |
//! | records | `store`, `gauge` | three arrays with a slot per tet: vertices, links, and the minors of the in-sphere determinant with their error bound |
//! | parts | `parts`, `insert` | space is divided into boxes, in which threads insert points at the same time |
//! | walk | `walk` | from the last tet, stopping at the first one in conflict |
//! | test | `conflict` | 12 multiplications with the stored minors; then pairs of `f64`; then integers |
//! | cavity | `cavity` | breadth first, without branches |
//! | new tets | `fill`, `edges` | linked through a small matrix over the directed edges of the cavity |
//! | output | `finish`, `numbering` | without ghosts and free slots, under the caller's ids; where there were parts, in an order that does not depend on them |
//!
//! *Ties.* Five points on one sphere would leave the triangulation ambiguous. The ambiguity is removed by
//! lifting each point by an infinitesimal that grows with its place in the order of insertion (Devillers and
//! Teillaud 2011): in a tie the new point lies outside, and no flat tet ever arises. The order depends on the
//! coordinates alone, and therefore so does the triangulation.
//!
//! *The hull* is closed by ghost tets to a vertex at infinity, whose conflict test is the side of the hull
//! facet. A new point exactly in the plane of a hull facet conflicts with the ghost if and only if it
//! conflicts with the tet behind it.
//!
//! *Signs.* On the boundary of a mesh (a sphere, a box) a fifth to a half of all tests lie within the error
//! of `f64`; nearly all of these are decided by pairs of `f64`. True ties, seven per point on a grid, are
//! decided by integers of fixed width. See [`crate::geometry::predicates`].
//!
//! *Surfaces* become facets of tets in [`mod@constrain`].
//!
//! *Bounds.* Time and memory are those of the intermediate triangulations: n log n for ordinary points, and
//! quadratic where the result is quadratic (points on two skew lines, on the moment curve). Coinciding points
//! are set aside before anything is built.

mod cavity;
mod conflict;
pub mod constrain;
mod edges;
mod fill;
mod finish;
mod gauge;
mod input;
mod insert;
mod numbering;
mod order;
mod parts;
mod start;
mod store;
mod triangulation;
mod walk;

pub(crate) use constrain::flat_facets;
pub use constrain::{Constrained, EdgePoints, PointInTriangle, PointOnEdge, constrain};
pub use triangulation::{HullFacet, Triangulation};
