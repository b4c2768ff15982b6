//! Points that the graph within walls added: they move by linear elements on the graph for a Laplace
//! equation, so that an affine motion of the boundary still moves every vertex by the same affine map.

use crate::algebra::{Tolerance, conjugate_gradients};
use crate::base::{Point, Result, Threads};
use crate::motion::elements::{Numbering, System, gradients, laplacian};
use crate::motion::graph::Graph;
use crate::motion::update::{Displacements, Padded};

/// Points that the graph added: they follow the others.
#[derive(Debug)]
pub(super) struct AddedPoints {
    /// For each given node of the graph, its index among all nodes.
    given: Vec<u32>,
    n: usize,
    system: System<f64>,
}

/// A tolerance far below what affects cells.
const STEP_TOLERANCE: Tolerance = Tolerance { residual: 1e-12, iterations: 10_000 };

impl AddedPoints {
    /// Sets up the added points of a graph; `None` where all its nodes are given.
    ///
    /// # Errors
    /// When an added point has only flat tets.
    pub(super) fn new(graph: &Graph, given: &[u32]) -> Result<Option<Self>> {
        let n = graph.places.len() - given.len();
        if n == 0 {
            return Ok(None);
        }
        let all = graph.places.len();
        let numbering = Numbering::new(all, given.len()..all, 0..given.len());
        let numbers = |tet: &[u32; 4]| numbering.of_tet(tet.map(|node| node as usize));
        let numbers: Vec<[u32; 4]> = graph.tets.iter().filter_map(numbers).collect();
        let system = System::assemble(&numbering, &numbers, |t| {
            let found = gradients(graph.tets[t].map(|node| graph.places[node as usize]));
            found.map_or([[0.0; 4]; 4], |(g, volume)| laplacian(&g, volume))
        })?;
        Ok(Some(Self { given: given.to_vec(), n, system }))
    }

    pub(super) fn len(&self) -> usize {
        self.n
    }

    /// Displacements of all nodes, followed by those of the added points; and the number of iterations.
    ///
    /// # Errors
    /// When the system cannot be solved to the tolerance.
    pub(super) fn with_added(
        &self,
        displacements: &Displacements<'_>,
        threads: &Threads,
    ) -> Result<(Displacements<'static>, usize)> {
        let table = displacements.table();
        let given: Vec<Point> = self.given.iter().map(|&n| table[n as usize].point()).collect();
        let mut right = self.system.coupling.times(&given, threads);
        right.iter_mut().for_each(|f| *f = f.map(|x| -x));
        let mut added = vec![[0.0; 3]; self.n];
        let System { inner, sweeps, .. } = &self.system;
        let solved = conjugate_gradients(inner, sweeps, &right, &mut added, STEP_TOLERANCE, threads)?;
        let (nodes, never) = table.split_at(table.len() - 1);
        let all =
            nodes.iter().copied().chain(added.into_iter().map(Padded::new)).chain(never.iter().copied());
        Ok((Displacements::All(all.collect()), solved.iterations))
    }
}
