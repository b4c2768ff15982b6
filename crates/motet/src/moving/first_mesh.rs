//! The first mesh, and when to restore it: where walls return and the mesh does not settle by itself.

use crate::base::{Point, Threads};
use crate::geometry::vector::norm;
use crate::mesh::marks::{CORNER, REQUIRED, RIDGE};
use crate::mesh::{Field, Mesh};
use crate::moving::current::{Current, InFirst, LeftBad, Records};
use crate::moving::options::Options;
use crate::moving::shapes::{Shape, Tets};
use crate::moving::sizes::lengths;
use crate::moving::step::{Change, Why};
use crate::moving::wall::NO_NODE;

/// Walls are back if the distance of each node from its first position is within this fraction of the edges
/// there.
const BACK: f64 = 0.1;

/// A mesh that has changed on the way to this many returns in a row does not settle.
const MAX_RETURNS: u32 = 3;

/// Such a mesh is replaced if its mean EAS has fallen by this fraction of that of the first mesh. With 3 %, a
/// flap kept for six cycles a mesh that had lost up to 2.4 %.
const LOSS: f64 = 0.01;
/// Such a mesh is also replaced if its number of vertices is off by this fraction, after allowing for
/// `VERTICES_OFF_ALWAYS`: repair keeps the number no closer.
const VERTICES_OFF: f64 = 0.01;
const VERTICES_OFF_ALWAYS: usize = 5;

/// Fraction of these limits that suffices for a mesh already known not to settle.
const AGAIN: f64 = 0.75;
/// Multiple of these limits that suffices at once, without waiting for further returns.
const AT_ONCE: f64 = 15.0;

/// The mesh to restore, as it was before anything changed.
#[derive(Clone, Debug)]
pub(super) struct FirstMesh {
    /// The mesh with its points where they were at first; of its arrays only those that identify it: labels,
    /// ids, marks, the memory of refinement.
    pub(super) mesh: Mesh,
    pub(super) records: Records,
    /// Bad tets that repair left, sorted by cell.
    pub(super) left: Vec<LeftBad>,
    /// The mean edge length at each vertex.
    lengths: Vec<f64>,
    mean_eas: f64,
    pub(super) n_bad: usize,
}

/// The record of returns, and the mesh to restore.
#[derive(Clone, Debug, Default)]
pub(super) struct Returns {
    /// The first mesh; `None` if nothing is restored.
    pub(super) first: Option<Box<FirstMesh>>,
    pub(super) count: Count,
}

/// The counts kept from return to return.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Count {
    /// The number of returns in a row before which the mesh had changed on the way.
    pub(super) n_changed: u32,
    /// Whether the mesh has changed since the last return.
    pub(super) has_changed: bool,
    /// Whether walls have been away since the last return.
    pub(super) is_away: bool,
    /// Whether the mesh does not settle by itself: the first one was put back.
    pub(super) is_unsettled: bool,
}

impl FirstMesh {
    /// The first mesh, if returns are requested and repair is on. `None` also for a mesh that cannot be
    /// stored beside another one, such as one with polyhedra.
    pub(super) fn of(now: &Current, options: &Options, threads: &Threads) -> Option<Box<Self>> {
        let is_wanted = options.returns && options.repair.is_some();
        if !is_wanted || !now.mesh.cells.polyhedron_faces().is_empty() {
            return None;
        }
        let mesh = Mesh {
            points: now.mesh.points.clone(),
            cells: now.mesh.cells.clone(),
            label_names: now.mesh.label_names.clone(),
            point_data: identity_arrays(&now.mesh, &now.mesh.point_data),
            cell_data: identity_arrays(&now.mesh, &now.mesh.cell_data),
            field_data: Vec::new(),
        };
        let records =
            Records { before: Vec::new(), rest: None, in_first: InFirst::same(&mesh), ..now.records.clone() };
        Some(Box::new(Self::from_parts(mesh, &now.tets, records, now.left.clone(), options, threads)))
    }

    /// Builds the first mesh from its parts, of which `tets` are the tets of `mesh`, and evaluates its
    /// quality.
    pub(super) fn from_parts(
        mesh: Mesh,
        tets: &Tets,
        records: Records,
        left: Vec<LeftBad>,
        options: &Options,
        threads: &Threads,
    ) -> Self {
        let mean_eas = tets.qualities(&mesh.points, threads).mean;
        let n_bad = tets.shape(&mesh.points, options.limit(), threads).bad.len();
        Self { lengths: lengths(&mesh), mesh, records, left, mean_eas, n_bad }
    }

    /// Whether displacements of the nodes leave the walls about where they were at first.
    fn has_walls_at(&self, displacement: &[Point]) -> bool {
        let nodes = self.records.node.iter().zip(&self.lengths).filter(|(node, _)| **node != NO_NODE);
        nodes.into_iter().all(|(&node, length)| norm(displacement[node as usize]) <= BACK * length)
    }

    /// How much another mesh has lost compared with this one, relative to the limits: at 1, enough to put
    /// this one back.
    pub(super) fn lost(&self, now: &Current, points: &[Point], shape: &Shape, threads: &Threads) -> f64 {
        let mean = now.tets.qualities(points, threads).mean;
        let in_mean = (1.0 - mean / self.mean_eas) / LOSS;
        let n_first = self.mesh.points.len();
        let n_off = points.len().abs_diff(n_first).saturating_sub(VERTICES_OFF_ALWAYS);
        let in_vertices = n_off as f64 / n_first as f64 / VERTICES_OFF;
        let in_bad = if shape.bad.len() > self.n_bad { 1.0 } else { 0.0 };
        in_mean.max(in_vertices).max(in_bad)
    }
}

impl Returns {
    /// Whether the first mesh may be put back at the end of a step that takes walls to these displacements.
    pub(super) fn is_return(&self, displacement: &[Point]) -> bool {
        self.count.is_away && self.is_back(displacement)
    }

    fn is_back(&self, displacement: &[Point]) -> bool {
        self.first.as_ref().is_some_and(|first| first.has_walls_at(displacement))
    }

    /// Whether a mesh that has [lost](FirstMesh::lost) this much is to be replaced; `has_changed`: in this
    /// step.
    pub(super) fn is_enough(&self, lost: f64, has_changed: bool) -> bool {
        let Count { n_changed, has_changed: had_changed, is_unsettled, .. } = self.count;
        if is_unsettled {
            return lost >= AGAIN;
        }
        let is_third = n_changed + 1 >= MAX_RETURNS && (has_changed || had_changed);
        lost >= AT_ONCE || lost >= 1.0 && is_third
    }

    /// Counts a step that was made. `displacement` says where the walls are; `None` if they did not get
    /// there.
    pub(super) fn count_step(&mut self, displacement: Option<&[Point]>, changes: &[Change]) {
        let is_back = displacement.is_some_and(|displacement| self.is_back(displacement));
        let count = &mut self.count;
        if changes.iter().any(|change| change.why == Why::Return) {
            *count = Count { is_unsettled: true, ..Count::default() };
            return;
        }
        count.has_changed |= !changes.is_empty();
        if !is_back {
            count.is_away = true;
        } else if count.is_away {
            count.n_changed = if count.has_changed { count.n_changed.saturating_add(1) } else { 0 };
            (count.is_away, count.has_changed) = (false, false);
        }
    }
}

/// The arrays that identify a mesh: its labels, ids, marks and the memory of its refinement. All others are
/// the user's, and may have changed since.
fn identity_arrays(mesh: &Mesh, fields: &[Field]) -> Vec<Field> {
    let labels = [mesh.regions(), mesh.patches()].map(|labels| labels.map(|labels| labels.array));
    let is_label = |name: &str| labels.iter().flatten().any(|label| label == name);
    let is_own = |field: &&Field| {
        let name = field.name.as_str();
        IDENTITY.contains(&name) || name.starts_with(REFINEMENT) || is_label(name)
    };
    fields.iter().filter(is_own).cloned().collect()
}

const IDENTITY: [&str; 5] = ["GlobalNodeID", "GlobalElementID", REQUIRED, CORNER, RIDGE];
const REFINEMENT: &str = "refine_";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mesh_that_has_changed_to_three_returns_in_a_row_is_not_to_stay_once_it_has_lost() {
        let at = |n_changed: u32, has_changed: bool, is_unsettled: bool| Returns {
            first: None,
            count: Count { n_changed, has_changed, is_away: true, is_unsettled },
        };
        assert!(at(2, true, false).is_enough(1.0, false) && at(2, false, false).is_enough(1.0, true));
        // Only twice, or not since the last return, or hardly anything lost.
        assert!(!at(1, true, false).is_enough(1.0, true));
        assert!(!at(2, false, false).is_enough(1.0, false));
        assert!(!at(2, true, false).is_enough(0.9, true));
        // A loss so large that no further return is awaited, and a mesh known not to settle.
        assert!(at(0, true, false).is_enough(15.0, false));
        assert!(at(0, false, true).is_enough(0.8, false) && !at(0, false, true).is_enough(0.7, true));
    }
}
