//! Methods by which the interior vertices move as a linear system determines.
//!
//! They are slow compared to the graph, and what it is measured against: the methods that users know from
//! their solvers, implemented as well as possible. Linear elasticity, with cells that are stiffer the smaller
//! they are (Tezduyar 1992; Stein, Tezduyar, Benney 2003: "Jacobian-based stiffening"), and a Laplace
//! equation for each coordinate, with a diffusivity that falls with the distance from the wall (Jasak and
//! Tukovic 2006).

mod assemble;
mod element;
mod solver;

use std::sync::{Mutex, PoisonError};

use crate::algebra::{Block3, Solved, Tolerance};
use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::vector::add;
use crate::motion::options::{FacetSet, Method};
pub(crate) use crate::motion::solve::assemble::{Numbering, System};
pub(crate) use crate::motion::solve::element::{gradients, laplacian};
use crate::motion::solve::solver::Solver;
use crate::motion::update::Displacements;

/// A linear system for the displacements of the vertices that nothing else moves.
#[derive(Debug)]
pub(crate) struct LinearMethod {
    /// The vertices that are solved for.
    free: Vec<VertexId>,
    /// The vertices whose displacements are given.
    nodes: Vec<VertexId>,
    kind: Kind,
    tolerance: Tolerance,
    /// The last solution, from which the next one starts.
    last: Mutex<Vec<Point>>,
}

#[derive(Debug)]
enum Kind {
    Elastic(Solver<Block3>),
    Laplace(Solver<f64>),
}

impl LinearMethod {
    /// Sets up the system of a mesh whose cells have the corners `tets`, with its vertices at `points`. The
    /// displacements of `nodes` will be given; `wall` is where a Laplace equation is stiff.
    ///
    /// # Errors
    /// When a vertex of `free` is a corner of no cell, when all cells at one are flat, or when a factor
    /// cannot be computed.
    pub(crate) fn new(
        method: &Method,
        tets: &[[VertexId; 4]],
        points: &[Point],
        (free, nodes): (&[VertexId], &[VertexId]),
        wall: &FacetSet,
        threads: &Threads,
    ) -> Result<Self> {
        let numbering = Numbering::new(points.len(), free, nodes);
        let tets = numbering.of_tets(tets);
        let places: Vec<Point> = free.iter().map(|v| points[v.index()]).collect();
        let (kind, tolerance) = match method {
            Method::Elastic(law) => {
                let of_tet = element::elastic(law, &tets.vertices, points);
                let system = System::assemble(&numbering, &tets.numbers, of_tet)?;
                (Kind::Elastic(Solver::new(system, &places, law.factor_bytes, threads)?), law.tolerance)
            }
            Method::Laplace(law) => {
                let of_tet = element::laplace(law, &tets.vertices, points, wall, threads);
                let system = System::assemble(&numbering, &tets.numbers, of_tet)?;
                (Kind::Laplace(Solver::new(system, &places, law.factor_bytes, threads)?), law.tolerance)
            }
            _ => {
                return Err(Error::options("this method does not solve a linear system"));
            }
        };
        let last = Mutex::new(vec![[0.0; 3]; free.len()]);
        Ok(Self { free: free.to_vec(), nodes: nodes.to_vec(), kind, tolerance, last })
    }

    /// Bytes of the factor that is kept; 0 without one.
    pub(crate) fn factor_bytes(&self) -> u64 {
        match &self.kind {
            Kind::Elastic(solver) => solver.factor_bytes(),
            Kind::Laplace(solver) => solver.factor_bytes(),
        }
    }

    /// Moves all vertices from their positions `from`; those of no cell and no node stay.
    ///
    /// # Errors
    /// When the tolerance is not reached.
    pub(crate) fn apply(
        &self,
        from: &[Point],
        displacements: &Displacements<'_>,
        out: &mut [Point],
        threads: &Threads,
    ) -> Result<Solved> {
        let table = displacements.table();
        let given: Vec<Point> = table[..self.nodes.len()].iter().map(|d| d.point()).collect();
        let mut x = self.last.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let solved = match &self.kind {
            Kind::Elastic(solver) => solver.solve(&given, &mut x, self.tolerance, threads),
            Kind::Laplace(solver) => solver.solve(&given, &mut x, self.tolerance, threads),
        }?;
        out.copy_from_slice(from);
        for (v, d) in self.free.iter().zip(&x).chain(self.nodes.iter().zip(&given)) {
            out[v.index()] = add(from[v.index()], *d);
        }
        *self.last.lock().unwrap_or_else(PoisonError::into_inner) = x;
        Ok(solved)
    }
}
