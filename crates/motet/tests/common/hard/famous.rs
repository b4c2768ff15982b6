//! Polyhedra that cannot be divided into tets without additional points: Schoenhardt's and Chazelle's.

use std::f64::consts::TAU;

use super::super::Numbers;
use super::body::{Body, area, ears};

/// A prism over a triangle whose top is rotated by this angle, above 0 and below 60 degrees (in radians),
/// with its sides cut along the diagonals that lie inside (Schoenhardt 1928). 30 degrees is the usual choice;
/// near 0 sides are nearly flat, near 60 diagonals nearly meet.
pub(crate) fn schoenhardt(twist: f64) -> Body {
    let corner = |angle: f64| [angle.cos(), angle.sin()];
    let [bottom, top] = [0.0, twist].map(|turn| [0, 1, 2].map(|i| corner(turn + TAU * f64::from(i) / 3.0)));
    let mut points = bottom.map(|[x, y]| [x, y, 0.0]).to_vec();
    points.extend(top.map(|[x, y]| [x, y, 1.0]));
    let mut triangles = vec![[0, 2, 1], [3, 4, 5]];
    for i in 0..3 {
        let next = (i + 1) % 3;
        triangles.extend([[i, next, next + 3], [i, next + 3, i + 3]]);
    }
    // Simpson's rule is exact for a prismatoid; the middle section is a hexagon of midpoints of edges.
    let half = |p: [f64; 2], q: [f64; 2]| [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])];
    let middle: Vec<_> =
        (0..3).flat_map(|i| [half(bottom[i], top[i]), half(bottom[i], top[(i + 1) % 3])]).collect();
    let volume = (area(&bottom) + 4.0 * area(&middle) + area(&top)) / 6.0;
    Body::new(points, &triangles, Some(volume))
}

/// A random angle; a third are near each end of the range, where the body is nearly degenerate.
pub(crate) fn random_twist(numbers: &mut Numbers) -> f64 {
    let (small, at) = (0.1f64.powi(2 + numbers.below(8) as i32), TAU / 6.0);
    match numbers.below(3) {
        0 => small,
        1 => at - small,
        _ => at * (0.1 + 0.8 * numbers.unit()),
    }
}

/// Half the width of a notch where it opens.
const HALF_WIDTH: f64 = 0.0625;

/// A block with `n` thin notches from below, across y, and `n` from above, across x, that end on the surfaces
/// z = x y and z = x y + `room` (Chazelle 1984): at least on the order of n^2 tets are needed.
pub(crate) fn chazelle(n: usize, room: f64) -> Body {
    let end = (n + 1) as f64;
    let (low, high) = (-1.0, end * end + 2.0);
    // A row of corners along one axis: `None` where a notch ends.
    let mut row = vec![(0.0, false)];
    for i in 1..=n {
        let x = i as f64;
        row.extend([(x - HALF_WIDTH, false), (x, true), (x + HALF_WIDTH, false)]);
    }
    row.push((end, false));
    let m = row.len();
    let mut points = Vec::new();
    for y in [0.0, end] {
        points.extend(row.iter().map(|&(x, is_notch)| [x, y, if is_notch { x * y } else { low }]));
    }
    for x in [0.0, end] {
        points.extend(row.iter().map(|&(y, is_notch)| [x, y, if is_notch { x * y + room } else { high }]));
    }
    let bottom = |side: usize, i: usize| side * m + i;
    let top = |side: usize, i: usize| (2 + side) * m + i;
    let mut triangles = Vec::new();
    for i in 0..m - 1 {
        let [a, b, c, d] = [bottom(0, i), bottom(1, i), bottom(1, i + 1), bottom(0, i + 1)];
        triangles.extend([[a, b, c], [a, c, d]]);
        let [a, b, c, d] = [top(0, i), top(1, i), top(1, i + 1), top(0, i + 1)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    let mut side = |corners: Vec<usize>, axis: usize, is_turned: bool| {
        let flat: Vec<_> = corners.iter().map(|&v| [points[v][axis], points[v][2]]).collect();
        let found = ears(&flat);
        triangles.extend(found.iter().map(|t| t.map(|i| corners[i])).map(|[a, b, c]| match is_turned {
            true => [a, c, b],
            false => [a, b, c],
        }));
    };
    for s in [0, 1] {
        // The sides of least and largest y: notches below, a straight edge above.
        let mut corners: Vec<usize> = (0..m).map(|i| bottom(s, i)).collect();
        corners.extend([top(1, s * (m - 1)), top(0, s * (m - 1))]);
        side(corners, 0, s == 1);
        // The sides of least and largest x: a straight edge below, notches above.
        let mut corners = vec![bottom(0, s * (m - 1)), bottom(1, s * (m - 1))];
        corners.extend((0..m).rev().map(|i| top(s, i)));
        side(corners, 1, s == 0);
    }
    Body::new(points, &triangles, None)
}
