//! Points that are not finite, that nothing uses, or that coincide.

use crate::base::VertexId;
use crate::geometry::vector::in_range;
use crate::mesh::Mesh;
use crate::mesh::check::defect::{Defect, DefectKind, Example};
use crate::mesh::coincident::firsts_at_place;

/// For each vertex, the first vertex at exactly the same place.
pub(super) struct CoincidentVertices {
    firsts: Vec<VertexId>,
    duplicated: Vec<bool>,
}

impl CoincidentVertices {
    pub(super) fn of(mesh: &Mesh) -> Self {
        let firsts = firsts_at_place(&mesh.points);
        let mut duplicated = vec![false; firsts.len()];
        for (v, first) in firsts.iter().enumerate().filter(|(v, first)| first.index() != *v) {
            (duplicated[v], duplicated[first.index()]) = (true, true);
        }
        Self { firsts, duplicated }
    }

    /// The first vertex at the place of `v`.
    pub(super) fn first(&self, v: VertexId) -> VertexId {
        self.firsts[v.index()]
    }

    /// Whether another vertex lies at the place of `v`.
    pub(super) fn is_duplicated(&self, v: VertexId) -> bool {
        self.duplicated[v.index()]
    }
}

pub(super) fn defects(mesh: &Mesh, coincident: &CoincidentVertices) -> Vec<Defect> {
    let used = used(mesh);
    let mut non_finite = Defect::empty(DefectKind::NonFinitePoint);
    let mut orphan = Defect::empty(DefectKind::OrphanPoint);
    let mut duplicate = Defect::empty(DefectKind::DuplicatePoint);
    for (i, point) in mesh.points.iter().enumerate() {
        let v = VertexId::new(i);
        if !in_range(*point) {
            non_finite.add(|| Example::new(&[], &[v], &mesh.points));
        }
        if !used[i] {
            orphan.add(|| Example::new(&[], &[v], &mesh.points));
        }
        if coincident.first(v) != v {
            duplicate.add(|| Example::new(&[], &[coincident.first(v), v], &mesh.points));
        }
    }
    vec![non_finite, orphan, duplicate]
}

fn used(mesh: &Mesh) -> Vec<bool> {
    let mut used = vec![false; mesh.points.len()];
    mesh.cells.connectivity().items().iter().for_each(|v| used[v.index()] = true);
    mesh.cells.polyhedron_faces().iter().flat_map(|f| f.items()).for_each(|v| used[v.index()] = true);
    used
}
