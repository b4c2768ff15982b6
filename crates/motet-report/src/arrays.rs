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
/// Names of the arrays of labels.
pub(crate) const REGION: &str = "region";
pub(crate) const PATCH: &str = "patch";
/// At how many points or triangles of the skin, evenly chosen, the page has vectors.
const MAX_VECTORS: usize = 1000;
/// The code of the component 0 among packed vectors; codes go up to twice this.
const ZERO: u32 = 32_767;
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
    /// Whether the values are the lengths of vectors.
    pub(crate) is_vector: bool,
}

/// An array of one frame: a number for each point or cell, NaN where there is none.
#[derive(Clone, Debug)]
pub(crate) struct Array {
    pub(crate) key: Key,
    pub(crate) names: BTreeMap<i32, String>,
    pub(crate) values: Vec<f64>,
    /// The vectors whose lengths the values are; empty where they are not.
    pub(crate) vectors: Vec<[f64; 3]>,
    /// Whether triangles of the skin take their value from the surface cell rather than the volume cell.
    pub(crate) is_of_surface: bool,
}

impl Array {
    /// The value of a triangle of the skin, given its volume cell and its surface cell.
    pub(crate) fn of_triangle(&self, [volume, surface]: [u32; 2]) -> f64 {
        self.values.get(self.cell_of_triangle([volume, surface])).copied().unwrap_or(f64::NAN)
    }

    /// The vector of a triangle of the skin.
    pub(crate) fn vector_of_triangle(&self, cells: [u32; 2]) -> [f64; 3] {
        self.vectors.get(self.cell_of_triangle(cells)).copied().unwrap_or([f64::NAN; 3])
    }

    fn cell_of_triangle(&self, [volume, surface]: [u32; 2]) -> usize {
        let first = if self.is_of_surface { surface } else { volume };
        if first == NONE && !self.key.is_label { volume.min(surface) as usize } else { first as usize }
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
    arrays.extend(regions.as_ref().map(|labels| label_array(REGION, mesh, 3, labels)));
    arrays.extend(patches.as_ref().map(|labels| label_array(PATCH, mesh, 2, labels)));
    let is_label =
        |name: &str| [&regions, &patches].iter().any(|l| l.as_ref().is_some_and(|l| l.array == name));
    for field in mesh.cell_data.iter().filter(|f| !is_label(&f.name) && f.name != "eas") {
        arrays.extend(of_cells(mesh, field));
    }
    for field in &mesh.point_data {
        arrays.extend(magnitudes(field).map(|values| of_field(field, Place::Point, false, values)));
    }
    arrays
}

fn array(name: &str, on: Place, is_label: bool, values: Vec<f64>) -> Array {
    let key = Key { name: name.to_owned(), on, is_label, is_vector: false };
    Array { key, names: BTreeMap::new(), values, vectors: Vec::new(), is_of_surface: false }
}

fn of_field(field: &Field, on: Place, is_label: bool, values: Vec<f64>) -> Array {
    let mut array = array(&field.name, on, is_label, values);
    if field.components == 3 {
        array.key.is_vector = true;
        array.vectors = field.values.to_f64().map(|all| all.as_chunks::<3>().0.to_vec()).unwrap_or_default();
    }
    array
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
    Some(Array { is_of_surface, ..of_field(field, Place::Cell, is_label, values) })
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

/// The places among `n` at which the page has vectors.
pub(crate) fn sample(n: usize) -> impl Iterator<Item = usize> {
    let count = n.min(MAX_VECTORS);
    (0..count).map(move |i| i * n / count)
}

/// Packs vectors into 16 bits a component, `step * (n - ZERO)`, with one code for missing ones; returns the
/// step, too. `None` where there is no vector other than zero.
pub(crate) fn pack_vectors(vectors: &[[f64; 3]]) -> Option<(Block, f64)> {
    let is_there = |v: &&[f64; 3]| v.iter().all(|x| x.is_finite());
    let bounded = |x: f64| x.clamp(-MAX_VALUE, MAX_VALUE);
    let longest = vectors.iter().filter(is_there).flatten().map(|&x| bounded(x).abs()).fold(0.0, f64::max);
    let step = longest / f64::from(ZERO);
    let code = |x: f64| (bounded(x) / step + f64::from(ZERO)).round() as u32;
    let row = |v: &[f64; 3]| if is_there(&v) { v.map(code) } else { [MISSING; 3] };
    (step > 0.0).then(|| (Block::of(Kind::Plain, &vectors.iter().map(row).collect::<Vec<_>>()), step))
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
        let is_vector: Vec<bool> = arrays.iter().map(|a| a.key.is_vector).collect();
        assert_eq!(is_vector, [false, false, false, false, true]);
    }

    #[test]
    fn vectors_come_back_to_a_part_in_thirty_thousand_of_the_longest() {
        let vectors = [[3.0, -4.0, 0.0], [f64::NAN, 1.0, 1.0], [0.001, 0.0, -2.5]];
        let (block, step) = pack_vectors(&vectors).unwrap();
        let rows = unpacked(&block);
        for (row, vector) in [(&rows[0], vectors[0]), (&rows[2], vectors[2])] {
            for (code, x) in row.iter().zip(vector) {
                assert!((step * (f64::from(*code) - f64::from(ZERO)) - x).abs() <= 4.0 / 65_534.0);
            }
        }
        assert_eq!(rows[1], [MISSING; 3]);
        assert!(pack_vectors(&[[0.0; 3]]).is_none());
        assert_eq!(sample(3).collect::<Vec<_>>(), [0, 1, 2]);
        assert!(sample(10 * MAX_VECTORS).eq((0..MAX_VECTORS).map(|i| 10 * i)));
        assert_eq!(sample(0).count(), 0);
    }
}
