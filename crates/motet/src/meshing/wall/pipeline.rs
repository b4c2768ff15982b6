//! The steps by which a wall is made.

use super::super::layers::{OutwardLayers, radii};
use super::join::join;
use super::lumen::Lumen;
use super::options::{Options, Thickness};
use super::report::Report;
use crate::base::{Error, Result, Threads};
use crate::geometry::vector::LARGEST;
use crate::mesh::Mesh;
use crate::mesh::history::Changed;

/// Puts a solid wall on the outer side of a lumen: layers of prisms, or of the tets that these are divided
/// into, which share the lumen's vertices. They rise outward from the boundary of the volume cells, or from
/// the surface cells of a mesh without volume cells, and end in the planes of caps and of open rims. Where
/// there is no space, such as between branches, the wall is thinner. The wall is a region, its outer side and
/// its ends are patches. Points and cells of the wall take values of arrays from the lumen at their feet.
///
/// # Errors
/// When an option is out of its range, a patch does not exist, a thickness is not a length, the surface
/// crosses itself or has other faults than open ends, or a facet for the wall is not a triangle.
pub fn wall(mesh: &Mesh, options: &Options, threads: &Threads) -> Result<Changed<Report>> {
    let stack = options.stack()?;
    let lumen = Lumen::of(mesh, &options.on, threads)?;
    let thickness = thickness(&lumen, mesh.points.len(), &options.thickness, threads)?;
    let layers = OutwardLayers::new(&lumen.surfaces, lumen.n_real, &lumen.on, stack, &thickness, threads)?;
    join(mesh, &lumen, &layers, options, threads)
}

/// The thickness at each point of the surfaces.
fn thickness(lumen: &Lumen, n_points: usize, of: &Thickness, threads: &Threads) -> Result<Vec<f64>> {
    let n = lumen.surfaces.points.len();
    if let Thickness::AtPoints(values) = of
        && values.len() != n_points
    {
        return Err(Error::options(format!(
            "the thickness of the wall has {} values for {n_points} points",
            values.len()
        )));
    }
    let thickness = match of {
        Thickness::Uniform(thickness) => vec![*thickness; n],
        Thickness::AtPoints(values) => {
            lumen.points.iter().map(|v| values[v.index()]).chain(std::iter::repeat(0.0)).take(n).collect()
        }
        Thickness::OfRadius(part) => {
            radii(&lumen.surfaces, &lumen.on, threads).into_iter().map(|radius| part * radius).collect()
        }
    };
    let corners = lumen.surfaces.triangles.iter().zip(&lumen.on).filter(|(_, on)| **on).flat_map(|(t, _)| t);
    let is_wrong = |t: f64| !(0.0..=LARGEST).contains(&t);
    match corners.copied().find(|v| is_wrong(thickness[v.index()])) {
        None => Ok(thickness),
        Some(v) => Err(Error::input(format!(
            "the thickness of the wall must be a length of 0 or more; got {}",
            thickness[v.index()]
        ))
        .at(format!("point {}", lumen.points[v.index()]))),
    }
}
