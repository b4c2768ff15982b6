//! Sizes that hold for more than one generation: worked out on the mesh that has the solution, and carried from there as an array.

use super::{Criterion, Size};
use crate::base::{Result, Threads};
use crate::mesh::{Field, Mesh, TetPart};

/// Puts arrays of sizes in place of [`Criterion::Hessian`]: on a finer mesh, a field that was carried there is straight within each tet of the coarse one, and
/// bends at its facets alone. Gives the names of the arrays, which the mesh gets on its points.
///
/// # Errors
/// As for [`HessianSizes::sizes`](super::HessianSizes::sizes), and when there is no tet.
pub fn fix_sizes(criteria: &mut [Criterion], mesh: &mut Mesh, threads: &Threads) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for (i, criterion) in criteria.iter_mut().enumerate() {
        if let Criterion::Hessian(sizes) = criterion {
            let name = format!("refine_size_{i}");
            let values = sizes.sizes(mesh, &TetPart::of(mesh)?, threads)?;
            mesh.set_point_field(Field::scalars(name.clone(), values));
            *criterion = Criterion::Size(Size::Array(name.clone()));
            names.push(name);
        }
    }
    Ok(names)
}
