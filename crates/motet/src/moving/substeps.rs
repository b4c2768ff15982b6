//! A step, in as many parts as it takes: move while tets stay well shaped, repair, move on.

use std::time::Instant;

use crate::base::{CellId, Point, Result};
use crate::geometry::vector::{add, scale, sub};
use crate::moving::current::{Current, LeftBad};
use crate::moving::repair::{Effort, Repaired};
use crate::moving::shapes::Shape;
use crate::moving::step_run::{StepResult, StepRun};

/// Parts are halved down to this if tets would become flat: repairing more often than that makes no progress.
const MIN_PART_IF_FLAT: f64 = 1.0 / 32.0;
/// Parts are halved down to this if tets would be inverted.
const MIN_PART_IF_INVERTED: f64 = 1.0 / 4096.0;

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

    /// The mesh of the step, with the positions in [`Self::points`] as its new reference.
    fn rebased(&mut self, now: &Current, before: &[Point], left: Vec<LeftBad>) -> Result<Current> {
        let begin = Instant::now();
        let next = now.rebased(&self.points, before, left, self.wall, self.options, self.threads);
        self.seconds.setup += begin.elapsed().as_secs_f64();
        next
    }
}
