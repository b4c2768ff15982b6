//! Decides what lies between triangles along each axis; everything else is outside of them all.

use crate::base::{Point, VertexId};
use crate::mesh::bounds;

/// Pixels along the longest side of the box.
const PIXELS: f64 = 512.0;

/// Three images of a surface, one along each axis: the lowest and highest extent of triangles at each pixel.
pub(super) struct Shadow {
    low: Point,
    pixel: f64,
    images: [Image; 3],
}

struct Image {
    along: usize,
    across: [usize; 2],
    counts: [usize; 2],
    spans: Vec<[f64; 2]>,
}

impl Shadow {
    pub(super) fn new(points: &[Point], triangles: &[[VertexId; 3]]) -> Self {
        let [low, high] = bounds(points).unwrap_or_default();
        let sides = [0, 1, 2].map(|i| high[i] - low[i]);
        let pixel = sides.iter().fold(0.0, |a: f64, b| a.max(*b)) / PIXELS;
        let images = [0, 1, 2].map(|along| {
            let across = [(along + 1) % 3, (along + 2) % 3];
            let counts = across.map(|axis| (sides[axis] / pixel) as usize + 1);
            let spans = vec![[f64::INFINITY, f64::NEG_INFINITY]; counts[0] * counts[1]];
            let mut image = Image { along, across, counts, spans };
            for triangle in triangles {
                let corner = |v: VertexId| [0, 1, 2].map(|i| (points[v.index()][i] - low[i]) / pixel);
                image.add(triangle.map(corner));
            }
            image
        });
        Self { low, pixel, images }
    }

    /// Whether some point of a box may lie between triangles along all three axes.
    pub(super) fn may_hold(&self, bounds: [Point; 2]) -> bool {
        let bounds = bounds.map(|p| [0, 1, 2].map(|i| (p[i] - self.low[i]) / self.pixel));
        self.images.iter().all(|image| image.may_hold(bounds))
    }
}

impl Image {
    /// The pixels between two positions along an axis of the image.
    fn pixels(&self, i: usize, from: f64, to: f64) -> std::ops::Range<usize> {
        from.floor().max(0.0) as usize..self.counts[i].min((to.floor() + 1.0).max(0.0) as usize)
    }

    /// Rasterises a triangle row by row: otherwise a needle across the image would fill all of it.
    fn add(&mut self, corners: [Point; 3]) {
        let [u, v] = self.across;
        let [low, high] = bounds(&corners).unwrap_or_default();
        for row in self.pixels(0, low[u], high[u]) {
            let [from, to] = within_row(corners, [u, v], row as f64);
            for column in self.pixels(1, from, to) {
                let span = &mut self.spans[row * self.counts[1] + column];
                *span = [span[0].min(low[self.along]), span[1].max(high[self.along])];
            }
        }
    }

    fn may_hold(&self, [low, high]: [Point; 2]) -> bool {
        let [u, v] = self.across;
        let meets = |[from, to]: [f64; 2]| from <= high[self.along] && low[self.along] <= to;
        self.pixels(0, low[u], high[u]).any(|row| {
            let columns = self.pixels(1, low[v], high[v]);
            columns.clone().any(|column| meets(self.spans[row * self.counts[1] + column]))
        })
    }
}

/// The extent of a triangle along `v` where `u` is between `row` and `row + 1`.
fn within_row(corners: [Point; 3], [u, v]: [usize; 2], row: f64) -> [f64; 2] {
    let mut span = [f64::INFINITY, f64::NEG_INFINITY];
    for (a, b) in [(0, 1), (1, 2), (2, 0)] {
        let [mut from, mut to] = [corners[a], corners[b]].map(|p| [p[u], p[v]]);
        if from[0] > to[0] {
            (from, to) = (to, from);
        }
        if to[0] < row || from[0] > row + 1.0 {
            continue;
        }
        let slope = (to[1] - from[1]) / (to[0] - from[0]);
        let at = |x: f64| if slope.is_finite() { from[1] + slope * (x - from[0]) } else { from[1] };
        let ends = [
            if from[0] < row { at(row) } else { from[1] },
            if to[0] > row + 1.0 { at(row + 1.0) } else { to[1] },
        ];
        span = ends.iter().fold(span, |[low, high], x| [low.min(*x), high.max(*x)]);
    }
    span
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Surface;
    use crate::mesh::shapes::ball;

    #[test]
    fn what_is_inside_is_between_and_the_corners_of_the_box_are_not() {
        let surface = Surface::boundary_of(&ball(6, 3));
        let shadow = Shadow::new(&surface.points, &surface.triangles);
        for p in ball(6, 3).points {
            assert!(shadow.may_hold([p, p]), "{p:?}");
        }
        for k in 0..8 {
            let p = [0, 1, 2].map(|i| if k >> i & 1 == 0 { -0.8 } else { 0.8 });
            assert!(!shadow.may_hold([p, p.map(|x| x + 1e-3)]));
            assert!(shadow.may_hold([[0.0; 3].map(|x: f64| x.min(p[0])), [0.9; 3]]));
        }
        assert!(!shadow.may_hold([[2.0; 3], [3.0; 3]]));
    }

    #[test]
    fn a_needle_across_the_picture_fills_its_own_pixels_alone() {
        let points = [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [1.0, 1.0, 0.999]];
        let shadow = Shadow::new(&points, &[[0, 1, 2].map(VertexId::new)]);
        let filled = shadow.images.map(|p| p.spans.iter().filter(|s| s[0] <= s[1]).count());
        assert!(filled.iter().all(|n| (500..3000).contains(n)), "{filled:?}");
    }
}
