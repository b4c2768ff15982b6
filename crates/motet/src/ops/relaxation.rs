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

/// Room for the star, used again and again.
#[derive(Clone, Debug, Default)]
pub struct Relaxation {
    /// Where the tets are, and then in poses.
    views: Vec<View>,
    /// Where the vertex was in turn.
    places: Vec<Point>,
    /// Where the vertex of the last proposal is to be in each pose.
    places_in_poses: Vec<Point>,
}

/// The tets of a star at one time.
#[derive(Clone, Debug, Default)]
struct View {
    star: RoughStar,
    qualities: Vec<f64>,
    tried: Vec<f64>,
    /// How the vertex moves there; `None`: this is where it is.
    map: Option<Second>,
}

/// A second place at which the tets of a star count as much as where they are, and how the vertex moves there.
#[derive(Clone, Copy, Debug)]
struct Second {
    from: Point,
    place: Point,
    /// Rows: how each coordinate there follows those here.
    map: [Point; 3],
}

impl Second {
    /// The linear map that takes the edges of a vertex here to those there, with the least squares of what is left. Where they lie in a plane: none.
    fn of(from: Point, place: Point, edges: impl Iterator<Item = [Point; 2]>) -> Option<Self> {
        let (mut normal, mut right) = ([[0.0; 3]; 3], [[0.0; 3]; 3]);
        for [here, there] in edges {
            for i in 0..3 {
                for j in 0..3 {
                    normal[i][j] += here[i] * here[j];
                    right[i][j] += there[i] * here[j];
                }
            }
        }
        let [a, b, c] = normal;
        let adjugate = [cross(b, c), cross(c, a), cross(a, b)];
        let determinant = dot(a, adjugate[0]);
        let trace = a[0] + b[1] + c[2];
        // The normal matrix is symmetric, and so is its inverse.
        let inverse = adjugate.map(|row| scale(row, 1.0 / determinant));
        let is_sound = determinant > 1e-9 * trace * trace * trace;
        is_sound.then(|| Self { from, place, map: right.map(|row| inverse.map(|column| dot(row, column))) })
    }

    fn at(&self, place: Point) -> Point {
        let shift = sub(place, self.from);
        add(self.place, self.map.map(|row| dot(row, shift)))
    }
}

impl Relaxation {
    /// Proposes a place on its track for a vertex whose tets are `star` at which the sum of their [defects](defect) is lower and no quality is below `floor`. With so many poses, and a map
    /// that says where vertices are in each, the sums of their defects there count as much. `false` when none was found.
    ///
    /// Steps down the gradient; qualities are exact at the end only, and those in poses not even then.
    pub fn propose(
        &mut self,
        (complex, (n_poses, pose)): (&Complex, (usize, Option<impl Fn(usize, VertexId) -> Point>)),
        star: &[TetId],
        vertex: VertexId,
        floor: f64,
        track: &impl Track,
        change: &mut Change,
    ) -> bool {
        self.views.resize(1 + n_poses, View::default());
        self.views[0].star.set(star.iter().map(|&t| (complex.corners(t), complex.place(t, vertex))));
        change.clear();
        if let Some(pose) = pose {
            for (i, view) in self.views[1..].iter_mut().enumerate() {
                let corners = |t: TetId| complex.vertices(t).map(|v| pose(i, v));
                view.star.set(star.iter().map(|&t| (corners(t), complex.place(t, vertex))));
                let start = [complex.point(vertex), pose(i, vertex)];
                let others = star.iter().flat_map(|&t| complex.vertices(t)).filter(|&v| v != vertex);
                let edge = |v: VertexId| [sub(complex.point(v), start[0]), sub(pose(i, v), start[1])];
                view.map = Second::of(start[0], start[1], others.map(edge));
                if view.map.is_none() {
                    return false;
                }
            }
        }
        self.descend(complex, star, vertex, floor - ROUGH_EAS_ERROR, track);
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
            let is_better = n_poses > 0 || after < before;
            if change.fill.len() == star.len() && change.worst() > floor && is_better {
                change.cavity.extend_from_slice(star);
                self.places_in_poses.clear();
                let maps = self.views.iter().filter_map(|view| view.map);
                self.places_in_poses.extend(maps.map(|map| map.at(place)));
                return true;
            }
        }
        false
    }

    /// About where the vertex of the last proposal is to be in each pose: as the linear map that is nearest to the star's has it.
    pub fn places_in_poses(&self) -> &[Point] {
        &self.places_in_poses
    }

    /// Moves the vertex downhill, step by step, and leaves where it was.
    fn descend(
        &mut self,
        complex: &Complex,
        star: &[TetId],
        vertex: VertexId,
        floor: f64,
        track: &impl Track,
    ) {
        let start = complex.point(vertex);
        let edge = |&t: &TetId| sub(complex.corners(t)[(complex.place(t, vertex) + 1) % 4], start);
        let size = star.iter().map(|t| norm(edge(t))).sum::<f64>() / star.len().max(1) as f64;
        let mut sum = self.sum_at(start);
        self.take_tried();
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
                if let Some(trial) = track.draw(add(place, scale(gradient, -step / steep))) {
                    let lower = self.sum_at(trial);
                    if lower < sum && self.views[0].tried.iter().all(|&q| q > floor) {
                        found = Some((trial, lower));
                        break;
                    }
                }
                step *= 0.5;
            }
            let Some((trial, lower)) = found else { return };
            self.take_tried();
            let gain = sum - lower;
            (place, sum) = (trial, lower);
            self.places.push(place);
            if gain < SMALLEST_GAIN * sum {
                return;
            }
        }
    }

    fn take_tried(&mut self) {
        self.views.iter_mut().for_each(|view| std::mem::swap(&mut view.qualities, &mut view.tried));
    }

    /// The sum with the vertex elsewhere; the qualities are left in `tried`.
    fn sum_at(&mut self, place: Point) -> f64 {
        self.views.iter_mut().map(|view| view.sum_at(place)).sum()
    }

    fn gradient(&mut self, place: Point, step: f64) -> Point {
        let mut gradient = [0.0; 3];
        for axis in 0..3 {
            let mut beside = place;
            beside[axis] += step;
            self.sum_at(beside);
            gradient[axis] = self.views.iter().map(View::rise).sum::<f64>() / step;
        }
        gradient
    }
}

impl View {
    /// No quality counts as lower: in a pose tets need not be valid, and one is as bad as another.
    fn lowest(&self) -> f64 {
        if self.map.is_some() { 0.0 } else { f64::NEG_INFINITY }
    }

    fn sum_at(&mut self, place: Point) -> f64 {
        self.star.judge(self.map.map_or(place, |map| map.at(place)), &mut self.tried);
        let lowest = self.lowest();
        self.tried.iter().map(|&q| defect(q.max(lowest))).sum()
    }

    /// By how much the sum rises from the qualities to those tried, to first order.
    fn rise(&self) -> f64 {
        let lowest = self.lowest();
        let of = |(&q, &there): (&f64, &f64)| {
            let (q, there) = (q.clamp(lowest, 1.0), there.max(lowest));
            -2.0 * (1.0 - q) * (there - q)
        };
        self.qualities.iter().zip(&self.tried).map(of).sum()
    }
}
