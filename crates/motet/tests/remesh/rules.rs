//! What a remeshing may not touch, what it may, and why tets are left bad: on meshes small enough for brute
//! force.

use std::collections::BTreeSet;

use crate::common::Numbers;
use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::quality::{dihedral, eas};
use motet::geometry::triangle::{angle_at, area_vector};
use motet::geometry::vector::{distance, norm};
use motet::kernel::Complex;
use motet::mesh::shapes::{box_grid, sphere_in_box};
use motet::mesh::{TetMesh, TetPart};
use motet::remesh::{Goal, Held, Options, Outcome, Reason, Sizes, SurfaceRule, remesh};
use motet::spatial::NearestTriangle;

const N: usize = 5;

/// The unit cube, regions 5 and 9 on both sides of x = 2/5; vertices off that plane are displaced, those of
/// sides within them.
fn shaken(part: f64, on_sides: bool) -> TetMesh {
    let mut mesh = TetPart::of(&box_grid([N; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
    let centre =
        |mesh: &TetMesh, t: usize| mesh.tets[t].iter().map(|v| mesh.points[v.index()][0]).sum::<f64>() / 4.0;
    mesh.regions = (0..mesh.tets.len()).map(|t| if centre(&mesh, t) < 0.4 { 5 } else { 9 }).collect();
    let mut numbers = Numbers(11);
    for p in &mut mesh.points {
        let is_free = p.map(|x| x > 0.0 && x < 1.0);
        let n_free = is_free.iter().filter(|free| **free).count();
        let moves = (n_free == 3 || n_free == 2 && on_sides) && (p[0] - 0.4).abs() > 1e-9;
        for k in 0..3 {
            let by = part / N as f64 * (2.0 * numbers.unit() - 1.0);
            p[k] += if moves && is_free[k] { by } else { 0.0 };
        }
    }
    mesh
}

fn remeshed(mesh: &TetMesh, options: Options) -> Outcome {
    let outcome = remesh(mesh, &options, &Threads::single()).unwrap();
    Complex::new(&outcome.extract.mesh).unwrap().verify().unwrap();
    outcome
}

fn corners(mesh: &TetMesh, t: usize) -> [Point; 4] {
    mesh.tets[t].map(|v| mesh.points[v.index()])
}

fn bad(mesh: &TetMesh) -> Vec<usize> {
    (0..mesh.tets.len()).filter(|&t| eas(corners(mesh, t)) < 0.2).collect()
}

/// The triangles of a patch, by the bits of their corners.
fn patch(mesh: &TetMesh, label: i32) -> BTreeSet<Vec<[u64; 3]>> {
    let of_patch = mesh.triangles.iter().zip(&mesh.patches).filter(|(_, patch)| **patch == label);
    let bits = |t: &[VertexId; 3]| {
        let mut all = t.map(|v| mesh.points[v.index()].map(f64::to_bits)).to_vec();
        all.sort_unstable();
        all
    };
    of_patch.map(|(t, _)| bits(t)).collect()
}

fn area(mesh: &TetMesh, label: i32) -> f64 {
    let of_patch = mesh.triangles.iter().zip(&mesh.patches).filter(|(_, patch)| **patch == label);
    of_patch.map(|(t, _)| 0.5 * norm(area_vector(t.map(|v| mesh.points[v.index()])))).sum()
}

fn adapt() -> SurfaceRule {
    SurfaceRule::Adapt { distance: None }
}

#[test]
fn a_region_that_is_held_stays_bad_tets_and_all() {
    let mesh = shaken(0.5, false);
    let held = Held { regions: vec![9], ..Held::default() };
    let in_region = |t: &usize| mesh.regions[*t] == 9;
    let (inside, outside): (Vec<usize>, Vec<usize>) = bad(&mesh).into_iter().partition(in_region);
    assert!(inside.len() > 5 && outside.len() > 2, "{} and {}", inside.len(), outside.len());
    for surface in [SurfaceRule::Keep, adapt()] {
        let Outcome { extract, report } =
            remeshed(&mesh, Options { held: held.clone(), surface, ..Options::default() });
        assert_eq!((report.held, report.before.bad, report.after.bad), (inside.len(), outside.len(), 0));
        let kept: BTreeSet<usize> =
            extract.tet_to_old.iter().filter_map(|old| old.get()).map(TetId::index).collect();
        assert!((0..mesh.tets.len()).filter(in_region).all(|t| kept.contains(&t)));
        assert!(outside.iter().all(|t| !kept.contains(t)));
    }
    let all = remeshed(&mesh, Options::default());
    assert_eq!((all.report.held, all.report.before.bad), (0, inside.len() + outside.len()));
}

#[test]
fn a_patch_that_is_held_stays_while_others_adapt() {
    let mesh = shaken(0.38, true);
    let labels: BTreeSet<i32> = mesh.patches.iter().copied().collect();
    let changed = |outcome: &Outcome| -> Vec<i32> {
        let is_other = |label: &i32| patch(&outcome.extract.mesh, *label) != patch(&mesh, *label);
        labels.iter().copied().filter(is_other).collect()
    };
    assert!(changed(&remeshed(&mesh, Options::default())).is_empty(), "the surface is kept");
    let free = remeshed(&mesh, Options { surface: adapt(), ..Options::default() });
    let held = changed(&free)[0];
    let options = Options {
        surface: adapt(),
        held: Held { patches: vec![held], ..Held::default() },
        ..Options::default()
    };
    let some = remeshed(&mesh, options);
    assert!(!changed(&some).contains(&held), "{held} of {:?}", changed(&some));
    for outcome in [&free, &some] {
        let new = &outcome.extract.mesh;
        // Flat sides and straight edges are preserved.
        for &label in &labels {
            assert!((area(new, label) - area(&mesh, label)).abs() < 1e-12, "patch {label}");
        }
        let volume: f64 = {
            let complex = Complex::new(new).unwrap();
            complex.tets().map(|t| motet::geometry::tet::volume(complex.corners(t))).sum()
        };
        assert!((volume - 1.0).abs() < 1e-12, "{volume}");
        assert!(outcome.report.after.inverted <= outcome.report.before.inverted);
        assert!(outcome.report.after.bad <= outcome.report.before.bad);
        for (i, &old) in outcome.extract.triangle_to_old.iter().enumerate() {
            assert_eq!(new.patches[i], mesh.patches[old as usize]);
        }
    }
    assert_eq!(free.report.after.bad, 0);
}

#[test]
fn the_best_goal_leaves_a_better_mesh() {
    let mesh = shaken(0.5, false);
    let worst = |goal: Goal| {
        let outcome = remeshed(&mesh, Options { goal, ..Options::default() });
        assert_eq!(outcome.report.after.bad, 0);
        let new = &outcome.extract.mesh;
        let n_low = (0..new.tets.len()).filter(|&t| eas(corners(new, t)) < 0.35).count();
        (outcome.report.after.worst.unwrap().eas, n_low)
    };
    let (usual, best) = (worst(Options::default().goal), worst(Goal::Best));
    assert!(usual.0 >= 0.2 && best.0 > usual.0 + 0.05 && 3 * best.1 < usual.1, "{usual:?} {best:?}");
}

#[test]
fn a_mesh_without_bad_tets_is_as_it_was() {
    let mesh = shaken(0.1, false);
    for surface in [SurfaceRule::Keep, adapt(), SurfaceRule::Loose { distance: Some(0.1) }] {
        let outcome = remeshed(&mesh, Options { surface, ..Options::default() });
        assert_eq!(outcome.extract.mesh, mesh);
        assert_eq!((outcome.report.kept, outcome.report.kept_share), (mesh.tets.len(), 1.0));
    }
}

/// Stacked prisms on a triangle with a corner of this many degrees, each of three tets.
fn wedge(degrees: f64, n: usize) -> TetMesh {
    let (sin, cos) = degrees.to_radians().sin_cos();
    let points = (0..=n)
        .flat_map(|k| [[0.0, 0.0], [1.0, 0.0], [cos, sin]].map(|[x, y]| [x, y, 0.5 * k as f64]))
        .collect();
    let tets = (0..n).flat_map(|k| {
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|i| VertexId::new(3 * k + i));
        [[a, b, c, d], [b, c, d, e], [c, d, e, f]]
    });
    TetMesh::new(points, tets.collect())
}

#[test]
fn walls_that_meet_at_an_angle_or_have_one_are_named_as_the_cause() {
    let (degrees, n) = (9.0, 6);
    let mesh = wedge(degrees, n);
    let outcome = remeshed(&mesh, Options::default());
    let complex = Complex::new(&outcome.extract.mesh).unwrap();
    let (mut n_angles, mut n_meets) = (0, 0);
    for left in &outcome.report.left {
        let tet = left.tet;
        let corners = complex.corners(tet);
        let walls = (0..4).filter(|&i| complex.is_wall(tet, i));
        let facets: Vec<[Point; 3]> = walls
            .map(|i| complex.facet(motet::kernel::HalfFacet::new(tet, i)).map(|v| complex.point(v)))
            .collect();
        let angles = facets.iter().flat_map(|f| (0..3).map(|k| angle_at(*f, k).to_degrees()));
        let narrowest = angles.fold(f64::INFINITY, f64::min);
        assert_eq!(left.reason.to_string().contains("degrees"), left.reason.is_forced());
        match left.reason {
            Reason::WallAngle { degrees: at, best_eas } => {
                n_angles += 1;
                assert!(
                    (at - narrowest).abs() < 1e-9 && (best_eas - at / 60.0).abs() < 1e-12,
                    "{at} {narrowest}"
                );
                assert!(left.eas <= best_eas + 1e-12);
            }
            Reason::WallsMeet { degrees: at, best_eas } => {
                n_meets += 1;
                assert!(narrowest > 12.0, "{narrowest}");
                assert!((at - degrees).abs() < 1e-9, "{at}");
                assert!((best_eas - degrees.to_radians() / dihedral::REGULAR).abs() < 1e-12);
                let least = dihedral::angles(corners).into_iter().fold(f64::INFINITY, f64::min);
                assert!(least.to_degrees() <= degrees + 1e-9);
            }
            other => assert!(!other.is_forced(), "{other:?} {narrowest}"),
        }
    }
    assert!(n_angles > 0 && n_meets >= n - 2, "{n_angles} {n_meets}");
    // At a wide angle nothing is forced.
    assert!(remeshed(&wedge(60.0, 3), Options::default()).report.left.is_empty());
}

#[test]
fn a_surface_that_gives_way_stays_within_the_distance() {
    // A ball with its surface vertices moved along the surface; coarser sizes, so that walls are merged.
    let mut mesh = TetPart::of(&sphere_in_box(4, 3)).unwrap().mesh;
    let mut numbers = Numbers(5);
    for p in &mut mesh.points {
        let radius = norm(*p);
        if (radius - 1.0).abs() < 1e-9 {
            let q = p.map(|x| x + 0.1 * (2.0 * numbers.unit() - 1.0));
            *p = q.map(|x| x * radius / norm(q));
        }
    }
    let walls = |mesh: &TetMesh| {
        let complex = Complex::new(mesh).unwrap();
        complex.walls().map(|(_, wall)| complex.facet(wall.sides[0])).collect::<Vec<_>>()
    };
    let first = NearestTriangle::new(&mesh.points, &walls(&mesh), &Threads::single());
    let mut n_walls = Vec::new();
    for allowed in [0.01, 0.1, 0.3] {
        let surface = SurfaceRule::Adapt { distance: Some(allowed) };
        let outcome =
            remeshed(&mesh, Options { sizes: Some(Sizes::Uniform(3.0)), surface, ..Options::default() });
        let new = &outcome.extract.mesh;
        let after = walls(new);
        for corners in after.iter().map(|wall| wall.map(|v| new.points[v.index()])) {
            let centre = [0, 1, 2].map(|k| corners.iter().map(|p| p[k]).sum::<f64>() / 3.0);
            for p in corners.into_iter().chain([centre]) {
                let stray = distance(p, first.closest(p).unwrap().point);
                assert!(stray <= allowed + 1e-9, "{stray} of {allowed}");
            }
        }
        // And the removed surface lies near the present one.
        let now = NearestTriangle::new(&new.points, &after, &Threads::single());
        let left =
            mesh.points.iter().map(|&p| (p, now.closest(p).unwrap().point)).filter(|(p, _)| norm(*p) < 1.1);
        assert!(left.map(|(p, q)| distance(p, q)).fold(0.0, f64::max) <= 2.0 * allowed);
        n_walls.push(after.len());
    }
    assert!(n_walls[0] <= walls(&mesh).len() && n_walls[2] < n_walls[0], "{n_walls:?}");
}
