//! A new surface for a device: closed, without crossings, with even triangles, as near to the old one as
//! requested.
//!
//! | step | file | how |
//! |---|---|---|
//! | faces | `facing` | parts that face inward are turned outward, except for cavities |
//! | cubes | `cubes` | those near the surface; the tets of a body-centred lattice between their centres and corners |
//! | inside | `old` | winding numbers, also of surfaces that cross themselves, have open ends or duplicate triangles; those of a closed one change only across triangles |
//! | skin | `skin` | lattice vertices near the surface move onto it, the other edges that it crosses are cut: Labelle and Shewchuk 2007, *Isosurface stuffing* |
//! | widen | `widen` | narrow triangles made wider: edges flipped or collapsed, vertices moved along the old surface |
//! | distance | `fit` | both ways; if it is too large, the lattice is made finer |

mod cubes;
mod facing;
mod fit;
mod old;
mod skin;
mod widen;

use super::report::Fit;
use crate::base::{Error, Result, Threads};
use crate::mesh::{CellKind, Cells, Mesh, Surface};
use cubes::{Cubes, shortest_edge};
use old::{OriginalSurface, encloses_nothing};
use skin::Skin;

/// The edge length of the first lattice, over the radius of a round wire as thick as the device.
const EDGE_OVER_RADIUS: f64 = 0.5;

/// The default tolerance, over that radius. Where a wire ends in a sharp edge, this is the error of a lattice
/// of that size.
const TOLERANCE_OVER_RADIUS: f64 = 0.2;

/// The edge length of the lattice over that of chords that stray from the circle of the wire by the
/// tolerance.
const CHORD: f64 = 0.7;

/// Where the surfaces are too far apart, the lattice is made finer by this factor, in at most `TRIES` tries.
const FINER: f64 = 0.7;
const TRIES: usize = 5;

/// A finer surface that is still too far away is taken only if its distance is below this fraction of that of
/// the best one, since it has twice the triangles. Any lattice cuts off the edge of a thin wedge, so there
/// the distance hardly falls.
const NEARER: f64 = 0.9;

/// A device's new surface.
#[derive(Debug)]
pub(super) struct Resurfaced {
    pub(super) mesh: Mesh,
    pub(super) fit: Fit,
}

/// Makes a new surface for the space that `surface` encloses.
///
/// # Errors
/// When it encloses nothing, has corners that are not finite, or needs so fine a lattice that it has too many
/// cubes.
pub(super) fn resurface(
    surface: Surface,
    name: &str,
    tolerance: Option<f64>,
    size: Option<f64>,
    threads: &Threads,
) -> Result<Resurfaced> {
    let old = OriginalSurface::new(surface, name, threads)?;
    let tolerance = tolerance.unwrap_or(TOLERANCE_OVER_RADIUS * old.radius);
    // A chord of a circle strays by an eighth of its square over the radius.
    let by_tolerance = CHORD * (8.0 * old.radius * tolerance).sqrt();
    let mut edge = size.unwrap_or(by_tolerance.min(EDGE_OVER_RADIUS * old.radius));
    let shortest = shortest_edge(&old.surface);
    if edge < shortest {
        let what =
            format!("the device `{name}` needs a lattice with edges of {edge:.2e}, which has too many cubes");
        let least = (shortest / CHORD).powi(2) / (8.0 * old.radius);
        let by_size = format!("a size of at least {shortest:.2e}");
        // No tolerance leads to edges longer than a fraction of the radius.
        let remedy = match size.is_none() && EDGE_OVER_RADIUS * old.radius >= shortest {
            true => format!("give a tolerance of at least {least:.2e}, or {by_size}"),
            false => format!("give {by_size}"),
        };
        return Err(Error::input(what).at("its surface").remedy(remedy));
    }
    let mut best: Option<(Skin, Fit)> = None;
    for k in 0..TRIES {
        threads.watch().report_and_check("building a new surface", k, TRIES)?;
        let lattice = Cubes::near(&old.surface, edge).lattice();
        let skin = Skin::new(lattice, &old, threads);
        let fit = old.fit(&skin, tolerance, threads);
        let part = if fit.is_reached() { 1.0 } else { NEARER };
        if best.as_ref().is_none_or(|(_, best)| fit.farthest() < part * best.farthest()) {
            best = Some((skin, fit));
        }
        edge *= FINER;
        if fit.is_reached() || edge < shortest {
            break;
        }
    }
    let (mut skin, mut fit) =
        best.filter(|(skin, _)| !skin.triangles.is_empty()).ok_or_else(|| encloses_nothing(name))?;
    if let Some(widened) = old.widened(&skin, tolerance, threads) {
        let now = old.fit(&widened, tolerance, threads);
        if now.is_reached() || now.farthest() <= fit.farthest() {
            (skin, fit) = (widened, now);
        }
    }
    let mut cells = Cells::new();
    skin.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    Ok(Resurfaced { mesh: Mesh::new(skin.points, cells), fit })
}
