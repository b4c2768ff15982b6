#![no_main]
//! A script from bytes, run on a moving mesh: moved, repaired, refined, coarsened, saved and loaded; after
//! each step the mesh is valid and the reported counts are true.

mod solids;

use libfuzzer_sys::fuzz_target;
use motet::base::{Point, Threads};
use motet::mesh::Field;
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::moving::{MovingMesh, Options};
use motet::refine::{Criterion, Wanted};
use solids::Numbers;

/// A script ends when the mesh has more tets than this.
const MOST_TETS: usize = 20_000;

fuzz_target!(|bytes: &[u8]| {
    let mut numbers = Numbers(bytes);
    let mut mesh = match numbers.below(4) {
        0 => box_grid([2, 3, 2], [[-1.0; 3], [1.0; 3]]),
        1 => sphere_in_box(3, 2),
        _ => solids::cubes(&mut numbers, 0.2),
    };
    let n_cells = mesh.cells.len();
    mesh.set_cell_field(Field::scalars(
        "dye",
        (0..n_cells).map(|i| 1.0 + (i % 7) as f64).collect::<Vec<_>>(),
    ));
    let mut options = Options { contents: vec!["dye".into()], ..Options::default() };
    options.motion.smooth = numbers.below(3);
    let threads = Threads::single();
    let Ok(mut moving) = MovingMesh::new(&mesh, options.clone(), &threads) else { return };
    let content = integral(moving.mesh());
    let mut goes = vec![[0.0; 3]; moving.driven_places().len()];
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut time = 0.0;
    while !numbers.is_empty() && moving.mesh().cells.len() < MOST_TETS {
        match numbers.below(8) {
            0 => drop(moving.repair(&threads).expect("a mesh is repaired")),
            1 => drop(moving.coarsen(0.05, &threads).expect("a mesh is coarsened")),
            2 => refine(&mut moving, &mut numbers, &threads),
            3 => {
                let state = folder.path().join("state.vtu");
                moving.save(&state).expect("a state is saved");
                moving =
                    MovingMesh::load(&state, options.clone(), &threads).expect("what is saved is loaded");
            }
            how => {
                push(&mut goes, moving.driven_places(), how, &mut numbers);
                time += 1.0;
                let step = moving.advance(time, &goes, &threads).expect("a step ends");
                assert_eq!(step.inverted, solids::n_not_positive(moving.mesh()), "inverted tets are counted");
            }
        }
        solids::check(moving.mesh());
        let now = integral(moving.mesh());
        assert!((now - content).abs() <= 1e-8 * content.abs(), "content {content}, now {now}");
    }
});

/// Moves driven vertices: all together, those of one side, or each separately.
fn push(goes: &mut [Point], places: &[Point], how: usize, numbers: &mut Numbers) {
    let by = numbers.vector().map(|x| 0.3 * x);
    let side = numbers.coarse();
    for (go, place) in goes.iter_mut().zip(places) {
        let moves = match how {
            4 => true,
            5 => place[0] > side,
            6 => place.iter().map(|x| x * x).sum::<f64>() < 1.1,
            _ => false,
        };
        let own = if how == 7 { numbers.vector().map(|x| 0.05 * x) } else { [0.0; 3] };
        *go = [0, 1, 2].map(|i| go[i] + own[i] + if moves { by[i] } else { 0.0 });
    }
}

fn refine(moving: &mut MovingMesh, numbers: &mut Numbers, threads: &Threads) {
    let ball = Criterion::Ball { centre: numbers.vector(), radius: 0.3 };
    let coarsen = numbers.below(2) == 1;
    let wanted = Wanted { criteria: vec![ball], coarsen, generations: Some(1), ..Wanted::default() };
    // The ball may contain no tet: then nothing changes.
    let before = moving.mesh().clone();
    if moving.refine(&wanted, threads).is_err() {
        assert_eq!(*moving.mesh(), before);
    }
}

/// The integral of `dye` over all tets.
fn integral(mesh: &motet::Mesh) -> f64 {
    let dye = mesh.cell_field("dye").and_then(|f| f.values.to_f64()).expect("the array is there");
    let volumes = mesh.cells.tets().zip(solids::tets(mesh));
    volumes.map(|((cell, _), tet)| dye[cell.index()] * motet::geometry::tet::volume(tet)).sum()
}
