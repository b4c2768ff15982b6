//! The volume that two tets share: compared with exact geometry and with itself, and summed over the parts of
//! a whole.

use motet::base::{Point, Threads};
use motet::delaunay::Triangulation;
use motet::geometry::overlap::{Solid, overlap};
use motet::geometry::tet;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use proptest::prelude::*;

const UNIT: [Point; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

type Exact = [BigRational; 3];

fn exact(p: Point) -> Exact {
    p.map(|x| BigRational::from_float(x).expect("finite"))
}

fn det(a: &Exact, b: &Exact, c: &Exact) -> BigRational {
    &a[0] * (&b[1] * &c[2] - &b[2] * &c[1])
        + &a[1] * (&b[2] * &c[0] - &b[0] * &c[2])
        + &a[2] * (&b[0] * &c[1] - &b[1] * &c[0])
}

fn minus(a: &Exact, b: &Exact) -> Exact {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

/// Positive where `p` lies behind the facet, that is, inside.
fn inside(facet: &[Exact; 3], p: &Exact) -> BigRational {
    -det(&minus(&facet[1], &facet[0]), &minus(&facet[2], &facet[0]), &minus(p, &facet[0]))
}

/// The facets of a tet, turned outward.
fn facets(corners: [Point; 4]) -> [[Exact; 3]; 4] {
    let corners = corners.map(exact);
    [0, 1, 2, 3].map(|i| {
        let [a, b, c] = tet::FACETS[i].map(|k| corners[k].clone());
        let facet = [a, b, c];
        if inside(&facet, &corners[i]).is_negative() {
            let [a, b, c] = facet;
            [a, c, b]
        } else {
            facet
        }
    })
}

/// The part of a polygon behind a facet (Sutherland and Hodgman 1974).
fn clipped(polygon: &[Exact], facet: &[Exact; 3]) -> Vec<Exact> {
    let mut kept = Vec::new();
    for (i, p) in polygon.iter().enumerate() {
        let q = &polygon[(i + 1) % polygon.len()];
        let (vp, vq) = (inside(facet, p), inside(facet, q));
        if !vp.is_negative() {
            kept.push(p.clone());
        }
        if (&vp * &vq).is_negative() {
            let t = &vp / (&vp - &vq);
            kept.push([0, 1, 2].map(|k| &p[k] + &t * (&q[k] - &p[k])));
        }
    }
    kept
}

/// Whether two facets lie in one plane and have the same orientation.
fn agree(f: &[Exact; 3], g: &[Exact; 3]) -> bool {
    let normal = |f: &[Exact; 3]| {
        let (u, v) = (minus(&f[1], &f[0]), minus(&f[2], &f[0]));
        [0, 1, 2].map(|k| &u[(k + 1) % 3] * &v[(k + 2) % 3] - &u[(k + 2) % 3] * &v[(k + 1) % 3])
    };
    let (n, m) = (normal(f), normal(g));
    let dot = &n[0] * &m[0] + &n[1] * &m[1] + &n[2] * &m[2];
    g.iter().all(|p| inside(f, p).is_zero()) && dot.is_positive()
}

/// The shared volume by another method: its surface consists of the parts of each tet's facets inside the
/// other; the divergence theorem gives its volume, without rounding.
fn overlap_by_surface(a: [Point; 4], b: [Point; 4]) -> f64 {
    let (a, b) = (facets(a), facets(b));
    let mut volume_6 = BigRational::zero();
    for (facets, others, first) in [(&a, &b, true), (&b, &a, false)] {
        for facet in facets {
            // A facet that both have counts once.
            if !first && others.iter().any(|other| agree(other, facet)) {
                continue;
            }
            let polygon = others.iter().fold(facet.to_vec(), |polygon, other| clipped(&polygon, other));
            for i in 2..polygon.len() {
                volume_6 += det(&polygon[0], &polygon[i - 1], &polygon[i]);
            }
        }
    }
    (volume_6 / BigRational::from_integer(6.into())).to_f64().expect("a number")
}

fn volume(corners: [Point; 4]) -> f64 {
    Solid::new(corners).volume()
}

fn mirrored([a, b, c, d]: [Point; 4]) -> [Point; 4] {
    [b, a, c, d]
}

#[test]
fn a_tet_shares_all_of_itself_in_either_orientation() {
    let sliver = [[0.1, 0.2, 0.3], [1.1, 0.2, 0.3], [1.1, 1.2, 0.3], [0.1, 1.2, 0.300_000_000_000_001]];
    for corners in [UNIT, sliver] {
        let whole = volume(corners);
        assert!(whole > 0.0);
        for other in [corners, mirrored(corners)] {
            assert!((overlap(corners, other) - whole).abs() <= 1e-15 * whole);
            assert!((overlap(mirrored(corners), other) - whole).abs() <= 1e-15 * whole);
        }
    }
}

#[test]
fn tets_that_only_touch_share_nothing() {
    let across_facet = [[1.0, 1.0, 1.0], UNIT[1], UNIT[2], UNIT[3]];
    let at_edge = [UNIT[0], UNIT[1], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    let at_vertex = UNIT.map(|p| p.map(|x| -x));
    let apart = UNIT.map(|p| [p[0] + 2.0, p[1], p[2]]);
    for other in [across_facet, at_edge, at_vertex, apart] {
        assert_eq!(overlap(UNIT, other), 0.0);
        assert_eq!(overlap(other, UNIT), 0.0);
    }
}

#[test]
fn a_tet_within_another_is_shared_whole_however_small() {
    for size in [0.3, 1e-6, 1e-12] {
        let small = UNIT.map(|p| p.map(|x| 0.2 + size * x));
        let whole = volume(small);
        assert!((overlap(UNIT, small) - whole).abs() <= 1e-15 * whole, "{size}");
    }
}

#[test]
fn flat_tets_and_ones_without_numbers_share_nothing() {
    let flat = [UNIT[0], UNIT[1], UNIT[2], [0.3, 0.3, 0.0]];
    let point = [[0.1; 3]; 4];
    let mut nan = UNIT;
    nan[2][1] = f64::NAN;
    let far = UNIT.map(|p| p.map(|x| x * 1e300));
    for other in [flat, point, nan, far] {
        assert_eq!(overlap(flat, other), 0.0);
        assert!(overlap(UNIT, other).is_finite());
    }
    assert_eq!(overlap(UNIT, flat), 0.0);
    assert_eq!(overlap(UNIT, nan), 0.0);
}

fn anywhere() -> impl Strategy<Value = [Point; 4]> {
    prop::array::uniform4(prop::array::uniform3(-1.0..1.0f64))
}

fn on_a_grid() -> impl Strategy<Value = [Point; 4]> {
    prop::array::uniform4(prop::array::uniform3(-1i8..=1))
        .prop_map(|t| t.map(|p| p.map(|x| f64::from(x) * 0.1)))
}

/// Four points almost in one plane.
fn slivers() -> impl Strategy<Value = [Point; 4]> {
    anywhere().prop_map(|t| t.map(|p| [p[0], p[1], p[2] * 1e-9 + 0.3 * p[0]]))
}

fn tets() -> impl Strategy<Value = [Point; 4]> {
    prop_oneof![anywhere(), on_a_grid(), slivers()]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn the_surface_of_what_is_shared_tells_the_same_volume(a in tets(), b in tets(), n_shared in 0usize..4) {
        let mut b = b;
        b[..n_shared].copy_from_slice(&a[..n_shared]);
        let smaller = volume(a).min(volume(b));
        let found = overlap(a, b);
        prop_assert!((0.0..=smaller).contains(&found));
        if smaller > 0.0 {
            let expected = overlap_by_surface(a, b);
            prop_assert!((found - expected).abs() <= 1e-14 * smaller, "{} {} of {}", found, expected, smaller);
        } else {
            prop_assert_eq!(found, 0.0);
        }
    }

    #[test]
    fn the_order_of_the_two_and_of_their_corners_matters_to_the_last_digits_only(a in tets(), b in tets()) {
        let smaller = volume(a).min(volume(b));
        let found = overlap(a, b);
        prop_assert!((overlap(b, a) - found).abs() <= 1e-14 * smaller);
        prop_assert!((overlap(mirrored(a), mirrored(b)) - found).abs() <= 1e-14 * smaller);
    }

    #[test]
    fn parts_in_the_tets_of_a_triangulation_add_up(
        cloud in prop::collection::vec(prop::array::uniform3(0.0..1.0f64), 10..60),
        inner in prop_oneof![anywhere(), on_a_grid(), slivers()],
        pick in prop::array::uniform4(any::<prop::sample::Index>()),
        n_shared in 0usize..4,
    ) {
        let mut points = cloud;
        for corner in 0..8 {
            points.push([0, 1, 2].map(|k| if corner >> k & 1 == 0 { -3.0 } else { 3.0 }));
        }
        let triangulation = Triangulation::new(&points, &Threads::single()).unwrap();
        let mut inner = inner;
        for i in 0..n_shared {
            inner[i] = points[pick[i].index(points.len())];
        }
        let whole = volume(inner);
        let parts = triangulation.tets().iter().map(|t| overlap(inner, t.map(|v| points[v.index()])));
        let sum: f64 = parts.sum();
        prop_assert!((sum - whole).abs() <= 1e-14 * whole, "{} of {}", sum, whole);
    }
}
