//! Resolves the expressions by which users name arrays of a mesh, and parts of them.
//!
//! | expression | meaning |
//! |---|---|
//! | `p` | the values of `p`; of an array with several components the root of the sum of their squares |
//! | <code>&#124;v&#124;</code> | that root in any case: for scalars the absolute value |
//! | `v:x` `v:y` `v:z` | one component |
//! | `v[3]` | one component, counted from 0 |
//!
//! An array whose name equals the whole expression takes precedence, and point arrays take precedence over
//! cell arrays.

use crate::base::{Error, Point, Result};
use crate::mesh::{Field, Mesh};

/// Where the rows of an array live.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum On {
    Points,
    Cells,
}

/// Which part of a row is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Part {
    Whole,
    Magnitude,
    Component(usize),
}

/// One number for each point or cell.
pub(super) struct Column {
    pub(super) on: On,
    pub(super) values: Vec<f64>,
}

/// What an expression refers to in a mesh.
struct Found<'a> {
    on: On,
    part: Part,
    field: &'a Field,
    values: Vec<f64>,
}

/// Returns one number for each point or cell.
pub(super) fn column(mesh: &Mesh, word: &str) -> Result<Column> {
    let found = find(mesh, word)?;
    let n = found.field.components.max(1);
    let row = |row: &[f64]| match found.part {
        Part::Component(k) => row[k],
        Part::Whole if n == 1 => row[0],
        _ => row.iter().map(|x| x * x).sum::<f64>().sqrt(),
    };
    Ok(Column { on: found.on, values: found.values.chunks_exact(n).map(row).collect() })
}

/// Returns for each component that the expression refers to one number per point.
pub(super) fn point_columns(mesh: &Mesh, word: &str) -> Result<Vec<Vec<f64>>> {
    let found = find(mesh, word)?;
    check_on_points(mesh, &found, word)?;
    let n = found.field.components.max(1);
    let component = |k: usize| found.values.iter().skip(k).step_by(n).copied().collect();
    match found.part {
        Part::Component(k) => Ok(vec![component(k)]),
        Part::Whole => Ok((0..n).map(component).collect()),
        Part::Magnitude => Ok(vec![column(mesh, word)?.values]),
    }
}

/// Returns a vector for each point.
pub(super) fn point_vectors(mesh: &Mesh, word: &str) -> Result<Vec<Point>> {
    let found = find(mesh, word)?;
    check_on_points(mesh, &found, word)?;
    match found.part {
        Part::Whole => found.field.to_vectors(),
        _ => Err(Error::input(format!("`{word}` is not a velocity"))
            .remedy("give a point array with three components, not a part of one")),
    }
}

fn check_on_points(mesh: &Mesh, found: &Found<'_>, word: &str) -> Result<()> {
    match found.on {
        On::Points => Ok(()),
        On::Cells => {
            Err(Error::input(format!("`{word}` is a cell array, but derivatives need values at points"))
                .remedy(format!("average it to the points; point arrays: {}", names(&mesh.point_data))))
        }
    }
}

fn find<'a>(mesh: &'a Mesh, word: &str) -> Result<Found<'a>> {
    let readings = [Some((word, Part::Whole)), magnitude(word), component(word)];
    let found = readings.into_iter().flatten().find_map(|(name, part)| {
        let (on, field) = named(mesh, name)?;
        Some((on, field, part))
    });
    let Some((on, field, part)) = found else { return Err(unknown(mesh, word)) };
    if let Part::Component(k) = part
        && k >= field.components
    {
        return Err(Error::input(format!(
            "`{word}`: {} has {} component(s), counted from 0",
            field.name, field.components
        )));
    }
    let Some(values) = field.values.to_f64() else {
        return Err(Error::input(format!("the array `{}` contains strings, not numbers", field.name)));
    };
    Ok(Found { on, part, field, values })
}

fn named<'a>(mesh: &'a Mesh, name: &str) -> Option<(On, &'a Field)> {
    let on_points = mesh.point_field(name).map(|field| (On::Points, field));
    on_points.or_else(|| mesh.cell_field(name).map(|field| (On::Cells, field)))
}

fn magnitude(word: &str) -> Option<(&str, Part)> {
    let name = word.strip_prefix('|')?.strip_suffix('|')?;
    Some((name, Part::Magnitude))
}

fn component(word: &str) -> Option<(&str, Part)> {
    if let Some((name, index)) = word.strip_suffix(']').and_then(|rest| rest.rsplit_once('[')) {
        return Some((name, Part::Component(index.trim().parse().ok()?)));
    }
    let (name, axis) = word.rsplit_once(':')?;
    let k = ["x", "y", "z"].iter().position(|letter| *letter == axis)?;
    Some((name, Part::Component(k)))
}

fn unknown(mesh: &Mesh, word: &str) -> Error {
    Error::input(format!("the mesh has no array `{word}`")).remedy(format!(
        "point arrays: {}; cell arrays: {}",
        names(&mesh.point_data),
        names(&mesh.cell_data)
    ))
}

fn names(fields: &[Field]) -> String {
    match fields {
        [] => "none".to_owned(),
        _ => fields.iter().map(|field| field.name.as_str()).collect::<Vec<_>>().join(", "),
    }
}
