//! Writes nodes, elements by kind, sets and surfaces.

use std::collections::{BTreeMap, HashMap};
use std::io::Write as _;

use super::kinds::{faces, vtk_to_abaqus, written_as};
use super::names::{PATCH, REGION, one_line, written};
use super::{ELSET, NSET, SURFACE};
use crate::base::{Result, VertexId};
use crate::io::cell_labels::{cell_labels, labels_cover};
use crate::io::facet_key::{FacetKey, facet_key, have_same_orientation};
use crate::io::format::WriteOptions;
use crate::io::label_numbers::numbers;
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::text::push_float;
use crate::mesh::facets::facet_shapes;
use crate::mesh::{CellKind, Field, Labels, Mesh, corners, unused_name};

/// Maximum number of entries in a line.
const MAX_PER_LINE: usize = 16;

/// Maximum number of characters in a name.
const MAX_NAME_LENGTH: usize = 80;

/// Set names with the indices of their members.
type Sets = Vec<(String, Vec<usize>)>;
/// The name and the cells of each label.
type ByLabel = BTreeMap<i32, (String, Vec<usize>)>;

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, "Abaqus", |kind| written_as(kind).is_some());
    let mut out = b"*HEADING\nmesh written by motet\n".to_vec();
    nodes(&mut out, &mesh);
    elements(&mut out, &mesh);
    let patches = by_label(mesh.patches(), PATCH);
    let element_sets = element_sets(&mesh, &patches, &mut lost);
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

fn by_label(labels: Option<Labels>, prefix: &str) -> ByLabel {
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
fn element_sets(mesh: &Mesh, patches: &ByLabel, lost: &mut Vec<String>) -> Sets {
    let regions = by_label(mesh.regions(), REGION);
    let mut sets = Sets::new();
    let mut place_of: HashMap<String, usize> = HashMap::new();
    for (name, cells) in regions.values().chain(patches.values()) {
        let next = sets.len();
        match *place_of.entry(name.clone()).or_insert(next) {
            place if place < next => sets[place].1.extend(cells),
            _ => sets.push((name.clone(), cells.clone())),
        }
    }
    for (labels, prefix, what) in [(&regions, REGION, "regions"), (patches, PATCH, "patches")] {
        let mut in_order: Vec<(i32, &str)> = labels.iter().map(|(&id, set)| (id, set.0.as_str())).collect();
        in_order.sort_by_key(|(_, name)| place_of[*name]);
        let names: Vec<&str> = in_order.iter().map(|label| label.1).collect();
        if !numbers(&names, prefix).into_iter().eq(in_order.iter().map(|label| label.0)) {
            lost.push(format!("numbers of {what} are not kept: Abaqus identifies {what} by name"));
        }
        if names.windows(2).any(|pair| pair[0] == pair[1]) {
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
fn sets_from_arrays(fields: &[Field], prefix: &str) -> Sets {
    let name = |f: &Field| f.name.strip_prefix(prefix).unwrap_or_default().to_owned();
    let marked =
        |f: &Field| marks(f, prefix).map(|marks| (0..marks.len()).filter(|&i| marks[i] == 1).collect());
    fields.iter().filter_map(|f| Some((name(f), marked(f)?))).collect()
}

/// The values of an array that stands for a set; `None` for other arrays.
fn marks(field: &Field, prefix: &str) -> Option<Vec<i64>> {
    let is_named = field.name.len() > prefix.len() && field.name.starts_with(prefix);
    let values =
        field.values.to_i64().filter(|_| is_named && field.components == 1 && field.values.is_integer())?;
    values.iter().all(|v| matches!(v, 0 | 1)).then_some(values)
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
