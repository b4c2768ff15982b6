//! Writes points, elements and markers.

use std::collections::BTreeMap;
use std::io::Write as _;

use super::{KINDS, UNLABELLED, order_of};
use crate::base::Result;
use crate::io::cell_labels::{cell_labels, lost_cell_arrays};
use crate::io::format::WriteOptions;
use crate::io::label_numbers::numbers;
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::text::push_floats;
use crate::mesh::Mesh;

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let dim = dimension(mesh);
    let (mesh, mut lost) =
        keep_cells(mesh, "SU2", |kind| [dim - 1, dim].iter().any(|&d| KINDS[d].contains(&kind)));
    let of_dim = |d: usize| {
        let kinds = mesh.cells.kinds();
        (0..kinds.len()).filter(move |&i| kinds[i].dim() == Some(d)).collect::<Vec<_>>()
    };
    let elements = of_dim(dim);
    let mut labels = cell_labels(&mesh, None);
    elements.iter().for_each(|&i| labels[i] = 0);
    let markers = markers(&mesh, &labels, &of_dim(dim - 1), &mut lost);
    write_all(output, format!("NDIME= {dim}\n").as_bytes())?;
    cells(output, &mesh, "NELEM", &elements)?;
    write_all(output, format!("NPOIN= {}\n", mesh.points.len()).as_bytes())?;
    output.rows(mesh.points.len(), |rows, mut out| {
        for i in rows {
            push_floats(&mut out, &mesh.points[i][..dim]);
            let _ = writeln!(out, " {i}");
        }
        out
    })?;
    write_all(output, format!("NMARK= {}\n", markers.len()).as_bytes())?;
    for (name, of_marker) in &markers {
        write_all(output, format!("MARKER_TAG= {name}\n").as_bytes())?;
        cells(output, &mesh, "MARKER_ELEMS", of_marker)?;
    }
    let order = elements.iter().chain(markers.iter().flat_map(|(_, of_marker)| of_marker));
    if !order.is_sorted() {
        lost.push("the order of the cells is not kept: SU2 groups cells by marker".into());
    }
    lost.extend(lost_cell_arrays("SU2", &mesh, &labels));
    lost.extend(lost_arrays("SU2", "point", &mesh.point_data));
    lost.extend(lost_arrays("SU2", "field", &mesh.field_data));
    let regions: Vec<&str> = mesh.label_names.regions.values().map(String::as_str).collect();
    if !regions.is_empty() {
        lost.push(format!("names of regions are not written (SU2 has no regions): {}", regions.join(", ")));
    }
    Ok(lost)
}

/// Two dimensions for surfaces and lines in the plane z = 0, otherwise three.
fn dimension(mesh: &Mesh) -> usize {
    let is_flat = || mesh.points.iter().all(|p| p[2].to_bits() == 0);
    if matches!(mesh.cells.dim(), Some(1 | 2)) && is_flat() { 2 } else { 3 }
}

/// The name and the cells of each marker, ordered by label.
fn markers(
    mesh: &Mesh,
    labels: &[i32],
    sides: &[usize],
    lost: &mut Vec<String>,
) -> Vec<(String, Vec<usize>)> {
    let mut by_label: BTreeMap<i32, Vec<usize>> = BTreeMap::new();
    sides.iter().for_each(|&i| by_label.entry(labels[i]).or_default().push(i));
    let ids: Vec<i32> = by_label.keys().copied().collect();
    let mut markers: Vec<(String, Vec<usize>)> = Vec::with_capacity(ids.len());
    for (label, cells) in by_label {
        let name = match mesh.label_names.patches.get(&label) {
            _ if label == 0 => {
                lost.push(format!("{} cells without a patch are in the marker {UNLABELLED}", cells.len()));
                UNLABELLED.to_owned()
            }
            Some(name) => word(name, lost),
            None => label.to_string(),
        };
        match markers.iter_mut().find(|(known, _)| *known == name) {
            Some((_, known)) => {
                lost.push(format!("patches with the name {name} are merged"));
                known.extend(cells);
            }
            None => markers.push((name, cells)),
        }
    }
    let names: Vec<&str> = markers.iter().map(|(name, _)| name.as_str()).collect();
    if numbers(&names, "") != ids {
        lost.push("numbers of patches are not kept: SU2 identifies patches by name".into());
    }
    markers
}

/// A name without the characters that end one.
fn word(name: &str, lost: &mut Vec<String>) -> String {
    let ends = |c: char| c.is_whitespace() || c == '%' || c == ',' || c == '(' || c == ')';
    let word = name.trim().replace(ends, "_");
    let word = if word.is_empty() { "_".to_owned() } else { word };
    if word != name {
        lost.push(format!("the patch {name:?} is written as {word}: SU2 names are single words"));
    }
    word
}

fn cells(output: &mut Output<'_>, mesh: &Mesh, key: &str, places: &[usize]) -> Result<()> {
    write_all(output, format!("{key}= {}\n", places.len()).as_bytes())?;
    output.rows(places.len(), |rows, mut out| {
        for &i in &places[rows] {
            let kind = mesh.cells.kinds()[i];
            let vertices = mesh.cells.connectivity().list(i);
            let _ = write!(out, "{}", kind.0);
            // The order is its own inverse.
            for &place in order_of(kind) {
                let _ = write!(out, " {}", vertices[place]);
            }
            out.push(b'\n');
        }
        out
    })
}
