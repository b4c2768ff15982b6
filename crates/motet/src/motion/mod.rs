//! Floor 7: mesh motion. Boundary displacement in, volume mesh out.
//!
//! ```
//! use motet::base::Threads;
//! use motet::mesh::shapes;
//! use motet::motion::{Mover, Options};
//!
//! # fn main() -> motet::Result<()> {
//! let mesh = shapes::sphere_in_box(8, 4); // or motet::io::read("vessel.vtu")?
//! let threads = Threads::single();
//! let mut mover = Mover::new(&mesh, &Options::default(), &threads)?;
//! let is_sphere = |p: &[f64; 3]| p.iter().map(|x| x * x).sum::<f64>() < 2.0;
//! let displacement: Vec<_> = (mover.boundary().iter())
//!     .map(|v| if is_sphere(&mesh.points[v.index()]) { [0.5, 0.0, 0.0] } else { [0.0; 3] })
//!     .collect();
//! let mut points = mesh.points.clone();
//! let certificate = mover.advance(&displacement, &mut points, &threads)?;
//! assert!(certificate.complete && certificate.inverted == 0);
//! # Ok(())
//! # }
//! ```
//!
//! # The method
//!
//! Delaunay graph mapping (Liu, Qin and Xia 2006). The vertices of the boundary, and they alone, are
//! triangulated: the *graph*. Every other vertex lies in one tet of it and keeps that tet and its four
//! weights there. When the boundary moves, the vertex moves by the weighted mean of the four displacements.
//! No equation is solved; a step is a weighted sum for each vertex, at the speed of memory. Cells are not
//! examined, so they may be of any kind. A step depends on the displacement alone, not on the steps before
//! it: a wall that returns brings the mesh back, to the bit, and an affine motion of the boundary moves every
//! vertex by the same affine map.
//!
//! The graph fills the convex hull of the boundary, so it contains every vertex of any domain, convex or not.
//! It does not know of walls: a vertex in a narrow branch may depend on vertices of another branch, and one
//! beside a thin flap on the flap's far side, where the boundary is coarser than the gap is wide. With
//! [`Options::within_walls`] the graph is the constrained Delaunay triangulation of the boundary, and
//! neither happens.
//!
//! # Limits
//!
//! Translating a body works almost until it touches another. *Rotating* it does not: a tet of the graph with
//! three nodes on a body of radius r and one at the distance D keeps its sign while the angle is below acos(r
//! / D), which is less than 90 degrees, and cells degrade from 30 degrees on. Where walls bend, let the nodes
//! rotate with them ([`Method::Guided`]). Rotate bodies in several calls of [`Mover::advance`], which
//! rebuilds the graph where a step from the reference does not suffice; or let the rotating parts carry the
//! volume along as rigid bodies ([`Method::Bodies`]). Between the tets of the graph the map has kinks: thin
//! layers at a wall are better kept whole by a [`RigidLayer`].
//!
//! # What is checked
//!
//! [`Mover::step`] checks nothing. [`Mover::advance`] checks the mesh's own cells, by exact signs: a tet is
//! upright when its volume is positive, a linear cell of another kind when the tets at its corners are (those
//! corners where three facets meet), a quadratic cell when the determinant of its Jacobian is positive
//! everywhere, by [bounds](crate::mesh::curved) of it. The mesh moves only as far as no cell is inverted that
//! was upright at first. Tets of the graph do invert, flat ones at once, which has no significance; the
//! [`Certificate`] counts those that contain vertices. It reports the worst EAS and the worst mean ratio of
//! the tets and the worst scaled Jacobian of other cells, with places. Of quadratic cells, these are measured
//! at corners; the inside has a number of its own ([`Quality::worst_curved_jacobian`]).
//!
//! # Kinds of vertices
//!
//! * *driven* vertices are moved by the caller: those of the boundary ([`Mover::boundary`]), and any others
//!   that [`Options::also_moved`] names, such as those of an interface inside ([`Interface::moved`]). They
//!   arrive to the bit. Two boundary vertices in one place (the two sides of a slit) move independently;
//!   vertices nearby follow the one that comes first.
//! * *sliding* vertices ([`Options::sliding`]) lie on flat patches and follow their rim: in the plane, and
//!   where two planes meet, along their line. Where three planes meet, and where a sliding patch meets one
//!   that does not slide, vertices are driven.
//! * the *rigid layer* ([`Options::rigid_layer`]) keeps its position relative to the wall.
//! * *middle* nodes of quadratic cells that lie in the middle of their corners at first, and that the caller
//!   does not move, stay there: straight edges stay straight. Those of curved edges follow like any other
//!   vertex.
//! * all other vertices follow the graph; those that lie outside it and belong to no volume cell stay where
//!   they are.

mod advance;
mod boundary_motion;
mod carrier;
mod certificate;
mod check;
mod choose;
mod corners;
mod crease;
mod elements;
mod graph;
mod interface;
mod layer;
mod matching;
mod methods;
mod middles;
mod mover;
mod nodes;
mod options;
mod point_mover;
mod polar;
mod prescribed;
mod rotation;
mod setup;
mod slide;
mod smooth;
mod update;
mod words;

pub use boundary_motion::{BoundaryMotion, Taken};
pub use carrier::SurfaceCarrier;
pub use certificate::{Certificate, Quality, Seconds, Worst};
pub use choose::{Choice, Tried, choose};
pub use interface::Interface;
pub use matching::{Matching, SurfaceMotion, match_ids, match_patch, node_ids};
pub use mover::{Mover, mesh_velocity};
pub use options::{
    Elastic, Extent, FacetSet, Laplace, Limits, Method, Options, RigidLayer, SlideTolerance, Strain,
};
pub use point_mover::PointMover;
pub use prescribed::Prescribed;
pub use setup::{Setup, SetupSeconds};
pub use slide::{LeavesPlane, SlidingPlane};
pub use words::{MethodName, Motion, MotionParts};
