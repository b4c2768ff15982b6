#![no_main]
//! Fills the boundary of a body from bytes: every triangle is a facet, volumes are as enclosed, tets are
//! positive or reported.

mod solids;

use libfuzzer_sys::fuzz_target;
use motet::base::{Threads, VertexId};
use motet::mesh::Surface;
use motet::mesh::cone_volume;
use motet::meshing::{Grading, Options, Sizes, Surfaces, fill};
use motet::preflight::Role;
use solids::Numbers;

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes);
    let sizes = match numbers.below(4) {
        0 | 1 => None,
        2 => Some(Sizes::Uniform(0.4)),
        _ => Some(Sizes::Graded(Grading { at_points: None, growth: 0.5, largest: None })),
    };
    let min_eas = [None, Some(0.2)][numbers.below(2)];
    let most = [0.0, 0.2, 0.45, 1.0][numbers.below(4)];
    let body = solids::cubes(&mut numbers, most);
    let skin = solids::skin(&body);
    let threads = Threads::single();
    let Ok(surfaces) = Surfaces::new(&[(&skin, Role::Boundary, "skin")]) else { return };
    let preflight = surfaces.preflight(&threads);
    let options = Options { voids: true, ..Options::with_sizes(sizes, min_eas) };
    let Ok(filled) = fill(&surfaces, &preflight, &options, &threads) else { return };
    solids::check(&filled.mesh);
    assert_eq!(solids::n_not_positive(&filled.mesh) > 0, filled.report.not_positive > 0, "as reported");
    let surface = Surface::of(&skin);
    let cone = |t: &[VertexId; 3]| cone_volume(t.iter().copied(), &surface.points, surface.points[0]);
    let enclosed: f64 = surface.triangles.iter().map(cone).sum();
    let total: f64 = solids::volumes(&filled.mesh).values().sum();
    // A part of the skin that faces inward encloses a negative volume.
    let faces_outward = solids::n_not_positive(&body) == 0;
    if faces_outward && filled.report.triangles_kept == filled.report.triangles {
        let off = (total - enclosed).abs();
        assert!(off <= solids::tolerance(&filled.mesh, &skin), "{total} filled, {enclosed} enclosed");
    }
});
