//! Crossing triangles, and what is inside: compared with all pairs, with solid angles, and on grids where
//! rays hit vertices and edges.

use crate::common::Numbers;
use crate::common::solid_angle::encloses;
use motet::base::{Point, Threads, VertexId};
use motet::contact::{inside, is_closed};
use motet::geometry::distance::{segment_triangle, triangle_triangle};
use motet::geometry::vector::{add, scale};
use motet::mesh::Surface;
use motet::mesh::shapes::{TubeOptions, ball, box_grid, tube};
use motet::preflight::{crossings, own_crossings};
use proptest::prelude::*;

type Triangles = Vec<[VertexId; 3]>;

/// Appends the boundary of a shape, facing outward, with each point moved, to the existing points.
fn append(mesh: &motet::Mesh, points: &mut Vec<Point>, place: impl Fn(Point) -> Point) -> Triangles {
    let surface = Surface::boundary_of(mesh);
    let start = points.len() as u32;
    points.extend(surface.points.iter().map(|&p| place(p)));
    surface.triangles.iter().map(|t| t.map(|v| VertexId(v.0 + start))).collect()
}

fn corners(points: &[Point], t: [VertexId; 3]) -> [Point; 3] {
    t.map(|v| points[v.index()])
}

/// A torus around z of radii 1 and `r`, `n` by `m` squares of two triangles.
fn torus(r: f64, n: usize, m: usize, points: &mut Vec<Point>) -> Triangles {
    let start = points.len();
    let angle = |i: usize, n: usize| std::f64::consts::TAU * i as f64 / n as f64;
    for i in 0..n {
        for j in 0..m {
            let ((s, c), (t, d)) = (angle(i, n).sin_cos(), angle(j, m).sin_cos());
            points.push([(1.0 + r * d) * c, (1.0 + r * d) * s, r * t]);
        }
    }
    let at = |i: usize, j: usize| VertexId::new(start + i % n * m + j % m);
    let square = |k: usize| {
        let (i, j) = (k / m, k % m);
        [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]]
    };
    (0..n * m).flat_map(square).collect()
}

/// `inside` for single points.
fn lone(points: &mut Vec<Point>, queries: &[Point], b: &[[VertexId; 3]]) -> Vec<bool> {
    let start = points.len();
    points.extend(queries);
    let vertices: Vec<_> = (start..points.len()).map(VertexId::new).collect();
    let found = inside(points, &vertices, &[], b, &[], &Threads::single());
    points.truncate(start);
    found
}

fn small_grid(n: usize) -> impl Strategy<Value = Vec<Point>> {
    prop::collection::vec(prop::array::uniform3((-2i8..=2).prop_map(f64::from)), n)
}

fn soup(n_points: u32, n: usize) -> impl Strategy<Value = Triangles> {
    prop::collection::vec(prop::array::uniform3((0..n_points).prop_map(VertexId)), 1..n)
}

/// Four times the grid points within both triangles, at quarters of the weights: a sample of what a pair has
/// in common.
fn common_places(a: [Point; 3], b: [Point; 3]) -> Vec<Point> {
    let places = |t: [Point; 3]| -> Vec<Point> {
        let weights = (0..=4).flat_map(|i| (0..=4 - i).map(move |j| [i, j, 4 - i - j].map(f64::from)));
        weights.map(|w| [0, 1, 2].map(|k| t[0][k] * w[0] + t[1][k] * w[1] + t[2][k] * w[2])).collect()
    };
    let times_4 = |t: [Point; 3]| t.map(|p| scale(p, 4.0));
    let of_b = times_4(b);
    places(a).into_iter().filter(|&p| segment_triangle::meet([p, p], of_b)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn crossings_are_all_pairs_that_meet(points in small_grid(12), a in soup(6, 8), b in soup(6, 8)) {
        // The surfaces share nothing: the second has its own points.
        let b: Triangles = b.iter().map(|t| t.map(|v| VertexId(v.0 + 6))).collect();
        let mut expected = Vec::new();
        for (i, &t) in a.iter().enumerate() {
            for (j, &u) in b.iter().enumerate() {
                if triangle_triangle::meet(corners(&points, t), corners(&points, u)) {
                    expected.push([i as u32, j as u32]);
                }
            }
        }
        prop_assert_eq!(&crossings(&points, &a, &b, &Threads::single()), &expected);
    }

    #[test]
    fn pairs_that_share_vertices_cross_where_they_have_more_in_common(points in small_grid(8), t in soup(8, 8)) {
        let found = own_crossings(&points, &t, &Threads::single());
        for i in 0..t.len() {
            for j in i + 1..t.len() {
                let is_found = found.contains(&[i as u32, j as u32]);
                let (a, b) = (corners(&points, t[i]), corners(&points, t[j]));
                let distinct = |t: [VertexId; 3]| t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
                let apart = |t: [Point; 3]| !motet::geometry::predicates::collinear(t[0], t[1], t[2]);
                let shared: Vec<Point> = t[i].iter().filter(|v| t[j].contains(v)).map(|v| points[v.index()]).collect();
                let is_shared = |p: &Point| match shared[..] {
                    [] => false,
                    [u] => *p == scale(u, 4.0),
                    [u, v] => {
                        let (u, v) = (scale(u, 4.0), scale(v, 4.0));
                        segment_triangle::meet([*p, *p], [u, v, v])
                    }
                    _ => true,
                };
                if !(distinct(t[i]) && distinct(t[j]) && apart(a) && apart(b)) {
                    continue;
                }
                if shared.len() == 3 {
                    prop_assert!(is_found);
                    continue;
                }
                let more = common_places(a, b).iter().chain(&common_places(b, a)).any(|p| !is_shared(p));
                prop_assert!(is_found || !more, "{a:?} {b:?}");
                prop_assert!(!is_found || triangle_triangle::meet(a, b));
                if is_found && shared.len() == 1 {
                    // Moved a little towards the shared vertex, each still has two other corners.
                    let far = |t: [Point; 3]| t.iter().filter(|p| **p != shared[0]).count();
                    prop_assert!(far(a) == 2 && far(b) == 2);
                }
            }
        }
    }

    /// Rays through vertices and along edges and faces of boxes with integer coordinates.
    #[test]
    fn boxes_on_a_grid_hold_what_their_sides_say(
        low in prop::array::uniform3(-2i8..=1), size in prop::array::uniform3(1u8..=3), n in prop::array::uniform3(1usize..=3),
        queries in small_grid(40), is_turned in any::<bool>(),
    ) {
        let low = low.map(f64::from);
        let high = [0, 1, 2].map(|k| low[k] + f64::from(size[k]));
        let mut points = Vec::new();
        let mut b = append(&box_grid(n, [low, high]), &mut points, |p| p);
        if is_turned {
            b.iter_mut().for_each(|t| t.swap(0, 1));
        }
        prop_assert!(is_closed(&b));
        let expected: Vec<bool> =
            queries.iter().map(|p| (0..3).all(|k| low[k] < p[k] && p[k] < high[k])).collect();
        prop_assert_eq!(lone(&mut points, &queries, &b), expected);
    }

    /// Closed soups of tets, which overlap, degenerate and coincide: winding numbers at grid points equal the
    /// sum over the tets that contain them.
    #[test]
    fn soups_of_tets_wind_as_their_tets_do(
        points in small_grid(8),
        tets in prop::collection::vec(prop::array::uniform4((0u32..8).prop_map(VertexId)), 1..8),
        queries in prop::collection::vec(prop::array::uniform3((-8i8..=8).prop_map(|x| f64::from(x) / 4.0)), 20),
    ) {
        let b: Triangles = tets.iter().flat_map(|&[a, b, c, d]| [[b, c, d], [a, d, c], [a, b, d], [a, c, b]]).collect();
        prop_assert!(is_closed(&b));
        let on = |q: Point| b.iter().any(|t| segment_triangle::meet([q, q], corners(&points, *t)));
        let sides = |q: Point| -> i64 {
            let holds = |t: &[VertexId; 4]| {
                let [a, b, c, d] = t.map(|v| points[v.index()]);
                let sign = motet::geometry::predicates::orient3d;
                let all = [sign(q, b, c, d), sign(a, q, c, d), sign(a, b, q, d), sign(a, b, c, q)];
                if all == [1; 4] { 1 } else if all == [-1; 4] { -1 } else { 0 }
            };
            tets.iter().map(holds).sum()
        };
        let expected: Vec<bool> = queries.iter().map(|&q| !on(q) && sides(q) != 0).collect();
        let mut points = points.clone();
        prop_assert_eq!(lone(&mut points, &queries, &b), expected);
    }
}

#[test]
fn random_points_are_inside_where_solid_angles_say_so() {
    let mut numbers = Numbers(5);
    let mut points = Vec::new();
    let outer = append(&ball(4, 2), &mut points, |p| p);
    let mut inner = append(&ball(3, 2), &mut points, |p| scale(p, 0.5));
    inner.iter_mut().for_each(|t| t.swap(1, 2));
    // A shell; a torus beside and through it; a tube through everything.
    let mut all = [outer, inner].concat();
    all.extend(torus(0.3, 40, 20, &mut points));
    all.extend(append(&tube(&TubeOptions::default()), &mut points, |p| add(scale(p, 0.3), [0.2, 0.1, -2.0])));
    assert!(is_closed(&all) && !is_closed(&all[1..]));
    let queries: Vec<Point> = (0..3000)
        .map(|_| [(); 3].map(|()| 3.0 * numbers.unit() - 1.5))
        .chain([[f64::NAN; 3], [1e300; 3]])
        .collect();
    let found = lone(&mut points, &queries, &all);
    let mut n = [0; 2];
    for (q, found) in queries.iter().zip(found) {
        let expected = encloses(&points, &all, *q);
        assert_eq!(found, expected, "{q:?}");
        n[usize::from(found)] += 1;
    }
    assert!(n.iter().all(|&n| n > 300), "{n:?}");
}

#[test]
fn crossing_surfaces_say_the_same_with_and_without_their_parts() {
    for (shift, unit) in [([0.3, 0.2, 0.1], 1.0), ([0.0, 0.0, 0.0], 1e-3), ([0.5, 0.0, 0.0], 1e3)] {
        let mut points = Vec::new();
        let b = torus(0.3, 60, 30, &mut points);
        let mut a = append(&ball(8, 3), &mut points, |p| add(scale(p, 0.9), shift));
        a.extend(torus(0.2, 30, 15, &mut points));
        points.iter_mut().for_each(|p| *p = scale(*p, unit));
        let crossed = crossings(&points, &a, &b, &Threads::single());
        assert!(!crossed.is_empty());
        let vertices: Vec<_> = (0..points.len()).map(VertexId::new).collect();
        let of_parts = inside(&points, &vertices, &a, &b, &crossed, &Threads::single());
        let by_itself = inside(&points, &vertices, &[], &b, &[], &Threads::single());
        assert_eq!(of_parts, by_itself);
        assert!(of_parts.contains(&true) && of_parts[1800..].contains(&false));
        assert!(!of_parts[..1800].contains(&true), "vertices of b are on it");
        for v in (1800..points.len()).step_by(7) {
            assert_eq!(of_parts[v], encloses(&points, &b, points[v]));
        }
        let threads = Threads::new(3).unwrap();
        assert_eq!(crossings(&points, &a, &b, &threads), crossed);
        assert_eq!(inside(&points, &vertices, &a, &b, &crossed, &threads), of_parts);
    }
}

/// A tet attached to a vertex of a box, half inside: its other vertices are on both sides of the shared
/// vertex.
#[test]
fn surfaces_that_share_vertices_are_distinguished_there() {
    let mut points = Vec::new();
    let b = append(&box_grid([1; 3], [[0.0; 3], [1.0; 3]]), &mut points, |p| p);
    let corner = VertexId::new(points.iter().position(|&p| p == [1.0; 3]).unwrap());
    let n = points.len() as u32;
    points.extend([
        [0.5, 0.6, 0.7],
        [0.6, 0.5, 0.7],
        [0.6, 0.7, 0.5],
        [1.5, 1.6, 1.7],
        [1.6, 1.5, 1.7],
        [1.6, 1.7, 1.5],
    ]);
    let tet = |k: u32| {
        let [p, q, r] = [n + k, n + k + 1, n + k + 2].map(VertexId);
        [[corner, p, q], [corner, q, r], [corner, r, p], [p, r, q]]
    };
    let a = [tet(0), tet(3)].concat();
    let crossed = crossings(&points, &a, &b, &Threads::single());
    assert!(crossed.is_empty());
    let vertices: Vec<_> = (0..6).map(|k| VertexId(n + k)).chain([corner]).collect();
    let found = inside(&points, &vertices, &a, &b, &crossed, &Threads::single());
    assert_eq!(found, [true, true, true, false, false, false, false]);
}

#[test]
fn nothing_is_closed_and_holds_nothing() {
    assert!(is_closed(&[]));
    let points = [[0.0; 3]];
    assert_eq!(inside(&points, &[VertexId(0)], &[], &[], &[[3, 4]], &Threads::single()), [false]);
    assert!(crossings(&points, &[], &[], &Threads::single()).is_empty());
    let bad = [[f64::NAN; 3], [0.0; 3], [1.0; 3]];
    let t = [[0, 1, 2].map(VertexId)];
    assert!(own_crossings(&bad, &[t[0], t[0]], &Threads::single()).is_empty());
}

#[test]
fn a_ray_for_each_vertex_says_the_same() {
    let mut points = Vec::new();
    let b = torus(0.3, 64, 32, &mut points);
    let start = points.len();
    let a = torus(0.3, 65, 31, &mut points);
    points[start..].iter_mut().for_each(|p| *p = add(*p, [0.1, 0.0, 0.0]));
    let vertices: Vec<_> = (start..points.len()).map(VertexId::new).collect();
    for n in [1, 2] {
        let threads = Threads::new(n).unwrap();
        let crossed = crossings(&points, &a, &b, &threads);
        assert!(!crossed.is_empty());
        let found = inside(&points, &vertices, &a, &b, &crossed, &threads);
        let by_itself = inside(&points, &vertices, &[], &b, &[], &threads);
        assert_eq!(found, by_itself);
        assert!(found.contains(&true) && found.contains(&false));
    }
}
