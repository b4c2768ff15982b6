//! Netgen's meshes (`.vol`), also compressed with gzip (`.vol.gz`).
//!
//! The numbers of cells are the array `netgen:index` (meshio's name): the material of a volume cell, the
//! boundary condition of a surface cell, the number of the edge that a line lies on. The names of materials
//! and of boundary conditions are those of regions and patches; `default` stands for none. Where several
//! numbers have one name, arrays `region` and `patch` have the first of them, so that a name is one label.
//!
//! Netgen lists the pieces of an edge once for each face beside it; each is one line. In meshes of two
//! dimensions surface cells have materials, and lines the numbers of boundary conditions.
//! Meshes without volume cells in the plane z = 0 are written in two dimensions. Parameters of points on the
//! geometry, names of edges, identifications and colours are skipped, with a note where there are any.
//!
//! Labels below 1 get new numbers, since Netgen counts from 1.
//!
//! Layout: what Netgen 6.2 writes and reads (`Mesh::Save` and `Mesh::Load`, libsrc/meshing/meshclass.cpp).
//! Netgen orders the nodes of a cell so that its orientation is opposite to VTK's. The order of the nodes on
//! edges is that of Netgen's `SecondOrder`, found by comparison with midpoints.

mod kinds;
mod labels;
mod read;
#[cfg(test)]
mod tests;
mod write;

use std::collections::BTreeMap;

use crate::io::{Format, Write};

pub(super) const VOL: Format = Format {
    name: "Netgen",
    extensions: &[".vol"],
    read: Some(read::read),
    write: Some(Write::File(write::write)),
};
pub(super) const VOL_GZ: Format = Format {
    name: "Netgen, compressed",
    extensions: &[".vol.gz"],
    read: Some(read::read),
    write: Some(Write::File(write::write_compressed)),
};

/// The array of materials, boundary conditions and numbers of edges.
const INDEX: &str = "netgen:index";

/// The name that stands for none.
const NO_NAME: &str = "default";

/// Names of numbers.
type Names = BTreeMap<i32, String>;
