//! The cases of the paper on dynamic remeshing, small and short: checks after every step.

use crate::moving_cases::channel::{repaired_as_it_moves, stretched};
use crate::moving_cases::cube::{self, Distortion, cube_mesh};
use crate::moving_cases::measure::{assert_valid, boundary, labelled, quality, volumes};
use crate::moving_cases::membrane::{self, Bending, membrane_mesh};
use crate::moving_cases::meshes::{Channel, INNER, Stack, prepared};
use crate::moving_cases::transfer::{self, Loaded, Tally};
use crate::moving_cases::{self, keep};
use motet::base::Threads;
use motet::mesh::TetMesh;
use motet::remesh::remesh;

fn small_channel() -> TetMesh {
    let channel = Channel {
        low: [0.0, -1.0, -1.0],
        high: [4.0, 1.0, 1.0],
        centre: [1.2, 0.0, 0.0],
        radius: 0.5,
        sizes: [0.18, 0.36],
        growth: 0.15,
    };
    prepared(&channel.mesh(1))
}

fn volume(mesh: &TetMesh) -> f64 {
    volumes(mesh).values().sum()
}

fn assert_close(x: f64, y: f64, tolerance: f64) {
    assert!((x - y).abs() <= tolerance * y.abs(), "{x} {y}");
}

/// Asserts that boundary and labelled triangles are those of `before` to the bit, the volume is the same, and
/// no tet is bad.
fn assert_repaired(before: &TetMesh, after: &TetMesh) {
    assert_valid(after);
    assert_eq!(quality(after).bad, 0);
    assert!(boundary(before) == boundary(after), "the boundary changed");
    assert!(labelled(before) == labelled(after), "labelled triangles changed");
    assert_close(volume(after), volume(before), 1e-12);
}

#[test]
fn meshes_are_what_they_are_meant_to_be() {
    let channel = small_channel();
    assert_valid(&channel);
    assert_eq!(quality(&channel).bad, 0);
    let areas = moving_cases::measure::patches(&channel);
    [4.0, 4.0, 8.0, 8.0, 8.0, 8.0]
        .iter()
        .zip(1..)
        .for_each(|(&a, side)| assert_close(areas[&side].1, a, 1e-12));
    // A convex polyhedron between the sphere and one inside it, of radius 0.478: no circle free of vertices
    // is wider than their distance, 0.144.
    let sphere = std::f64::consts::PI;
    assert!(areas[&INNER].1 < sphere && areas[&INNER].1 > 0.91 * sphere, "{}", areas[&INNER].1);
    let membrane = membrane_mesh(0.2, 1);
    assert_valid(&membrane);
    let state = membrane::state(&membrane);
    assert_close(state.volumes[&1], 0.5, 1e-12);
    assert_close(state.volumes[&2], 0.5, 1e-12);
    assert_close(state.patches[&INNER].1, 1.0, 1e-12);
    // The 12 edges of the box and the 4 of the membrane.
    assert_close(state.features.1, 16.0, 1e-12);
}

#[test]
fn harmonic_motion_reproduces_a_shift_and_a_linear_field() {
    let mesh = Stack { low: [0.0; 3], high: [1.0; 3], levels: vec![0.0, 1.0] }.even_mesh(0.3, 2);
    let linear = |p: [f64; 3]| [0.3 + p[0], 0.1 * p[1] - p[2], 0.2];
    let mut reported = vec![None; mesh.points.len()];
    mesh.triangles.iter().flatten().for_each(|v| reported[v.index()] = Some([0.5, -0.25, 1.0]));
    assert!(reported.iter().any(Option::is_none));
    let displacement = moving_cases::harmonic::harmonic(&mesh, &reported);
    for d in displacement {
        (0..3).for_each(|i| assert_close(d[i], [0.5, -0.25, 1.0][i], 1e-7));
    }
    // With weights 1 / volume a linear field is not the solution, but no value exceeds the range of the
    // boundary's by much.
    for (reported, p) in reported.iter_mut().zip(&mesh.points).filter(|(reported, _)| reported.is_some()) {
        *reported = Some(linear(*p));
    }
    let displacement = moving_cases::harmonic::harmonic(&mesh, &reported);
    assert!(displacement.iter().all(|d| d[0] > 0.2 && d[0] < 1.4));
}

#[test]
fn a_sphere_moved_along_a_channel_leaves_no_bad_tet() {
    let states = stretched(&small_channel(), &[0.2, 0.4, 0.6]);
    assert!(states.windows(2).all(|two| two[0].quality.bad < two[1].quality.bad));
    assert!(states[2].quality.bad > 100, "{}", states[2].quality.bad);
    for state in states {
        let outcome = remesh(&state.mesh, &keep(), &Threads::single()).unwrap();
        assert_repaired(&state.mesh, &outcome.extract.mesh);
        assert!(outcome.report.is_complete());
        assert!(outcome.report.kept_share > 0.8, "{}", outcome.report.kept_share);
    }
}

#[test]
fn a_sphere_goes_far_when_the_mesh_is_repaired_as_it_moves() {
    let mut n_bad = 0;
    repaired_as_it_moves(&small_channel(), 0.1, 15, &keep(), |step| {
        assert_repaired(&step.moved, &step.repaired);
        n_bad += quality(&step.moved).bad;
    });
    assert!(n_bad > 100, "{n_bad}");
}

#[test]
fn a_membrane_bends_and_comes_back_and_nothing_drifts() {
    let mut mesh = membrane_mesh(0.14, 1);
    let first = membrane::state(&mesh);
    let bending = Bending { amplitude: 0.4, n_steps: 16 };
    let mut most_bad = 0;
    for _ in 0..3 {
        let cycle = membrane::cycle(&mut mesh, &bending, &keep(), |_, mesh| {
            assert_valid(mesh);
            assert_eq!(quality(mesh).bad, 0);
            assert_close(volume(mesh), 1.0, 1e-12);
        });
        most_bad = most_bad.max(cycle.most_bad);
        let last = cycle.state;
        for (label, volume) in &first.volumes {
            assert_close(last.volumes[label], *volume, 1e-12);
        }
        for (label, (_, area)) in &first.patches {
            assert_close(last.patches[label].1, *area, 1e-12);
        }
        assert_close(last.features.1, first.features.1, 1e-12);
        assert!(last.off_membrane < 1e-12);
        // Where the surface could be kept throughout, it is unchanged.
        assert!(cycle.n_adapted > 0 || last.patches[&INNER].0 == first.patches[&INNER].0);
    }
    assert!(most_bad > 10, "{most_bad}");
}

/// Distorts a small cube and restores it; asserts that the cube's sides, edges, corners and volume are
/// preserved after every step.
fn distort(distortion: Distortion, n_steps: usize, n_cycles: usize, see: impl Fn(&cube::Step)) -> usize {
    let mut mesh = cube_mesh(0.2, 1);
    let (first, mut most_bad) = (mesh.tets.len(), 0);
    for _ in 0..n_cycles {
        cube::cycle(&mut mesh, &distortion, n_steps, &moving_cases::adapt(), |step, mesh| {
            assert_valid(mesh);
            most_bad = most_bad.max(step.bad_before);
            see(step);
            assert!(step.state.off_side < 1e-12 && step.state.off_edge < 1e-12, "{:?}", step.state);
            assert_close(step.state.edges, 12.0, 1e-12);
            assert_eq!(step.state.corners, 8);
            assert!(step.state.n_tets < 2 * first, "{} tets of {first}", step.state.n_tets);
        });
    }
    most_bad
}

fn assert_no_bad(step: &cube::Step) {
    assert_eq!(step.bad, 0, "part {}: {:?}", step.part, step.report.left);
}

#[test]
fn a_sheared_cube_comes_back_whole() {
    let most_bad = distort(Distortion::Shear(60.0), 16, 2, assert_no_bad);
    assert!(most_bad > 0);
}

#[test]
fn a_cube_sheared_beyond_what_any_tet_can_follow_comes_back_whole() {
    // Beyond 75.9 degrees the sides meet at less than 14.1: too sharp for any tet of EAS 0.2.
    distort(Distortion::Shear(80.0), 16, 1, |_| {});
}

#[test]
fn a_twisted_cube_comes_back_whole() {
    distort(Distortion::Twist(90.0), 16, 2, assert_no_bad);
}

/// Asserts that linear fields stay linear, constants stay to the bit, and integrals change by no more than
/// the ledger states.
fn assert_carried(tally: &Tally) {
    assert!(tally.n_new_tets > 100, "{tally:?}");
    assert!(tally.linear < 1e-12 && tally.linear_outside < 1e-12, "{tally:?}");
    assert_eq!(tally.off_constant, 0.0);
    assert!(tally.kept.beyond < 1e-13 && tally.adapted.beyond < 1e-13, "{tally:?}");
    assert!(tally.drift <= tally.kept.drift + tally.adapted.drift + 1e-12, "{tally:?}");
}

#[test]
fn what_tets_hold_stays_while_a_membrane_bends_and_comes_back() {
    let mut loaded = Loaded::new(&membrane_mesh(0.14, 1), 1);
    let bending = Bending { amplitude: 0.4, n_steps: 32 };
    transfer::bend(&mut loaded, &bending, None, 3, |_, loaded| {
        assert_carried(&loaded.tally);
        assert_eq!(loaded.tally.n_inverted, 0);
        assert!(loaded.tally.drift < 1e-13, "{:?}", loaded.tally);
    });
}

#[test]
fn what_tets_hold_stays_while_flat_sides_adapt() {
    let mut loaded = Loaded::new(&cube_mesh(0.2, 1), 1);
    transfer::distort(&mut loaded, &Distortion::Shear(60.0), 16, 3, |_, loaded| {
        assert_carried(&loaded.tally);
        assert!(loaded.tally.drift < 1e-13, "{:?}", loaded.tally);
    });
}

#[test]
fn what_tets_hold_changes_by_what_curved_sides_give_way() {
    let mut loaded = Loaded::new(&cube_mesh(0.2, 1), 1);
    transfer::distort(&mut loaded, &Distortion::Twist(160.0), 16, 1, |_, loaded| {
        assert_carried(&loaded.tally);
    });
    let adapted = loaded.tally.adapted;
    assert!(adapted.deviation > 1e-9 && adapted.drift < adapted.allowed, "{adapted:?}");
}
