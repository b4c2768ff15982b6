//! Writes nodes, elements by kind, sets and surfaces.

use std::collections::HashMap;
use std::io::Write as _;

use super::kinds::{faces, vtk_to_abaqus, written_as};
use super::names::{one_line, written};
use crate::base::{Result, VertexId};
use crate::io::cell_labels::{cell_labels, labels_cover};
use crate::io::facet_key::{FacetKey, facet_key, have_same_orientation};
use crate::io::format::WriteOptions;
use crate::io::label_numbers::numbers;
use crate::io::named_sets::{
    ByLabel, ELSET, NSET, PATCH, REGION, SURFACE, Sets, by_label, element_sets, marks, sets_from_arrays,
};
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::text::push_float;
use crate::mesh::facets::facet_shapes;
use crate::mesh::{CellKind, Field, Mesh, corners};

/// Maximum number of entries in a line.
const MAX_PER_LINE: usize = 16;

/// Maximum number of characters in a name.
const MAX_NAME_LENGTH: usize = 80;

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, "Abaqus", |kind| written_as(kind).is_some());
    let mut out = b"*HEADING\nmesh written by motet\n".to_vec();
    nodes(&mut out, &mesh);
    elements(&mut out, &mesh);
    let (regions, patches) = (by_label(mesh.regions(), REGION), by_label(mesh.patches(), PATCH));
    let mut renamed = Vec::new();
    let element_sets = element_sets(&mesh, &regions, &patches, &mut renamed);
    lost.extend(lost_numbers(&regions, &element_sets, REGION, "regions"));
    lost.extend(lost_numbers(&patches, &element_sets, PATCH, "patches"));
    lost.extend(renamed);
    let node_sets = sets_from_arrays(&mesh.point_data, NSET);
    sets(&mut out, "ELSET", &element_sets);
    sets(&mut out, "NSET", &node_sets);
    let mut named: Sets = patches.into_values().collect();
    named.extend(sets_from_arrays(&mesh.cell_data, SURFACE));
    surfaces(&mut out, &mesh, &named, &mut lost);
    report_losses(&mesh, &mut lost);
    write_all(output, &out)?;
    Ok(lost)
}

fn nodes(out: &mut Vec<u8>, mesh: &Mesh) {
    out.extend(b"*NODE\n");
    for (point, id) in mesh.points.iter().zip(1..) {
        push(out, id);
        for &x in point {
            out.extend(b", ");
            push_float(out, x);
        }
        out.push(b'\n');
    }
}

fn elements(out: &mut Vec<u8>, mesh: &Mesh) {
    let kinds = mesh.cells.kinds();
    let mut first = 0;
    for run in kinds.chunk_by(|a, b| a == b) {
        let kind = run[0];
        let order = abaqus_to_vtk(kind);
        let _ = writeln!(out, "*ELEMENT, TYPE={}", written_as(kind).unwrap_or_default());
        for cell in first..first + run.len() {
            let vertices = mesh.cells.connectivity().list(cell);
            let ids = order.iter().map(|&place| vertices[place].index() + 1);
            rows(out, std::iter::once(cell + 1).chain(ids));
        }
        first += run.len();
    }
}

fn abaqus_to_vtk(kind: CellKind) -> Vec<usize> {
    let order = vtk_to_abaqus(kind, kind.n_vertices().unwrap_or(0));
    let mut inverse = vec![0; order.len()];
    order.iter().enumerate().for_each(|(vtk, &abaqus)| inverse[abaqus] = vtk);
    inverse
}

/// Writes numbers over as many lines as needed; a trailing comma continues a line.
fn rows(out: &mut Vec<u8>, numbers: impl Iterator<Item = usize>) {
    for (i, number) in numbers.enumerate() {
        if i > 0 {
            out.extend(if i % MAX_PER_LINE == 0 { b",\n" } else { b", " });
        }
        push(out, number);
    }
    out.push(b'\n');
}

fn push(out: &mut Vec<u8>, number: usize) {
    let _ = write!(out, "{number}");
}

/// A message where labels get other numbers when the file is read.
fn lost_numbers(labels: &ByLabel, sets: &Sets, prefix: &str, what: &str) -> Option<String> {
    let place_of: HashMap<&str, usize> = sets.iter().zip(0..).map(|(set, i)| (set.0.as_str(), i)).collect();
    let mut in_order: Vec<(i32, &str)> = labels.iter().map(|(&id, set)| (id, set.0.as_str())).collect();
    in_order.sort_by_key(|(_, name)| place_of.get(name));
    let names: Vec<&str> = in_order.iter().map(|label| label.1).collect();
    let are_kept = numbers(&names, prefix).into_iter().eq(in_order.iter().map(|label| label.0));
    (!are_kept).then(|| format!("numbers of {what} are not kept: Abaqus identifies {what} by name"))
}

fn sets(out: &mut Vec<u8>, keyword: &str, sets: &Sets) {
    for ((_, places), name) in sets.iter().zip(written_names(sets)) {
        let _ = writeln!(out, "*{keyword}, {keyword}={name}");
        // A set without members has no data line.
        if !places.is_empty() {
            rows(out, places.iter().map(|place| place + 1));
        }
    }
}

/// Names as written to the file; names that differ only in case are quoted.
fn written_names(sets: &Sets) -> Vec<String> {
    let mut n_alike: HashMap<String, usize> = HashMap::new();
    sets.iter().for_each(|(name, _)| *n_alike.entry(name.to_ascii_uppercase()).or_default() += 1);
    sets.iter().map(|(name, _)| written(name, n_alike[&name.to_ascii_uppercase()] > 1)).collect()
}

/// Writes the surfaces of which every cell is a facet of a volume cell.
fn surfaces(out: &mut Vec<u8>, mesh: &Mesh, sets: &Sets, lost: &mut Vec<String>) {
    if sets.is_empty() {
        return;
    }
    let sides = sides_of(mesh);
    for ((name, cells), written) in sets.iter().zip(written_names(sets)) {
        let side = |&cell: &usize| sides.get(&key(mesh, cell)).filter(|s| s.0 == cell).and_then(|s| s.1);
        let of_cells: Option<Vec<Side>> = cells.iter().map(side).collect();
        match of_cells.filter(|_| !cells.is_empty()) {
            Some(of_cells) => {
                let _ = writeln!(out, "*SURFACE, TYPE=ELEMENT, NAME={written}");
                for side in of_cells {
                    let _ = writeln!(out, "{}, S{}", side.cell + 1, side.number);
                }
            }
            None if mesh.cell_field(&format!("{SURFACE}{name}")).is_some() => {
                lost.push(format!(
                    "surface {name} is not written: not all its cells are faces of volume cells"
                ));
            }
            None => {}
        }
    }
}

/// A facet of a volume cell, with its number counted from 1 as in S1, S2, ...
#[derive(Clone, Copy)]
struct Side {
    cell: usize,
    number: usize,
    /// Whether the facet has the orientation of the surface cell.
    same_orientation: bool,
}

fn key(mesh: &Mesh, cell: usize) -> FacetKey {
    facet_key(ring(mesh, cell).iter().copied())
}

fn ring(mesh: &Mesh, cell: usize) -> &[VertexId] {
    corners(mesh.cells.kinds()[cell], mesh.cells.connectivity().list(cell))
}

/// For each facet with surface cells, the first of these and the volume cell that it lies on: preferably the
/// first that it faces away from.
fn sides_of(mesh: &Mesh) -> HashMap<FacetKey, (usize, Option<Side>)> {
    let mut sides = HashMap::new();
    for cell in (0..mesh.cells.len()).filter(|&cell| mesh.cells.kinds()[cell].dim() == Some(2)) {
        sides.entry(key(mesh, cell)).or_insert((cell, None));
    }
    let mut faces_of: HashMap<CellKind, Vec<usize>> = HashMap::new();
    for (cell, kind, vertices) in mesh.cells.iter() {
        let shapes = facet_shapes(kind).unwrap_or_default();
        for (&place, number) in faces_of.entry(kind).or_insert_with(|| faces(kind)).iter().zip(1..) {
            let facet: Vec<VertexId> =
                shapes[place].corners().iter().map(|&i| vertices[usize::from(i)]).collect();
            let Some((on, side)) = sides.get_mut(&facet_key(facet.iter().copied())) else { continue };
            let same_orientation = have_same_orientation(ring(mesh, *on), &facet);
            if side.is_none_or(|side: Side| same_orientation && !side.same_orientation) {
                *side = Some(Side { cell: cell.index(), number, same_orientation });
            }
        }
    }
    sides
}

fn report_losses(mesh: &Mesh, lost: &mut Vec<String>) {
    let mut labels = cell_labels(mesh, None);
    // Sets of curves would be read back as arrays of another name.
    let kinds = mesh.cells.kinds();
    labels.iter_mut().zip(kinds).filter(|(_, kind)| kind.dim() < Some(2)).for_each(|(label, _)| *label = 0);
    let is_set = |f: &&Field, prefixes: &[&str]| prefixes.iter().any(|p| marks(f, p).is_some());
    let cell_arrays = mesh.cell_data.iter().filter(|f| !is_set(f, &[ELSET, SURFACE]));
    let unexpressed = cell_arrays.filter(|f| !labels_cover(&labels, mesh, f));
    lost.extend(lost_arrays("Abaqus", "cell", unexpressed));
    lost.extend(lost_arrays("Abaqus", "point", mesh.point_data.iter().filter(|f| !is_set(f, &[NSET]))));
    lost.extend(lost_arrays("Abaqus", "field", &mesh.field_data));
    let names = mesh.label_names.regions.values().chain(mesh.label_names.patches.values());
    for name in names {
        if one_line(name) != *name {
            lost.push(format!("the name {name:?} is written as {:?}", one_line(name)));
        }
        if name.chars().count() > MAX_NAME_LENGTH {
            lost.push(format!(
                "the name {name:?} has more than {MAX_NAME_LENGTH} characters: Abaqus rejects it"
            ));
        }
    }
}
