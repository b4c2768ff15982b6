//! Floor 7: how far apart surfaces are, where, and when they will touch.
//!
//! A [`Contact`] holds two or more surfaces, the *bodies*, over one list of points: a stent and the wall of a
//! vessel, three leaflets, patches of a volume mesh, a coil against itself. It is built once; at each step of
//! a solver [`Contact::refit`] takes the new points, and [`Contact::measure`] gives the gap at every vertex
//! and the nearest points of every pair of bodies.
//!
//! All distances are exact up to rounding (some 1e-15 of the size), in any unit of length: the distance of a
//! vertex is the least over *all* triangles of the other surface, that of two bodies the least over all pairs
//! of triangles, edges against edges included. Trees of boxes only avoid examining what is farther away.
//! Overestimating a gap is the unsafe direction, and does not happen.
//!
//! ```
//! use motet::base::{Threads, VertexId};
//! use motet::contact::{Body, Contact, Options, Room};
//!
//! // Two triangles, 0.1 apart.
//! let points = vec![
//!     [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0],
//!     [0.0, 0.0, 0.1], [1.0, 0.0, 0.1], [0.0, 1.0, 0.1],
//! ];
//! let body = |name: &str, first: u32| Body {
//!     name: name.into(),
//!     triangles: vec![[first, first + 1, first + 2].map(VertexId)],
//!     room: Room::Found,
//! };
//! let options = Options { warn: Some(0.2), ..Options::default() };
//! let bodies = vec![body("lower", 0), body("upper", 3)];
//! let mut contact = Contact::new(points, bodies, options, &Threads::single())?;
//! let gaps = contact.measure(&Threads::single());
//! assert!((gaps.least() - 0.1).abs() < 1e-15);
//! assert!(gaps.is_warned());
//! # Ok::<(), motet::Error>(())
//! ```

mod ahead;
mod between;
mod body;
mod facing;
mod input;
mod inside;
mod measure;
mod nearest;
mod options;
mod pair;
mod results;
mod room;
mod rule;
mod side;
mod surface_graph;
mod sweep;
mod words;

pub use ahead::{Ahead, FirstContact};
pub use between::{Between, BetweenOptions, GapKind, GapTet, Least, VertexPair, paper};
pub use body::{Body, Room};
pub use inside::{inside, is_closed};
pub use measure::Contact;
pub use options::Options;
pub use results::{BodyGaps, Gaps, Nearest, PairGap, Warned};
pub use room::Within;
pub use side::Side;
pub use sweep::{SLACK, Sweep, Touch, sweep, sweep_apart, sweep_own};
pub use words::{GapWords, set_rooms};
