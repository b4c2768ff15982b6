//! Finds the new tet at a directed edge of the cavity's surface: in a small matrix, or in a hash table.

/// A map from directed edges (pairs of local vertex numbers) to the facet of a new tet on their left. An
/// entry is read only after it was written for the same cavity, so nothing needs clearing in between.
pub(super) trait EdgeMap {
    fn put(&mut self, from: u32, to: u32, link: u32);
    fn get(&self, from: u32, to: u32) -> u32;
}

/// The most vertices a cavity may have to use the matrix. Fewer than 7 in 10,000 cavities of ordinary points
/// have more; this many rows of the matrix (16 kB) still fit into the first-level cache.
pub(super) const MAX_MATRIX_VERTICES: usize = 64;

/// A matrix over all pairs of up to [`MAX_MATRIX_VERTICES`] vertices.
#[derive(Debug)]
pub(super) struct EdgeMatrix(Box<[u32; MAX_MATRIX_VERTICES * MAX_MATRIX_VERTICES]>);

impl Default for EdgeMatrix {
    fn default() -> Self {
        Self(Box::new([0; MAX_MATRIX_VERTICES * MAX_MATRIX_VERTICES]))
    }
}

impl EdgeMap for EdgeMatrix {
    #[inline(always)]
    fn put(&mut self, from: u32, to: u32, link: u32) {
        self.0[(from as usize * MAX_MATRIX_VERTICES + to as usize)
            % (MAX_MATRIX_VERTICES * MAX_MATRIX_VERTICES)] = link;
    }

    #[inline(always)]
    fn get(&self, from: u32, to: u32) -> u32 {
        self.0[(from as usize * MAX_MATRIX_VERTICES + to as usize)
            % (MAX_MATRIX_VERTICES * MAX_MATRIX_VERTICES)]
    }
}

/// A hash table for any number of vertices, in memory linear in the number of edges: points on two skew lines
/// make cavities with as many vertices as there are points, where a matrix would be quadratic.
#[derive(Debug, Default)]
pub(super) struct EdgeTable {
    slots: Vec<(u32, u32, u32)>,
}

const EMPTY: (u32, u32, u32) = (u32::MAX, u32::MAX, 0);

impl EdgeTable {
    /// Empties the table and reserves space for `n` edges.
    pub(super) fn clear(&mut self, n: usize) {
        self.slots.clear();
        self.slots.resize((2 * n).next_power_of_two(), EMPTY);
    }

    /// The place of the edge, or the empty place where it belongs.
    fn find(&self, from: u32, to: u32) -> usize {
        let mask = self.slots.len() - 1;
        let key = u64::from(from) << 32 | u64::from(to);
        let mut place = (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 32) as usize & mask;
        while self.slots[place].0 != u32::MAX && (self.slots[place].0, self.slots[place].1) != (from, to) {
            place = (place + 1) & mask;
        }
        place
    }
}

impl EdgeMap for EdgeTable {
    fn put(&mut self, from: u32, to: u32, link: u32) {
        let place = self.find(from, to);
        self.slots[place] = (from, to, link);
    }

    fn get(&self, from: u32, to: u32) -> u32 {
        self.slots[self.find(from, to)].2
    }
}
