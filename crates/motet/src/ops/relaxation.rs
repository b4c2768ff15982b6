//! A vertex moved to where its tets are better on the whole, and none of them bad.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::quality::{ROUGH_EAS_ERROR, RoughStar};
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
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

/// What a move has to reach.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reach {
    /// No quality is to be below this.
    pub floor: f64,
    /// By about this or more the sum of the defects is to be lower.
    pub gain: f64,
}

/// Room for the star, used again and again.
#[derive(Clone, Debug, Default)]
pub struct Relaxation {
    here: View,
    in_pose: View,
    /// How the vertex moves in the other pose; `None`: that does not count.
    map: Option<LinearMap>,
    /// Where the vertex was in turn.
    places: Vec<Point>,
    /// Where the vertex of the last proposal is.
    place: Point,
}

/// The tets of a star in one place.
#[derive(Clone, Debug, Default)]
struct View {
    star: RoughStar,
    qualities: Vec<f64>,
    tried: Vec<f64>,
}

/// How a vertex moves in a second place of its star, as it moves here.
#[derive(Clone, Copy, Debug)]
struct LinearMap {
    from: Point,
    to: Point,
    /// How each coordinate there follows those here.
    rows: [Point; 3],
}

impl LinearMap {
    /// Takes the edges of a vertex here to those there, with the least squares of what is left. `None` where they lie in a plane.
    fn of(from: Point, to: Point, edges: impl Iterator<Item = [Point; 2]>) -> Option<Self> {
        let (mut normal, mut right) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for [here, there] in edges {
            for i in 0..3 {
                normal[i] = add(normal[i], scale(here, here[i]));
                right[i] = add(right[i], scale(here, there[i]));
            }
        }
        let [a, b, c] = normal;
        let adjugate = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = dot(a, adjugate[0]);
        let trace = a[0] + b[1] + c[2];
        // The normal matrix is symmetric, and so is its inverse.
        let inverse = adjugate.map(|row| scale(row, 1.0 / determinant));
        let is_sound = determinant > 1e-9 * trace * trace * trace;
        is_sound.then(|| Self { from, to, rows: right.map(|row| inverse.map(|column| dot(row, column))) })
    }

    fn at(&self, place: Point) -> Point {
        let shift = sub(place, self.from);
        add(self.to, self.rows.map(|row| dot(row, shift)))
    }
}

impl Relaxation {
    /// Proposes a place on its track for a vertex whose tets are `star` that has the [`Reach`]: the sum of their [defects](defect) is lower there, and no quality below the floor. With a map that says where each
    /// vertex is in the other pose, the sum of their defects there counts as much. `false` when none was found.
    ///
    /// Steps down the gradient; qualities are exact at the end only, and those in the other pose not even then.
    pub fn propose(
        &mut self,
        (complex, pose): (&Complex, Option<impl Fn(VertexId) -> Point>),
        star: &[TetId],
        vertex: VertexId,
        reach: Reach,
        track: &impl Track,
        change: &mut Change,
    ) -> bool {
        change.clear();
        self.here.star.set(star.iter().map(|&t| (complex.corners(t), complex.place(t, vertex))));
        self.map = None;
        if let Some(pose) = pose {
            let corners = |t: TetId| complex.vertices(t).map(&pose);
            self.in_pose.star.set(star.iter().map(|&t| (corners(t), complex.place(t, vertex))));
            let [from, to] = [complex.point(vertex), pose(vertex)];
            let others = star.iter().flat_map(|&t| complex.vertices(t)).filter(|&v| v != vertex);
            let edges = others.map(|v| [sub(complex.point(v), from), sub(pose(v), to)]);
            self.map = LinearMap::of(from, to, edges);
            if self.map.is_none() {
                return false;
            }
        }
        let floor = reach.floor;
        let rough = Reach { floor: floor - ROUGH_EAS_ERROR, ..reach };
        if self.descend(complex, star, vertex, rough, track) < reach.gain {
            return false;
        }
        let before: f64 = star.iter().map(|&t| defect(complex.quality(t))).sum();
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
            let is_better = self.map.is_some() || after < before;
            if change.fill.len() == star.len() && change.worst() > floor && is_better {
                change.cavity.extend_from_slice(star);
                self.place = place;
                return true;
            }
        }
        false
    }

    /// About where the vertex of the last proposal is to be in the other pose: as the linear map that is nearest to the star's has it. `None` where that does not count.
    pub fn place_in_pose(&self) -> Option<Point> {
        self.map.map(|map| map.at(self.place))
    }

    /// Moves the vertex downhill, step by step, and leaves where it was. By how much the sum is lower; stops where it cannot be by the gain of the reach, if it is convex.
    fn descend(
        &mut self,
        complex: &Complex,
        star: &[TetId],
        vertex: VertexId,
        reach: Reach,
        track: &impl Track,
    ) -> f64 {
        let start = complex.point(vertex);
        let edge = |&t: &TetId| sub(complex.corners(t)[(complex.place(t, vertex) + 1) % 4], start);
        let size = star.iter().map(|t| norm(edge(t))).sum::<f64>() / star.len().max(1) as f64;
        let mut sum = self.sum_at(start);
        self.take_tried();
        let (mut place, mut step, mut gain) = (start, FIRST_STEP * size, 0.0);
        self.places.clear();
        for _ in 0..MOST_STEPS {
            let gradient = track.along(self.gradient(place, DIFFERENCE * size));
            let steep = norm(gradient);
            if steep * size <= 1e-6 {
                break;
            }
            let mut found = None;
            for _ in 0..=MOST_HALVINGS {
                if gain + step * steep < reach.gain {
                    break;
                }
                if let Some(trial) = track.draw(add(place, scale(gradient, -step / steep))) {
                    let lower = self.sum_at(trial);
                    if lower < sum && self.here.tried.iter().all(|&q| q > reach.floor) {
                        found = Some((trial, lower));
                        break;
                    }
                }
                step *= 0.5;
            }
            let Some((trial, lower)) = found else { break };
            self.take_tried();
            let gained = sum - lower;
            (place, sum, gain) = (trial, lower, gain + gained);
            self.places.push(place);
            if gained < SMALLEST_GAIN * sum {
                break;
            }
        }
        gain
    }

    fn take_tried(&mut self) {
        for view in [&mut self.here, &mut self.in_pose] {
            std::mem::swap(&mut view.qualities, &mut view.tried);
        }
    }

    /// The sum with the vertex elsewhere; the qualities are left in `tried`. In the other pose tets need not be valid, and one that is not is as bad as another.
    fn sum_at(&mut self, place: Point) -> f64 {
        let here = self.here.sum_at(place, f64::NEG_INFINITY);
        here + self.map.map_or(0.0, |map| self.in_pose.sum_at(map.at(place), 0.0))
    }

    fn gradient(&mut self, place: Point, step: f64) -> Point {
        let mut gradient = [0.0; 3];
        for axis in 0..3 {
            let mut beside = place;
            beside[axis] += step;
            self.sum_at(beside);
            let in_pose = self.map.map_or(0.0, |_| self.in_pose.rise(0.0));
            gradient[axis] = (self.here.rise(f64::NEG_INFINITY) + in_pose) / step;
        }
        gradient
    }
}

impl View {
    /// The sum of the defects with the vertex at a place, no quality counted as lower than `lowest`.
    fn sum_at(&mut self, place: Point, lowest: f64) -> f64 {
        self.star.judge(place, &mut self.tried);
        self.tried.iter().map(|&q| defect(q.max(lowest))).sum()
    }

    /// By how much the sum rises from the qualities to those tried, to first order.
    fn rise(&self, lowest: f64) -> f64 {
        let of = |(&q, &there): (&f64, &f64)| {
            let (q, there) = (q.clamp(lowest, 1.0), there.max(lowest));
            -2.0 * (1.0 - q) * (there - q)
        };
        self.qualities.iter().zip(&self.tried).map(of).sum()
    }
}
