//! Several surfaces: nested, nearly touching, or sharing corners, edges and facets.

use std::collections::BTreeSet;

use motet::base::VertexId;
use motet::geometry::vector::scale;

use super::super::Numbers;
use super::body::{Body, cuboid};
use super::round;

/// `n` boxes, each inside the one before; every second is turned inward.
pub(crate) fn nested(n: usize) -> Body {
    let box_of = |i: usize| {
        let half = (n - i) as f64;
        let body = cuboid([-half; 3], [half; 3]);
        if i.is_multiple_of(2) { body } else { body.turned_inside_out() }
    };
    (1..n).fold(box_of(0), |all, i| all.with(&box_of(i)))
}

/// Plates on top of each other with gaps of this size.
pub(crate) fn plates(n: usize, room: f64, numbers: &mut Numbers) -> Body {
    let (mut all, mut low) = (cuboid([0.0; 3], [1.0, 1.0, 0.25]), 0.25);
    for _ in 0..n {
        let from = low + room * (1.0 + numbers.unit());
        low = from + 0.25;
        let size = 0.5 + numbers.unit();
        all = all.with(&cuboid([0.0, 0.25 * numbers.unit(), from], [size, size, low]));
    }
    all
}

/// A tet in a box that shares one to three of its corners: a corner, an edge, or a facet.
pub(crate) fn tet_in_box(shared: usize, numbers: &mut Numbers) -> Body {
    let mut body = cuboid([0.0; 3], [1.0; 3]);
    let shell = body.triangles[numbers.below(12)].map(VertexId::index);
    let mut tet: Vec<usize> = shell[..shared].to_vec();
    // In general position relative to each other and to corners and edges of the box.
    let inner = [[0.5, 0.5, 0.5], [0.625, 0.53125, 0.5625], [0.5, 0.6875, 0.53125]];
    for p in &inner[..4 - shared] {
        tet.push(body.points.len());
        body.points.push(*p);
    }
    let corners = [0, 1, 2, 3].map(|i| body.points[tet[i]]);
    let volume = motet::geometry::tet::volume(corners);
    if volume < 0.0 {
        tet.swap(2, 3);
    }
    // As a hole, with facets that face inward.
    let holes = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]].map(|t| t.map(|i: usize| VertexId::new(tet[i])));
    let is_new = |t: &[VertexId; 3]| !t.iter().all(|v| shell.contains(&v.index()));
    body.triangles.extend(holes.into_iter().filter(is_new));
    if shared == 3 {
        return Body { has_membranes: true, ..body };
    }
    body.volume = body.volume.map(|v| v - volume.abs());
    body
}

/// Boxes that meet in an edge, in a corner, or in a whole side, with their corners shared.
pub(crate) fn boxes_in_touch(numbers: &mut Numbers) -> Body {
    let corner = [0, 1, 2].map(|_| (1 + numbers.below(8)) as f64);
    let zero = [0.0; 3];
    let first = cuboid(zero, corner);
    match numbers.below(3) {
        0 => first.with(&cuboid(corner, scale(corner, 2.0))).welded(),
        1 => {
            let [x, y, z] = corner;
            let other = cuboid([x, y, 0.0], [2.0 * x, 3.0 * y, z]);
            let third = cuboid([-1.0, -2.0, 0.0], [0.0, 0.0, z]);
            first.with(&other).with(&third).welded()
        }
        _ => {
            let [x, y, z] = corner;
            let mut both = first.with(&cuboid([x, 0.0, 0.0], [3.0 * x, y, z])).welded();
            both.has_membranes = true;
            drop_twins(&mut both);
            both
        }
    }
}

/// Drops all but the first of the triangles with the same corners.
fn drop_twins(body: &mut Body) {
    let mut seen = BTreeSet::new();
    body.triangles.retain(|t| {
        let mut corners = *t;
        corners.sort_unstable();
        seen.insert(corners)
    });
}

/// A spiky body, turned inward, in a larger copy of itself; between them lies a thin shell.
pub(crate) fn star_in_star(numbers: &mut Numbers) -> Body {
    let outer = round::star(1 + numbers.below(3), 0.2, numbers);
    let mut inner = outer.clone();
    let share = 1.0 - 0.5f64.powi(1 + numbers.below(20) as i32);
    inner.points.iter_mut().for_each(|p| *p = scale(*p, share));
    outer.with(&inner.turned_inside_out())
}
