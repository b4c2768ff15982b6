//! Tets within surfaces, with regions and patches.

use serde::Serialize;

use super::compact::{compact, named};
use super::interior::lattice;
use super::layers::{self, Grown, Layers};
use super::surfaces::Surfaces;
use crate::base::{Error, Result, Threads, VertexId};
use crate::delaunay::{Constrained, EdgePoints, constrain};
use crate::geometry::quality::eas;
use crate::geometry::tet::volume;
use crate::mesh::history::Rules;
use crate::mesh::{CellKind, Cells, Field, LabelNames, Mesh};
use crate::preflight::Preflight;
use crate::remesh::{self, remesh_mesh};

/// How surfaces are filled.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What becomes of points that have to be put on edges of the surface. Default: they move inside.
    pub edge_points: EdgePoints,
    /// How long edges inside are to be, in units of the surface; `None`: no points inside. Default: `None`.
    pub size: Option<f64>,
    /// How the tets are improved once they are there; `None`: not at all. Default: `None`.
    pub improve: Option<remesh::Options>,
    /// Layers of thin cells on walls. Default: `None`.
    pub layers: Option<Layers>,
}

/// What came of filling surfaces.
#[derive(Clone, Debug)]
pub struct Filled {
    /// The tets, by their regions 1, 2, ..., and behind them the triangles of the surfaces, by their patches.
    pub mesh: Mesh,
    /// How it went.
    pub report: Report,
    /// How improving went, where it was asked for.
    pub improved: Option<remesh::Report>,
    /// How the layers went, where they were asked for.
    pub layers: Option<layers::Report>,
}

/// How filling went.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Triangles that the surfaces came with, those that two surfaces share counted once.
    pub triangles: usize,
    /// Tets made.
    pub tets: usize,
    /// Points that stayed on edges of the surface, where there was no room inside: the triangles there are in pieces.
    pub points_on_edges: usize,
    /// Points inside.
    pub points_inside: usize,
    /// Triangles that are facets as they came.
    pub triangles_kept: usize,
    /// Triangles with nothing enclosed on either side, which are left out.
    pub triangles_outside: usize,
    /// Tets of no positive volume, once points on edges were rounded.
    pub not_positive: usize,
    /// The volume of each region, from region 1 on.
    pub volumes: Vec<f64>,
    /// The worst EAS.
    pub worst_eas: f64,
}

/// Fills surfaces, of which `preflight` tells whether they are fit, with tets.
///
/// # Errors
/// When the surfaces are not fit: the first fault, and how many there are. When they enclose nothing. When an edge comes so close to
/// others that its coordinates have no digits left to divide it. When a size is no length, or asks for too many points.
pub fn fill(
    surfaces: &Surfaces,
    preflight: &Preflight,
    options: &Options,
    threads: &Threads,
) -> Result<Filled> {
    if let Some(error) = preflight.first_error() {
        return Err(error);
    }
    if let Some(size) = options.size.filter(|size| !(*size > 0.0 && size.is_finite())) {
        return Err(Error::options(format!("a size of {size}, expected a length above 0")));
    }
    let surfaces = surfaces.without_shared().compact();
    let Some(layers) = &options.layers else {
        let tets = fill_once(&surfaces, options, threads)?;
        let (mesh, _) = mesh(&surfaces, &tets);
        let (mesh, improved) = improve(mesh, options, threads)?;
        return Ok(Filled { report: report(&surfaces, &tets), mesh, improved, layers: None });
    };
    fill_with_layers(&surfaces, layers, options, threads)
}

fn fill_with_layers(
    surfaces: &Surfaces,
    layers: &Layers,
    options: &Options,
    threads: &Threads,
) -> Result<Filled> {
    if options.edge_points == EdgePoints::Stay {
        return Err(Error::options("layers, and points that stay on edges of the surface")
            .remedy("layers stand on whole triangles: let points move inside"));
    }
    let mut grown = Grown::new(surfaces, layers, threads)?;
    let tets = grown.fill(threads, |core| fill_once(core, options, threads))?;
    let (core, core_to_mesh) = mesh(grown.core(), &tets);
    let (mut mesh, improved) = improve(grown.glue(&core, &core_to_mesh), options, threads)?;
    if !layers.keep_prisms {
        mesh = layers::split(mesh);
    }
    let mut report = report(grown.core(), &tets);
    let (of_layers, volumes) = grown.report(report.volumes.len());
    report.volumes.iter_mut().zip(volumes).for_each(|(volume, of_layers)| *volume += of_layers);
    report.triangles = surfaces.triangles.len();
    [report.triangles_kept, report.triangles_outside] =
        grown.count(|i| tets.triangle_to_facets.list(i).len() == 1);
    Ok(Filled { mesh, report, improved, layers: Some(of_layers) })
}

/// Tets within surfaces, with points inside where a size is asked for.
fn fill_once(surfaces: &Surfaces, options: &Options, threads: &Threads) -> Result<Constrained> {
    let mut points = surfaces.points.clone();
    if let Some(size) = options.size {
        points.extend(lattice(&points, &surfaces.triangles, size, threads)?);
    }
    let tets = constrain(&points, &surfaces.triangles, options.edge_points, threads)?;
    if tets.tets.is_empty() {
        return Err(Error::input("the surfaces enclose nothing")
            .remedy("close them, or see what `motet info` says of them"));
    }
    Ok(tets)
}

fn improve(mesh: Mesh, options: &Options, threads: &Threads) -> Result<(Mesh, Option<remesh::Report>)> {
    let Some(improve) = &options.improve else { return Ok((mesh, None)) };
    let outcome = remesh_mesh(&mesh, improve, &Rules::default(), threads)?;
    Ok((outcome.mesh, Some(outcome.report)))
}

fn report(surfaces: &Surfaces, filled: &Constrained) -> Report {
    let corners = |t: &[VertexId; 4]| t.map(|v| filled.points[v.index()]);
    let n_bodies = filled.bodies.iter().max().map_or(0, |&b| b as usize + 1);
    let is_named = named(filled.points.len(), filled.tets.as_flattened().iter());
    let mut volumes = vec![0.0; n_bodies];
    let mut not_positive = 0;
    for (tet, &body) in filled.tets.iter().zip(&filled.bodies) {
        let volume = volume(corners(tet));
        volumes[body as usize] += volume;
        not_positive += usize::from(volume <= 0.0);
    }
    let is_kept = |list: &[[VertexId; 3]]| list.len() == 1;
    Report {
        triangles: surfaces.triangles.len(),
        tets: filled.tets.len(),
        points_on_edges: filled.on_edges.len(),
        points_inside: is_named[surfaces.points.len()..].iter().filter(|n| **n).count()
            - filled.on_edges.len(),
        triangles_kept: filled.triangle_to_facets.iter().filter(|list| is_kept(list)).count(),
        triangles_outside: filled.triangle_to_bodies.iter().filter(|b| **b == [None; 2]).count(),
        not_positive,
        volumes,
        worst_eas: filled.tets.iter().map(|t| eas(corners(t))).fold(f64::INFINITY, f64::min),
    }
}

/// Tets and triangles as cells, and the new number of each point; points that no cell uses are left out.
fn mesh(surfaces: &Surfaces, filled: &Constrained) -> (Mesh, Vec<VertexId>) {
    let mut triangles = Vec::new();
    for (i, list) in filled.triangle_to_facets.iter().enumerate() {
        if filled.triangle_to_bodies[i] != [None; 2] {
            triangles.extend(list.iter().map(|&t| (t, surfaces.patches[i])));
        }
    }
    let of_triangles = triangles.iter().flat_map(|(t, _)| t);
    let is_used = named(filled.points.len(), filled.tets.as_flattened().iter().chain(of_triangles));
    let (points, old_to_new) = compact(&filled.points, &is_used);
    let (mut cells, mut regions, mut patches) = (Cells::new(), Vec::new(), Vec::new());
    for (tet, &body) in filled.tets.iter().zip(&filled.bodies) {
        cells.push(CellKind::TETRA, tet.map(|v| old_to_new[v.index()]));
        regions.push(body as i32 + 1);
        patches.push(0);
    }
    for (triangle, patch) in triangles {
        cells.push(CellKind::TRIANGLE, triangle.map(|v| old_to_new[v.index()]));
        regions.push(0);
        patches.push(patch);
    }
    let mesh = Mesh {
        cell_data: vec![Field::scalars("region", regions), Field::scalars("patch", patches)],
        label_names: LabelNames { patches: surfaces.patch_names.clone(), ..LabelNames::default() },
        ..Mesh::new(points, cells)
    };
    (mesh, old_to_new)
}
