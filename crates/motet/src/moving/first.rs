//! The first mesh, put back where walls come back and the mesh does not settle by itself.

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

/// Walls are back where each of their nodes is nearer than this part of the edges there to where it was at first.
const BACK: f64 = 0.1;

/// A mesh that has changed on the way to so many returns in a row does not settle.
const MOST_RETURNS: u32 = 3;

/// Such a mesh has lost enough where its mean EAS is below that of the first mesh by this part of it. With 3 % a flap kept a mesh for six cycles that lost up to 2.4 %.
const LOSS: f64 = 0.01;
/// Or where its number of vertices is off by this part, and so many more: repair keeps numbers no closer.
const VERTICES_OFF: f64 = 0.01;
const VERTICES_OFF_ALWAYS: usize = 5;

/// As a part of these: enough for a mesh of which it is known that it does not settle.
const AGAIN: f64 = 0.75;
/// As a multiple: enough at once, without waiting for further returns.
const AT_ONCE: f64 = 15.0;

/// So often vertices are left where they are, since tets would turn over if they went to where the first mesh has them.
const MOST_TRIES: usize = 8;

/// The mesh that is wanted back, as it was before anything of it changed.
#[derive(Clone, Debug)]
pub(super) struct FirstMesh {
    /// The mesh with its points where they were at first, and of its arrays those that identify it: labels, ids, marks, the memory of refinement.
    pub(super) mesh: Mesh,
    pub(super) known: Known,
    /// Bad tets that repair left, cells rising.
    pub(super) left: Vec<LeftBad>,
    /// How long edges are at each vertex.
    lengths: Vec<f64>,
    mean_eas: f64,
    n_bad: usize,
}

/// How walls come back, and what becomes of the mesh.
#[derive(Clone, Debug, Default)]
pub(super) struct Returns {
    /// `None`: nothing is put back.
    pub(super) first: Option<Box<FirstMesh>>,
    pub(super) count: Count,
}

/// What is counted from return to return.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Count {
    /// Returns in a row to which the mesh has changed on the way.
    pub(super) n_changed: u32,
    /// Whether it has changed since the last return.
    pub(super) has_changed: bool,
    /// Whether walls have been away since then.
    pub(super) is_away: bool,
    /// Whether the mesh does not settle by itself: the first one was put back.
    pub(super) is_unsettled: bool,
}

impl FirstMesh {
    /// `None` for a mesh that cannot be stored beside another one, such as one with polyhedra.
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

    /// How good it was is looked up.
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

    /// What another mesh has lost against this one, 1: enough to put this one back.
    fn lost(&self, now: &Now, points: &[Point], shape: &Shape, threads: &Threads) -> f64 {
        let mean = now.tets.qualities(points, threads).mean;
        let in_mean = (1.0 - mean / self.mean_eas) / LOSS;
        let n_first = self.mesh.points.len();
        let n_off = points.len().abs_diff(n_first).saturating_sub(VERTICES_OFF_ALWAYS);
        let in_vertices = n_off as f64 / n_first as f64 / VERTICES_OFF;
        let in_bad = if shape.bad.len() > self.n_bad { 1.0 } else { 0.0 };
        in_mean.max(in_vertices).max(in_bad)
    }

    /// This mesh with the walls displaced, and how its tets are; `None` where that makes tets bad.
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
    /// Whether a step that takes walls to these displacements is one at whose end the first mesh may be put back.
    pub(super) fn is_return(&self, displacement: &[Point]) -> bool {
        self.count.is_away && self.is_back(displacement)
    }

    fn is_back(&self, displacement: &[Point]) -> bool {
        self.first.as_ref().is_some_and(|first| first.has_walls_at(displacement))
    }

    /// Whether a mesh that has lost that much is not to stay; `has_changed`: in this step.
    fn is_enough(&self, lost: f64, has_changed: bool) -> bool {
        let Count { n_changed, has_changed: had_changed, is_unsettled, .. } = self.count;
        if is_unsettled {
            return lost >= AGAIN;
        }
        let is_third = n_changed + 1 >= MOST_RETURNS && (has_changed || had_changed);
        lost >= AT_ONCE || lost >= 1.0 && is_third
    }

    /// Counts a step that was made; `displacement`: where the walls are, `None` where they did not get there.
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
    /// The first mesh in the place of `now`, whose vertices are at [`Self::points`]; with how good its tets are. `None` where it is not due, or would not be good there.
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

    /// Gives `next`, the first mesh with its walls displaced, what `now` has; `None` where its cells cannot be traced, or its tets are inverted where they are not to be.
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

    /// The vertices of a mesh with those of the first one where that has them, as far as no tet turns over: this is a part of the step's motion, so that tets which are still those
    /// of the first mesh stay.
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

/// From `given`, which is `now` with all its arrays, to the first mesh; `None` where its cells cannot be traced: lines that were divided, labels in other arrays.
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

/// For each thing of the first mesh what it is now.
fn turned_round<I: Id>(in_first: &[I], n_first: usize) -> Vec<I> {
    let mut now = vec![I::NONE; n_first];
    for (i, first) in in_first.iter().enumerate().filter(|(_, first)| **first != I::NONE) {
        now[first.place()] = I::of(i);
    }
    now
}

/// Arrays in the order of others.
fn arrange(fields: &mut [Field], as_in: &[Field]) {
    fields.sort_by_key(|field| as_in.iter().position(|other| other.name == field.name));
}

/// The arrays that say what a mesh is: its labels, ids, marks and the memory of its refinement. All others are the user's, and may have changed since.
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
        // Twice only, or not since the last return, or hardly anything lost.
        assert!(!at(1, true, false).is_enough(1.0, true));
        assert!(!at(2, false, false).is_enough(1.0, false));
        assert!(!at(2, true, false).is_enough(0.9, true));
        // So much that nothing is waited for, and a mesh of which more is known.
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
