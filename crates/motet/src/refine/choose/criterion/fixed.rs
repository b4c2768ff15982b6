//! Sizes that stay valid for more than one generation: computed on the mesh of the solution, and transferred
//! as arrays.

use super::Criterion;
use crate::base::{Result, Threads};
use crate::mesh::{Mesh, TetPart};

/// Puts the sizes of every [`Criterion::Hessian`] into the mesh (see
/// [`HessianSizes::put`](super::HessianSizes::put)) and replaces the criterion by a [`Criterion::Size`].
/// Returns the names of the point arrays added.
///
/// # Errors
/// The errors of [`HessianSizes::put`](super::HessianSizes::put), and when there is no tet.
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
