//! Nearest triangles: compared with brute force, and checked by the definition of closest points.

use motet::base::{MaybeId, Point, Threads, TriangleId, VertexId};
use motet::geometry::triangle;
use motet::geometry::vector::{add, distance, dot, norm, scale, sub};
use motet::mesh::shapes::{TubeOptions, mixed, sphere_in_box, tube};
use motet::mesh::{CellKind, Cells, Mesh, Surface, triangulate};
use motet::spatial::NearestTriangle;
use proptest::prelude::*;

fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![2 => -1.0f64..1.0, 1 => (-2i32..3).prop_map(|i| f64::from(i) / 2.0)]
}

fn points(n: usize) -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec(prop::array::uniform3(coordinate()), n)
}

fn soup() -> impl Strategy<Value = Vec<[VertexId; 3]>> {
    prop::collection::vec(prop::array::uniform3((0u32..12).prop_map(VertexId)), 1..60)
}

fn by_brute_force(points: &[Point], triangles: &[[VertexId; 3]], p: Point) -> (usize, f64) {
    let distance_squared = |t: &[VertexId; 3]| {
        let corners = t.map(|v| points[v.index()]);
        let offset = sub(triangle::at(corners, triangle::closest(corners, p)), p);
        dot(offset, offset)
    };
    let all = triangles.iter().map(distance_squared).enumerate();
    all.min_by(|x, y| x.1.total_cmp(&y.1)).expect("there is a triangle")
}

proptest! {
    #[test]
    fn the_tree_finds_what_a_look_at_every_triangle_finds(
        points in points(12), triangles in soup(), p in prop::array::uniform3(-2.0f64..2.0),
        unit in prop::sample::select(vec![1.0, 1e-3, 1e-9, 1e6]),
    ) {
        let points: Vec<Point> = points.iter().map(|x| scale(*x, unit)).collect();
        let p = scale(p, unit);
        let found = NearestTriangle::new(&points, &triangles, &Threads::single()).closest(p).unwrap();
        prop_assert_eq!((found.triangle, found.distance_squared), by_brute_force(&points, &triangles, p));
        let weights = found.weights;
        prop_assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)));
        prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15);
        let corners = triangles[found.triangle].map(|v| points[v.index()]);
        prop_assert_eq!(triangle::at(corners, weights), found.point);
        let far = found.distance_squared.sqrt();
        let tree = NearestTriangle::new(&points, &triangles, &Threads::single());
        prop_assert_eq!(tree.closest_within(p, far * 1.001 + 1e-300), Some(found));
        prop_assert_eq!(tree.closest_within(p, far * 0.999), None.or((far == 0.0).then_some(found)));
    }

    #[test]
    fn no_point_of_the_triangle_is_closer(
        corners in prop::array::uniform3(prop::array::uniform3(coordinate())),
        p in prop::array::uniform3(-2.0f64..2.0),
    ) {
        // c is the point of a convex set closest to p exactly when nothing of the
        // set lies on p's side of the plane through c across p - c.
        let c = triangle::at(corners, triangle::closest(corners, p));
        let away = sub(p, c);
        for corner in corners {
            prop_assert!(dot(away, sub(corner, c)) <= 1e-13 * norm(away).max(1e-3), "{:?}", corner);
        }
    }
}

#[test]
fn needles_and_points_count_as_what_they_are() {
    let line = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [3.0, 0.0, 0.0]];
    let ids = [[0, 1, 2].map(VertexId)];
    let on_line = NearestTriangle::new(&line, &ids, &Threads::single()).closest([2.0, 1.0, 0.0]).unwrap();
    assert_eq!((on_line.point, on_line.distance_squared), ([2.0, 0.0, 0.0], 1.0));
    let dot = [[1.0, 2.0, 3.0]; 3];
    assert_eq!(
        NearestTriangle::new(&dot, &ids, &Threads::single())
            .closest([1.0, 2.0, 5.0])
            .unwrap()
            .distance_squared,
        4.0
    );
    let needle = [[0.0, 0.0, 0.0], [1.0, 1e-17, 0.0], [2.0, 0.0, 1e-18]];
    let found = NearestTriangle::new(&needle, &ids, &Threads::single()).closest([1.5, 1.0, 0.0]).unwrap();
    assert!((found.distance_squared - 1.0).abs() < 1e-15 && (found.point[0] - 1.5).abs() < 1e-15);
}

#[test]
fn a_search_without_an_answer_says_so() {
    assert!(NearestTriangle::new(&[], &[], &Threads::single()).closest([0.0; 3]).is_none());
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, f64::NAN, 0.0], [0.0, 1.0, 0.0]];
    let tree = NearestTriangle::new(
        &corners,
        &[[0, 1, 2].map(VertexId), [0, 1, 3].map(VertexId)],
        &Threads::single(),
    );
    assert_eq!(tree.closest([0.1, 0.1, 1.0]).map(|c| c.triangle), Some(1));
    assert!(tree.closest([f64::NAN, 0.0, 0.0]).is_none());
    assert!(tree.closest([f64::INFINITY, 0.0, 0.0]).is_none());
    let huge = [[-3.4e38, 0.0, 0.0], [3.4e38, 0.0, 0.0], [0.0, 3.4e38, 0.0]];
    let found = NearestTriangle::new(&huge, &[[0, 1, 2].map(VertexId)], &Threads::single())
        .closest([0.0, 1.0, 2e38])
        .unwrap();
    assert!((found.distance_squared / 4e76 - 1.0).abs() < 1e-14);
}

#[test]
fn distances_to_a_sphere_are_those_of_the_radius() {
    let mesh = sphere_in_box(12, 2);
    let mut surface = Surface::of(&mesh);
    let sphere = mesh.patches().unwrap().find("sphere").unwrap();
    let mut patches = surface.patches.iter();
    surface.triangles.retain(|_| patches.next() == Some(&sphere));
    let tree = NearestTriangle::new(&surface.points, &surface.triangles, &Threads::single());
    for p in &mesh.points {
        let found = tree.closest(*p).unwrap().distance_squared.sqrt();
        // The surface lies within the sphere by at most the sagitta of its longest edge.
        let exact = norm(*p) - 1.0;
        assert!((exact - 1e-12..exact + 0.02).contains(&found), "{found} {exact}");
    }
}

fn area_of(surface: &Surface) -> f64 {
    (0..surface.triangles.len()).map(|t| triangle::area(surface.corners(t))).sum()
}

/// Six times the enclosed volume, signed.
fn enclosed(surface: &Surface) -> f64 {
    let cone = |t| {
        let corners = surface.corners(t);
        dot(triangle::area_vector(corners), triangle::centroid(corners)) / 3.0
    };
    (0..surface.triangles.len()).map(cone).sum()
}

#[test]
fn the_surface_cells_and_the_boundary_found_are_one_surface() {
    let wedges = TubeOptions {
        wall_layers: 2,
        wall_cells: motet::mesh::shapes::WallCells::Wedges,
        ..TubeOptions::default()
    };
    for mesh in [mixed(2), tube(&wedges), sphere_in_box(4, 2)] {
        let (given, found) = (Surface::of(&mesh), Surface::boundary_of(&mesh));
        assert_eq!(given.triangles, found.triangles);
        let volume: f64 = motet::mesh::cell_volumes(&mesh.cells, &mesh.points).iter().sum();
        assert!((enclosed(&given) - volume).abs() < 1e-11 * volume);
        assert!(given.patches.iter().all(|&p| p != 0) && !given.patch_names.is_empty());
        assert_eq!(given.vertices(), motet::mesh::Boundary::of(&mesh.cells).vertices);
    }
    assert!((area_of(&Surface::of(&mixed(2))) - 14.0).abs() < 1e-12);
}

#[test]
fn surface_cells_of_every_kind_keep_their_area_and_their_side() {
    // The unit square, in every form that VTK supports; area vector (0, 0, 1).
    let square = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];
    let middle = |i: usize, j: usize| scale(add(square[i], square[j]), 0.5);
    let middles = [middle(0, 1), middle(1, 2), middle(2, 3), middle(3, 0)];
    let with = |extra: &[Point]| square.iter().chain(extra).copied().collect::<Vec<_>>();
    let dented = vec![[0., 0., 0.], [2., 0., 0.], [2., 1., 0.], [1., 0.5, 0.], [0., 1., 0.], [0.5, 0.4, 0.]];
    let cases = [
        (CellKind::QUAD, with(&[]), 1.0),
        (CellKind::PIXEL, vec![square[0], square[1], square[3], square[2]], 1.0),
        (CellKind::POLYGON, with(&[]), 1.0),
        (CellKind::TRIANGLE_STRIP, vec![square[0], square[1], square[3], square[2]], 1.0),
        (CellKind::QUADRATIC_QUAD, with(&middles), 1.0),
        (CellKind::BIQUADRATIC_QUAD, with(&[&middles[..], &[middle(0, 2)]].concat()), 1.0),
        (CellKind::QUADRATIC_LINEAR_QUAD, with(&[middles[0], middles[2]]), 1.0),
        (CellKind::QUADRATIC_POLYGON, with(&middles), 1.0),
        (CellKind::TRIANGLE, square[..3].to_vec(), 0.5),
        (
            CellKind::QUADRATIC_TRIANGLE,
            [&square[..3], &[middle(0, 1), middle(1, 2), middle(2, 0)]].concat(),
            0.5,
        ),
        (
            CellKind::BIQUADRATIC_TRIANGLE,
            [&square[..3], &[middle(0, 1), middle(1, 2), middle(2, 0), [0.6, 0.4, 0.0]]].concat(),
            0.5,
        ),
        (CellKind::POLYGON, dented, 1.25),
    ];
    for (kind, points, area) in cases {
        let ids: Vec<_> = (0..points.len()).map(VertexId::new).collect();
        let mut cells = Cells::new();
        cells.push(kind, ids.iter().copied());
        let surface = Surface::of(&Mesh::new(points.clone(), cells));
        assert_eq!(surface.vertices(), ids, "{}", kind.label());
        let vectors = (0..surface.triangles.len()).map(|t| triangle::area_vector(surface.corners(t)));
        assert!(vectors.clone().all(|v| v[2] > 0.0), "{} {:?}", kind.label(), surface.triangles);
        assert!(distance(vectors.fold([0.0; 3], add), [0.0, 0.0, area]) < 1e-15, "{}", kind.label());
        assert_eq!(surface.triangle_to_cell.len(), surface.triangles.len());
    }
    let mut none = 0;
    triangulate(CellKind::LINE, &[VertexId(0), VertexId(1)], &square, &mut |_| none += 1);
    assert_eq!(none, 0);
}

/// Triangles with every flaw: without area, needles, coincident ones, corners that are not finite.
fn rough_soup() -> impl Strategy<Value = (Vec<Point>, Vec<[VertexId; 3]>)> {
    let x = prop_oneof![8 => coordinate(), 1 => Just(1e-9)];
    let wrong = prop_oneof![Just(f64::NAN), Just(f64::INFINITY), Just(f64::NEG_INFINITY)];
    let point = prop_oneof![
        20 => prop::array::uniform3(x),
        1 => (prop::array::uniform3(coordinate()), 0..3usize, wrong).prop_map(|(mut p, axis, wrong)| {
            p[axis] = wrong;
            p
        }),
    ];
    (
        prop::collection::vec(point, 40),
        prop::collection::vec(prop::array::uniform3((0u32..40).prop_map(VertexId)), 0..300),
    )
}

/// The least squared distance and the first triangle that has it, among those with finite corners, by brute
/// force.
fn by_look(points: &[Point], triangles: &[[VertexId; 3]], p: Point) -> Option<(f64, usize)> {
    let is_finite = |t: &&[VertexId; 3]| t.iter().all(|v| points[v.index()].iter().all(|x| x.is_finite()));
    let sound: Vec<[VertexId; 3]> = triangles.iter().filter(is_finite).copied().collect();
    let places: Vec<usize> = (0..triangles.len()).filter(|&t| is_finite(&&triangles[t])).collect();
    if sound.is_empty() {
        return None;
    }
    let (place, distance_squared) = by_brute_force(points, &sound, p);
    Some((distance_squared, places[place]))
}

proptest! {
    #[test]
    fn many_answers_are_what_a_look_at_every_triangle_finds_also_after_motions(
        (points, triangles) in rough_soup(),
        queries in prop::collection::vec(prop::array::uniform3(-2.0f64..2.0), 0..30),
        moves in prop::collection::vec((points(40), prop_oneof![Just(1e-3), Just(1.0), Just(100.0)]), 0..4),
        unit in prop::sample::select(vec![1.0, 1e-6, 1e9, 1e-30, 1e-170]),
        offset in prop::sample::select(vec![0.0, 1e6, -1e12]),
        guesses in prop::collection::vec(prop_oneof![0u32..300, Just(u32::MAX)], 30),
    ) {
        let placed = |points: &[Point]| -> Vec<Point> {
            points.iter().map(|p| p.map(|x| (x + offset) * unit)).collect()
        };
        let queries = placed(&queries);
        let mut now = placed(&points);
        let mut tree = NearestTriangle::new(&now, &triangles, &Threads::single());
        let threads = Threads::new(2).unwrap();
        let mut guesses: Vec<MaybeId<TriangleId>> =
            guesses[..queries.len()].iter().map(|t| TriangleId(*t).into()).collect();
        for step in 0..=moves.len() {
            let expected: Vec<_> = queries.iter().map(|p| by_look(&now, &triangles, *p)).collect();
            let one = |c: Option<motet::spatial::Closest>| c.map(|c| (c.distance_squared, c.triangle));
            let cold = tree.closest_all(&queries, None, &Threads::single());
            prop_assert_eq!(cold.iter().map(|c| one(*c)).collect::<Vec<_>>(), expected);
            prop_assert_eq!(&tree.closest_all(&queries, Some(&guesses), &threads), &cold);
            prop_assert_eq!(&queries.iter().map(|p| tree.closest(*p)).collect::<Vec<_>>(), &cold);
            guesses = cold.iter().map(|c| c.map(|c| TriangleId::new(c.triangle)).into()).collect();
            if let Some((by, how_far)) = moves.get(step) {
                let moved: Vec<Point> = points.iter().zip(by).map(|(p, d)| add(*p, scale(*d, *how_far))).collect();
                now = placed(&moved);
                tree.refit(&now, &Threads::single());
            }
        }
    }
}

#[test]
fn a_large_surface_is_searched_alike_on_any_number_of_threads() {
    let surface = Surface::of(&sphere_in_box(16, 4));
    let two = Threads::new(2).unwrap();
    let mut tree = NearestTriangle::new(&surface.points, &surface.triangles, &two);
    let queries: Vec<Point> =
        surface.points.iter().map(|p| p.map(|x| 0.9 * x + 0.05 * (7.0 * x).sin())).collect();
    let one = tree.closest_all(&queries, None, &Threads::single());
    assert_eq!(tree.closest_all(&queries, None, &two), one);
    for (p, found) in queries.iter().zip(&one).step_by(17) {
        let found = found.unwrap();
        let expected = by_brute_force(&surface.points, &surface.triangles, *p);
        assert_eq!((found.triangle, found.distance_squared), expected);
    }
    let moved: Vec<Point> = surface.points.iter().map(|p| [p[0] + 0.1 * p[1], p[1], 1.5 * p[2]]).collect();
    tree.refit(&moved, &two);
    let anew = NearestTriangle::new(&moved, &surface.triangles, &Threads::single());
    let guesses: Vec<_> = one.iter().map(|c| c.map(|c| TriangleId::new(c.triangle)).into()).collect();
    assert_eq!(tree.closest_all(&queries, Some(&guesses), &two), anew.closest_all(&queries, None, &two));
}

proptest! {
    #[test]
    fn the_nearest_pair_is_what_a_look_at_every_pair_finds(
        (a, b) in (points(30), points(30)),
        (s, t) in (prop::collection::vec(prop::array::uniform3((0u32..30).prop_map(VertexId)), 0..90), soup()),
        apart in prop_oneof![Just(0.0), Just(3.0), Just(1e5)],
        unit in prop::sample::select(vec![1.0, 1e-6, 1e9]),
        offset in prop::sample::select(vec![0.0, 1e6]),
    ) {
        let a: Vec<Point> = a.iter().map(|p| p.map(|x| (x + offset) * unit)).collect();
        let b: Vec<Point> = b.iter().map(|p| p.map(|x| (0.01 * x + offset + apart) * unit)).collect();
        let (one, two) = (NearestTriangle::new(&a, &s, &Threads::single()), NearestTriangle::new(&b, &t, &Threads::single()));
        // Distances of corners: any distance between places of the triangles will do.
        let squared = |i: u32, j: u32| {
            let (p, q) = (s[i as usize].map(|v| a[v.index()]), t[j as usize].map(|v| b[v.index()]));
            let all = p.iter().flat_map(|p| q.iter().map(move |q| dot(sub(*p, *q), sub(*p, *q))));
            all.fold(f64::INFINITY, f64::min)
        };
        let all = (0..s.len() as u32).flat_map(|i| (0..t.len() as u32).map(move |j| (squared(i, j), i, j)));
        let expected = all.min_by(|x, y| x.partial_cmp(y).unwrap());
        let threads = Threads::single();
        let found = one.closest_pair(&two, f64::INFINITY, &threads, |(): &mut (), i, j, _| Some(squared(i, j)));
        prop_assert_eq!(found, expected);
        if let Some((least, ..)) = expected {
            let near = |(): &mut (), i, j, bound| Some(squared(i, j)).filter(|d| *d <= bound);
            let again = one.closest_pair(&two, least, &threads, near);
            prop_assert_eq!(again, expected);
            prop_assert_eq!(one.closest_pair(&two, least * 0.99, &threads, near), expected.filter(|e| e.0 == 0.0));
        }
    }
}

proptest! {
    #[test]
    fn a_search_with_a_filter_finds_the_nearest_that_passes(
        (points, triangles) in rough_soup(),
        p in prop::array::uniform3(-2.0f64..2.0),
        one_in in 1u32..40, salt in 0u32..1000,
        within in prop_oneof![Just(f64::INFINITY), 0.0f64..1.0],
    ) {
        let passes = |t: u32| t.wrapping_mul(2654435761).wrapping_add(salt * 7919).is_multiple_of(one_in);
        let tree = NearestTriangle::new(&points, &triangles, &Threads::single());
        let alone = |t: &u32| NearestTriangle::new(&points, &[triangles[*t as usize]], &Threads::single()).closest_within(p, within);
        let all = (0..triangles.len() as u32).filter(|t| passes(*t)).filter_map(|t| {
            alone(&t).map(|found| motet::spatial::Closest { triangle: t as usize, ..found })
        });
        let expected = all.min_by(|x, y| x.distance_squared.total_cmp(&y.distance_squared));
        let mut tried = Vec::new();
        let mut best = (f64::INFINITY, usize::MAX);
        let found = tree.closest_where(p, within, |t, closest| {
            let this = (closest.distance_squared, closest.triangle);
            assert!(closest.triangle == t as usize && this < best && !tried.contains(&t));
            assert_eq!(Some(closest.point), alone(&t).map(|c| c.point));
            tried.push(t);
            best = if passes(t) { this } else { best };
            passes(t)
        });
        prop_assert_eq!(found, expected);
        prop_assert_eq!(tree.closest_where(p, within, |_, _| false), None);
        prop_assert_eq!(tree.closest_where(p, within, |_, _| true), tree.closest_within(p, within));
    }
}

#[test]
fn points_far_off_have_exact_answers_too() {
    let surface = Surface::of(&sphere_in_box(8, 2));
    let tree = NearestTriangle::new(&surface.points, &surface.triangles, &Threads::single());
    for power in 0..40 {
        let far = 3f64.powi(power);
        for direction in [[1.0, 0.3, -0.2], [-0.1, -0.7, 1.0]] {
            let p = scale(direction, far);
            let expected = by_brute_force(&surface.points, &surface.triangles, p);
            for found in [
                tree.closest(p),
                tree.closest_all(&[p; 2], Some(&[3, 5].map(|t| TriangleId(t).into())), &Threads::single())[1],
            ] {
                assert_eq!(found.map(|c| (c.triangle, c.distance_squared)), Some(expected), "{far}");
            }
        }
    }
}
