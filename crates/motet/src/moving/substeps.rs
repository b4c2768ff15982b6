//! A step, in as many parts as it takes: move while tets stay well shaped, repair, move on.

use std::sync::Arc;
use std::time::Instant;

use crate::base::{CellId, Point, Result, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::vector::{add, norm, scale, sub};
use crate::mesh::history::{Changed, Origin};
use crate::moving::current::{Current, Derived, LeftBad, Records, positions_after, present_rules};
use crate::moving::shapes::Shape;
use crate::moving::step::{Change, Why};
use crate::moving::step_run::{StepResult, StepRun};
use crate::remesh::{self, Density, Goal, Improve, Report, remesh_mesh};

/// Parts are halved down to this if tets would become flat: repairing more often than that makes no progress.
const MIN_PART_IF_FLAT: f64 = 1.0 / 32.0;
/// Parts are halved down to this if tets would be inverted.
const MIN_PART_IF_INVERTED: f64 = 1.0 / 4096.0;

/// The largest number of times a repair is repeated with more tets held.
const MAX_REPEATS: usize = 8;

/// No vertex is extrapolated to the next step farther than this fraction of the mean length of its edges.
const FARTHEST_AHEAD: f64 = 0.5;

/// A tet of the first mesh counts as unchanged if its EAS has fallen by no more than this.
const AS_AT_FIRST: f64 = 0.005;

/// Tets within this many layers of a bad one are near it.
const RINGS: usize = 2;

/// How hard repair tries.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Effort {
    Usual,
    /// Before anything has moved: all tets within the margin.
    Margin,
    /// Bad tets were left: improve everything around them as far as possible.
    AllAround,
    /// No progress was possible: improve everything as far as possible.
    All,
}

impl StepRun<'_> {
    /// Makes the step from `start`, which is not changed. If walls have come back, the first mesh may be put
    /// back at the end.
    pub(super) fn go(&mut self, start: &Current) -> Result<StepResult> {
        let reached = self.moved_and_repaired(start)?;
        if reached.fraction < 1.0 || self.returns.count.is_unsettled {
            return Ok(reached);
        }
        let put_back = match &reached.changed {
            Some(now) => self.put_back(now, &now.records.before, true)?,
            None => self.put_back(start, &start.mesh.points, false)?,
        };
        Ok(put_back.map_or(reached, |(now, shape)| self.at_first_mesh(now, shape)))
    }

    fn at_first_mesh(&mut self, now: Current, shape: Shape) -> StepResult {
        self.points.clone_from(&now.mesh.points);
        StepResult { changed: Some(now), left: None, shape, fraction: 1.0 }
    }

    fn moved_and_repaired(&mut self, start: &Current) -> Result<StepResult> {
        let (mut changed, mut done, mut effort) = (None::<Current>, 0.0, Effort::Usual);
        loop {
            let watch = self.threads.watch();
            watch.report_and_check("moving and repairing", self.legs, self.options.motion.substeps)?;
            let now = changed.as_ref().unwrap_or(start);
            let (part, shape) = self.leg(now)?;
            self.legs += 1;
            done = if part == 1.0 { 1.0 } else { done + (1.0 - done) * part };
            let is_stuck = part == 0.0;
            if is_stuck && effort == Effort::All || self.legs >= self.options.motion.substeps {
                return Ok(StepResult { changed, left: None, shape, fraction: done });
            }
            let is_end = part == 1.0;
            // The first mesh of a step is where it was when the step began.
            let before = changed.as_ref().map_or(&start.mesh.points, |now| &now.records.before);
            // A mesh that will be replaced anyway is not repaired first.
            if is_end
                && self.returns.count.is_unsettled
                && let Some((now, shape)) = self.put_back(now, before, changed.is_some())?
            {
                return Ok(self.at_first_mesh(now, shape));
            }
            let is_worth_it = shape.bad.iter().any(|&(cell, eas)| !now.is_left(cell, eas));
            if is_end && !(is_worth_it && self.options.repair.is_some()) {
                return Ok(StepResult { changed, left: None, shape, fraction: done });
            }
            effort = if is_stuck { Effort::All } else { Effort::Usual };
            let time = self.times[0] + (self.times[1] - self.times[0]) * done;
            let next = match self.repaired(now, before, &shape, time, effort)? {
                Repaired::Changed(next) => *next,
                Repaired::Left(left) if is_end => {
                    return Ok(StepResult { changed, left: Some(left), shape, fraction: done });
                }
                Repaired::Left(left) => self.rebased(now, before, left)?,
            };
            self.points.clone_from(&next.mesh.points);
            if is_end {
                let (next, shape) = self.improved_around(next, effort, time)?;
                self.points.clone_from(&next.mesh.points);
                return Ok(StepResult { changed: Some(next), left: None, shape, fraction: done });
            }
            changed = Some(next);
        }
    }

    /// If repair has left bad tets that no wall forces, everything around them is improved as far as
    /// possible, once: the step ends here, and no tet should be bad at its end. A flap pressed to its wall
    /// had up to 26 such tets of 150,000, in 32 of 480 steps.
    fn improved_around(&mut self, next: Current, effort: Effort, time: f64) -> Result<(Current, Shape)> {
        let shape = self.shape(&next);
        let n_left = shape.bad.len() - next.n_forced(&shape);
        if n_left == 0 || effort != Effort::Usual {
            return Ok((next, shape));
        }
        let before = next.records.before.clone();
        match self.repaired(&next, &before, &shape, time, Effort::AllAround)? {
            Repaired::Left(_) => Ok((next, shape)),
            Repaired::Changed(better) => {
                let shape = self.shape(&better);
                Ok((*better, shape))
            }
        }
    }

    /// Repairs bad tets without moving; `is_first`: before the first step.
    pub(super) fn repair_in_place(&mut self, start: &Current, is_first: bool) -> Result<StepResult> {
        self.points.clone_from(&start.mesh.points);
        let shape = self.shape_at(start);
        let mut reached = StepResult { changed: None, left: None, shape, fraction: 1.0 };
        if self.options.repair.is_some() && !reached.shape.bad.is_empty() {
            let effort = if is_first { Effort::Margin } else { Effort::Usual };
            match self.repaired(start, &start.records.before, &reached.shape, self.times[0], effort)? {
                Repaired::Changed(next) => reached.changed = Some(*next),
                Repaired::Left(left) => reached.left = Some(left),
            }
        }
        Ok(reached)
    }

    /// Moves on as far as tets stay well shaped: all the remaining way, or half of it, and so on. Returns the
    /// fraction of the remaining way, and the shape of the tets there.
    fn leg(&mut self, now: &Current) -> Result<(f64, Shape)> {
        let (from, to) = (now.here(), now.target(self.displacement));
        let mut part = 1.0;
        loop {
            let driven: Vec<Point> = match part {
                1.0 => to.clone(),
                _ => from.iter().zip(&to).map(|(&a, &b)| add(a, scale(sub(b, a), part))).collect(),
            };
            self.points.resize(now.mesh.points.len(), [0.0; 3]);
            let begin = Instant::now();
            now.mover.step(&driven, &mut self.points, self.threads)?;
            self.seconds.motion += begin.elapsed().as_secs_f64();
            let begin = Instant::now();
            let is_upright = now.mover.check.newly_inverted(&self.points, self.threads).is_empty();
            self.seconds.quality += begin.elapsed().as_secs_f64();
            if is_upright {
                let shape = self.shape_at(now);
                let is_flat =
                    |&(cell, eas): &(CellId, f64)| eas < self.options.floor && !now.is_left(cell, eas);
                if part <= MIN_PART_IF_FLAT || self.options.repair.is_none() || !shape.bad.iter().any(is_flat)
                {
                    return Ok((part, shape));
                }
            }
            part *= 0.5;
            if part < MIN_PART_IF_INVERTED {
                self.points.copy_from_slice(&now.mesh.points);
                return Ok((0.0, self.shape_at(now)));
            }
        }
    }

    /// The mesh with its bad tets repaired, with the vertices at [`Self::points`].
    fn repaired(
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
        let mut repair = remesh::Options {
            min_eas: (usual.min_eas + options.margin).min(1.0),
            only: self.worth_repair(now, shape, effort),
            improve: self.improve(now, before, usual, effort),
            goal: if matches!(effort, Effort::Usual | Effort::Margin) { usual.goal } else { Goal::Best },
            ..usual.clone()
        };
        let given = now.moved(&self.points, &options.contents);
        let rules = present_rules(&options.rules, &given);
        let mut tries_left = if options.valid_at_start { MAX_REPEATS } else { 0 };
        let outcome = loop {
            let outcome = remesh_mesh(&given, &repair, &rules, self.threads)?;
            let replaced = if tries_left > 0 { replaced_by_inverted(&outcome, before)? } else { Vec::new() };
            if replaced.is_empty() {
                break outcome;
            }
            repair.held.cells.extend(replaced);
            tries_left -= 1;
        };
        let (report, history) = (outcome.report, Arc::new(outcome.history));
        self.n_free.get_or_insert(report.before.free_vertices);
        let left = left_of(&report, options.limit());
        self.seconds.repair += begin.elapsed().as_secs_f64();
        if report.kept == now.tets.len() && outcome.mesh.points == given.points {
            return Ok(Repaired::Left(left));
        }
        let begin = Instant::now();
        let derived =
            Derived { given: &given, mesh: outcome.mesh, history: history.clone(), before: before.to_vec() };
        let next = now.next(derived, left, self.wall, options, self.threads)?;
        let counts = [now.tets.len(), report.after.tets];
        let change = Change::new(time, Why::Repair, counts, shape, history, self.points.clone());
        self.changes.push(Change { operations: report.operations, ..change });
        self.seconds.setup += begin.elapsed().as_secs_f64();
        Ok(Repaired::Changed(Box::new(next)))
    }

    /// The tets to repair; `None`: all.
    fn worth_repair(&self, now: &Current, shape: &Shape, effort: Effort) -> Option<Vec<CellId>> {
        let limit = self.options.limit();
        let low = || now.tets.shape(&self.points, limit + self.options.margin, self.threads).bad;
        match effort {
            Effort::All => None,
            Effort::AllAround => Some(now.tets.around(&shape.bad, RINGS, self.points.len())),
            Effort::Margin => Some(low().into_iter().map(|(cell, _)| cell).collect()),
            Effort::Usual => {
                let low = low();
                let was = now.tets.eas_of(&low, now.mover.reference());
                let fallen = low.iter().zip(was).filter(|((_, is), was)| is - (was - is).max(0.0) < limit);
                Some(fallen.map(|((cell, _), _)| *cell).collect())
            }
        }
    }

    /// Which tets are improved besides the bad ones: those that have deteriorated since the start. If the
    /// repair has sizes of its own, they replace the density.
    ///
    /// `before`: where the vertices were when the step began.
    fn improve(
        &self,
        now: &Current,
        before: &[Point],
        usual: &remesh::Options,
        effort: Effort,
    ) -> Option<Improve> {
        let below = self.options.improve_below;
        if below == 0.0 || effort == Effort::Margin {
            return None;
        }
        // If walls come back, tets are compared with the first mesh at rest. A mesh that is put back need not
        // be good there.
        let rest = now.records.rest.as_ref().filter(|_| !self.returns.count.is_unsettled);
        let places = rest.unwrap_or(&self.points);
        let low = now.tets.shape(places, below, self.threads).bad;
        let first = &now.records.first_eas;
        let is_as_at_first = |&(cell, eas): &(CellId, f64)| eas >= first[cell.index()] - AS_AT_FIRST;
        let cells = low.into_iter().filter(|low| !is_as_at_first(low)).map(|(cell, _)| cell).collect();
        let sizes = self.sizes.at_vertices(now, &self.points, self.wall, self.options, self.threads);
        // The mesh ahead is nearly the current one: a gain counts twice, and so must the cost.
        let (pose, cost) = match rest {
            Some(rest) => (rest.clone(), Improve::FEW_CHANGES),
            None => (self.ahead(before, &sizes), 2.0 * Improve::FEW_CHANGES),
        };
        let density = Density { sizes, free_vertices: self.n_free };
        Some(Improve {
            below,
            cells: Some(cells),
            keeps_others: false,
            raises_worst: false,
            density: usual.sizes.is_none().then_some(density),
            pose: Some(pose),
            cost,
        })
    }

    /// The positions of the vertices after the next step if they continue as in this one. All move less far
    /// if one would exceed [`FARTHEST_AHEAD`], since walls turn.
    fn ahead(&self, before: &[Point], sizes: &[f64]) -> Vec<Point> {
        let ways: Vec<Point> = self.points.iter().zip(before).map(|(&to, &from)| sub(to, from)).collect();
        let lengths = ways.iter().zip(sizes).filter(|(_, size)| **size > 0.0);
        let farthest = lengths.map(|(&way, size)| norm(way) / size).fold(0.0, f64::max);
        let part = (FARTHEST_AHEAD / farthest).min(1.0);
        self.points.iter().zip(ways).map(|(&to, way)| add(to, scale(way, part))).collect()
    }

    /// The mesh of the step, with the positions in [`Self::points`] as its new reference.
    fn rebased(&mut self, now: &Current, before: &[Point], left: Vec<LeftBad>) -> Result<Current> {
        let begin = Instant::now();
        let mesh = now.moved(&self.points, &self.options.contents);
        let records = Records { before: before.to_vec(), ..now.records.clone() };
        let next = Current::new(mesh, records, left, self.wall, self.options, self.threads);
        self.seconds.setup += begin.elapsed().as_secs_f64();
        next
    }
}

/// The result of a repair.
enum Repaired {
    Changed(Box<Current>),
    /// Nothing changed; these tets could not be repaired.
    Left(Vec<LeftBad>),
}

/// The tets of the old mesh that a repair has replaced by tets without volume at the positions that their
/// vertices had when the step began, which were `before` for those of the old mesh.
fn replaced_by_inverted(outcome: &Changed<Report>, before: &[Point]) -> Result<Vec<CellId>> {
    let start = positions_after(before, &outcome.history)?;
    let side = |tet: [VertexId; 4], points: &[Point]| {
        let [a, b, c, d] = tet.map(|v| points[v.index()]);
        orient3d(a, b, c, d)
    };
    let mut replaced = Vec::new();
    for (cell, tet) in outcome.mesh.cells.tets() {
        if let Origin::Changed(row) = outcome.history.cells.of(cell)
            && side(tet, &start) * side(tet, &outcome.mesh.points) <= 0
        {
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
