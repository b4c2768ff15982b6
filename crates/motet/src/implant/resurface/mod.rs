//! A new surface for a device: closed, without crossings, of even triangles, as near to the old one as was asked.
//!
//! | step | file | how |
//! |---|---|---|
//! | cubes | `cubes` | those near the surface; the tets of a body-centred lattice between their middles and corners |
//! | inside | here | winding numbers, also of surfaces that cross themselves, have open ends or triangles twice |
//! | skin | `skin` | lattice vertices near the surface move onto it, the other edges that it cuts are cut: Labelle and Shewchuk 2007, *Isosurface stuffing* |
//! | distance | here | both ways; where it is too far the lattice is made finer |

mod cubes;
mod skin;

use super::report::Fit;
use crate::base::{Error, Point, Result, Threads};
use crate::geometry::triangle::{area, area_vector, centroid};
use crate::geometry::vector::{add, distance, is_finite, norm, scale};
use crate::mesh::{CellKind, Cells, Mesh, Surface};
use crate::spatial::{NearestTriangle, WindingNumber};
use cubes::Cubes;
use skin::Skin;

/// A point is inside from this winding number on.
const INSIDE: f64 = 0.5;

/// Edges of the first lattice over the radius of a round wire as thick as the device.
const EDGE_OVER_RADIUS: f64 = 0.5;

/// The distance that is asked where nobody said, over that radius. Where a wire ends in a sharp edge this is what a lattice of that size leaves of it.
const TOLERANCE_OVER_RADIUS: f64 = 0.2;

/// Where the surfaces are too far apart the lattice is made finer by this, so often at most.
const FINER: f64 = 0.7;
const TRIES: usize = 5;

/// A device's new surface.
#[derive(Debug)]
pub(super) struct Resurfaced {
    pub(super) mesh: Mesh,
    pub(super) fit: Fit,
}

/// The surface as it came, ready for questions.
struct Old {
    surface: Surface,
    nearest: NearestTriangle,
    winding: WindingNumber,
    /// That of a round wire with as much volume for its area.
    radius: f64,
}

/// Makes a new surface for the room that `surface` goes round.
///
/// # Errors
/// When it goes round nothing, has corners that are not finite, or so fine a lattice would be needed that it has too many cubes.
pub(super) fn resurface(
    surface: Surface,
    name: &str,
    tolerance: Option<f64>,
    size: Option<f64>,
    threads: &Threads,
) -> Result<Resurfaced> {
    let old = Old::new(surface, name, threads)?;
    let tolerance = tolerance.unwrap_or(TOLERANCE_OVER_RADIUS * old.radius);
    // A chord of a circle strays by an eighth of its square over the radius.
    let by_tolerance = 0.7 * (8.0 * old.radius * tolerance).sqrt();
    let mut edge = size.unwrap_or(by_tolerance.min(EDGE_OVER_RADIUS * old.radius));
    let mut best: Option<Resurfaced> = None;
    for _ in 0..TRIES {
        let made = old.resurfaced(edge, tolerance, name, threads)?;
        let farthest = |made: &Resurfaced| made.fit.to_old.max(made.fit.from_old);
        let is_near = made.fit.is_reached();
        if best.as_ref().is_none_or(|best| farthest(&made) < farthest(best)) {
            best = Some(made);
        }
        if is_near {
            break;
        }
        edge *= FINER;
    }
    best.filter(|best| !best.mesh.cells.is_empty()).ok_or_else(|| nothing(name))
}

fn nothing(name: &str) -> Error {
    Error::input(format!("the device `{name}` goes round nothing"))
        .at("its surface")
        .remedy("turn it outward, and close it as far as that matters")
}

impl Old {
    fn new(surface: Surface, name: &str, threads: &Threads) -> Result<Self> {
        let off = surface.vertices().into_iter().find(|v| !is_finite(surface.points[v.index()]));
        if let Some(v) = off {
            return Err(Error::input(format!("the device `{name}` has a coordinate that is no number"))
                .at(format!("point {v}"))
                .remedy("give the point a place, or remove it with its triangles"));
        }
        let volume = surface.enclosed_volume();
        let whole = (0..surface.triangles.len()).map(|t| area(surface.corners(t))).sum::<f64>();
        if volume <= 0.0 || whole <= 0.0 {
            return Err(nothing(name));
        }
        Ok(Self {
            nearest: NearestTriangle::new(&surface.points, &surface.triangles, threads),
            winding: WindingNumber::new(&surface.points, &surface.triangles),
            radius: 2.0 * volume / whole,
            surface,
        })
    }

    /// The distance of a place, negative inside.
    fn signed(&self, p: Point) -> f64 {
        let distance = self.nearest.closest(p).map_or(f64::INFINITY, |found| found.distance_squared.sqrt());
        if self.winding.at(p) > INSIDE { -distance } else { distance }
    }

    fn resurfaced(&self, edge: f64, tolerance: f64, name: &str, threads: &Threads) -> Result<Resurfaced> {
        let cubes = Cubes::near(&self.surface, edge).ok_or_else(|| {
            let what = format!(
                "the device `{name}` needs a lattice with edges of {edge:.2e}, which has far too many cubes"
            );
            Error::input(what).at("its surface").remedy("give a larger tolerance, or a size")
        })?;
        let lattice = cubes.lattice();
        let values = threads.map(lattice.points.len(), |v| self.signed(lattice.points[v]));
        let skin = Skin::new(lattice, values, |p| self.signed(p), threads);
        let fit = Fit {
            to_old: self.off_old(&skin, threads),
            from_old: self.off_new(&skin, edge, threads),
            tolerance,
        };
        let mut cells = Cells::new();
        skin.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
        Ok(Resurfaced { mesh: Mesh::new(skin.points, cells), fit })
    }

    /// The largest distance of the new surface from the old one, at corners, middles of edges and of triangles.
    fn off_old(&self, skin: &Skin, threads: &Threads) -> f64 {
        let of_triangle = |t: usize| {
            let [a, b, c] = skin.triangles[t].map(|v| skin.points[v.index()]);
            let half = |p: Point, q: Point| scale(add(p, q), 0.5);
            let places = [a, b, c, half(a, b), half(b, c), half(c, a), centroid([a, b, c])];
            let off = places.map(|p| self.nearest.closest(p).map_or(0.0, |found| found.distance_squared));
            off.into_iter().fold(0.0, f64::max)
        };
        threads.map(skin.triangles.len(), of_triangle).into_iter().fold(0.0, f64::max).sqrt()
    }

    /// The largest distance of the old surface from the new one, at middles of triangles and of their edges; where it lies in the device, such as where turns of a wire
    /// overlap, it does not bound it, and does not count.
    fn off_new(&self, skin: &Skin, edge: f64, threads: &Threads) -> f64 {
        let tree = NearestTriangle::new(&skin.points, &skin.triangles, threads);
        let of_triangle = |t: usize| {
            let corners = self.surface.corners(t);
            let normal = area_vector(corners);
            let length = norm(normal);
            if length == 0.0 {
                return 0.0;
            }
            let places = [0, 1, 2].map(|k| scale(add(corners[k], corners[(k + 1) % 3]), 0.5));
            let off = |p: Point| {
                let out = add(p, scale(normal, 0.1 * edge / length));
                if self.winding.at(out) > INSIDE {
                    return 0.0;
                }
                tree.closest(p).map_or(f64::INFINITY, |found| distance(found.point, p))
            };
            places.into_iter().chain([centroid(corners)]).map(off).fold(0.0, f64::max)
        };
        threads.map(self.surface.triangles.len(), of_triangle).into_iter().fold(0.0, f64::max)
    }
}
