//! Point location and weights: every point of the hull finds its tet, every other one its nearest facet.

use motet::base::{Point, TetId, Threads};
use motet::delaunay::Triangulation;
use motet::geometry::predicates::orient3d;
use motet::geometry::{triangle, weights};
use motet::spatial::Located;
use proptest::prelude::*;

fn holds(tet: [Point; 4], q: Point) -> bool {
    (0..4).all(|i| {
        let mut sub = tet;
        sub[i] = q;
        orient3d(sub[0], sub[1], sub[2], sub[3]) >= 0
    })
}

fn distance_squared(p: Point, q: Point) -> f64 {
    (0..3).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum()
}

fn corners(t: &Triangulation, tet: TetId) -> [Point; 4] {
    t.tets()[tet.index()].map(|v| t.points()[v.index()])
}

fn facet_distance_squared(t: &Triangulation, facet: [motet::base::VertexId; 3], q: Point) -> f64 {
    let corners = facet.map(|v| t.points()[v.index()]);
    distance_squared(triangle::at(corners, triangle::closest(corners, q)), q)
}

/// Asserts that `located` is right, by checking all tets and all facets of the hull.
fn assert_located(t: &Triangulation, q: Point, located: Located) {
    match located {
        Located::Inside(tet) => assert!(holds(corners(t, tet), q), "{q:?} in tet {tet}"),
        Located::Outside { tet, facet } => {
            assert!((0..t.tets().len()).all(|i| !holds(corners(t, TetId::new(i)), q)), "{q:?} is in no tet");
            let ours =
                t.hull().iter().find(|f| f.tet == tet && f.facet == facet).expect("a facet of the hull");
            let least = t
                .hull()
                .iter()
                .map(|f| facet_distance_squared(t, f.vertices, q))
                .fold(f64::INFINITY, f64::min);
            // Facets that meet at the nearest place are equally near; their distances round differently.
            assert!(facet_distance_squared(t, ours.vertices, q) <= least * (1.0 + 1e-12), "{q:?}");
        }
    }
}

fn points(n: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Point>> {
    let anywhere = prop::collection::vec(prop::array::uniform3(-2.0..2.0f64), n.clone());
    let grid = prop::collection::vec(prop::array::uniform3(-2i8..=2), n)
        .prop_map(|p| p.into_iter().map(|p| p.map(|v| f64::from(v) * 0.1)).collect());
    prop_oneof![anywhere, grid]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn every_point_is_located_or_reported_outside(points in points(4..60), queries in points(1..20)) {
        let Ok(t) = Triangulation::new(&points, &Threads::single()) else { return Ok(()) };
        let last = TetId::new(t.tets().len() - 1);
        for &q in queries.iter().chain(&points) {
            assert_located(&t, q, t.locate(q, TetId(0)));
            assert_located(&t, q, t.locate(q, last));
        }
        let all = t.locator().locate_all(&queries, &Threads::single());
        for (&q, &located) in queries.iter().zip(&all) {
            assert_located(&t, q, located);
        }
    }

    #[test]
    fn vertices_edges_and_facets_of_the_hull_are_inside(points in points(4..40)) {
        let Ok(t) = Triangulation::new(&points, &Threads::single()) else { return Ok(()) };
        for facet in t.hull() {
            for v in facet.vertices {
                prop_assert!(t.locate(points[v.index()], TetId(0)).is_inside());
            }
        }
    }

    #[test]
    fn weights_reproduce_the_point_in_any_sliver(
        base in prop::array::uniform4(prop::array::uniform3(-1.0..1.0f64)),
        (thickness, offset) in (-18..1i32, prop_oneof![Just(0.0), Just(100.0)]),
        mix in prop::array::uniform4(0.0..1.0f64),
    ) {
        // The fourth vertex arbitrarily near the plane of the others.
        let mut tet = base;
        let [a, b, c, d] = base;
        let part = 10f64.powi(thickness);
        tet[3] = std::array::from_fn(|i| (a[i] + b[i] + c[i]) / 3.0 + part * d[i]);
        tet = tet.map(|p| p.map(|x| x + offset));
        if orient3d(tet[0], tet[1], tet[2], tet[3]) < 0 {
            tet.swap(0, 1);
        }
        let sum: f64 = mix.iter().sum();
        let q: Point = std::array::from_fn(|i| (0..4).map(|k| mix[k] / sum * tet[k][i]).sum());
        prop_assume!(holds(tet, q));
        let Some(w) = weights(tet, q) else {
            prop_assert_eq!(orient3d(tet[0], tet[1], tet[2], tet[3]), 0);
            return Ok(());
        };
        prop_assert!(w.iter().all(|w| (0.0..=1.0).contains(w)), "{w:?}");
        prop_assert!((w.iter().sum::<f64>() - 1.0).abs() <= 4.0 * f64::EPSILON);
        let back: Point = std::array::from_fn(|i| (0..4).map(|k| w[k] * tet[k][i]).sum());
        let size = 2.0 + offset;
        prop_assert!(distance_squared(back, q).sqrt() <= 1e-14 * size, "{w:?} {back:?} {q:?}");
    }
}

#[test]
fn threads_find_what_one_thread_finds() {
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut cloud = |n: usize| (0..n).map(|_| [next(), next(), next()]).collect::<Vec<Point>>();
    let (points, queries) = (cloud(2000), cloud(20_000));
    let t = Triangulation::new(&points, &Threads::single()).expect("a volume");
    let two = Threads::new(2).expect("two threads");
    let one = t.locator().locate_all(&queries, &Threads::single());
    assert_eq!(one, t.locator().locate_all(&queries, &two));
    for (&q, &located) in queries.iter().zip(&one).step_by(97) {
        assert_located(&t, q, located);
    }
}
