//! Built-in geometry for demonstrations, tests and benchmarks.
//!
//! | shape | cells | patches |
//! |---|---|---|
//! | [`box_grid`] | tets | `xmin` `xmax` `ymin` `ymax` `zmin` `zmax` |
//! | [`ball`] | tets | `sphere` |
//! | [`sphere_in_box`] | tets | `sphere` `box` |
//! | [`tube`] | tets; optionally wedges or thin tets at the wall | `wall` `inlet` `outlet` |
//! | [`mixed`] | hexahedra, wedges, pyramids, tets | `surface` |
//! | [`quadratic`] | quadratic tets, from any of the tet shapes | unchanged |
//! | [`Stent`] | triangles, the same at every radius | `stent` |
//! | [`Coil`] | triangles, a wire wound around a line | `wire` |
//! | [`Braid`] | polylines, the wires of a braided stent | |
//! | [`wire`] | triangles, round tubes along line segments | `wire` |
//! | [`Flap`] | triangles, a vessel and a sheet inside it | `wall` `inlet` `outlet` `flap` |
//! | [`ThickTube`] | triangles, a vessel and its wall | `lumen_inlet` `lumen_outlet` `interface` `outer` `wall_inlet` `wall_outlet` |
//! | [`Bifurcation`] | triangles, a vessel that branches into two | `wall` `inlet` `outlet_1` `outlet_2` |
//! | [`Aneurysm`] | triangles, a bent vessel with a sac | `wall` `inlet` `outlet` |
//!
//! Each has a cell array `region` on its volume cells and `patch` on its surface cells, which cover the whole
//! boundary, and names for both. Cells are positive and conforming, and the same arguments give the same
//! bytes. Most volume meshes are built of hexahedra that [`to_tets`] then splits. Triangle surfaces are
//! closed and face outward, apart from the sheets inside them (a flap, the interface of lumen and wall);
//! [`CenterLine`] bends shapes built along z.

mod aneurysm;
mod ball;
mod bifurcation;
mod boxes;
mod braid;
mod coil;
mod cubed_sphere;
mod even_out;
mod flap;
mod frames;
mod junction;
mod labelled;
mod mixed;
mod quadratic;
mod sleeve;
mod split;
mod stent;
mod sweep;
mod thick_tube;
mod tube;
mod wire;

pub use aneurysm::Aneurysm;
pub use ball::ball;
pub use bifurcation::Bifurcation;
pub use boxes::box_grid;
pub use braid::Braid;
pub use coil::Coil;
pub use cubed_sphere::sphere_in_box;
pub use flap::Flap;
pub use frames::CenterLine;
pub use mixed::mixed;
pub use quadratic::quadratic;
pub use split::to_tets;
pub use stent::Stent;
pub(crate) use sweep::{Soup, Wire, add_ball, corner_radius};
pub use thick_tube::ThickTube;
pub use tube::{TubeOptions, WallCells, tube};
pub use wire::{Chain, chains, wire};

use crate::base::{Error, Result};

/// Largest number of points of a shape: more are only requested by mistake, and few machines could hold them.
const MAX_POINTS: f64 = (1u64 << 26) as f64;

/// Refuses a shape of too many points before memory is allocated.
///
/// # Errors
/// If `n_points` is too large, or NaN.
pub fn check_count(n_points: f64) -> Result<()> {
    if n_points <= MAX_POINTS {
        return Ok(());
    }
    Err(Error::options(format!(
        "a shape of {n_points:.3e} points is too large: at most {MAX_POINTS:.0} are supported"
    ))
    .remedy("ask for fewer"))
}
