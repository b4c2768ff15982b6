//! Floor 9: the loop. A mesh that moves with its walls, step after step, and stays good.
//!
//! | room | what it does |
//! |---|---|
//! | `options` | what is asked: how the inside follows, what is repaired, what is watched; patches by label, since ids do not last |
//! | `handle` | [`MovingMesh`]: made once, then [`advance`](MovingMesh::advance), [`refine`](MovingMesh::refine), arrays, velocity, history |
//! | `legs` | a step, in as many parts as it takes: on while tets stay well shaped, then repaired, then on |
//! | `first` | the first mesh, put back where walls come back and the mesh does not settle by itself |
//! | `now` | the mesh between two changes: where it is, what moves it, where each vertex was at first |
//! | `coarsen` | divisions taken back by lengths, where nobody knows any more what was whole |
//! | `contents` | what cells hold of something that stays in them, while they move and where they change |
//! | `shapes` | which tets are bad, and how bad the worst is |
//! | `wall` | the walls as they came: what the caller's displacements are about, however the walls are divided by now |
//! | `hold` | walls that are kept apart: what would come too near stops in front of it |
//! | `watch` | how near patches are to each other, and how long surely nothing touches |
//! | `swept` | the volume that each facet sweeps in a step, exact to rounding: what a flow on a moving mesh has to know |
//! | `script` | what walls do in time, told in words or by frames |
//! | `step` | what a step says of itself |
//! | `described` | options as text: a state is gone on with by those that it was saved with |
//! | `first_state` | the first mesh as arrays of a state |
//! | `state` | all of it in a file, and back: a run that was stopped goes on to the same bytes |
//!
//! ```
//! use motet::base::Threads;
//! use motet::geometry::vector::norm;
//! use motet::mesh::shapes;
//! use motet::moving::{MovingMesh, Options};
//!
//! # fn main() -> motet::Result<()> {
//! let threads = Threads::new(0)?;
//! let mut moving = MovingMesh::new(&shapes::sphere_in_box(6, 4), Options::default(), &threads)?;
//! // What is driven stays the same list, whatever becomes of the mesh.
//! let is_sphere: Vec<bool> = moving.driven_places().iter().map(|&p| norm(p) < 2.0).collect();
//! for k in 1..=4 {
//!     let shift = [0.5 * f64::from(k), 0.0, 0.0];
//!     let displacement: Vec<_> = is_sphere.iter().map(|&s| if s { shift } else { [0.0; 3] }).collect();
//!     let step = moving.advance(f64::from(k), &displacement, &threads)?;
//!     assert!(step.complete && step.inverted == 0 && step.bad == 0);
//!     if let Some(history) = moving.history_since(step.step - 1)? {
//!         // Arrays of the caller's own follow: history.transfer_points(&old)?
//!         assert_eq!(history.vertices.len(), moving.mesh().points.len());
//!     }
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # How a step is made
//!
//! The mesh of the last change is the *reference*: as long as nothing changes, a step depends on where the walls are and on nothing else, so a
//! wall that comes back brings every vertex back to the bit. A step that would leave a tet flatter than [`Options::floor`], or inverted, is gone in part;
//! what is bad there is repaired while it still has a volume, and the mesh as it is then is the new reference. What is bad
//! at the end of the step is repaired there; where that leaves what no wall forces, everything round it is made as good as it gets, once. With what is bad goes what soon will be: a tet within
//! [`Options::margin`] above the limit that would be below it after another fall like the one since the last change.
//!
//! A change of connectivity happens at a time level and is announced: [`Step::changes`] has the time, [`MovingMesh::history_since`] the maps. A solver
//! whose time integration needs the mesh before and after the change at the same time level finds both in [`Change`].

mod coarsen;
mod contents;
mod described;
mod first;
mod first_state;
mod handle;
mod hold;
mod legs;
mod now;
mod options;
mod script;
mod shapes;
mod sizes;
mod state;
mod step;
mod swept;
mod wall;
mod watch;

pub use handle::{GAP, MovingMesh};
pub use options::{Contents, Motion, Options, Watching};
pub use script::{InTime, Script, normals};
pub use step::{Change, Closest, Gaps, InvertedAtStart, Seconds, Step, Stopped, Why, WorstTet};
pub use swept::{SweptVolumes, swept_volumes};
