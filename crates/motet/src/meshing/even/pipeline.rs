//! The steps by which a surface is made even.

use super::super::adapt::{Adapting, adapt};
use super::super::compact::{compact, used_vertices};
use super::super::surfaces::Surfaces;
use super::clip::clip;
use super::measured::Measured;
use super::options::Options;
use super::origins::{Given, history, numbers};
use super::report::{Report, Smoothed};
use crate::base::{Error, Result, Threads};
use crate::geometry::vector::in_range;
use crate::mesh::history::{Changed, Rules};
use crate::mesh::{CellKind, Cells, Field, Mesh, Surface};
use crate::preflight::{Repairs, Role, renamed};
use crate::surface;

/// Makes the surface of a mesh even: its surface cells, divided into triangles, or else the boundary of its
/// volume cells. The surface may be open; rims, borders of patches, edges of more than two triangles and
/// creases stay. Points at the same place are merged. Arrays are carried by the history: on points, floats
/// are interpolated in the nearest given triangle of the same patch and other values are those of one of its
/// corners; triangles get the values of the nearest given one. Parts are cut off first, if requested.
///
/// # Errors
/// When the mesh has no surface, a coordinate is not finite, an option is out of its range, a cut separates
/// no part, or a size requires too many triangles.
pub fn even_surface(mesh: &Mesh, options: &Options, threads: &Threads) -> Result<Changed<Report>> {
    if options.cuts.is_empty() {
        return even(mesh, options, threads);
    }
    check(&Surface::own_or_boundary_of(mesh))?;
    let cut = clip(mesh, &options.cuts, threads)?;
    let at_points = |values: &[f64]| {
        let field = Field::scalars("size", values.to_vec());
        let carried = cut.history.transfer_points(&field).ok();
        carried.and_then(|field| field.values.to_f64()).unwrap_or_default()
    };
    let sizes = options.sizes.clone().map(|sizes| sizes.map_points(at_points));
    let rest = Options { cuts: Vec::new(), sizes, ..options.clone() };
    let made = even(&cut.mesh, &rest, threads)?;
    let given = Surface::of(mesh);
    let is_boundary = given.triangles.is_empty();
    let is_used = used_cells(mesh.cells.len(), &given);
    Ok(Changed {
        history: cut.history.then(&made.history),
        report: Report {
            cuts: cut.report,
            is_boundary,
            left_out: if is_boundary { 0 } else { is_used.iter().filter(|is_used| !**is_used).count() },
            ..made.report
        },
        mesh: made.mesh,
    })
}

/// Makes the surface of a mesh even, without cutting anything off.
fn even(mesh: &Mesh, options: &Options, threads: &Threads) -> Result<Changed<Report>> {
    let own = Surface::of(mesh);
    let is_boundary = own.triangles.is_empty();
    let given = if is_boundary { Surface::boundary_of(mesh) } else { own };
    check(&given)?;
    let mut surfaces = Surfaces::of(&[(&given, Role::Boundary, "surface")])?;
    let before = Measured::of(&surfaces.points, &surfaces.triangles, threads);
    // Among points that are merged the smallest size counts.
    let merged = |values: &[f64]| surfaces.sizes(&[values.to_vec()]);
    let sizes = options.sizes.clone().map(|sizes| sizes.map_points(merged));
    sizes.as_ref().map_or(Ok(()), |sizes| sizes.check(&surfaces))?;
    let repaired = surfaces.repair(&Repairs { drop_degenerate: true, ..options.repairs }, threads)?;
    if surfaces.triangles.is_empty() {
        return Err(Error::input("no triangle of the surface has an area and stands alone")
            .remedy("give a surface whose triangles are neither flat nor double"));
    }
    let sizes = sizes.map(|sizes| sizes.map_points(|values| repaired.at_points(values)));
    let smoothed = match options.smooth {
        0 => None,
        passes => Some(smooth(&mut surfaces, passes, &options.adapting, threads)?),
    };
    let mut held = options.held.clone();
    if !held.is_empty() {
        held.resize(surfaces.points.len(), false);
    }
    let (new, _, adapted) = adapt(&surfaces, sizes.as_ref(), &options.adapting, &held, false, threads)?;
    let history =
        history(&Given { mesh, given: &given, repaired: &repaired, surfaces: &surfaces }, &new, threads)?;
    let after = Measured::of(&new.points, &new.triangles, threads);
    let mut made = mesh_of(&new)?;
    history.transfer_on(mesh, &mut made, &Rules::default(), threads)?;
    let is_used = used_cells(mesh.cells.len(), &given);
    let report = Report {
        cuts: Vec::new(),
        before,
        after,
        allowed: adapted.allowed,
        to_given: adapted.to_given,
        from_given: adapted.from_given,
        smoothed,
        repairs: repaired.done,
        is_boundary,
        left_out: if is_boundary { 0 } else { is_used.iter().filter(|is_used| !**is_used).count() },
    };
    Ok(Changed { mesh: made, history, report })
}

/// # Errors
/// When there is no triangle, or a corner is not finite.
fn check(given: &Surface) -> Result<()> {
    if given.triangles.is_empty() {
        return Err(Error::input("the mesh has no surface: neither surface cells nor volume cells")
            .remedy("give a surface of triangles, quads or polygons, or a volume mesh"));
    }
    let corners = given.triangles.as_flattened();
    match corners.iter().find(|v| !in_range(given.points[v.index()])) {
        Some(v) => Err(Error::input("a coordinate is not finite or too large").at(format!("point {v}"))),
        None => Ok(()),
    }
}

/// Smooths surfaces. Returns what that did.
fn smooth(
    surfaces: &mut Surfaces,
    passes: usize,
    adapting: &Adapting,
    threads: &Threads,
) -> Result<Smoothed> {
    let features = [adapting.feature_angle, adapting.allowed(surfaces)];
    let labels = numbers(&surfaces.patches);
    let points = surface::smooth(&surfaces.points, &surfaces.triangles, &labels, passes, features, threads)?;
    let triangles = &surfaces.triangles;
    let [to_given, from_given] =
        surface::distances([(&surfaces.points, triangles), (&points, triangles)], threads);
    surfaces.points = points;
    Ok(Smoothed { passes, to_given, from_given })
}

/// The triangles of surfaces as a mesh without arrays.
fn mesh_of(surfaces: &Surfaces) -> Result<Mesh> {
    let is_used = used_vertices(surfaces.points.len(), surfaces.triangles.as_flattened().iter());
    let (points, old_to_new) = compact(&surfaces.points, &is_used);
    let triangles = renamed(&surfaces.triangles, &old_to_new);
    Ok(Mesh::new(points, Cells::uniform(CellKind::TRIANGLE, triangles.into_flattened())?))
}

/// Whether each cell has a triangle of the surface.
fn used_cells(n: usize, surface: &Surface) -> Vec<bool> {
    let mut is_used = vec![false; n];
    surface.triangle_to_cell.iter().for_each(|cell| is_used[cell.index()] = true);
    is_used
}
