//! SimVascular's mesh-complete folders: a volume, and a file for each of its faces.
//!
//! Two layouts are read: `mesh-complete.mesh.vtu` with `mesh-surfaces/*.vtp`, and `NAME.vtu` with
//! `NAME_*.vtp` beside it, if the folder has a single volume of this kind. The first layout is written, with
//! `mesh-complete.exterior.vtp` and, if names of patches begin with `wall`, `walls_combined.vtp`.

mod read;
mod write;

use crate::io::format::{Format, Write};

pub(super) const FORMAT: Format = Format {
    name: "SimVascular mesh-complete",
    extensions: &["/"],
    read: Some(read::read),
    write: Some(Write::Files(|mesh, options, threads, _| write::write(mesh, options, threads))),
};

const NODE_ID: &str = "GlobalNodeID";
const ELEMENT_ID: &str = "GlobalElementID";
const FACE_ID: &str = "ModelFaceID";
const REGION_ID: &str = "ModelRegionID";

const VOLUME: &str = "mesh-complete.mesh.vtu";
const SURFACES: &str = "mesh-surfaces";
