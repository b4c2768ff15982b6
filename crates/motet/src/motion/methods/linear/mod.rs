//! Methods by which the interior vertices move as a linear system determines.
//!
//! They are slow compared to the graph, and what it is measured against: the methods that users know from
//! their solvers, implemented as well as possible.

mod elastic;
mod laplace;
mod solver;

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use crate::algebra::{Block, Tolerance};
use crate::base::{Point, Result, Threads, VertexId};
use crate::geometry::vector::add;
use crate::motion::elements::{NumberedTets, Numbering, System};
use crate::motion::methods::linear::solver::Solver;
use crate::motion::methods::{Follower, Prepared, Scene};
use crate::motion::setup::{Setup, SetupSeconds};
use crate::motion::update::Displacements;

pub(crate) use laplace::LaplaceEquation;

/// The vertices that are solved for, and the tets that couple them with each other and with the nodes.
struct Domain<'a> {
    scene: &'a Scene<'a>,
    free: Vec<VertexId>,
    staying: Vec<u32>,
    numbering: Numbering,
    tets: NumberedTets,
    /// The positions of the free vertices.
    places: Vec<Point>,
    begin: Instant,
}

impl<'a> Domain<'a> {
    fn new(scene: &'a Scene<'a>, points: &[Point]) -> Self {
        let begin = Instant::now();
        let (free, staying) = scene.used();
        let index = |v: &VertexId| v.index();
        let numbering =
            Numbering::new(points.len(), free.iter().map(index), scene.nodes.vertices.iter().map(index));
        let tets = numbering.of_tets(scene.corners);
        let places = free.iter().map(|v| points[v.index()]).collect();
        Self { scene, free, staying, numbering, tets, places, begin }
    }

    /// A follower by the system that `of_tet`, the matrices of the tets, gives; solved by a factor of at most
    /// `factor_bytes`, or iterated to the tolerance.
    ///
    /// # Errors
    /// When a free vertex is a corner of no cell, when all cells at one are flat, or when a factor cannot be
    /// computed.
    fn prepared<B: Block>(
        &self,
        of_tet: impl Fn(usize) -> [[B; 4]; 4],
        (tolerance, factor_bytes): (Tolerance, u64),
        threads: &Threads,
    ) -> Result<Prepared> {
        let system = System::assemble(&self.numbering, &self.tets.numbers, of_tet)?;
        let solver = Solver::new(system, &self.places, factor_bytes, threads)?;
        let factor_bytes = solver.factor_bytes();
        let follower = LinearFollower {
            last: Mutex::new(vec![[0.0; 3]; self.free.len()]),
            free: self.free.clone(),
            nodes: self.scene.nodes.vertices.clone(),
            solver,
            tolerance,
        };
        let seconds = SetupSeconds { system: self.begin.elapsed().as_secs_f64(), ..SetupSeconds::default() };
        Ok(Prepared {
            follower: Box::new(follower),
            staying: self.staying.clone(),
            graph_tets: Vec::new(),
            setup: Setup { solved: self.free.len(), factor_bytes, seconds, ..Setup::default() },
        })
    }
}

/// A linear system for the displacements of the vertices that nothing else moves.
#[derive(Debug)]
struct LinearFollower<B> {
    /// The vertices that are solved for.
    free: Vec<VertexId>,
    /// The vertices whose displacements are given.
    nodes: Vec<VertexId>,
    solver: Solver<B>,
    tolerance: Tolerance,
    /// The last solution, from which the next one starts.
    last: Mutex<Vec<Point>>,
}

impl<B: Block> Follower for LinearFollower<B> {
    fn follow(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<usize> {
        let table = displacements.table();
        let given: Vec<Point> = table[..self.nodes.len()].iter().map(|d| d.point()).collect();
        let mut x = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let solved = self.solver.solve(&given, &mut x, self.tolerance, threads)?;
        out.copy_from_slice(from);
        for (v, d) in self.free.iter().zip(&x).chain(self.nodes.iter().zip(&given)) {
            out[v.index()] = add(from[v.index()], *d);
        }
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = x;
        Ok(solved.iterations)
    }
}
