//! The first mesh, restored where walls return and the mesh does not settle by itself.

use std::sync::Arc;
use std::time::Instant;

use crate::base::{CellId, ErrorKind, Id, Point, Result, Threads, VertexId};
use crate::geometry::vector::norm;
use crate::mesh::history::History;
use crate::mesh::marks::{CORNER, REQUIRED, RIDGE};
use crate::mesh::{Field, Mesh};
use crate::motion::Mover;
use crate::moving::contents::hand_over;
use crate::moving::legs::Way;
use crate::moving::now::{InFirst, Known, LeftBad, Now};
use crate::moving::options::Options;
use crate::moving::shapes::{Shape, Tets};
use crate::moving::sizes::lengths;
use crate::moving::step::{Change, Why};
use crate::moving::wall::NO_NODE;
use crate::spatial::trace::between;

/// Walls are back if the distance of each node from its first position is within this fraction of the edges
/// there.
const BACK: f64 = 0.1;

/// A mesh that has changed on the way to this many returns in a row does not settle.
const MOST_RETURNS: u32 = 3;

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

/// The largest number of attempts to leave vertices in place because tets would turn over if they moved to
/// their positions in the first mesh.
const MOST_TRIES: usize = 8;

/// The mesh to restore, as it was before anything changed.
#[derive(Clone, Debug)]
pub(super) struct FirstMesh {
    /// The mesh with its points where they were at first; of its arrays only those that identify it: labels,
    /// ids, marks, the memory of refinement.
    pub(super) mesh: Mesh,
    pub(super) known: Known,
    /// Bad tets that repair left, sorted by cell.
    pub(super) left: Vec<LeftBad>,
    /// The mean edge length at each vertex.
    lengths: Vec<f64>,
    mean_eas: f64,
    n_bad: usize,
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
    pub(super) fn of(now: &Now, options: &Options, threads: &Threads) -> Option<Box<Self>> {
        let is_wanted = options.returns && options.repair.is_some();
        if !is_wanted || !now.mesh.cells.polyhedron_faces().is_empty() {
            return None;
        }
        let mesh = Mesh {
            points: now.mesh.points.clone(),
            cells: now.mesh.cells.clone(),
            label_names: now.mesh.label_names.clone(),
            point_data: own_arrays(&now.mesh, &now.mesh.point_data),
            cell_data: own_arrays(&now.mesh, &now.mesh.cell_data),
            field_data: Vec::new(),
        };
        let known =
            Known { before: Vec::new(), rest: None, in_first: InFirst::same(&mesh), ..now.known.clone() };
        Some(Box::new(Self::from_parts(mesh, known, now.left.clone(), options, threads)))
    }

    /// Builds the first mesh from its parts, and evaluates its quality.
    pub(super) fn from_parts(
        mesh: Mesh,
        known: Known,
        left: Vec<LeftBad>,
        options: &Options,
        threads: &Threads,
    ) -> Self {
        let tets = Tets::of(&mesh);
        let mean_eas = tets.qualities(&mesh.points, threads).mean;
        let n_bad = tets.shape(&mesh.points, options.limit(), threads).bad.len();
        Self { lengths: lengths(&mesh), mesh, known, left, mean_eas, n_bad }
    }

    /// Whether displacements of the nodes leave the walls about where they were at first.
    fn has_walls_at(&self, displacement: &[Point]) -> bool {
        let nodes = self.known.node.iter().zip(&self.lengths).filter(|(node, _)| **node != NO_NODE);
        nodes.into_iter().all(|(&node, length)| norm(displacement[node as usize]) <= BACK * length)
    }

    /// How much another mesh has lost compared with this one, relative to the limits: at 1, enough to put
    /// this one back.
    fn lost(&self, now: &Now, points: &[Point], shape: &Shape, threads: &Threads) -> f64 {
        let mean = now.tets.qualities(points, threads).mean;
        let in_mean = (1.0 - mean / self.mean_eas) / LOSS;
        let n_first = self.mesh.points.len();
        let n_off = points.len().abs_diff(n_first).saturating_sub(VERTICES_OFF_ALWAYS);
        let in_vertices = n_off as f64 / n_first as f64 / VERTICES_OFF;
        let in_bad = if shape.bad.len() > self.n_bad { 1.0 } else { 0.0 };
        in_mean.max(in_vertices).max(in_bad)
    }

    /// This mesh with its walls displaced, and the shape of its tets; `None` if that makes tets bad.
    fn displaced(&self, way: &Way<'_>) -> Result<Option<(Now, Shape)>> {
        let (mesh, threads) = (self.mesh.clone(), way.threads);
        let mover = Mover::new(&mesh, &way.options.motion.of(&mesh), threads)?;
        let mut now = Now::of(mesh, mover, self.known.clone(), self.left.clone(), way.wall, threads)?;
        now.mover.step(&now.target(way.displacement), &mut now.mesh.points, threads)?;
        let is_upright = now.mover.check.turned_over(&now.mesh.points, threads).is_empty();
        let shape = now.tets.shape(&now.mesh.points, way.options.limit(), threads);
        Ok((is_upright && shape.bad.len() <= self.n_bad).then_some((now, shape)))
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
    fn is_enough(&self, lost: f64, has_changed: bool) -> bool {
        let Count { n_changed, has_changed: had_changed, is_unsettled, .. } = self.count;
        if is_unsettled {
            return lost >= AGAIN;
        }
        let is_third = n_changed + 1 >= MOST_RETURNS && (has_changed || had_changed);
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

impl Way<'_> {
    /// The first mesh as a replacement for `now`, whose vertices are at [`Self::points`], and the shape of
    /// its tets. `None` if a replacement is not due, or would not be good there.
    pub(super) fn put_back(
        &mut self,
        now: &Now,
        before: &[Point],
        has_changed: bool,
    ) -> Result<Option<(Now, Shape)>> {
        let returns = self.returns;
        let Some(first) = returns.first.as_deref().filter(|_| returns.is_return(self.displacement)) else {
            return Ok(None);
        };
        let shape = self.shape_at(now);
        let lost = first.lost(now, &self.points, &shape, self.threads);
        if !returns.is_enough(lost, has_changed) || now.known.in_first == first.known.in_first {
            return Ok(None);
        }
        let begin = Instant::now();
        let put_back = match first.displaced(self)? {
            None => None,
            Some((next, shape_there)) => {
                let next = self.handed_over(now, before, next, &shape)?;
                next.map(|next| (next, shape_there))
            }
        };
        self.seconds.setup += begin.elapsed().as_secs_f64();
        Ok(put_back)
    }

    /// Passes the data of `now` to `next`, the first mesh with its walls displaced. `None` if its cells
    /// cannot be traced, or if its tets would be inverted at the start and may not be.
    fn handed_over(
        &mut self,
        now: &Now,
        before: &[Point],
        mut next: Now,
        shape: &Shape,
    ) -> Result<Option<Now>> {
        let points = self.nearest_to(now, &next.mesh.points);
        let mut given = now.moved(&points, &self.options.contents);
        let rules = now.put_known(&mut given, before, &self.options.rules);
        let Some(history) = history(&given, now, &next.mesh, self.threads)? else { return Ok(None) };
        history.transfer(&given, &mut next.mesh, &rules)?;
        hand_over(&given, &mut next.mesh, &history, &self.options.contents);
        next.known.before = now.known_of(&mut next.mesh, &history)?.before;
        next.known.rest = Some(next.mesh.points.clone());
        arrange(&mut next.mesh.point_data, &now.mesh.point_data);
        arrange(&mut next.mesh.cell_data, &now.mesh.cell_data);
        if self.options.valid_at_start && next.inverted_at_start(self.threads).is_some() {
            return Ok(None);
        }
        let counts = [now, &next].map(|now| now.tets.len());
        let what = (self.times[1], Why::Return);
        self.changes.push(Change::new(what, counts, shape, Arc::new(history), points));
        Ok(Some(next))
    }

    /// The vertices of a mesh, moved to their positions in the first one where that has them and no tet turns
    /// over: this is part of the step's motion, so that tets still shared with the first mesh stay.
    fn nearest_to(&self, now: &Now, places: &[Point]) -> Vec<Point> {
        let mut is_first: Vec<Option<Point>> = now
            .known
            .in_first
            .vertices
            .iter()
            .map(|v| (*v != VertexId::NONE).then(|| places[v.index()]))
            .collect();
        for _ in 0..MOST_TRIES {
            let points: Vec<Point> =
                is_first.iter().zip(&self.points).map(|(place, here)| place.unwrap_or(*here)).collect();
            let turned = now.mover.check.turned_over(&points, self.threads);
            if turned.is_empty() {
                return points;
            }
            let vertices = turned.iter().flat_map(|cell| now.mesh.cells.vertices(*cell));
            vertices.for_each(|v| is_first[v.index()] = None);
        }
        self.points.clone()
    }
}

/// The history from `given`, which is `now` with all its arrays, to the first mesh; `None` if its cells
/// cannot be traced: lines that were divided, labels in other arrays.
fn history(given: &Mesh, now: &Now, first: &Mesh, threads: &Threads) -> Result<Option<History>> {
    let array =
        |mesh: &Mesh| [mesh.regions(), mesh.patches()].map(|labels| labels.map(|labels| labels.array));
    if array(given) != array(first) {
        return Ok(None);
    }
    let InFirst { vertices, cells } = &now.known.in_first;
    let vertices: Vec<VertexId> = turned_round(vertices, first.points.len());
    let cells: Vec<CellId> = turned_round(cells, first.cells.len());
    match between(given, first, &vertices, &cells, threads) {
        Ok(history) => Ok(Some(history)),
        Err(e) if e.kind() == ErrorKind::Input => Ok(None),
        Err(e) => Err(e),
    }
}

/// For each entity of the first mesh its current id, or none: the inverse of `in_first`.
fn turned_round<I: Id>(in_first: &[I], n_first: usize) -> Vec<I> {
    let mut now = vec![I::NONE; n_first];
    for (i, first) in in_first.iter().enumerate().filter(|(_, first)| **first != I::NONE) {
        now[first.place()] = I::of(i);
    }
    now
}

/// Sorts arrays into the order of others.
fn arrange(fields: &mut [Field], as_in: &[Field]) {
    fields.sort_by_key(|field| as_in.iter().position(|other| other.name == field.name));
}

/// The arrays that identify a mesh: its labels, ids, marks and the memory of its refinement. All others are
/// the user's, and may have changed since.
fn own_arrays(mesh: &Mesh, fields: &[Field]) -> Vec<Field> {
    let labels = [mesh.regions(), mesh.patches()].map(|labels| labels.map(|labels| labels.array));
    let is_label = |name: &str| labels.iter().flatten().any(|label| label == name);
    let is_own = |field: &&Field| {
        let name = field.name.as_str();
        OWN.contains(&name) || name.starts_with(REFINEMENT) || is_label(name)
    };
    fields.iter().filter(is_own).cloned().collect()
}

const OWN: [&str; 5] = ["GlobalNodeID", "GlobalElementID", REQUIRED, CORNER, RIDGE];
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

    #[test]
    fn ids_are_turned_round() {
        let [none, a, b, c] = [VertexId::NONE, VertexId(0), VertexId(1), VertexId(2)];
        assert_eq!(turned_round(&[c, none, a], 4), [c, none, a, none]);
        assert_eq!(turned_round(&[none, b], 2), [none, b]);
    }
}
