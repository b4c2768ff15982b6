//! A linear system and the way it is solved.

use crate::algebra::{Block, Cholesky, Solved, Tolerance, TwoLevel, conjugate_gradients};
use crate::base::{Point, Result, Threads};
use crate::motion::elements::System;

/// From this many unknown vertices on, two levels are worth setting up: a step takes two thirds of the time
/// or less on meshes of 32,000 vertices and more, and a third on one of 158,000.
const TWO_LEVELS_FROM: usize = 5_000;

/// A system ready for right-hand sides.
#[derive(Debug)]
pub(super) struct Solver<B> {
    system: System<B>,
    kind: SolverKind<B>,
}

#[derive(Debug)]
enum SolverKind<B> {
    Factor(Box<Cholesky>),
    TwoLevels(Box<TwoLevel<B>>),
    Sweeps,
}

impl<B: Block> Solver<B> {
    /// Uses a factor where it takes no more than `factor_bytes`; `places` are the positions of the unknown
    /// vertices.
    pub(super) fn new(
        system: System<B>,
        places: &[Point],
        factor_bytes: u64,
        threads: &Threads,
    ) -> Result<Self> {
        let factor = match factor_bytes {
            0 => None,
            max_bytes => Cholesky::new(&system.inner, places, max_bytes)?,
        };
        let kind = match factor {
            Some(factor) => SolverKind::Factor(Box::new(factor)),
            None if places.len() < TWO_LEVELS_FROM => SolverKind::Sweeps,
            None => match TwoLevel::new(&system.inner, places, threads)? {
                Some(levels) => SolverKind::TwoLevels(Box::new(levels)),
                None => SolverKind::Sweeps,
            },
        };
        Ok(Self { system, kind })
    }

    /// Computes the displacements `x` of the unknown vertices from the given ones; `x` holds a guess on
    /// entry.
    pub(super) fn solve(
        &self,
        given: &[Point],
        x: &mut Vec<Point>,
        tolerance: Tolerance,
        threads: &Threads,
    ) -> Result<Solved> {
        let System { inner, coupling, sweeps, .. } = &self.system;
        let right: Vec<Point> = coupling.times(given, threads).into_iter().map(|f| f.map(|x| -x)).collect();
        match &self.kind {
            SolverKind::Factor(factor) => {
                *x = factor.solve(&right);
                Ok(Solved::default())
            }
            SolverKind::TwoLevels(levels) => {
                conjugate_gradients(inner, &**levels, &right, x, tolerance, threads)
            }
            SolverKind::Sweeps => conjugate_gradients(inner, sweeps, &right, x, tolerance, threads),
        }
    }

    /// Bytes of the factor; 0 without one.
    pub(super) fn factor_bytes(&self) -> u64 {
        if let SolverKind::Factor(factor) = &self.kind { factor.n_bytes() } else { 0 }
    }
}
