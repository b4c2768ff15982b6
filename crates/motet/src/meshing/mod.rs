//! Floor 8: closed surfaces in, volume mesh out.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | surfaces | `surfaces` | joined: equal points become one, triangles shared by surfaces become one, meshes that end at a common edge become one surface |
//! | caps | `caps` | open rims closed, frame by frame of a wall that moves |
//! | check | [`crate::preflight`] | everything that would prevent meshing, with ids and places |
//! | divide | `divide` | a surface far coarser than the size inside is divided within its own planes |
//! | adapt | `adapt`, [`crate::surface`] | or surfaces get even triangles within a distance, if requested |
//! | surfaces alone | [`even`] | open or closed: even triangles, arrays carried; no tets |
//! | wires | [`tubes`] | centre lines with radii become one closed surface of round tubes |
//! | layers | [`layers`] | thin prisms on walls, if requested; the following steps fill the core that they leave |
//! | sizes | `sizes`, `size_field` | the same everywhere, or growing from the surface |
//! | points | `interior`; `graded`, `octree`, `shadow` | a lattice inside, slightly away from the surface; or one of nested cubes |
//! | tets | [`mod@crate::delaunay::constrain`] | every triangle is a facet of tets |
//! | quality | [`crate::remesh`] | bad tets repaired, the surface kept |
//! | bodies | `bodies` | numbered from the outside in, named, left out on request |
//! | labels | `fill` | each enclosed body is a region, triangles keep their patches |
//! | walls | [`wall`] | a solid wall on the outer side of a vessel: layers outward |
//! | words | `words` | options as callers write them, with names of patches |

mod adapt;
mod bodies;
mod caps;
mod compact;
mod divide;
pub mod even;
mod fill;
mod graded;
mod interior;
pub mod layers;
mod octree;
mod shadow;
mod sheet;
mod size_field;
mod sizes;
mod surfaces;
pub mod tubes;
pub mod wall;
mod words;

pub use adapt::{Adapted, Adapting};
pub(crate) use bodies::bodies_of_mesh;
pub use bodies::{Body, Seed};
pub use caps::{Caps, RimPlane};
pub(crate) use compact::{compact, used_vertices};
pub use divide::Divided;
pub use fill::{Dividing, Filled, Options, Report, fill};
pub(crate) use graded::points_between;
pub(crate) use interior::EDGE_OVER_SIDE;
pub use sizes::{Coarse, Grading, MOST_GROWTH, Sizes, sizes_by};
pub use surfaces::Surfaces;
pub use words::{EdgeLength, MeshingWords, WallLayers};
