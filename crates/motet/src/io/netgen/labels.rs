//! Numbers and names of materials and boundary conditions as labels.

use std::collections::BTreeMap;

use super::{INDEX, NO_NAME, Names};
use crate::mesh::{CellKind, Field, Mesh};

/// Sets the array of the numbers, and names of regions and patches. Where numbers share a name, an array
/// more has the first of them.
pub(super) fn set_labels(mesh: &mut Mesh, indices: Vec<i32>, names: [Names; 2]) {
    let dims = [3, 2].into_iter().zip(["region", "patch"]);
    for ((dim, array), mut names) in dims.zip(names) {
        names.retain(|&number, name| number != 0 && name != NO_NAME);
        let mut first_of: BTreeMap<&str, i32> = BTreeMap::new();
        let first: BTreeMap<i32, i32> = names
            .iter()
            .map(|(&number, name)| (number, *first_of.entry(name.as_str()).or_insert(number)))
            .collect();
        if first.iter().any(|(number, first)| number != first) {
            let of_cell = |(&index, kind): (&i32, &CellKind)| match kind.dim() == Some(dim) {
                true => first.get(&index).copied().unwrap_or(index),
                false => 0,
            };
            let labels: Vec<i32> = indices.iter().zip(mesh.cells.kinds()).map(of_cell).collect();
            mesh.set_cell_field(Field::scalars(array, labels));
            names.retain(|number, _| first.get(number) == Some(number));
        }
        match dim {
            3 => mesh.label_names.regions = names,
            _ => mesh.label_names.patches = names,
        }
    }
    if indices.iter().any(|&index| index != 0) {
        mesh.set_cell_field(Field::scalars(INDEX, indices));
    }
}
