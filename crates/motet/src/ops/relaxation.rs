//! A vertex moved to where its tets are better on the whole, and none of them bad.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::vector::{add, norm, scale, sub};
use crate::kernel::{Change, Complex, Fill, VertexChange};
use crate::ops::Track;

/// How far a tet is from regular: the square of what its quality lacks. Convex, so that of two tets the worse one counts for more.
#[inline]
pub fn defect(quality: f64) -> f64 {
    let lack = 1.0 - quality.min(1.0);
    lack * lack
}

/// How many directions are tried.
const MOST_STEPS: usize = 6;
/// How often a step is halved.
const MOST_HALVINGS: usize = 4;
/// The first step, as a part of the mean edge of the star.
const FIRST_STEP: f64 = 0.15;
/// The last step lowers the sum by less than this part of it.
const SMALLEST_GAIN: f64 = 0.01;
/// Gradients are differences over this part of the size of the star.
const DIFFERENCE: f64 = 1e-6;

/// Room for the star, used again and again.
#[derive(Clone, Debug, Default)]
pub struct Relaxation {
    tets: Vec<([Point; 4], usize, TetId)>,
    qualities: Vec<f64>,
    tried: Vec<f64>,
}

impl Relaxation {
    /// Proposes a place on its track for a vertex whose tets are `star` at which the sum of their [defects](defect) is lower and no quality is below `floor`. `false` when none was found.
    pub fn propose(
        &mut self,
        complex: &Complex,
        star: &[TetId],
        vertex: VertexId,
        floor: f64,
        track: &impl Track,
        change: &mut Change,
    ) -> bool {
        let start = complex.point(vertex);
        self.tets.clear();
        self.tets.extend(star.iter().map(|&t| (complex.corners(t), complex.place(t, vertex), t)));
        self.qualities.clear();
        self.qualities.extend(star.iter().map(|&t| complex.quality(t)));
        let lengths = self.tets.iter().map(|(points, place, _)| norm(sub(points[(place + 1) % 4], start)));
        let size = lengths.sum::<f64>() / star.len().max(1) as f64;
        let first: f64 = self.qualities.iter().map(|&q| defect(q)).sum();
        let (mut place, mut sum, mut step) = (start, first, FIRST_STEP * size);
        for _ in 0..MOST_STEPS {
            let gradient = track.along(self.gradient(complex, place, DIFFERENCE * size));
            let steep = norm(gradient);
            if steep * size <= 1e-6 {
                break;
            }
            let mut found = None;
            for _ in 0..=MOST_HALVINGS {
                if let Some(trial) = track.draw(add(place, scale(gradient, -step / steep)))
                    && let Some(lower) = self.sum_at(complex, trial, floor, sum)
                {
                    found = Some((trial, lower));
                    break;
                }
                step *= 0.5;
            }
            let Some((trial, lower)) = found else { break };
            std::mem::swap(&mut self.qualities, &mut self.tried);
            let gain = sum - lower;
            (place, sum) = (trial, lower);
            if gain < SMALLEST_GAIN * sum {
                break;
            }
        }
        if sum >= first {
            return false;
        }
        change.clear();
        change.vertex = VertexChange::Move(vertex, place);
        change.cavity.extend_from_slice(star);
        change.fill.extend(star.iter().zip(&self.qualities).map(|(&tet, &quality)| Fill {
            vertices: complex.vertices(tet),
            region: complex.region(tet),
            quality,
        }));
        true
    }

    /// The sum with the vertex elsewhere, where it is below `bar` and no quality below `floor`.
    fn sum_at(&mut self, complex: &Complex, place: Point, floor: f64, bar: f64) -> Option<f64> {
        self.tried.clear();
        let mut sum = 0.0;
        for &(mut points, corner, tet) in &self.tets {
            points[corner] = place;
            let quality = complex.judge(points, |i| complex.side(tet, i));
            if quality <= floor {
                return None;
            }
            sum += defect(quality);
            if sum >= bar {
                return None;
            }
            self.tried.push(quality);
        }
        Some(sum)
    }

    fn gradient(&self, complex: &Complex, place: Point, step: f64) -> Point {
        let mut gradient = [0.0; 3];
        for (&(mut points, corner, _), quality) in self.tets.iter().zip(&self.qualities) {
            let slope = -2.0 * (1.0 - quality.min(1.0));
            for axis in 0..3 {
                points[corner] = place;
                points[corner][axis] += step;
                gradient[axis] += slope * (complex.measure(points) - quality.min(1.0)) / step;
            }
        }
        gradient
    }
}
