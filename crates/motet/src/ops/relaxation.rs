//! Relaxation: a vertex is moved to where its tets are better as a whole, with none bad.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::quality::EasStar;
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
use crate::kernel::{Change, Complex, VertexChange};
use crate::ops::Track;

/// How far a tet is from regular: (1 - quality)^2. Convex, so that the worse of two tets counts for more.
#[inline]
pub fn defect(quality: f64) -> f64 {
    let lack = 1.0 - quality.min(1.0);
    lack * lack
}

/// The largest number of directions tried.
const MAX_STEPS: usize = 6;
/// The largest number of times a step is halved.
const MAX_HALVINGS: usize = 4;
/// Length of the first step, relative to the mean edge of the star.
const FIRST_STEP: f64 = 0.15;
/// A step that lowers the sum by less than this fraction is the last.
const SMALLEST_GAIN: f64 = 0.01;
/// Step of the difference quotients for gradients, relative to the size of the star.
const DIFFERENCE: f64 = 1e-6;

/// What a move has to achieve.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reach {
    /// Every quality has to stay above this.
    pub floor: f64,
    /// The sum of the defects has to fall by about this much or more.
    pub gain: f64,
}

/// Work arrays, reused from call to call.
#[derive(Clone, Debug, Default)]
pub struct Relaxation {
    here: View,
    in_pose: View,
    /// How the vertex moves in the other pose; `None` if there is no other pose.
    map: Option<LinearMap>,
    /// The successive positions of the vertex.
    places: Vec<Point>,
    /// Position of the vertex in the last proposal.
    place: Point,
}

/// The tets of a star in one pose.
#[derive(Clone, Debug, Default)]
struct View {
    star: EasStar,
    qualities: Vec<f64>,
    tried: Vec<f64>,
}

/// How a vertex moves in a second pose of its star when it moves here.
#[derive(Clone, Copy, Debug)]
struct LinearMap {
    from: Point,
    to: Point,
    /// Row i maps a shift here to coordinate i of the shift there.
    rows: [Point; 3],
}

impl LinearMap {
    /// The least-squares map that takes the edges of a vertex here to those there. `None` if the edges lie in
    /// a plane.
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
    /// Proposes a position on its track for a vertex with the tets `star` that achieves the [`Reach`]: the
    /// sum of their [defects](defect) is lower there, and every quality above the floor. If `pose` gives the
    /// position of each vertex in another pose, the sum of the defects there counts as much. Returns `false`
    /// if no position was found.
    ///
    /// Steps down the gradient; qualities in the other pose are approximate.
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
        if self.descend(complex, star, vertex, reach, track) < reach.gain {
            return false;
        }
        let before: f64 = star.iter().map(|&t| defect(complex.quality(t))).sum();
        // If a quality is not above the floor after all, by rounding, tries the previous position.
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

    /// The approximate position in the other pose of the vertex of the last proposal: given by the linear map
    /// that fits the star best. `None` if there is no other pose.
    pub fn place_in_pose(&self) -> Option<Point> {
        self.map.map(|map| map.at(self.place))
    }

    /// Moves the vertex downhill, step by step, and records its positions. Returns by how much the sum has
    /// fallen; stops when a convex sum could no longer fall by the required gain.
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
        for _ in 0..MAX_STEPS {
            let gradient = track.along(self.gradient(place, DIFFERENCE * size));
            let steep = norm(gradient);
            if steep * size <= 1e-6 {
                break;
            }
            let mut found = None;
            for _ in 0..=MAX_HALVINGS {
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

    /// The sum of the defects with the vertex at `place`; the qualities are left in `tried`. In the other
    /// pose tets need not be valid, and all invalid ones cost the same.
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
    /// The sum of the defects with the vertex at `place`, with no quality counted below `lowest`.
    fn sum_at(&mut self, place: Point, lowest: f64) -> f64 {
        self.star.judge(place, &mut self.tried);
        self.tried.iter().map(|&q| defect(q.max(lowest))).sum()
    }

    /// The first-order change of the sum from `qualities` to `tried`.
    fn rise(&self, lowest: f64) -> f64 {
        let of = |(&q, &there): (&f64, &f64)| {
            let (q, there) = (q.clamp(lowest, 1.0), there.max(lowest));
            -2.0 * (1.0 - q) * (there - q)
        };
        self.qualities.iter().zip(&self.tried).map(of).sum()
    }
}
