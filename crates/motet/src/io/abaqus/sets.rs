//! Resolves the sets of a file to nodes and elements.

use std::collections::{HashMap, HashSet};
use std::ops::Range;

use super::line::{Reference, Target};
use super::scope::{Entry, Sets};
use crate::base::{Error, Result};
use crate::io::format::Notes;
use crate::io::named_sets::{Runs, merged};
use crate::io::tags::Tags;
use crate::mesh::Cells;

/// Maximum total number of runs, since sets of sets may repeat each other without limit.
pub(super) const MAX_RUNS: usize = 1 << 26;

/// Maps the numbers of a scope to indices in the mesh.
pub(super) struct Numbering {
    tags: Tags,
    sorted: Vec<u64>,
    first_place: u32,
}

impl Numbering {
    /// Fails if a number occurs twice.
    pub(super) fn new(ids: &[u64], what: &str, first_place: usize) -> Result<Self> {
        let mut sorted = ids.to_vec();
        sorted.sort_unstable();
        Ok(Self { tags: Tags::new(ids, what)?, sorted, first_place: first_place as u32 })
    }

    /// The index in the mesh of a number of the scope, if it exists.
    pub(super) fn place(&self, id: u64) -> Option<u32> {
        self.tags.place(id).map(|place| self.first_place + place)
    }

    /// Indices of the existing numbers from `first` to `last` with a step of `step`.
    fn between(&self, first: u64, last: u64, step: u64) -> impl Iterator<Item = u32> + '_ {
        let from = self.sorted.partition_point(|&id| id < first);
        let to = self.sorted.partition_point(|&id| id <= last);
        let stepped =
            self.sorted[from..to.max(from)].iter().filter(move |&&id| (id - first).is_multiple_of(step));
        stepped.filter_map(|&id| self.place(id))
    }
}

/// A scope whose nodes and elements are in the mesh.
pub(super) struct Placed {
    pub(super) nodes: Numbering,
    pub(super) elements: Numbering,
    /// Indices in the mesh of the cells of this scope.
    pub(super) cells: Range<u32>,
    pub(super) node_sets: Members,
    pub(super) element_sets: Members,
}

/// The members of all sets of a scope.
#[derive(Default)]
pub(super) struct Members {
    pub(super) runs: Vec<Runs>,
    by_key: HashMap<String, usize>,
}

impl Members {
    pub(super) fn find(&self, key: &str) -> Option<&Runs> {
        self.by_key.get(key).map(|&set| &self.runs[set])
    }
}

/// Whether sets hold nodes or elements.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum SetKind {
    Nodes,
    Elements,
}

/// Everything that the sets of a scope may refer to.
pub(super) struct Context<'a> {
    pub(super) here: &'a Placed,
    pub(super) instances: &'a [Placed],
    pub(super) instance_of_key: &'a HashMap<String, usize>,
    pub(super) cells: &'a Cells,
    pub(super) notes: &'a Notes,
}

impl<'a> Context<'a> {
    /// The scope of an instance, or this scope if `instance` is `None`.
    pub(super) fn scope(&self, instance: Option<&String>) -> Result<&'a Placed> {
        let Some(key) = instance else { return Ok(self.here) };
        self.instance_of_key.get(key).map(|&i| &self.instances[i]).ok_or_else(|| {
            Error::input(format!("instance `{key}` is not defined"))
                .remedy("the file is damaged: write it again")
        })
    }

    /// Resolves the members of all sets of one kind, in the order of the file.
    pub(super) fn members(&self, sets: &Sets, kind: SetKind) -> Result<Members> {
        let mut found: Vec<Gathered> = sets.all.iter().map(|_| Gathered::default()).collect();
        let mut n_runs = 0;
        for entries in sets.entries.chunk_by(|a, b| a.0 == b.0) {
            let set = entries[0].0;
            // Taken out so that the other sets can be read meanwhile; a set that refers to itself adds
            // nothing.
            let mut whole = std::mem::take(&mut found[set]);
            let mut gathered = Gathered::default();
            let mut known = HashSet::new();
            for (_, entry) in entries {
                match entry {
                    Entry::Ids { first, last, step, instance } => {
                        let scope = self.scope(instance.as_ref())?;
                        gathered.add_ids(kind.numbering(scope), *first, *last, *step);
                    }
                    Entry::Set(reference) => {
                        if known.insert((reference.instance.clone(), key_of(reference))) {
                            gathered.runs.extend(self.other(sets, &found, reference, kind)?.iter().cloned());
                        }
                    }
                    Entry::NodesOf(key) => {
                        let cells = self.here.element_sets.find(key).ok_or_else(|| no_set(key))?;
                        let cells = cells.iter().cloned().flatten();
                        let nodes = cells.flat_map(|cell| self.cells.connectivity().list(cell as usize));
                        gathered.runs.extend(nodes.map(|node| node.0..node.0 + 1));
                    }
                }
            }
            gathered.runs = merged(gathered.runs);
            n_runs += gathered.runs.len();
            if n_runs > MAX_RUNS {
                return Err(Error::input("sets contain each other too often")
                    .remedy("write the sets without nesting"));
            }
            whole.n_missing = whole.n_missing.saturating_add(gathered.n_missing);
            whole.runs.append(&mut gathered.runs);
            whole.runs = merged(whole.runs);
            found[set] = whole;
        }
        for (set, gathered) in sets.all.iter().zip(&found).filter(|(_, gathered)| gathered.n_missing > 0) {
            let n = gathered.n_missing;
            self.notes.add(format!("set {} refers to nonexistent {}: {n}", set.label.shown, kind.what()));
        }
        let by_key = sets.all.iter().zip(0..).map(|(set, i)| (set.label.key.clone(), i)).collect();
        Ok(Members { runs: found.into_iter().map(|gathered| gathered.runs).collect(), by_key })
    }

    /// The members of another set of this scope, or of a set of an instance.
    fn other<'f>(
        &'f self,
        sets: &Sets,
        found: &'f [Gathered],
        reference: &Reference,
        kind: SetKind,
    ) -> Result<&'f Runs> {
        let key = key_of(reference);
        if reference.instance.is_some() {
            let scope = self.scope(reference.instance.as_ref())?;
            let members = if kind == SetKind::Nodes { &scope.node_sets } else { &scope.element_sets };
            return members.find(&key).ok_or_else(|| no_set(&key));
        }
        sets.find(&key).map(|set| &found[set].runs).ok_or_else(|| no_set(&key))
    }
}

#[derive(Default)]
struct Gathered {
    runs: Runs,
    /// Number of references to nonexistent nodes or elements.
    n_missing: usize,
}

impl Gathered {
    fn add_ids(&mut self, numbering: &Numbering, first: u64, last: u64, step: u64) {
        let before = self.runs.len();
        let mut n = 0u64;
        for place in numbering.between(first, last, step) {
            n += 1;
            match self.runs[before..].last_mut() {
                Some(run) if run.end == place => run.end += 1,
                _ => self.runs.push(place..place + 1),
            }
        }
        let n_missing = (last - first) / step + 1 - n;
        self.n_missing = self.n_missing.saturating_add(usize::try_from(n_missing).unwrap_or(usize::MAX));
    }
}

impl SetKind {
    fn numbering(self, scope: &Placed) -> &Numbering {
        if self == Self::Nodes { &scope.nodes } else { &scope.elements }
    }

    fn what(self) -> &'static str {
        if self == Self::Nodes { "nodes" } else { "elements" }
    }
}

fn key_of(reference: &Reference) -> String {
    match &reference.to {
        Target::Label(label) => label.key.clone(),
        Target::Number(id) => id.to_string(),
    }
}

pub(super) fn no_set(key: &str) -> Error {
    Error::input(format!("set `{key}` is not defined")).remedy("the file is damaged: write it again")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_finds_existing_numbers() {
        let numbering = Numbering::new(&[10, 4, 7, 40], "node", 100).unwrap();
        let mut places: Vec<u32> = numbering.between(4, 10, 3).collect();
        places.sort_unstable();
        assert_eq!(places, [100, 101, 102]);
        assert_eq!(numbering.between(5, u64::MAX, u64::MAX).count(), 0);
        assert_eq!(numbering.place(40), Some(103));
    }
}
