//! Sparse matrices in compressed rows.

use crate::algebra::{Block, Vector3};
use crate::base::Threads;

/// A sparse matrix of blocks in compressed rows; the entries of a row are in order of rising column.
#[derive(Clone, Debug, Default)]
pub struct SparseMatrix<B> {
    starts: Vec<usize>,
    columns: Vec<u32>,
    blocks: Vec<B>,
}

impl<B: Block> SparseMatrix<B> {
    /// A zero matrix with the given pattern: for each row its columns, in any order, repeats allowed.
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

    /// How many blocks are stored.
    pub fn n_blocks(&self) -> usize {
        self.blocks.len()
    }

    /// Adds `block` to an entry of the pattern.
    ///
    /// # Panics
    /// When the pattern does not have the entry.
    pub fn add(&mut self, row: usize, column: u32, block: B) {
        self.add_at(self.place(row, column), block);
    }

    /// The index of an entry of the pattern, for [`Self::add_at`].
    ///
    /// # Panics
    /// When the pattern does not have the entry.
    pub fn place(&self, row: usize, column: u32) -> usize {
        let range = self.starts[row]..self.starts[row + 1];
        range.start + self.columns[range].binary_search(&column).expect("the pattern has the entry")
    }

    /// Adds `block` to the entry at an index from [`Self::place`].
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

    /// The product `self other`, row by row (Gustavson 1978).
    pub fn product(&self, other: &Self) -> Self {
        const UNMARKED: usize = usize::MAX;
        let width = other.columns.iter().map(|&c| c as usize + 1).max().unwrap_or(0);
        let mut place_of = vec![UNMARKED; width];
        let (mut starts, mut columns, mut blocks) = (vec![0], Vec::new(), Vec::new());
        let mut row_of: Vec<(u32, B)> = Vec::new();
        for row in 0..self.n_rows() {
            let (middle, first) = self.row(row);
            for (&m, block) in middle.iter().zip(first) {
                let (ends, second) = other.row(m as usize);
                for (&column, other) in ends.iter().zip(second) {
                    let term = block.times_block(*other);
                    let place = &mut place_of[column as usize];
                    if *place == UNMARKED {
                        *place = row_of.len();
                        row_of.push((column, term));
                    } else {
                        row_of[*place].1 = row_of[*place].1.plus(term);
                    }
                }
            }
            row_of.sort_unstable_by_key(|(column, _)| *column);
            for (column, block) in row_of.drain(..) {
                place_of[column as usize] = UNMARKED;
                columns.push(column);
                blocks.push(block);
            }
            starts.push(columns.len());
        }
        Self { starts, columns, blocks }
    }

    /// The transpose; `n_columns`, its number of rows, is greater than every column index.
    pub fn transposed(&self, n_columns: usize) -> Self {
        let mut starts = vec![0; n_columns + 1];
        self.columns.iter().for_each(|&c| starts[c as usize + 1] += 1);
        (0..n_columns).for_each(|c| starts[c + 1] += starts[c]);
        let mut next = starts.clone();
        let (mut columns, mut blocks) = (vec![0; self.columns.len()], vec![B::ZERO; self.blocks.len()]);
        for row in 0..self.n_rows() {
            let (here, values) = self.row(row);
            for (&column, block) in here.iter().zip(values) {
                let place = &mut next[column as usize];
                columns[*place] = row as u32;
                blocks[*place] = block.transposed();
                *place += 1;
            }
        }
        Self { starts, columns, blocks }
    }

    /// Replaces each block by `change(row, block)`.
    pub fn change_rows(&mut self, change: impl Fn(usize, B) -> B) {
        for row in 0..self.n_rows() {
            let range = self.starts[row]..self.starts[row + 1];
            self.blocks[range].iter_mut().for_each(|block| *block = change(row, *block));
        }
    }

    /// The product with `x`, the same to the bit with any number of threads.
    pub fn times(&self, x: &[Vector3], threads: &Threads) -> Vec<Vector3> {
        threads.map(self.n_rows(), |row| self.row_times(row, x))
    }
}
