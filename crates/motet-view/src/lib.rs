//! A mesh in a window of the browser: its parts are dragged, and the mesh follows.
//!
//! A small server, reachable from this machine alone, sends the page of a report with the mesh in it
//! ([`motet_report::Live`]). While a part is dragged, the page requests the positions of all vertices: the
//! motion of one step, without repair, so that answers take milliseconds. When the part is released, the step
//! is made, and bad tets are repaired. Each step can be undone, to the byte.
//!
//! | file | idea |
//! |---|---|
//! | `scene` | the mesh, what was done to it, and what the page shows of it |
//! | `parts` | the patches that can be dragged, and the distances between those that stand apart |
//! | `preview` | what a displacement would do, in the order of the page |
//! | `server` | requests and answers |

mod parts;
mod preview;
mod scene;
mod server;

pub use preview::PreviewRequest;
pub use scene::{MoveRequest, Scene};
pub use server::Server;
