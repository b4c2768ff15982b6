//! Assembly of the matrix of a mesh from those of its tets.

use crate::algebra::{Block, Sgs, SparseMatrix};
use crate::base::{Csr, Error, Result, VertexId};

/// The numbers of the unknowns: free vertices first, then those that are given.
#[derive(Debug)]
pub(crate) struct Numbering {
    number_of: Vec<u32>,
    n_free: usize,
    n_given: usize,
}

/// The number of what is neither free nor given.
const NONE: u32 = u32::MAX;

/// Tets whose vertices all have numbers.
pub(crate) struct NumberedTets {
    pub(crate) vertices: Vec<[VertexId; 4]>,
    pub(crate) numbers: Vec<[u32; 4]>,
}

impl Numbering {
    /// Numbers `n` vertices of a mesh, or nodes of a graph: those of `free` first, then those of `given`.
    pub(crate) fn new(
        n: usize,
        free: impl ExactSizeIterator<Item = usize>,
        given: impl ExactSizeIterator<Item = usize>,
    ) -> Self {
        let mut number_of = vec![NONE; n];
        let (n_free, n_given) = (free.len(), given.len());
        for (number, i) in (0..).zip(free.chain(given)) {
            number_of[i] = number;
        }
        Self { number_of, n_free, n_given }
    }

    pub(crate) fn n_free(&self) -> usize {
        self.n_free
    }

    /// The numbers of the corners of a tet; `None` where a corner is neither free nor given.
    pub(crate) fn of_tet(&self, corners: [usize; 4]) -> Option<[u32; 4]> {
        let numbers = corners.map(|i| self.number_of[i]);
        (!numbers.contains(&NONE)).then_some(numbers)
    }

    /// Those of `tets` whose corners all have numbers.
    pub(crate) fn of_tets(&self, tets: &[[VertexId; 4]]) -> NumberedTets {
        let numbered = |tet: &[VertexId; 4]| Some((*tet, self.of_tet(tet.map(VertexId::index))?));
        let (vertices, numbers) = tets.iter().filter_map(numbered).unzip();
        NumberedTets { vertices, numbers }
    }
}

/// The equations of the free vertices.
#[derive(Clone, Debug)]
pub(crate) struct System<B> {
    /// Their coupling with each other.
    pub(crate) inner: SparseMatrix<B>,
    /// Their coupling with the given vertices.
    pub(crate) coupling: SparseMatrix<B>,
    pub(crate) sweeps: Sgs<B>,
    /// For each tet, where its matrix goes, row after row. Searching for these places each time takes five
    /// times as long.
    places: Vec<[[u32; 4]; 4]>,
}

impl<B: Block> System<B> {
    /// A zero system with the pattern of tets that have these numbers.
    pub(crate) fn with_pattern(numbering: &Numbering, tets: &[[u32; 4]]) -> Self {
        let n_free = numbering.n_free as u32;
        let is_free = |number: u32| number < n_free;
        let uses = || {
            let uses = (0u32..).zip(tets).flat_map(|(t, tet)| tet.map(|number| (number, t)));
            uses.filter(|(number, _)| is_free(*number)).map(|(number, t)| (number as usize, t))
        };
        let tets_of = Csr::from_pairs(numbering.n_free, uses);
        let near = |row: usize| tets_of.list(row).iter().flat_map(|&t| tets[t as usize]);
        let rows = 0..numbering.n_free;
        let inner =
            SparseMatrix::with_pattern(rows.clone().map(|row| near(row).filter(|n| is_free(*n)).collect()));
        let coupling = SparseMatrix::with_pattern(
            rows.map(|row| near(row).filter(|n| !is_free(*n)).map(|n| n - n_free).collect()),
        );
        debug_assert!(numbering.n_given > 0);
        let places_of = |tet: &[u32; 4]| {
            tet.map(|row| {
                tet.map(|column| match (is_free(row), is_free(column)) {
                    (false, _) => NONE,
                    (true, true) => inner.place(row as usize, column) as u32,
                    (true, false) => coupling.place(row as usize, column - n_free) as u32,
                })
            })
        };
        let places = tets.iter().map(places_of).collect();
        Self { places, inner, coupling, sweeps: Sgs::default() }
    }

    /// Calls [`Self::with_pattern`], then [`Self::fill`].
    pub(crate) fn assemble(
        numbering: &Numbering,
        tets: &[[u32; 4]],
        of_tet: impl Fn(usize) -> [[B; 4]; 4],
    ) -> Result<Self> {
        let mut system = Self::with_pattern(numbering, tets);
        system.fill(tets, of_tet)?;
        Ok(system)
    }

    /// Sums the matrices of all tets into the system; `of_tet` returns the matrix of each.
    ///
    /// # Errors
    /// When a free vertex has no tet, or only flat ones.
    pub(crate) fn fill(&mut self, tets: &[[u32; 4]], of_tet: impl Fn(usize) -> [[B; 4]; 4]) -> Result<()> {
        let Self { inner, coupling, sweeps, places } = self;
        inner.clear();
        coupling.clear();
        let n_free = inner.n_rows() as u32;
        for (t, (tet, places)) in tets.iter().zip(places).enumerate() {
            let matrix = of_tet(t);
            let rows = tet.iter().zip(matrix).zip(places).filter(|((row, _), _)| **row < n_free);
            for ((_, blocks), places) in rows {
                for ((&column, block), &place) in tet.iter().zip(blocks).zip(&*places) {
                    let matrix = if column < n_free { &mut *inner } else { &mut *coupling };
                    matrix.add_at(place as usize, block);
                }
            }
        }
        *sweeps = Sgs::new(inner).map_err(|_| {
            Error::input("a vertex that should follow is a corner of no cell with a volume")
                .remedy("use the method `delaunay`, which needs no cells; or write the mesh with linear cells, none of them flat")
        })?;
        Ok(())
    }
}
