//! Materials and components as named sets.

use std::collections::BTreeMap;

use crate::io::named_sets::{Named, NamedSets, PATCH, REGION, Rank, Runs};
use crate::mesh::CellKind;

/// The sets of cells: components, with the number of the material that they are, and the materials of volume
/// cells, and of surface cells, where there are several.
pub(super) fn sets_of_cells(components: NamedSets, kinds: &[CellKind], materials: &[i32]) -> Vec<Named> {
    let mut sets = components.all;
    for (dim, prefix) in [(3, REGION), (2, PATCH)] {
        let of_dim = |cell: u32| kinds[cell as usize].dim() == Some(dim);
        let mut cells_of: BTreeMap<i32, Vec<u32>> = BTreeMap::new();
        for (cell, &material) in (0u32..).zip(materials).filter(|&(cell, _)| of_dim(cell)) {
            cells_of.entry(material).or_default().push(cell);
        }
        let mut of_materials: Vec<Named> = Vec::new();
        let are_several = cells_of.len() > 1;
        for (material, cells) in cells_of.into_iter().filter(|&(material, _)| material != 0) {
            let is_same = |set: &Named| {
                set.runs.iter().cloned().flatten().filter(|&cell| of_dim(cell)).eq(cells.iter().copied())
            };
            let component = sets.iter_mut().find(|set| is_same(set));
            let name = match component {
                Some(component) => {
                    component.number = material;
                    component.name.clone()
                }
                None => format!("{prefix}{material}"),
            };
            of_materials.push(Named { name, number: material, runs: runs(&cells), rank: Rank::Section });
        }
        if are_several {
            sets.append(&mut of_materials);
        }
    }
    sets
}

/// Rising numbers as runs.
fn runs(places: &[u32]) -> Runs {
    let mut runs = Runs::new();
    for &place in places {
        match runs.last_mut() {
            Some(run) if run.end == place => run.end += 1,
            _ => runs.push(place..place + 1),
        }
    }
    runs
}
