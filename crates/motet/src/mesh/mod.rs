//! Floor 2: the exchange form. Plain arrays that hold everything a file holds.

pub mod adjacency;
mod boundary;
mod cell_kind;
mod cells;
pub mod check;
mod coincident;
mod connectivity;
pub mod curved;
mod cutout;
mod data;
pub(crate) mod disc;
mod edge_lengths;
pub mod facets;
mod field;
mod half_facet;
pub mod history;
mod labels;
mod layers;
pub mod marks;
mod measure;
pub(crate) mod orientation;
mod oriented_tets;
mod qualities;
mod seams;
pub mod shapes;
mod spread;
mod summary;
mod surface;
pub mod tet_facets;
mod tet_mesh;
mod tet_part;
mod triangulate;
mod unshared;
mod volume;

pub use boundary::Boundary;
pub(crate) use boundary::corners;
pub use cell_kind::CellKind;
pub use cells::Cells;
pub use coincident::firsts_at_place;
pub(crate) use connectivity::Connectivity;
pub(crate) use cutout::Cutout;
pub use data::{Mesh, bounds, largest_extent};
pub(crate) use edge_lengths::for_each_edge;
pub use edge_lengths::{edge_lengths, mean_edge_lengths};
pub use field::{Field, Values};
pub use half_facet::HalfFacet;
pub(crate) use half_facet::MAX_TETS;
pub(crate) use labels::LabelPlaces;
pub use labels::{LabelNames, Labels, unused_name};
pub use oriented_tets::{Judged, OrientedTets, is_inverted};
pub use qualities::Qualities;
pub use seams::{open_edges, seamless, seams};
pub use spread::Spread;
pub use summary::{
    BAD_EAS, BoundarySummary, EasSummary, MinMean, PatchSummary, QualitySummary, Range, RegionSummary,
    Summary,
};
pub use surface::Surface;
pub use tet_mesh::TetMesh;
pub use tet_part::TetPart;
pub use triangulate::triangulate;
pub use volume::{cell_volume, cell_volumes, cone_volume};
