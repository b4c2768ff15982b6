//! TetGen's files: `.node` and `.ele`, with `.face` and `.edge` if they are present.
//!
//! Either name reads all files with the same stem. Numbering starts at the first number in `.node`, 0 or 1 or
//! any other. Attributes and markers become the arrays `tetgen:attr1`, ... and `tetgen:ref` on points,
//! `tetgen:ref`, `tetgen:ref2`, ... on cells (meshio's names); on triangles and edges `tetgen:ref` is their
//! marker. The orientation of tetrahedra is kept: TetGen writes positive ones, other programs do not.
//! `.neigh` is not read, since it follows from `.ele`.

mod read;
mod write;

use super::node_order::Nodes;
use crate::io::{Format, Write};

pub(super) const FORMAT: Format = Format {
    name: "TetGen",
    extensions: &[".node", ".ele"],
    read: Some(read::read),
    write: Some(Write::Files(|mesh, options, threads, _| write::write(mesh, options, threads))),
};

/// Nodes on the edges of a tetrahedron, determined by comparing the output of TetGen 1.6 with `-o2` with
/// midpoints of edges.
const EDGE_NODES: Nodes = &[&[2, 3], &[0, 3], &[0, 1], &[1, 2], &[1, 3], &[0, 2]];
