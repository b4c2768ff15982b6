//! Wires as closed surfaces: volumes, unions, joints, what is refused.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use motet::base::{Point, Threads, VertexId};
use motet::geometry::triangle::area_vector;
use motet::geometry::vector::{distance, dot, scale, sub, unit};
use motet::mesh::shapes::{Braid, Coil};
use motet::mesh::{CellKind, Cells, Field, Mesh, Surface, open_edges};
use motet::meshing::even::SurfaceWords;
use motet::meshing::tubes::{Options, Radius, Tubes, even_tubes, tubes};
use motet::preflight::own_crossings;
use motet::spatial::WindingNumber;
use proptest::prelude::*;

fn lines(points: &[Point], chains: &[&[usize]]) -> Mesh {
    let mut cells = Cells::new();
    for chain in chains {
        cells.push(CellKind::POLY_LINE, chain.iter().map(|&v| VertexId::new(v)));
    }
    Mesh::new(points.to_vec(), cells)
}

fn of(radius: f64) -> Options {
    Options::of(Radius::Same(radius))
}

/// The tubes, checked: closed, free of crossings, facing outward.
fn sound(mesh: &Mesh, options: &Options) -> Tubes {
    let made = tubes(mesh, options, &Threads::single()).expect("the wires can be united");
    let surface = Surface::of(&made.mesh);
    assert!(open_edges(&surface.triangles).is_empty());
    assert!(own_crossings(&surface.points, &surface.triangles, &Threads::single()).is_empty());
    assert!((surface.enclosed_volume() - made.report.volume).abs() < 1e-12 && made.report.volume > 0.0);
    made
}

#[test]
fn a_straight_wire_and_one_of_gentle_bends_have_the_volume_of_round_ones() {
    let bent = [[0.0; 3], [1.0, 0.0, 0.0], [1.8, 0.6, 0.0], [2.0, 1.2, 0.9], [2.0, 1.4, 2.0]];
    for (points, chain) in [(&bent[..2], &[0, 1][..]), (&bent[..], &[0, 1, 2, 3, 4])] {
        let made = sound(&lines(points, &[chain]), &of(0.1));
        let length: f64 = chain.windows(2).map(|s| distance(points[s[0]], points[s[1]])).sum();
        let volume = PI * 0.01 * length;
        assert!((made.report.volume / volume - 1.0).abs() < 1e-12, "{} {volume}", made.report.volume);
        assert!((made.report.wire_volume / volume - 1.0).abs() < 1e-12);
        assert_eq!((made.report.chains, made.report.sharp_bends, made.report.bodies), (1, 0, 1));
        assert!(made.is_far.iter().all(|is_far| *is_far));
    }
}

#[test]
fn a_closed_ring_is_a_torus_without_caps() {
    let n = 48;
    let points: Vec<Point> = (0..n)
        .map(|i| {
            let (sin, cos) = (2.0 * PI * f64::from(i) / f64::from(n)).sin_cos();
            [cos, sin, 0.2 * (3.0 * sin).sin()]
        })
        .collect();
    let chain: Vec<usize> = (0..=n as usize).map(|i| i % n as usize).collect();
    let made = sound(&lines(&points, &[&chain]), &of(0.1));
    // Twist is spread over the ring, so prisms are not exact.
    assert!((made.report.volume / made.report.wire_volume - 1.0).abs() < 1e-3);
    let (v, f) = (made.mesh.points.len(), made.mesh.cells.len());
    assert_eq!(2 * v, f, "the Euler characteristic of a torus is 0");
}

#[test]
fn radii_of_points_and_cells_make_cones_and_steps() {
    let mut mesh = lines(&[[0.0; 3], [2.0, 0.0, 0.0]], &[&[0, 1]]);
    mesh.set_point_field(Field::scalars("r", vec![0.1, 0.2]));
    mesh.set_cell_field(Field::scalars("d", vec![0.1]));
    let cone = sound(&mesh, &Options::of(Radius::Array("r".into())));
    let volume = PI / 3.0 * (0.01 + 0.02 + 0.04) * 2.0;
    assert!((cone.report.volume / volume - 1.0).abs() < 1e-12);
    assert_eq!(cone.report.radii, [0.1, 0.2]);
    let same = sound(&mesh, &Options::of(Radius::Array("d".into())));
    assert!((same.report.volume / (PI * 0.01 * 2.0) - 1.0).abs() < 1e-12);
}

/// The share of points of a fine grid in a box that are inside, times the volume of the box.
fn sampled(n: usize, [low, high]: [Point; 2], is_inside: impl Fn(Point) -> bool) -> f64 {
    let place = |i: usize, k: usize| low[k] + (high[k] - low[k]) * (i as f64 + 0.5) / n as f64;
    let all = (0..n).flat_map(|i| (0..n).flat_map(move |j| (0..n).map(move |k| [i, j, k])));
    let inside = all.filter(|&[i, j, k]| is_inside([place(i, 0), place(j, 1), place(k, 2)])).count();
    let size = sub(high, low);
    size[0] * size[1] * size[2] * inside as f64 / (n * n * n) as f64
}

#[test]
fn wires_that_cross_are_one_body_of_the_volume_of_their_union() {
    let points = [[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.05], [0.2, 1.0, 0.05]];
    let made = sound(&lines(&points, &[&[0, 1], &[2, 3]]), &of(0.2));
    assert_eq!((made.report.bodies, made.report.meetings, made.report.bridges), (1, 1, 0));
    assert_eq!((made.report.branching_edges, made.report.pinched_vertices), (0, 0));
    // Two other routes: round wires, and winding numbers of the surface.
    let near = |a: Point, b: Point, p: Point| {
        let t = (dot(sub(p, a), sub(b, a)) / dot(sub(b, a), sub(b, a))).clamp(0.0, 1.0);
        let is_between = t > 0.0 && t < 1.0;
        is_between && distance(p, motet::geometry::vector::add(a, scale(sub(b, a), t))) < 0.2
    };
    let bounds = [[-1.05, -1.05, -0.25], [1.05, 1.05, 0.3]];
    let round = sampled(70, bounds, |p| near(points[0], points[1], p) || near(points[2], points[3], p));
    assert!((made.report.volume / round - 1.0).abs() < 0.015, "{} {round}", made.report.volume);
    let surface = Surface::of(&made.mesh);
    let winding = WindingNumber::new(&surface.points, &surface.triangles);
    let wound = sampled(70, bounds, |p| winding.at(p) > 0.5);
    assert!((made.report.volume / wound - 1.0).abs() < 0.01, "{} {wound}", made.report.volume);
}

#[test]
fn branches_and_sharp_bends_are_joined_by_balls() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [-0.5, 0.8, 0.0], [-0.5, -0.7, 0.3], [0.1, 0.35, 0.1]];
    let star = sound(&lines(&points, &[&[1, 0], &[0, 2], &[3, 0]]), &of(0.1));
    assert_eq!((star.report.chains, star.report.branches, star.report.sharp_bends), (3, 1, 0));
    assert_eq!((star.report.bodies, star.report.pinched_vertices), (1, 0));
    // A hairpin, whose legs overlap near the bend.
    let hairpin = sound(&lines(&points, &[&[1, 0, 4]]), &of(0.1));
    assert_eq!((hairpin.report.branches, hairpin.report.sharp_bends, hairpin.report.bodies), (0, 1, 1));
    let back = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1e-3, 0.0]];
    assert_eq!(sound(&lines(&back, &[&[0, 1, 2]]), &of(0.1)).report.sharp_bends, 1);
    let steps: Vec<Point> = (0..9).map(|i| [0.04 * f64::from(i), 0.03 * f64::from(i % 2), 0.0]).collect();
    let zigzag = sound(&lines(&steps, &[&[0, 1, 2, 3, 4, 5, 6, 7, 8]]), &of(0.1));
    assert!(zigzag.report.sharp_bends > 0 && zigzag.report.bodies == 1);
}

#[test]
fn wires_nearer_than_the_gap_are_joined_and_others_stay_apart() {
    let two = |height: f64| {
        lines(
            &[[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, -1.0, height], [0.1, 1.0, height]],
            &[&[0, 1], &[2, 3]],
        )
    };
    for (height, bodies, bridges) in
        [(0.2, 1, 1), (0.2 + 0.009, 1, 1), (0.2 - 0.009, 1, 1), (0.22, 2, 0), (0.1, 1, 0)]
    {
        let made = sound(&two(height), &of(0.1));
        assert_eq!((made.report.bodies, made.report.bridges), (bodies, bridges), "{height}");
        if bodies == 2 {
            assert!((made.report.least_gap.unwrap() - 0.02).abs() < 1e-3);
        }
    }
    let apart = sound(&two(0.215), &Options { join: Some(0.0), ..of(0.1) });
    assert_eq!((apart.report.bodies, apart.report.bridges), (2, 0));
    let joined = sound(&two(0.25), &Options { join: Some(0.06), ..of(0.1) });
    assert_eq!((joined.report.bodies, joined.report.bridges), (1, 1));
    // Side by side they are joined along their length.
    let parallel = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 0.2, 0.0], [2.0, 0.2, 0.0]];
    let made = sound(&lines(&parallel, &[&[0, 1], &[2, 3]]), &of(0.1));
    assert_eq!((made.report.bodies, made.report.bridges), (1, 1));
}

#[test]
fn turns_of_a_coil_that_touch_are_joined() {
    let coil = Coil { centre: [0.0; 3], radius: 0.5, pitch: 0.16, turns: 2.5, wire_radius: 0.08 };
    let made = sound(&coil.lines(32).unwrap(), &Options::of(Radius::Array("radius".into())));
    assert!(made.report.bridges > 0 && made.report.bodies == 1);
}

#[test]
fn a_braid_of_wires_that_touch_overlap_or_stay_apart_is_closed_and_even() {
    for (gap, over, bodies) in [(0.0, 1, 1), (-0.05, 2, 1), (0.03, 1, 4)] {
        let braid = Braid { radius: 0.6, length: 1.0, wires: 4, pitch: 3.0, wire_radius: 0.05, gap, over };
        let mesh = braid.lines(8).unwrap();
        let options = Options::of(Radius::Array("radius".into()));
        assert_eq!(sound(&mesh, &options).report.bodies, bodies, "{gap}");
        let even = even_tubes(&mesh, &options, &SurfaceWords::default(), &Threads::single()).unwrap();
        let after = &even.report.surface.after;
        assert_eq!((after.crossings, after.open_edges, even.report.surface.not_reached()), (0, 0, None));
        assert!(after.angles.worst > 15.0, "{after:?}");
        let volume = after.volume.unwrap();
        assert!((volume / even.report.wires.volume - 1.0).abs() < 0.01);
    }
}

/// The least cosine between the normals of two triangles at an edge.
fn sharpest_fold(surface: &Surface) -> f64 {
    let mut at = BTreeMap::new();
    for (t, &[a, b, c]) in surface.triangles.iter().enumerate() {
        at.extend([[a, b], [b, c], [c, a]].map(|edge| (edge, t)));
    }
    let normal = |t: usize| unit(area_vector(surface.corners(t))).unwrap();
    at.iter().map(|(&[u, v], &t)| dot(normal(t), normal(at[&[v, u]]))).fold(1.0, f64::min)
}

#[test]
fn no_triangles_are_folded_onto_each_other_where_wires_overlap() {
    let braid =
        Braid { radius: 0.6, length: 2.0, wires: 8, pitch: 2.5, wire_radius: 0.05, gap: -0.07, over: 1 };
    let mut mesh = braid.lines(2).unwrap();
    mesh.points.iter_mut().for_each(|p| p[0] += 0.5 * p[2] * p[2]);
    let options = Options::of(Radius::Array("radius".into()));
    let even = even_tubes(&mesh, &options, &SurfaceWords::default(), &Threads::single()).unwrap();
    let fold = sharpest_fold(&Surface::of(&even.mesh));
    assert!(fold > -0.966, "{fold}");
}

#[test]
fn a_braid_has_crossings_where_wires_are_their_gap_apart() {
    for (gap, over) in [(0.0, 1), (0.1, 2)] {
        let braid = Braid { wires: 8, pitch: 8.0, length: 8.0, gap, over, ..Braid::default() };
        let mesh = braid.lines(16).unwrap();
        assert_eq!(mesh.cells.counts(), [(CellKind::POLY_LINE, 8)]);
        let wires: Vec<Vec<Point>> =
            mesh.cells.iter().map(|(_, _, vs)| vs.iter().map(|v| mesh.points[v.index()]).collect()).collect();
        // At each crossing a wire of the first way meets one of the second at the same angle and height.
        for i in (0..wires[0].len()).step_by(16) {
            let of = |p: Point| (p[1].atan2(p[0]), p[0].hypot(p[1]));
            let (angle, radius) = of(wires[0][i]);
            let is_there =
                |w: &&Vec<Point>| ((of(w[i]).0 - angle).rem_euclid(2.0 * PI) + 1e-9) % (2.0 * PI) < 2e-9;
            let other = wires[4..].iter().find(is_there).expect("wires cross here");
            assert!(((radius - of(other[i]).1).abs() - 2.0 * 0.05 - gap).abs() < 1e-9);
        }
    }
}

#[test]
fn what_cannot_be_a_tube_is_named() {
    let nan =
        lines(&[[0.0; 3], [1.0, 0.0, 0.0], [f64::NAN, 0.0, 0.0], [3.0, 0.0, 0.0]], &[&[0, 1, 2], &[2, 3]]);
    let refused = |mesh: &Mesh, options: &Options| {
        tubes(mesh, options, &Threads::single()).expect_err("it is refused").to_string()
    };
    let text = refused(&nan, &of(0.1));
    assert!(text.contains("point 2") && text.contains("cell 0") && text.contains("repair"), "{text}");
    let left = sound(&nan, &Options { repair: true, ..of(0.1) });
    assert_eq!((left.report.left_out, left.report.segments), (2, 1));
    let mut with_radii = lines(&[[0.0; 3], [1.0, 0.0, 0.0]], &[&[0, 1]]);
    with_radii.set_point_field(Field::scalars("r", vec![0.1, -1.0]));
    let by = |name: &str| Options::of(Radius::Array(name.into()));
    let text = refused(&with_radii, &by("r"));
    assert!(text.contains("`r` at point 1") && text.contains("-1"), "{text}");
    assert!(refused(&with_radii, &by("s")).contains("point arrays: r"));
    let same = lines(&[[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0]], &[&[0, 1], &[1, 2]]);
    assert!(refused(&same, &of(0.1)).contains("has no length"));
    let mut triangle = Cells::new();
    triangle.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId::new));
    assert!(refused(&Mesh::new(vec![[0.0; 3]; 3], triangle), &of(0.1)).contains("no line cells"));
    let wire = lines(&[[0.0; 3], [1.0, 0.0, 0.0]], &[&[0, 1]]);
    assert!(refused(&wire, &of(0.0)).contains("radius"));
    assert!(refused(&wire, &Options { sides: Some(2), ..of(0.1) }).contains("2 sides"));
    assert!(refused(&wire, &Options { join: Some(-1.0), ..of(0.1) }).contains("joined"));
    assert!(refused(&wire, &of(1e-9)).contains("too large"));
}

#[test]
fn curves_of_higher_order_follow_their_nodes() {
    let points = vec![[0.0; 3], [2.0, 0.0, 0.0], [1.0, 0.5, 0.0]];
    let mut cells = Cells::new();
    cells.push(CellKind::QUADRATIC_LINE, [0, 1, 2].map(VertexId::new));
    let made = sound(&Mesh::new(points, cells), &of(0.05));
    assert_eq!((made.report.segments, made.report.chains), (2, 1));
    assert!((made.report.length - 2.0 * 1.25f64.sqrt()).abs() < 1e-12);
}

#[test]
fn the_result_is_the_same_for_any_number_of_threads() {
    let mesh = Braid { radius: 0.6, length: 1.0, wires: 4, pitch: 3.0, ..Braid::default() }.lines(8).unwrap();
    let made = |threads: &Threads| {
        even_tubes(&mesh, &Options::of(Radius::Same(0.05)), &SurfaceWords::default(), threads).unwrap().mesh
    };
    assert_eq!(made(&Threads::single()), made(&Threads::exactly(3).unwrap()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Random wires that touch, cross and bend in any way are closed, free of crossings, and no larger than
    /// all of their parts together.
    #[test]
    fn random_wires_make_closed_surfaces(
        points in prop::collection::vec(prop::array::uniform3(-1.0f64..1.0), 6..12),
        is_touching in any::<bool>(),
    ) {
        let mut points = points;
        if is_touching {
            // The second wire lies on the first.
            points[4] = [points[0][0], points[0][1], points[0][2] + 0.2];
            points[5] = [points[1][0], points[1][1], points[1][2] + 0.2];
        }
        let n = points.len();
        let rest: Vec<usize> = (6..n).chain([0]).collect();
        let chains: Vec<&[usize]> = vec![&[0, 1, 2, 3], &[4, 5], &rest];
        let made = sound(&lines(&points, &chains), &of(0.1));
        let balls = made.report.branches + made.report.sharp_bends;
        prop_assert!(made.report.volume > 0.3 * made.report.wire_volume);
        let most = made.report.wire_volume * 1.2 + 0.01 * (balls + made.report.bridges) as f64 + 0.02;
        prop_assert!(made.report.bridges > 2 || made.report.volume < most);
    }
}
