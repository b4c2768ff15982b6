//! The arrays by which a mesh can be coloured: its quality, its labels, and every array of numbers on points
//! and cells.

use std::collections::{BTreeMap, BTreeSet};

use motet::Mesh;
use motet::base::CellId;
use motet::mesh::{Field, Labels};
use serde::Serialize;

use crate::codec::{Block, Kind};
use crate::skin::NONE;

/// Name of the array that is computed here.
pub(crate) const EAS: &str = "EAS quality";
/// Above this number, labels cannot be distinguished by colour.
const MAX_LABELS: usize = 64;
/// The code of a missing value among packed ones.
const MISSING: u32 = 65_535;
/// Values are clamped to this size, which stays within the range of WebGL's numbers.
const MAX_VALUE: f64 = 1e37;

/// Whether values belong to cells or points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Place {
    Cell,
    Point,
}

/// Identifies an array on the page.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub(crate) struct Key {
    pub(crate) name: String,
    pub(crate) on: Place,
    /// Whether the values are labels, each with a colour of its own.
    pub(crate) is_label: bool,
}

/// An array of one frame: a number for each point or cell, NaN where there is none.
#[derive(Clone, Debug)]
pub(crate) struct Array {
    pub(crate) key: Key,
    pub(crate) names: BTreeMap<i32, String>,
    pub(crate) values: Vec<f64>,
    /// Whether triangles of the skin take their value from the surface cell rather than the volume cell.
    pub(crate) is_of_surface: bool,
}

impl Array {
    /// The value of a triangle of the skin, given its volume cell and its surface cell.
    pub(crate) fn of_triangle(&self, [volume, surface]: [u32; 2]) -> f64 {
        let first = if self.is_of_surface { surface } else { volume };
        let cell = if first == NONE && !self.key.is_label { volume.min(surface) } else { first };
        self.values.get(cell as usize).copied().unwrap_or(f64::NAN)
    }
}

/// Every array of the mesh that holds numbers, with EAS and labels first.
pub(crate) fn of(mesh: &Mesh, eas: &[f32]) -> Vec<Array> {
    let mut arrays = Vec::new();
    if eas.iter().any(|q| !q.is_nan()) {
        let values = eas.iter().map(|&q| f64::from(q)).collect();
        arrays.push(array(EAS, Place::Cell, false, values));
    }
    let (regions, patches) = (mesh.regions(), mesh.patches());
    arrays.extend(regions.as_ref().map(|labels| label_array("region", mesh, 3, labels)));
    arrays.extend(patches.as_ref().map(|labels| label_array("patch", mesh, 2, labels)));
    let is_label =
        |name: &str| [&regions, &patches].iter().any(|l| l.as_ref().is_some_and(|l| l.array == name));
    for field in mesh.cell_data.iter().filter(|f| !is_label(&f.name) && f.name != "eas") {
        arrays.extend(of_cells(mesh, field));
    }
    for field in &mesh.point_data {
        arrays.extend(magnitudes(field).map(|values| array(&field.name, Place::Point, false, values)));
    }
    arrays
}

fn array(name: &str, on: Place, is_label: bool, values: Vec<f64>) -> Array {
    let key = Key { name: name.to_owned(), on, is_label };
    Array { key, names: BTreeMap::new(), values, is_of_surface: false }
}

fn label_array(name: &str, mesh: &Mesh, dim: usize, labels: &Labels) -> Array {
    let value = |(&kind, &id): (&motet::mesh::CellKind, &i32)| {
        if kind.dim() == Some(dim) { f64::from(id) } else { f64::NAN }
    };
    let values = mesh.cells.kinds().iter().zip(&labels.ids).map(value).collect();
    let is_label = labels.used().len() <= MAX_LABELS;
    Array {
        names: labels.names.clone(),
        is_of_surface: dim == 2,
        ..array(name, Place::Cell, is_label, values)
    }
}

/// A cell array; one with few distinct integers, such as `body`, is taken for labels.
fn of_cells(mesh: &Mesh, field: &Field) -> Option<Array> {
    let values = magnitudes(field)?;
    let is_of_surface = is_of_surface(mesh, &values);
    let is_label = field.components == 1 && field.values.is_integer() && has_few(&values);
    Some(Array { is_of_surface, ..array(&field.name, Place::Cell, is_label, values) })
}

/// Scalars as they are, the norms of rows with several components; `None` for texts.
fn magnitudes(field: &Field) -> Option<Vec<f64>> {
    let values = field.values.to_f64()?;
    match field.components {
        0 => None,
        1 => Some(values),
        n => Some(values.chunks(n).map(|row| row.iter().map(|x| x * x).sum::<f64>().sqrt()).collect()),
    }
}

fn has_few(values: &[f64]) -> bool {
    let mut seen = BTreeSet::new();
    values.iter().all(|x| {
        seen.insert(*x as i64);
        seen.len() <= 24
    })
}

/// Whether an array varies on surface cells but not on volume cells.
fn is_of_surface(mesh: &Mesh, values: &[f64]) -> bool {
    let says_something = |dim: usize| {
        let cells = (0..values.len()).filter(|&i| mesh.cells.kind(CellId::new(i)).dim() == Some(dim));
        let mut numbers = cells.map(|i| values[i]).filter(|x| !x.is_nan());
        numbers.next().is_some_and(|first| numbers.any(|x| x != first))
    };
    let has = |dim| mesh.cells.kinds().iter().any(|kind| kind.dim() == Some(dim));
    !has(3) || (has(2) && says_something(2) && !says_something(3))
}

/// Values packed into 16 bits, `low + step * n`, with one code for missing ones.
#[derive(Clone, Debug)]
pub(crate) struct Packed {
    pub(crate) block: Block,
    pub(crate) low: f64,
    pub(crate) high: f64,
    pub(crate) step: f64,
}

/// Packs values, integers exactly where they fit; `None` where there are no numbers.
pub(crate) fn pack(on: Place, values: &[f64]) -> Option<Packed> {
    let numbers = || values.iter().filter(|x| x.is_finite()).map(|x| x.clamp(-MAX_VALUE, MAX_VALUE));
    let low = numbers().reduce(f64::min)?;
    let high = numbers().reduce(f64::max)?;
    let is_whole = high - low < f64::from(MISSING) && numbers().all(|x| x.fract() == 0.0);
    let step = if is_whole || high == low { 1.0 } else { (high - low) / f64::from(MISSING - 1) };
    let code = |&x: &f64| match x.is_finite() {
        true => (((x.clamp(-MAX_VALUE, MAX_VALUE) - low) / step).round() as u32).min(MISSING - 1),
        false => MISSING,
    };
    let codes: Vec<u32> = values.iter().map(code).collect();
    let kind = if on == Place::Point { Kind::Steps } else { Kind::Plain };
    Some(Packed { block: Block::column(kind, &codes), low, high, step })
}

#[cfg(test)]
mod tests {
    use motet::mesh::shapes::box_grid;

    use super::*;
    use crate::codec::tests::unpacked;

    #[test]
    fn values_come_back_to_a_part_in_sixty_thousand_and_whole_ones_exactly() {
        let back = |values: &[f64]| {
            let packed = pack(Place::Point, values).unwrap();
            let number = |row: Vec<u32>| packed.low + packed.step * f64::from(row[0]);
            unpacked(&packed.block).into_iter().map(number).collect::<Vec<f64>>()
        };
        assert_eq!(back(&[-3.0, 7.0, 60_000.0]), [-3.0, 7.0, 60_000.0]);
        for (a, b) in back(&[0.1, -0.7, 12.3]).iter().zip([0.1, -0.7, 12.3]) {
            assert!((a - b).abs() <= 13.0 / 65_534.0);
        }
        assert_eq!(back(&[5.5]), [5.5]);
    }

    #[test]
    fn what_is_no_number_is_marked_and_what_is_too_large_is_bounded() {
        assert!(pack(Place::Cell, &[f64::NAN, f64::INFINITY]).is_none());
        assert!(pack(Place::Cell, &[]).is_none());
        let packed = pack(Place::Cell, &[1.0, f64::NAN, 1e300, -1e300]).unwrap();
        assert_eq!(unpacked(&packed.block)[1], [MISSING]);
        assert!(packed.step.is_finite() && packed.high == MAX_VALUE);
    }

    #[test]
    fn labels_vectors_and_texts_are_distinguished() {
        let mut mesh = box_grid([1; 3], [[0.0; 3], [1.0; 3]]);
        let n = mesh.points.len();
        mesh.set_point_field(Field::vectors("u", &vec![[3.0, 4.0, 0.0]; n]));
        mesh.set_point_field(Field::scalars("text", vec![String::new(); n]));
        let n = mesh.cells.len();
        mesh.set_cell_field(Field::scalars("body", vec![1i32; n]));
        let arrays = of(&mesh, &vec![0.5; n]);
        let names: Vec<&str> = arrays.iter().map(|a| a.key.name.as_str()).collect();
        assert_eq!(names, [EAS, "region", "patch", "body", "u"]);
        assert!(arrays[1].key.is_label && arrays[2].is_of_surface && arrays[3].key.is_label);
        assert!(arrays[4].values.iter().all(|&x| x == 5.0));
    }
}
