//! Points that are no place, that nothing uses, or that lie on one another.

use crate::base::VertexId;
use crate::geometry::vector::is_finite;
use crate::mesh::Mesh;
use crate::mesh::check::defect::{Defect, DefectKind, Example};

/// For each vertex the first vertex at exactly the same place.
pub(super) struct Canonical {
    firsts: Vec<VertexId>,
    doubled: Vec<bool>,
}

impl Canonical {
    pub(super) fn of(mesh: &Mesh) -> Self {
        let points = &mesh.points;
        let mut firsts: Vec<VertexId> = (0..points.len()).map(VertexId::new).collect();
        let mut doubled = vec![false; points.len()];
        let mut order = firsts.clone();
        // Zero has two signs and one place.
        let key = |v: &VertexId| points[v.index()].map(|x| total_order(x + 0.0));
        order.sort_unstable_by_key(|v| (key(v), *v));
        for same in order.chunk_by(|a, b| points[a.index()] == points[b.index()]) {
            for v in same {
                firsts[v.index()] = same[0];
                doubled[v.index()] = same.len() > 1;
            }
        }
        Self { firsts, doubled }
    }

    /// The first vertex where `v` lies.
    pub(super) fn first(&self, v: VertexId) -> VertexId {
        self.firsts[v.index()]
    }

    /// Whether another vertex lies where `v` does.
    pub(super) fn is_doubled(&self, v: VertexId) -> bool {
        self.doubled[v.index()]
    }
}

/// A number that sorts as `x` does.
fn total_order(x: f64) -> i64 {
    let bits = x.to_bits() as i64;
    bits ^ (((bits >> 63) as u64) >> 1) as i64
}

pub(super) fn defects(mesh: &Mesh, canonical: &Canonical) -> Vec<Defect> {
    let used = used(mesh);
    let mut non_finite = Defect::none(DefectKind::NonFinitePoint);
    let mut orphan = Defect::none(DefectKind::OrphanPoint);
    let mut duplicate = Defect::none(DefectKind::DuplicatePoint);
    for (i, point) in mesh.points.iter().enumerate() {
        let v = VertexId::new(i);
        if !is_finite(*point) {
            non_finite.add(|| Example::new(&[], &[v], &mesh.points));
        }
        if !used[i] {
            orphan.add(|| Example::new(&[], &[v], &mesh.points));
        }
        if canonical.first(v) != v {
            duplicate.add(|| Example::new(&[], &[canonical.first(v), v], &mesh.points));
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
