//! Solutions: unnamed arrays on points or on cells of one kind.

use super::source::Source;
use super::{SECTIONS, SOLUTION};
use crate::base::{Error, Result};
use crate::mesh::{Field, Mesh, Values};

/// The arrays of one section.
pub(super) struct Solution {
    /// Index in [`SECTIONS`] of the entities with the values.
    pub(super) of: usize,
    pub(super) n_rows: usize,
    fields: Vec<Rows>,
}

/// An array: the number of components of a row in the mesh, and all values.
struct Rows {
    components: usize,
    values: Vec<f64>,
}

/// Maximum number of arrays: cells without values get NaN, so a file with few values could request any amount
/// of memory.
const MAX_ARRAYS: usize = 1000;

/// An array type, with its number in files.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    pub(super) number: i32,
    /// Number of components of a row in the mesh.
    pub(super) components: usize,
    /// For each number of a row in a 3D file, its component in the mesh.
    pub(super) places: &'static [usize],
    /// For each number of a row in a 2D file, its component in the mesh; components not listed are 0.
    places_2d: &'static [usize],
}

/// Scalars, vectors, symmetric tensors (stored in VTK's order), full tensors row by row.
pub(super) const KINDS: &[Kind] = &[
    Kind { number: 1, components: 1, places: &[0], places_2d: &[0] },
    Kind { number: 2, components: 3, places: &[0, 1, 2], places_2d: &[0, 1] },
    Kind { number: 3, components: 6, places: &[0, 3, 1, 5, 4, 2], places_2d: &[0, 3, 1] },
    Kind { number: 4, components: 9, places: &[0, 1, 2, 3, 4, 5, 6, 7, 8], places_2d: &[0, 1, 3, 4] },
];

impl Solution {
    /// Reads a section after its name.
    pub(super) fn read(source: &mut Source<'_>, of: usize, dim: usize) -> Result<Self> {
        let n_rows = source.count("rows of a solution", 0, 1)?;
        let n_fields = source.fixed_i32("the number of arrays")?;
        let n_fields = usize::try_from(n_fields).ok().filter(|&n| n <= MAX_ARRAYS).ok_or_else(|| {
            source
                .error(format!("expected 0 to {MAX_ARRAYS} arrays in a section, found {n_fields}"))
                .remedy("the file is damaged: write it again")
        })?;
        let mut kinds = Vec::with_capacity(n_fields);
        for _ in 0..n_fields {
            let number = source.fixed_i32("array type")?;
            let kind = KINDS.iter().find(|kind| i64::from(kind.number) == number).ok_or_else(|| {
                source
                    .error(format!("expected an array type from 1 to 4, found {number}"))
                    .remedy("the file is damaged: write it again")
            })?;
            kinds.push((kind, if dim == 2 { kind.places_2d } else { kind.places }));
        }
        let n_each: usize = kinds.iter().map(|(_, places)| places.len()).sum();
        let room = source.max_floats_left() / n_each.max(1);
        if n_rows > room {
            return Err(source
                .error(format!(
                    "{n_rows} rows of {n_each} values declared, but the remaining data can hold at most {room}"
                ))
                .remedy("the file is truncated or damaged: get a new copy"));
        }
        let zeros =
            |kind: &Kind| Rows { components: kind.components, values: vec![0.0; n_rows * kind.components] };
        let mut fields: Vec<Rows> = kinds.iter().map(|(kind, _)| zeros(kind)).collect();
        for row in 0..n_rows {
            for (field, (kind, places)) in fields.iter_mut().zip(&kinds) {
                for place in *places {
                    field.values[row * kind.components + place] = source.float("a value")?;
                }
            }
        }
        Ok(Self { of, n_rows, fields })
    }
}

/// Stores solutions in a mesh as arrays.
///
/// Fails if the number of rows of a solution differs from the number of points or cells.
pub(super) fn attach(mesh: &mut Mesh, solutions: &[Solution]) -> Result<()> {
    let places: Vec<Vec<usize>> = (0..SECTIONS.len()).map(|of| places_of(mesh, of)).collect();
    for solution in solutions {
        let n = places[solution.of].len();
        if n != solution.n_rows {
            let of = SECTIONS[solution.of].list.name;
            return Err(Error::input(format!(
                "has {} values on {of}, but the mesh has {n}",
                solution.n_rows
            ))
            .remedy("the files do not belong together: compute the solution again, or remove it"));
        }
    }
    let points = solutions.iter().filter(|s| SECTIONS[s.of].cells.is_none()).flat_map(|s| &s.fields);
    for (i, field) in points.enumerate() {
        mesh.set_point_field(field.named(array_name(i), field.values.clone()));
    }
    let mut known: Vec<(usize, usize)> = Vec::new();
    for solution in solutions.iter().filter(|s| SECTIONS[s.of].cells.is_some() && s.n_rows > 0) {
        for (i, field) in solution.fields.iter().enumerate() {
            // Arrays at the same position in different sections, with equal numbers of components, are one
            // array.
            let key = (i, field.components);
            let number = known.iter().position(|k| *k == key).unwrap_or_else(|| {
                known.push(key);
                known.len() - 1
            });
            put_on_cells(mesh, array_name(number), field, &places[solution.of]);
        }
    }
    Ok(())
}

impl Rows {
    fn named(&self, name: String, values: Vec<f64>) -> Field {
        Field { name, components: self.components, values: Values::F64(values) }
    }
}

/// Sets the rows of `places`, in a new array filled with NaN if there is none with this name.
fn put_on_cells(mesh: &mut Mesh, name: String, field: &Rows, places: &[usize]) {
    let n = field.components;
    if mesh.cell_field(&name).is_none() {
        mesh.set_cell_field(field.named(name.clone(), vec![f64::NAN; n * mesh.cells.len()]));
    }
    let ours = mesh.cell_data.iter_mut().find(|f| f.name == name && f.components == n);
    if let Some(Field { values: Values::F64(values), .. }) = ours {
        for (row, &place) in field.values.chunks_exact(n).zip(places) {
            values[place * n..][..n].copy_from_slice(row);
        }
    }
}

/// The indices in a mesh of the points or cells of a section.
pub(super) fn places_of(mesh: &Mesh, of: usize) -> Vec<usize> {
    match SECTIONS[of].cells {
        None => (0..mesh.points.len()).collect(),
        Some((kind, _)) => (0..mesh.cells.len()).filter(|&i| mesh.cells.kinds()[i] == kind).collect(),
    }
}

/// The name of solution array `i`, counted from 0.
fn array_name(i: usize) -> String {
    if i == 0 { SOLUTION.to_owned() } else { format!("{SOLUTION}_{}", i + 1) }
}
