//! Labels in formats that have no labels of their own: cell arrays `region` and
//! `patch`, and their names as field data `region:NAME`, `patch:NAME`.

use std::collections::BTreeMap;

use crate::mesh::{Field, Labels, Mesh, Values};

const REGION: &str = "region";
const PATCH: &str = "patch";

/// The cell arrays and field data that `mesh` needs beside its own, so that its
/// labels are found again under names of ours.
pub(super) fn label_fields(mesh: &Mesh) -> (Vec<Field>, Vec<Field>) {
    let array = |name: &str, labels: Option<Labels>| labels.map(|labels| Field::scalars(name, labels.ids));
    let mut cell_data = Vec::new();
    if mesh.cell_field(REGION).is_none() {
        cell_data.extend(array(REGION, mesh.regions()));
    }
    if mesh.cell_field(PATCH).is_none() {
        cell_data.extend(array(PATCH, mesh.patches()));
    }
    let mut field_data = Vec::new();
    for (kind, names) in [(REGION, &mesh.label_names.regions), (PATCH, &mesh.label_names.patches)] {
        field_data.extend(names.iter().map(|(&id, name)| Field::scalars(format!("{kind}:{name}"), vec![id])));
    }
    (cell_data, field_data)
}

/// Moves the names of labels from the field data to where the mesh keeps them.
pub(super) fn take_label_names(mesh: &mut Mesh) {
    let names = &mut mesh.label_names;
    mesh.field_data
        .retain(|field| !take(field, REGION, &mut names.regions) && !take(field, PATCH, &mut names.patches));
}

fn take(field: &Field, kind: &str, names: &mut BTreeMap<i32, String>) -> bool {
    let name = field.name.strip_prefix(kind).and_then(|rest| rest.strip_prefix(':'));
    let (Some(name), Values::I32(ids)) = (name, &field.values) else { return false };
    let &[id] = ids.as_slice() else { return false };
    names.insert(id, name.to_owned());
    true
}
