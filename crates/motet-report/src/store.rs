//! The packed tables of a page; equal ones are stored once.

use std::collections::{BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};

use crate::codec::Block;

/// Index of a block in a [`Store`].
pub(crate) type BlockId = usize;

/// All packed blocks; those that no frame of the page uses are not written.
#[derive(Debug, Default)]
pub(crate) struct Store {
    blocks: Vec<Block>,
    by_hash: HashMap<u64, Vec<BlockId>>,
}

impl Store {
    /// Adds a block and returns its id, that of an equal block where there is one.
    pub(crate) fn put(&mut self, block: Block) -> BlockId {
        let mut hasher = DefaultHasher::new();
        (block.rows, block.columns, &block.data).hash(&mut hasher);
        let alike = self.by_hash.entry(hasher.finish()).or_default();
        if let Some(&id) = alike.iter().find(|&&id| self.blocks[id] == block) {
            return id;
        }
        alike.push(self.blocks.len());
        self.blocks.push(block);
        self.blocks.len() - 1
    }

    pub(crate) fn get(&self, id: BlockId) -> &Block {
        &self.blocks[id]
    }

    /// The size on the page of these blocks, except those in `paid`.
    pub(crate) fn cost(&self, ids: &[BlockId], paid: &BTreeSet<BlockId>) -> usize {
        let new: BTreeSet<BlockId> = ids.iter().copied().filter(|id| !paid.contains(id)).collect();
        new.iter().map(|&id| self.blocks[id].cost()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::codec::Kind;

    #[test]
    fn what_is_the_same_is_kept_and_paid_once() {
        let mut store = Store::default();
        let a = store.put(Block::column(Kind::Plain, &[1, 2, 3]));
        let b = store.put(Block::column(Kind::Plain, &[1, 2, 4]));
        assert_eq!(store.put(Block::column(Kind::Plain, &[1, 2, 3])), a);
        assert_ne!(a, b);
        let paid = BTreeSet::from([a]);
        assert_eq!(store.cost(&[a, b, b], &paid), store.get(b).cost());
    }
}
