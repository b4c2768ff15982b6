//! From the matrices of tets to that of the mesh.

use crate::algebra::{Block, Sgs, SparseMatrix};
use crate::base::{Csr, Error, Result, VertexId};

/// The unknowns: free vertices first, then those that are given.
#[derive(Debug)]
pub(super) struct Numbering {
    of_vertex: Vec<u32>,
    n_free: usize,
    n_given: usize,
}

/// A vertex that is neither.
const NONE: u32 = u32::MAX;

/// Tets all of whose vertices have numbers.
pub(super) struct NumberedTets {
    pub(super) vertices: Vec<[VertexId; 4]>,
    pub(super) numbers: Vec<[u32; 4]>,
}

impl Numbering {
    pub(super) fn new(n_points: usize, free: &[VertexId], given: &[VertexId]) -> Self {
        let mut of_vertex = vec![NONE; n_points];
        for (number, v) in (0..).zip(free.iter().chain(given)) {
            of_vertex[v.index()] = number;
        }
        Self { of_vertex, n_free: free.len(), n_given: given.len() }
    }

    pub(super) fn of_tets(&self, tets: &[[VertexId; 4]]) -> NumberedTets {
        let numbered = tets.iter().map(|tet| (*tet, tet.map(|v| self.of_vertex[v.index()])));
        let (vertices, numbers) = numbered.filter(|(_, numbers)| !numbers.contains(&NONE)).unzip();
        NumberedTets { vertices, numbers }
    }
}

/// The equations of the free vertices.
#[derive(Debug)]
pub(super) struct System<B> {
    /// What they have to do with each other.
    pub(super) inner: SparseMatrix<B>,
    /// And with those that are given.
    pub(super) coupling: SparseMatrix<B>,
    pub(super) sweeps: Sgs<B>,
}

impl<B: Block> System<B> {
    /// `of_tet` gives the matrix of each tet.
    ///
    /// # Errors
    /// When a free vertex has no tet, or only flat ones.
    pub(super) fn assemble(
        numbering: &Numbering,
        tets: &[[u32; 4]],
        of_tet: impl Fn(usize) -> [[B; 4]; 4],
    ) -> Result<Self> {
        let n_free = numbering.n_free as u32;
        let is_free = |number: u32| number < n_free;
        let uses = || {
            let uses = (0u32..).zip(tets).flat_map(|(t, tet)| tet.map(|number| (number, t)));
            uses.filter(|(number, _)| is_free(*number)).map(|(number, t)| (number as usize, t))
        };
        let tets_of = Csr::from_pairs(numbering.n_free, uses);
        let near = |row: usize| tets_of.list(row).iter().flat_map(|&t| tets[t as usize]);
        let rows = 0..numbering.n_free;
        let mut inner =
            SparseMatrix::with_pattern(rows.clone().map(|row| near(row).filter(|n| is_free(*n)).collect()));
        let mut coupling = SparseMatrix::with_pattern(
            rows.map(|row| near(row).filter(|n| !is_free(*n)).map(|n| n - n_free).collect()),
        );
        debug_assert!(numbering.n_given > 0);
        for (t, tet) in tets.iter().enumerate() {
            let matrix = of_tet(t);
            for (row, blocks) in tet.iter().zip(matrix).filter(|(row, _)| is_free(**row)) {
                for (&column, block) in tet.iter().zip(blocks) {
                    match is_free(column) {
                        true => inner.add(*row as usize, column, block),
                        false => coupling.add(*row as usize, column - n_free, block),
                    }
                }
            }
        }
        let sweeps = Sgs::new(&inner).map_err(|_| {
            Error::input("a vertex that is to follow has no cell with a volume at its corner")
                .remedy("use the method `delaunay`, which needs no cells; or write the mesh with linear cells, none of them flat")
        })?;
        Ok(Self { inner, coupling, sweeps })
    }
}
