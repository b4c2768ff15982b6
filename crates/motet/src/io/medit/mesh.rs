//! Converts the content of a file to a mesh.

use super::content::Content;
use super::solution::{attach, places_of};
use super::{REF, SECTIONS};
use crate::base::{Error, Result};
use crate::mesh::{Field, Mesh, Values};

impl Content {
    /// The mesh, with the solutions in the same file.
    pub(super) fn into_mesh(self) -> Result<Mesh> {
        let Some(points) = self.points else {
            return Err(Error::input("there is no section Vertices")
                .remedy("the file contains no mesh or is truncated: get a new copy"));
        };
        let mut mesh = Mesh::new(points, self.cells);
        if self.point_refs.iter().any(|&r| r != 0) {
            mesh.set_point_field(Field::scalars(REF, self.point_refs));
        }
        if self.cell_refs.iter().any(|&r| r != 0) {
            mesh.set_cell_field(Field::scalars(REF, self.cell_refs));
        }
        set_marks(&mut mesh, &self.marks)?;
        attach(&mut mesh, &self.solutions)?;
        Ok(mesh)
    }
}

/// Stores marked entities as arrays of 0 and 1.
fn set_marks(mesh: &mut Mesh, marks: &[(usize, &'static str, usize)]) -> Result<()> {
    for (of, section) in SECTIONS.iter().enumerate().filter(|(of, _)| marks.iter().any(|m| m.0 == *of)) {
        let places = places_of(mesh, of);
        let on_points = section.cells.is_none();
        let n = if on_points { mesh.points.len() } else { mesh.cells.len() };
        let fields = if on_points { &mut mesh.point_data } else { &mut mesh.cell_data };
        for &(_, array, place) in marks.iter().filter(|m| m.0 == of) {
            let Some(&row) = places.get(place) else {
                return Err(Error::input(format!(
                    "a mark refers to entry {} of section {}, which has {}",
                    place + 1,
                    section.list.name,
                    places.len()
                ))
                .remedy("the file is damaged: write it again"));
            };
            if !fields.iter().any(|f| f.name == array) {
                fields.push(Field::scalars(array, vec![0u8; n]));
            }
            let field = fields.iter_mut().find(|f| f.name == array);
            if let Some(Field { values: Values::U8(values), .. }) = field {
                values[row] = 1;
            }
        }
    }
    Ok(())
}
