//! How well arrays were transferred: their ranges, and their integrals over each region, before and after.

use std::collections::BTreeMap;

use super::rule::is_averageable;
use super::{Rule, Rules};
use crate::base::{Threads, VertexId};
use crate::geometry::tet;
use crate::mesh::{Field, LabelPlaces, Mesh, Values};

/// The range and the integrals of an array of real numbers before and after a change.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct FieldLedger {
    /// The name of the array.
    pub name: String,
    /// Whether it has its rows on points or on cells.
    pub on: On,
    /// The rule by which it was transferred.
    pub rule: Rule,
    /// Smallest and largest value before the change; of arrays with several components, of the lengths of the
    /// rows. NaN does not count; `None` if there is no other value.
    pub range_before: Option<[f64; 2]>,
    /// Smallest and largest value after the change, as in `range_before`.
    pub range_after: Option<[f64; 2]>,
    /// One entry for each region of the tets, by rising label.
    pub regions: Vec<FieldIntegral>,
}

/// Where an array has its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum On {
    /// One row for each point; values are linear in each tet.
    Points,
    /// One row for each cell; values are constant in each tet.
    Cells,
}

/// The integral of an array over the tets of one region. Tets of either orientation count with positive
/// volume.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct FieldIntegral {
    /// The label of the region; 0 for tets without one.
    pub region: i32,
    /// The integral of each component before the change.
    pub before: Vec<f64>,
    /// The integral of each component after the change.
    pub after: Vec<f64>,
    /// The change of the integral, relative to the integral of the magnitude of the values (the larger one of
    /// before and after).
    pub deviation: f64,
}

impl FieldLedger {
    /// The largest deviation of its regions; NaN if one of them is NaN.
    pub fn deviation(&self) -> f64 {
        let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
        self.regions.iter().map(|r| r.deviation).fold(0.0, larger)
    }
}

/// Compares each array of real numbers that both meshes have, first those on points, then those on cells, in
/// their order. `rules` are those by which they were transferred. Takes one pass over the tets of each mesh,
/// and one more for each array.
pub fn field_ledger(before: &Mesh, after: &Mesh, rules: &Rules, threads: &Threads) -> Vec<FieldLedger> {
    let sources = [
        (On::Points, &before.point_data, &after.point_data),
        (On::Cells, &before.cell_data, &after.cell_data),
    ];
    let pairs = sources.into_iter().flat_map(|(on, old, new)| {
        old.iter()
            .filter_map(move |old| new.iter().find(|new| is_carried(old, new)).map(|new| (on, old, new)))
    });
    let pairs: Vec<_> = pairs.collect();
    if pairs.is_empty() {
        return Vec::new();
    }
    let tets = threads.each(vec![before, after], Tets::of);
    let ledger = |&(on, old, new): &(On, &Field, &Field)| {
        let (old_sums, new_sums) = threads.join(|| tets[0].sums(on, old), || tets[1].sums(on, new));
        FieldLedger {
            name: old.name.clone(),
            on,
            rule: match on {
                On::Points => rules.points.get(&old.name).copied().unwrap_or_else(|| Rule::of_points(old)),
                On::Cells => rules.cells.get(&old.name).copied().unwrap_or_else(|| Rule::of_cells(old)),
            },
            range_before: range(old),
            range_after: range(new),
            regions: integrals(old.components, &old_sums, &new_sums),
        }
    };
    pairs.iter().map(ledger).collect()
}

fn is_carried(old: &Field, new: &Field) -> bool {
    old.name == new.name && old.components == new.components && is_averageable(old) && is_averageable(new)
}

/// The tets of a mesh, with what integration needs.
struct Tets {
    /// The cell of each tet, its vertices, its volume and the index of its region.
    tets: Vec<(usize, [VertexId; 4], f64, usize)>,
    /// The index of each region.
    places: LabelPlaces,
}

/// The integrals over each region: of each component, then of the magnitude of the rows.
type Sums = BTreeMap<i32, Vec<f64>>;

impl Tets {
    fn of(mesh: &Mesh) -> Self {
        let labels = mesh.regions();
        let label = |cell: usize| labels.as_ref().map_or(0, |labels| labels.ids[cell]);
        let mut places = LabelPlaces::default();
        let mut tets = Vec::new();
        for (cell, vertices) in mesh.cells.tets() {
            let volume = tet::volume(vertices.map(|v| mesh.points[v.index()])).abs();
            tets.push((cell.index(), vertices, volume, places.of(label(cell.index()))));
        }
        Self { tets, places }
    }

    fn sums(&self, on: On, field: &Field) -> Sums {
        match &field.values {
            Values::F64(values) => self.sums_of(on, field.components, |i| values[i]),
            Values::F32(values) => self.sums_of(on, field.components, |i| values[i].into()),
            _ => Sums::new(),
        }
    }

    fn sums_of(&self, on: On, components: usize, value: impl Fn(usize) -> f64) -> Sums {
        let n = components + 1;
        let mut sums = vec![Sum::default(); n * self.places.iter().len()];
        // Sums over one tet: of each component, then of the magnitude.
        let mut held = vec![0.0; n];
        for &(cell, vertices, volume, place) in &self.tets {
            held.fill(0.0);
            let mut add = |row: usize| {
                let mut squared = 0.0;
                for (k, held) in held[..components].iter_mut().enumerate() {
                    let value = value(row * components + k);
                    *held += value;
                    squared += value * value;
                }
                held[components] += squared.sqrt();
            };
            let share = match on {
                On::Points => {
                    vertices.into_iter().for_each(|v| add(v.index()));
                    0.25 * volume
                }
                On::Cells => {
                    add(cell);
                    volume
                }
            };
            sums[place * n..][..n].iter_mut().zip(&held).for_each(|(sum, held)| sum.add(share * held));
        }
        let row = |place: usize| sums[place * n..][..n].iter().map(Sum::value).collect();
        self.places.iter().map(|(region, place)| (region, row(place))).collect()
    }
}

/// A compensated sum, which adds up rounding errors separately, so that a million terms are as accurate as
/// ten (Knuth's two-sum).
#[derive(Clone, Copy, Default)]
struct Sum {
    sum: f64,
    rest: f64,
}

impl Sum {
    #[inline]
    fn add(&mut self, x: f64) {
        let sum = self.sum + x;
        let added = sum - self.sum;
        self.rest += (self.sum - (sum - added)) + (x - added);
        self.sum = sum;
    }

    fn value(&self) -> f64 {
        // If the sum is infinite, the rest is NaN.
        if self.sum.is_finite() { self.sum + self.rest } else { self.sum }
    }
}

fn integrals(components: usize, before: &Sums, after: &Sums) -> Vec<FieldIntegral> {
    let mut regions: Vec<i32> = before.keys().chain(after.keys()).copied().collect();
    regions.sort_unstable();
    regions.dedup();
    let nothing = vec![0.0; components + 1];
    let entry = |region: i32| {
        let [before, after] = [before, after].map(|sums| sums.get(&region).unwrap_or(&nothing));
        let squared: f64 = (0..components).map(|k| (after[k] - before[k]).powi(2)).sum();
        let size = before[components].max(after[components]);
        FieldIntegral {
            region,
            before: before[..components].to_vec(),
            after: after[..components].to_vec(),
            deviation: if squared == 0.0 { 0.0 } else { squared.sqrt() / size },
        }
    };
    regions.into_iter().map(entry).collect()
}

fn range(field: &Field) -> Option<[f64; 2]> {
    match &field.values {
        Values::F64(values) => range_of(field.components, values.iter().copied()),
        Values::F32(values) => range_of(field.components, values.iter().map(|&x| x.into())),
        _ => None,
    }
}

fn range_of(components: usize, mut values: impl ExactSizeIterator<Item = f64>) -> Option<[f64; 2]> {
    let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
    let n_rows = values.len() / components.max(1);
    for _ in 0..n_rows {
        let value = match components {
            1 => values.next()?,
            n => values.by_ref().take(n).map(|x| x * x).sum::<f64>().sqrt(),
        };
        (least, largest) = (least.min(value), largest.max(value));
    }
    (least <= largest).then_some([least, largest])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::box_grid;

    #[test]
    fn integrals_of_what_is_known_are_right() {
        let mut mesh = box_grid([3; 3], [[0.0; 3], [1.0, 2.0, 0.5]]);
        let (points, n_cells) = (mesh.points.clone(), mesh.cells.len());
        mesh.set_point_field(Field::vectors("place", &points));
        mesh.set_point_field(Field::scalars(
            "single",
            points.iter().map(|p| p[0] as f32).collect::<Vec<_>>(),
        ));
        mesh.set_point_field(Field::scalars("number", vec![1; points.len()]));
        mesh.set_cell_field(Field::scalars("two", vec![-2.0; n_cells]));
        let mut later = mesh.clone();
        later.set_cell_field(Field::scalars("two", vec![-3.0; n_cells]));
        let ledger = field_ledger(&mesh, &later, &Rules::default(), &Threads::single());
        assert_eq!(ledger.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(), ["place", "single", "two"]);
        let region = |i: usize| {
            assert_eq!(ledger[i].regions.len(), 1);
            &ledger[i].regions[0]
        };
        let close = |a: f64, b: f64| (a - b).abs() < 1e-7;
        assert!(region(0).before.iter().zip([0.5, 1.0, 0.25]).all(|(&a, b)| close(a, b)), "{:?}", region(0));
        assert_eq!((region(0).deviation, ledger[0].rule), (0.0, Rule::Interpolate));
        let [least, largest] = ledger[0].range_before.unwrap();
        assert!(least == 0.0 && close(largest, 5.25f64.sqrt()));
        assert!(close(region(1).after[0], 0.5) && ledger[1].range_after == Some([0.0, 1.0]));
        assert_eq!((ledger[2].on, ledger[2].rule), (On::Cells, Rule::Conserve));
        assert!(close(region(2).before[0], -2.0) && close(region(2).after[0], -3.0));
        assert!(close(ledger[2].deviation(), 1.0 / 3.0));
    }

    #[test]
    fn what_is_no_number_is_reported_as_such() {
        let mut mesh = box_grid([1; 3], [[0.0; 3], [1.0; 3]]);
        let mut values = vec![1.0; mesh.cells.len()];
        values[0] = f64::NAN;
        mesh.set_cell_field(Field::scalars("odd", values));
        let ledger = field_ledger(&mesh, &mesh, &Rules::default(), &Threads::single());
        assert_eq!(ledger[0].range_before, Some([1.0, 1.0]));
        assert!(ledger[0].deviation().is_nan());
        mesh.set_cell_field(Field::scalars("odd", vec![f64::INFINITY; mesh.cells.len()]));
        let ledger = field_ledger(&mesh, &mesh, &Rules::default(), &Threads::single());
        assert_eq!(ledger[0].regions[0].before, [f64::INFINITY]);
    }

    #[test]
    fn many_terms_add_up_without_loss() {
        let mut sum = Sum::default();
        (0..1_000_000).for_each(|_| sum.add(0.1));
        assert!((sum.value() - 1e5).abs() < 1e-9);
        sum.add(1e20);
        sum.add(-1e20);
        assert!((sum.value() - 1e5).abs() < 1e-9);
    }
}
