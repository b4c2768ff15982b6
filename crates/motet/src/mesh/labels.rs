//! Labels: the region of each volume cell, and the patch of each surface cell.

use std::collections::BTreeMap;

use crate::base::{Error, Result};
use crate::mesh::{Field, Mesh, Values};

/// Names of labels; a label without a name is known by its number.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LabelNames {
    /// Names of regions, the labels of volume cells.
    pub regions: BTreeMap<i32, String>,
    /// Names of patches, the labels of surface cells.
    pub patches: BTreeMap<i32, String>,
}

/// Prefixes of field data that hold the name of a region, and of a patch; a colon and the name follow.
const NAME_FIELDS: [&str; 2] = ["region", "patch"];

impl LabelNames {
    /// The names as field data, for formats that have arrays but no label names: `region:NAME` and
    /// `patch:NAME`, each with the label as its one value.
    pub fn to_entries(&self) -> impl Iterator<Item = (String, i32)> {
        let [region, patch] = NAME_FIELDS;
        let all = [(region, &self.regions), (patch, &self.patches)];
        all.into_iter()
            .flat_map(|(kind, names)| names.iter().map(move |(&id, name)| (format!("{kind}:{name}"), id)))
    }

    /// Takes a name from field data as written by [`Self::to_entries`]; returns `false` if it is not such a
    /// name.
    pub fn take_entry(&mut self, field: &str, label: i64) -> bool {
        let [region, patch] = NAME_FIELDS;
        let Some((kind, name)) = field.split_once(':') else { return false };
        let names = match kind {
            kind if kind == region => &mut self.regions,
            kind if kind == patch => &mut self.patches,
            _ => return false,
        };
        let Ok(id) = i32::try_from(label) else { return false };
        names.insert(id, name.to_owned());
        true
    }
}

/// A label for each cell of a mesh; 0 for cells of other dimensions and for cells without a label.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Labels {
    /// The label of each cell, in the order of the cells.
    pub ids: Vec<i32>,
    /// The names of labels, where there are any.
    pub names: BTreeMap<i32, String>,
    /// The name of the cell array that the labels come from.
    pub array: String,
}

impl Labels {
    /// The label denoted by `text`, a name or a number; `None` if there is no such label.
    pub fn find(&self, text: &str) -> Option<i32> {
        let named = self.names.iter().find(|(_, name)| *name == text).map(|(&id, _)| id);
        named.or_else(|| text.parse().ok().filter(|id| self.ids.contains(id)))
    }

    /// Every label in use except 0, in rising order.
    pub fn used(&self) -> Vec<i32> {
        let mut used: Vec<i32> = self.ids.iter().copied().filter(|&id| id != 0).collect();
        used.sort_unstable();
        used.dedup();
        used
    }

    /// The name of a label, or its number.
    pub fn name(&self, id: i32) -> String {
        self.names.get(&id).cloned().unwrap_or_else(|| id.to_string())
    }
}

/// Places of labels: 0, 1, ... in the order in which labels are first asked for. Neighbouring cells mostly
/// have one label, so the last one is compared first.
#[derive(Debug, Default)]
pub(crate) struct LabelPlaces {
    places: BTreeMap<i32, usize>,
    last: Option<(i32, usize)>,
}

impl LabelPlaces {
    /// The place of a label, the next one if it is new.
    #[inline]
    pub(crate) fn of(&mut self, label: i32) -> usize {
        match self.last {
            Some((last, place)) if last == label => place,
            _ => {
                let next = self.places.len();
                let place = *self.places.entry(label).or_insert(next);
                self.last = Some((label, place));
                place
            }
        }
    }

    /// All labels, rising, with their places.
    pub(crate) fn iter(&self) -> impl ExactSizeIterator<Item = (i32, usize)> + '_ {
        self.places.iter().map(|(&label, &place)| (label, place))
    }
}

/// A name that is not taken yet: `name`, or `name` with a number from 2 on appended.
pub fn unused_name(name: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let numbered = (2u32..).map(|k| format!("{name}_{k}"));
    std::iter::once(name.to_owned()).chain(numbered).find(|name| !is_taken(name)).unwrap_or_default()
}

/// Arrays in which other tools store labels of volume cells, in order of preference.
const REGION_ARRAYS: &[&str] = &[
    "region",
    "gmsh:physical",
    "medit:ref",
    "tetgen:ref",
    "netgen:index",
    "nastran:ref",
    "elemTag",
    "ModelRegionID",
    "CellEntityIds",
    "gmsh:geometrical",
];

/// Arrays in which other tools store labels of surface cells, in order of preference.
const PATCH_ARRAYS: &[&str] = &[
    "patch",
    "gmsh:physical",
    "medit:ref",
    "tetgen:ref",
    "su2:tag",
    "netgen:index",
    "nastran:ref",
    "elemTag",
    "ModelFaceID",
    "CellEntityIds",
    "gmsh:geometrical",
];

impl Mesh {
    /// Labels of the volume cells, from the first of the array names in common use that has any; `None` if
    /// the mesh has none.
    pub fn regions(&self) -> Option<Labels> {
        self.labels_of(3, REGION_ARRAYS, &self.label_names.regions)
    }

    /// Labels of the surface cells, from the first of the array names in common use that has any; `None` if
    /// the mesh has none.
    pub fn patches(&self) -> Option<Labels> {
        self.labels_of(2, PATCH_ARRAYS, &self.label_names.patches)
    }

    /// The region denoted by `word`: its name, or its number.
    ///
    /// # Errors
    /// If the mesh has no such region; the error lists those it has.
    pub fn find_region(&self, word: &str) -> Result<i32> {
        find(self.regions(), word, ["region", "regions"])
    }

    /// The patch denoted by `word`: its name, or its number.
    ///
    /// # Errors
    /// If the mesh has no such patch; the error lists those it has.
    pub fn find_patch(&self, word: &str) -> Result<i32> {
        find(self.patches(), word, ["patch", "patches"])
    }

    /// The patches denoted by `words`, in their order.
    ///
    /// # Errors
    /// If the mesh lacks one of them, as for [`Self::find_patch`].
    pub fn find_patches(&self, words: &[String]) -> Result<Vec<i32>> {
        words.iter().map(|word| self.find_patch(word)).collect()
    }

    /// Writes the region of each volume cell and the patch of each surface cell into the arrays of these
    /// names, which may be one array for both.
    pub(crate) fn set_labels(&mut self, arrays: &[String; 2], regions: Vec<i64>, patches: Vec<i64>) {
        let field = |name: &str, ids: Vec<i64>| {
            Field::scalars(name, ids.into_iter().map(|id| id as i32).collect::<Vec<_>>())
        };
        let [of_regions, of_patches] = arrays;
        if of_regions == of_patches {
            let both = regions.into_iter().zip(patches).zip(self.cells.kinds());
            let both = both.map(|((r, p), kind)| if kind.dim() == Some(2) { p } else { r }).collect();
            self.set_cell_field(field(of_regions, both));
        } else {
            self.set_cell_field(field(of_regions, regions));
            self.set_cell_field(field(of_patches, patches));
        }
    }

    /// The labels in an array of cells as whole numbers; 0 for each cell where there is no such array.
    pub(crate) fn label_numbers(&self, array: &str) -> Vec<i64> {
        let known = self.cell_field(array).and_then(|field| field.values.to_i64());
        known.unwrap_or_else(|| vec![0; self.cells.len()])
    }

    fn labels_of(&self, dim: usize, arrays: &[&str], names: &BTreeMap<i32, String>) -> Option<Labels> {
        let on_dim: Vec<bool> = self.cells.kinds().iter().map(|k| k.dim() == Some(dim)).collect();
        arrays.iter().find_map(|array| {
            let ids = label_ids(self.cell_field(array)?, &on_dim)?;
            Some(Labels { ids, names: names.clone(), array: (*array).to_owned() })
        })
    }
}

fn find(labels: Option<Labels>, word: &str, [what, several]: [&str; 2]) -> Result<i32> {
    let labels = labels.unwrap_or_default();
    labels.find(word).ok_or_else(|| {
        let names: Vec<String> = labels.used().into_iter().map(|id| labels.name(id)).collect();
        let known = if names.is_empty() { format!("no {several}") } else { names.join(", ") };
        Error::options(format!("the mesh has no {what} `{word}`")).remedy(format!("it has {known}"))
    })
}

/// The labels that `field` gives to the cells where `on_dim` is `true`; `None` if its values are not whole
/// numbers, or if none of these cells has a label.
fn label_ids(field: &Field, on_dim: &[bool]) -> Option<Vec<i32>> {
    if field.components != 1 || matches!(field.values, Values::Text(_)) {
        return None;
    }
    let all = field.values.to_i64()?;
    let ids: Option<Vec<i32>> =
        all.iter().zip(on_dim).map(|(&id, &on)| if on { i32::try_from(id).ok() } else { Some(0) }).collect();
    ids.filter(|ids| ids.iter().any(|&id| id != 0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_into_field_data_and_come_back() {
        let mut given = LabelNames::default();
        given.regions.insert(3, "blood: outer".to_owned());
        given.patches.extend([(-1, "wall".to_owned()), (7, String::new()), (i32::MAX, "patch:x".to_owned())]);
        let mut back = LabelNames::default();
        for (field, label) in given.to_entries() {
            assert!(back.take_entry(&field, label.into()), "{field}");
        }
        assert_eq!(back, given);
        for other in ["patch", "patches:wall", "region 3", ":wall", ""] {
            assert!(!back.take_entry(other, 1), "{other}");
        }
        assert!(!back.take_entry("patch:far", 1 << 40) && back == given);
    }
}
