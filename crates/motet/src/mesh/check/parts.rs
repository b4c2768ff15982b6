//! Parts of a mesh that are not connected.

use crate::base::DisjointSets;
use crate::mesh::Mesh;
use crate::mesh::check::defect::{Defect, DefectKind, Example};

/// One example per part, its first cell, if there is more than one part. Cells that share a vertex are
/// connected; only cells of the highest dimension count.
pub(super) fn defects(mesh: &Mesh) -> Vec<Defect> {
    let mut defect = Defect::empty(DefectKind::SeparatePart);
    let Some(dim) = mesh.cells.dim() else { return vec![defect] };
    let cells = || mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(dim));
    let mut vertices = DisjointSets::new(mesh.points.len());
    vertices.join_all(cells().map(|(_, _, cell)| cell));
    let mut seen = vec![false; mesh.points.len()];
    for (id, _, cell) in cells() {
        let Some(first) = cell.first() else { continue };
        if !std::mem::replace(&mut seen[vertices.root(first.0) as usize], true) {
            defect.add(|| Example::new(&[id], cell, &mesh.points));
        }
    }
    if defect.count == 1 {
        return Vec::new();
    }
    vec![defect]
}
