//! A vertex moved to where its tets are better on the whole, and none of them bad.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::quality::{ROUGH_EAS_ERROR, RoughStar};
use crate::geometry::vector::{add, norm, scale, sub};
use crate::kernel::{Change, Complex, VertexChange};
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
    star: RoughStar,
    qualities: Vec<f64>,
    tried: Vec<f64>,
    /// Where the vertex was in turn.
    places: Vec<Point>,
}

impl Relaxation {
    /// Proposes a place on its track for a vertex whose tets are `star` at which the sum of their [defects](defect) is lower and no quality is below `floor`. `false` when none was found.
    ///
    /// Steps down the gradient; qualities are exact at the end only.
    pub fn propose(
        &mut self,
        complex: &Complex,
        star: &[TetId],
        vertex: VertexId,
        floor: f64,
        track: &impl Track,
        change: &mut Change,
    ) -> bool {
        self.star.set(star.iter().map(|&t| (complex.corners(t), complex.place(t, vertex))));
        self.descend(complex, star, vertex, floor - ROUGH_EAS_ERROR, track);
        let before: f64 = star.iter().map(|&t| defect(complex.quality(t))).sum();
        change.clear();
        // Where a tet is below the floor after all, an earlier place.
        while let Some(place) = self.places.pop() {
            change.vertex = VertexChange::Move(vertex, place);
            change.fill.clear();
            for &tet in star {
                let vertices = complex.vertices(tet);
                if !change.push_above(complex, vertices, complex.region(tet), floor) {
                    break;
                }
            }
            let after: f64 = change.fill.iter().map(|tet| defect(tet.quality)).sum();
            if change.fill.len() == star.len() && change.worst() > floor && after < before {
                change.cavity.extend_from_slice(star);
                return true;
            }
        }
        false
    }

    /// Moves the vertex downhill, step by step, and leaves where it was.
    fn descend(&mut self, complex: &Complex, star: &[TetId], vertex: VertexId, floor: f64, track: &impl Track) {
        let start = complex.point(vertex);
        let lengths = star.iter().map(|&t| norm(sub(complex.corners(t)[(complex.place(t, vertex) + 1) % 4], start)));
        let size = lengths.sum::<f64>() / star.len().max(1) as f64;
        self.star.judge(start, &mut self.qualities);
        let mut sum: f64 = self.qualities.iter().map(|&q| defect(q)).sum();
        let (mut place, mut step) = (start, FIRST_STEP * size);
        self.places.clear();
        for _ in 0..MOST_STEPS {
            let gradient = track.along(self.gradient(place, DIFFERENCE * size));
            let steep = norm(gradient);
            if steep * size <= 1e-6 {
                return;
            }
            let mut found = None;
            for _ in 0..=MOST_HALVINGS {
                if let Some(trial) = track.draw(add(place, scale(gradient, -step / steep)))
                    && let Some(lower) = self.sum_at(trial, floor, sum)
                {
                    found = Some((trial, lower));
                    break;
                }
                step *= 0.5;
            }
            let Some((trial, lower)) = found else { return };
            std::mem::swap(&mut self.qualities, &mut self.tried);
            let gain = sum - lower;
            (place, sum) = (trial, lower);
            self.places.push(place);
            if gain < SMALLEST_GAIN * sum {
                return;
            }
        }
    }

    /// The sum with the vertex elsewhere, where it is below `bar` and no quality below `floor`.
    fn sum_at(&mut self, place: Point, floor: f64, bar: f64) -> Option<f64> {
        self.star.judge(place, &mut self.tried);
        let sum: f64 = self.tried.iter().map(|&q| defect(q)).sum();
        (sum < bar && self.tried.iter().all(|&q| q > floor)).then_some(sum)
    }

    fn gradient(&mut self, place: Point, step: f64) -> Point {
        let mut gradient = [0.0; 3];
        for axis in 0..3 {
            let mut beside = place;
            beside[axis] += step;
            self.star.judge(beside, &mut self.tried);
            let rises = self.qualities.iter().zip(&self.tried).map(|(&q, &there)| {
                let slope = -2.0 * (1.0 - q.min(1.0));
                slope * (there - q.min(1.0))
            });
            gradient[axis] = rises.sum::<f64>() / step;
        }
        gradient
    }
}
