//! The handle: a mesh that moves with its walls, step after step.

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use crate::base::{Error, Point, Result, Threads};
use crate::contact;
use crate::geometry::vector::{in_range, sub};
use crate::mesh::history::{History, Rule};
use crate::mesh::{Field, Mesh};
use crate::motion::{LeavesPlane, Mover, mesh_velocity};
use crate::moving::contents::move_points;
use crate::moving::current::{Current, Derived, InFirst, Records, present_rules};
use crate::moving::first_mesh::{FirstMesh, Returns};
use crate::moving::hold::{self, Held, Hold};
use crate::moving::options::Options;
use crate::moving::shapes::Shape;
use crate::moving::sizes::{SizeMap, Sizes};
use crate::moving::step::{Change, Seconds, Step, Why, WorstTet};
use crate::moving::step_run::{StepResult, StepRun};
use crate::moving::wall::Wall;
use crate::moving::watch::Watch;
use crate::refine::{self, Criterion, MeshRefinement, Size, Wanted};
use crate::remesh::Counts;

/// A mesh that moves with its walls and keeps its quality: moved, certified, repaired, refined, watched, with
/// its arrays carried along.
///
/// Calls on one mesh are made one at a time; different meshes can be used at the same time. A clone goes on
/// with the same bytes as the original: a step of an implicit coupling is repeated from a clone made before
/// it.
#[derive(Clone, Debug)]
pub struct MovingMesh {
    pub(super) options: Options,
    pub(super) wall: Wall,
    pub(super) now: Current,
    pub(super) clock: Clock,
    pub(super) changes: VecDeque<(usize, Arc<History>)>,
    /// Changes of steps up to this one are no longer known.
    pub(super) forgotten: Option<usize>,
    /// The record of returns, and the first mesh.
    pub(super) returns: Returns,
    /// Requested edge lengths.
    pub(super) sizes: Sizes,
    watch: Option<Watch>,
    pub(super) hold: Option<Hold>,
    /// The nodes stopped in the last step.
    held: Held,
}

/// The time of a mesh, and its counters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Clock {
    /// The number of steps made.
    pub(super) step: usize,
    pub(super) time: f64,
    /// The duration of the last step.
    pub(super) dt: f64,
    /// How many free vertices the mesh is to have: as many as at first, or as refinement left. `None`: as
    /// many as it has.
    pub(super) n_free: Option<usize>,
}

impl MovingMesh {
    /// Takes over a mesh with its walls undisplaced, at time 0.
    ///
    /// # Errors
    /// The errors of [`Mover::new`], and if a watched patch does not exist.
    pub fn new(mesh: &Mesh, options: Options, threads: &Threads) -> Result<Self> {
        options.check()?;
        let mover = Mover::new(mesh, &options.motion.options(mesh)?, threads)?;
        let wall = Wall::of(mesh, &mover, &options)?;
        let mut records = Records::at_first(mesh, mover.boundary());
        records.rest = options.returns.then(|| mesh.points.clone());
        let now = Current::of(mesh.clone(), mover, records, Vec::new(), &wall, threads)?;
        let mut moving = Self::of(options, wall, now, Sizes::at_first(mesh), Clock::default(), threads)?;
        moving.remember_first(threads);
        moving.measure_gaps(threads)?;
        Ok(moving)
    }

    pub(super) fn of(
        options: Options,
        wall: Wall,
        now: Current,
        sizes: Sizes,
        clock: Clock,
        threads: &Threads,
    ) -> Result<Self> {
        let hold = options.watch.as_ref().map(|watch| Hold::of(watch, &wall, threads)).transpose()?.flatten();
        let watch = options.watch.clone().map(Watch::new);
        Ok(Self {
            options,
            wall,
            now,
            clock,
            changes: VecDeque::new(),
            forgotten: None,
            returns: Returns::default(),
            sizes,
            watch,
            hold,
            held: Held::default(),
        })
    }

    /// Remembers the current mesh as the first one.
    fn remember_first(&mut self, threads: &Threads) {
        self.returns.first = FirstMesh::of(&self.now, &self.options, threads);
        if self.returns.first.is_some() {
            self.now.records.in_first = InFirst::same(&self.now.mesh);
        }
    }

    /// The first positions of the driven vertices: those of the boundary, and of the requested patches
    /// inside, in the order of the first mesh. Displacements are given for these, whatever becomes of the
    /// mesh.
    pub fn driven_places(&self) -> &[Point] {
        &self.wall.places
    }

    /// The mesh as it is now, with its arrays.
    pub fn mesh(&self) -> &Mesh {
        &self.now.mesh
    }

    /// The time that was reached.
    pub fn time(&self) -> f64 {
        self.clock.time
    }

    /// The number of steps made.
    pub fn step(&self) -> usize {
        self.clock.step
    }

    /// Where a rim of a sliding patch would deviate farthest from its plane if walls had these displacements
    /// now, measured from the planes of the last change.
    ///
    /// # Panics
    /// Panics if there are not as many displacements as [`Self::driven_places`].
    pub fn leaves_plane(&self, displacement: &[Point]) -> Option<LeavesPlane> {
        assert_eq!(displacement.len(), self.wall.places.len(), "a displacement for each driven vertex");
        self.now.mover.leaves_plane(&self.now.target(displacement))
    }

    /// The options of this mesh.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The velocity of each vertex in the last step; zero before the first. For a vertex inserted in it,
    /// measured from the position at its beginning that is interpolated between the vertices it came from.
    pub fn velocity(&self) -> Vec<Point> {
        let Self { now, clock, .. } = self;
        let points = &now.mesh.points;
        // A step without duration has no velocity.
        mesh_velocity(&now.records.before, points, clock.dt).unwrap_or_else(|_| vec![[0.0; 3]; points.len()])
    }

    /// The displacement of each vertex from its first position.
    pub fn displacement(&self) -> Vec<Point> {
        let pairs = self.now.mesh.points.iter().zip(&self.now.records.first);
        pairs.map(|(&p, &first)| sub(p, first)).collect()
    }

    /// The last measurement of gaps; `None` if nothing is watched, or if the mesh has been divided, coarsened
    /// or repaired since: [`Self::certify`] measures again.
    pub fn gaps(&self) -> Option<&contact::Gaps> {
        self.watch.as_ref().filter(|watch| !watch.is_stale()).and_then(|watch| watch.last.as_ref())
    }

    /// Sets a point array of the mesh, replacing one of the same name: a solver's new values. Arrays are
    /// carried where the mesh changes.
    ///
    /// # Errors
    /// If the field does not have one row per point.
    pub fn set_point_field(&mut self, field: Field) -> Result<()> {
        check_rows(&field, self.now.mesh.points.len(), "points")?;
        self.now.mesh.set_point_field(field);
        Ok(())
    }

    /// Sets a cell array of the mesh, replacing one of the same name.
    ///
    /// # Errors
    /// If the field does not have one row per cell.
    pub fn set_cell_field(&mut self, field: Field) -> Result<()> {
        check_rows(&field, self.now.mesh.cells.len(), "cells")?;
        self.now.mesh.set_cell_field(field);
        Ok(())
    }

    /// The history from the mesh after `step` (0: the first) to the mesh as it is: transfers any array at any
    /// time level in between. `None` if the connectivity is the same.
    ///
    /// # Errors
    /// If that step has not been made yet, or if changes since it are not known: those made before a loaded
    /// state was saved, and those before the last [`Options::remembered`]. [`Self::remembers`] tests for
    /// that.
    pub fn history_since(&self, step: usize) -> Result<Option<History>> {
        if !self.remembers(step) {
            return Err(self.not_known(step));
        }
        let later = self.changes.iter().filter(|(at, _)| *at > step).map(|(_, history)| history);
        Ok(later.fold(None, |all: Option<History>, history| {
            Some(all.map_or_else(|| History::clone(history), |all| all.then(history)))
        }))
    }

    fn not_known(&self, step: usize) -> Error {
        let last = self.clock.step;
        match self.forgotten.filter(|_| step <= last) {
            None => Error::options(format!("step {step} has not been made yet: the last one is {last}"))
                .remedy(format!("give a step up to {last}")),
            Some(first) => Error::options(format!(
                "changes since step {step} are not known, only those since step {first}: \
                 a state that is loaded does not hold those before it was saved, \
                 and only the last {} are remembered",
                self.options.remembered
            ))
            .remedy(format!(
                "transfer arrays before the state is saved, increase `remembered`, \
                 or give step {first} or a later one"
            )),
        }
    }

    /// Whether all changes since a step are known.
    pub fn remembers(&self, step: usize) -> bool {
        step <= self.clock.step && self.forgotten.is_none_or(|forgotten| step >= forgotten)
    }

    /// Moves the walls to where they are at `time`: `displacement` has an entry for each of
    /// [`Self::driven_places`], measured from there. The inside follows; tets that become bad are repaired,
    /// on the way if necessary.
    ///
    /// A motion that cannot be completed is not an error: see [`Step::complete`].
    ///
    /// # Errors
    /// If a displacement is missing or not finite, if time does not advance, if an array cannot be carried,
    /// and if the watch stops the call. Then everything is as before the call.
    pub fn advance(&mut self, time: f64, displacement: &[Point], threads: &Threads) -> Result<Step> {
        let begin = Instant::now();
        self.check(time, displacement)?;
        let start = self.clock.time;
        let held = self.hold.as_mut().map(|hold| hold.stop(&self.wall.places, displacement, threads));
        let holding = begin.elapsed().as_secs_f64();
        let displacement = held.as_ref().map_or(displacement, |held| &held.displacement);
        let mut run = self.step_run(displacement, time, threads);
        let StepResult { changed, left, shape, fraction } = run.go(&self.now)?;
        let StepRun { points, mut seconds, changes, legs, n_free, .. } = run;
        match changed {
            Some(now) => self.now = now,
            None => self.now.records.before.clone_from(&self.now.mesh.points),
        }
        match left {
            Some(left) => self.now.left = left,
            None => self.now.drop_good(&shape),
        }
        move_points(&mut self.now.mesh, &points, &self.options.contents);
        let is_complete = fraction == 1.0;
        if is_complete && self.options.returns && self.wall.is_at_rest(displacement) {
            self.now.records.rest = Some(self.now.mesh.points.clone());
        }
        let reached = if is_complete { time } else { start + (time - start) * fraction };
        self.clock = Clock { step: self.clock.step + 1, time: reached, dt: reached - start, n_free };
        self.remember(&changes);
        self.returns.count_step(is_complete.then_some(displacement), &changes);
        let begin_contact = Instant::now();
        if let (Some(hold), Some(held)) = (&mut self.hold, held) {
            hold.advance(&held.displacement, fraction);
            self.held = held;
        }
        let gaps = self.measure_gaps(threads)?;
        seconds.contact = holding + begin_contact.elapsed().as_secs_f64();
        let inverted_at_start = if changes.is_empty() { None } else { self.now.inverted_at_start(threads) };
        let begin_certificate = Instant::now();
        let certified = self.certified(&shape, threads);
        seconds.quality += begin_certificate.elapsed().as_secs_f64();
        seconds.total = begin.elapsed().as_secs_f64();
        Ok(Step {
            complete: is_complete,
            fraction,
            legs,
            changes,
            inverted_at_start,
            gaps,
            seconds,
            ..certified
        })
    }

    /// Where the vertices would be with the walls at these displacements, in one part and without repair,
    /// whatever becomes of the tets. Nothing changes: this shows what follows from a displacement while it is
    /// still being chosen, at the cost of the motion alone.
    ///
    /// # Errors
    /// If a displacement is missing or not finite.
    pub fn preview(&self, displacement: &[Point], threads: &Threads) -> Result<Vec<Point>> {
        self.check_displacement(displacement)?;
        let mut points = self.now.mesh.points.clone();
        self.now.mover.step(&self.now.target(displacement), &mut points, threads)?;
        Ok(points)
    }

    /// Certifies the mesh as it is, without a step.
    ///
    /// # Errors
    /// If gaps cannot be measured.
    pub fn certify(&mut self, threads: &Threads) -> Result<Step> {
        let begin = Instant::now();
        let shape = self.now.tets.shape(&self.now.mesh.points, self.options.limit(), threads);
        let certified = self.certified(&shape, threads);
        let quality = begin.elapsed().as_secs_f64();
        let gaps = self.measure_gaps(threads)?;
        let total = begin.elapsed().as_secs_f64();
        let seconds = Seconds { quality, contact: total - quality, total, ..Seconds::default() };
        Ok(Step { complete: true, fraction: 1.0, gaps, seconds, ..certified })
    }

    /// Repairs bad tets of the mesh where it is, at the current time. A step does so by itself; a mesh that
    /// was just given or refined may need it before the first.
    ///
    /// # Errors
    /// If an array cannot be carried, and if the watch stops the call. Then everything is as before the call.
    pub fn repair(&mut self, threads: &Threads) -> Result<Option<Change>> {
        let mut run = self.step_run(&[], self.clock.time, threads);
        let StepResult { changed, left, .. } = run.repair_in_place(&self.now, self.clock.step == 0)?;
        let (changes, n_free) = (run.changes, run.n_free);
        self.clock.n_free = n_free;
        if let Some(left) = left {
            self.now.left = left;
        }
        if let Some(now) = changed {
            self.now = now;
            self.remember(&changes);
        }
        // Initially bad tets should not come back with the first mesh.
        if self.clock.step == 0 && self.returns.first.is_some() {
            self.remember_first(threads);
        }
        Ok(changes.into_iter().next())
    }

    fn step_run<'a>(&'a self, displacement: &'a [Point], time: f64, threads: &'a Threads) -> StepRun<'a> {
        StepRun {
            options: &self.options,
            wall: &self.wall,
            returns: &self.returns,
            sizes: &self.sizes.now,
            displacement,
            times: [self.clock.time, time],
            n_free: self.clock.n_free,
            threads,
            points: Vec::new(),
            seconds: Seconds::default(),
            changes: Vec::new(),
            legs: 0,
        }
    }

    /// Divides tets and undoes divisions, at the current time, as [`MeshRefinement::reach`] does. Divisions
    /// are recorded in arrays of the mesh.
    ///
    /// If patches are watched, criteria find the point array [`GAP`]: the gap at each vertex of the patches,
    /// no limit elsewhere. As a size it keeps edges of walls as short as the gap between them is wide, and so
    /// the tets in it well shaped; a limit on the smallest edge ends that. If [`GAP`] is the only criterion,
    /// divisions are also undone [by lengths](Self::coarsen).
    ///
    /// # Errors
    /// The errors of [`MeshRefinement::reach`]. Then everything is as before the call.
    pub fn refine(&mut self, wanted: &Wanted, threads: &Threads) -> Result<Vec<Change>> {
        let mut changes: Vec<Change> = self.divide(wanted, threads)?.into_iter().collect();
        let is_gap =
            |criterion: &Criterion| matches!(criterion, Criterion::Size(Size::Array(name)) if name == GAP);
        // Only gaps determine how long edges may be. A mesh that has not moved yet was not repaired.
        let knows_lengths = !wanted.criteria.is_empty() && wanted.criteria.iter().all(is_gap);
        if wanted.coarsen && knows_lengths && self.clock.step > 0 {
            changes.extend(self.coarsen(wanted.limits.smallest.unwrap_or(0.0), threads)?);
        }
        Ok(changes)
    }

    fn divide(&mut self, wanted: &Wanted, threads: &Threads) -> Result<Option<Change>> {
        let gaps = self.gaps_here(threads)?;
        let mut given = self.now.mesh.clone();
        let mut rules = present_rules(&self.options.rules, &given);
        if let Some(gaps) = gaps {
            let sizes: Vec<f64> =
                gaps.into_iter().map(|gap| gap.clamp(f64::MIN_POSITIVE, NO_LIMIT)).collect();
            given.set_point_field(Field::scalars(GAP, sizes));
            rules.points.insert(GAP.to_owned(), Rule::Linear);
        }
        let mut refinement = MeshRefinement::new(&given, refine::Options::default(), threads)?;
        let wanted = Wanted { keeps_history: true, ..wanted.clone() };
        let reached = refinement.reach(&wanted, &rules, threads, |_| ())?;
        let history = reached
            .history
            .unwrap_or_else(|| History::identity(self.now.mesh.points.len(), self.now.mesh.cells.len()));
        let mut mesh = refinement.with_memory(threads);
        mesh.point_data.retain(|field| field.name != GAP);
        if mesh.cells == self.now.mesh.cells {
            return Ok(None);
        }
        let shape = self.now.tets.shape(&self.now.mesh.points, self.options.limit(), threads);
        let derived = Derived {
            given: &given,
            mesh,
            history: Arc::new(history),
            before: self.now.records.before.clone(),
        };
        self.take_over(derived, &shape, Counts::default(), threads).map(Some)
    }

    /// Continues with a mesh that was divided or coarsened in place. `shape` is that of the mesh before.
    pub(super) fn take_over(
        &mut self,
        derived: Derived<'_>,
        shape: &Shape,
        operations: Counts,
        threads: &Threads,
    ) -> Result<Change> {
        let history = derived.history.clone();
        let now = self.now.next(derived, Vec::new(), &self.wall, &self.options, threads)?;
        let counts = [&self.now, &now].map(|now| now.tets.len());
        let points_before = self.now.mesh.points.clone();
        let change = Change::new(self.clock.time, Why::Refinement, counts, shape, history, points_before);
        let change = Change { operations, ..change };
        self.now = now;
        self.clock.n_free = None;
        self.sizes.now = Arc::new(SizeMap::anew(&self.now, &self.options, threads));
        // The first mesh is no longer the one to restore.
        (self.returns.first, self.now.records.in_first) = (None, InFirst::default());
        self.remember(std::slice::from_ref(&change));
        Ok(change)
    }

    /// The gap at each vertex of the mesh as it is, infinite if there is none; `None` if nothing is watched.
    pub(super) fn gaps_here(&mut self, threads: &Threads) -> Result<Option<Vec<f64>>> {
        if self.watch.as_ref().is_some_and(Watch::is_stale) {
            self.measure_gaps(threads)?;
        }
        let n_points = self.now.mesh.points.len();
        Ok(self.gaps().map(|gaps| gaps.at_points(n_points)))
    }

    fn check(&self, time: f64, displacement: &[Point]) -> Result<()> {
        self.check_displacement(displacement)?;
        match time > self.clock.time && time.is_finite() {
            true => Ok(()),
            false => Err(Error::options(format!(
                "the time must advance: {time} is not after the current time {}",
                self.clock.time
            ))),
        }
    }

    fn check_displacement(&self, displacement: &[Point]) -> Result<()> {
        let n = self.wall.places.len();
        if displacement.len() != n {
            return Err(Error::input(format!(
                "got {} displacements for {n} driven vertices",
                displacement.len()
            ))
            .remedy("give one for each driven vertex of the first mesh, whatever the mesh has become"));
        }
        match displacement.iter().position(|&d| !in_range(d)) {
            None => Ok(()),
            Some(i) => Err(Error::input("a displacement is not finite").at(format!("driven vertex {i}"))),
        }
    }

    fn remember(&mut self, changes: &[Change]) {
        if changes.is_empty() {
            return;
        }
        if let Some(watch) = &mut self.watch {
            watch.forget();
        }
        self.changes.extend(changes.iter().map(|change| (self.clock.step, change.history.clone())));
        while self.changes.len() > self.options.remembered {
            self.forgotten = self.changes.pop_front().map(|(step, _)| step);
        }
    }

    fn measure_gaps(&mut self, threads: &Threads) -> Result<Option<super::Gaps>> {
        let Some(mut watch) = self.watch.take() else { return Ok(None) };
        let velocity = (self.clock.dt > 0.0).then(|| self.velocity());
        let ahead = velocity.as_ref().map(|velocity| (velocity.as_slice(), self.clock.dt));
        let gaps = watch.measure(&self.now.mesh, ahead, threads);
        self.watch = Some(watch);
        gaps.map(|gaps| Some(self.with_held(gaps)))
    }

    fn with_held(&self, gaps: super::Gaps) -> super::Gaps {
        let name = |wall: usize| self.options.watch.as_ref()?.patches.get(wall).cloned();
        let stopped = |at: &hold::Stopped| {
            Some(super::Stopped { patch: name(at.wall)?, short: at.short, place: at.place })
        };
        super::Gaps {
            held: self.held.n_nodes,
            farthest_held: self.held.farthest.as_ref().and_then(stopped),
            cramped: self.held.cramped.and_then(name),
            ..gaps
        }
    }

    fn certified(&self, shape: &Shape, threads: &Threads) -> Step {
        let Self { now, clock, .. } = self;
        let shape = now.tets.without_layers(shape, &now.mesh.points, self.options.limit());
        Step {
            step: clock.step,
            time: clock.time,
            points: now.mesh.points.len(),
            tets: now.tets.len(),
            bad: shape.bad.len(),
            forced: now.n_forced(&shape),
            inverted: shape.inverted,
            quality: now.tets.qualities(&now.mesh.points, threads),
            worst: shape.worst.map(|(cell, eas, place)| WorstTet { eas, cell, place }),
            ..Step::default()
        }
    }
}

/// Longer than any edge. Infinity cannot be interpolated with.
const NO_LIMIT: f64 = 1e100;

/// The point array that criteria of [`MovingMesh::refine`] find if patches are watched.
pub const GAP: &str = "moving:gap";

fn check_rows(field: &Field, n: usize, what: &str) -> Result<()> {
    match field.n_rows() == n && field.values.len() == n * field.components {
        true => Ok(()),
        false => Err(Error::input(format!("has {} rows for {n} {what}", field.n_rows()))
            .at(format!("array {}", field.name))),
    }
}
