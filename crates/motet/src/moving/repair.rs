//! The repair within a step: which tets are repaired and improved, in the part of the mesh around them.

use std::borrow::Cow;
use std::sync::Arc;
use std::time::Instant;

use crate::base::{CellId, Point, Result, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::vector::{add, norm, scale, sub};
use crate::mesh::history::Changed;
use crate::mesh::{CellKind, Cutout, Mesh, bounds, largest_extent};
use crate::moving::contents::move_points;
use crate::moving::current::{Current, Derived, LeftBad, positions_after, present_rules};
use crate::moving::shapes::Shape;
use crate::moving::step::{Change, Why};
use crate::moving::step_run::StepRun;
use crate::remesh::{self, Density, Goal, Improve, Report, Whole, remesh_cutout, remesh_mesh};

/// The largest number of times a repair is repeated with more tets held.
const MAX_REPEATS: usize = 8;

/// No vertex is extrapolated to the next step farther than this fraction of the mean length of its edges.
const FARTHEST_AHEAD: f64 = 0.5;

/// A tet of the first mesh counts as unchanged if its EAS has fallen by no more than this.
const AS_AT_FIRST: f64 = 0.005;

/// Tets within this many layers of a bad one are near it.
const RINGS: usize = 2;

/// A part of a mesh is repaired with this many layers of cells around what is wanted; with as many more where
/// changes come near the cut.
const LAYERS: u8 = 6;
/// A part of more than this fraction of the cells is not repaired by itself.
const MOST_OF_MESH: f64 = 0.4;

/// How hard repair tries.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Effort {
    Usual,
    /// Before anything has moved: all tets within the margin.
    Margin,
    /// Bad tets were left: improve everything around them as far as possible.
    AllAround,
    /// No progress was possible: improve everything as far as possible.
    All,
}

/// The result of a repair.
pub(super) enum Repaired {
    Changed(Box<Current>),
    /// Nothing changed; these tets could not be repaired.
    Left(Vec<LeftBad>),
}

/// What a repair is to do.
struct Wanted<'a> {
    usual: &'a remesh::Options,
    effort: Effort,
    /// The tets to repair; `None`: all.
    only: Option<Vec<CellId>>,
    /// The tets to improve besides; `None`: nothing is improved.
    improve: Option<Vec<CellId>>,
    /// All tets below the target of the repair, and possibly some above it, with their EAS.
    low: Vec<(CellId, f64)>,
    /// How many free vertices are lacking.
    lack: isize,
    /// What holds of the whole mesh.
    whole: Whole,
}

impl StepRun<'_> {
    /// The mesh with its bad tets repaired, with the vertices at [`Self::points`].
    ///
    /// `before`: where the vertices were when the step began.
    pub(super) fn repaired(
        &mut self,
        now: &Current,
        before: &[Point],
        shape: &Shape,
        time: f64,
        effort: Effort,
    ) -> Result<Repaired> {
        let begin = Instant::now();
        let options = self.options;
        let is_needed = !shape.bad.is_empty() || effort == Effort::All;
        let Some(usual) = options.repair.as_ref().filter(|_| is_needed) else {
            return Ok(Repaired::Left(Vec::new()));
        };
        let wanted = self.wanted(now, shape, usual, effort);
        // Only contents depend on where the vertices are.
        let given = match options.contents.is_empty() {
            true => Cow::Borrowed(&now.mesh),
            false => Cow::Owned(now.moved(&self.points, &options.contents)),
        };
        let outcome = match self.remeshed_locally(now, &given, before, &wanted)? {
            Some(outcome) => Some(outcome),
            None => self.remeshed(now, &now.moved(&self.points, &options.contents), before, &wanted, None)?,
        };
        let Some(Changed { mesh, history, report, .. }) = outcome else {
            return Ok(Repaired::Left(Vec::new()));
        };
        let left = left_of(&report, options.limit());
        self.seconds.repair += begin.elapsed().as_secs_f64();
        if report.kept == report.before.tets {
            return Ok(Repaired::Left(left));
        }
        let begin = Instant::now();
        let history = Arc::new(history);
        let derived = Derived { given: &given, mesh, history: history.clone(), before: before.to_vec() };
        let next = now.next(derived, left, self.wall, options, self.threads)?;
        let counts = [now.tets.len(), next.tets.len()];
        let change = Change::new(time, Why::Repair, counts, shape, history, self.points.clone());
        self.changes.push(Change { operations: report.operations, ..change });
        self.seconds.setup += begin.elapsed().as_secs_f64();
        Ok(Repaired::Changed(Box::new(next)))
    }

    /// What is to be repaired and improved.
    fn wanted<'a>(
        &mut self,
        now: &Current,
        shape: &Shape,
        usual: &'a remesh::Options,
        effort: Effort,
    ) -> Wanted<'a> {
        let n_free = now.n_free();
        let target = *self.n_free.get_or_insert(n_free);
        // If walls come back, tets are compared with the first mesh at rest. A mesh that is put back need not
        // be good there.
        let rest = self.rest(now);
        let below = if effort == Effort::Margin { 0.0 } else { self.options.improve_below };
        let in_pose = rest.filter(|_| below > 0.0).map(|rest| now.tets.shape(rest, below, self.threads));
        let highest = if in_pose.is_some() { 0.0 } else { below };
        let limit = (self.options.limit() + self.options.margin).max(highest);
        let low = now.tets.shape(&self.points, limit, self.threads).bad;
        let first = &now.records.first_eas;
        let has_fallen = |&&(cell, eas): &&(CellId, f64)| {
            let is_as_at_first = eas >= first[cell.index()] - AS_AT_FIRST;
            eas < below && !is_as_at_first
        };
        let improve = (below > 0.0).then(|| {
            let low = in_pose.as_ref().map_or(&low, |in_pose| &in_pose.bad);
            low.iter().filter(has_fallen).map(|(cell, _)| *cell).collect()
        });
        let defects_in_pose = in_pose.as_ref().map_or(shape.defects, |in_pose| in_pose.defects);
        let n_tets = now.tets.len();
        Wanted {
            usual,
            effort,
            only: self.worth_repair(now, shape, &low, effort),
            improve,
            low,
            lack: target as isize - n_free as isize,
            whole: Whole {
                tets: n_tets,
                free_vertices: n_free,
                mean_defect: (shape.defects + defects_in_pose) / n_tets.max(1) as f64,
                extent: bounds(&self.points).map_or(0.0, largest_extent),
            },
        }
    }

    /// The vertices at rest, if tets are to be good there, too.
    fn rest<'a>(&self, now: &'a Current) -> Option<&'a [Point]> {
        now.records.rest.as_deref().filter(|_| !self.returns.count.is_unsettled)
    }

    /// The mesh after a repair of the part around what is wanted; `None` where that is much of the mesh, or
    /// depends on all of it. `given` has the arrays.
    fn remeshed_locally(
        &self,
        now: &Current,
        given: &Mesh,
        before: &[Point],
        wanted: &Wanted,
    ) -> Result<Option<Changed<Report>>> {
        let Wanted { usual, only, improve, lack, whole, .. } = wanted;
        let Some(only) = only.as_ref().filter(|_| usual.sizes.is_none()) else { return Ok(None) };
        if Density::is_far_off(*lack, whole.free_vertices) {
            return Ok(None);
        }
        let seeds: Vec<CellId> = only.iter().chain(improve.iter().flatten()).copied().collect();
        if seeds.is_empty() {
            return Ok(None);
        }
        let most = (MOST_OF_MESH * now.mesh.cells.len() as f64) as usize;
        for n_layers in (LAYERS..=u8::MAX / 2).step_by(usize::from(LAYERS)) {
            let cutout = Cutout::around(&now.mesh, &seeds, n_layers, most, self.threads);
            let Some(mut cutout) = cutout else { return Ok(None) };
            let places = cutout.pick(&self.points);
            move_points(&mut cutout.mesh, &places, &self.options.contents);
            if let Some(outcome) = self.remeshed(now, given, before, wanted, Some(&cutout))? {
                return Ok(Some(outcome));
            }
        }
        Ok(None)
    }

    /// The mesh after a repair, of a part if there is one. `None` if changes came near the cut of the part.
    fn remeshed(
        &self,
        now: &Current,
        given: &Mesh,
        before: &[Point],
        wanted: &Wanted,
        part: Option<&Cutout>,
    ) -> Result<Option<Changed<Report>>> {
        let mut repair = self.repair_options(now, before, wanted, part);
        let rules = present_rules(&self.options.rules, given);
        let mut tries_left = if self.options.valid_at_start { MAX_REPEATS } else { 0 };
        loop {
            let outcome = match part {
                Some(part) => remesh_cutout(given, &self.points, part, &repair, &rules, self.threads)?,
                None => Some(remesh_mesh(given, &repair, &rules, self.threads)?),
            };
            let Some(outcome) = outcome else { return Ok(None) };
            let replaced = if tries_left > 0 { replaced_by_inverted(&outcome, before)? } else { Vec::new() };
            if replaced.is_empty() {
                return Ok(Some(outcome));
            }
            repair.held.cells.extend(cells_in(part, &replaced));
            tries_left -= 1;
        }
    }

    /// The options of the remesher for a part, or for the whole mesh.
    fn repair_options(
        &self,
        now: &Current,
        before: &[Point],
        wanted: &Wanted,
        part: Option<&Cutout>,
    ) -> remesh::Options {
        let &Wanted { usual, effort, whole, .. } = wanted;
        let min_eas = (usual.min_eas + self.options.margin).min(1.0);
        let mut held = usual.held.clone();
        held.cells = cells_in(part, &held.cells);
        if part.is_some() && usual.keep_layers {
            // A part may have no more than the upper end of a layer.
            let limit = remesh::Options { min_eas, ..usual.clone() }.limit();
            held.cells.extend(cells_in(part, &now.tets.layers(&wanted.low, &self.points, limit)));
        }
        remesh::Options {
            min_eas,
            only: wanted.only.as_ref().map(|only| cells_in(part, only)),
            improve: self.improve(now, before, wanted, part),
            goal: if matches!(effort, Effort::Usual | Effort::Margin) { usual.goal } else { Goal::Best },
            keep_layers: usual.keep_layers && part.is_none(),
            held,
            part_of: part.map(|_| whole),
            ..usual.clone()
        }
    }

    /// The tets to repair, among those of `low` quality; `None`: all.
    fn worth_repair(
        &self,
        now: &Current,
        shape: &Shape,
        low: &[(CellId, f64)],
        effort: Effort,
    ) -> Option<Vec<CellId>> {
        let limit = self.options.limit();
        let is_below_target = |low: &&(CellId, f64)| low.1 < limit + self.options.margin;
        match effort {
            Effort::All => None,
            Effort::AllAround => Some(now.tets.around(&shape.bad, RINGS, self.points.len())),
            Effort::Margin => Some(low.iter().filter(is_below_target).map(|(cell, _)| *cell).collect()),
            Effort::Usual => {
                let low: Vec<_> = low.iter().filter(is_below_target).copied().collect();
                let was = now.tets.eas_of(&low, now.mover.reference());
                let fallen = low.iter().zip(was).filter(|((_, is), was)| is - (was - is).max(0.0) < limit);
                Some(fallen.map(|((cell, _), _)| *cell).collect())
            }
        }
    }

    /// How tets are improved besides the bad ones: those that have deteriorated since the start. If the
    /// repair has sizes of its own, they replace the density.
    fn improve(
        &self,
        now: &Current,
        before: &[Point],
        wanted: &Wanted,
        part: Option<&Cutout>,
    ) -> Option<Improve> {
        let cells = cells_in(part, wanted.improve.as_ref()?);
        let all: Vec<VertexId>;
        let vertices = match part {
            Some(part) => &part.vertices,
            None => {
                all = (0..self.points.len()).map(VertexId::new).collect();
                &all
            }
        };
        let sizes =
            self.sizes.at_vertices(now, &self.points, vertices, self.wall, self.options, self.threads);
        // The mesh ahead is nearly the current one: a gain counts twice, and so must the cost.
        let (pose, cost) = match self.rest(now) {
            Some(rest) => (vertices.iter().map(|v| rest[v.index()]).collect(), Improve::FEW_CHANGES),
            None => (self.ahead(vertices, before, &sizes), 2.0 * Improve::FEW_CHANGES),
        };
        let density = Density { sizes, lack: wanted.lack };
        Some(Improve {
            below: self.options.improve_below,
            cells: Some(cells),
            keeps_others: false,
            raises_worst: false,
            density: wanted.usual.sizes.is_none().then_some(density),
            pose: Some(pose),
            cost,
        })
    }

    /// The positions of some vertices after the next step if they continue as in this one. All move less far
    /// if one would exceed [`FARTHEST_AHEAD`], since walls turn. `sizes` has an entry for each of them.
    fn ahead(&self, vertices: &[VertexId], before: &[Point], sizes: &[f64]) -> Vec<Point> {
        let way = |v: &VertexId| sub(self.points[v.index()], before[v.index()]);
        let lengths = vertices.iter().zip(sizes).filter(|(_, size)| **size > 0.0);
        let farthest = lengths.map(|(v, size)| norm(way(v)) / size).fold(0.0, f64::max);
        let part = (FARTHEST_AHEAD / farthest).min(1.0);
        vertices.iter().map(|v| add(self.points[v.index()], scale(way(v), part))).collect()
    }
}

/// The cells of a part that some cells of the whole mesh are; these themselves if there is no part.
fn cells_in(part: Option<&Cutout>, cells: &[CellId]) -> Vec<CellId> {
    part.map_or_else(|| cells.to_vec(), |part| part.inside(cells))
}

/// The tets of the old mesh that a repair has replaced by tets without volume at the positions that their
/// vertices had when the step began, which were `before` for those of the old mesh.
fn replaced_by_inverted(outcome: &Changed<Report>, before: &[Point]) -> Result<Vec<CellId>> {
    let start = positions_after(before, &outcome.history)?;
    let side = |tet: &[VertexId], points: &[Point]| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| points[tet[i].index()]);
        orient3d(a, b, c, d)
    };
    let (mut replaced, cells) = (Vec::new(), &outcome.mesh.cells);
    let changed = outcome.history.cells.changed();
    for (&cell, row) in changed.ids().iter().zip(changed.iter()) {
        let tet = cells.vertices(cell);
        if cells.kind(cell) == CellKind::TETRA && side(tet, &start) * side(tet, &outcome.mesh.points) <= 0 {
            replaced.extend_from_slice(row.from);
        }
    }
    replaced.sort_unstable();
    replaced.dedup();
    Ok(replaced)
}

/// The bad tets that repair has left. Those between the limit and the target of the repair are not bad yet:
/// they are tried once they fall below the limit.
fn left_of(report: &remesh::Report, limit: f64) -> Vec<LeftBad> {
    let of =
        |left: &remesh::Left| LeftBad { cell: left.tet, eas: left.eas, is_forced: left.reason.is_forced() };
    let mut all: Vec<LeftBad> = report.left.iter().filter(|left| left.eas < limit).map(of).collect();
    all.sort_by_key(|left| left.cell);
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::remesh::{Left, Reason};

    #[test]
    fn what_repair_left_above_the_limit_is_not_left_bad() {
        let of = |tet: u32, eas: f64| Left {
            tet: CellId(tet),
            eas,
            place: [0.0; 3],
            defect: "other",
            reason: Reason::NothingHelps,
        };
        let report =
            remesh::Report { left: vec![of(7, 0.1), of(3, 0.22), of(2, 0.19)], ..Default::default() };
        let left: Vec<_> = left_of(&report, 0.2).into_iter().map(|left| (left.cell.0, left.eas)).collect();
        assert_eq!(left, [(2, 0.19), (7, 0.1)]);
    }
}
