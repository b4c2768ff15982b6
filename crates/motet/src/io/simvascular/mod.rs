//! SimVascular's mesh-complete folders: a volume, and a file for each of its faces.
//!
//! Read are two layouts: `mesh-complete.mesh.vtu` with `mesh-surfaces/*.vtp`, and
//! `NAME.vtu` with `NAME_*.vtp` beside it, where the folder has one such volume.
//! Written is the first, with `mesh-complete.exterior.vtp` and, where names of patches
//! begin with `wall`, `walls_combined.vtp`.

mod read;
mod write;

use crate::io::format::Format;

pub(super) const FORMAT: Format = Format {
    name: "SimVascular mesh-complete",
    endings: &["/"],
    read: Some(read::read),
    write: Some(write::write),
};

const NODE_ID: &str = "GlobalNodeID";
const ELEMENT_ID: &str = "GlobalElementID";
const FACE_ID: &str = "ModelFaceID";
const REGION_ID: &str = "ModelRegionID";

const VOLUME: &str = "mesh-complete.mesh.vtu";
const SURFACES: &str = "mesh-surfaces";
