//! The sets that the labels and arrays of a mesh stand for.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::ELSET;
use crate::mesh::{Field, Labels, Mesh, unused_name};

/// Set names with the indices of their members.
pub(in crate::io) type Sets = Vec<(String, Vec<usize>)>;
/// The name and the cells of each label.
pub(in crate::io) type ByLabel = BTreeMap<i32, (String, Vec<usize>)>;

/// The cells of each label, under its name, or under the prefix and its number.
pub(in crate::io) fn by_label(labels: Option<Labels>, prefix: &str) -> ByLabel {
    let labels = labels.unwrap_or_default();
    let mut all = ByLabel::new();
    for (cell, &id) in labels.ids.iter().enumerate().filter(|(_, id)| **id != 0) {
        let name = || labels.names.get(&id).filter(|name| !name.is_empty()).cloned();
        let set =
            all.entry(id).or_insert_with(|| (name().unwrap_or_else(|| format!("{prefix}{id}")), Vec::new()));
        set.1.push(cell);
    }
    all
}

/// Element sets made of labels and of `elset:` arrays, in this order.
pub(in crate::io) fn element_sets(
    mesh: &Mesh,
    regions: &ByLabel,
    patches: &ByLabel,
    lost: &mut Vec<String>,
) -> Sets {
    let mut sets = Sets::new();
    let mut place_of: HashMap<String, usize> = HashMap::new();
    for (name, cells) in regions.values().chain(patches.values()) {
        let next = sets.len();
        match *place_of.entry(name.clone()).or_insert(next) {
            place if place < next => sets[place].1.extend(cells),
            _ => sets.push((name.clone(), cells.clone())),
        }
    }
    for (labels, what) in [(regions, "regions"), (patches, "patches")] {
        let names: BTreeSet<&str> = labels.values().map(|set| set.0.as_str()).collect();
        if names.len() < labels.len() {
            lost.push(format!("{what} with the same name are merged"));
        }
    }
    for (name, cells) in sets_from_arrays(&mesh.cell_data, ELSET) {
        // The array holds the cells of a label, and curves in addition: both form one set.
        let can_have_label = |&&cell: &&usize| mesh.cells.kinds()[cell].dim() > Some(1);
        if let Some(&place) = place_of.get(&name)
            && cells.iter().filter(can_have_label).eq(&sorted(&sets[place].1))
        {
            sets[place].1 = cells;
            continue;
        }
        let unused = unused_name(&name, |name| place_of.contains_key(name));
        if unused != name {
            lost.push(format!("{ELSET}{name} is written as set {unused}: a label already has this name"));
        }
        place_of.insert(unused.clone(), sets.len());
        sets.push((unused, cells));
    }
    sets
}

fn sorted(cells: &[usize]) -> Vec<usize> {
    let mut cells = cells.to_vec();
    cells.sort_unstable();
    cells
}

/// The sets marked by arrays of 0 and 1, under the array names without the prefix.
pub(in crate::io) fn sets_from_arrays(fields: &[Field], prefix: &str) -> Sets {
    let name = |f: &Field| f.name.strip_prefix(prefix).unwrap_or_default().to_owned();
    let marked =
        |f: &Field| marks(f, prefix).map(|marks| (0..marks.len()).filter(|&i| marks[i] == 1).collect());
    fields.iter().filter_map(|f| Some((name(f), marked(f)?))).collect()
}

/// The values of an array that stands for a set; `None` for other arrays.
pub(in crate::io) fn marks(field: &Field, prefix: &str) -> Option<Vec<i64>> {
    let is_named = field.name.len() > prefix.len() && field.name.starts_with(prefix);
    let values =
        field.values.to_i64().filter(|_| is_named && field.components == 1 && field.values.is_integer())?;
    values.iter().all(|v| matches!(v, 0 | 1)).then_some(values)
}
