//! Floor 10: the loop. A mesh moves with its walls, step after step, and keeps its quality.
//!
//! | file | what it does |
//! |---|---|
//! | `options` | options: how the inside follows, what is repaired, what is watched; patches by label, since ids do not last |
//! | `moving_mesh` | [`MovingMesh`]: made once, then [`advance`](MovingMesh::advance), [`refine`](MovingMesh::refine), arrays, velocity, history |
//! | `substeps` | a step, in as many parts as it takes: move while tets stay well shaped, repair, move on |
//! | `repair` | the repair within a step: which tets are repaired and improved, in the part of the mesh around them |
//! | `step_run` | the state of one step in progress, and its result |
//! | `first_mesh` | the first mesh, and when to restore it: where walls return and the mesh does not settle by itself |
//! | `restore` | the first mesh put back |
//! | `current` | the mesh between two changes: its positions, what moves it, where each vertex was at first |
//! | `coarsen` | divisions undone by edge lengths, where the record of what was divided is lost |
//! | `contents` | cell arrays whose contents stay in their cells while these move, and are passed on where they change |
//! | `shapes` | which tets are bad, and how bad the worst is |
//! | `wall` | the walls as given: displacements refer to them, however the walls are divided by now |
//! | `hold` | walls that are kept apart: what would come too near stops in front of it |
//! | `watch` | how near patches are to each other, and for how long contact is ruled out |
//! | `swept` | the volume that each facet sweeps in a step, exact to rounding: needed for flow on a moving mesh |
//! | `script` | the motion of walls in time, given by formulas or by frames |
//! | `step` | the report of a step |
//! | `options_text` | options as text: a saved run continues with the options it was saved with |
//! | `first_state` | the first mesh as arrays of a saved state |
//! | `state` | everything in a file, and back: a run that was stopped continues with the same bytes |
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
//! The mesh after the last change is the *reference*: as long as nothing changes, a step depends only on
//! where the walls are, so a wall that comes back brings every vertex back to the bit. A step that would
//! leave a tet flatter than [`Options::floor`], or inverted, is made in part; tets that are bad there are
//! repaired while they still have a volume, and the resulting mesh is the new reference. Tets that are bad at
//! the end of the step are repaired there; if that leaves bad ones that no wall forces, everything around
//! them is improved as far as possible, once. Tets that will soon be bad are repaired with them: those within
//! [`Options::margin`] above the limit that would be below it after another fall like the one since the last
//! change.
//!
//! A change of connectivity happens at a time level and is announced: [`Step::changes`] has the time,
//! [`MovingMesh::history_since`] the maps. A solver whose time integration needs the mesh before and after
//! the change at the same time level finds both in [`Change`].

mod coarsen;
mod contents;
mod current;
mod first_mesh;
mod first_state;
mod hold;
mod moving_mesh;
mod options;
mod options_text;
mod repair;
mod restore;
mod script;
mod shapes;
mod sizes;
mod state;
mod step;
mod step_run;
mod substeps;
mod swept;
mod wall;
mod watch;
mod words;

pub use moving_mesh::{GAP, MovingMesh};
pub use options::{Contents, Options, Watching};
pub use script::{InTime, Script, normals};
pub use step::{Change, Closest, Gaps, InvertedAtStart, Seconds, Step, Stopped, Why, WorstTet};
pub use swept::{SweptVolumes, swept_volumes};
pub use words::{RepairWords, WatchWords};
