//! Arrays of 0 and 1 that mark points and cells, under the names that Medit's sections have here.

use crate::mesh::{CellKind, Mesh};

/// Points and cells that stay as they are.
pub const REQUIRED: &str = "medit:required";
/// Points at which features meet.
pub const CORNER: &str = "medit:corner";
/// Lines along sharp edges.
pub const RIDGE: &str = "medit:ridge";

impl Mesh {
    /// The points that are required or corners, rising.
    pub fn marked_points(&self) -> Vec<usize> {
        let mut marked: Vec<usize> =
            [REQUIRED, CORNER].iter().flat_map(|array| self.point_field(array)).flat_map(rows).collect();
        marked.sort_unstable();
        marked.dedup();
        marked
    }

    /// The cells of a kind that are required, rising.
    pub fn required_cells(&self, kind: CellKind) -> Vec<usize> {
        let marked = self.cell_field(REQUIRED).map(rows).unwrap_or_default();
        marked.into_iter().filter(|&cell| self.cells.kinds()[cell] == kind).collect()
    }

    /// Takes the marks off points that no mesh had before; `point_to_old` has [`u32::MAX`] for these.
    pub fn unmark_new_points(&mut self, point_to_old: &[u32]) {
        let is_mark = |name: &str| name == REQUIRED || name == CORNER;
        for field in self.point_data.iter_mut().filter(|field| is_mark(&field.name) && field.components == 1)
        {
            for point in (0..point_to_old.len()).filter(|&point| point_to_old[point] == u32::MAX) {
                field.values.set_f64(point, 0.0);
            }
        }
    }
}

/// The rows that a field marks.
fn rows(field: &crate::mesh::Field) -> Vec<usize> {
    if field.components != 1 {
        return Vec::new();
    }
    (0..field.n_rows()).filter(|&row| field.values.get_f64(row).is_some_and(|value| value != 0.0)).collect()
}
