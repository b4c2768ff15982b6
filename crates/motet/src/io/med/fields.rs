//! Fields as arrays.

use super::WHOLE;
use crate::base::{Error, Result};
use crate::io::format::Notes;
use crate::io::hdf;
use crate::io::memory_budget::MemoryBudget;
use crate::mesh::{Field, Values};

/// Cells of one type, in the order of the file.
pub(super) struct Block {
    pub(super) name: String,
    /// The places of the cells in the mesh.
    pub(super) cells: Vec<u32>,
}

/// The arrays of points, and of cells.
pub(super) struct Arrays {
    pub(super) points: Vec<Field>,
    pub(super) cells: Vec<Field>,
}

/// Reads the fields of the mesh with this name, at their last step.
pub(super) fn read(
    root: &hdf::Group,
    mesh: &str,
    n_points: usize,
    blocks: &[Block],
    file_bytes: u64,
    notes: &Notes,
) -> Result<Arrays> {
    let mut arrays = Arrays { points: Vec::new(), cells: Vec::new() };
    let Some(all) = root.group("CHA")? else { return Ok(arrays) };
    let budget = MemoryBudget::of(file_bytes);
    for name in all.groups() {
        let Some(field) = all.group(name)?.filter(|field| field.text("MAI").is_none_or(|of| of == mesh))
        else {
            continue;
        };
        let steps = field.groups();
        let Some(last) = steps.last() else { continue };
        if steps.len() > 1 {
            notes.add(format!("of {} steps of field {name} the last is read", steps.len()));
        }
        let Some(step) = field.group(last)? else { continue };
        let mut of_blocks = Vec::new();
        for support in step.groups() {
            let Some(values) = step.group(support)?.map(|group| whole(&group)).transpose()?.flatten() else {
                notes.add(format!("field {name} on parts of cells ({support}) is skipped"));
                continue;
            };
            if support == "NOE" {
                arrays.points.extend(rows(name, values, n_points, notes));
                continue;
            }
            let block =
                support.strip_prefix("MAI.").and_then(|of| blocks.iter().find(|block| block.name == of));
            match block {
                Some(block) => {
                    of_blocks
                        .extend(rows(name, values, block.cells.len(), notes).map(|field| (block, field)));
                }
                None => notes.add(format!("field {name} on {support} is skipped")),
            }
        }
        if !of_blocks.is_empty() {
            arrays.cells.extend(joined(name, &of_blocks, blocks, &budget, notes)?);
        }
    }
    Ok(arrays)
}

/// The values on all points or cells of a type; `None` if there are others only.
fn whole(support: &hdf::Group) -> Result<Option<Values>> {
    let Some(profile) = support.group(WHOLE)? else { return Ok(None) };
    if profile.ints("NGA").is_some_and(|n| n != [1]) {
        return Ok(None);
    }
    let Some(values) = profile.array("CO")?.filter(hdf::Array::is_supported) else { return Ok(None) };
    values.all().map(Some)
}

/// An array of `n` rows from values that are stored column by column.
fn rows(name: &str, values: Values, n: usize, notes: &Notes) -> Option<Field> {
    let components = values.len().checked_div(n).unwrap_or(0);
    if components == 0 || components * n != values.len() || matches!(values, Values::Text(_)) {
        notes.add(format!("field {name} is skipped: it does not have {n} rows"));
        return None;
    }
    let columns = Field { name: name.to_owned(), components: 1, values };
    let order = (0..n).flat_map(|row| (0..components).map(move |column| column * n + row));
    Some(Field { components, ..columns.pick(order) })
}

/// One array of the fields on several types of cells; others get zeros.
fn joined(
    name: &str,
    of_blocks: &[(&Block, Field)],
    blocks: &[Block],
    budget: &MemoryBudget,
    notes: &Notes,
) -> Result<Option<Field>> {
    let n_cells: usize = blocks.iter().map(|block| block.cells.len()).sum();
    let components = of_blocks[0].1.components;
    if of_blocks.iter().any(|(_, field)| field.components != components) {
        notes.add(format!("field {name} is skipped: it has rows of different lengths"));
        return Ok(None);
    }
    budget.take(8 * (n_cells as u64).saturating_mul(components as u64))?;
    let n_given: usize = of_blocks.iter().map(|(block, _)| block.cells.len()).sum();
    let mut place = vec![0usize; n_cells];
    let mut all: Option<Values> = None;
    let mut next = 0;
    for (block, field) in of_blocks {
        for (row, &cell) in block.cells.iter().enumerate() {
            place[cell as usize] = next + row;
        }
        next += block.cells.len();
        let is_one_type = match &mut all {
            None => {
                all = Some(field.values.clone());
                true
            }
            Some(all) => all.append(&field.values),
        };
        if !is_one_type {
            notes.add(format!("field {name} is skipped: it has numbers of several types"));
            return Ok(None);
        }
    }
    let Some(mut values) = all else { return Ok(None) };
    if n_given < n_cells {
        let zeros = Field { name: String::new(), components: 1, values: values.clone() };
        let mut zero = zeros.pick([0]).values;
        clear(&mut zero)?;
        (0..components).for_each(|_| {
            values.append(&zero);
        });
        let is_given: Vec<bool> = {
            let mut given = vec![false; n_cells];
            of_blocks
                .iter()
                .flat_map(|(block, _)| &block.cells)
                .for_each(|&cell| given[cell as usize] = true);
            given
        };
        place.iter_mut().zip(is_given).filter(|(_, given)| !given).for_each(|(place, _)| *place = n_given);
    }
    let stacked = Field { name: name.to_owned(), components, values };
    Ok(Some(stacked.pick(place)))
}

/// Sets all numbers to 0.
fn clear(values: &mut Values) -> Result<()> {
    match values {
        Values::I8(v) => v.fill(0),
        Values::U8(v) => v.fill(0),
        Values::I16(v) => v.fill(0),
        Values::U16(v) => v.fill(0),
        Values::I32(v) => v.fill(0),
        Values::U32(v) => v.fill(0),
        Values::I64(v) => v.fill(0),
        Values::U64(v) => v.fill(0),
        Values::F32(v) => v.fill(0.0),
        Values::F64(v) => v.fill(0.0),
        Values::Text(_) => return Err(Error::input("expected numbers, found texts")),
    }
    Ok(())
}
