//! Lists of ids in VTKHDF, part by part: offsets of the lists, and the ids of all lists.

use crate::base::{Csr, Result, VertexId};
use crate::io::hdf::Group;

/// The two arrays of the lists, and the first row of a frame in each.
pub(super) struct Source<'a> {
    pub(super) group: &'a Group,
    /// Array of offsets, with one entry more than lists in each part.
    pub(super) offsets: &'a str,
    /// The first row in `offsets`, which has an additional row for each preceding part.
    pub(super) first_offset: usize,
    /// Array of ids.
    pub(super) ids: &'a str,
    pub(super) first_id: usize,
}

/// The number of lists and of ids of a part, and the bound on these ids.
pub(super) struct Part {
    pub(super) n_lists: usize,
    pub(super) n_ids: usize,
    pub(super) n_targets: usize,
}

impl Source<'_> {
    /// Reads the lists of all parts, with ids renumbered consecutively over the parts.
    pub(super) fn read(&self, parts: &[Part]) -> Result<Csr<u32>> {
        let offsets = self.group.required_array(self.offsets)?;
        let ids = self.group.required_array(self.ids)?;
        let (mut at_offset, mut at_id, mut shift) = (self.first_offset, self.first_id, 0usize);
        let (mut ends, mut all) = (vec![0u32], Vec::new());
        for part in parts {
            let next_offset = at_offset.saturating_add(part.n_lists).saturating_add(1);
            let next_id = at_id.saturating_add(part.n_ids);
            let starts = offsets.ints(at_offset..next_offset)?;
            if all.len().saturating_add(part.n_ids) > VertexId::MAX_COUNT {
                return Err(ids.error("more ids than a mesh can hold"));
            }
            let ascends = starts.is_sorted() && starts.first() == Some(&0);
            if !ascends || starts.last().is_none_or(|&end| usize::try_from(end) != Ok(part.n_ids)) {
                return Err(offsets.error(format!(
                    "the offsets do not ascend from 0 to {}, the number of ids",
                    part.n_ids
                )));
            }
            ends.extend(starts[1..].iter().map(|&end| all.len() as u32 + end as u32));
            for id in ids.ints(at_id..next_id)? {
                let known = usize::try_from(id).ok().filter(|&id| id < part.n_targets);
                let id = known.ok_or_else(|| {
                    ids.error(format!("id {id} is out of range: there are {}", part.n_targets))
                })?;
                all.push((shift + id) as u32);
            }
            (at_offset, at_id, shift) = (next_offset, next_id, shift + part.n_targets);
        }
        Csr::new(ends, all).ok_or_else(|| offsets.error("the offsets do not ascend"))
    }
}
