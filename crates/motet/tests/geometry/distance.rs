//! Distances of points, segments and triangles: compared with exact arithmetic, and checked for the
//! properties of every distance.

use crate::distance_oracle as oracle;
use motet::base::Point;
use motet::geometry::distance::{
    Closest, Feature, point_segment, point_triangle, segment_segment, segment_triangle, triangle_triangle,
};
use motet::geometry::triangle;
use motet::geometry::vector::{add, distance, dot, norm, scale, sub};
use num_traits::Zero;
use oracle::Grid;
use proptest::prelude::*;

/// The promised error, relative to the extent.
const PROMISED: f64 = 4e-15;
/// Coordinates so large that products are rounded, while sums of some vertices are not.
const FINE: i64 = 1 << 45;

fn float(p: Grid) -> Point {
    p.map(|x| x as f64)
}

/// The largest distance between two vertices.
fn extent(points: &[Point]) -> f64 {
    points.iter().flat_map(|p| points.iter().map(|q| distance(*p, *q))).fold(0.0, f64::max)
}

fn at(points: &[Point], weights: &[f64]) -> Point {
    points.iter().zip(weights).fold([0.0; 3], |sum, (p, w)| add(sum, scale(*p, *w)))
}

/// `(k . a) / 12` for vertices that are multiples of 12: a point of the triangle on the grid.
fn within(a: [Grid; 3], [k, l]: [i64; 2]) -> Grid {
    let (k, l) = (k.min(12 - l), l);
    [0, 1, 2].map(|x| (a[0][x] * (12 - k - l) + a[1][x] * k + a[2][x] * l) / 12)
}

/// Pairs of triangles that are hard to measure: on a small grid, where they cross, touch and coincide; on a
/// fine one; in a plane; needles of both kinds; nearly parallel; touching; with a vertex on a needle; without
/// area.
fn pair() -> impl Strategy<Value = [Grid; 6]> {
    let small = prop::array::uniform6(prop::array::uniform3(-4..=4i64));
    let fine = prop::array::uniform6(prop::array::uniform3(-FINE..=FINE));
    let coarser = 0..40u8;
    let part = prop::array::uniform2(0..=12i64);
    (0..11u8, small, fine, coarser, part).prop_map(|(kind, s, f, coarser, part)| {
        let f = f.map(|p| p.map(|x: i64| x >> coarser));
        let plus = |a: Grid, b: Grid| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let times = |a: Grid, k: i64| a.map(|x| x * k);
        // Long and thin: the third vertex beside the long edge, or beside one of its ends.
        let needle = [f[0], plus(f[0], times(f[1], 12)), plus(plus(f[0], times(f[1], part[0])), s[2])];
        let nail = [f[0], plus(f[0], s[1]), f[2]];
        let in_12 = |t: [Grid; 3]| t.map(|p| times(p, 12));
        let with = |a: [Grid; 3], b: [Grid; 3]| [a[0], a[1], a[2], b[0], b[1], b[2]];
        let plane = |p: Grid| [p[0], p[1], p[0] + 2 * p[1]];
        match kind {
            0 => s,
            1 => f,
            2 => s.map(plane),
            3 => with(needle, [f[3], f[4], f[5]]),
            4 => with(nail, [plus(f[0], s[3]), plus(f[2], s[4]), f[5]]),
            5 => with([f[0], f[1], f[2]], [plus(f[0], s[3]), plus(f[1], s[4]), plus(f[2], s[5])]),
            6 => with(in_12([s[0], s[1], s[2]]), [within(in_12([s[0], s[1], s[2]]), part), f[4], s[5]]),
            7 => with(in_12(needle), [within(in_12(needle), part), f[4], f[5]]),
            8 => with(in_12(nail), [within(in_12(nail), part), f[4], s[5]]),
            9 => with([s[0], s[0], s[2]], [s[3], s[4], if part[0] < 6 { s[3] } else { plus(s[4], s[4]) }]),
            _ => with(needle, [plus(needle[0], s[3]), plus(needle[1], s[4]), plus(needle[2], s[5])]),
        }
    })
}

/// Checks everything that must hold of closest points, for all primitives.
fn check<const A: usize, const B: usize>(
    found: Closest<A, B>,
    a: [Grid; A],
    b: [Grid; B],
) -> Result<f64, TestCaseError> {
    let (exact, a, b) = (oracle::distance(&a, &b), a.map(float), b.map(float));
    let extent = extent(&[a.as_slice(), b.as_slice()].concat());
    let off = (found.distance() - exact).abs();
    prop_assert!(off <= PROMISED * extent, "{off:e} of {extent} off {exact}: {found:?}");
    for weights in [found.on_a.as_slice(), found.on_b.as_slice()] {
        prop_assert!(weights.iter().all(|w| (0.0..=1.0).contains(w)), "{weights:?}");
        prop_assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-15, "{weights:?}");
    }
    // The weights give points that are this far apart; coordinates are up to ten times the extent.
    let apart = sub(at(&b, &found.on_b), at(&a, &found.on_a));
    let size = [a.as_slice(), b.as_slice()].concat().iter().map(|p| norm(*p)).fold(0.0, f64::max);
    prop_assert!(distance(apart, found.offset) <= PROMISED * size.max(extent), "{apart:?} {found:?}");
    prop_assert!((norm(found.offset) - found.distance()).abs() <= 1e-15 * extent);
    prop_assert_eq!(found.features(), [feature(&found.on_a), feature(&found.on_b)]);
    match found.direction() {
        Some(n) => prop_assert!((norm(n) - 1.0).abs() < 1e-15),
        None => prop_assert_eq!(found.distance_squared, 0.0),
    }
    Ok(if extent > 0.0 { off / extent } else { 0.0 })
}

/// The feature by its definition, case by case.
fn feature(weights: &[f64]) -> Feature {
    let held: Vec<bool> = weights.iter().map(|&w| w > 0.0).collect();
    match held.as_slice() {
        [true] | [true, false] | [true, false, false] => Feature::Vertex(0),
        [false, true] | [false, true, false] => Feature::Vertex(1),
        [false, false, true] => Feature::Vertex(2),
        [true, true] | [false, true, true] => Feature::Edge(0),
        [true, false, true] => Feature::Edge(1),
        [true, true, false] => Feature::Edge(2),
        _ => Feature::Face,
    }
}

/// The closest points by the weights of `triangle::closest` alone.
fn plain(p: Point, triangle: [Point; 3]) -> Closest<1, 3> {
    let on_b = triangle::closest(triangle, p);
    let offset = at(&triangle.map(|x| sub(x, p)), &on_b);
    Closest { distance_squared: dot(offset, offset), on_a: [1.0], on_b, offset }
}

fn triangles(g: [Grid; 6]) -> [[Point; 3]; 2] {
    [[g[0], g[1], g[2]].map(float), [g[3], g[4], g[5]].map(float)]
}

fn extent_of(a: [Point; 3], b: [Point; 3]) -> f64 {
    extent(&[a, b].concat())
}

/// Random triangles in a box, without degeneracies.
fn anywhere() -> impl Strategy<Value = [[Point; 3]; 2]> {
    prop::array::uniform2(prop::array::uniform3(prop::array::uniform3(-1.0..1.0f64)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6000))]

    #[test]
    fn distances_are_those_without_rounding(g in pair(), i in 0..3usize) {
        let [a, b] = [[g[0], g[1], g[2]], [g[3], g[4], g[5]]];
        let [p, q] = triangles(g);
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        check(point_segment::closest(q[i], [p[j], p[k]]), [b[i]], [a[j], a[k]])?;
        check(point_triangle::closest(q[i], p), [b[i]], a)?;
        check(plain(q[i], p), [b[i]], a)?;
        check(segment_segment::closest([p[i], p[j]], [q[k], q[i]]), [a[i], a[j]], [b[k], b[i]])?;
        check(triangle_triangle::closest(p, q), a, b)?;
    }

    #[test]
    fn weights_on_a_triangle_know_no_unit_and_no_origin(g in pair(), power in -480..400i32, axis in 0..3usize) {
        let [a, b] = triangles(g);
        let found = triangle::closest(a, b[0]);
        let by = |p: Point| scale(p, 2f64.powi(power));
        let exact = oracle::distance(&[g[3]], &[g[0], g[1], g[2]]);
        let extent = extent(&[a[0], a[1], a[2], b[0]]);
        // In other units the search may take another path to the point, so it need not have the same bits.
        let weights = triangle::closest(a.map(by), by(b[0]));
        let d = norm(at(&a.map(|x| sub(x, b[0])), &weights));
        prop_assert!((d - exact).abs() <= PROMISED * extent, "{d} {exact}");
        if extent > 2f64.powi(40) {
            return Ok(());
        }
        // No coordinate is rounded.
        let far = |mut p: Point| {
            p[axis] += 2f64.powi(50);
            p
        };
        prop_assert_eq!(triangle::closest(a.map(far), far(b[0])), found);
    }

    #[test]
    fn what_meets_is_at_distance_zero_and_nothing_else(g in pair(), i in 0..3usize) {
        let [a, b] = [[g[0], g[1], g[2]], [g[3], g[4], g[5]]];
        let [p, q] = triangles(g);
        let [j, k] = [(i + 1) % 3, (i + 2) % 3];
        let meet = oracle::distance_squared(&[a[i], a[j]], &[b[k], b[i]]).is_zero();
        prop_assert_eq!(segment_segment::meet([p[i], p[j]], [q[k], q[i]]), meet);
        let meet = oracle::distance_squared(&[a[i], a[j]], &b).is_zero();
        prop_assert_eq!(segment_triangle::meet([p[i], p[j]], q), meet);
        let meet = oracle::distance_squared(&a, &b).is_zero();
        prop_assert_eq!(triangle_triangle::meet(p, q), meet);
        let found = triangle_triangle::closest(p, q);
        prop_assert!(!meet || found.distance_squared == 0.0 && found.gradient().is_none());
    }

    #[test]
    fn order_of_arguments_and_of_vertices_does_not_matter(g in pair(), turn in 0..3usize) {
        let [a, b] = triangles(g);
        let d = triangle_triangle::closest(a, b).distance();
        let mut turned = a;
        turned.rotate_left(turn);
        turned.swap(0, turn);
        let tolerance = 2.0 * PROMISED * extent_of(a, b);
        for other in [triangle_triangle::closest(b, a), triangle_triangle::closest(turned, b), triangle_triangle::closest(b, turned)] {
            prop_assert!((other.distance() - d).abs() <= tolerance);
        }
        let (e, f) = ([a[0], a[1]], [b[0], b[1]]);
        let d = segment_segment::closest(e, f).distance();
        for other in [segment_segment::closest(f, e), segment_segment::closest([e[1], e[0]], f)] {
            prop_assert!((other.distance() - d).abs() <= tolerance);
        }
        prop_assert_eq!(segment_segment::closest(e, f).swapped().swapped(), segment_segment::closest(e, f));
    }

    #[test]
    fn units_and_the_place_of_the_origin_do_not_matter(g in pair(), power in -450..400i32, axis in 0..3usize) {
        let [a, b] = triangles(g);
        let found = triangle_triangle::closest(a, b);
        let by = 2f64.powi(power);
        let scaled = triangle_triangle::closest(a.map(|p| scale(p, by)), b.map(|p| scale(p, by)));
        prop_assert_eq!((found.on_a, found.on_b, scale(found.offset, by)), (scaled.on_a, scaled.on_b, scaled.offset));
        prop_assert_eq!(found.distance() * by, scaled.distance());
        prop_assert_eq!(found.direction(), scaled.direction());
        if extent_of(a, b) > 2f64.powi(40) {
            return Ok(());
        }
        // No coordinate is rounded.
        let far = |mut p: Point| {
            p[axis] += 2f64.powi(50);
            p
        };
        prop_assert_eq!(triangle_triangle::closest(a.map(far), b.map(far)), found);
    }

    #[test]
    fn a_rigid_motion_does_not_matter([a, b] in anywhere(), angle in 0.0..6.3f64, shift in -1.0..1.0f64) {
        let (s, c) = angle.sin_cos();
        let turn = |[x, y, z]: Point| {
            let [x, y] = [c * x - s * y, s * x + c * y];
            [x + shift, 0.8 * y - 0.6 * z, 0.6 * y + 0.8 * z - shift]
        };
        let moved = triangle_triangle::closest(a.map(turn), b.map(turn));
        prop_assert!((moved.distance() - triangle_triangle::closest(a, b).distance()).abs() < 4e-15);
    }

    #[test]
    fn the_gradient_is_what_differences_say([a, b] in anywhere(), vertex in 0..6usize, axis in 0..3usize) {
        const STEP: f64 = 1e-5;
        let found = triangle_triangle::closest(a, b);
        let Some(gradient) = found.gradient() else { return Ok(()) };
        let d = found.distance();
        if d < 1e-2 {
            return Ok(());
        }
        let moved = |by: f64| {
            let mut all = [a[0], a[1], a[2], b[0], b[1], b[2]];
            all[vertex][axis] += by;
            triangle_triangle::closest([all[0], all[1], all[2]], [all[3], all[4], all[5]]).distance()
        };
        let all = [gradient.by_a, gradient.by_b].concat();
        let slope = all[vertex][axis];
        // The pair that was found is still a candidate, so the distance grows no faster than that.
        let curved = STEP * STEP / (2.0 * d) + 1e-14;
        let (ahead, behind) = (moved(STEP), moved(-STEP));
        prop_assert!(ahead <= d + slope * STEP + curved && behind <= d - slope * STEP + curved);
        // Nor any slower, where the two sides do not form a kink.
        let kink = 2.0 * d - ahead - behind;
        prop_assert!(((ahead - behind) / (2.0 * STEP) - slope).abs() <= (kink.abs() + 2.0 * curved) / STEP);
        // Moving all vertices together changes nothing.
        let sum = all.iter().fold([0.0; 3], |sum, g| add(sum, *g));
        prop_assert!(norm(sum) < 1e-15);
    }

    #[test]
    fn triangles_that_do_not_meet_are_as_near_as_their_nearest_parts(g in pair()) {
        let [a, b] = triangles(g);
        if triangle_triangle::meet(a, b) {
            return Ok(());
        }
        let mut least = f64::INFINITY;
        for i in 0..3 {
            least = least.min(point_triangle::closest(a[i], b).distance_squared);
            least = least.min(point_triangle::closest(b[i], a).distance_squared);
            for j in 0..3 {
                let (e, f) = ([a[i], a[(i + 1) % 3]], [b[j], b[(j + 1) % 3]]);
                least = least.min(segment_segment::closest(e, f).distance_squared);
            }
        }
        let off = triangle_triangle::closest(a, b).distance() - least.sqrt();
        prop_assert!(off.abs() <= 2.0 * PROMISED * extent_of(a, b), "{off:e}");
    }

    #[test]
    fn a_search_below_a_bound_finds_what_is_below_it(g in pair(), part in prop_oneof![0.0..2.0f64, Just(1.0)]) {
        let [a, b] = triangles(g);
        let found = triangle_triangle::closest(a, b);
        let bound = found.distance() * part;
        let rounding = 2.0 * PROMISED * extent_of(a, b);
        match triangle_triangle::closest_below(a, b, bound * bound) {
            Some(below) => {
                prop_assert!(below.distance_squared < bound * bound);
                prop_assert!((below.distance() - found.distance()).abs() <= rounding);
            }
            None => prop_assert!(found.distance() >= bound - rounding),
        }
        let all = triangle_triangle::closest_below(a, b, f64::INFINITY);
        prop_assert!(all.is_some_and(|all| (all.distance() - found.distance()).abs() <= rounding));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn no_sampled_pair_is_nearer_and_one_is_hardly_farther([a, b] in anywhere()) {
        const PARTS: usize = 12;
        let samples = |t: [Point; 3]| -> Vec<Point> {
            let weights = (0..=PARTS).flat_map(|i| (0..=PARTS - i).map(move |j| [i, j, PARTS - i - j]));
            weights.map(|w| at(&t, &w.map(|x| x as f64 / PARTS as f64))).collect()
        };
        let (of_a, of_b) = (samples(a), samples(b));
        let nearest = of_a.iter().flat_map(|p| of_b.iter().map(|q| distance(*p, *q))).fold(f64::INFINITY, f64::min);
        let d = triangle_triangle::closest(a, b).distance();
        let spacing = (extent(&a) + extent(&b)) / PARTS as f64;
        prop_assert!(d <= nearest + 1e-15 && nearest <= d + spacing, "{d} {nearest}");
    }
}

#[test]
fn what_is_not_a_number_stops_nobody() {
    let bad = [[f64::NAN, 0.0, 0.0], [f64::INFINITY, 1.0, 0.0], [1e308, -1e308, 0.0]];
    let good = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    for (a, b) in [(bad, good), (good, bad), (bad, bad)] {
        let found = segment_segment::closest([a[0], a[1]], [b[0], b[1]]);
        assert!(found.distance_squared.is_nan());
        assert!(point_triangle::closest(a[0], b).distance_squared.is_nan());
        assert!(triangle_triangle::closest(a, b).distance_squared.is_nan());
        assert!(triangle_triangle::closest_below(a, b, 1.0).is_none());
    }
}

/// Each error is within the promise, and the mean error far below it.
#[test]
fn the_mean_error_is_a_rounding_or_so() {
    use proptest::strategy::ValueTree;
    const N: usize = 2_000;
    let mut runner = proptest::test_runner::TestRunner::deterministic();
    let mut sum = [0.0; 5];
    for _ in 0..N {
        let g = pair().new_tree(&mut runner).expect("pairs are easy to make").current();
        let ([p, q], [a, b]) = (triangles(g), [[g[0], g[1], g[2]], [g[3], g[4], g[5]]]);
        let off = [
            check(point_segment::closest(q[0], [p[0], p[1]]), [b[0]], [a[0], a[1]]),
            check(point_triangle::closest(q[0], p), [b[0]], a),
            check(segment_segment::closest([p[0], p[1]], [q[0], q[1]]), [a[0], a[1]], [b[0], b[1]]),
            check(triangle_triangle::closest(p, q), a, b),
            check(plain(q[0], p), [b[0]], a),
        ];
        for (sum, off) in sum.iter_mut().zip(off) {
            *sum += off.expect("good enough") / N as f64;
        }
    }
    println!("{sum:?}");
    assert!(sum.into_iter().all(|mean| mean < f64::EPSILON / 8.0), "{sum:?}");
}
