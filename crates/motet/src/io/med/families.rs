//! Families: each cell, and each point, belongs to one, and a family to groups.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use crate::base::{Error, Result};
use crate::io::hdf;
use crate::io::latin::decode_utf8_or_latin1;
use crate::io::named_sets::{Named, NamedSets, PATCH, REGION, Rank, Runs, Sets, merged};
use crate::mesh::CellKind;

/// Maximum number of runs of all groups, since families may have any number of groups.
const MAX_RUNS: usize = 1 << 26;

/// The groups of each family, by its number: negative for cells, positive for points.
#[derive(Default)]
pub(super) struct Families(BTreeMap<i64, Vec<String>>);

impl Families {
    /// Reads the families of a mesh.
    pub(super) fn read(root: &hdf::Group, mesh: &hdf::Group) -> Result<Self> {
        let mut families = Self::default();
        let name = mesh.path().rsplit('/').next().unwrap_or_default().to_owned();
        let of_mesh = match root.group("FAS")? {
            Some(all) => all.group(&name)?,
            None => mesh.group("FAS")?,
        };
        let Some(of_mesh) = of_mesh else { return Ok(families) };
        for name in of_mesh.groups() {
            let Some(group) = of_mesh.group(name)? else { continue };
            match name.as_str() {
                "ELEME" | "NOEUD" => {
                    for name in group.groups() {
                        if let Some(family) = group.group(name)? {
                            families.add(&family)?;
                        }
                    }
                }
                // In files of version 2.
                _ => families.add(&group)?,
            }
        }
        Ok(families)
    }

    fn add(&mut self, family: &hdf::Group) -> Result<()> {
        let Some(&number) = family.ints("NUM").as_ref().and_then(|numbers| numbers.first()) else {
            return Ok(());
        };
        let mut groups = Vec::new();
        if let Some(of_family) = family.group("GRO")?
            && let Some(names) = of_family.array("NOM")?
        {
            let name = |record: &Vec<u8>| {
                let end = record.iter().position(|&byte| byte == 0).unwrap_or(record.len());
                decode_utf8_or_latin1(record[..end].trim_ascii())
            };
            groups.extend(names.records()?.iter().map(name).filter(|name| !name.is_empty()));
        }
        self.0.insert(number, groups);
        Ok(())
    }

    /// The groups of cells or points whose families are given. A group that is one family, which has no other
    /// group, has the number of the family.
    pub(super) fn sets(&self, of_places: &[i64]) -> Result<NamedSets> {
        let mut families: BTreeMap<&str, Vec<i64>> = BTreeMap::new();
        for (&number, groups) in &self.0 {
            groups.iter().for_each(|group| families.entry(group).or_default().push(number));
        }
        let mut runs_of: HashMap<i64, Runs> = HashMap::new();
        for (place, &family) in (0u32..).zip(of_places) {
            let runs = runs_of.entry(family).or_default();
            match runs.last_mut() {
                Some(run) if run.end == place => run.end += 1,
                _ => runs.push(place..place + 1),
            }
        }
        let mut sets = NamedSets::default();
        let mut n_runs = 0;
        for (name, numbers) in families {
            n_runs += numbers.iter().filter_map(|number| runs_of.get(number)).map(Vec::len).sum::<usize>();
            if n_runs > MAX_RUNS {
                return Err(
                    Error::input("groups overlap too often").remedy("write the file with fewer groups")
                );
            }
            let own = numbers.iter().filter_map(|number| runs_of.get(number)).flatten().cloned();
            let runs = merged(own.collect());
            let number = match numbers[..] {
                [number] if self.0[&number].len() == 1 => i32::try_from(number.unsigned_abs()).unwrap_or(0),
                _ => 0,
            };
            if !runs.is_empty() {
                sets.add(Named { name: name.to_owned(), number, runs, rank: Rank::Declared });
            }
        }
        Ok(sets)
    }

    /// Sets of the cells of each family, for files without groups.
    pub(super) fn sets_of_families(of_cells: &[i64], kinds: &[CellKind]) -> Vec<Named> {
        let mut runs_of: BTreeMap<(bool, i64), Runs> = BTreeMap::new();
        for (cell, (&family, kind)) in
            (0u32..).zip(of_cells.iter().zip(kinds)).filter(|(_, (family, _))| **family != 0)
        {
            runs_of.entry((kind.dim() == Some(3), family)).or_default().push(cell..cell + 1);
        }
        let named = |((is_volume, family), runs): ((bool, i64), Runs)| {
            let number = i32::try_from(family.unsigned_abs()).unwrap_or(0);
            let name = format!("{}{number}", if is_volume { REGION } else { PATCH });
            Named { name, number, runs: merged(runs), rank: Rank::Declared }
        };
        runs_of.into_iter().map(named).collect()
    }

    /// Whether there are groups of cells.
    pub(super) fn have_groups_of_cells(&self) -> bool {
        self.0.range(..0).any(|(_, groups)| !groups.is_empty())
    }
}

/// Families for writing: for each place the place of its family, and for each family the sets that it is in.
/// The first family is in none.
pub(super) struct Divided {
    pub(super) of_places: Vec<u32>,
    pub(super) families: Vec<Vec<usize>>,
}

impl Divided {
    /// Divides places so that each set consists of whole families.
    pub(super) fn new(n: usize, sets: &Sets) -> Self {
        let mut of_places = vec![0u32; n];
        let mut families: Vec<Vec<usize>> = vec![Vec::new()];
        for (set, (_, members)) in sets.iter().enumerate() {
            let mut moved: HashMap<u32, u32> = HashMap::new();
            let members: BTreeSet<usize> = members.iter().copied().collect();
            for place in members {
                let old = of_places[place];
                of_places[place] = *moved.entry(old).or_insert_with(|| {
                    let mut of = families[old as usize].clone();
                    of.push(set);
                    families.push(of);
                    families.len() as u32 - 1
                });
            }
        }
        Self { of_places, families }
    }

    /// Whether a family has places.
    pub(super) fn used(&self) -> Vec<bool> {
        let mut used = vec![false; self.families.len()];
        self.of_places.iter().for_each(|&family| used[family as usize] = true);
        used
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_divided_into_families() {
        let sets: Sets =
            vec![("a".into(), vec![0, 1, 2]), ("b".into(), vec![2, 3]), ("c".into(), vec![0, 1])];
        let divided = Divided::new(5, &sets);
        let of = |place: usize| divided.families[divided.of_places[place] as usize].clone();
        assert_eq!((of(0), of(1), of(2)), (vec![0, 2], vec![0, 2], vec![0, 1]));
        assert_eq!((of(3), of(4)), (vec![1], vec![]));
        assert_eq!(divided.used().iter().filter(|used| **used).count(), 4);
    }
}
