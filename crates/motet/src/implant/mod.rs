//! Floor 9: devices put into a mesh, one conforming mesh out.
//!
//! | step | file | how |
//! |---|---|---|
//! | surfaces | `resurface` | new ones for devices whose own cross themselves or are bad, if requested |
//! | devices | `devices` | their surfaces joined and checked for all faults; the tets that they keep |
//! | adapt | `adapt` | walls of the host near them refined, or everything there, by [`crate::refine`] |
//! | carve | `carve` | tets in the devices and near them are removed |
//! | place | `place` | devices that lie outside of the host are refused |
//! | divide | `frame`, `cut`, `parts` | walls and devices divided where they meet; what bounds something is kept |
//! | fill | `fill`, `lattice`, `bodies` | every triangle of the devices and of what the carving left is a facet of new tets ([`mod@crate::delaunay::constrain`]); which of them are in which device |
//! | zone | `zone` | new tets, and a ring of the host, repaired by [`crate::remesh`]; nothing beyond is touched |
//! | join | `join`, `layout`, `origins`, `names`, `starts` | one mesh again, arrays carried across, new cells named |
//! | certificate | `report` | conforming, volumes, triangles kept, bad tets that are left and why |
//!
//! The order is that of Moyle and Ventikos 2008 (*Local remeshing for large amplitude grid deformations*; the
//! suite around it): adapt, locate, remove, conform. Where they conform by moving the carved surface, the gap
//! is filled here, so that the triangles of a device stay as they are, and fluid and solid share their
//! vertices.

mod adapt;
mod bodies;
mod carve;
mod cut;
mod devices;
mod fill;
mod frame;
mod join;
mod lattice;
mod layout;
mod names;
mod options;
mod origins;
mod owner;
mod parts;
mod pipeline;
mod place;
mod report;
mod resurface;
mod starts;
mod words;
mod zone;

pub use options::{Adapt, Device, Inside, Interface, Options, Outside};
pub use pipeline::implant;
pub use report::{Adapted, DeviceReport, Fit, Report, Seconds};
pub use words::{ImplantWords, InterfaceName};
