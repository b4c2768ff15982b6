//! Writes nodes, elements and components.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Write as _;

use super::kinds::written;
use crate::base::Result;
use crate::io::cell_labels::{cell_labels, labels_cover};
use crate::io::format::WriteOptions;
use crate::io::named_sets::{
    ELSET, NSET, PATCH, REGION, Sets, by_label, element_sets, marks, sets_from_arrays,
};
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::mesh::{CellKind, Field, Mesh, unused_name};

const NAME: &str = "an Ansys archive";

/// Numbers in a line of a component.
const PER_LINE: usize = 8;

/// Nodes in the first line of an element.
const FIRST_NODES: usize = 8;

/// Maximum number of characters in a name.
const MAX_NAME_LENGTH: usize = 32;

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let as_shells = mesh.cells.kinds().iter().all(|kind| kind.dim() != Some(3));
    let (mesh, mut lost) = keep_cells(mesh, NAME, |kind| written(kind, as_shells).is_some());
    let types = types(&mesh, as_shells);
    let mut head = b"/COM, mesh written by motet\n/PREP7\n".to_vec();
    for (number, key) in (1..).zip(types.iter()) {
        let _ = writeln!(head, "ET,{number},{}", key.0);
        if let Some(shape) = key.1 {
            let _ = writeln!(head, "KEYOPT,{number},1,{shape}");
        }
    }
    let n_points = mesh.points.len();
    let _ = writeln!(head, "NBLOCK,6,SOLID,{n_points:10},{n_points:10}\n(3i10,6e25.16e3)");
    write_all(output, &head)?;
    output.rows(n_points, |rows, mut out| {
        for i in rows {
            let [x, y, z] = mesh.points[i].map(fortran);
            let _ = writeln!(out, "{:10}{:10}{:10}{x:>25}{y:>25}{z:>25}", i + 1, 0, 0);
        }
        out
    })?;
    let materials = materials(&mesh, &mut lost);
    let n_cells = mesh.cells.len();
    write_all(
        output,
        format!("N,R5.3,LOC,       -1,\nEBLOCK,19,SOLID,{n_cells:10},{n_cells:10}\n(19i10)\n").as_bytes(),
    )?;
    output.rows(n_cells, |rows, mut out| {
        rows.for_each(|i| element(&mut out, &mesh, i, &types, materials[i], as_shells));
        out
    })?;
    write_all(output, b"        -1\n")?;
    let (regions, patches) = (by_label(mesh.regions(), REGION), by_label(mesh.patches(), PATCH));
    let of_cells = element_sets(&mesh, &regions, &patches, &mut lost);
    let of_points = sets_from_arrays(&mesh.point_data, NSET);
    let mut names = BTreeSet::new();
    components(output, "ELEM", &of_cells, &mut names, &mut lost)?;
    components(output, "NODE", &of_points, &mut names, &mut lost)?;
    write_all(output, b"FINISH\n")?;
    report_losses(&mesh, &mut lost);
    Ok(lost)
}

/// A number with an exponent of three digits and enough digits to recover it bit for bit.
fn fortran(x: f64) -> String {
    let text = format!("{x:.16e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => {
            let (sign, digits) = exponent.strip_prefix('-').map_or(('+', exponent), |digits| ('-', digits));
            format!("{mantissa}E{sign}{digits:0>3}")
        }
        None => text,
    }
}

/// The element types, in the order of their numbers in the file: that of the library, and the shape of
/// MESH200.
fn types(mesh: &Mesh, as_shells: bool) -> BTreeSet<(i64, Option<i64>)> {
    let kinds: BTreeSet<CellKind> = mesh.cells.kinds().iter().copied().collect();
    kinds.into_iter().filter_map(|kind| written(kind, as_shells)).map(|w| (w.number, w.shape)).collect()
}

/// The material of each cell: its label if that is positive; for cells of each dimension without one a number
/// that none has.
fn materials(mesh: &Mesh, lost: &mut Vec<String>) -> Vec<i32> {
    let mut labels = cell_labels(mesh, None);
    for (dim, what, prefix) in
        [(3, "volume cells", "region"), (2, "surface cells", "patch"), (1, "curves", "label")]
    {
        let of_dim: Vec<usize> =
            (0..labels.len()).filter(|&cell| mesh.cells.kinds()[cell].dim() == Some(dim)).collect();
        let mut used: BTreeSet<i32> = of_dim.iter().map(|&cell| labels[cell]).collect();
        let without: Vec<i32> = used.iter().copied().filter(|&label| label <= 0).collect();
        let is_labelled = used.len() > 1;
        let mut numbers: BTreeMap<i32, i32> = BTreeMap::new();
        for label in without {
            let free = (1..).find(|number| !used.contains(number)).unwrap_or(1);
            used.insert(free);
            numbers.insert(label, free);
            match label {
                0 if is_labelled => {
                    lost.push(format!("{what} without a {prefix} are written with material {free}"))
                }
                0 => {}
                label => lost.push(format!("{prefix} {label} of {what} is written as material {free}")),
            }
        }
        for cell in of_dim {
            labels[cell] = numbers.get(&labels[cell]).copied().unwrap_or(labels[cell]);
        }
    }
    labels
}

fn element(
    out: &mut Vec<u8>,
    mesh: &Mesh,
    cell: usize,
    types: &BTreeSet<(i64, Option<i64>)>,
    material: i32,
    as_shells: bool,
) {
    let Some(written) = written(mesh.cells.kinds()[cell], as_shells) else { return };
    let of = types.iter().position(|key| *key == (written.number, written.shape)).map_or(0, |at| at + 1);
    let n_nodes = written.nodes.len();
    let _ = write!(
        out,
        "{material:10}{of:10}{:10}{:10}{:10}{:10}{:10}{:10}{n_nodes:10}{:10}{:10}",
        1,
        1,
        0,
        0,
        0,
        0,
        0,
        cell + 1
    );
    let vertices = mesh.cells.connectivity().list(cell);
    for (i, &place) in written.nodes.iter().enumerate() {
        if i == FIRST_NODES {
            out.push(b'\n');
        }
        let _ = write!(out, "{:10}", vertices[place].index() + 1);
    }
    out.push(b'\n');
}

/// Writes sets under names that none has yet; a number that follows the one before it, and others, are a
/// range, whose end is negative.
fn components(
    output: &mut Output<'_>,
    sort: &str,
    sets: &Sets,
    names: &mut BTreeSet<String>,
    lost: &mut Vec<String>,
) -> Result<()> {
    for (name, members) in sets.iter().filter(|(_, members)| !members.is_empty()) {
        let plain = plain(name);
        let own = unused_name(&plain, |name| names.contains(&name.to_ascii_uppercase()));
        names.insert(own.to_ascii_uppercase());
        if own != *name {
            lost.push(format!("the name {name:?} is written as {own}"));
        }
        if own.len() > MAX_NAME_LENGTH {
            lost.push(format!("the name {own} has more than {MAX_NAME_LENGTH} characters: Ansys cuts it"));
        }
        let mut rising: Vec<usize> = members.iter().map(|&place| place + 1).collect();
        rising.sort_unstable();
        let mut numbers: Vec<i64> = Vec::new();
        for run in rising.chunk_by(|a, b| a + 1 == *b) {
            numbers.push(run[0] as i64);
            match run.len() {
                1 => {}
                2 => numbers.push(run[1] as i64),
                n => numbers.push(-(run[n - 1] as i64)),
            }
        }
        let mut out = Vec::new();
        let _ = writeln!(out, "CMBLOCK,{own},{sort},{:10}\n(8i10)", numbers.len());
        for line in numbers.chunks(PER_LINE) {
            line.iter().for_each(|number| {
                let _ = write!(out, "{number:10}");
            });
            out.push(b'\n');
        }
        write_all(output, &out)?;
    }
    Ok(())
}

/// A name of letters, digits and underscores that begins with a letter.
fn plain(name: &str) -> String {
    let plain: String =
        name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '_' { c } else { '_' }).collect();
    if plain.starts_with(|c: char| c.is_ascii_alphabetic()) { plain } else { format!("C{plain}") }
}

fn report_losses(mesh: &Mesh, lost: &mut Vec<String>) {
    let mut labels = cell_labels(mesh, None);
    // Components of curves would be read back as arrays of another name.
    let kinds = mesh.cells.kinds();
    labels.iter_mut().zip(kinds).filter(|(_, kind)| kind.dim() < Some(2)).for_each(|(label, _)| *label = 0);
    let is_set = |f: &&Field, prefix: &str| marks(f, prefix).is_some();
    let cell_arrays = mesh.cell_data.iter().filter(|f| !is_set(f, ELSET) && !labels_cover(&labels, mesh, f));
    lost.extend(lost_arrays(NAME, "cell", cell_arrays));
    lost.extend(lost_arrays(NAME, "point", mesh.point_data.iter().filter(|f| !is_set(f, NSET))));
    lost.extend(lost_arrays(NAME, "field", &mesh.field_data));
}
