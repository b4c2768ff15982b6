//! The edge length at any place: the smallest that any triangle of the surface allows there.

use super::sizes::Grading;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::triangle;
use crate::geometry::vector::{add, cross, distance, dot, scale, sub};
use crate::spatial::{BoxTree, NearestTriangle, bounding_box};

/// The smallest sizes of triangles of a class agree within a factor of 2 to the power of the inverse of this.
const CLASSES_PER_OCTAVE: f64 = 4.0;

/// Sizes that grow from a surface; at two places they differ by at most `growth` times the distance.
pub(super) struct SizeField<'a> {
    growth: f64,
    largest: f64,
    points: &'a [Point],
    triangles: &'a [[VertexId; 3]],
    at_corners: Vec<[f64; 3]>,
    nearest: NearestTriangle,
    classes: Vec<Class>,
}

/// Triangles of similar size, of which only those near a place need to be examined.
struct Class {
    least: f64,
    triangles: Vec<u32>,
    tree: BoxTree,
}

impl<'a> SizeField<'a> {
    /// Builds the field from sizes at the corners of triangles.
    pub(super) fn new(
        points: &'a [Point],
        triangles: &'a [[VertexId; 3]],
        at_corners: Vec<[f64; 3]>,
        grading: &Grading,
        threads: &Threads,
    ) -> Self {
        let mut order: Vec<(i32, u32)> = at_corners.iter().map(class).zip(0..).collect();
        order.sort_unstable();
        let class = |same: &[(i32, u32)]| {
            let bounds = |t: &u32| bounding_box(triangles[*t as usize].map(|v| points[v.index()]));
            let triangles: Vec<u32> = same.iter().map(|of| of.1).collect();
            let least =
                triangles.iter().map(|t| least(&at_corners[*t as usize])).fold(f64::INFINITY, f64::min);
            Class { least, tree: BoxTree::new(&triangles.iter().map(bounds).collect::<Vec<_>>()), triangles }
        };
        let classes = order.chunk_by(|x, y| x.0 == y.0).map(class).collect();
        Self {
            growth: grading.growth,
            largest: grading.largest.unwrap_or(f64::INFINITY),
            points,
            triangles,
            nearest: NearestTriangle::new(points, triangles, threads),
            at_corners,
            classes,
        }
    }

    /// The size at a place.
    pub(super) fn at(&self, p: Point) -> f64 {
        let nearest =
            self.nearest.closest(p).map_or(f64::INFINITY, |found| self.of_triangle(found.triangle, p));
        let mut size = nearest.min(self.largest);
        for class in &self.classes {
            // The largest distance at which a triangle of this class can lower the size.
            let reach = (size - class.least) / self.growth;
            if reach <= 0.0 {
                continue;
            }
            let measure = |i: u32| {
                let size = self.of_triangle(class.triangles[i as usize] as usize, p);
                let reach = (size - class.least).max(0.0) / self.growth;
                Some((reach * reach, size))
            };
            let found = class.tree.nearest_within(p, reach * reach, measure);
            size = found.map_or(size, |(_, _, found)| found.min(size));
        }
        size
    }

    /// Whether the surface is closer to a place than `distance`.
    pub(super) fn is_near(&self, p: Point, distance: f64) -> bool {
        self.nearest.closest_within(p, distance).is_some()
    }

    /// The largest size anywhere, if limited.
    pub(super) fn largest(&self) -> Option<f64> {
        self.largest.is_finite().then_some(self.largest)
    }

    /// The median of the sizes of all triangles.
    pub(super) fn median(&self) -> f64 {
        let mut sizes: Vec<f64> = self.at_corners.iter().map(|at| at.iter().sum::<f64>() / 3.0).collect();
        let middle = sizes.len() / 2;
        let median = (!sizes.is_empty()).then(|| *sizes.select_nth_unstable_by(middle, f64::total_cmp).1);
        median.unwrap_or(self.largest).min(self.largest)
    }

    fn of_triangle(&self, triangle: usize, p: Point) -> f64 {
        let corners = self.triangles[triangle].map(|v| self.points[v.index()]);
        min_over_triangle(corners, self.at_corners[triangle], self.growth, p)
    }
}

fn least(sizes: &[f64; 3]) -> f64 {
    sizes[0].min(sizes[1]).min(sizes[2])
}

fn class(sizes: &[f64; 3]) -> i32 {
    (least(sizes).log2() * CLASSES_PER_OCTAVE).floor() as i32
}

/// The minimum of `size + growth * distance` from `p` over a triangle whose sizes are linear.
///
/// Where sizes vary along the triangle, the minimum is not at the point nearest to `p`: if the size has
/// gradient `m` along the triangle, it lies `height * m / sqrt(growth^2 - m^2)` from there towards smaller
/// sizes. If that is outside the triangle, the minimum lies on an edge, where the same holds.
fn min_over_triangle(corners: [Point; 3], sizes: [f64; 3], growth: f64, p: Point) -> f64 {
    let at = |weights: [f64; 3]| {
        let size = (0..3).map(|i| weights[i] * sizes[i]).sum::<f64>();
        size + growth * distance(triangle::at(corners, weights), p)
    };
    if sizes[0] == sizes[1] && sizes[1] == sizes[2] {
        return sizes[0] + growth * distance(triangle::at(corners, triangle::closest(corners, p)), p);
    }
    if let Some(weights) = min_inside(corners, sizes, growth, p) {
        return at(weights);
    }
    let edge = |i: usize| {
        let j = (i + 1) % 3;
        let share = min_on_edge([corners[i], corners[j]], [sizes[i], sizes[j]], growth, p);
        let mut weights = [0.0; 3];
        (weights[i], weights[j]) = (1.0 - share, share);
        at(weights)
    };
    edge(0).min(edge(1)).min(edge(2))
}

/// The weights of the minimum in the plane of the triangle, if it lies in the triangle.
fn min_inside([a, b, c]: [Point; 3], sizes: [f64; 3], growth: f64, p: Point) -> Option<[f64; 3]> {
    let (u, v, w) = (sub(b, a), sub(c, a), sub(p, a));
    let normal = cross(u, v);
    let square = dot(normal, normal);
    let gradient = add(
        scale(cross(v, normal), (sizes[1] - sizes[0]) / square),
        scale(cross(normal, u), (sizes[2] - sizes[0]) / square),
    );
    let rest = growth * growth - dot(gradient, gradient);
    let height = dot(w, normal).abs() / square.sqrt();
    let place = sub(w, scale(gradient, height / rest.sqrt()));
    let to_b = dot(cross(place, v), normal) / square;
    let to_c = dot(cross(u, place), normal) / square;
    let weights = [1.0 - to_b - to_c, to_b, to_c];
    // NaN weights do not count as inside.
    (rest > 0.0 && weights.iter().all(|x| *x >= 0.0)).then_some(weights)
}

/// The position of the minimum along an edge, in [0, 1].
fn min_on_edge([a, b]: [Point; 2], sizes: [f64; 2], growth: f64, p: Point) -> f64 {
    let (edge, to) = (sub(b, a), sub(p, a));
    let length = dot(edge, edge).sqrt();
    let slope = (sizes[1] - sizes[0]) / length;
    if slope.abs() >= growth {
        return if slope > 0.0 { 0.0 } else { 1.0 };
    }
    let foot = dot(to, edge) / length;
    let height = (dot(to, to) - foot * foot).max(0.0).sqrt();
    let share = (foot - slope * height / (growth * growth - slope * slope).sqrt()) / length;
    if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Point> {
        prop::array::uniform3(-1.0..1.0f64)
    }

    /// The minimum over a fine grid of points of the triangle.
    fn by_sampling(corners: [Point; 3], sizes: [f64; 3], growth: f64, p: Point) -> f64 {
        const N: usize = 60;
        let all =
            (0..=N).flat_map(|i| (0..=N - i).map(move |j| [i, j, N - i - j].map(|k| k as f64 / N as f64)));
        let at = |w: [f64; 3]| {
            (0..3).map(|i| w[i] * sizes[i]).sum::<f64>() + growth * distance(triangle::at(corners, w), p)
        };
        all.map(at).fold(f64::INFINITY, f64::min)
    }

    proptest! {
        #[test]
        fn the_minimum_over_a_triangle_is_what_sampling_finds(
            corners in prop::array::uniform3(point()),
            sizes in prop::array::uniform3(0.1..0.6f64),
            growth in 0.1..0.7f64,
            p in point(),
        ) {
            let found = min_over_triangle(corners, sizes, growth, p);
            let seen = by_sampling(corners, sizes, growth, p);
            prop_assert!(found <= seen + 1e-12, "{found} {seen}");
            prop_assert!(found >= seen - 0.1, "{found} {seen}");
        }

        #[test]
        fn sizes_grow_no_faster_than_requested_and_are_the_least_of_all_triangles(
            points in prop::collection::vec(point(), 9),
            sizes in prop::collection::vec(0.01..1.0f64, 9),
            places in prop::array::uniform2(point()),
            growth in 0.1..0.7f64,
        ) {
            let ids: [usize; 9] = std::array::from_fn(|i| i);
            let triangles: Vec<_> =
                ids.as_chunks::<3>().0.iter().map(|t| t.map(VertexId::new)).collect();
            let at_corners: Vec<_> = triangles.iter().map(|t| t.map(|v| sizes[v.index()])).collect();
            let grading = Grading { growth, largest: Some(0.8), ..Grading::default() };
            let field = SizeField::new(&points, &triangles, at_corners.clone(), &grading, &Threads::single());
            let found = places.map(|p| field.at(p));
            prop_assert!((found[0] - found[1]).abs() <= growth * distance(places[0], places[1]) + 1e-12);
            let all = (0..3).map(|i| field.of_triangle(i, places[0])).fold(0.8, f64::min);
            prop_assert!((found[0] - all).abs() <= 1e-12 * all, "{} {all}", found[0]);
        }
    }
}
