//! Floor 6: bad tets found, classified, repaired, and only those.

mod candidate;
pub mod classify;
mod options;
mod repair;
mod report;
mod surface;

use std::time::Instant;

use crate::base::{Result, TetId};
use crate::kernel::Complex;
use crate::mesh::{TetMesh, bounds};
use crate::remesh::surface::Surface;

pub use options::{DEFAULT_DISTANCE, Goal, Options, SurfaceRule};
pub use report::{Operation, Report};

/// A mesh after remeshing, and what was done.
#[derive(Debug)]
pub struct Outcome {
    /// The complex.
    pub complex: Complex,
    /// What was done.
    pub report: Report,
}

/// Repairs the bad tets of a mesh.
///
/// # Errors
/// When the mesh is not one: see [`Complex::new`].
pub fn remesh(mesh: &TetMesh, options: &Options) -> Result<Outcome> {
    let start = Instant::now();
    let mut complex = Complex::new(mesh)?;
    let surface = adaptable(&mut complex, mesh, options);
    let mut report = Report { seconds: [start.elapsed().as_secs_f64(), 0.0], ..Report::default() };
    let start = Instant::now();
    let bad = complex.below(options.min_eas);
    note(&complex, &bad, 0, &mut report);
    let mut repair = repair::Repair::new(complex, surface, options.min_eas);
    let mut left = repair.run(bad, options.rounds);
    if options.goal == Goal::Best {
        repair.best(options.rounds);
        left = repair.complex.below(options.min_eas);
    }
    report.operations = repair.operations;
    let complex = repair.complex;
    note(&complex, &left, 1, &mut report);
    report.kept = complex.tets().filter(|&t| complex.is_original(t)).count();
    report.seconds[1] = start.elapsed().as_secs_f64();
    Ok(Outcome { complex, report })
}

/// The surface, where it may change.
fn adaptable(complex: &mut Complex, mesh: &TetMesh, options: &Options) -> Option<Surface> {
    let SurfaceRule::Adapt { distance } = options.surface else { return None };
    let extent = || {
        let [low, high] = bounds(&mesh.points).unwrap_or_default();
        (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max)
    };
    surface::hold_features(complex);
    complex.adapt_surface();
    Some(Surface::of(complex, distance.unwrap_or_else(|| DEFAULT_DISTANCE * extent())))
}

fn note(complex: &Complex, bad: &[TetId], when: usize, report: &mut Report) {
    let by_type = if when == 0 { &mut report.found } else { &mut report.left };
    for &tet in bad {
        by_type[classify::classify(complex.corners(tet)).number()] += 1;
    }
    report.tets[when] = complex.n_tets();
    report.worst_eas[when] = complex.worst().map_or(0.0, |w| w.1);
    report.inverted[when] = bad.iter().filter(|&&t| complex.quality(t) <= 0.0).count();
}
