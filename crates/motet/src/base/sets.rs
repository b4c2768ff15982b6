//! Disjoint sets of numbers.

use crate::base::VertexId;

/// Disjoint sets of the numbers below `n` (union-find, Tarjan 1975), each represented by its smallest member.
pub(crate) struct DisjointSets {
    parents: Vec<u32>,
}

impl DisjointSets {
    pub(crate) fn new(n: usize) -> Self {
        Self { parents: (0..n as u32).collect() }
    }

    pub(crate) fn root(&mut self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            let above = self.parents[self.parents[i as usize] as usize];
            self.parents[i as usize] = above;
            i = above;
        }
        i
    }

    /// The root of each number.
    pub(crate) fn roots(mut self) -> Vec<u32> {
        (0..self.parents.len() as u32).map(|i| self.root(i)).collect()
    }

    /// Joins the vertices of each list, such as those of a facet, into one set.
    pub(crate) fn join_all<'a>(&mut self, lists: impl IntoIterator<Item = &'a [VertexId]>) {
        for list in lists {
            list.windows(2).for_each(|pair| self.join(pair[0].0, pair[1].0));
        }
    }

    pub(crate) fn join(&mut self, i: u32, j: u32) {
        let (i, j) = (self.root(i), self.root(j));
        self.parents[i.max(j) as usize] = i.min(j);
    }
}
