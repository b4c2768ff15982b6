//! Gaps by Delaunay tets: classes by hand, bounds and exactness compared with brute force, degenerate bodies.

use crate::common::Numbers;
use motet::base::{BodyId, Point, Threads, VertexId};
use motet::contact::{Between, BetweenOptions, GapKind, Side, paper};
use motet::geometry::distance::segment_segment;
use motet::geometry::vector::{add, distance, scale};
use motet::spatial::NearestTriangle;

type Triangles = Vec<[VertexId; 3]>;

fn ids(triangles: &[[u32; 3]]) -> Triangles {
    triangles.iter().map(|t| t.map(VertexId)).collect()
}

fn between(points: &[Point], bodies: &[Triangles]) -> Between {
    Between::new(points, bodies, &BetweenOptions::default(), &Threads::single()).unwrap()
}

fn sided(points: &[Point], bodies: &[Triangles], sides: &[Side]) -> Between {
    let options = BetweenOptions { sides: sides.to_vec(), ..BetweenOptions::default() };
    Between::new(points, bodies, &options, &Threads::single()).unwrap()
}

fn kinds(found: &Between) -> Vec<GapKind> {
    found.tets.iter().map(|tet| tet.kind).collect()
}

/// An octahedron whose faces are split `n` times, projected onto a sphere.
fn sphere(n: usize, centre: Point, radius: f64) -> (Vec<Point>, Triangles) {
    let mut points: Vec<Point> = Vec::new();
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let mut p = [0.0; 3];
            p[axis] = sign;
            points.push(p);
        }
    }
    let mut triangles: Vec<[usize; 3]> = Vec::new();
    for (x, y, z) in (0..8).map(|i| (i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2))) {
        let even = (x + y + z) % 2 == 0;
        triangles.push(if even { [x, y, z] } else { [x, z, y] });
    }
    for _ in 0..n {
        let mut middles = std::collections::BTreeMap::new();
        let mut split = Vec::new();
        for [a, b, c] in triangles {
            let mut middle = |i: usize, j: usize| {
                *middles.entry((i.min(j), i.max(j))).or_insert_with(|| {
                    let m = add(points[i], points[j]);
                    points.push(scale(m, 1.0 / distance(m, [0.0; 3])));
                    points.len() - 1
                })
            };
            let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
            split.extend([[a, d, f], [d, b, e], [f, e, c], [d, e, f]]);
        }
        triangles = split;
    }
    let placed = points.iter().map(|p| add(centre, scale(*p, radius))).collect();
    (placed, triangles.iter().map(|t| t.map(VertexId::new)).collect())
}

/// Shapes over one list of points.
fn joined(shapes: &[(Vec<Point>, Triangles)]) -> (Vec<Point>, Vec<Triangles>) {
    let mut points = Vec::new();
    let mut bodies = Vec::new();
    for (own, triangles) in shapes {
        let n = points.len();
        bodies.push(triangles.iter().map(|t| t.map(|v| VertexId::new(v.index() + n))).collect());
        points.extend_from_slice(own);
    }
    (points, bodies)
}

/// The distance of every vertex from the nearest triangle of another body.
fn exact(points: &[Point], bodies: &[Triangles]) -> Vec<f64> {
    let mut gap = vec![f64::INFINITY; points.len()];
    for (a, own) in bodies.iter().enumerate() {
        for (_, other) in bodies.iter().enumerate().filter(|(b, _)| *b != a) {
            let tree = NearestTriangle::new(points, other, &Threads::single());
            for v in own.as_flattened() {
                let found = tree.closest(points[v.index()]).unwrap().distance_squared.sqrt();
                gap[v.index()] = gap[v.index()].min(found);
            }
        }
    }
    gap
}

fn nearest_vertices(points: &[Point], bodies: &[Triangles]) -> f64 {
    let mut least = f64::INFINITY;
    for (a, own) in bodies.iter().enumerate() {
        for other in &bodies[..a] {
            for v in own.as_flattened() {
                for w in other.as_flattened() {
                    least = least.min(distance(points[v.index()], points[w.index()]));
                }
            }
        }
    }
    least
}

/// A soup of triangles, with shared and repeated places.
fn soup(seed: u64, unit: f64) -> (Vec<Point>, Vec<Triangles>) {
    let mut numbers = Numbers(seed);
    let n = 12 + numbers.below(40);
    let on_grid = numbers.below(3) == 0;
    let coordinate = |numbers: &mut Numbers| {
        if on_grid { numbers.below(4) as f64 / 3.0 } else { numbers.unit() }
    };
    let points: Vec<Point> = (0..n).map(|_| [(); 3].map(|()| unit * coordinate(&mut numbers))).collect();
    let n_bodies = 2 + numbers.below(3);
    let bodies = (0..n_bodies)
        .map(|_| {
            (0..1 + numbers.below(12)).map(|_| [(); 3].map(|()| VertexId::new(numbers.below(n)))).collect()
        })
        .collect();
    (points, bodies)
}

#[test]
fn one_tet_is_what_its_vertices_say() {
    let points = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, -0.5, 1.0], [0.5, 0.5, 1.0]];
    let two_two = between(&points, &[ids(&[[0, 1, 1]]), ids(&[[3, 2, 2]])]);
    assert_eq!(kinds(&two_two), [GapKind::TwoTwo]);
    assert_eq!(two_two.tets[0].vertices[..2].iter().max(), Some(&VertexId(1).into()));
    assert_eq!((two_two.tets[0].bodies, two_two.tets[0].distance), ([0, 1].map(BodyId), 1.0));
    // The edges are 1 apart, their vertices farther from the other edge.
    assert!(two_two.gap.iter().all(|gap| *gap == 1.25f64.sqrt()));
    assert_eq!(two_two.nearest_vertices.unwrap().distance, 1.5f64.sqrt());

    let three_one = between(&points, &[ids(&[[0, 1, 2]]), ids(&[[3, 3, 3]])]);
    assert_eq!(kinds(&three_one), [GapKind::ThreeOne]);
    assert_eq!(three_one.tets[0].vertices[3], VertexId(3).into());
    let exact = exact(&points, &[ids(&[[0, 1, 2]]), ids(&[[3, 3, 3]])]);
    assert!((three_one.gap[3] - exact[3]).abs() < 1e-15);
    assert_eq!(three_one.gap[2], 1.0);

    let many = |bodies: &[Triangles]| kinds(&between(&points, bodies));
    assert_eq!(many(&[ids(&[[0, 1, 1]]), ids(&[[2; 3]]), ids(&[[3; 3]])]), [GapKind::TwoOneOne]);
    assert_eq!(many(&[ids(&[[0; 3]]), ids(&[[1; 3]]), ids(&[[2; 3]]), ids(&[[3; 3]])]), [GapKind::Ones]);
    assert_eq!(many(&[ids(&[[0, 1, 2]]), ids(&[[2, 3, 3]])]), [GapKind::Touching]);
    let alone = between(&points, &[ids(&[[0, 1, 2], [0, 1, 3]])]);
    assert_eq!((alone.tets.len(), alone.n_of_one_body, alone.least), (0, 1, None));
    assert!(alone.gap.iter().all(|gap| *gap == f64::INFINITY));
}

#[test]
fn chords_and_facets_that_are_no_triangles_do_not_count() {
    // An apex over the middle of an edge that is not part of the surface.
    let points = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, 0.1, 0.5]];
    let with = between(&points, &[ids(&[[0, 1, 2]]), ids(&[[3; 3]])]);
    assert_eq!(with.gap[3], 0.5);
    let chord = between(&points, &[ids(&[[0, 2, 2], [1, 2, 2]]), ids(&[[3; 3]])]);
    let to_edges = segment_segment::closest([points[3]; 2], [points[0], points[2]]).distance();
    assert!((chord.gap[3] - to_edges).abs() < 1e-15 && chord.gap[3] > 0.5);
    // The paper's method takes it for a facet nevertheless.
    assert_eq!(paper::within(&chord.tets[0], &points), Some(0.5));
}

#[test]
fn the_papers_rule_for_two_edges_overestimates_and_never_under() {
    let mut numbers = Numbers(7);
    let mut larger = 0;
    for _ in 0..2000 {
        let mut point = || [(); 3].map(|()| numbers.unit());
        let (a, b) = ([point(), point()], [point(), point()]);
        let (rule, exact) = (paper::two_two(a, b), segment_segment::closest(a, b).distance());
        assert!(rule >= exact * (1.0 - 1e-9), "{rule} {exact}");
        larger += usize::from(rule > exact * (1.0 + 1e-9));
    }
    assert!(larger > 500, "{larger}");
}

#[test]
fn no_gap_is_smaller_than_the_distance_and_the_nearest_vertices_are() {
    for seed in 0..400 {
        let unit = [1.0, 1e-3][seed as usize % 2];
        let (points, bodies) = soup(seed, unit);
        let found = between(&points, &bodies);
        let exact = exact(&points, &bodies);
        for (v, (gap, exact)) in found.gap.iter().zip(&exact).enumerate() {
            assert!(*gap >= exact - 1e-14 * unit, "seed {seed}, vertex {v}: {gap} {exact}");
            assert_eq!(*gap < f64::INFINITY, found.closest[v].is_some());
        }
        let options = BetweenOptions { stars: true, ..BetweenOptions::default() };
        let stars = Between::new(&points, &bodies, &options, &Threads::single()).unwrap();
        for (v, (gap, exact)) in stars.gap.iter().zip(&exact).enumerate() {
            assert!(*gap >= exact - 1e-14 * unit && *gap <= found.gap[v], "seed {seed}, vertex {v}");
        }
        assert!(stars.least.unwrap().distance <= found.least.unwrap().distance);
        let pair = found.nearest_vertices.unwrap();
        assert_eq!(pair.distance, nearest_vertices(&points, &bodies), "seed {seed}");
        let [v, w] = pair.vertices;
        assert_eq!(pair.distance, distance(points[v.index()], points[w.index()]));
        let least = found.least.unwrap();
        assert!(least.distance <= pair.distance, "seed {seed}: {least:?} {pair:?}");
        assert!((distance(least.points[0], least.points[1]) - least.distance).abs() < 1e-14 * unit);
    }
}

#[test]
fn spheres_are_as_far_apart_as_their_nearest_vertices() {
    for unit in [1.0, 1e-3] {
        let (points, bodies) = joined(&[sphere(2, [0.0; 3], unit), sphere(2, [2.1 * unit, 0.0, 0.0], unit)]);
        let found = between(&points, &bodies);
        assert!((found.least.unwrap().distance - 0.1 * unit).abs() < 1e-14 * unit);
        assert_eq!(found.least.unwrap().bodies, [0, 1].map(BodyId));
        let exact = exact(&points, &bodies);
        assert!(found.gap.iter().zip(&exact).all(|(gap, exact)| *gap >= exact * (1.0 - 1e-14)));
        let facing = |v: &usize| (found.gap[*v] - exact[*v]).abs() <= 1e-14 * unit;
        assert!((0..points.len()).filter(facing).count() > 4);
    }
}

#[test]
fn sides_keep_gaps_on_the_side_of_the_fluid() {
    // A small sphere within a large one: the gap is outside the small and inside the large one.
    let shapes = [sphere(2, [0.0; 3], 0.8), sphere(2, [0.0; 3], 1.0)];
    let (points, bodies) = joined(&shapes);
    let both = between(&points, &bodies);
    let right = sided(&points, &bodies, &[Side::Outside, Side::Inside]);
    assert_eq!(both.gap, right.gap);
    for wrong in [[Side::Inside, Side::Inside], [Side::Outside, Side::Outside]] {
        let found = sided(&points, &bodies, &wrong);
        assert!(found.gap.iter().all(|gap| *gap == f64::INFINITY), "{wrong:?}");
        assert_eq!(found.least, None);
    }
    // Turned inside out, the sides change.
    let turned: Vec<Triangles> =
        bodies.iter().map(|b| b.iter().map(|&[x, y, z]| [x, z, y]).collect()).collect();
    assert_eq!(sided(&points, &turned, &[Side::Inside, Side::Outside]).gap, both.gap);
}

#[test]
fn nothing_is_measured_through_a_wall() {
    // A plate with a vertex below and one above the same place; a point above it sees only its upper face.
    let mut points: Vec<Point> = Vec::new();
    for z in [0.0, -0.1] {
        points.extend([[-1.0, -1.0, z], [1.0, -1.0, z], [1.0, 1.0, z], [-1.0, 1.0, z], [0.0, 0.0, z]]);
    }
    let top = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
    let mut plate: Vec<[u32; 3]> = top.to_vec();
    plate.extend(top.map(|[a, b, c]| [a + 5, c + 5, b + 5]));
    for (a, b) in [(0, 1), (1, 2), (2, 3), (3, 0)] {
        plate.extend([[a, a + 5, b + 5], [a, b + 5, b]]);
    }
    points.extend([[0.1, 0.2, 0.5], [0.2, 0.1, -0.5]]);
    let bodies = [ids(&plate), ids(&[[10; 3]]), ids(&[[11; 3]])];
    let found = sided(&points, &bodies, &[Side::Outside]);
    // Each point is measured to the face that is visible from it, and each face to the point before it.
    assert!((0.5..0.6).contains(&found.gap[10]) && (0.4..0.5).contains(&found.gap[11]));
    let closest = |v: usize| found.closest[v].get().unwrap().0;
    assert!(closest(10) < 5 && (5..10).contains(&closest(11)));
    assert_eq!((closest(4), closest(9)), (10, 11));
}

#[test]
fn bodies_that_share_a_place_touch() {
    let (mut points, mut bodies) = joined(&[sphere(1, [0.0; 3], 1.0), sphere(1, [2.0, 0.0, 0.0], 1.0)]);
    // Vertex 0 of the first and vertex 1 of the second are the same place.
    let found = between(&points, &bodies);
    let second = points.len() / 2 + 1;
    assert_eq!((found.gap[0], found.gap[second]), (0.0, 0.0));
    assert_eq!([0, second].map(|v| found.closest[v].get().unwrap().index()), [second, 0]);
    assert_eq!(found.least.unwrap().distance, 0.0);
    assert!(kinds(&found).contains(&GapKind::Touching));
    // The same bodies sharing one vertex.
    bodies[1].as_flattened_mut().iter_mut().filter(|v| v.index() == second).for_each(|v| *v = VertexId(0));
    let shared = between(&points, &bodies);
    assert_eq!(
        (shared.gap[0], shared.closest[0], shared.gap[second]),
        (0.0, VertexId(0).into(), f64::INFINITY)
    );
    // The same bodies, each triangle with its own points: the result is as if they were one.
    let (soup, own): (Vec<Point>, Vec<Triangles>) = {
        let mut soup = Vec::new();
        let own = bodies.iter().map(|body| {
            body.iter()
                .map(|t| {
                    t.map(|v| {
                        soup.push(points[v.index()]);
                        VertexId::new(soup.len() - 1)
                    })
                })
                .collect()
        });
        let own = own.collect();
        (soup, own)
    };
    let loose = between(&soup, &own);
    for (v, w) in own.iter().flatten().flatten().zip(bodies.iter().flatten().flatten()) {
        let (one, other) = (loose.gap[v.index()], shared.gap[w.index()]);
        assert!(one == other || (one - other).abs() < 1e-15, "{v} {w}: {one} {other}");
    }
    points[0][0] += f64::NAN;
    assert!(Between::new(&points, &bodies, &BetweenOptions::default(), &Threads::single()).is_err());
}

#[test]
fn points_in_a_plane_on_a_line_and_in_one_place_have_gaps_too() {
    let plane = [
        [0.0, 0.0, 1.0],
        [1.0, 0.0, 1.0],
        [0.0, 1.0, 1.0],
        [1.0, 1.0, 1.0],
        [3.0, 0.0, 1.0],
        [3.0, 2.0, 1.0],
    ];
    let bodies = [ids(&[[0, 1, 2], [1, 3, 2]]), ids(&[[4, 5, 5]])];
    let found = between(&plane, &bodies);
    assert!(!found.tets.is_empty() && kinds(&found).iter().all(|kind| *kind == GapKind::Flat));
    assert!(found.tets.iter().all(|tet| tet.vertices[3].is_none()));
    assert_eq!((found.least.unwrap().distance, found.gap[1], found.gap[4]), (2.0, 2.0, 2.0));
    assert_eq!(found.nearest_vertices.unwrap().distance, 2.0);

    let line: Vec<Point> = (0..4).map(|i| [f64::from(i * i), 0.0, 0.0]).collect();
    let found = between(&line, &[ids(&[[0, 1, 1]]), ids(&[[2, 3, 3]])]);
    assert_eq!((found.tets.len(), found.least.unwrap().distance), (1, 3.0));
    assert_eq!(found.gap, [f64::INFINITY, 3.0, 3.0, f64::INFINITY]);

    let one = vec![[2.0, 3.0, 4.0]; 3];
    let found = between(&one, &[ids(&[[0; 3]]), ids(&[[1, 2, 1]])]);
    assert_eq!((found.gap.clone(), found.tets.len()), (vec![0.0; 3], 0));
    assert_eq!(found.least.unwrap().distance, 0.0);
    assert_eq!(found.nearest_vertices.unwrap().vertices, [VertexId(0), VertexId(1)]);
}

#[test]
fn updates_are_bounds_and_the_same_where_nothing_moved() {
    let (points, bodies) = joined(&[
        sphere(2, [0.0; 3], 1.0),
        sphere(2, [2.3, 0.4, 0.0], 1.0),
        sphere(1, [1.0, -2.0, 0.3], 0.9),
    ]);
    let fresh = between(&points, &bodies);
    let mut kept = fresh.clone();
    kept.update(&points, &Threads::single()).unwrap();
    assert_eq!((&kept.gap, &kept.closest, &kept.tets), (&fresh.gap, &fresh.closest, &fresh.tets));
    let n = points.len();
    for step in 1..6 {
        let by = 0.05 * f64::from(step);
        let moved: Vec<Point> = points
            .iter()
            .enumerate()
            .map(|(v, p)| if v < n / 2 { add(*p, [by, -by, 0.0]) } else { *p })
            .collect();
        kept.update(&moved, &Threads::single()).unwrap();
        let exact = exact(&moved, &bodies);
        assert!(kept.gap.iter().zip(&exact).all(|(gap, exact)| *gap >= exact - 1e-14));
        assert!(kept.least.unwrap().distance >= between(&moved, &bodies).least.unwrap().distance * 0.5);
    }
    assert!(kept.update(&points[1..], &Threads::single()).is_err());
    let mut nan = points.clone();
    nan[3][1] = f64::NAN;
    let error = kept.update(&nan, &Threads::single()).unwrap_err();
    assert!(error.to_string().contains("point 3"), "{error}");
}

#[test]
fn threads_change_nothing() {
    let (points, bodies) = joined(&[sphere(4, [0.0; 3], 1.0), sphere(4, [2.05, 0.1, 0.2], 1.0)]);
    let options = BetweenOptions { sides: vec![Side::Outside; 2], stars: true };
    let one = Between::new(&points, &bodies, &options, &Threads::single()).unwrap();
    let three = Between::new(&points, &bodies, &options, &Threads::new(3).unwrap()).unwrap();
    assert_eq!((&one.tets, &one.gap, &one.closest), (&three.tets, &three.gap, &three.closest));
    assert_eq!((one.least, one.nearest_vertices), (three.least, three.nearest_vertices));
}

#[test]
fn what_cannot_be_measured_is_refused_with_the_place() {
    let points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, f64::INFINITY, 0.0]];
    let refused = |bodies: &[Triangles]| {
        let options = BetweenOptions::default();
        let error = Between::new(&points, bodies, &options, &Threads::single()).unwrap_err();
        assert!(error.remedy_text().is_some());
        error.to_string()
    };
    assert!(refused(&[]).contains("no body to measure"));
    assert!(refused(&[ids(&[[0, 1, 1]]), vec![]]).contains("body 1 has no triangles"));
    assert!(refused(&[ids(&[[0, 1, 1], [0, 1, 3]])]).contains("body 0, triangle 1: names point 3"));
    assert!(refused(&[ids(&[[0, 1, 2]])]).contains("body 0, point 2"));
    // A point that no body uses may have any coordinates.
    assert!(
        Between::new(
            &points,
            &[ids(&[[0; 3]]), ids(&[[1; 3]])],
            &BetweenOptions::default(),
            &Threads::single()
        )
        .is_ok()
    );
}
