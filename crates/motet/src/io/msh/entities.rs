//! Geometrical entities of version 4, and the labels of their elements.

use std::collections::HashMap;

use super::source::Source;
use crate::base::Result;
use crate::io::Notes;

/// Dimension and number of a geometrical entity.
type Key = (i32, i32);

/// The labels that a geometrical entity gives to its elements.
#[derive(Clone, Copy, Default)]
pub(super) struct EntityLabels {
    pub(super) physical: i32,
    /// The entity that this one is a part of, or itself.
    pub(super) geometrical: i32,
    pub(super) partition: i32,
}

/// All entities of a file.
#[derive(Default)]
pub(super) struct Entities(HashMap<Key, EntityLabels>);

impl Entities {
    /// The labels of the entity with this dimension and number.
    pub(super) fn get(&self, dim: i32, tag: i32) -> EntityLabels {
        let unnamed = EntityLabels { geometrical: tag, ..EntityLabels::default() };
        self.0.get(&(dim, tag)).copied().unwrap_or(unnamed)
    }

    /// Reads `$Entities`.
    pub(super) fn read(&mut self, source: &mut Source<'_>, notes: &Notes) -> Result<()> {
        let counts = entity_counts(source)?;
        for (dim, n) in (0..).zip(counts) {
            for _ in 0..n {
                let tag = source.int("entity number")?;
                let entity = EntityLabels { geometrical: tag, ..EntityLabels::default() };
                self.read_body(source, (dim, tag), entity, notes)?;
            }
        }
        Ok(())
    }

    /// Reads `$PartitionedEntities`.
    pub(super) fn read_partitioned(&mut self, source: &mut Source<'_>, notes: &Notes) -> Result<()> {
        source.size("the number of partitions")?;
        for _ in 0..source.count("ghost entities", 2)? {
            source.int("ghost entity number")?;
            source.int("partition of a ghost entity")?;
            notes.add("ghost entities are skipped: a mesh cannot hold them");
        }
        let counts = entity_counts(source)?;
        for (dim, n) in (0..).zip(counts) {
            for _ in 0..n {
                let tag = source.int("partitioned entity number")?;
                let parent_dim = source.int("dimension of the parent entity")?;
                let parent = source.int("parent entity number")?;
                let mut partition = 0;
                for i in 0..source.count("partitions of an entity", 1)? {
                    let number = source.int("partition number")?;
                    partition = if i == 0 { number } else { partition };
                }
                let geometrical = if parent_dim == dim { parent } else { tag };
                let entity = EntityLabels { geometrical, partition, physical: 0 };
                self.read_body(source, (dim, tag), entity, notes)?;
            }
        }
        Ok(())
    }

    /// Reads the bounding box, the physical groups and the boundary of an entity.
    fn read_body(
        &mut self,
        source: &mut Source<'_>,
        key: Key,
        mut entity: EntityLabels,
        notes: &Notes,
    ) -> Result<()> {
        for _ in 0..if key.0 == 0 { 3 } else { 6 } {
            source.double("bounding box of an entity")?;
        }
        let n_physical = source.count("physical groups of an entity", 1)?;
        for i in 0..n_physical {
            // The sign states whether the group reverses the entity; its elements are stored reversed
            // already.
            let tag = source.int("physical group number")?.saturating_abs();
            entity.physical = if i == 0 { tag } else { entity.physical };
        }
        if n_physical > 1 {
            notes.add("some entities are in several physical groups: their cells keep the first");
        }
        if key.0 > 0 {
            for _ in 0..source.count("bounding entities", 1)? {
                source.int("bounding entity number")?;
            }
        }
        self.0.insert(key, entity);
        Ok(())
    }
}

fn entity_counts(source: &mut Source<'_>) -> Result<[usize; 4]> {
    let mut counts = [0; 4];
    for n in &mut counts {
        *n = source.count("entities", 4)?;
    }
    Ok(counts)
}
