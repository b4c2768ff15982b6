//! Everything that a mesh file holds.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::in_range;
use crate::mesh::{Cells, Field, LabelNames};

/// Points, cells of any kind, and the arrays on them: what a file holds, and what the parts of the library
/// exchange.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Mesh {
    /// Coordinates of each vertex.
    pub points: Vec<Point>,
    /// The cells, in the order of the file.
    pub cells: Cells,
    /// Arrays with a row for each point.
    pub point_data: Vec<Field>,
    /// Arrays with a row for each cell.
    pub cell_data: Vec<Field>,
    /// Arrays about the mesh as a whole.
    pub field_data: Vec<Field>,
    /// Names of regions and patches.
    pub label_names: LabelNames,
}

impl Mesh {
    /// A mesh of points and cells, without arrays.
    pub fn new(points: Vec<Point>, cells: Cells) -> Self {
        Self { points, cells, ..Self::default() }
    }

    /// Checks that every array has the right length and every vertex id exists. Every reader calls it last,
    /// so later code need not check again.
    ///
    /// # Errors
    /// If a check fails; the error names the array or the cell at fault.
    pub fn validate(&self) -> Result<()> {
        if self.points.len() > VertexId::MAX_COUNT {
            return Err(Error::input(format!("{} points are more than a mesh can hold", self.points.len())));
        }
        self.cells.check_ids(self.points.len())?;
        check_rows(&self.point_data, self.points.len(), "point")?;
        check_rows(&self.cell_data, self.cells.len(), "cell")
    }

    /// The point array named `name`, if there is one.
    pub fn point_field(&self, name: &str) -> Option<&Field> {
        self.point_data.iter().find(|f| f.name == name)
    }

    /// The cell array named `name`, if there is one.
    pub fn cell_field(&self, name: &str) -> Option<&Field> {
        self.cell_data.iter().find(|f| f.name == name)
    }

    /// Adds a point array, replacing any of the same name.
    pub fn set_point_field(&mut self, field: Field) {
        set(&mut self.point_data, field);
    }

    /// Adds a cell array, replacing any of the same name.
    pub fn set_cell_field(&mut self, field: Field) {
        set(&mut self.cell_data, field);
    }

    /// The lowest and the highest corner of the axis-aligned bounding box of all points with finite
    /// coordinates; `None` if there are no such points.
    pub fn bounds(&self) -> Option<[Point; 2]> {
        bounds(&self.points)
    }
}

/// The lowest and the highest corner of the axis-aligned bounding box of the finite ones of `points`; `None`
/// if there are none.
pub fn bounds(points: &[Point]) -> Option<[Point; 2]> {
    points.iter().filter(|p| in_range(**p)).fold(None, |bounds, p| {
        let [low, high] = bounds.unwrap_or([*p, *p]);
        Some([[0, 1, 2].map(|i| low[i].min(p[i])), [0, 1, 2].map(|i| high[i].max(p[i]))])
    })
}

/// The length of the longest side of a box.
pub fn largest_extent([low, high]: [Point; 2]) -> f64 {
    (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max)
}

fn set(fields: &mut Vec<Field>, field: Field) {
    match fields.iter_mut().find(|f| f.name == field.name) {
        Some(old) => *old = field,
        None => fields.push(field),
    }
}

pub(super) fn check_rows(fields: &[Field], n: usize, what: &str) -> Result<()> {
    match fields.iter().find(|f| f.values.len() != n * f.components) {
        None => Ok(()),
        Some(f) => Err(Error::input(format!(
            "has {} values, but {n} {what}s of {} component(s) need {}",
            f.values.len(),
            f.components,
            n * f.components
        ))
        .at(format!("{what} array {}", f.name))),
    }
}
