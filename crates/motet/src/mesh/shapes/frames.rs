//! Frames along a curve that do not twist, and bending of shapes built along z onto a curve.

use crate::base::{Error, Point, Result};
use crate::geometry::vector::{add, cross, distance, dot, in_range, norm, scale, sub};

/// Two directions across the curve and the one along it: orthonormal, right-handed.
pub(super) type Frame = [Point; 3];

/// A frame without twist at each point of a polyline: each is the previous one rotated no more than
/// necessary. Computed by double reflection (Wang, Juettler, Zheng and Liu 2008), with an error of fourth
/// order in the step against the exact frame of the smooth curve. For a closed line, the angle by which the
/// last frame misses the first is spread evenly.
///
/// Points must be finite, and consecutive points distinct.
pub(super) fn frames(points: &[Point], closed: bool) -> Vec<Frame> {
    let n = points.len();
    let tangents: Vec<Point> = (0..n).map(|i| tangent(points, closed, i)).collect();
    let mut across = vec![any_across(tangents[0])];
    for i in 1..n + usize::from(closed) {
        let step = sub(points[i % n], points[i - 1]);
        let once = |v: Point| reflected(v, step);
        across.push(reflected(once(across[i - 1]), sub(tangents[i % n], once(tangents[i - 1]))));
    }
    let missed = if closed { turn(across[0], across[n], tangents[0]) } else { 0.0 };
    (0..n)
        .map(|i| {
            let (along, u) = (tangents[i], across[i]);
            let v = cross(along, u);
            let (sin, cos) = (-missed * i as f64 / n as f64).sin_cos();
            let turned = add(scale(u, cos), scale(v, sin));
            [turned, cross(along, turned), along]
        })
        .collect()
}

/// The directions of the segments before and after a point of a polyline, as unit vectors; at an end both are
/// the same.
pub(super) fn directions(points: &[Point], closed: bool, i: usize) -> [Point; 2] {
    let n = points.len();
    let unit = |from: usize, to: usize| {
        let step = sub(points[to], points[from]);
        scale(step, 1.0 / norm(step))
    };
    let before = (i > 0 || closed).then(|| unit((i + n - 1) % n, i));
    let after = (i + 1 < n || closed).then(|| unit(i, (i + 1) % n));
    [before.or(after), after.or(before)].map(|d| d.unwrap_or([0.0, 0.0, 1.0]))
}

fn tangent(points: &[Point], closed: bool, i: usize) -> Point {
    let [before, after] = directions(points, closed, i);
    let sum = add(before, after);
    let length = norm(sum);
    // If the line turns back on itself, there is no mean direction.
    if length > 1e-6 { scale(sum, 1.0 / length) } else { after }
}

/// A unit vector perpendicular to another.
pub(super) fn any_across(along: Point) -> Point {
    let least = (0..3).min_by(|&i, &j| along[i].abs().total_cmp(&along[j].abs())).unwrap_or(0);
    let mut axis = [0.0; 3];
    axis[least] = 1.0;
    let across = sub(axis, scale(along, along[least]));
    scale(across, 1.0 / norm(across))
}

/// `v` reflected in the plane perpendicular to `normal`; unchanged if `normal` is zero.
pub(super) fn reflected(v: Point, normal: Point) -> Point {
    let squared = dot(normal, normal);
    if squared == 0.0 { v } else { sub(v, scale(normal, 2.0 * dot(normal, v) / squared)) }
}

/// The angle from one direction to another, about `along`.
pub(super) fn turn(from: Point, to: Point, along: Point) -> f64 {
    dot(cross(from, to), along).atan2(dot(from, to))
}

/// A curve, as a polyline, onto which shapes built along z can be bent.
#[derive(Clone, Debug)]
pub struct CenterLine {
    points: Vec<Point>,
    frames: Vec<Frame>,
    /// The length of the line up to each point.
    arc: Vec<f64>,
}

impl CenterLine {
    /// A polyline through these points. The more of them, the smoother a bent shape.
    ///
    /// # Errors
    /// If there are fewer than two points, one is not finite, or two consecutive ones coincide.
    pub fn new(points: &[Point]) -> Result<Self> {
        check_line(points)?;
        let mut arc = vec![0.0];
        for pair in points.windows(2) {
            arc.push(arc[arc.len() - 1] + distance(pair[0], pair[1]));
        }
        Ok(Self { points: points.to_vec(), frames: frames(points, false), arc })
    }

    /// The length of the line.
    pub fn length(&self) -> f64 {
        self.arc[self.arc.len() - 1]
    }

    /// The image of a point of a shape built along z: z becomes the length along the line, x and y are
    /// measured across it, in a frame that does not twist. Beyond both ends the map continues straight.
    ///
    /// Shapes do not intersect themselves as long as no bend of the line is narrower than they are wide.
    pub fn place(&self, [x, y, z]: Point) -> Point {
        let last = self.points.len() - 2;
        let i = self.arc.partition_point(|&s| s <= z).saturating_sub(1).min(last);
        let share = (z - self.arc[i]) / (self.arc[i + 1] - self.arc[i]);
        let across = |i: usize| {
            let [u, v, _] = self.frames[i];
            add(scale(u, x), scale(v, y))
        };
        if !(0.0..=1.0).contains(&share) {
            let end = if share < 0.0 { i } else { i + 1 };
            let on = add(self.points[end], scale(self.frames[end][2], z - self.arc[end]));
            return add(on, across(end));
        }
        let at = |i: usize| add(self.points[i], across(i));
        add(scale(at(i), 1.0 - share), scale(at(i + 1), share))
    }

    /// The images of all points of a shape: see [`Self::place`].
    pub fn bent(&self, points: &[Point]) -> Vec<Point> {
        points.iter().map(|p| self.place(*p)).collect()
    }
}

/// Checks that points can be a polyline.
fn check_line(points: &[Point]) -> Result<()> {
    if points.len() < 2 {
        return Err(Error::input(format!(
            "a line needs at least two points, but there are {}",
            points.len()
        ))
        .remedy("give the centre line as a list of points"));
    }
    if let Some(i) = points.iter().position(|p| !in_range(*p)) {
        return Err(Error::input(format!("has the coordinates {:?}", points[i]))
            .at(format!("point {i} of the line"))
            .remedy("give finite numbers"));
    }
    match points.windows(2).position(|pair| distance(pair[0], pair[1]) == 0.0) {
        None => Ok(()),
        Some(i) => Err(Error::input("coincides with the point before it")
            .at(format!("point {} of the line", i + 1))
            .remedy("leave out repeated points")),
    }
}
