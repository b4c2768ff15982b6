//! Signs and error bounds of every stage, compared with rational arithmetic.

use super::{collinear, exact, insphere, insphere_perturbed, orient, orient3d};
use crate::base::Point;
use num_rational::BigRational;
use num_traits::{Signed, Zero};
use proptest::prelude::*;

type Rational = BigRational;

fn rational(x: f64) -> Rational {
    Rational::from_float(x).expect("finite")
}

fn row(p: Point, a: Point) -> [Rational; 3] {
    std::array::from_fn(|i| rational(p[i]) - rational(a[i]))
}

fn det3([a, b, c]: [&[Rational; 3]; 3]) -> Rational {
    let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
    &a[0] * minor(1, 2) + &a[1] * minor(2, 0) + &a[2] * minor(0, 1)
}

fn orient_exact(p: [Point; 4]) -> Rational {
    let [b, c, d] = [1, 2, 3].map(|i| row(p[i], p[0]));
    det3([&b, &c, &d])
}

fn insphere_exact(p: [Point; 5]) -> Rational {
    let rows = [1, 2, 3, 4].map(|i| row(p[i], p[0]));
    let [b, c, d, x] = &rows;
    let squared = |v: &[Rational; 3]| v.iter().map(|x| x * x).sum::<Rational>();
    squared(b) * det3([c, d, x]) - squared(c) * det3([b, d, x]) + squared(d) * det3([b, c, x])
        - squared(x) * det3([b, c, d])
}

fn sign(x: &Rational) -> i8 {
    if x.is_zero() {
        0
    } else if x.is_positive() {
        1
    } else {
        -1
    }
}

/// Points of the kinds that occur: anywhere, on a grid (also one whose step is not a binary fraction), on a
/// sphere, in a plane, rotated, nearly equal, and of sizes from one end of `f64` to the other.
fn points(n: usize) -> impl Strategy<Value = Vec<Point>> {
    let raw = prop::collection::vec(prop::array::uniform3(-1.0..1.0f64), n);
    let kind = 0..7u8;
    let scale = prop_oneof![4 => Just(1.0), 1 => Just(1e-3), 1 => Just(1e18), 1 => Just(1e-80),
        1 => Just(1e-308), 1 => Just(1e60), 1 => Just(1e307)];
    let offset = prop_oneof![3 => Just(0.0), 1 => Just(100.0), 1 => Just(1e12)];
    (raw, kind, scale, offset, 0.0..6.3f64).prop_map(|(raw, kind, scale, offset, angle)| {
        let (s, c) = angle.sin_cos();
        let turn = |[x, y, z]: Point| [c * x - s * y, s * x + c * y, 0.6 * z - 0.8 * (s * x + c * y)];
        raw.into_iter()
            .map(|p| match kind {
                0 => p,
                1 => p.map(|x| (x * 3.0).round()),
                2 => p.map(|x| (x * 3.0).round() * 0.1),
                3 => {
                    let norm = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt().max(1e-3);
                    p.map(|x| x / norm)
                }
                4 => turn([p[0], p[1], 0.25]),
                5 => turn(p.map(|x| (x * 2.0).round() * 0.1)),
                _ => [p[0], 0.5 + 1e-15 * p[1], 0.5 + 1e-15 * p[2]],
            })
            .map(|p| p.map(|x| (x + offset) * scale))
            .map(|p| p.map(|x| if x.is_finite() { x } else { 0.0 }))
            .collect()
    })
}

fn four(p: &[Point]) -> [Point; 4] {
    [p[0], p[1], p[2], p[3]]
}

fn five(p: &[Point]) -> [Point; 5] {
    [p[0], p[1], p[2], p[3], p[4]]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn orient3d_has_the_sign_of_the_rational_determinant(p in points(4)) {
        let [a, b, c, d] = four(&p);
        let truth = orient_exact([a, b, c, d]);
        prop_assert_eq!(orient3d(a, b, c, d), sign(&truth));
        prop_assert_eq!(exact::orient3d(a, [b, c, d]), sign(&truth));
        prop_assert_eq!(orient3d(b, a, c, d), -sign(&truth));
    }

    #[test]
    fn insphere_has_the_sign_of_the_rational_determinant(p in points(5)) {
        let [a, b, c, d, e] = five(&p);
        let truth = sign(&insphere_exact([a, b, c, d, e]));
        prop_assert_eq!(insphere(a, b, c, d, e), truth);
        prop_assert_eq!(exact::insphere(a, [b, c, d, e]), truth);
        prop_assert_eq!(insphere(a, c, b, d, e), -truth);
    }

    #[test]
    fn no_stage_of_orient3d_errs_by_more_than_its_bound(p in points(4)) {
        let [a, b, c, d] = four(&p);
        prop_assume!(p.iter().flatten().all(|x| x.abs() < 1e60));
        let truth = orient_exact([a, b, c, d]);
        for (value, bound) in orient::stages(a, b, c, d) {
            let error = rational(value.high) + rational(value.low) - &truth;
            prop_assert!(error.abs() <= rational(bound), "{value:?} +- {bound}");
        }
    }

    #[test]
    fn no_stage_of_insphere_errs_by_more_than_its_bound(p in points(5)) {
        prop_assume!(p.iter().flatten().all(|x| x.abs() < 1e30));
        let truth = insphere_exact(five(&p));
        let mut stages = insphere::stages::<pulp::Scalar>(five(&p)).to_vec();
        #[cfg(target_arch = "x86_64")]
        stages.extend(insphere::stages::<pulp::x86::V3>(five(&p)));
        for (value, bound) in stages {
            let error = rational(value.high) + rational(value.low) - &truth;
            prop_assert!(error.abs() <= rational(bound), "{value:?} +- {bound}");
        }
    }

    #[test]
    fn a_tie_is_broken_the_same_way_from_every_side(p in points(5), ranks in Just([0u32, 1, 2, 3, 4]).prop_shuffle()) {
        // Lifted into four dimensions, five points make a simplex: whether e lies below the plane of a, b, c,
        // d does not depend on which of them is called e, up to the parity of the exchange.
        let mut p = five(&p);
        for i in 0..4 {
            prop_assume!((i + 1..5).all(|j| p[i] != p[j]));
        }
        if orient3d(p[0], p[1], p[2], p[3]) < 0 {
            p.swap(0, 1);
        }
        prop_assume!(orient3d(p[0], p[1], p[2], p[3]) > 0);
        let ours = insphere_perturbed(p, ranks);
        prop_assert!(ours != 0);
        for i in 0..4 {
            // Exchange e with vertex i; the tet may come out negative, which exchanges two more.
            let (mut q, mut r) = (p, ranks);
            q.swap(i, 4);
            r.swap(i, 4);
            let orientation = orient3d(q[0], q[1], q[2], q[3]);
            if orientation < 0 {
                q.swap((i + 1) % 4, (i + 2) % 4);
                r.swap((i + 1) % 4, (i + 2) % 4);
            }
            // The lifted determinant changes sign with the exchange; the test multiplies it by the tet's own
            // sign.
            if orientation != 0 {
                prop_assert_eq!(insphere_perturbed(q, r), -ours * orientation);
            }
        }
    }

    #[test]
    fn three_points_are_collinear_when_their_triangle_has_no_area(p in points(3), t in 0..3u8) {
        let [a, b] = [p[0], p[1]];
        let c = if t == 0 { p[2] } else { a.map(|x| x * f64::from(t)) };
        let (u, v) = (row(b, a), row(c, a));
        let flat = (0..3).all(|i| (&u[(i + 1) % 3] * &v[(i + 2) % 3] - &u[(i + 2) % 3] * &v[(i + 1) % 3]).is_zero());
        prop_assert_eq!(collinear(a, b, c), flat);
    }
}

#[test]
fn the_whole_range_of_floats_has_exact_signs() {
    let (tiny, huge) = (5e-324, f64::MAX);
    assert_eq!(orient3d([0.0; 3], [huge, 0.0, 0.0], [0.0, tiny, 0.0], [0.0, 0.0, tiny]), 1);
    assert_eq!(orient3d([-huge; 3], [huge, 0.0, 0.0], [0.0, tiny, 0.0], [0.0, 0.0, huge]), 1);
    // The sphere of a cube's corners, tiny and huge; the last corner is on it, a step inward is not.
    for s in [tiny, 1e-200, 1.0, 1e200, huge / 2.0] {
        let tet = [[0.0; 3], [s, 0.0, 0.0], [0.0, s, 0.0], [0.0, 0.0, s]];
        assert_eq!(insphere(tet[0], tet[1], tet[2], tet[3], [s; 3]), 0);
        assert_eq!(insphere(tet[0], tet[1], tet[2], tet[3], [s, s, 2.0 * s]), -1);
        if s > tiny {
            assert_eq!(insphere(tet[0], tet[1], tet[2], tet[3], [s, s, s.next_down()]), 1);
        }
    }
}

mod spots {
    //! Signs for points on segments and in triangles, compared with rational arithmetic.

    use super::{Rational, det3, points, rational, sign};
    use crate::base::Point;
    use crate::geometry::predicates::spot::{Between, Spot, insphere_of, orient3d_of};
    use proptest::prelude::*;

    type Place = [Rational; 3];

    fn place(spot: &Spot) -> Place {
        match spot {
            Spot::Given(p) => p.map(rational),
            Spot::On(between) => {
                let ([a, b, c], shares) = between.parts();
                let along =
                    |p: Point, share: f64, i: usize| rational(share) * (rational(p[i]) - rational(a[i]));
                std::array::from_fn(|i| rational(a[i]) + along(b, shares[0], i) + along(c, shares[1], i))
            }
        }
    }

    fn rows<const N: usize>(spots: &[Spot]) -> [Place; N] {
        let origin = place(&spots[0]);
        std::array::from_fn(|k| {
            let p = place(&spots[k + 1]);
            std::array::from_fn(|i| &p[i] - &origin[i])
        })
    }

    fn orient_exact(spots: &[Spot]) -> i8 {
        let [b, c, d] = &rows::<3>(spots);
        sign(&det3([b, c, d]))
    }

    fn insphere_exact(spots: &[Spot]) -> i8 {
        let [b, c, d, x] = &rows::<4>(spots);
        let squared = |v: &Place| v.iter().map(|x| x * x).sum::<Rational>();
        sign(
            &(squared(b) * det3([c, d, x]) - squared(c) * det3([b, d, x]) + squared(d) * det3([b, c, x])
                - squared(x) * det3([b, c, d])),
        )
    }

    /// A point on a segment or in a triangle of some of the given points, or a given point itself.
    #[derive(Clone, Debug)]
    struct Kind {
        is_between: bool,
        corners: [usize; 3],
        shares: [f64; 2],
    }

    /// Which of five points lie on segments or in triangles, between which of the points, and where.
    fn kinds() -> impl Strategy<Value = Vec<Kind>> {
        let share = prop_oneof![Just(0.5), Just(0.25), 0.01..0.99f64, Just(1e-9), Just(1.0 - 1e-12)];
        let second =
            prop_oneof![Just(0.0), Just(0.5), 0.01..0.99f64, Just(1e-9), -1e-17..1e-17f64, Just(-1e-25)];
        let kind = (any::<bool>(), [0..7usize, 0..7usize, 0..7usize], share, second);
        let kind = kind.prop_map(|(is_between, corners, share, second)| Kind {
            is_between,
            corners,
            shares: [share, second * (1.0 - share)],
        });
        prop::collection::vec(kind, 5)
    }

    fn between(p: &[Point], kind: &Kind) -> Between {
        let [i, j, k] = kind.corners;
        Between::within(p[i], [p[j], p[k]], kind.shares)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(4000))]
        #[test]
        fn signs_of_points_on_segments_and_in_triangles_are_exact(p in points(7), kinds in kinds()) {
            let on: Vec<Between> = kinds.iter().map(|kind| between(&p, kind)).collect();
            let spot = |k: usize| if kinds[k].is_between { Spot::On(&on[k]) } else { Spot::Given(p[k]) };
            let spots = [spot(0), spot(1), spot(2), spot(3), spot(4)];
            // Differences of numbers near the largest f64 overflow; such points are scaled before they get
            // here.
            prop_assume!(p.iter().flatten().all(|x| x.abs() < 1e300));
            prop_assert_eq!(orient3d_of([spots[0], spots[1], spots[2], spots[3]]), orient_exact(&spots[..4]));
            prop_assert_eq!(insphere_of(spots), insphere_exact(&spots));
        }

        #[test]
        fn a_point_on_a_segment_stays_in_every_plane_through_it(
            p in points(4),
            share in 0.001..0.999f64,
            rest in -1e-17..1e-17f64,
        ) {
            let between = Between::new(p[0], p[1], [share, rest]);
            let on = Spot::On(&between);
            let [a, b, c, d] = [p[0], p[1], p[2], p[3]].map(Spot::Given);
            prop_assert_eq!(orient3d_of([a, b, c, on]), 0);
            // And lies on the same side of any other plane as the ends, where those agree.
            let sides = [orient3d_of([c, d, on, a]), orient3d_of([c, d, on, b])];
            prop_assert!(sides[0] * sides[1] <= 0);
        }

        #[test]
        fn what_cancels_leaves_no_error(p in points(3), x in -1e-9..1e-9f64, share in 0.4999..0.5001f64) {
            // Segments through the origin, and the signs of points near it.
            let on: Vec<Between> = p.iter().map(|&q| Between::new(q, q.map(|x| -x), [share, 0.0])).collect();
            let spots = [Spot::On(&on[0]), Spot::On(&on[1]), Spot::On(&on[2]), Spot::Given([x, -x, 0.5 * x])];
            prop_assume!(p.iter().flatten().all(|x| x.abs() < 1e300));
            prop_assert_eq!(orient3d_of(spots), orient_exact(&spots));
        }

        #[test]
        fn rounding_is_by_at_most_a_place(p in points(2), share in 0.001..0.999f64) {
            prop_assume!(p.iter().flatten().all(|x| x.abs() < 1e300 && (x.abs() > 1e-290 || *x == 0.0)));
            let between = Between::new(p[0], p[1], [share, 0.0]);
            let truth = place(&Spot::On(&between));
            let near: Point = between.rounded();
            for i in 0..3 {
                let size = p[0][i].abs().max(p[1][i].abs());
                let error = (rational(near[i]) - &truth[i]).clone();
                let limit = rational(size * f64::EPSILON);
                prop_assert!(error.clone() <= limit && -error <= limit);
            }
        }
    }
}
