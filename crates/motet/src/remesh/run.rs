//! From a mesh to a better one: join, find, repair, extract.

use std::time::Instant;

use crate::base::{Result, TetId};
use crate::kernel::{Complex, Extract};
use crate::mesh::{TetMesh, bounds};
use crate::remesh::layers::Layers;
use crate::remesh::left::explain;
use crate::remesh::options::{Goal, Options};
use crate::remesh::repair::{Repair, passes};
use crate::remesh::report::{Report, State};
use crate::remesh::surface::{Crease, Surface};

/// A mesh after remeshing, where each part of it was before, and what was done.
#[derive(Debug)]
pub struct Outcome {
    /// The mesh, and what each of its rows was before.
    pub extract: Extract,
    /// What was done.
    pub report: Report,
}

/// Repairs the bad tets of a mesh, and only those.
///
/// # Errors
/// When the mesh is not one: see [`Complex::new`].
pub fn remesh(mesh: &TetMesh, options: &Options) -> Result<Outcome> {
    let mut watch = Watch(Instant::now());
    let min_eas = options.limit();
    let mut report = Report { min_eas, ..Report::default() };
    let mut complex = Complex::new(mesh)?;
    let surface = adaptable(&mut complex, mesh, options);
    report.seconds.join = watch.lap();

    let mut bad = complex.below(min_eas);
    report.layers = spare_layers(&mut complex, &mut bad, options);
    report.before = State::of(&complex, &bad, |t| t);
    let mut repair = Repair::new(complex, surface, min_eas);
    let mut left = repair.run(bad, options.rounds);
    for pass in passes(options.surface) {
        if !left.is_empty() {
            left = repair.beside_forced(&left, |repair, left| repair.pass(*pass, left, options.rounds));
        }
    }
    if repair.thin() {
        left = repair.below(min_eas);
    }
    if options.goal == Goal::Best {
        repair.best(options.rounds);
        left = repair.below(min_eas);
    }
    report.operations = repair.operations;
    let complex = repair.complex;
    report.seconds.repair = watch.lap();

    let extract = complex.extract(mesh);
    report.after = State::of(&complex, &left, |t| extract.tet(t));
    report.kept = mesh.tets.len() - extract.gone_tets.len();
    report.kept_share = report.kept as f64 / mesh.tets.len().max(1) as f64;
    report.left = explain(&complex, &left, min_eas, |t: TetId| extract.tet(t).0);
    report.seconds.extract = watch.lap();
    Ok(Outcome { extract, report })
}

/// Takes the tets of boundary layers out of the bad ones, and locks all that are thin; how many were taken out.
fn spare_layers(complex: &mut Complex, bad: &mut Vec<TetId>, options: &Options) -> usize {
    if !options.keep_layers || bad.is_empty() {
        return 0;
    }
    let Some(layers) = Layers::of(complex) else { return 0 };
    let (thin, others): (Vec<_>, Vec<_>) =
        bad.iter().partition(|&&t| layers.holds(complex, t, options.limit()));
    if thin.len() < others.len() {
        return 0;
    }
    thin.iter().for_each(|&tet| complex.lock(tet));
    *bad = others;
    thin.len()
}

/// The surface, where it may change.
fn adaptable(complex: &mut Complex, mesh: &TetMesh, options: &Options) -> Option<Surface> {
    let distance = options.surface.distance(|| {
        let [low, high] = bounds(&mesh.points).unwrap_or_default();
        (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max)
    })?;
    let mut surface = Surface::of(complex, distance);
    surface.hold_features(complex, Crease::SHARP);
    complex.adapt_surface();
    Some(surface)
}

/// Tells the time since it was last asked.
struct Watch(Instant);

impl Watch {
    fn lap(&mut self) -> f64 {
        let now = Instant::now();
        now.duration_since(std::mem::replace(&mut self.0, now)).as_secs_f64()
    }
}
