//! Patches and arrays that a job names, in the mesh.

use motet::base::VertexId;
use motet::motion::FacetSet;
use motet::{Mesh, Result};

/// The labels of patches.
pub(super) fn labels(mesh: &Mesh, words: &[String]) -> Result<Vec<i32>> {
    words.iter().map(|word| mesh.find_patch(word)).collect()
}

/// The vertices of patches, rising.
pub(super) fn vertices(mesh: &Mesh, words: &[String]) -> Result<Vec<VertexId>> {
    let sets = words.iter().map(|word| FacetSet::find(mesh, word)).collect::<Result<Vec<_>>>()?;
    Ok(FacetSet::joined(sets).unwrap_or_default().vertices)
}
