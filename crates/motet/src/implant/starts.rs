//! Initial values of arrays in devices.

use std::collections::BTreeMap;

use super::owner::Owner;
use super::zone::Draft;
use crate::base::{Error, Result};
use crate::mesh::{Field, Mesh};

/// The components of a value, by the name of the array.
pub(super) type Starts = BTreeMap<String, Vec<f64>>;

/// Checks initial values against the arrays of the host.
///
/// # Errors
/// When the host has no such array, or one with other components or of a type that cannot hold the numbers,
/// or when the array holds the regions.
pub(super) fn check(host: &Mesh, starts: &Starts) -> Result<()> {
    for (name, value) in starts {
        let refused = |what: String, remedy: String| {
            Err(Error::options(what).at(format!("array {name}")).remedy(remedy))
        };
        let fields: Vec<&Field> =
            [host.point_field(name), host.cell_field(name)].into_iter().flatten().collect();
        if fields.is_empty() {
            let known: Vec<&str> =
                host.point_data.iter().chain(&host.cell_data).map(|field| field.name.as_str()).collect();
            return refused(
                "the host has no array of that name".into(),
                format!("its arrays: {}", known.join(", ")),
            );
        }
        if host.regions().is_some_and(|regions| regions.array == *name) {
            return refused(
                "the array holds the regions, and devices have regions of their own".into(),
                "leave it out".into(),
            );
        }
        for field in fields {
            if field.components != value.len() {
                let what = format!("got {} numbers for {} components", value.len(), field.components);
                return refused(what, "give a number for each component".into());
            }
            let mut one = field.pick(field.n_rows().checked_sub(1));
            if one.n_rows() > 0 && !value.iter().enumerate().all(|(k, x)| one.values.set_f64(k, *x)) {
                return refused(
                    format!("the array cannot hold {value:?}"),
                    "give numbers that its type can hold".into(),
                );
            }
        }
    }
    Ok(())
}

/// Sets initial values in the cells of devices, and at points that no other cells have. Those cells are the
/// last of the mesh: tets of the draft, then `n_own` tets that devices kept.
pub(super) fn set(mesh: &mut Mesh, draft: &Draft, n_own: usize, starts: &Starts) {
    let first = mesh.cells.len() - n_own - draft.tets.len();
    let of_draft = draft.owners.iter().map(|owner| matches!(owner, Owner::Device(_)));
    let is_device: Vec<bool> =
        std::iter::repeat_n(false, first).chain(of_draft).chain(std::iter::repeat_n(true, n_own)).collect();
    let mut is_within = vec![false; mesh.points.len()];
    for is_of_device in [true, false] {
        for (cell, kind, vertices) in mesh.cells.iter() {
            // Triangles only bound cells.
            if kind.dim() == Some(3) && is_device[cell.index()] == is_of_device {
                vertices.iter().for_each(|v| is_within[v.index()] = is_of_device);
            }
        }
    }
    let cells: Vec<usize> = (0..is_device.len()).filter(|&c| is_device[c]).collect();
    let points: Vec<usize> = (0..is_within.len()).filter(|&v| is_within[v]).collect();
    for (fields, rows) in [(&mut mesh.point_data, points), (&mut mesh.cell_data, cells)] {
        for field in fields.iter_mut() {
            let Some(value) = starts.get(&field.name) else { continue };
            for row in &rows {
                for (k, x) in value.iter().enumerate() {
                    field.values.set_f64(row * value.len() + k, *x);
                }
            }
        }
    }
}
