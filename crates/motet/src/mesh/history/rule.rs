//! How the values of a field are transferred where the mesh changed.

use std::collections::BTreeMap;

use crate::base::{Error, Result};
use crate::mesh::{Field, Mesh, Values};

/// How the values of a field are transferred where the mesh changed. Where it did not, they are copied bit
/// for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Rule {
    /// For points: by the [row for quadratic fields](super::Origins::quadratic) if there is one, otherwise
    /// linear in each old tet. Fields that are linear in space are reproduced to the last digits. Other
    /// values lie between the surrounding values, and differ from the linear value by no more than the spread
    /// of the values at the tet's vertices.
    Interpolate,
    /// For points: linear in each old tet. Fields that are linear in space are reproduced to the last digits;
    /// other values lie between those at its vertices.
    Linear,
    /// For cells: the mean over what a new tet overlaps. The integral over each region is conserved (up to
    /// its [`deviation`](super::RegionLedger::deviation)), constants are reproduced to the bit, and other
    /// values lie between those they come from.
    Conserve,
    /// The value of the [main](super::Row::main) old entity, as a rule that with the largest share: for ids,
    /// names and directions, which have no mean.
    Inherit,
    /// The array is left out.
    Drop,
}

impl Rule {
    /// The default rule for a point array: floats are interpolated; whole numbers, texts and directions are
    /// inherited.
    pub fn of_points(field: &Field) -> Self {
        if is_averageable(field) && !is_direction(field) { Self::Interpolate } else { Self::Inherit }
    }

    /// The default rule for a cell array: floats are conserved; whole numbers, texts and directions are
    /// inherited.
    pub fn of_cells(field: &Field) -> Self {
        if is_averageable(field) && !is_direction(field) { Self::Conserve } else { Self::Inherit }
    }
}

/// Rules for arrays by their names; all other arrays get [`Rule::of_points`] and [`Rule::of_cells`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Rules {
    /// The rules of point arrays.
    pub points: BTreeMap<String, Rule>,
    /// The rules of cell arrays.
    pub cells: BTreeMap<String, Rule>,
}

/// A user's choice of how an array is transferred, on points and on cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Carry {
    /// [`Rule::Interpolate`] on points, [`Rule::Conserve`] on cells.
    Mean,
    /// [`Rule::Linear`] on points, [`Rule::Conserve`] on cells.
    Linear,
    /// [`Rule::Inherit`] on points and on cells.
    Inherit,
    /// [`Rule::Drop`] on points and on cells.
    Drop,
}

impl Rules {
    /// Sets the rule that `carry` stands for, for the arrays of this name: on points, on cells, or on both.
    ///
    /// # Errors
    /// If `mesh` has no such array.
    pub fn carry(&mut self, mesh: &Mesh, name: &str, carry: Carry) -> Result<()> {
        let rule = |mean, linear| match carry {
            Carry::Mean => mean,
            Carry::Linear => linear,
            Carry::Inherit => Rule::Inherit,
            Carry::Drop => Rule::Drop,
        };
        let (on_points, on_cells) = (mesh.point_field(name).is_some(), mesh.cell_field(name).is_some());
        if on_points {
            self.points.insert(name.to_owned(), rule(Rule::Interpolate, Rule::Linear));
        }
        if on_cells {
            self.cells.insert(name.to_owned(), rule(Rule::Conserve, Rule::Conserve));
        }
        if on_points || on_cells {
            return Ok(());
        }
        let fields = mesh.point_data.iter().chain(&mesh.cell_data);
        let known: Vec<&str> = fields.map(|f| f.name.as_str()).collect();
        Err(Error::options(format!("the mesh has no array `{name}` to transfer"))
            .remedy(format!("the mesh has these: {}", known.join(", "))))
    }
}

/// Whether a mean of values is meaningful: only for floats.
pub(super) fn is_averageable(field: &Field) -> bool {
    matches!(field.values, Values::F32(_) | Values::F64(_))
}

/// Parts of the names that cardiac modelling uses for arrays of tissue directions.
const DIRECTION_NAMES: &[&str] = &["fibre", "fiber", "sheet", "direction"];
/// Tolerance on the squared length of a unit vector, which may be written in single precision or with five
/// digits.
const UNIT_TOLERANCE: f64 = 1e-4;

/// Whether the rows are directions: by their name, or since all are vectors of length 1 (or 0, where there is
/// no direction). A mean of directions is shorter than they are, and that of opposite ones is zero.
fn is_direction(field: &Field) -> bool {
    let name = field.name.to_lowercase();
    field.components.is_multiple_of(3)
        && (DIRECTION_NAMES.iter().any(|part| name.contains(part)) || has_unit_rows(field))
}

fn has_unit_rows(field: &Field) -> bool {
    let squared =
        |row: usize| (0..3).filter_map(|k| field.values.get_f64(3 * row + k)).map(|x| x * x).sum::<f64>();
    let mut lengths = (0..field.n_rows()).map(squared).filter(|&l| l != 0.0).peekable();
    field.components == 3 && lengths.peek().is_some() && lengths.all(|l| (l - 1.0).abs() < UNIT_TOLERANCE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn floats_have_means_and_whole_numbers_texts_and_directions_have_none() {
        let pressure = Field::scalars("pressure", vec![1.0f32, 2.0]);
        assert_eq!(Rule::of_points(&pressure), Rule::Interpolate);
        assert_eq!(Rule::of_cells(&pressure), Rule::Conserve);
        let velocity = Field::vectors("velocity", &[[1.0, 2.0, 3.0], [0.0; 3]]);
        assert_eq!(Rule::of_points(&velocity), Rule::Interpolate);
        let inherited = [
            Field::scalars("region", vec![1, 2]),
            Field::scalars("part", vec!["a".to_owned()]),
            Field::vectors("Fibers", &[[2.0, 0.0, 0.0]]),
            Field::vectors("e1", &[[0.6, 0.8, 0.0], [0.0; 3], [0.0, 0.0, -1.0]]),
        ];
        for field in inherited {
            assert_eq!(Rule::of_points(&field), Rule::Inherit, "{}", field.name);
            assert_eq!(Rule::of_cells(&field), Rule::Inherit, "{}", field.name);
        }
        // A field at rest has no direction; a scalar named so has none either.
        assert_eq!(Rule::of_points(&Field::vectors("velocity", &[[0.0; 3]])), Rule::Interpolate);
        assert_eq!(Rule::of_points(&Field::scalars("fiber_stretch", vec![1.0])), Rule::Interpolate);
    }

    #[test]
    fn a_word_holds_on_points_and_on_cells() {
        let mut mesh = crate::mesh::shapes::box_grid([1, 1, 1], [[0.0; 3], [1.0; 3]]);
        mesh.set_point_field(Field::scalars("p", vec![0.0; mesh.points.len()]));
        mesh.set_cell_field(Field::scalars("p", vec![0.0; mesh.cells.len()]));
        let mut rules = Rules::default();
        rules.carry(&mesh, "p", Carry::Mean).unwrap();
        assert_eq!((rules.points["p"], rules.cells["p"]), (Rule::Interpolate, Rule::Conserve));
        rules.carry(&mesh, "region", Carry::Drop).unwrap();
        assert_eq!((rules.points.get("region"), rules.cells["region"]), (None, Rule::Drop));
        assert!(rules.carry(&mesh, "q", Carry::Inherit).unwrap_err().to_string().contains("these: p"));
    }
}
