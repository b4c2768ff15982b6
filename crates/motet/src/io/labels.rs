//! Labels in formats without labels of their own: cell arrays `region` and `patch`, and the names of labels
//! as field data `region:NAME`, `patch:NAME`.

use crate::mesh::{Field, Labels, Mesh, Values};

const REGION: &str = "region";
const PATCH: &str = "patch";

/// The cell arrays and field data to write in addition to those of `mesh`, so that its labels are recovered
/// under motet's names.
pub(super) fn label_fields(mesh: &Mesh) -> (Vec<Field>, Vec<Field>) {
    let array = |name: &str, labels: Option<Labels>| labels.map(|labels| Field::scalars(name, labels.ids));
    let mut cell_data = Vec::new();
    if mesh.cell_field(REGION).is_none() {
        cell_data.extend(array(REGION, mesh.regions()));
    }
    if mesh.cell_field(PATCH).is_none() {
        cell_data.extend(array(PATCH, mesh.patches()));
    }
    let field_data = mesh.label_names.to_entries().map(|(name, id)| Field::scalars(name, vec![id]));
    (cell_data, field_data.collect())
}

/// Moves the names of labels from the field data to `label_names`. Labels may have any integer type, as other
/// programs may write them with more or fewer bytes.
pub(super) fn extract_label_names(mesh: &mut Mesh) {
    let names = &mut mesh.label_names;
    mesh.field_data.retain(|field| {
        let is_whole = !matches!(field.values, Values::Text(_) | Values::F64(_) | Values::F32(_));
        let label = if is_whole && field.values.len() == 1 { field.values.to_i64() } else { None };
        !label.is_some_and(|label| names.take_entry(&field.name, label[0]))
    });
}
