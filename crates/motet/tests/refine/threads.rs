//! Refinement on any number of threads gives the same bytes: meshes, arrays, histories, memories.

use crate::common::{Numbers, random_mesh};
use motet::Mesh;
use motet::base::{TetId, Threads};
use motet::mesh::history::{History, Rules};
use motet::mesh::{CellKind, Cells, Field, TetMesh};
use motet::refine::{Memory, MeshRefinement, Options, Refinement};
use proptest::prelude::*;

/// What a step does to a mesh: the share of tets that it marks in a ball about a corner of the unit cube.
#[derive(Clone, Copy, Debug)]
struct Step {
    is_back: bool,
    share: f64,
    radius: f64,
}

fn steps() -> impl Strategy<Value = Vec<Step>> {
    let step = (0..10, 0.3..1.0f64, 0.3..2.0f64);
    let step = step.prop_map(|(kind, share, radius)| Step { is_back: kind < 3, share, radius });
    prop::collection::vec(step, 2..5)
}

fn marked(mesh: &TetMesh, step: Step, numbers: &mut Numbers) -> Vec<TetId> {
    let is_near = |tet: &TetId| {
        let point = mesh.points[mesh.tets[tet.index()][0].index()];
        point.iter().map(|x| x * x).sum::<f64>() < step.radius * step.radius
    };
    let share = if step.is_back { 1.0 } else { step.share };
    let all = (0..mesh.tets.len()).map(TetId::new);
    all.filter(is_near).filter(|_| numbers.unit() < share).collect()
}

/// Above this number of tets, tests take long.
const MOST_TETS: usize = 60_000;

fn run(first: &TetMesh, steps: &[Step], threads: &Threads) -> Vec<(TetMesh, Memory)> {
    let mut numbers = Numbers(7);
    let mut refinement = Refinement::new(first, Options::default(), threads).unwrap();
    let mut states = Vec::new();
    for &step in steps {
        let marked = marked(refinement.mesh(), step, &mut numbers);
        if step.is_back {
            refinement.coarsen(&marked, threads).unwrap();
        } else if refinement.mesh().tets.len() < MOST_TETS {
            refinement.refine(&marked, threads).unwrap();
        }
        let memory = refinement.memory_to_keep(threads);
        let again = Refinement::recall(refinement.mesh(), &memory, Options::default(), threads).unwrap();
        assert_eq!(again.memory_to_keep(threads), memory);
        states.push((refinement.mesh().clone(), memory));
    }
    states
}

/// The mesh with triangles and lines between its tets, and arrays.
fn whole(first: &TetMesh) -> Mesh {
    let (mut cells, mut regions) = (Cells::new(), Vec::new());
    for (t, (tet, region)) in first.tets.iter().zip(&first.regions).enumerate() {
        cells.push(CellKind::TETRA, *tet);
        regions.push(*region);
        if let Some(triangle) = first.triangles.get(t) {
            cells.push(CellKind::TRIANGLE, *triangle);
            regions.push(2);
        }
        if t % 50 == 0 {
            cells.push(CellKind::LINE, [tet[0], tet[1]]);
            regions.push(4);
        }
    }
    let n = cells.len();
    let mut mesh = Mesh::new(first.points.clone(), cells);
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_cell_field(Field::scalars("heat", (0..n).map(|c| (c as f64).sin()).collect::<Vec<_>>()));
    mesh.set_point_field(Field::vectors("flow", &mesh.points));
    let speed: Vec<f32> = mesh.points.iter().map(|p| (7.0 * p[0] * p[1]).cos() as f32).collect();
    mesh.set_point_field(Field::scalars("speed", speed));
    mesh
}

fn run_whole(first: &Mesh, steps: &[Step], threads: &Threads) -> Vec<(Mesh, History)> {
    let mut numbers = Numbers(7);
    let mut refinement = MeshRefinement::new(first, Options::default(), threads).unwrap();
    let mut states = Vec::new();
    for &step in steps {
        let marked = marked(refinement.refinement().mesh(), step, &mut numbers);
        let history = if step.is_back {
            refinement.coarsen(&marked, &Rules::default(), threads).unwrap().history
        } else if refinement.refinement().mesh().tets.len() < MOST_TETS {
            refinement.refine(&marked, &Rules::default(), threads).unwrap().history
        } else {
            continue;
        };
        states.push((refinement.with_memory(threads), history));
    }
    states
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]

    #[test]
    fn any_number_of_threads_gives_the_same_bytes(seed in 0..1000u64, steps in steps()) {
        let first = random_mesh(700, seed);
        let mesh = whole(&first);
        let one = (run(&first, &steps, &Threads::single()), run_whole(&mesh, &steps, &Threads::single()));
        for n in [2, 3, 7] {
            let threads = Threads::exactly(n).unwrap();
            prop_assert!(run(&first, &steps, &threads) == one.0, "{n} threads");
            prop_assert!(run_whole(&mesh, &steps, &threads) == one.1, "{n} threads, whole");
        }
    }
}

#[test]
fn several_generations_everywhere_are_the_same_on_all_threads() {
    let first = random_mesh(250, 5);
    let everywhere = Step { is_back: false, share: 2.0, radius: 9.0 };
    let back = Step { is_back: true, ..everywhere };
    let near = Step { radius: 0.4, ..everywhere };
    let steps = [everywhere, everywhere, near, back, near];
    let one = run(&first, &steps, &Threads::single());
    assert!(one[2].0.tets.len() > 100_000);
    for n in [2, 3, 7] {
        assert!(run(&first, &steps, &Threads::exactly(n).unwrap()) == one, "{n} threads");
    }
}
