//! Surfaces that meet without shared vertices and edges: divided on request, with area and volume preserved,
//! and reported by kind.

use motet::base::{Point, Threads, VertexId};
use motet::geometry::triangle::area;
use motet::geometry::vector::{add, scale, sub};
use motet::mesh::shapes::{ball, box_grid};
use motet::mesh::{CellKind, Cells, Mesh, Surface};
use motet::meshing::{Options, Surfaces, fill};
use motet::preflight::{FaultKind, RepairKind, Repaired, Repairs, Role};

use crate::common::random::Random;

pub(super) const IMPRINT: Repairs = Repairs {
    merge: None,
    imprint: true,
    cut: false,
    drop_degenerate: false,
    drop_duplicates: false,
    orient: false,
    keep_inward: false,
    close_holes: None,
    unite: false,
    wrap: None,
};

const CUT: Repairs = Repairs { cut: true, ..IMPRINT };

/// Points and triangles.
pub(super) type Soup = (Vec<Point>, Vec<[VertexId; 3]>);

fn mesh((points, triangles): &Soup) -> Mesh {
    let cells = Cells::uniform(CellKind::TRIANGLE, triangles.as_flattened().to_vec()).unwrap();
    Mesh::new(points.clone(), cells)
}

/// The surface of a box of cubes, `n` along each axis.
pub(super) fn box_of(n: [usize; 3], bounds: [Point; 2]) -> Soup {
    let surface = Surface::boundary_of(&box_grid(n, bounds));
    (surface.points, surface.triangles)
}

/// Boxes between random planes of a grid, and the number of cells of the grid that are in some box.
pub(super) fn random_boxes(seed: u64, n: usize) -> (Vec<Soup>, usize) {
    const N: usize = 6;
    let mut random = Random((seed + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut below = |n: usize| (random.next() * n as f64) as usize;
    let mut range = |_| {
        let low = below(N);
        [low, low + 1 + below(N - low)]
    };
    let boxes: Vec<[[usize; 2]; 3]> = (0..n).map(|_| [0, 1, 2].map(&mut range)).collect();
    let at = |of: &[[usize; 2]; 3], end: usize| -> Point { [0, 1, 2].map(|axis| of[axis][end] as f64) };
    let bodies = boxes.iter().map(|of| box_of([1, 2, 1], [0, 1].map(|end| at(of, end)))).collect();
    let is_in_some = |cell: &usize| {
        let at = [cell / (N * N), cell / N % N, cell % N];
        boxes.iter().any(|of| (0..3).all(|axis| (of[axis][0]..of[axis][1]).contains(&at[axis])))
    };
    (bodies, (0..N * N * N).filter(is_in_some).count())
}

/// A rectangle of two triangles.
pub(super) fn sheet(corner: Point, u: Point, v: Point) -> Soup {
    let points = vec![corner, add(corner, u), add(add(corner, u), v), add(corner, v)];
    (points, [[0, 1, 2], [0, 2, 3]].map(|t| t.map(VertexId)).to_vec())
}

pub(super) fn together(soups: &[Soup]) -> Soup {
    let mut all: Soup = Default::default();
    for (points, triangles) in soups {
        let first = all.0.len();
        all.0.extend(points);
        all.1.extend(triangles.iter().map(|t| t.map(|v| VertexId::new(first + v.index()))));
    }
    all
}

/// Several kinds of rounding: none; rotated; rotated and shifted; in `f32`; with six decimals; small.
fn rounded(case: usize, p: Point) -> Point {
    let turned = || {
        let ([x, y, z], (s, c), (t, d)) = (p, 0.7f64.sin_cos(), 1.1f64.sin_cos());
        let [x, y] = [c * x - s * y, s * x + c * y];
        [d * x - t * z, y, t * x + d * z]
    };
    match case {
        0 => p,
        1 => turned(),
        2 => turned().map(|x| x + 1e3),
        3 => turned().map(|x| f64::from(x as f32)),
        4 => turned().map(|x| (x * 1e6).round() / 1e6),
        _ => turned().map(|x| x * 1e-3),
    }
}

pub(super) const CASES: usize = 6;

pub(super) fn moved(case: usize, (points, triangles): &Soup) -> Soup {
    (points.iter().map(|&p| rounded(case, p)).collect(), triangles.clone())
}

/// The permitted error of coordinates, and the length of a unit.
pub(super) fn scale_of(case: usize) -> (f64, f64) {
    match case {
        2 => (1e-11, 1.0),
        3 | 4 => (1e-5, 1.0),
        5 => (1e-12, 1e-3),
        _ => (1e-12, 1.0),
    }
}

pub(super) fn repaired(soups: &[(&Soup, Role)], repairs: &Repairs) -> (Surfaces, Repaired) {
    let meshes: Vec<(Mesh, Role)> = soups.iter().map(|(soup, role)| (mesh(soup), *role)).collect();
    let named: Vec<_> = meshes.iter().map(|(mesh, role)| (mesh, *role, "")).collect();
    let mut surfaces = Surfaces::new(&named).unwrap();
    let done = surfaces.repair(repairs, &Threads::single()).unwrap();
    (surfaces, done)
}

fn total_area(surfaces: &Surfaces) -> f64 {
    surfaces.triangles.iter().map(|t| area(t.map(|v| surfaces.points[v.index()]))).sum()
}

/// The volumes of the regions, ascending.
pub(super) fn volumes(surfaces: &Surfaces) -> Vec<f64> {
    let threads = Threads::single();
    let report = surfaces.preflight(&threads);
    assert!(report.is_fit(), "{report}");
    let filled = fill(surfaces, &report, &Options::default(), &threads).unwrap();
    assert_eq!(filled.report.not_positive, 0);
    let mut volumes: Vec<f64> = filled.report.bodies.iter().map(|body| body.volume).collect();
    volumes.sort_by(f64::total_cmp);
    volumes
}

pub(super) fn assert_volumes(case: usize, surfaces: &Surfaces, expected: &[f64]) {
    let (off, unit) = scale_of(case);
    let volumes = volumes(surfaces);
    assert_eq!(volumes.len(), expected.len(), "case {case}: {volumes:?}");
    for (volume, expected) in volumes.iter().zip(expected) {
        assert!(
            (volume / unit.powi(3) - expected).abs() < 10.0 * off.max(1e-12),
            "case {case}: {volume} {expected}"
        );
    }
}

/// A box of twelve triangles; on each side of one edge, the triangles have vertices at these fractions of the
/// edge, with fans around them.
fn with_vertices_on_edge(on_sides: [&[f64]; 2]) -> Soup {
    let (mut points, mut triangles) = box_of([1; 3], [[0.0; 3], [1.0, 2.0, 3.0]]);
    let [u, v, _] = triangles[0];
    let is_at = |t: &[VertexId; 3]| t.contains(&u) && t.contains(&v);
    let at_edge: Vec<[VertexId; 3]> = triangles.iter().copied().filter(is_at).collect();
    triangles.retain(|t| !is_at(t));
    for (triangle, parts) in at_edge.iter().zip(on_sides) {
        let k = (0..3).find(|&k| triangle[k] != u && triangle[k] != v).unwrap();
        let [apex, from, to] = [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
        let [p, q] = [u, v].map(|v| points[v.index()]);
        let mut on: Vec<VertexId> = Vec::new();
        for part in parts {
            on.push(VertexId::new(points.len()));
            points.push(add(p, scale(sub(q, p), *part)));
        }
        if from == v {
            on.reverse();
        }
        let way: Vec<VertexId> = [from].into_iter().chain(on).chain([to]).collect();
        triangles.extend(way.windows(2).map(|pair| [apex, pair[0], pair[1]]));
    }
    (points, triangles)
}

#[test]
fn edges_are_divided_at_vertices_on_them() {
    let sides: [[&[f64]; 2]; 3] =
        [[&[0.5], &[]], [&[0.125, 0.3, 0.7], &[]], [&[1.0 / 3.0, 2.0 / 3.0], &[0.1, 0.5]]];
    for (case, on_sides) in (0..CASES).flat_map(|case| sides.map(|on_sides| (case, on_sides))) {
        let soup = moved(case, &with_vertices_on_edge(on_sides));
        let (before, _) = repaired(&[(&soup, Role::Boundary)], &Repairs::default());
        assert!(!before.preflight(&Threads::single()).is_fit());
        let (surfaces, done) = repaired(&[(&soup, Role::Boundary)], &IMPRINT);
        let report = surfaces.preflight(&Threads::single());
        assert!(report.is_fit() && report.faults.is_empty(), "case {case}: {report}");
        // No points are new, and each vertex is on the edge of the other side.
        assert_eq!(surfaces.points.len(), before.points.len());
        let n = on_sides[0].len() + on_sides[1].len();
        assert_eq!(done.count(RepairKind::TJunction), n, "case {case}");
        assert_eq!(surfaces.triangles.len(), 12 + 2 * n);
        for junction in done.done.iter().filter(|repair| repair.kind == RepairKind::TJunction) {
            assert_eq!(junction.at, Some(surfaces.points[junction.vertices[0].index()]));
        }
        assert_volumes(case, &surfaces, &[6.0]);
    }
}

#[test]
fn bodies_side_by_side_share_their_wall() {
    let beside = [
        // The same face with other triangles; a smaller face within a larger one; faces that overlap in part.
        ([3, 3, 3], [[1.0, 0.0, 0.0], [2.0, 1.0, 1.0]], [1.0, 1.0]),
        ([2, 2, 2], [[1.0, 0.2, 0.3], [2.0, 0.7, 0.9]], [0.3, 1.0]),
        ([1, 2, 1], [[1.0, 0.4, 0.3], [1.5, 1.4, 1.3]], [0.5, 1.0]),
    ];
    for (case, (n, bounds, expected)) in (0..CASES).flat_map(|case| beside.map(|beside| (case, beside))) {
        let bodies = [box_of([2; 3], [[0.0; 3], [1.0; 3]]), box_of(n, bounds)];
        let both = moved(case, &together(&bodies));
        let (surfaces, done) = repaired(&[(&both, Role::Boundary)], &IMPRINT);
        assert!(done.count(RepairKind::Imprinted) > 0 && done.count(RepairKind::CutCrossing) == 0);
        assert!(done.count(RepairKind::KeptWall) > 0);
        assert_volumes(case, &surfaces, &expected);
        // From two files, they share the facets instead.
        let [a, b] = bodies.map(|body| moved(case, &body));
        let (surfaces, done) = repaired(&[(&a, Role::Boundary), (&b, Role::Boundary)], &IMPRINT);
        let n_shared = surfaces.preflight(&Threads::single()).count(FaultKind::SharedFacet);
        assert!(n_shared > 0 && done.count(RepairKind::KeptWall) == 0);
        assert_volumes(case, &surfaces, &expected);
    }
}

#[test]
fn bodies_that_go_through_each_other_are_divided_on_request_only() {
    for case in 0..CASES {
        let second = [[0.4, 0.3, -0.2], [1.9, 0.8, 0.7]];
        let both = together(&[box_of([2; 3], [[0.0; 3], [1.0; 3]]), box_of([1, 2, 1], second)]);
        let both = moved(case, &both);
        let (surfaces, _) = repaired(&[(&both, Role::Boundary)], &IMPRINT);
        let report = surfaces.preflight(&Threads::single());
        let error = report.first_error().expect("what crosses is not divided").to_string();
        assert!(report.count(FaultKind::Crossing) > 0 && error.contains("--cut"), "{error}");
        let (surfaces, done) = repaired(&[(&both, Role::Boundary)], &CUT);
        assert!(done.count(RepairKind::CutCrossing) > 0);
        // The intersection is 0.6 by 0.5 by 0.7.
        let (off, unit) = scale_of(case);
        let whole = 6.0 + 2.0 * (1.5 * 0.5 + 0.5 * 0.9 + 0.9 * 1.5);
        assert!((total_area(&surfaces) / unit.powi(2) - whole).abs() < 100.0 * off);
        assert_volumes(case, &surfaces, &[0.21, 1.5 * 0.5 * 0.9 - 0.21, 1.0 - 0.21]);
    }
}

#[test]
fn sheets_that_cross_in_a_line_and_in_a_point_are_divided() {
    let wall = box_of([2; 3], [[-1.0; 3], [1.0; 3]]);
    let sheets = [
        sheet([-0.5, -0.6, 0.1], [1.0, 0.0, 0.0], [0.0, 1.2, 0.0]),
        sheet([-0.4, 0.1, -0.5], [0.9, 0.0, 0.0], [0.0, 0.0, 1.0]),
        // Through the line of the others, and from wall to wall.
        sheet([0.2, -1.0, -1.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]),
    ];
    let areas: f64 = 24.0 + 1.2 + 0.9 + 4.0;
    for case in 0..CASES {
        let moved_sheets = sheets.each_ref().map(|soup| moved(case, soup));
        let wall = moved(case, &wall);
        let mut all = vec![(&wall, Role::Boundary)];
        all.extend(moved_sheets.iter().map(|soup| (soup, Role::Membrane)));
        let (surfaces, done) = repaired(&all, &CUT);
        assert!(done.count(RepairKind::CutCrossing) > 2, "case {case}");
        let (off, unit) = scale_of(case);
        assert!((total_area(&surfaces) / unit.powi(2) - areas).abs() < 100.0 * off, "case {case}");
        assert_volumes(case, &surfaces, &[8.0 * 0.4, 8.0 * 0.6]);
    }
}

#[test]
fn surfaces_that_are_right_stay_as_they_are() {
    let ball = Surface::boundary_of(&ball(3, 1));
    let shifted = |s: f64, by: f64| -> Soup {
        (ball.points.iter().map(|p| scale(*p, s).map(|x| x + by)).collect(), ball.triangles.clone())
    };
    let soups = [shifted(1.0, 0.0), shifted(0.5, 0.1), shifted(1.0, 5.0)];
    let all: Vec<_> = soups.iter().map(|soup| (soup, Role::Boundary)).collect();
    let (before, _) = repaired(&all, &Repairs::default());
    let (surfaces, done) = repaired(&all, &CUT);
    assert!(done.done.is_empty());
    assert_eq!((surfaces.points, surfaces.triangles), (before.points, before.triangles));
}

#[test]
fn values_at_points_are_linear_in_the_triangles_where_points_are_new() {
    let both = together(&[box_of([1; 3], [[0.0; 3], [1.0; 3]]), box_of([1; 3], [[0.5; 3], [1.5; 3]])]);
    let value = |p: &Point| 3.0 + p[0] - 2.0 * p[1] + 0.5 * p[2];
    let (before, _) = repaired(&[(&both, Role::Boundary)], &Repairs::default());
    let given: Vec<f64> = before.points.iter().map(value).collect();
    let (surfaces, done) = repaired(&[(&both, Role::Boundary)], &CUT);
    let values = done.at_points(&given);
    assert!(surfaces.points.len() > before.points.len());
    for (p, reported) in surfaces.points.iter().zip(values) {
        assert!((value(p) - reported).abs() < 1e-12, "{p:?}");
    }
}
