//! Fills surfaces with tets, with regions and patches.

use std::collections::BTreeMap;

use serde::Serialize;

use super::adapt::{Adapted, Adapting, adapt, lost, strayed};
use super::bodies::{self, Body, Named, NumberedBodies, Seed};
use super::compact::{compact, used_vertices};
use super::divide::{Divided, divide};
use super::graded;
use super::interior;
use super::layers::{self, GrownLayers, Layers};
use super::size_field::SizeField;
use super::sizes::{Coarse, Sizes};
use super::surfaces::Surfaces;
use crate::base::{CellId, Error, Point, Result, Threads, VertexId, reasons};
use crate::delaunay::{Constrained, EdgePoints, constrain};
use crate::geometry::predicates::orient3d;
use crate::geometry::rounding;
use crate::geometry::tet::volume;
use crate::mesh::{CellKind, Cells, Field, LabelNames, Mesh, Qualities};
use crate::names;
use crate::preflight::Preflight;
use crate::remesh::{self, Improve, SurfaceRule, remesh_labelled};

/// A thread takes this many cells at a time.
const SWEEP: usize = 1 << 14;

/// Vertices of a flat facet may lie off a plane through three of them by up to this many times the rounding
/// error of a coordinate.
const OFF_PLANE: f64 = 4.0;

names! {
    /// Which surfaces get new triangles. Where triangles are divided, the shape is kept to rounding: flat
    /// parts get new triangles in their own planes, creases and borders of patches are divided into parts of
    /// about the size. [`Sizes::coarse`] says which are far coarser.
    pub enum Dividing: "rule for the surface" {
        /// Only surfaces most of whose triangles are far coarser than the size, or narrow.
        Coarse = "auto",
        /// All surfaces.
        Always = "divide",
        /// No surface: every triangle is a facet of tets.
        Never = "keep",
        /// All surfaces get even triangles of the size, within a distance of the given ones; creases,
        /// corners, rims and borders of patches stay.
        Adapt = "adapt",
    }
}

/// Options for filling surfaces.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// What happens to points that must be put on edges of the surface. Default: they move inside.
    pub edge_points: EdgePoints,
    /// The edge lengths inside; `None`: no points inside. Default: `None`.
    pub sizes: Option<Sizes>,
    /// Whether the triangles of the surfaces are divided to a uniform size. Default: [`Dividing::Coarse`].
    pub dividing: Dividing,
    /// How surfaces are adapted, with [`Dividing::Adapt`].
    pub adapting: Adapting,
    /// Places in bodies, with names for their regions. Default: none.
    pub seeds: Vec<Seed>,
    /// Places in bodies that are left out. Default: none.
    pub holes: Vec<Point>,
    /// Whether bodies enclosed by closed surfaces turned inward are left out, such as the cavity of a hollow
    /// body; those named by a seed stay. Default: false.
    pub voids: bool,
    /// How the tets are repaired and improved afterwards; `None`: not at all. Default: `None`.
    pub improve: Option<remesh::Options>,
    /// Layers of thin prisms on walls. Default: `None`.
    pub layers: Option<Layers>,
}

impl Options {
    /// Options with points inside by `sizes`, if given. Tets with an EAS below `min_eas` are repaired; if
    /// only sizes are given, the default bound applies. With sizes, tets are also improved as a whole.
    pub fn with_sizes(sizes: Option<Sizes>, min_eas: Option<f64>) -> Self {
        let min_eas = min_eas.or(sizes.as_ref().map(|_| remesh::Options::default().min_eas));
        let improve_all = sizes.as_ref().map(|_| Improve::filled());
        let improve = min_eas.map(|min_eas| remesh::Options {
            min_eas,
            improve: improve_all,
            ..remesh::Options::default()
        });
        Self { sizes, improve, ..Self::default() }
    }

    /// The size to which surfaces are divided, if any; `coarse` is given if they are far coarser.
    fn divided_to(&self, coarse: Option<Coarse>) -> Result<Option<f64>> {
        match (self.dividing, &self.sizes) {
            (Dividing::Never | Dividing::Adapt, _) => Ok(None),
            (Dividing::Coarse, _) => Ok(coarse.map(|coarse| coarse.size)),
            (Dividing::Always, Some(Sizes::Uniform(size))) => Ok(Some(*size)),
            (Dividing::Always, _) => {
                Err(Error::options("the surface is to be divided, but there is no uniform size")
                    .remedy("give --size H only, or keep the surface as it is"))
            }
        }
    }
}

/// The result of filling surfaces.
#[derive(Clone, Debug)]
pub struct Filled {
    /// The tets, with regions 1, 2, ..., followed by the triangles of the surfaces, with their patches.
    pub mesh: Mesh,
    /// Statistics.
    pub report: Report,
    /// The report of improving the tets, if requested.
    pub improved: Option<remesh::Report>,
    /// The report on layers, if requested.
    pub layers: Option<layers::Report>,
}

impl Filled {
    /// Whether everything requested by `options` was reached: triangles are whole, tets have positive volume
    /// and none is left bad, and layers found space.
    pub fn is_complete(&self, options: &Options) -> bool {
        self.not_reached(options).is_none()
    }

    /// Explains what requested by `options` was not reached; `None` if everything was.
    pub fn not_reached(&self, options: &Options) -> Option<String> {
        let Report { points_on_edges, not_positive, triangles, triangles_kept, triangles_outside, .. } =
            self.report;
        // A surface with new triangles has none to keep.
        let is_given = self.report.divided.is_none() && self.report.adapted.is_none();
        let keeps_triangles = options.edge_points != EdgePoints::Stay && is_given;
        let in_pieces = (keeps_triangles && points_on_edges > 0).then(|| {
            format!(
                "{} triangles of the surfaces are divided: there was no space inside for {points_on_edges} points on \
                 them",
                triangles.saturating_sub(triangles_kept + triangles_outside)
            )
        });
        let flat = (not_positive > 0).then(|| {
            format!("{not_positive} tets do not have positive volume in floating-point coordinates")
        });
        let strays = self.report.adapted.and_then(|of| strayed([of.to_given, of.from_given], of.allowed));
        let without_layers = self.layers.as_ref().is_some_and(|layers| layers.prisms == 0);
        reasons([
            lost(self.report.lost),
            strays,
            in_pieces,
            flat,
            self.improved.as_ref().and_then(remesh::Report::not_reached),
            without_layers.then(|| "there was no space for any layer".to_owned()),
        ])
    }
}

/// Statistics on filling.
#[derive(Clone, Debug, Default, Serialize)]
#[non_exhaustive]
pub struct Report {
    /// Triangles of the given surfaces, those shared by two surfaces counted once.
    pub triangles: usize,
    /// Tets before improvement.
    pub tets: usize,
    /// Points left on edges or triangles of the surface because there was no space inside: the triangles
    /// there are in pieces.
    pub points_on_edges: usize,
    /// Points inside the surfaces.
    pub points_inside: usize,
    /// Triangles that are facets of tets unchanged.
    pub triangles_kept: usize,
    /// Triangles that enclose nothing on either side, which are left out.
    pub triangles_outside: usize,
    /// The edge lengths of the surface, if it is far coarser than the size of edges inside.
    pub coarse: Option<Coarse>,
    /// How many triangles such a surface was divided into.
    pub divided: Option<Divided>,
    /// Triangles of walls and gaps that a wrap has lost before, since they are thinner than its distance.
    pub lost: usize,
    /// How surfaces were adapted, if requested.
    pub adapted: Option<Adapted>,
    /// Bodies left out because closed surfaces turned inward enclose them.
    pub voids: usize,
    /// The worst EAS before improvement.
    pub worst_eas: f64,
    /// Tets of the final mesh without positive volume.
    pub not_positive: usize,
    /// The regions of the final mesh, from region 1 on.
    pub bodies: Vec<Body>,
}

/// Fills surfaces with tets. `preflight` must be the result of checking these surfaces.
///
/// # Errors
/// When `preflight` found faults: the error gives the first, and their number. When the surfaces enclose
/// nothing. When an edge comes so close to others that floating-point coordinates cannot divide it further.
/// When a size is not a valid length, or requires too many points. When a seed or a hole lies in no body or
/// on a surface, or contradicts another.
pub fn fill(
    surfaces: &Surfaces,
    preflight: &Preflight,
    options: &Options,
    threads: &Threads,
) -> Result<Filled> {
    if let Some(error) = preflight.first_error() {
        return Err(error);
    }
    let named = Named { seeds: &options.seeds, holes: &options.holes, leaves_voids_out: options.voids };
    options.sizes.as_ref().map_or(Ok(()), |sizes| sizes.check(surfaces))?;
    options.improve.as_ref().map_or(Ok(()), remesh::Options::check)?;
    if options.dividing == Dividing::Adapt {
        let (adapted, sizes, report) =
            adapt(surfaces, options.sizes.as_ref(), &options.adapting, &[], true, threads)?;
        let preflight = adapted.preflight(threads);
        let options = Options { dividing: Dividing::Never, sizes, ..options.clone() };
        let mut filled = fill(&adapted, &preflight, &options, threads)?;
        filled.report.adapted = Some(report);
        return Ok(filled);
    }
    let coarse = options.sizes.as_ref().and_then(|sizes| sizes.coarse(surfaces));
    let divided = options.divided_to(coarse)?.map(|size| divide(surfaces, size, threads)).transpose()?;
    let off_plane = divided.is_some().then(|| OFF_PLANE * rounding::of(&surfaces.points));
    let (surfaces, divided) = match &divided {
        Some((surfaces, divided)) => (surfaces, Some(*divided)),
        None => (surfaces, None),
    };
    let joined = surfaces.without_shared();
    let triangles = joined.triangles.clone();
    let at_corners = options.sizes.as_ref().map_or_else(Vec::new, |sizes| sizes.at_corners(&joined));
    let joined = joined.compact();
    if let Some(layers) = &options.layers {
        if options.edge_points == EdgePoints::Stay {
            return Err(Error::options(
                "layers cannot be combined with points that stay on edges of the surface",
            )
            .remedy("layers need undivided triangles: let points move inside"));
        }
        // This finds out which bodies lie on the two sides of each triangle, and which bodies seeds and holes
        // lie in.
        let mut whole = fill_tets(&joined, Vec::new(), options, threads)?;
        let arranged = bodies::arrange(&mut whole, surfaces, &triangles, &named)?;
        let grown = GrownLayers::new(&joined, layers, whole.triangle_to_bodies, threads)?;
        let mut filled = fill_with_layers(grown, &at_corners, arranged, layers, options, threads)?;
        (filled.report.coarse, filled.report.divided) = (coarse, divided);
        return Ok(filled);
    }
    let points = points_inside(&joined, options.sizes.as_ref(), at_corners, threads)?;
    let n_points = joined.points.len() + points.len();
    let mut tets = fill_tets(&joined, points, options, threads)?;
    threads.watch().report_and_check("finding regions", 0, 0)?;
    let arranged = bodies::arrange(&mut tets, surfaces, &triangles, &named)?;
    let mut report = report(&joined, &tets, n_points, threads);
    let (mut mesh, _) = mesh(&joined, &tets, threads);
    mesh.label_names.regions = region_names(&arranged);
    drop(tets);
    let (mesh, improved) = improve(mesh, options, coarse.is_some(), off_plane, threads)?;
    (report.coarse, report.divided) = (coarse, divided);
    (report.bodies, report.not_positive) = (bodies_of(&mesh, &arranged), not_positive(&mesh, threads));
    report.voids = arranged.n_left_out;
    Ok(Filled { report, mesh, improved, layers: None })
}

/// Fills the core that layers leave, and joins it with them. `at_corners` are sizes at the corners of the
/// surfaces' triangles.
fn fill_with_layers(
    mut grown: GrownLayers,
    at_corners: &[[f64; 3]],
    arranged: NumberedBodies,
    layers: &Layers,
    options: &Options,
    threads: &Threads,
) -> Result<Filled> {
    let (tets, n_points) = grown.fill(threads, |core, to_triangle| {
        let of_core = to_triangle.iter().filter_map(|&t| at_corners.get(t as usize).copied()).collect();
        let points = points_inside(core, options.sizes.as_ref(), of_core, threads)?;
        let n_points = core.points.len() + points.len();
        Ok((fill_tets(core, points, options, threads)?, n_points))
    })?;
    let mut report = report(grown.core(), &tets, n_points, threads);
    let (core, core_to_mesh) = mesh(grown.core(), &tets, threads);
    let mut glued = grown.glue(&core, &core_to_mesh);
    glued.label_names.regions = region_names(&arranged);
    let (mut mesh, improved) = improve(glued, options, false, None, threads)?;
    let split = layers::split(mesh.clone());
    (report.bodies, report.not_positive) = (bodies_of(&split, &arranged), not_positive(&split, threads));
    report.voids = arranged.n_left_out;
    match layers.keep_prisms {
        true => bodies::count_cells(&mut report.bodies, &mesh),
        false => mesh = split,
    }
    report.triangles = grown.n_triangles();
    [report.triangles_kept, report.triangles_outside] =
        grown.count(|i| tets.triangle_to_facets.list(i).len() == 1);
    Ok(Filled { mesh, report, improved, layers: Some(grown.report()) })
}

/// Returns tets within surfaces, with the given points inside.
fn fill_tets(
    surfaces: &Surfaces,
    inside: Vec<Point>,
    options: &Options,
    threads: &Threads,
) -> Result<Constrained> {
    let mut points = surfaces.points.clone();
    points.extend(inside);
    let tets = constrain(&points, &surfaces.triangles, options.edge_points, threads)?;
    if tets.tets.is_empty() {
        return Err(Error::input("the surfaces enclose nothing")
            .remedy("close them; `motet info` shows what is open"));
    }
    Ok(tets)
}

/// Repairs bad tets. A divided surface, whose vertices lie off their planes by up to `off_plane`, may be
/// divided in another way, its shape kept. On an undivided surface far coarser than the sizes only one round
/// is made, since most tets there stay bad however often they are tried.
fn improve(
    mesh: Mesh,
    options: &Options,
    is_coarse: bool,
    off_plane: Option<f64>,
    threads: &Threads,
) -> Result<(Mesh, Option<remesh::Report>)> {
    let Some(improve) = &options.improve else { return Ok((mesh, None)) };
    let rounds = if is_coarse && off_plane.is_none() { improve.rounds.min(1) } else { improve.rounds };
    let surface = match off_plane {
        Some(_) => SurfaceRule::Flat { distance: off_plane },
        None => improve.surface,
    };
    let improve = remesh::Options { rounds, surface, ..improve.clone() };
    let (mesh, report) = remesh_labelled(&mesh, &improve, threads)?;
    Ok((mesh, Some(report)))
}

/// The names of bodies as names of regions, which are numbered from 1.
fn region_names(arranged: &NumberedBodies) -> BTreeMap<i32, String> {
    arranged.names.iter().map(|(&body, name)| (body as i32 + 1, name.clone())).collect()
}

/// The bodies of the finished mesh, with the voids among them marked.
fn bodies_of(mesh: &Mesh, arranged: &NumberedBodies) -> Vec<Body> {
    let mut bodies = bodies::bodies_of_mesh(mesh);
    for body in &mut bodies {
        body.is_void = arranged.voids.contains(&(body.region as u32).wrapping_sub(1));
    }
    bodies
}

/// Chooses points inside by the requested sizes.
fn points_inside(
    surfaces: &Surfaces,
    sizes: Option<&Sizes>,
    at_corners: Vec<[f64; 3]>,
    threads: &Threads,
) -> Result<Vec<Point>> {
    threads.watch().report_and_check("choosing points inside", 0, 0)?;
    let (points, triangles) = (&surfaces.points, &surfaces.triangles);
    match sizes {
        None => Ok(Vec::new()),
        Some(Sizes::Uniform(size)) => interior::lattice(points, triangles, *size, threads),
        Some(Sizes::Graded(grading)) => {
            graded::check(points, triangles, &at_corners, grading)?;
            let field = SizeField::new(points, triangles, at_corners, grading, threads);
            graded::lattice(points, triangles, &field, threads)
        }
    }
}

fn not_positive(mesh: &Mesh, threads: &Threads) -> usize {
    let corners = |cell: usize| match (mesh.cells.kinds()[cell], mesh.cells.vertices(CellId::new(cell))) {
        (CellKind::TETRA, &[a, b, c, d]) => Some([a, b, c, d].map(|v| mesh.points[v.index()])),
        _ => None,
    };
    let is_not = |&[a, b, c, d]: &[Point; 4]| orient3d(a, b, c, d) <= 0 || volume([a, b, c, d]) <= 0.0;
    let counts = threads.in_runs(mesh.cells.len(), SWEEP, |(): &mut (), run| {
        vec![run.filter_map(corners).filter(is_not).count()]
    });
    counts.into_iter().sum()
}

/// Collects statistics. The first `n_points` points were given; points on edges follow.
fn report(surfaces: &Surfaces, filled: &Constrained, n_points: usize, threads: &Threads) -> Report {
    let eas = Qualities::eas_of_each(&filled.points, &filled.tets, threads);
    let is_used = used_vertices(filled.points.len(), filled.tets.as_flattened().iter());
    let n_used = |of: std::ops::Range<usize>| is_used[of].iter().filter(|n| **n).count();
    let points_on_edges = n_used(n_points..n_points + filled.on_edges.len() + filled.in_triangles.len());
    let is_kept = |list: &[[VertexId; 3]]| list.len() == 1;
    Report {
        triangles: surfaces.triangles.len(),
        tets: filled.tets.len(),
        points_on_edges,
        points_inside: n_used(surfaces.points.len()..is_used.len()) - points_on_edges,
        triangles_kept: filled.triangle_to_facets.iter().filter(|list| is_kept(list)).count(),
        triangles_outside: filled.triangle_to_bodies.iter().filter(|b| **b == [None; 2]).count(),
        coarse: None,
        divided: None,
        lost: surfaces.n_lost,
        adapted: None,
        voids: 0,
        worst_eas: eas.into_iter().fold(f64::INFINITY, f64::min),
        not_positive: 0,
        bodies: Vec::new(),
    }
}

/// Returns tets and triangles as cells, and the new number of each point; points that no cell uses are left
/// out.
fn mesh(surfaces: &Surfaces, filled: &Constrained, threads: &Threads) -> (Mesh, Vec<VertexId>) {
    let (mut triangles, mut patches) = (Vec::new(), vec![0; filled.tets.len()]);
    for (i, list) in filled.triangle_to_facets.iter().enumerate() {
        if filled.triangle_to_bodies[i] != [None; 2] {
            triangles.extend_from_slice(list);
            patches.resize(filled.tets.len() + triangles.len(), surfaces.patches[i]);
        }
    }
    let used = filled.tets.as_flattened().iter().chain(triangles.as_flattened());
    let is_used = used_vertices(filled.points.len(), used);
    let (points, old_to_new) = compact(&filled.points, &is_used);
    let new = |v: VertexId| old_to_new[v.index()];
    let mut cells = Cells::new();
    cells.push_all(CellKind::TETRA, &threads.map(filled.tets.len(), |t| filled.tets[t].map(new)), threads);
    triangles.iter_mut().for_each(|triangle| *triangle = triangle.map(new));
    cells.push_all(CellKind::TRIANGLE, &triangles, threads);
    let mut regions: Vec<i32> = filled.bodies.iter().map(|&body| body as i32 + 1).collect();
    regions.resize(cells.len(), 0);
    let mesh = Mesh {
        cell_data: vec![Field::scalars("region", regions), Field::scalars("patch", patches)],
        label_names: LabelNames { patches: surfaces.patch_names.clone(), ..LabelNames::default() },
        ..Mesh::new(points, cells)
    };
    (mesh, old_to_new)
}
