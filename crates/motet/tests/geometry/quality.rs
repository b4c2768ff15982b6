//! Quality measures: known shapes, invariances, and finite on every finite tet.

use motet::base::{Names as _, Point};
use motet::geometry::quality::{
    Measure, aspect_ratio, cubit_mean_ratio, dihedral, eas, edge_ratio, equiangle_skew, mean_ratio,
    radius_ratio, scaled_jacobian, volume,
};
use motet::geometry::tet::EDGES;
use motet::geometry::vector::{cross, dot, norm, sub};
use proptest::prelude::*;

const CORNER: [Point; 4] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];
const REGULAR: [Point; 4] = [[1., 1., 1.], [-1., 1., -1.], [1., -1., -1.], [-1., -1., 1.]];

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-14 * b.abs().max(1.0)
}

fn mirrored(tet: [Point; 4]) -> [Point; 4] {
    tet.map(|p| [-p[0], p[1], p[2]])
}

fn all(tet: [Point; 4]) -> [f64; 11] {
    let [low, high] = dihedral::min_max(tet);
    [
        eas(tet),
        equiangle_skew(tet),
        low,
        high,
        mean_ratio(tet),
        cubit_mean_ratio(tet),
        edge_ratio(tet),
        volume(tet),
        scaled_jacobian(tet),
        radius_ratio(tet),
        aspect_ratio(tet),
    ]
}

#[test]
fn the_regular_tet_is_best_by_every_measure() {
    let angle = (1.0f64 / 3.0).acos();
    let expected = [1.0, 0.0, angle, angle, 1.0, 1.0, 1.0, 8.0 / 3.0, 1.0, 1.0, 1.0];
    for (measure, expected) in all(REGULAR).into_iter().zip(expected) {
        assert!(near(measure, expected), "{measure} {expected}");
    }
    assert_eq!(dihedral::REGULAR, angle);
}

#[test]
fn the_corner_of_a_cube_has_the_values_that_its_definition_gives() {
    // Smallest face angle 45 degrees, so (60 - 45) / 60; smallest dihedral angle acos(1/sqrt 3).
    let [low, high] = dihedral::min_max(CORNER);
    assert!(near(equiangle_skew(CORNER), 0.25) && near(eas(CORNER), 0.75));
    assert!(near(low, (1.0 / 3.0f64.sqrt()).acos()) && near(high, std::f64::consts::FRAC_PI_2));
    assert!(near(mean_ratio(CORNER), 12.0 * 0.5f64.powf(2.0 / 3.0) / 9.0));
    assert!(near(edge_ratio(CORNER), 2.0f64.sqrt()) && near(volume(CORNER), 1.0 / 6.0));
    // At three vertices edges of 1, sqrt 2 and sqrt 2 meet. The sphere around has the radius sqrt(3) / 2, that
    // inside three times the volume over the area, (3 + sqrt 3) / 2.
    assert!(near(scaled_jacobian(CORNER), 0.5f64.sqrt()));
    let inside = 1.0 / (3.0 + 3f64.sqrt());
    assert!(near(radius_ratio(CORNER), 0.75f64.sqrt() / (3.0 * inside)));
    assert!(near(aspect_ratio(CORNER), 2f64.sqrt() / (24f64.sqrt() * inside)));
}

#[test]
fn a_measure_has_the_better_value_for_the_regular_tet() {
    for measure in Measure::ALL.iter().filter(|measure| **measure != Measure::Volume) {
        let [regular, corner] = [REGULAR, CORNER].map(|tet| measure.of_tet(tet));
        assert_eq!(regular > corner, measure.is_better_if_larger(), "{measure}");
    }
}

#[test]
fn a_tet_without_volume_is_worst_and_finite() {
    let flat = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]];
    let needle = [[0., 0., 0.], [1., 0., 0.], [2., 0., 0.], [3., 0., 0.]];
    let point = [[0.1, 0.2, 0.3]; 4];
    for tet in [flat, needle, point] {
        let [eas, skew, low, high, eta, cubit, ratio, volume, jacobian, radii, aspect] = all(tet);
        assert_eq!([eas, skew, eta, cubit, volume], [0.0, 1.0, 0.0, 0.0, 0.0], "{tet:?}");
        assert_eq!([jacobian, radii, aspect], [0.0, 1e30, 1e30], "{tet:?}");
        assert!(low == 0.0 && (0.0..=std::f64::consts::PI).contains(&high));
        assert!((1.0..=1e30).contains(&ratio));
    }
}

#[test]
fn a_hair_whose_facets_underflow_has_the_largest_ratios() {
    for thickness in [1e-31, 1e-60, 1e-86, 1e-160, 1e-300] {
        let hair = [[0., 0., 0.], [1., 0., 0.], [0.5, thickness, 0.], [0.2, 0., thickness]];
        assert_eq!([radius_ratio(hair), aspect_ratio(hair)], [1e30, 1e30], "{thickness}");
    }
    let far = [[-0.2, 7.4e133, 4.4e219], [0.8, 0., 0.], [0.5, 0., 0.], [0., 0., 0.]];
    assert_eq!([radius_ratio(far), aspect_ratio(far)], [1e30, 1e30]);
}

#[test]
fn the_cosine_of_a_dihedral_angle_is_that_of_the_normals() {
    let tet = [[0.1, 0.2, -0.1], [1.3, 0.1, 0.2], [0.2, 0.9, 0.1], [0.4, 0.3, 1.1]];
    for (e, [i, j]) in EDGES.into_iter().enumerate() {
        let [k, l] = EDGES[5 - e];
        let along = sub(tet[j], tet[i]);
        let (m, n) = (cross(along, sub(tet[k], tet[i])), cross(along, sub(tet[l], tet[i])));
        assert!(near(dihedral::angles(tet)[e].cos(), dot(m, n) / (norm(m) * norm(n))));
    }
}

fn any_point() -> impl Strategy<Value = Point> {
    prop::array::uniform3(prop_oneof![
        4 => -1.0f64..1.0,
        1 => prop::num::f64::NORMAL | prop::num::f64::SUBNORMAL | prop::num::f64::ZERO,
        1 => (-2i32..3).prop_map(f64::from),
        1 => Just(f64::MAX),
    ])
}

proptest! {
    #[test]
    fn every_finite_tet_has_finite_values_within_their_range(tet in prop::array::uniform4(any_point())) {
        let [eas, skew, low, high, eta, cubit, ratio, volume, jacobian, radii, aspect] = all(tet);
        prop_assert!((-1.0..=1.0).contains(&eas) && (0.0..=1.0).contains(&skew), "{eas} {skew}");
        prop_assert!((0.0..=high).contains(&low) && high <= std::f64::consts::PI);
        prop_assert!(eta.abs() <= 1.0 + 1e-15 && cubit.abs() <= 1.0 + 1e-15);
        prop_assert!((1.0..=1e30).contains(&ratio) && volume.is_finite());
        prop_assert!(jacobian.abs() <= 1.0 + 1e-15, "{jacobian}");
        prop_assert!([radii, aspect].into_iter().all(|x| (1.0..=1e30).contains(&x)), "{radii} {aspect}");
    }

    #[test]
    fn mirroring_changes_only_the_sign(tet in prop::array::uniform4(prop::array::uniform3(-1.0f64..1.0))) {
        let [eas, skew, low, high, eta, cubit, ratio, volume, jacobian, radii, aspect] = all(tet);
        let expected = [-eas, skew, low, high, -eta, -cubit, ratio, -volume, -jacobian, radii, aspect];
        prop_assert_eq!(all(mirrored(tet)), expected);
    }

    #[test]
    fn size_by_a_power_of_two_matters_to_the_volume_alone(
        tet in prop::array::uniform4(prop::array::uniform3(-1.0f64..1.0)),
        exponent in -90i32..90,
    ) {
        let factor = 2f64.powi(exponent);
        let [expected, other] = [all(tet), all(tet.map(|p| p.map(|x| x * factor)))];
        prop_assert_eq!(&other[..4], &expected[..4]);
        prop_assert!(other[4..7].iter().zip(&expected[4..7]).all(|(a, b)| near(*a, *b)));
        prop_assert_eq!(other[7], expected[7] * factor * factor * factor);
        prop_assert!(other[8..].iter().zip(&expected[8..]).all(|(a, b)| near(*a, *b)));
    }
}

#[test]
fn the_regular_tet_is_best_at_any_size() {
    for exponent in [-1000, -300, 300, 1000] {
        let tet = REGULAR.map(|p| p.map(|x| x * 2f64.powi(exponent)));
        assert_eq!(all(tet)[..7], all(REGULAR)[..7]);
        assert!(all(tet)[8..].iter().all(|x| near(*x, 1.0)));
    }
}
