//! The Delaunay triangulation compared with its definition, on sets from ordinary to hostile.

use motet::base::{Point, TetId, Threads, VertexId};
use motet::delaunay::Triangulation;
use motet::geometry::predicates::{insphere, orient3d};
use motet::spatial::OUTSIDE;
use proptest::prelude::*;
use std::collections::{BTreeSet, HashMap};

/// Numbers in [0, 1) from a seed (splitmix64).
fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (state ^ state >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ z >> 31) >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn cube(n: usize, seed: u64) -> Vec<Point> {
    let mut next = uniform(seed);
    (0..n).map(|_| std::array::from_fn(|_| next())).collect()
}

fn sphere(n: usize) -> Vec<Point> {
    let point = |i: usize| {
        let z = 1.0 - (2 * i + 1) as f64 / n as f64;
        let (s, c) = (i as f64 * 2.399_963_229_728_653).sin_cos();
        let r = (1.0 - z * z).sqrt();
        [r * c, r * s, z]
    };
    (0..n).map(point).collect()
}

fn grid(n: usize, step: f64) -> Vec<Point> {
    (0..n * n * n).map(|i| [i % n, i / n % n, i / n / n].map(|k| k as f64 * step)).collect()
}

fn turned(points: &[Point]) -> Vec<Point> {
    let (s, c) = 0.7f64.sin_cos();
    let turn = |[x, y, z]: Point| [c * x - s * y, s * x + c * y, z];
    points.iter().map(|&p| turn(turn(p).map(|x| x + 0.3)).map(|x| x * 1.1)).collect()
}

/// A ball's surface within the six walls of a box.
fn sphere_in_box(n: usize, m: usize) -> Vec<Point> {
    let mut points = sphere(n);
    let mut next = uniform(7);
    for axis in 0..3 {
        for wall in [-3.0, 3.0] {
            points.extend((0..m).map(|_| {
                let mut p: Point = std::array::from_fn(|_| 6.0 * next() - 3.0);
                p[axis] = wall;
                p
            }));
        }
    }
    points
}

fn triangulate(points: &[Point]) -> Triangulation {
    Triangulation::new(points, &Threads::single()).expect("the points span a volume")
}

/// Asserts all defining properties of a Delaunay triangulation, facet by facet: by Delaunay's lemma (1934)
/// that implies the empty sphere of every tet with respect to all points.
fn assert_delaunay(points: &[Point], t: &Triangulation) {
    let corner = |v: VertexId| points[v.index()];
    for (id, (tet, neighbors)) in t.tets().iter().zip(t.neighbors()).enumerate() {
        let [a, b, c, d] = tet.map(corner);
        assert_eq!(orient3d(a, b, c, d), 1, "tet {id} is positive");
        for (i, &n) in neighbors.iter().enumerate().filter(|(_, n)| **n != OUTSIDE) {
            let back = t.neighbors()[n.index()].iter().filter(|&&back| back == TetId::new(id)).count();
            let shared = t.tets()[n.index()].iter().filter(|v| tet.contains(v)).count();
            assert_eq!((back, shared), (1, 3), "tets {id} and {n} share one facet");
            assert!(!t.tets()[n.index()].contains(&tet[i]), "facet {i} of tet {id} is opposite vertex {i}");
            let opposite = t.tets()[n.index()].iter().find(|v| !tet.contains(v)).expect("a fourth vertex");
            assert!(
                insphere(a, b, c, d, corner(*opposite)) <= 0,
                "tet {id} has vertex {opposite} in its sphere"
            );
        }
    }
    assert_hull(points, t);
    assert_euler(points, t);
}

/// Asserts that the hull consists of the facets without neighbour and is convex at every edge, and that the
/// tets fill it.
fn assert_hull(points: &[Point], t: &Triangulation) {
    let open = t.neighbors().iter().flatten().filter(|n| **n == OUTSIDE).count();
    assert_eq!(open, t.hull().len());
    let mut apex: HashMap<(VertexId, VertexId), VertexId> = HashMap::new();
    for facet in t.hull() {
        let tet = t.tets()[facet.tet.index()];
        assert_eq!(t.neighbors()[facet.tet.index()][facet.facet as usize], OUTSIDE);
        assert!(facet.vertices.iter().all(|v| tet.contains(v) && *v != tet[facet.facet as usize]));
        let [a, b, c] = facet.vertices;
        let inner = points[tet[facet.facet as usize].index()];
        assert_eq!(orient3d(points[a.index()], points[b.index()], points[c.index()], inner), -1, "outward");
        for (u, v, w) in [(a, b, c), (b, c, a), (c, a, b)] {
            assert!(apex.insert((u, v), w).is_none(), "an edge of the hull has one facet a side");
        }
    }
    for (&(u, v), &w) in &apex {
        let across = apex.get(&(v, u)).expect("the hull is closed");
        let side = orient3d(points[u.index()], points[v.index()], points[w.index()], points[across.index()]);
        assert!(side <= 0, "the hull is convex");
    }
}

/// Asserts that vertices - edges + facets - tets = 1, as for a ball, and that every distinct point is a
/// vertex.
fn assert_euler(points: &[Point], t: &Triangulation) {
    let mut edges = BTreeSet::new();
    let mut vertices: BTreeSet<VertexId> = BTreeSet::new();
    for tet in t.tets() {
        vertices.extend(tet);
        for (i, j) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            edges.insert((tet[i].min(tet[j]), tet[i].max(tet[j])));
        }
    }
    let facets = (4 * t.tets().len() + t.hull().len()) / 2;
    let euler = vertices.len() as i64 - edges.len() as i64 + facets as i64 - t.tets().len() as i64;
    assert_eq!(euler, 1);
    assert_eq!(vertices.len() + t.duplicates().len(), points.len());
    for &(duplicate, kept) in t.duplicates() {
        assert!(kept < duplicate && points[kept.index()] == points[duplicate.index()]);
        assert!(vertices.contains(&kept) && !vertices.contains(&duplicate));
    }
}

/// Asserts that no point is in any sphere, by brute force.
fn assert_empty_spheres(points: &[Point], t: &Triangulation) {
    for tet in t.tets() {
        let [a, b, c, d] = tet.map(|v| points[v.index()]);
        assert!(points.iter().all(|&p| insphere(a, b, c, d, p) <= 0));
    }
}

/// Tets as sets of coordinates, independent of numbering.
fn as_set(points: &[Point], t: &Triangulation) -> BTreeSet<Vec<[u64; 3]>> {
    let bits = |v: VertexId| points[v.index()].map(|x| (x + 0.0).to_bits());
    let sorted = |tet: &[VertexId; 4]| {
        let mut corners: Vec<_> = tet.iter().map(|&v| bits(v)).collect();
        corners.sort_unstable();
        corners
    };
    t.tets().iter().map(sorted).collect()
}

fn volume(points: &[Point], t: &Triangulation) -> f64 {
    t.tets().iter().map(|tet| motet::geometry::tet::volume(tet.map(|v| points[v.index()]))).sum()
}

fn skew_lines(n: usize) -> Vec<Point> {
    let along = |i: usize| i as f64 / n as f64;
    (0..n).flat_map(|i| [[along(i), 0.0, 0.0], [0.0, along(i), 1.0]]).collect()
}

fn moment_curve(n: usize) -> Vec<Point> {
    (1..=n).map(|i| i as f64 / n as f64).map(|t| [t, t * t, t * t * t]).collect()
}

/// Dense crowds of points about three places, some of them equal.
fn crowds(n: usize) -> Vec<Point> {
    let mut next = uniform(3);
    let crowd = |i: usize| {
        let jitter: Point =
            std::array::from_fn(|_| (next() * 4.0).floor() * 1e-9 * 10f64.powi(-((i % 5) as i32)));
        let center = [(i % 3) as f64, (i % 2) as f64, (i % 7 / 4) as f64];
        std::array::from_fn(|k| center[k] + jitter[k])
    };
    (0..n).map(crowd).collect()
}

#[test]
fn every_kind_of_set_gets_its_delaunay_triangulation() {
    let sets = [
        ("random", cube(3000, 1)),
        ("sphere", sphere(2000)),
        ("sphere in a box", sphere_in_box(1000, 300)),
        ("sphere in a box, turned", turned(&sphere_in_box(1000, 300))),
        ("grid", grid(9, 1.0)),
        ("grid of step 0.1", grid(9, 0.1)),
        ("grid, turned", turned(&grid(8, 0.1))),
        ("moment curve", moment_curve(150)),
        ("two skew lines", skew_lines(150)),
        ("crowds", crowds(1500)),
    ];
    for (name, points) in sets {
        println!("{name}");
        let t = triangulate(&points);
        assert_delaunay(&points, &t);
    }
}

#[test]
fn no_sphere_holds_any_point() {
    for points in [cube(300, 2), sphere(250), grid(6, 0.1), sphere_in_box(100, 30), turned(&grid(6, 1.0))] {
        assert_empty_spheres(&points, &triangulate(&points));
    }
}

#[test]
fn the_tets_fill_the_hull() {
    let mut points = cube(2000, 5);
    points.extend(grid(2, 1.0));
    assert!((volume(&points, &triangulate(&points)) - 1.0).abs() < 1e-12);
    let points = grid(11, 0.1);
    assert!((volume(&points, &triangulate(&points)) - 1.0).abs() < 1e-12);
}

#[test]
fn two_skew_lines_have_a_tet_for_each_pair_of_segments() {
    let n = 100;
    assert_eq!(triangulate(&skew_lines(n)).tets().len(), (n - 1) * (n - 1));
}

#[test]
fn the_order_of_the_points_does_not_matter() {
    for points in [cube(2000, 9), grid(9, 0.1), sphere_in_box(500, 100)] {
        let expected = as_set(&points, &triangulate(&points));
        let mut reversed = points.clone();
        reversed.reverse();
        assert_eq!(as_set(&reversed, &triangulate(&reversed)), expected);
        let stride: Vec<Point> = (0..points.len()).map(|i| points[i * 7919 % points.len()]).collect();
        assert_eq!(as_set(&stride, &triangulate(&stride)), expected);
    }
}

#[test]
fn the_number_of_threads_does_not_matter() {
    let two = Threads::new(2).expect("two threads");
    for points in [cube(30_000, 4), grid(20, 0.1)] {
        let (one, two) = (triangulate(&points), Triangulation::new(&points, &two).expect("a volume"));
        assert!(one.tets() == two.tets() && one.neighbors() == two.neighbors() && one.hull() == two.hull());
    }
}

#[test]
fn the_unit_of_length_does_not_matter() {
    let points = sphere_in_box(200, 50);
    let expected = triangulate(&points);
    for exponent in [-900, -300, 3, 300, 1000] {
        let scale = 2f64.powi(exponent);
        let scaled: Vec<Point> = points.iter().map(|p| p.map(|x| x * scale)).collect();
        assert_eq!(triangulate(&scaled).tets(), expected.tets(), "2^{exponent}");
    }
}

#[test]
fn sizes_from_one_end_of_the_floats_to_the_other() {
    let mut next = uniform(11);
    let points: Vec<Point> = (0..150)
        .map(|i| {
            let size = 10f64.powi((i % 9 - 4) * 50);
            std::array::from_fn(|_| (next() - 0.5) * size)
        })
        .collect();
    let t = triangulate(&points);
    assert_delaunay(&points, &t);
}

#[test]
fn what_spans_no_volume_is_refused_by_name() {
    let refused =
        |points: &[Point]| Triangulation::new(points, &Threads::single()).expect_err("no volume").to_string();
    assert!(refused(&[]).contains("0 distinct points, expected at least 4"));
    assert!(refused(&[[0.0; 3], [1.0; 3], [2.0, 0.0, 0.0]]).contains("expected at least 4"));
    assert!(refused(&[[0.5; 3]; 1000]).contains("1 distinct points"));
    let line: Vec<Point> = (0..500).map(|i| [0.5 * f64::from(i), -3.0, f64::from(i)]).collect();
    assert!(refused(&line).contains("on one line"));
    let plane: Vec<Point> = cube(500, 6).iter().map(|p| [p[0], p[1], 0.1]).collect();
    assert!(refused(&plane).contains("in one plane"));
    let mut holed = cube(100, 8);
    holed[41][2] = f64::NAN;
    assert!(refused(&holed).contains("point 41"));
    holed[41][2] = f64::NEG_INFINITY;
    assert!(refused(&holed).contains("point 41"));
}

#[test]
fn one_tet_is_its_own_triangulation() {
    let points = [[0.0; 3], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]];
    let t = triangulate(&points);
    assert_delaunay(&points, &t);
    assert_eq!((t.tets().len(), t.hull().len()), (1, 4));
    assert_eq!(t.duplicates(), [(VertexId(4), VertexId(2))]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Few places for many points: every kind of degeneracy.
    #[test]
    fn small_degenerate_sets(
        points in prop::collection::vec(prop::array::uniform3(-2i8..=2), 0..60),
        (step, tilt) in (prop_oneof![Just(1.0), Just(0.1), Just(1e-160)], prop_oneof![Just(0.0), Just(0.37)]),
    ) {
        let place = |p: &[i8; 3]| {
            let [x, y, z] = p.map(|v| f64::from(v) * step);
            [x, y + tilt * x, z - tilt * y]
        };
        let points: Vec<Point> = points.iter().map(place).collect();
        if let Ok(t) = Triangulation::new(&points, &Threads::single()) {
            assert_delaunay(&points, &t);
            assert_empty_spheres(&points, &t);
        } else {
            let first = points.first().copied().unwrap_or_default();
            let flat = points.iter().all(|&b| points.iter().step_by(3).all(|&c| points.iter().step_by(2).all(
                |&d| orient3d(first, b, c, d) == 0)));
            prop_assert!(flat, "a set that spans a volume was refused");
        }
    }
}
