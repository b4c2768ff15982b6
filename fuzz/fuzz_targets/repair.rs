#![no_main]
//! Repairs, coarsens or sizes a body from bytes: the result is a valid mesh with the same volumes; tets are
//! positive or reported.

mod solids;

use libfuzzer_sys::fuzz_target;
use motet::base::Threads;
use motet::mesh::history::Rules;
use motet::remesh::{Goal, Options, Sizes, SurfaceRule, remesh_mesh};
use solids::Numbers;

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes);
    let goal = [Goal::Repair, Goal::Best, Goal::Coarsen][numbers.below(3)];
    let adapt = SurfaceRule::Adapt { distance: None };
    let surface =
        [SurfaceRule::Keep, SurfaceRule::Flat { distance: None }, adapt, SurfaceRule::Keep][numbers.below(4)];
    let length = [None, None, Some(0.4), Some(1.5)][numbers.below(4)];
    let most = [0.0, 0.2, 0.45, 1.0][numbers.below(4)];
    let mesh = solids::cubes(&mut numbers, most);
    let extent = mesh.points.iter().fold([f64::MAX, f64::MIN], |m, p| [m[0].min(p[0]), m[1].max(p[0])]);
    let sizes = length.map(|l| Sizes::Uniform(l * (extent[1] - extent[0]) / 2.0));
    let options = Options { goal, surface, sizes, ..Options::default() };
    let Ok(outcome) = remesh_mesh(&mesh, &options, &Rules::default(), &Threads::single()) else { return };
    solids::check(&outcome.mesh);
    let n_wrong = solids::n_not_positive(&outcome.mesh);
    // A part whose tets are all inverted counts as numbered the other way round.
    let n_before = solids::n_not_positive(&mesh);
    assert!(
        n_wrong <= n_before || outcome.report.after.inverted > 0,
        "{n_wrong} tets are not positive, none is reported"
    );
    let was_sound = n_before == 0;
    assert!(!was_sound || n_wrong == 0, "{n_wrong} tets are not positive, all were");
    if was_sound && matches!(surface, SurfaceRule::Keep | SurfaceRule::Flat { .. }) {
        let after = solids::volumes(&outcome.mesh);
        for (region, before) in solids::volumes(&mesh) {
            let now = after.get(&region).copied().unwrap_or_default();
            let most = solids::tolerance(&mesh, &mesh)
                + solids::tolerance(&outcome.mesh, &mesh)
                + 1e-8 * before.abs();
            assert!((now - before).abs() <= most, "region {region}: {before} before, {now} after");
        }
    }
});
