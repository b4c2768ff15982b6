//! TetGen's files: `.node` and `.ele`, with `.face` and `.edge` where they lie beside.
//!
//! Either name reads all that have the same stem. Counting starts at the first
//! number in `.node`, 0 or 1 or any other. Attributes and markers become the arrays
//! `tetgen:attr1`, ... and `tetgen:ref` on points, `tetgen:ref`, `tetgen:ref2`, ...
//! on cells (meshio's names); on triangles and edges `tetgen:ref` is their marker.
//! The sense of tetrahedra stays as it is: TetGen writes positive ones, others do
//! not. `.neigh` is not read, since it follows from `.ele`.

mod read;
mod write;

use super::node_order::Nodes;
use crate::io::Format;

pub(super) const FORMAT: Format =
    Format { name: "TetGen", endings: &[".node", ".ele"], read: Some(read::read), write: Some(write::write) };

/// Nodes on edges of a tetrahedron, found by comparing with midpoints of edges
/// what TetGen 1.6 writes with `-o2`.
const EDGE_NODES: Nodes = &[&[2, 3], &[0, 3], &[0, 1], &[1, 2], &[1, 3], &[0, 2]];
