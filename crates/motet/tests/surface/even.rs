//! Surfaces made even: distances both ways, angles, lines and labels, and that neither place nor order matters.

use std::collections::BTreeMap;

use motet::base::{CellId, Point, Threads, VertexId};
use motet::geometry::triangle::{angle_at, area, at, closest};
use motet::geometry::vector::{distance, norm, sub};
use motet::mesh::shapes::{Aneurysm, ball, box_grid};
use motet::mesh::{Mesh, Surface};
use motet::preflight::own_crossings;
use motet::surface::{Adapted, Options, adapt, distances};

use crate::common::random::Random;

fn options(size: f64, distance: f64) -> Options {
    Options {
        sizes: vec![size],
        distance,
        feature_angle: 40.0,
        growth: 0.3,
        held: Vec::new(),
        is_for_tets: false,
    }
}

fn adapted(surface: &Surface, options: &Options) -> Adapted {
    let labels: Vec<u32> = surface.patches.iter().map(|&patch| patch as u32).collect();
    adapt(&surface.points, &surface.triangles, &labels, options, &Threads::single()).unwrap()
}

fn corners(of: &Adapted) -> impl Iterator<Item = [Point; 3]> + '_ {
    of.triangles.iter().map(|t| t.map(|v| of.points[v.index()]))
}

/// The least angles of all triangles in degrees, in rising order.
fn least_angles(of: &Adapted) -> Vec<f64> {
    let of_triangle = |t: [Point; 3]| (0..3).map(|k| angle_at(t, k)).fold(f64::INFINITY, f64::min);
    let mut angles: Vec<f64> = corners(of).map(of_triangle).map(f64::to_degrees).collect();
    angles.sort_by(f64::total_cmp);
    angles
}

fn least_angle(of: &Adapted) -> f64 {
    least_angles(of)[0]
}

/// Whether each edge has two triangles that run along it in both directions.
fn is_closed(triangles: &[[VertexId; 3]]) -> bool {
    let mut at = BTreeMap::<[VertexId; 2], i32>::new();
    for &[a, b, c] in triangles {
        for [u, v] in [[a, b], [b, c], [c, a]] {
            *at.entry([u, v]).or_default() += 1;
        }
    }
    at.iter().all(|(&[u, v], &n)| n == 1 && at.get(&[v, u]) == Some(&1))
}

/// The largest distance of random points of some triangles from others, by search through all.
fn strays(from: &[[Point; 3]], to: &[[Point; 3]], random: &mut Random) -> f64 {
    let mut most = 0.0;
    for _ in 0..400 {
        let t = from[(random.next() * from.len() as f64) as usize];
        let (mut u, mut v) = (random.next(), random.next());
        if u + v > 1.0 {
            (u, v) = (1.0 - u, 1.0 - v);
        }
        let p = at(t, [1.0 - u - v, u, v]);
        let nearest = to.iter().map(|t| distance(at(*t, closest(*t, p)), p)).fold(f64::INFINITY, f64::min);
        most = f64::max(most, nearest);
    }
    most
}

/// A surface whose vertices are moved along it, so that triangles become narrow.
fn disturbed(mut surface: Surface, by: f64, random: &mut Random) -> Surface {
    let radii: Vec<f64> = surface.points.iter().map(|p| norm(*p)).collect();
    for (p, radius) in surface.points.iter_mut().zip(radii) {
        let moved = p.map(|x| x + by * (random.next() - 0.5));
        let scale = radius / norm(moved).max(1e-300);
        *p = moved.map(|x| x * scale);
    }
    surface
}

fn check(name: &str, old: &Surface, new: &Adapted, allowed: f64, min_angle: f64) {
    let triangles = |points: &[Point], all: &[[VertexId; 3]]| -> Vec<[Point; 3]> {
        all.iter().map(|t| t.map(|v| points[v.index()])).collect()
    };
    let (given, made) = (triangles(&old.points, &old.triangles), triangles(&new.points, &new.triangles));
    assert!(is_closed(&new.triangles), "{name}");
    assert_eq!(
        own_crossings(&new.points, &new.triangles, &Threads::single()),
        Vec::<[u32; 2]>::new(),
        "{name}"
    );
    let measured =
        distances([(&old.points, &old.triangles), (&new.points, &new.triangles)], &Threads::single());
    assert!(measured.iter().all(|d| *d <= allowed), "{name}: {measured:?}");
    let random = &mut Random(7);
    let strays = [strays(&given, &made, random), strays(&made, &given, random)];
    assert!(strays.iter().all(|d| *d <= allowed), "{name}: {strays:?}");
    assert!(least_angle(new) > min_angle, "{name}: {}", least_angle(new));
}

#[test]
fn a_ball_of_narrow_triangles_gets_even_ones_near_it() {
    let mut random = Random(1);
    for (n, size) in [(8, 0.3), (16, 0.15), (16, 0.6)] {
        let old = disturbed(Surface::boundary_of(&ball(n, 2)), 1.2 / n as f64, &mut random);
        let new = adapted(&old, &options(size, 0.02));
        // Where the given surface is folded new triangles must face as it does, and a few stay narrow.
        check(&format!("{n} {size}"), &old, &new, 0.02, 18.0);
        let angles = least_angles(&new);
        assert!(angles[angles.len() / 100] > 30.0, "{n} {size}: {:?}", &angles[..8]);
    }
}

#[test]
fn what_is_made_even_again_and_again_keeps_its_volume_and_its_area() {
    let mesh = Aneurysm::default().mesh().unwrap();
    let mut surface = Surface::own_or_boundary_of(&mesh);
    let measured =
        |of: &Surface| [of.enclosed_volume(), (0..of.triangles.len()).map(|t| area(of.corners(t))).sum()];
    let first = measured(&surface);
    for round in 0..16 {
        let new = adapted(&surface, &options(if round % 2 == 0 { 0.3 } else { 0.33 }, 0.02));
        surface.patches = new.labels.iter().map(|&label| label as i32).collect();
        (surface.points, surface.triangles) = (new.points, new.triangles);
        surface.triangle_to_cell = vec![CellId::new(0); surface.triangles.len()];
    }
    let last = measured(&surface);
    let [volume, area] = [0, 1].map(|k| last[k] / first[k] - 1.0);
    assert!(volume.abs() < 0.002 && area.abs() < 0.004, "{volume} {area}");
}

#[test]
fn edges_and_corners_of_a_box_stay() {
    let old = Surface::boundary_of(&box_grid([1; 3], [[0.0; 3], [1.0, 2.0, 3.0]]));
    let new = adapted(&old, &options(0.2, 0.01));
    check("box", &old, &new, 0.01, 25.0);
    let all: f64 = corners(&new).map(area).sum();
    assert!((all - 22.0).abs() < 1e-12 * 22.0, "{all}");
    for corner in 0..8usize {
        let p = std::array::from_fn(|k| if corner >> k & 1 == 1 { (k + 1) as f64 } else { 0.0 });
        assert!(corners(&new).flatten().any(|q| q == p), "{p:?}");
    }
}

#[test]
fn borders_of_labels_stay() {
    let mesh: Mesh = Aneurysm::default().mesh().unwrap();
    let old = Surface::own_or_boundary_of(&mesh);
    let used: std::collections::BTreeSet<i32> = old.patches.iter().copied().collect();
    assert!(used.len() > 2, "there are ends");
    let new = adapted(&old, &options(0.25, 0.01));
    check("aneurysm", &old, &new, 0.01, 25.0);
    for &patch in &used {
        let area_of = |all: &mut dyn Iterator<Item = ([Point; 3], i32)>| -> f64 {
            all.filter(|(_, of)| *of == patch).map(|(t, _)| area(t)).sum()
        };
        let of_old = area_of(&mut (0..old.triangles.len()).map(|t| (old.corners(t), old.patches[t])));
        let of_new = area_of(&mut corners(&new).zip(new.labels.iter().map(|&label| label as i32)));
        assert!((of_new - of_old).abs() < 0.02 * of_old, "{patch}: {of_old} {of_new}");
    }
}

#[test]
fn sizes_at_points_are_followed() {
    let old = Surface::boundary_of(&ball(16, 2));
    let sizes = old.points.iter().map(|p| if p[0] > 0.0 { 0.1 } else { 0.4 }).collect();
    let new = adapted(&old, &Options { sizes, ..options(1.0, 0.05) });
    check("sizes", &old, &new, 0.05, 25.0);
    let mean = |side: f64| {
        let of = corners(&new).filter(|t| t.iter().all(|p| p[0] * side > 0.6));
        let lengths: Vec<f64> =
            of.flat_map(|[a, b, c]| [sub(a, b), sub(b, c), sub(c, a)].map(norm)).collect();
        lengths.iter().sum::<f64>() / lengths.len() as f64
    };
    assert!((0.07..0.13).contains(&mean(1.0)), "{}", mean(1.0));
    assert!((0.22..0.5).contains(&mean(-1.0)), "{}", mean(-1.0));
}

#[test]
fn scale_does_not_matter_and_neither_do_threads() {
    let old = disturbed(Surface::boundary_of(&ball(8, 2)), 0.1, &mut Random(3));
    let new = adapted(&old, &options(0.25, 0.01));
    let mut scaled = old.clone();
    scaled.points.iter_mut().flatten().for_each(|x| *x *= 1024.0);
    let of_scaled = adapted(&scaled, &options(0.25 * 1024.0, 0.01 * 1024.0));
    assert_eq!(of_scaled.triangles, new.triangles);
    let labels = vec![0; old.triangles.len()];
    let threads = Threads::exactly(3).unwrap();
    let options = options(0.25, 0.01);
    let other = adapt(&old.points, &old.triangles, &labels, &options, &threads).unwrap();
    assert_eq!((other.triangles, other.points), (new.triangles, new.points));
}

#[test]
fn options_out_of_range_are_refused() {
    let ball = Surface::boundary_of(&ball(2, 1));
    let labels = vec![0; ball.triangles.len()];
    for bad in [
        options(0.0, 0.1),
        options(f64::NAN, 0.1),
        options(0.1, 0.0),
        options(0.1, f64::INFINITY),
        Options { feature_angle: -1.0, ..options(0.1, 0.1) },
        Options { growth: 0.0, ..options(0.1, 0.1) },
        Options { sizes: vec![0.1; 2], ..options(0.1, 0.1) },
    ] {
        assert!(adapt(&ball.points, &ball.triangles, &labels, &bad, &Threads::single()).is_err(), "{bad:?}");
    }
    let mut points = ball.points.clone();
    points[ball.triangles[0][0].index()][1] = f64::NAN;
    let error = adapt(&points, &ball.triangles, &labels, &options(0.1, 0.1), &Threads::single()).unwrap_err();
    assert!(error.to_string().contains("not finite"), "{error}");
}
