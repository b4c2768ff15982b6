//! Writes elements by dimension, points and names.

use std::collections::{BTreeMap, HashMap};
use std::io::Write as _;

use super::NO_NAME;
use super::kinds::{MAX_NODES, order_of};
use crate::base::{Result, VertexId};
use crate::io::cell_labels::{cell_labels, lost_cell_arrays};
use crate::io::facet_key::{FacetKey, facet_key, have_same_orientation};
use crate::io::format::WriteOptions;
use crate::io::gzip;
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::text::push_floats;
use crate::mesh::facets::facet_shapes;
use crate::mesh::{Mesh, corners};

const NAME: &str = "Netgen";

/// The largest number that is kept: Netgen has a name for each number up to the largest.
const MAX_NUMBER: i32 = 100_000;

/// Writes a mesh compressed with gzip.
pub(super) fn write_compressed(
    mesh: &Mesh,
    options: &WriteOptions,
    output: &mut Output<'_>,
) -> Result<Vec<String>> {
    let mut bytes = Vec::new();
    let lost = write(mesh, options, &mut Output::to_memory(&mut bytes, output.threads()))?;
    write_all(output, &gzip::compress(&bytes))?;
    Ok(lost)
}

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, NAME, |kind| order_of(kind).is_some());
    let dim = dimension(&mesh);
    let labels = cell_labels(&mesh, None);
    let of_dim: [Vec<usize>; 4] = [0, 1, 2, 3].map(|d| {
        let kinds = mesh.cells.kinds();
        (0..kinds.len()).filter(|&i| kinds[i].dim() == Some(d)).collect()
    });
    let what = ["points", "lines", "patches", "regions"];
    // Points, and lines on edges, have numbers from 0.
    let least = [0, i32::from(dim == 2), 1, 1];
    let numbers = [0, 1, 2, 3].map(|d| numbers(&labels, &of_dim[d], (what[d], least[d]), &mut lost));
    let number = |d: usize, i: usize| numbers[d].get(&labels[i]).copied().unwrap_or(0);
    write_all(output, format!("mesh3d\n\ndimension\n{dim}\n\ngeomtype\n0\n").as_bytes())?;

    let sides = sides(&mesh, |i| number(3, i));
    section(output, "surfaceelements", "surfnr bcnr domin domout np p1 p2 p3", &of_dim[2], |out, i| {
        let [inside, outside] = if dim == 2 { [1, 0] } else { sides.get(&i).copied().unwrap_or_default() };
        let condition = number(2, i);
        let n_nodes = mesh.cells.connectivity().list(i).len();
        let _ = write!(out, "{condition} {condition} {inside} {outside} {n_nodes}");
        nodes(out, &mesh, i);
    })?;
    section(output, "volumeelements", "matnr np p1 p2 p3 p4", &of_dim[3], |out, i| {
        let _ = write!(out, "{} {}", number(3, i), mesh.cells.connectivity().list(i).len());
        nodes(out, &mesh, i);
    })?;
    let columns = "surfid 0 p1 p2 trignum1 trignum2 domin domout ednr1 dist1 ednr2 dist2";
    section(output, "edgesegmentsgi2", columns, &of_dim[1], |out, i| {
        let number = number(1, i);
        let _ = write!(out, "{number} 0");
        nodes(out, &mesh, i);
        let _ = write!(out, " -1 -1 0 0 {number} 0 {number} 0");
    })?;
    let all: Vec<usize> = (0..mesh.points.len()).collect();
    section(output, "points", "X Y Z", &all, |out, i| push_floats(out, &mesh.points[i]))?;
    if !of_dim[0].is_empty() {
        section(output, "pointelements", "pnum index", &of_dim[0], |out, i| {
            nodes(out, &mesh, i);
            let _ = write!(out, " {}", number(0, i));
        })?;
    }
    let [regions, patches] = match dim {
        2 => ["", "materials"],
        _ => ["materials", "bcnames"],
    };
    names(output, regions, &mesh.label_names.regions, &numbers[3], &mut lost)?;
    names(output, patches, &mesh.label_names.patches, &numbers[2], &mut lost)?;
    write_all(output, b"\nendmesh\n")?;

    if ![2, 3, 1, 0].iter().flat_map(|&d| &of_dim[d]).is_sorted() {
        lost.push("the order of the cells is not kept: Netgen groups cells by dimension".into());
    }
    lost.extend(lost_cell_arrays(NAME, &mesh, &labels));
    lost.extend(lost_arrays(NAME, "point", &mesh.point_data));
    lost.extend(lost_arrays(NAME, "field", &mesh.field_data));
    Ok(lost)
}

/// Two dimensions for surfaces and lines in the plane z = 0, otherwise three.
fn dimension(mesh: &Mesh) -> usize {
    let is_flat = || mesh.points.iter().all(|p| p[2].to_bits() == 0);
    if matches!(mesh.cells.dim(), Some(1 | 2)) && is_flat() { 2 } else { 3 }
}

/// The number of each label of the cells `cells`: the label itself, or for those that Netgen cannot hold the
/// next one after the others.
fn numbers(
    labels: &[i32],
    cells: &[usize],
    (what, least): (&str, i32),
    lost: &mut Vec<String>,
) -> BTreeMap<i32, i32> {
    let mut numbers: BTreeMap<i32, i32> = cells.iter().map(|&i| (labels[i], labels[i])).collect();
    let is_kept = |label: i32| (least..=MAX_NUMBER).contains(&label);
    let mut next = numbers.keys().copied().filter(|&label| is_kept(label)).max().unwrap_or(0);
    for (&label, number) in numbers.iter_mut().filter(|(label, _)| !is_kept(**label)) {
        next += 1;
        *number = next;
        lost.push(match label {
            0 => format!("{what} without a number are written with number {next}"),
            _ => format!("number {label} of {what} is written as {next}: Netgen counts from 1"),
        });
    }
    numbers
}

/// For each surface cell on volume cells, the number of the cell that it faces away from, and of the one that
/// it faces; 0 for none.
fn sides(mesh: &Mesh, number: impl Fn(usize) -> i32) -> HashMap<usize, [i32; 2]> {
    let ring = |i: usize| corners(mesh.cells.kinds()[i], mesh.cells.connectivity().list(i));
    let is_surface = |&i: &usize| mesh.cells.kinds()[i].dim() == Some(2);
    let cell_of: HashMap<FacetKey, usize> =
        (0..mesh.cells.len()).filter(is_surface).map(|i| (facet_key(ring(i).iter().copied()), i)).collect();
    let mut sides = HashMap::new();
    if cell_of.is_empty() {
        return sides;
    }
    for (cell, kind, vertices) in mesh.cells.iter() {
        for shape in facet_shapes(kind).unwrap_or_default() {
            let facet: Vec<VertexId> = shape.corners().iter().map(|&i| vertices[usize::from(i)]).collect();
            if let Some(&on) = cell_of.get(&facet_key(facet.iter().copied())) {
                let of_surface: &mut [i32; 2] = sides.entry(on).or_default();
                of_surface[usize::from(!have_same_orientation(ring(on), &facet))] = number(cell.index());
            }
        }
    }
    sides
}

/// Writes a comment with the columns, the name, the number of rows, and the rows.
fn section(
    output: &mut Output<'_>,
    name: &str,
    columns: &str,
    places: &[usize],
    row: impl Fn(&mut Vec<u8>, usize) + Sync + Send,
) -> Result<()> {
    write_all(output, format!("\n# {columns}\n{name}\n{}\n", places.len()).as_bytes())?;
    output.rows(places.len(), |rows, mut out| {
        for &i in &places[rows] {
            row(&mut out, i);
            out.push(b'\n');
        }
        out
    })
}

/// Writes the nodes of a cell, in Netgen's order and counted from 1.
fn nodes(out: &mut Vec<u8>, mesh: &Mesh, cell: usize) {
    let order = order_of(mesh.cells.kinds()[cell]).unwrap_or_default();
    let mut theirs = [0; MAX_NODES];
    let vertices = mesh.cells.connectivity().list(cell);
    order.iter().zip(vertices).for_each(|(&place, v)| theirs[place] = v.index() + 1);
    for id in &theirs[..order.len()] {
        let _ = write!(out, " {id}");
    }
}

/// Writes a name for each number, if there are any names.
fn names(
    output: &mut Output<'_>,
    section: &str,
    names: &BTreeMap<i32, String>,
    numbers: &BTreeMap<i32, i32>,
    lost: &mut Vec<String>,
) -> Result<()> {
    let mut name_of: BTreeMap<i32, String> = BTreeMap::new();
    for (label, name) in names {
        let number = numbers.get(label).copied().unwrap_or(*label);
        let word = name.trim().replace(['\n', '\r', '#'], " ");
        if word.is_empty() || section.is_empty() || !(1..=MAX_NUMBER).contains(&number) {
            lost.push(format!("the name {name:?} of label {label} is not written"));
            continue;
        }
        if word != *name {
            lost.push(format!("the name {name:?} is written as {word:?}"));
        }
        name_of.insert(number, word);
    }
    let used = numbers.values().copied().max().unwrap_or(0);
    let Some(last) = name_of.keys().copied().max().map(|last| last.max(used)) else { return Ok(()) };
    let mut out = format!("\n{section}\n{last}\n").into_bytes();
    for number in 1..=last {
        let _ = writeln!(out, "{number} {}", name_of.get(&number).map_or(NO_NAME, String::as_str));
    }
    write_all(output, &out)
}
