//! Sub-stepping: moving the mesh towards the requested displacement, as far as no cell is inverted.
//!
//! A motion that one step from the reference can do is done in one step, and depends on nothing else. Where
//! that would invert a cell, the mesh goes on from where the last call left it: as far as is admissible,
//! found by bisection. There the graph is rebuilt and every vertex is located in it anew (those of sliding
//! patches in the graph of their plane), and so on, until the boundary is where it should be or a sub-step
//! makes no progress. In between, the boundary moves along straight lines; the caller should therefore divide
//! the motion of a wall that rotates into steps.

use std::time::Instant;

use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::vector::{add, scale, sub};
use crate::motion::certificate::{Certificate, Seconds, measure};
use crate::motion::check::Check;
use crate::motion::methods::Follower;
use crate::motion::mover::{Mover, State, Work};
use crate::motion::nodes::SubstepStart;
use crate::motion::update::{Displacements, Padded};

/// Bisections in the search for the admissible part of the way, which is found to 1/4096.
const HALVINGS: usize = 12;

impl Mover {
    /// Moves the mesh by `displacement`, in sub-steps where necessary, and certifies the result.
    ///
    /// `displacement` holds one vector, counted from the reference, for each vertex of [`Self::boundary`];
    /// `out` receives the position of every vertex.
    ///
    /// No cell that was upright in the reference is inverted or flat in `out`, except where a call could not
    /// move at all from a start that has such cells.
    ///
    /// # Errors
    /// The errors of [`Self::step`]; the next call then begins where this one began. A motion that cannot be
    /// completed is no error: see [`Certificate::complete`].
    pub fn advance(
        &mut self,
        displacement: &[Point],
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<Certificate> {
        let begin = Instant::now();
        let mut seconds = Seconds::default();
        self.check_lengths(displacement, out)?;
        let work = timed(&mut seconds.update, || self.displace(displacement, out, threads))?;
        let inverted = timed(&mut seconds.check, || self.check.newly_inverted(out, threads));
        let mut certificate = Certificate {
            complete: true,
            fraction: 1.0,
            admissible_fraction: 1.0,
            iterations: work.iterations,
            smoothed: work.smoothed,
            ..Default::default()
        };
        if inverted.is_empty() {
            self.state = Some(State { points: out.to_vec(), driven: displacement.to_vec() });
        } else {
            certificate.blocked_by = inverted;
            certificate.blocked_by.truncate(10);
            let before = self.state.clone();
            let result = self.advance_in_substeps(displacement, out, threads, &mut certificate, &mut seconds);
            if result.is_err() {
                self.state = before;
            }
            result?;
        }
        let driven = self.state.as_ref().map_or(displacement, |state| &state.driven);
        certificate.leaves_plane = self.leaves_plane(driven);
        self.certify(out, &mut certificate, threads, &mut seconds);
        seconds.total = begin.elapsed().as_secs_f64();
        certificate.seconds = seconds;
        Ok(certificate)
    }

    /// Forgets where [`Self::advance`] left the mesh: the next call begins at the reference.
    pub fn restart(&mut self) {
        self.state = None;
    }

    /// The certificate of the mesh with its vertices at `points`.
    ///
    /// # Panics
    /// When there are fewer points than the mesh has.
    pub fn quality(&self, points: &[Point], threads: &Threads) -> Certificate {
        let mut certificate =
            Certificate { complete: true, fraction: 1.0, admissible_fraction: 1.0, ..Default::default() };
        let mut seconds = Seconds::default();
        self.certify(points, &mut certificate, threads, &mut seconds);
        certificate.seconds = Seconds { total: seconds.quality + seconds.check, ..seconds };
        certificate
    }

    fn certify(
        &self,
        points: &[Point],
        certificate: &mut Certificate,
        threads: &Threads,
        seconds: &mut Seconds,
    ) {
        let [now, before] = timed(&mut seconds.check, || self.check.count(points, threads));
        certificate.inverted = now;
        certificate.inverted_before = before;
        certificate.quality = timed(&mut seconds.quality, || measure(&self.check, points, threads));
        let place = |v: VertexId| points[v.index()];
        let tets = self.graph_tets.iter();
        certificate.graph_tets_inverted =
            tets.filter(|t| crate::geometry::tet::volume_6(t.map(place)) <= 0.0).count();
    }

    /// The largest fraction of the displacement that a step from the reference can do.
    fn admissible_in_one_step(
        &self,
        target: &[Point],
        out: &mut [Point],
        threads: &Threads,
        iterations: &mut usize,
        seconds: &mut Seconds,
    ) -> Result<f64> {
        largest_fraction(|fraction| {
            let part: Vec<Point> = target.iter().map(|&d| scale(d, fraction)).collect();
            *iterations += timed(&mut seconds.update, || self.displace(&part, out, threads))?.iterations;
            Ok(timed(&mut seconds.check, || self.check.stays_upright(out, &self.reference, 0.0, threads)))
        })
    }

    fn advance_in_substeps(
        &mut self,
        target: &[Point],
        out: &mut [Point],
        threads: &Threads,
        certificate: &mut Certificate,
        seconds: &mut Seconds,
    ) -> Result<()> {
        certificate.admissible_fraction =
            self.admissible_in_one_step(target, out, threads, &mut certificate.iterations, seconds)?;
        let from_reference = self.state.is_none();
        self.run_substeps(target, out, threads, certificate, seconds)?;
        if from_reference && certificate.fraction < certificate.admissible_fraction {
            certificate.fraction = certificate.admissible_fraction;
            let work = self.step_by_fraction(target, certificate.fraction, out, threads)?;
            certificate.iterations += work.iterations;
            certificate.smoothed = work.smoothed;
        }
        Ok(())
    }

    fn run_substeps(
        &mut self,
        target: &[Point],
        out: &mut [Point],
        threads: &Threads,
        certificate: &mut Certificate,
        seconds: &mut Seconds,
    ) -> Result<()> {
        let mut state = self.state.take().unwrap_or_else(|| State {
            points: self.reference.clone(),
            driven: vec![[0.0; 3]; target.len()],
        });
        let mut left = 1.0;
        certificate.complete = false;
        while certificate.substeps < self.limits.substeps {
            threads.watch().report_and_check(
                "moving in sub-steps",
                certificate.substeps,
                self.limits.substeps,
            )?;
            let mut path = timed(&mut seconds.graph, || SubstepPath::new(self, &state, target, threads))?;
            let mut part = path.longest_admissible(self.limits.keep_volume, out, threads, seconds)?;
            if part * left < self.limits.smallest {
                part = path.longest_admissible(0.0, out, threads, seconds)?;
            }
            certificate.smoothed = path.place(part, out, threads)?;
            certificate.iterations += path.iterations;
            certificate.substeps += 1;
            left *= 1.0 - part;
            state.driven = path.driven(part);
            state.points.copy_from_slice(out);
            certificate.complete = left == 0.0;
            if certificate.complete || part * (left / (1.0 - part)) < self.limits.smallest {
                break;
            }
        }
        certificate.fraction = 1.0 - left;
        out.copy_from_slice(&state.points);
        self.state = Some(state);
        Ok(())
    }

    /// Moves by the admissible fraction of the displacement, in one step from the reference.
    fn step_by_fraction(
        &mut self,
        target: &[Point],
        fraction: f64,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<Work> {
        let driven: Vec<Point> = target.iter().map(|&d| scale(d, fraction)).collect();
        let work = self.displace(&driven, out, threads)?;
        self.state = Some(State { points: out.to_vec(), driven });
        Ok(work)
    }
}

/// The way from one state to the target, with the follower set up at that state.
struct SubstepPath<'a> {
    mover: &'a Mover,
    state: &'a State,
    target: &'a [Point],
    follower: Box<dyn Follower>,
    start: SubstepStart,
    iterations: usize,
}

impl<'a> SubstepPath<'a> {
    fn new(mover: &'a Mover, state: &'a State, target: &'a [Point], threads: &Threads) -> Result<Self> {
        let follower = mover.follower_at(&state.points, threads)?;
        let start = mover.nodes.start(&mover.reference, &state.points, &state.driven, threads)?;
        Ok(Self { mover, state, target, follower, start, iterations: 0 })
    }

    /// Displacements of the driven vertices after `part` of the way.
    fn driven(&self, part: f64) -> Vec<Point> {
        if part == 1.0 {
            return self.target.to_vec();
        }
        let between = |(&from, &to): (&Point, &Point)| add(from, scale(sub(to, from), part));
        self.state.driven.iter().zip(self.target).map(between).collect()
    }

    fn place(&mut self, part: f64, out: &mut [Point], threads: &Threads) -> Result<usize> {
        let nodes = &self.mover.nodes;
        let target = self.driven(part);
        let to = nodes.displacements_from(&self.start, &target, threads);
        let from = self.start.displacement.iter();
        let change = to.iter().zip(from).map(|(to, from)| Padded::new(sub(to.point(), from.point())));
        let change = Displacements::All(change.collect());
        self.iterations += self.follower.follow(&self.state.points, &change, out, threads)?;
        nodes.place(&self.mover.reference, &to, out);
        Ok(self.mover.finish(out, threads))
    }

    /// The largest part of the way on which every cell stays upright: the whole way where possible, otherwise
    /// no farther than where each cell keeps `share` of its volume.
    fn longest_admissible(
        &mut self,
        share: f64,
        out: &mut [Point],
        threads: &Threads,
        seconds: &mut Seconds,
    ) -> Result<f64> {
        let (check, state): (&Check, _) = (&self.mover.check, self.state);
        largest_fraction(|part| {
            timed(&mut seconds.update, || self.place(part, out, threads).map(|_| ()))?;
            let share = if part == 1.0 { 0.0 } else { share };
            Ok(timed(&mut seconds.check, || check.stays_upright(out, &state.points, share, threads)))
        })
    }
}

/// The largest part of 1 for which `holds` is true, to within 2^-[`HALVINGS`], provided that it holds up to
/// some part and not beyond; 0 where it never does.
///
/// # Errors
/// The errors of `holds`.
fn largest_fraction(mut holds: impl FnMut(f64) -> Result<bool>) -> Result<f64> {
    if holds(1.0)? {
        return Ok(1.0);
    }
    let (mut good, mut bad) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (good + bad);
        if holds(middle)? {
            good = middle;
        } else {
            bad = middle;
        }
    }
    Ok(good)
}

/// Runs `work` and adds the time that it takes to `seconds`.
fn timed<T>(seconds: &mut f64, work: impl FnOnce() -> T) -> T {
    let begin = Instant::now();
    let result = work();
    *seconds += begin.elapsed().as_secs_f64();
    result
}
