//! Variables over time as arrays, at the last step.

use super::source::Source;
use crate::base::Result;
use crate::io::format::Notes;
use crate::io::memory_budget::MemoryBudget;
use crate::mesh::{Field, Values};

/// Endings of the names of the three coordinates of a vector.
const COORDINATES: [[&str; 3]; 2] = [["X", "Y", "Z"], ["x", "y", "z"]];

/// Reads the variables of points.
pub(super) fn of_points(source: &Source<'_>, n_points: usize, notes: &Notes) -> Result<Vec<Field>> {
    let names = source.texts("name_nod_var")?;
    let mut fields = Vec::new();
    // Older files have all variables in one array.
    let all = source.last("vals_nod_var")?.and_then(|values| values.to_f64());
    for (i, name) in names.into_iter().enumerate() {
        let values = match &all {
            Some(all) => {
                all.get(i * n_points..).and_then(|rest| rest.get(..n_points)).map(|v| v.to_vec().into())
            }
            None => source.last(&format!("vals_nod_var{}", i + 1))?,
        };
        add(&mut fields, name, values, n_points, notes);
    }
    Ok(with_vectors(fields))
}

/// Reads the variables of elements; the cells of each block are a range. Cells without values get zeros.
pub(super) fn of_cells(
    source: &Source<'_>,
    blocks: &[(usize, std::ops::Range<usize>)],
    n_cells: usize,
    file_bytes: u64,
    notes: &Notes,
) -> Result<Vec<Field>> {
    let mut fields = Vec::new();
    // A variable without values takes no bytes of the file.
    let budget = MemoryBudget::of(file_bytes);
    for (i, name) in source.texts("name_elem_var")?.into_iter().enumerate() {
        budget.take(8 * n_cells as u64)?;
        let (mut values, mut is_single) = (vec![0.0; n_cells], true);
        let mut is_whole = true;
        for (block, cells) in blocks {
            let Some(own) = source.last(&format!("vals_elem_var{}eb{block}", i + 1))? else { continue };
            is_single &= matches!(own, Values::F32(_));
            match own.to_f64().filter(|own| own.len() == cells.len()) {
                Some(own) => values[cells.clone()].copy_from_slice(&own),
                None => is_whole = false,
            }
        }
        let values = match is_single {
            true => Values::F32(values.into_iter().map(|x| x as f32).collect()),
            false => Values::F64(values),
        };
        add(&mut fields, name, is_whole.then_some(values), n_cells, notes);
    }
    Ok(with_vectors(fields))
}

fn add(fields: &mut Vec<Field>, name: String, values: Option<Values>, n_rows: usize, notes: &Notes) {
    match values.filter(|values| values.len() == n_rows && !matches!(values, Values::Text(_))) {
        Some(values) if fields.iter().all(|f| f.name != name) => {
            fields.push(Field { name, components: 1, values })
        }
        _ => notes.add(format!("variable {name} is skipped: it does not have {n_rows} values")),
    }
}

/// Joins three variables in succession that are the coordinates of a vector.
fn with_vectors(fields: Vec<Field>) -> Vec<Field> {
    let mut joined: Vec<Field> = Vec::new();
    let mut rest = &fields[..];
    while let [first, tail @ ..] = rest {
        if let [x, y, z, ..] = rest
            && let Some(name) = vector_name([&x.name, &y.name, &z.name])
            && let Some(values) = interleaved([&x.values, &y.values, &z.values])
        {
            joined.push(Field { name, components: 3, values });
            rest = &rest[3..];
        } else {
            joined.push(first.clone());
            rest = tail;
        }
    }
    joined
}

fn vector_name(names: [&String; 3]) -> Option<String> {
    COORDINATES.iter().find_map(|endings| {
        let stems: Vec<&str> =
            names.iter().zip(endings).filter_map(|(name, end)| name.strip_suffix(end)).collect();
        let stem = stems.first()?.trim_end_matches('_');
        (stems.len() == 3 && stems.iter().all(|s| *s == stems[0]) && !stem.is_empty())
            .then(|| stem.to_owned())
    })
}

fn interleaved(values: [&Values; 3]) -> Option<Values> {
    fn rows<T: Copy>([x, y, z]: [&Vec<T>; 3]) -> Vec<T> {
        x.iter().zip(y).zip(z).flat_map(|((&x, &y), &z)| [x, y, z]).collect()
    }
    match values {
        [Values::F64(x), Values::F64(y), Values::F64(z)] => Some(Values::F64(rows([x, y, z]))),
        [Values::F32(x), Values::F32(y), Values::F32(z)] => Some(Values::F32(rows([x, y, z]))),
        _ => None,
    }
}
