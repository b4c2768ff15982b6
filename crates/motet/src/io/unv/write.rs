//! Writes nodes, elements and groups.

use std::collections::BTreeSet;
use std::io::Write as _;

use super::kinds::written_as;
use crate::base::Result;
use crate::io::cell_labels::{cell_labels, labels_cover};
use crate::io::format::WriteOptions;
use crate::io::named_sets::{
    ByLabel, ELSET, NSET, PATCH, REGION, Sets, by_label, element_sets, marks, sets_from_arrays,
};
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays};
use crate::mesh::{Field, Mesh};

const NAME: &str = "UNV";

/// Nodes of an element in a line.
const NODES_PER_LINE: usize = 8;

pub(super) fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (mesh, mut lost) = keep_cells(mesh, NAME, |kind| written_as(kind).is_some());
    write_all(output, b"    -1\n  2411\n")?;
    output.rows(mesh.points.len(), |rows, mut out| {
        for i in rows {
            let _ = writeln!(out, "{:10}{:10}{:10}{:10}", i + 1, 1, 1, 11);
            for x in mesh.points[i] {
                let _ = write!(out, "{:>25}", fortran(x));
            }
            out.push(b'\n');
        }
        out
    })?;
    write_all(output, b"    -1\n    -1\n  2412\n")?;
    output.rows(mesh.cells.len(), |rows, mut out| {
        rows.for_each(|i| element(&mut out, &mesh, i));
        out
    })?;
    write_all(output, b"    -1\n")?;
    let (regions, patches) = (by_label(mesh.regions(), REGION), by_label(mesh.patches(), PATCH));
    let of_cells = element_sets(&mesh, &regions, &patches, &mut lost);
    let of_points = sets_from_arrays(&mesh.point_data, NSET);
    groups(output, [(&of_cells, 8), (&of_points, 7)], [&regions, &patches], &mut lost)?;
    report_losses(&mesh, &mut lost);
    Ok(lost)
}

/// A number with an exponent of `D` and enough digits to recover it bit for bit.
fn fortran(x: f64) -> String {
    format!("{x:.16e}").replace('e', "D")
}

fn element(out: &mut Vec<u8>, mesh: &Mesh, cell: usize) {
    let kind = mesh.cells.kinds()[cell];
    let Some((_, descriptor, order)) = written_as(kind) else { return };
    let vertices = mesh.cells.connectivity().list(cell);
    let _ = writeln!(out, "{:10}{descriptor:10}{:10}{:10}{:10}{:10}", cell + 1, 1, 1, 7, order.len());
    if kind.dim() == Some(1) {
        let _ = writeln!(out, "{:10}{:10}{:10}", 0, 1, 1);
    }
    for line in order.chunks(NODES_PER_LINE) {
        line.iter().for_each(|&place| {
            let _ = write!(out, "{:10}", vertices[place].index() + 1);
        });
        out.push(b'\n');
    }
}

/// Writes sets of elements and of nodes, each under a number of its own: that of its label if it is free.
fn groups(
    output: &mut Output<'_>,
    sets: [(&Sets, u8); 2],
    labels: [&ByLabel; 2],
    lost: &mut Vec<String>,
) -> Result<()> {
    if sets.iter().all(|(sets, _)| sets.is_empty()) {
        return Ok(());
    }
    let mut taken: BTreeSet<i32> = labels.iter().flat_map(|labels| labels.keys().copied()).collect();
    taken.insert(0);
    let mut used = BTreeSet::new();
    write_all(output, b"    -1\n  2467\n")?;
    for (sets, kind) in sets {
        for (name, members) in sets {
            let ids = |labels: &ByLabel| {
                labels.iter().find(|(_, set)| kind == 8 && set.0 == *name).map(|(&id, _)| id)
            };
            let own: Vec<i32> = labels.iter().filter_map(|labels| ids(labels)).collect();
            let kept = own.first().copied().filter(|&id| id > 0 && used.insert(id));
            let number = kept.unwrap_or_else(|| {
                let free = (1..).find(|number| !taken.contains(number)).unwrap_or_default();
                taken.insert(free);
                free
            });
            if own.iter().any(|&id| id != number) {
                lost.push(format!("the label {name} is written with number {number}"));
            }
            let mut out = Vec::new();
            let _ = writeln!(
                out,
                "{number:10}{:10}{:10}{:10}{:10}{:10}{:10}{:10}",
                0,
                0,
                0,
                0,
                0,
                0,
                members.len()
            );
            let _ = writeln!(out, "{}", one_line(name, lost));
            for pair in members.chunks(2) {
                pair.iter().for_each(|member| {
                    let _ = write!(out, "{kind:10}{:10}{:10}{:10}", member + 1, 0, 0);
                });
                out.push(b'\n');
            }
            write_all(output, &out)?;
        }
    }
    write_all(output, b"    -1\n")
}

fn one_line(name: &str, lost: &mut Vec<String>) -> String {
    let line = name.trim().replace(['\n', '\r'], " ");
    if line != name {
        lost.push(format!("the name {name:?} is written as {line:?}"));
    }
    line
}

fn report_losses(mesh: &Mesh, lost: &mut Vec<String>) {
    let mut labels = cell_labels(mesh, None);
    // Groups of curves would be read back as arrays of another name.
    let kinds = mesh.cells.kinds();
    labels.iter_mut().zip(kinds).filter(|(_, kind)| kind.dim() < Some(2)).for_each(|(label, _)| *label = 0);
    let is_set = |f: &&Field, prefix: &str| marks(f, prefix).is_some();
    let cell_arrays = mesh.cell_data.iter().filter(|f| !is_set(f, ELSET) && !labels_cover(&labels, mesh, f));
    lost.extend(lost_arrays(NAME, "cell", cell_arrays));
    lost.extend(lost_arrays(NAME, "point", mesh.point_data.iter().filter(|f| !is_set(f, NSET))));
    lost.extend(lost_arrays(NAME, "field", &mesh.field_data));
}
