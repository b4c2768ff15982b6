//! Arrays of 0 and 1 that mark points and cells, named after the sections of Medit files.

use crate::base::VertexId;
use crate::mesh::{CellKind, Mesh};

/// Marks points and cells that must stay as they are.
pub const REQUIRED: &str = "medit:required";
/// Marks points at which features meet.
pub const CORNER: &str = "medit:corner";
/// Marks lines along sharp edges.
pub const RIDGE: &str = "medit:ridge";

impl Mesh {
    /// The points marked as required or as corners, in rising order.
    pub fn marked_points(&self) -> Vec<usize> {
        let mut marked: Vec<usize> =
            [REQUIRED, CORNER].iter().flat_map(|array| self.point_field(array)).flat_map(rows).collect();
        marked.sort_unstable();
        marked.dedup();
        marked
    }

    /// The cells of a kind that are marked as required, in rising order.
    pub fn required_cells(&self, kind: CellKind) -> Vec<usize> {
        let marked = self.cell_field(REQUIRED).map(rows).unwrap_or_default();
        marked.into_iter().filter(|&cell| self.cells.kinds()[cell] == kind).collect()
    }

    /// Clears the marks of points.
    pub fn unmark(&mut self, points: &[VertexId]) {
        let is_mark = |name: &str| name == REQUIRED || name == CORNER;
        for field in self.point_data.iter_mut().filter(|field| is_mark(&field.name) && field.components == 1)
        {
            for point in points {
                field.values.set_f64(point.index(), 0.0);
            }
        }
    }
}

/// The rows whose value is not 0; none if the field is not scalar.
fn rows(field: &crate::mesh::Field) -> Vec<usize> {
    if field.components != 1 {
        return Vec::new();
    }
    (0..field.n_rows()).filter(|&row| field.values.get_f64(row).is_some_and(|value| value != 0.0)).collect()
}
