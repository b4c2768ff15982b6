//! Sparse matrices in compressed rows.

use crate::algebra::{Block, Vector3};
use crate::base::Threads;

/// A matrix of blocks, row after row, in each row those that are not zero by rising column.
#[derive(Clone, Debug, Default)]
pub struct SparseMatrix<B> {
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<B>,
}

impl<B: Block> SparseMatrix<B> {
    /// All zero, with room for these entries: for each row its columns, in any order, also more than once.
    pub fn with_pattern(rows: impl Iterator<Item = Vec<u32>>) -> Self {
        let (mut starts, mut columns) = (vec![0], Vec::new());
        for mut row in rows {
            row.sort_unstable();
            row.dedup();
            columns.extend(row);
            starts.push(columns.len());
        }
        Self { blocks: vec![B::ZERO; columns.len()], starts, columns }
    }

    /// Makes all entries zero; the pattern stays.
    pub fn clear(&mut self) {
        self.blocks.fill(B::ZERO);
    }

    /// How many rows there are.
    pub fn n_rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// How many blocks are kept.
    pub fn n_blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Adds to an entry that the pattern has.
    ///
    /// # Panics
    /// When it has not.
    pub fn add(&mut self, row: usize, column: u32, block: B) {
        self.add_at(self.place(row, column), block);
    }

    /// Where an entry is that the pattern has: for [`Self::add_at`].
    ///
    /// # Panics
    /// When it has not.
    pub fn place(&self, row: usize, column: u32) -> usize {
        let range = self.starts[row]..self.starts[row + 1];
        range.start + self.columns[range].binary_search(&column).expect("the pattern has the entry")
    }

    /// Adds to the entry at a [`Self::place`].
    #[inline(always)]
    pub fn add_at(&mut self, place: usize, block: B) {
        self.blocks[place] = self.blocks[place].plus(block);
    }

    /// The columns and blocks of a row.
    #[inline(always)]
    pub fn row(&self, row: usize) -> (&[u32], &[B]) {
        let range = self.starts[row]..self.starts[row + 1];
        (&self.columns[range.clone()], &self.blocks[range])
    }

    /// The block on the diagonal of a row; zero where there is none.
    pub fn diagonal(&self, row: usize) -> B {
        let (columns, blocks) = self.row(row);
        columns.binary_search(&(row as u32)).map_or(B::ZERO, |place| blocks[place])
    }

    /// The product of one row with `x`.
    #[inline(always)]
    pub fn row_times(&self, row: usize, x: &[Vector3]) -> Vector3 {
        let (columns, blocks) = self.row(row);
        let mut sum = [0.0; 3];
        for (&column, block) in columns.iter().zip(blocks) {
            block.add_times(x[column as usize], &mut sum);
        }
        sum
    }

    /// The product with `x`. The same bits with any number of threads.
    pub fn times(&self, x: &[Vector3], threads: &Threads) -> Vec<Vector3> {
        threads.map(self.n_rows(), |row| self.row_times(row, x))
    }
}
