//! Sizes that hold for more than one generation: worked out on the mesh that has the solution, and carried from there as arrays.

use super::Criterion;
use crate::base::{Result, Threads};
use crate::mesh::{Mesh, TetPart};

/// Puts the sizes of every [`Criterion::Hessian`] into the mesh, see [`HessianSizes::put`](super::HessianSizes::put), and [`Criterion::Size`] in its place. Gives
/// the names of the arrays, which the mesh gets on its points.
///
/// # Errors
/// As there, and when there is no tet.
pub fn fix_sizes(criteria: &mut [Criterion], mesh: &mut Mesh, threads: &Threads) -> Result<Vec<String>> {
    let mut names = Vec::new();
    for (i, criterion) in criteria.iter_mut().enumerate() {
        if let Criterion::Hessian(sizes) = criterion {
            let name = format!("refine_size_{i}");
            *criterion = sizes.put(mesh, &TetPart::of(mesh)?, &name, threads)?;
            names.push(name);
        }
    }
    Ok(names)
}
