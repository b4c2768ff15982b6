//! The remeshing of a mesh from start to end: join, find, repair, extract.

use std::time::Instant;

use crate::base::{CellId, Point, Result, TetId, Threads};
use crate::kernel::{Complex, Extract};
use crate::mesh::{OrientedTets, TetMesh, bounds, largest_extent};
use crate::remesh::held::{Required, hold};
use crate::remesh::input_mesh::{InputMesh, Pose};
use crate::remesh::left::explain;
use crate::remesh::lengths::Lengths;
use crate::remesh::options::{Goal, Improve, Options, SurfaceRule};
use crate::remesh::repair::{Aim, Density, Outside, Repair, Sizing, is_among, treatments};
use crate::remesh::report::{Operation, Report, SizesReport, State};
use crate::remesh::sizes::{LONG, SizeField, Sizes};
use crate::remesh::surface::{Crease, Surface};

/// A mesh after remeshing, with its history and a report.
#[derive(Debug)]
pub struct Outcome {
    /// The new mesh, and where each of its vertices, tets and triangles came from.
    pub extract: Extract,
    /// The report of what was done.
    pub report: Report<TetId>,
}

/// Repairs the bad tets of a mesh, and only those; if [`Options::sizes`] are given, brings edges to them,
/// too. The result is the same for any number of threads.
///
/// # Errors
/// If the mesh is invalid (see [`Complex::new`]), if a size is not a positive length, and if a mesh of these
/// sizes would have far too many tets: more than ten million and more than 100 times as many as `mesh`, or
/// more than 2^28.
pub fn remesh(mesh: &TetMesh, options: &Options, threads: &Threads) -> Result<Outcome> {
    remesh_keeping(mesh, &Required::default(), options, threads)
}

/// Remeshes as [`remesh`] does, leaving everything that is `required`.
pub(super) fn remesh_keeping(
    mesh: &TetMesh,
    required: &Required,
    options: &Options,
    threads: &Threads,
) -> Result<Outcome> {
    options.check()?;
    let mut clock = Clock(Instant::now());
    if let Some(improve) = &options.improve {
        improve.check(mesh.points.len())?;
    }
    let min_eas = options.limit();
    let mut report = Report { min_eas, ..Report::default() };
    let max_tets = options.sizes.as_ref().map(|sizes| sizes.check(mesh)).transpose()?;
    threads.watch().report_and_check("joining tets", 0, 0)?;
    let mut complex = Complex::new_on(mesh, threads)?;
    hold(&mut complex, mesh, &options.held, required, options.surface != SurfaceRule::Keep);
    report.seconds.join = clock.lap();

    let Judged { bad, layers, others } = judge(&mut complex, mesh, options, &mut report, threads);
    let n_peeled = complex.peel();
    let bad: Vec<TetId> = bad.into_iter().filter(|&t| complex.is_alive(t)).collect();
    let surface = adaptable(&mut complex, mesh, options);
    let is_graded = matches!(options.sizes, Some(Sizes::Vertices(_)));
    let looks_back =
        options.improve.as_ref().is_some_and(|improve| improve.density.is_some() || improve.pose.is_some());
    let input = InputMesh::new(mesh, is_graded || looks_back);
    let splits = options.goal != Goal::Coarsen;
    let longest = if splits { LONG } else { 1.0 };
    let mut sizing = options.sizes.as_ref().zip(max_tets).map(|(sizes, max_tets)| Sizing {
        field: SizeField::new(sizes, &input, longest),
        splits,
        max_tets,
    });
    let lengths_before = sizing.as_mut().map(|sizing| Lengths::of(&complex, &mut sizing.field, &input));
    let mut repair = Repair::new(complex, input, surface, others, min_eas, threads);
    repair.outside = options.part_of.map(|whole| Outside::of(whole, &report.before));
    repair.operations.add_many(Operation::Peeling, n_peeled);
    let pose = options.improve.as_ref().and_then(|improve| improve.pose.clone());
    repair.pose = pose.map(Pose::new);
    let mut left = match sizing {
        Some(sizing) => repair.bring_to_sizes(sizing, options.rounds)?,
        None => repair.run(bad, options.rounds)?,
    };
    left = finish_repair(&mut repair, left, options)?;
    if let Some(improve) = options.improve.as_ref().filter(|_| !repair.is_hopeless()) {
        let density = improve.density.as_ref().map(|density| {
            Density::new(&density.sizes, &repair.input, report.before.free_vertices, density.lack)
        });
        let vertices_left = repair.vertices_of(&left);
        improve_near(&mut repair, improve, density, options, mesh.tets.len())?;
        left = repair.try_again_at(&vertices_left, min_eas, options.rounds)?;
    }
    report.operations = repair.operations;
    let (complex, input, sizing) = (repair.complex, repair.input, repair.sizing);
    report.sizes = lengths_before.zip(sizing).map(|(before, mut sizing)| SizesReport {
        before,
        after: Lengths::of(&complex, &mut sizing.field, &input),
    });
    report.seconds.repair = clock.lap();

    let extract = complex.extract(mesh);
    if options.keep_layers {
        report.layers = rejudge(&complex, &extract, &mut left, &layers, min_eas, threads);
    }
    report.after = State::of(&complex, &left, report.layers, |t| extract.tet(t));
    report.kept = mesh.tets.len() - extract.removed_tets.len();
    report.kept_share = report.kept as f64 / mesh.tets.len().max(1) as f64;
    report.left = explain(&complex, &left, min_eas, |t| extract.tet(t));
    report.seconds.extract = clock.lap();
    Ok(Outcome { extract, report })
}

/// The tets of a mesh that are not good.
struct Judged {
    /// Those to be repaired.
    bad: Vec<TetId>,
    /// Those of boundary layers, which stay.
    layers: Vec<TetId>,
    /// Those that cannot count as bad.
    others: Vec<bool>,
}

/// Finds the bad tets, locks those of boundary layers, and records the state before any change.
fn judge(
    complex: &mut Complex,
    mesh: &TetMesh,
    options: &Options,
    report: &mut Report<TetId>,
    threads: &Threads,
) -> Judged {
    let others = options.only.as_ref().map_or_else(Vec::new, |only| others(mesh.tets.len(), only));
    let mut bad = complex.below(report.min_eas, threads);
    bad.retain(|&t| !is_among(&others, t));
    let n_bad = bad.len();
    bad.retain(|&t| !complex.is_locked(t));
    report.held = n_bad - bad.len();
    let layers = match options.keep_layers {
        true => split_off_layers(&oriented(complex, mesh), &mesh.points, &mut bad, report.min_eas),
        false => Vec::new(),
    };
    layers.iter().for_each(|&tet| complex.lock(tet));
    report.before = State::of(complex, &bad, layers.len(), |t| t);
    Judged { bad, layers, others }
}

/// Tries again what is left, removes superfluous vertices, and improves what the goal requests; returns the
/// tets that are left.
fn finish_repair(repair: &mut Repair, mut left: Vec<TetId>, options: &Options) -> Result<Vec<TetId>> {
    let min_eas = options.limit();
    for &treatment in treatments(options.surface) {
        if !left.is_empty() && !repair.is_hopeless() {
            let treat = |repair: &mut Repair, left| repair.treat(treatment, left, options.rounds);
            left = repair.beside_forced(&left, treat)?;
        }
    }
    // With sizes, they decide which vertices are too close.
    if repair.sizing.is_none() && repair.thin()? {
        left = repair.below(min_eas);
    }
    if options.goal == Goal::Best && !repair.is_hopeless() {
        repair.best(options.rounds)?;
        left = repair.below(min_eas);
    }
    if repair.sizing.is_some() && options.goal == Goal::Repair && !repair.is_hopeless() {
        let aim = Aim { below: Improve::NEW_TETS, floor: min_eas, limit: min_eas, cost: 0.0 };
        repair.improve(aim, repair.near_changes())?;
        left = repair.below(min_eas);
    }
    Ok(left)
}

/// Keeps the number of vertices, and improves tets of low quality near changes and among the requested cells.
fn improve_near(
    repair: &mut Repair,
    improve: &Improve,
    density: Option<Density>,
    options: &Options,
    n_tets: usize,
) -> Result<()> {
    let min_eas = options.limit();
    let mut zone = match &improve.cells {
        None => repair.complex.tets().collect(),
        Some(cells) => {
            let requested = cells.iter().map(|cell| TetId(cell.0));
            let mut zone = repair.near_changes();
            zone.extend(requested.filter(|&tet| repair.complex.is_original(tet)));
            zone.sort_unstable();
            zone.dedup();
            zone
        }
    };
    if let Some(mut density) = density {
        repair.keep_density(&mut density, min_eas, &mut zone)?;
    }
    if let Some(cells) = improve.cells.as_ref().filter(|_| improve.keeps_others) {
        repair.kept = others(n_tets, cells);
    }
    let aim = Aim { below: improve.below, floor: min_eas, limit: min_eas, cost: improve.cost };
    match improve.raises_worst && !repair.are_too_many(repair.below(min_eas).len()) {
        true => repair.best_within(aim, zone, options.rounds),
        false => repair.improve(aim, zone),
    }
}

/// Marks the tets that are not in `only`.
fn others(n_tets: usize, only: &[CellId]) -> Vec<bool> {
    let mut others = vec![true; n_tets];
    for cell in only.iter().filter(|cell| cell.index() < n_tets) {
        others[cell.index()] = false;
    }
    others
}

/// Orients the tets of a complex that nothing has changed since it was made of `mesh`.
fn oriented(complex: &Complex, mesh: &TetMesh) -> OrientedTets {
    let tets = (0..mesh.tets.len()).map(|t| complex.vertices(TetId::new(t))).collect();
    OrientedTets::given(tets, complex.walls().map(|(_, wall)| wall.sides[0]).collect())
}

/// Removes tets that belong to boundary layers from `low`, which keeps the bad ones, and returns them.
fn split_off_layers(tets: &OrientedTets, points: &[Point], low: &mut Vec<TetId>, min_eas: f64) -> Vec<TetId> {
    let judged = tets.judge(points, low.iter().map(|tet| tet.index()).collect(), min_eas);
    let [bad, layers] = [judged.bad, judged.layers].map(|tets| tets.into_iter().map(TetId::new).collect());
    *low = bad;
    layers
}

/// Judges the tets in `left` and `layers` anew, in the extracted mesh: keeps the bad ones in `left`, worst
/// first, and returns how many belong to layers. A count of bad tets in the written mesh then gives the same
/// number.
fn rejudge(
    complex: &Complex,
    extract: &Extract,
    left: &mut Vec<TetId>,
    layers: &[TetId],
    min_eas: f64,
    threads: &Threads,
) -> usize {
    left.extend_from_slice(layers);
    if left.is_empty() {
        return 0;
    }
    let mut low: Vec<TetId> = left.iter().map(|&tet| extract.tet(tet)).collect();
    low.sort_unstable();
    let tets = OrientedTets::of_tets(&extract.mesh, threads);
    let layers = split_off_layers(&tets, &extract.mesh.points, &mut low, min_eas);
    left.retain(|&tet| low.binary_search(&extract.tet(tet)).is_ok());
    left.sort_unstable_by(|&a, &b| complex.quality(a).total_cmp(&complex.quality(b)).then(a.cmp(&b)));
    layers.len()
}

/// The input surface, if it may change.
fn adaptable(complex: &mut Complex, mesh: &TetMesh, options: &Options) -> Option<Surface> {
    let extent = || match options.part_of {
        Some(whole) => whole.extent,
        None => bounds(&mesh.points).map_or(0.0, largest_extent),
    };
    let distance = options.surface.distance(extent)?;
    let mut surface = Surface::of(complex, distance);
    surface.constrain_features(complex, Crease::SHARP);
    complex.adapt_surface();
    Some(surface)
}

/// Measures the time between laps, in seconds.
struct Clock(Instant);

impl Clock {
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        now.duration_since(std::mem::replace(&mut self.0, now)).as_secs_f64()
    }
}
