//! Solutions as arrays: values on points, on cells, or on some elements; components of vectors are combined.

use std::collections::BTreeMap;

use crate::base::Result;
use crate::io::cgns::cells::{NO_CELL, Span};
use crate::io::cgns::conditions::{Numbers, is_on_points};
use crate::io::cgns::node::Node;
use crate::io::format::Notes;
use crate::mesh::{CellKind, Field, Values};

/// Maximum number of arrays: each takes a value for each point or cell, however few the file holds.
const MAX_ARRAYS: usize = 1000;

/// The indices in the mesh of the points and cells of a zone.
pub(super) struct Places<'a> {
    pub(super) first_point: usize,
    pub(super) n_points: usize,
    pub(super) spans: &'a [Span],
    pub(super) kinds: &'a [CellKind],
    /// Dimension of the cells that a cell solution is defined on.
    pub(super) cell_dim: usize,
}

/// Arrays on points or on cells, collected zone by zone.
#[derive(Default)]
pub(super) struct Arrays {
    by_name: BTreeMap<String, Column>,
}

/// Values, and the row of each value.
struct Column {
    values: Values,
    rows: Vec<u32>,
}

/// The solutions of all zones.
#[derive(Default)]
pub(super) struct Solutions {
    pub(super) points: Arrays,
    pub(super) cells: Arrays,
}

impl Solutions {
    /// Reads the solutions of a zone.
    pub(super) fn take(&mut self, zone: &Node, places: &Places<'_>, notes: &Notes) -> Result<()> {
        let is_known = |node: &Node| matches!(node.label.as_str(), "FlowSolution_t" | "UserDefinedData_t");
        for solution in zone.children()?.into_iter().filter(is_known) {
            let is_on_points = is_on_points(&solution)?;
            let some = Numbers::of(&solution, "PointList", "PointRange")?;
            // User-defined data is a solution if it lists the entities that it is defined on.
            if some.is_none() && solution.label != "FlowSolution_t" {
                continue;
            }
            let rows = if is_on_points { places.points(some.as_ref()) } else { places.cells(some.as_ref()) };
            let arrays = if is_on_points { &mut self.points } else { &mut self.cells };
            for node in solution.children_of("DataArray_t")? {
                let Some(array) = node.array()?.filter(|array| array.is_supported()) else {
                    notes.add(format!("{} contains no numbers: skipped", node.path()));
                    continue;
                };
                let values = array.all()?;
                if values.len() != rows.len() {
                    notes.add(format!(
                        "{} has {} values for {} {}: skipped",
                        node.path(),
                        values.len(),
                        rows.len(),
                        if is_on_points { "points" } else { "cells" }
                    ));
                    continue;
                }
                arrays.take(node, values, &rows, notes);
            }
        }
        Ok(())
    }
}

impl Places<'_> {
    /// The point of each value.
    fn points(&self, some: Option<&Numbers>) -> Vec<u32> {
        let row = |number: i64| (self.first_point as i64 + number - 1) as u32;
        let all = Numbers::Range(1, self.n_points as i64);
        some.unwrap_or(&all).within(1, self.n_points as i64).map(row).collect()
    }

    /// The cell of each value.
    fn cells(&self, some: Option<&Numbers>) -> Vec<u32> {
        match some {
            Some(numbers) => {
                let of = |span: &Span| -> Vec<u32> {
                    let cell = |number| span.cell(number).map_or(NO_CELL, |cell| cell as u32);
                    numbers.within(span.first, span.last()).map(cell).collect()
                };
                self.spans.iter().flat_map(of).collect()
            }
            None => {
                let fills = |&cell: &usize| self.kinds[cell].dim() == Some(self.cell_dim);
                self.spans.iter().flat_map(Span::cells).filter(fills).map(|cell| cell as u32).collect()
            }
        }
    }
}

impl Arrays {
    fn take(&mut self, node: Node, values: Values, rows: &[u32], notes: &Notes) {
        if self.by_name.len() >= MAX_ARRAYS && !self.by_name.contains_key(&node.name) {
            notes.add(format!("arrays beyond the first {MAX_ARRAYS} are skipped"));
            return;
        }
        let place = node.path().to_owned();
        match self.by_name.get_mut(&node.name) {
            None => {
                self.by_name.insert(node.name, Column { values, rows: rows.to_vec() });
            }
            Some(column) if column.rows.iter().any(|row| rows.first() == Some(row)) => {
                notes.add(format!("{place} occurs more than once: only the first is used"));
            }
            Some(column) => {
                if column.append(&values) {
                    column.rows.extend(rows);
                } else {
                    notes.add(format!("{place} contains no numbers: skipped"));
                }
            }
        }
    }

    /// The arrays, with a row for each of `n` points or cells; a missing value is NaN, or 0 for integers.
    pub(super) fn finish(self, n: usize) -> Vec<Field> {
        let scalars = self.by_name.into_iter().map(|(name, column)| (name, column.spread(n))).collect();
        with_vectors(scalars, n)
    }
}

impl Column {
    /// Appends values, converted to double precision if their types differ. Returns false if they are not
    /// numbers.
    fn append(&mut self, more: &Values) -> bool {
        if self.values.append(more) {
            return true;
        }
        let (Some(mut all), Some(more)) = (self.values.to_f64(), more.to_f64()) else { return false };
        all.extend(more);
        self.values = Values::F64(all);
        true
    }

    fn spread(self, n: usize) -> Values {
        let in_order = self.rows.len() == n && self.rows.iter().zip(0..).all(|(&row, i)| row == i);
        if in_order {
            return self.values;
        }
        let blank = self.values.len();
        let mut values = self.values;
        let _ = values.append(&blank_of(&values));
        let mut from = vec![blank; n];
        for (i, &row) in self.rows.iter().enumerate().rev().filter(|(_, row)| **row != NO_CELL) {
            from[row as usize] = i;
        }
        Field { name: String::new(), components: 1, values }.pick(from).values
    }
}

fn blank_of(values: &Values) -> Values {
    match values {
        Values::I8(_) => Values::I8(vec![0]),
        Values::U8(_) => Values::U8(vec![0]),
        Values::I16(_) => Values::I16(vec![0]),
        Values::U16(_) => Values::U16(vec![0]),
        Values::I32(_) => Values::I32(vec![0]),
        Values::U32(_) => Values::U32(vec![0]),
        Values::I64(_) => Values::I64(vec![0]),
        Values::U64(_) => Values::U64(vec![0]),
        Values::F32(_) => Values::F32(vec![f32::NAN]),
        Values::F64(_) => Values::F64(vec![f64::NAN]),
        Values::Text(_) => Values::Text(vec![String::new()]),
    }
}

/// Combines scalars whose names differ only in a final X, Y or Z into vectors.
fn with_vectors(mut scalars: BTreeMap<String, Values>, n: usize) -> Vec<Field> {
    let stems: Vec<String> =
        scalars.keys().filter_map(|name| name.strip_suffix('X')).map(str::to_owned).collect();
    let mut fields = Vec::new();
    for stem in stems.into_iter().filter(|stem| !stem.is_empty()) {
        let names = ["X", "Y", "Z"].map(|axis| format!("{stem}{axis}"));
        let has_all = names.iter().all(|name| scalars.contains_key(name)) && !scalars.contains_key(&stem);
        if has_all && let Some(vector) = vector(&stem, names.each_ref().map(|name| &scalars[name]), n) {
            names.iter().for_each(|name| drop(scalars.remove(name)));
            fields.push(vector);
        }
    }
    fields.extend(scalars.into_iter().map(|(name, values)| Field { name, components: 1, values }));
    fields.sort_by(|a, b| a.name.cmp(&b.name));
    fields
}

/// A vector of three scalars; `None` if their types differ.
fn vector(name: &str, [x, y, z]: [&Values; 3], n: usize) -> Option<Field> {
    let mut values = x.clone();
    if !values.append(y) || !values.append(z) {
        return None;
    }
    let all = Field { name: name.to_owned(), components: 1, values };
    let vector = all.pick((0..n).flat_map(|i| [i, i + n, i + 2 * n]));
    Some(Field { components: 3, ..vector })
}
