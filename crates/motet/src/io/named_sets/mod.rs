//! Named sets of cells and of points, which may overlap, as labels and arrays of a mesh, and back.
//!
//! Labels may not overlap. A set that labels do not express is an array of 0 and 1.

mod labels;
mod of_mesh;

use std::collections::HashMap;
use std::ops::Range;

use crate::mesh::unused_name;

pub(super) use labels::{set_arrays, set_labels};
pub(super) use of_mesh::{ByLabel, Sets, by_label, element_sets, marks, sets_from_arrays};

/// Prefix of the name of an array that stands for a node set.
pub(super) const NSET: &str = "nset:";
/// Prefix of the name of an array that stands for an element set.
pub(super) const ELSET: &str = "elset:";
/// Prefix of the name of an array that stands for a surface.
pub(super) const SURFACE: &str = "surface:";

/// A name that is this and a number stands for the unnamed region with this number.
pub(super) const REGION: &str = "REGION_";
/// A name that is this and a number stands for the unnamed patch with this number.
pub(super) const PATCH: &str = "PATCH_";

/// Disjoint ascending ranges of indices of points or cells of a mesh.
pub(super) type Runs = Vec<Range<u32>>;

/// Sorts runs and joins those that touch or overlap.
pub(super) fn merged(mut runs: Runs) -> Runs {
    runs.sort_unstable_by_key(|run| (run.start, run.end));
    let mut out = Runs::new();
    for run in runs {
        match out.last_mut() {
            Some(last) if run.start <= last.end => last.end = last.end.max(run.end),
            _ => out.push(run),
        }
    }
    out
}

/// A set or surface, as indices of points or cells of the mesh.
pub(super) struct Named {
    pub(super) name: String,
    /// The number of the set in the file; 0 for none.
    pub(super) number: i32,
    pub(super) runs: Runs,
    pub(super) rank: Rank,
}

/// Kinds of sets, in the order in which they are preferred as labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rank {
    Section,
    Declared,
    OfElements,
    Instance,
    Surface,
}

impl Named {
    fn places(&self) -> impl Iterator<Item = usize> + '_ {
        self.runs.iter().cloned().flatten().map(|place| place as usize)
    }
}

/// Sets with distinct names.
#[derive(Default)]
pub(super) struct NamedSets {
    pub(super) all: Vec<Named>,
    by_name: HashMap<String, usize>,
}

impl NamedSets {
    /// Adds a set under a unique name; a set with the same name and the same members is added only once.
    pub(super) fn add(&mut self, mut set: Named) {
        if self.by_name.get(&set.name).is_some_and(|&i| self.all[i].runs == set.runs) {
            return;
        }
        set.name = unused_name(&set.name, |name| self.by_name.contains_key(name));
        self.by_name.insert(set.name.clone(), self.all.len());
        self.all.push(set);
    }

    /// Adds a surface, whose name may also be that of a set.
    pub(super) fn add_surface(&mut self, name: String, runs: Runs) {
        self.all.push(Named { name, number: 0, runs, rank: Rank::Surface });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touching_runs_are_joined() {
        assert_eq!(merged(vec![5..6, 0..2, 2..3, 1..2, 6..9]), [0..3, 5..9]);
    }
}
