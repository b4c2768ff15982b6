//! Which tets to divide: by place, by size, by an estimate for each tet.

use super::estimate::longest_edge;
use crate::base::{Point, TetId, Threads};
use crate::geometry::tet;
use crate::geometry::vector::distance;
use crate::mesh::TetMesh;
use crate::spatial::{Closest, NearestTriangle};

/// The tets for which `is_marked` returns true, in ascending order.
fn tets_where(
    mesh: &TetMesh,
    threads: &Threads,
    is_marked: impl Fn([Point; 4]) -> bool + Sync + Send,
) -> Vec<TetId> {
    let flags = threads.map(mesh.tets.len(), |t| is_marked(mesh.tets[t].map(|v| mesh.points[v.index()])));
    (0..).zip(flags).filter(|(_, is_marked)| *is_marked).map(|(t, _)| TetId(t)).collect()
}

/// Tets that come within `radius` of `centre`.
pub fn in_ball(mesh: &TetMesh, centre: Point, radius: f64, threads: &Threads) -> Vec<TetId> {
    let nearest = |corners| tet::at(corners, tet::closest(corners, centre));
    tets_where(mesh, threads, |corners| distance(nearest(corners), centre) <= radius)
}

/// Tets whose centre lies in a box with sides along the axes, borders included.
pub fn in_box(mesh: &TetMesh, [low, high]: [Point; 2], threads: &Threads) -> Vec<TetId> {
    tets_where(mesh, threads, |corners| {
        let centre = tet::centroid(corners);
        (0..3).all(|k| low[k] <= centre[k] && centre[k] <= high[k])
    })
}

/// Tets whose longest edge is longer than the size requested at their centre.
pub fn above_size(
    mesh: &TetMesh,
    size: impl Fn(Point) -> f64 + Sync + Send,
    threads: &Threads,
) -> Vec<TetId> {
    tets_where(mesh, threads, |corners| longest_edge(corners) > size(tet::centroid(corners)))
}

/// Tets whose longest edge is longer than `size` plus `growth` times their distance from a surface: small
/// edges at a device, larger ones away from it. The distance is measured from the tet to the point of the
/// surface nearest to its centre.
pub fn near_surface(
    mesh: &TetMesh,
    surface: &NearestTriangle,
    size: f64,
    growth: f64,
    threads: &Threads,
) -> Vec<TetId> {
    tets_where(mesh, threads, |corners| {
        let (longest, centre) = (longest_edge(corners), tet::centroid(corners));
        if longest <= size {
            return false;
        }
        // Surface points farther than this from the centre cannot affect the tet.
        let reach =
            if growth > 0.0 { (longest - size) / growth + radius(corners, centre) } else { f64::INFINITY };
        surface
            .closest_within(centre, reach)
            .is_some_and(|found| is_above_size(corners, [size, growth], &found))
    })
}

/// The largest distance of a corner from the centre.
fn radius(corners: [Point; 4], centre: Point) -> f64 {
    corners.into_iter().map(|corner| distance(corner, centre)).fold(0.0, f64::max)
}

/// Whether the longest edge of one tet exceeds `size` plus `growth` times its distance from a surface;
/// `found` is the surface point nearest to its centre.
pub(super) fn is_above_size(corners: [Point; 4], [size, growth]: [f64; 2], found: &Closest) -> bool {
    let longest = longest_edge(corners);
    let away = found.distance_squared.sqrt();
    // The distance of the tet lies between that of its centre less its radius and that of its centre: this
    // decides most cases.
    if longest > size + growth * away {
        return true;
    }
    if longest <= size + growth * (away - radius(corners, tet::centroid(corners))) {
        return false;
    }
    let nearest = tet::at(corners, tet::closest(corners, found.point));
    longest > size + growth * distance(nearest, found.point)
}

/// Tets with an estimate above 0 in descending order of estimate; ties in ascending order of id.
fn by_estimate(estimates: &[f64]) -> Vec<TetId> {
    let mut order: Vec<TetId> =
        (0..estimates.len()).filter(|&t| estimates[t] > 0.0).map(TetId::new).collect();
    order.sort_by(|a, b| estimates[b.index()].total_cmp(&estimates[a.index()]).then(a.cmp(b)));
    order
}

/// The fewest tets whose squared estimates sum to at least the given share of the total (Dörfler 1996, *A
/// convergent adaptive algorithm for Poisson's equation*). Among tets with equal estimates those with the
/// lowest ids are taken; tets with an estimate of 0 or NaN never are.
pub fn largest_share(estimates: &[f64], share: f64) -> Vec<TetId> {
    let mut order = by_estimate(estimates);
    let squared = |t: TetId| estimates[t.index()] * estimates[t.index()];
    let all: f64 = order.iter().rev().map(|t| squared(*t)).sum();
    let mut sum = 0.0;
    let n = order.iter().take_while(|t| {
        let is_short = sum < share * all;
        sum += squared(**t);
        is_short
    });
    let n = n.count();
    order.truncate(n);
    order.sort_unstable();
    order
}

/// The tets with the largest estimates, as many as bring the mesh to about `target` tets when divided. Each
/// adds seven tets; those added by cutting neighbours are not counted.
pub fn to_count(estimates: &[f64], target: usize) -> Vec<TetId> {
    let n = target.saturating_sub(estimates.len()).div_ceil(7);
    let mut order = by_estimate(estimates);
    order.truncate(n);
    order.sort_unstable();
    order
}
