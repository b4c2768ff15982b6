//! Parts of a mesh that do not hang together.

use crate::base::Sets;
use crate::mesh::Mesh;
use crate::mesh::check::defect::{Defect, DefectKind, Example};

/// One entry a part, when there is more than one: its first cell. Cells hang
/// together that share a vertex; those of the highest dimension count.
pub(super) fn defects(mesh: &Mesh) -> Vec<Defect> {
    let mut defect = Defect::none(DefectKind::SeparatePart);
    let Some(dim) = mesh.cells.dim() else { return vec![defect] };
    let cells = || mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(dim));
    let mut vertices = Sets::new(mesh.points.len());
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
