//! Bodies made one: volumes against those of the definition, voxel by voxel.

use motet::base::{Point, Threads};
use motet::mesh::open_edges;
use motet::mesh::shapes::ball;
use motet::mesh::{Mesh, Surface};
use motet::preflight::{FaultKind, RepairKind, Repaired, Repairs, Role, own_crossings};

use super::joints::{
    CASES, IMPRINT, Soup, assert_volumes, box_of, moved, random_boxes, repaired, scale_of, sheet, together,
    volumes,
};

const UNITE: Repairs = Repairs { unite: true, ..IMPRINT };

/// Turned inside out.
fn inward((points, triangles): Soup) -> Soup {
    (points, triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect())
}

fn is_left(done: &Repaired) -> bool {
    done.count(RepairKind::LeftApart) > 0
}

#[test]
fn bodies_that_cross_become_one() {
    for case in 0..CASES {
        let second = [[0.4, 0.3, -0.2], [1.9, 0.8, 0.7]];
        let bodies = [box_of([2; 3], [[0.0; 3], [1.0; 3]]), box_of([1, 2, 1], second)];
        let expected = 1.0 + 1.5 * 0.5 * 0.9 - 0.6 * 0.5 * 0.7;
        let both = moved(case, &together(&bodies));
        let (surfaces, done) = repaired(&[(&both, Role::Boundary)], &UNITE);
        assert!(!is_left(&done), "case {case}");
        assert!(done.count(RepairKind::CutCrossing) > 0 && done.count(RepairKind::DroppedInside) > 0);
        assert_volumes(case, &surfaces, &[expected]);
        // From two files as from one.
        let [a, b] = bodies.map(|body| moved(case, &body));
        let (surfaces, _) = repaired(&[(&a, Role::Boundary), (&b, Role::Boundary)], &UNITE);
        assert_eq!(surfaces.roles.len(), 1);
        assert_volumes(case, &surfaces, &[expected]);
    }
}

#[test]
fn bodies_side_by_side_lose_their_wall() {
    let beside = [
        ([3, 3, 3], [[1.0, 0.0, 0.0], [2.0, 1.0, 1.0]], 2.0),
        ([2, 2, 2], [[1.0, 0.2, 0.3], [2.0, 0.7, 0.9]], 1.3),
        ([1, 2, 1], [[1.0, 0.4, 0.3], [1.5, 1.4, 1.3]], 1.5),
    ];
    for (case, (n, bounds, expected)) in (0..CASES).flat_map(|case| beside.map(|beside| (case, beside))) {
        let both = moved(case, &together(&[box_of([2; 3], [[0.0; 3], [1.0; 3]]), box_of(n, bounds)]));
        let (surfaces, done) = repaired(&[(&both, Role::Boundary)], &UNITE);
        assert!(done.count(RepairKind::KeptWall) == 0 && !is_left(&done));
        assert_volumes(case, &surfaces, &[expected]);
    }
}

/// What faces outward inside a body is left out, what faces inward bounds a void; a body that is there twice
/// counts once.
#[test]
fn bodies_within_bodies() {
    let (outer, inner) = (box_of([2; 3], [[0.0; 3], [1.0; 3]]), box_of([1; 3], [[0.3; 3], [0.6; 3]]));
    let one_void = inward(inner.clone());
    let cases: [(&[Soup], f64); 4] = [
        (&[outer.clone(), inner.clone()], 1.0),
        (&[outer.clone(), one_void.clone()], 1.0 - 0.027),
        (&[outer.clone(), outer.clone()], 1.0),
        // A body in a void of another.
        (&[outer.clone(), one_void, box_of([1; 3], [[0.4; 3], [0.5; 3]])], 1.0 - 0.027 + 0.001),
    ];
    for (bodies, expected) in cases {
        let all = together(bodies);
        for orient in [false, true] {
            let (surfaces, done) =
                repaired(&[(&all, Role::Boundary)], &Repairs { orient, drop_duplicates: orient, ..UNITE });
            assert!(!is_left(&done));
            let volume = Surface {
                points: surfaces.points.clone(),
                triangles: surfaces.triangles.clone(),
                ..Surface::boundary_of(&ball(1, 1))
            }
            .enclosed_volume();
            assert!((volume - expected).abs() < 1e-12, "{volume} {expected}");
        }
    }
    // All turned inside out: turned back first.
    let (surfaces, _) = repaired(&[(&inward(outer), Role::Boundary)], &Repairs { orient: true, ..UNITE });
    assert_volumes(0, &surfaces, &[1.0]);
}

/// Random boxes on a grid share planes, edges and corners in all ways; the cells of the grid that are in some
/// box are counted.
#[test]
fn random_boxes_have_the_volume_of_the_cells_in_them() {
    let mut n_united = 0;
    for seed in 0..60u64 {
        let case = seed as usize % CASES;
        let (bodies, n_cells) = random_boxes(seed, 5);
        let all = moved(case, &together(&bodies));
        let (surfaces, done) = repaired(&[(&all, Role::Boundary)], &UNITE);
        assert!(!is_left(&done), "seed {seed}");
        assert!(own_crossings(&surfaces.points, &surfaces.triangles, &Threads::single()).is_empty());
        assert!(open_edges(&surfaces.triangles).is_empty());
        let (off, unit) = scale_of(case);
        let volume = volumes(&surfaces).iter().sum::<f64>() / unit.powi(3);
        let expected = n_cells as f64;
        assert!((volume - expected).abs() < 1e4 * off, "seed {seed}, case {case}: {volume} {expected}");
        n_united += usize::from(done.count(RepairKind::DroppedInside) > 0);
    }
    assert!(n_united > 12, "{n_united}");
}

/// Two balls, by the volume of the lens in which they overlap, up to that of the chords of their surfaces.
#[test]
fn balls_that_overlap() {
    let surface = |mesh: &Mesh| Surface::boundary_of(mesh);
    let one = surface(&ball(16, 2));
    let own = one.enclosed_volume();
    let at = |shift: Point| -> Soup {
        (one.points.iter().map(|p| std::array::from_fn(|k| p[k] + shift[k])).collect(), one.triangles.clone())
    };
    let both = together(&[at([0.0; 3]), at([0.9, 0.31, 0.17])]);
    let (surfaces, done) = repaired(&[(&both, Role::Boundary)], &UNITE);
    assert!(!is_left(&done) && done.count(RepairKind::DroppedInside) > 10);
    let d = (0.9f64 * 0.9 + 0.31 * 0.31 + 0.17 * 0.17).sqrt();
    let lens = std::f64::consts::PI * (4.0 + d) * (2.0 - d).powi(2) / 12.0;
    let volume: f64 = volumes(&surfaces).iter().sum();
    assert!((volume / (2.0 * own - lens) - 1.0).abs() < 0.01, "{volume}");
}

#[test]
fn membranes_stay_and_what_is_open_is_left() {
    let body = box_of([2; 3], [[0.0; 3], [1.0; 3]]);
    let flap = sheet([0.2, 0.2, 0.5], [0.5, 0.0, 0.0], [0.0, 0.5, 0.1]);
    let (surfaces, done) = repaired(&[(&body, Role::Boundary), (&flap, Role::Membrane)], &UNITE);
    assert!(done.done.is_empty() && surfaces.triangles.len() == body.1.len() + 2);
    // A body that lacks a triangle, and a sheet through it: refused as it is.
    let open = together(&[
        (body.0.clone(), body.1[1..].to_vec()),
        sheet([0.2, 0.2, 0.5], [2.0, 0.0, 0.0], [0.0, 0.5, 0.1]),
    ]);
    let (surfaces, done) = repaired(&[(&open, Role::Boundary)], &UNITE);
    assert!(is_left(&done));
    let report = surfaces.preflight(&Threads::single());
    assert!(report.count(FaultKind::OpenEdge) > 0);
}
