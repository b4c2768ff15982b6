//! Writes meshes over time to one VTKHDF file. Cells and arrays that equal those of the previous step are
//! stored once.

use crate::base::{Error, Result};
use crate::io::format::WriteOptions;
use crate::io::hdf::{Attribute, Node, Storage};
use crate::io::labels::label_fields;
use crate::io::output::{Output, write_all};
use crate::io::vtkhdf::write::{storage, valid_name};
use crate::mesh::{Cells, Field, Mesh, Values};

/// The frames added so far.
#[derive(Debug, Default)]
pub(in crate::io) struct Steps {
    times: Vec<f64>,
    points: Vec<f64>,
    /// The first point of each step.
    first_points: Vec<i64>,
    /// The part with the cells of each step.
    parts: Vec<i64>,
    /// The first cell, and the first vertex of the cells, of each step.
    first_cells: Vec<i64>,
    first_ids: Vec<i64>,
    cells: Parts,
    last: Option<Cells>,
    on_points: Vec<StepArray>,
    on_cells: Vec<StepArray>,
    field_data: Vec<Field>,
}

/// Distinct sets of cells, concatenated.
#[derive(Debug, Default)]
struct Parts {
    n_points: Vec<i64>,
    n_cells: Vec<i64>,
    n_ids: Vec<i64>,
    kinds: Vec<u8>,
    offsets: Vec<i64>,
    ids: Vec<i64>,
}

/// An array present in every step so far.
#[derive(Debug)]
struct StepArray {
    field: Field,
    /// The first row of each step.
    first: Vec<i64>,
    /// The values of the last step.
    last: Values,
}

impl Steps {
    /// Adds a frame; frames must be added in the order of their times.
    ///
    /// Fails if the mesh has polyhedra, or the time does not follow the previous one.
    pub(in crate::io) fn add(&mut self, time: f64, mesh: &Mesh) -> Result<()> {
        if !mesh.cells.polyhedron_faces().is_empty() {
            return Err(
                Error::input("time series with polyhedra cannot be written as VTKHDF").remedy("write a .pvd")
            );
        }
        if !time.is_finite() || self.times.last().is_some_and(|&last| last >= time) {
            return Err(Error::input(format!(
                "time {time} is not finite, or not greater than the previous time"
            )));
        }
        if self.last.as_ref() != Some(&mesh.cells)
            || self.cells.n_points.last() != Some(&(mesh.points.len() as i64))
        {
            self.add_part(mesh);
        }
        let part = self.cells.n_cells.len() - 1;
        self.parts.push(part as i64);
        self.first_cells.push(self.cells.n_cells[..part].iter().sum());
        self.first_ids.push(self.cells.n_ids[..part].iter().sum());
        self.first_points.push((self.points.len() / 3) as i64);
        self.points.extend_from_slice(mesh.points.as_flattened());
        let (label_cells, label_names) = label_fields(mesh);
        let is_first = self.times.is_empty();
        grow(&mut self.on_points, mesh.point_data.iter(), is_first);
        grow(&mut self.on_cells, mesh.cell_data.iter().chain(&label_cells), is_first);
        if is_first {
            self.field_data = mesh.field_data.iter().cloned().chain(label_names).collect();
        }
        self.times.push(time);
        Ok(())
    }

    fn add_part(&mut self, mesh: &Mesh) {
        let lists = mesh.cells.connectivity();
        self.cells.n_points.push(mesh.points.len() as i64);
        self.cells.n_cells.push(mesh.cells.len() as i64);
        self.cells.n_ids.push(lists.items().len() as i64);
        self.cells.kinds.extend(mesh.cells.kinds().iter().map(|kind| kind.0));
        self.cells.ids.extend(lists.items().iter().map(|v| i64::from(v.0)));
        let ends = lists.iter().scan(0, |end, list| {
            *end += list.len() as i64;
            Some(*end)
        });
        self.cells.offsets.extend(std::iter::once(0).chain(ends));
        self.last = Some(mesh.cells.clone());
    }

    /// Writes the file; returns what the format could not hold.
    ///
    /// Fails if there are no frames, or the options request an unsupported compression.
    pub(in crate::io) fn write_to(
        mut self,
        options: &WriteOptions,
        output: &mut Output<'_>,
    ) -> Result<Vec<String>> {
        let storage = storage(options)?;
        let n = self.times.len();
        if n == 0 {
            return Err(Error::input("the series contains no meshes"));
        }
        let mut lost = Vec::new();
        for (what, arrays) in [("point", &mut self.on_points), ("cell", &mut self.on_cells)] {
            let (kept, left): (Vec<_>, Vec<_>) =
                std::mem::take(arrays).into_iter().partition(|a| a.first.len() == n);
            *arrays = kept;
            lost.extend(left.iter().map(|array| {
                format!(
                    "{what} array {} is not written: it must have the same type and number of components in every step",
                    array.field.name
                )
            }));
        }
        let mut root = Node::new("VTKHDF");
        root.attribute("Version", Attribute::Ints(vec![2, 0]));
        root.attribute("Type", Attribute::Text("UnstructuredGrid".into()));
        let n_rows = self.points.len() / 3;
        root.array("Points", Values::F64(self.points), &[n_rows, 3], storage);
        let Parts { n_points, n_cells, n_ids, kinds, offsets, ids } = self.cells;
        for (name, numbers) in
            [("NumberOfPoints", n_points), ("NumberOfCells", n_cells), ("NumberOfConnectivityIds", n_ids)]
        {
            int(&mut root, name, numbers, Storage::Plain);
        }
        let n_kinds = kinds.len();
        root.array("Types", Values::U8(kinds), &[n_kinds], storage);
        int(&mut root, "Offsets", offsets, storage);
        int(&mut root, "Connectivity", ids, storage);
        let mut steps = Node::new("Steps");
        steps.attribute("NSteps", Attribute::Ints(vec![n as i64]));
        steps.array("Values", Values::F64(self.times), &[n], Storage::Plain);
        int(&mut steps, "NumberOfParts", vec![1; n], Storage::Plain);
        int(&mut steps, "PartOffsets", self.parts, Storage::Plain);
        int(&mut steps, "PointOffsets", self.first_points, Storage::Plain);
        steps.array("CellOffsets", Values::I64(self.first_cells), &[n, 1], Storage::Plain);
        steps.array("ConnectivityIdOffsets", Values::I64(self.first_ids), &[n, 1], Storage::Plain);
        for (kind, arrays) in [("PointData", self.on_points), ("CellData", self.on_cells)] {
            let (mut data, mut firsts) = (Node::new(kind), Node::new(format!("{kind}Offsets")));
            let mut taken: Vec<String> = Vec::new();
            for StepArray { field, first, .. } in arrays {
                let name = valid_name(&field.name, &taken);
                let shape = [field.n_rows(), field.components];
                let shape = if field.components == 1 { &shape[..1] } else { &shape };
                data.array(&name, field.values, shape, storage);
                int(&mut firsts, &name, first, Storage::Plain);
                taken.push(name);
            }
            root.group(data);
            steps.group(firsts);
        }
        let mut data = Node::new("FieldData");
        let mut taken: Vec<String> = Vec::new();
        for field in self.field_data {
            let name = valid_name(&field.name, &taken);
            let shape = [field.n_rows(), field.components];
            data.array(&name, field.values, &shape, Storage::Plain);
            taken.push(name);
        }
        root.group(data);
        root.group(steps);
        let mut file = Node::new("");
        file.group(root);
        write_all(output, &file.into_file()?)?;
        Ok(lost)
    }
}

fn int(group: &mut Node, name: &str, numbers: Vec<i64>, storage: Storage) {
    let n = numbers.len();
    group.array(name, Values::I64(numbers), &[n], storage);
}

/// Appends the rows of a step to each array present in all previous steps; the first step defines the arrays.
fn grow<'f>(all: &mut Vec<StepArray>, fields: impl Iterator<Item = &'f Field>, is_first: bool) {
    let fields: Vec<&Field> = fields.collect();
    if is_first {
        all.extend(fields.iter().map(|&field| StepArray {
            field: field.clone(),
            first: vec![0],
            last: field.values.clone(),
        }));
        return;
    }
    for growing in all {
        let same = |field: &&&Field| {
            field.name == growing.field.name && field.components == growing.field.components
        };
        let Some(field) = fields.iter().find(same) else { continue };
        let row = growing.field.n_rows() as i64;
        if field.values == growing.last {
            growing.first.extend(growing.first.last().copied());
        } else if growing.field.values.append(&field.values) {
            growing.first.push(row);
            growing.last = field.values.clone();
        }
    }
}
