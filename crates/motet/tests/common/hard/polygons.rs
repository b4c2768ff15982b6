//! Extruded polygons: combs, spirals, stars of cocircular corners, fans of thin wedges.

use std::f64::consts::TAU;

use super::super::Numbers;
use super::body::{Body, extruded};

/// A comb: `teeth` of this width, equally far apart, of random length.
pub(crate) fn comb(teeth: usize, width: f64, numbers: &mut Numbers) -> Body {
    let mut polygon = vec![[0.0, -1.0], [(2 * teeth - 1) as f64 * width, -1.0]];
    for tooth in (0..teeth).rev() {
        let left = 2.0 * tooth as f64 * width;
        let top = (1 + numbers.below(64)) as f64 / 16.0;
        if tooth + 1 < teeth {
            polygon.push([left + width, 0.0]);
        }
        polygon.extend([[left + width, top], [left, top]]);
        if tooth > 0 {
            polygon.push([left, 0.0]);
        }
    }
    extruded(&polygon, (1 + numbers.below(8)) as f64 / 4.0, numbers)
}

/// A band wound around a point; `thickness` is the fraction of the space between turns that it takes, less
/// than 1.
pub(crate) fn spiral(turns: usize, steps: usize, thickness: f64, numbers: &mut Numbers) -> Body {
    let at = |i: usize, off: f64| {
        let turn = i as f64 / steps as f64;
        let (sin, cos) = (TAU * turn).sin_cos();
        let radius = 0.5 + turn + off;
        [radius * cos, radius * sin]
    };
    let n = turns * steps;
    let mut polygon: Vec<_> = (0..=n).map(|i| at(i, thickness)).collect();
    polygon.extend((0..=n).rev().map(|i| at(i, 0.0)));
    extruded(&polygon, 1.0, numbers)
}

/// A polygon around the origin whose corners lie exactly on one circle, and a share of them on one half as
/// large: all points with integer coordinates on the circle of radius 1105, or most of them.
pub(crate) fn cocircular(outer_share: f64, numbers: &mut Numbers) -> Body {
    const RADIUS: i32 = 1105;
    let mut corners: Vec<[i32; 2]> = Vec::new();
    for x in -RADIUS..=RADIUS {
        let y = f64::from(RADIUS * RADIUS - x * x).sqrt().round() as i32;
        if x * x + y * y == RADIUS * RADIUS {
            corners.extend(if y == 0 { vec![[x, 0]] } else { vec![[x, y], [x, -y]] });
        }
    }
    let angle = |[x, y]: [i32; 2]| f64::from(y).atan2(f64::from(x));
    corners.sort_by(|a, b| angle(*a).total_cmp(&angle(*b)));
    // Keep enough corners for the origin to be inside.
    corners.retain(|[x, y]| *x == 0 || *y == 0 || numbers.unit() < 0.8);
    let polygon: Vec<[f64; 2]> = corners
        .into_iter()
        .map(|corner| {
            let share = if numbers.unit() < outer_share { 1.0 } else { 0.5 };
            corner.map(|x| share * f64::from(x))
        })
        .collect();
    extruded(&polygon, 512.0, numbers)
}

/// A star with deep notches towards the origin that leave a core of this radius.
pub(crate) fn wedges(notches: usize, core: f64, numbers: &mut Numbers) -> Body {
    let n = 2 * notches;
    let polygon: Vec<[f64; 2]> = (0..n)
        .map(|i| {
            let (sin, cos) = (TAU * i as f64 / n as f64).sin_cos();
            let radius = if i % 2 == 0 { 1.0 + numbers.unit() } else { core };
            [radius * cos, radius * sin]
        })
        .collect();
    extruded(&polygon, 0.5, numbers)
}
