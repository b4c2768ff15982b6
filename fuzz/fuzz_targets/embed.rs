#![no_main]
//! Puts a body from bytes into a box of tets: the result is a valid mesh of the same volume with positive
//! tets.

mod solids;

use libfuzzer_sys::fuzz_target;
use motet::base::Threads;
use motet::implant::{Device, Inside, Interface, Options, Outside, implant};
use motet::mesh::history::Rules;
use motet::mesh::shapes::box_grid;
use solids::Numbers;

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes);
    // Any lattice cuts off the edge of a thin wedge: with a tolerance much smaller than the body, the surface
    // would get tens of thousands of triangles.
    let interface =
        [Interface::Match, Interface::Match, Interface::Conform { tolerance: Some(1.0) }][numbers.below(3)];
    let outside = [Outside::Cut, Outside::Keep][numbers.below(2)];
    let is_hollow = numbers.below(2) == 1;
    let brings_tets = numbers.below(3) == 2;
    let size = [0.5, 1.0, 0.125, 1.5][numbers.below(4)];
    let at = numbers.vector();
    let most = [0.0, 0.2, 0.45][numbers.below(3)];
    let body = solids::cubes(&mut numbers, most);
    let mut mesh = if brings_tets { body } else { solids::skin(&body) };
    mesh.points.iter_mut().for_each(|p| *p = [0, 1, 2].map(|i| size * p[i] + 2.0 * at[i]));
    let mut device = Device::new(mesh, "device");
    if is_hollow {
        device.inside = Inside::Hollow;
    }
    let host = box_grid([4; 3], [[-2.0; 3], [2.0; 3]]);
    let options = Options { interface, outside, ..Options::default() };
    let Ok(made) = implant(&host, &[device], &options, &Rules::default(), &Threads::single()) else { return };
    solids::check(&made.mesh);
    let n_wrong = solids::n_not_positive(&made.mesh);
    assert!(
        n_wrong == 0 || !made.report.is_valid(),
        "{n_wrong} tets are not positive, the report says valid"
    );
});
