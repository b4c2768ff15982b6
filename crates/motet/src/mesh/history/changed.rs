//! What every call that changes a mesh returns.

use super::History;
use crate::mesh::Mesh;

/// A mesh after a change, where each part of it came from, and what was done.
///
/// A call that makes a new mesh returns it; where an object holds the mesh, `M` is a reference to it.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Changed<R, M = Mesh> {
    /// The mesh after the change.
    pub mesh: M,
    /// Where each vertex and cell came from; it carries any array of the old mesh, of any time level.
    pub history: History,
    /// What was done.
    pub report: R,
}
