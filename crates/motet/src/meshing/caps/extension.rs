//! A straight tube that continues a vessel beyond an open end, so that flow there is developed.
//!
//! Rows of vertices follow each other along the normal of the rim's plane. The cross-section goes over from
//! the rim to a circle of the same area within the first half of the length; the last row is flat.

use std::f64::consts::{PI, TAU};

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{add, cross, distance, dot, norm, scale, sub, unit};

/// The largest number of rows.
const MAX_ROWS: usize = 10_000;

/// The part of the length within which the cross-section becomes a circle.
const TRANSITION: f64 = 0.5;

/// An extension of one end.
#[derive(Clone, Debug)]
pub(super) struct Extension {
    length: f64,
    n_rows: usize,
    /// The patch of each triangle beside the rim, which those of the extension continue.
    patches: Vec<i32>,
}

/// The triangles of an extension, facing as the surface does, with their patches, and its last row.
pub(super) struct Rows {
    pub(super) triangles: Vec<[VertexId; 3]>,
    pub(super) patches: Vec<i32>,
    pub(super) last: Vec<VertexId>,
}

/// The middle of a rim and the unit normal of its plane.
#[derive(Clone, Copy)]
pub(super) struct RimFrame {
    pub(super) middle: Point,
    pub(super) normal: Point,
}

impl Extension {
    /// An extension of a rim whose edges have these patches; rows are as far apart as the rim's vertices.
    ///
    /// # Errors
    /// When the length is not above 0, or requires too many rows.
    pub(super) fn new(rim: &[Point], patches: Vec<i32>, length: f64) -> Result<Self> {
        if !(length > 0.0 && length.is_finite()) {
            return Err(Error::options(format!("the length of an extension must be above 0; got {length}")));
        }
        let next = rim.iter().cycle().skip(1);
        let edge = rim.iter().zip(next).map(|(p, q)| distance(*p, *q)).sum::<f64>() / rim.len() as f64;
        let n_rows = (length / edge).round().max(1.0);
        if n_rows.is_nan() || n_rows > MAX_ROWS as f64 {
            return Err(Error::options(format!(
                "an extension of length {length} has {n_rows} rows of triangles; at most {MAX_ROWS} are allowed"
            ))
            .remedy("give a shorter one"));
        }
        Ok(Self { length, n_rows: n_rows as usize, patches })
    }

    /// Adds the points of the rows, and returns the triangles.
    ///
    /// # Errors
    /// When the rim is not nearer to its plane than the extension is long.
    pub(super) fn build(&self, points: &mut Vec<Point>, rim: &[VertexId], frame: RimFrame) -> Result<Rows> {
        let corners: Vec<Point> = rim.iter().map(|v| points[v.index()]).collect();
        let highest = corners.iter().map(|&p| dot(sub(p, frame.middle), frame.normal)).fold(0.0, f64::max);
        if highest >= self.length {
            return Err(Error::input(format!(
                "the rim is up to {highest:.3e} beyond its plane, and the extension only {} long",
                self.length
            ))
            .remedy("give a longer extension, or a flatter rim"));
        }
        let circle = circle(&corners, frame);
        let n = rim.len();
        let (mut triangles, mut patches, mut row) = (Vec::new(), Vec::new(), rim.to_vec());
        for j in 1..=self.n_rows {
            let share = j as f64 / self.n_rows as f64;
            let first = points.len();
            points.extend(corners.iter().zip(&circle).map(|(&p, &q)| self.at(p, q, share, frame)));
            let next: Vec<VertexId> = (first..first + n).map(VertexId::new).collect();
            for i in 0..n {
                let [a, b, c, d] = [row[i], row[(i + 1) % n], next[(i + 1) % n], next[i]];
                match (i + j) % 2 {
                    0 => triangles.extend([[a, b, d], [b, c, d]]),
                    _ => triangles.extend([[a, b, c], [a, c, d]]),
                }
                patches.extend([self.patches[i]; 2]);
            }
            row = next;
        }
        Ok(Rows { triangles, patches, last: row })
    }

    /// The place above a vertex of the rim, at a share of the length; `on_circle` is its place in the last
    /// row, seen along the normal.
    fn at(&self, p: Point, on_circle: Point, share: f64, RimFrame { middle, normal }: RimFrame) -> Point {
        let offset = sub(p, middle);
        let height = dot(offset, normal);
        let lateral = sub(offset, scale(normal, height));
        let t = (share / TRANSITION).min(1.0);
        let round = t * t * (3.0 - 2.0 * t);
        let lateral = add(scale(lateral, 1.0 - round), scale(on_circle, round));
        add(add(middle, lateral), scale(normal, height * (1.0 - share) + self.length * share))
    }
}

/// For each vertex of a rim, its place on a circle of the same area around the origin, in the rim's plane:
/// as far along the circle as along the rim, and turned so that all are near their own places.
fn circle(corners: &[Point], RimFrame { middle, normal }: RimFrame) -> Vec<Point> {
    let lateral = |p: Point| {
        let offset = sub(p, middle);
        sub(offset, scale(normal, dot(offset, normal)))
    };
    let flat: Vec<Point> = corners.iter().map(|&p| lateral(p)).collect();
    let next = |i: usize| flat[(i + 1) % flat.len()];
    let area: f64 = (0..flat.len()).map(|i| 0.5 * dot(cross(flat[i], next(i)), normal)).sum();
    let radius = (area.abs() / PI).sqrt();
    let x = flat.iter().copied().find_map(unit).unwrap_or([1.0, 0.0, 0.0]);
    let y = cross(normal, x);
    let around: f64 = (0..flat.len()).map(|i| norm(sub(next(i), flat[i]))).sum();
    let mut along = 0.0;
    let angle = |i: usize| {
        let angle = TAU * along / around;
        along += norm(sub(next(i), flat[i]));
        angle
    };
    let angles: Vec<f64> = (0..flat.len()).map(angle).collect();
    // The turn that brings them nearest: the angle of the sum of all places turned back by their own angles.
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (p, angle) in flat.iter().zip(&angles) {
        let (u, v) = (dot(*p, x), dot(*p, y));
        cosine += u * angle.cos() + v * angle.sin();
        sine += v * angle.cos() - u * angle.sin();
    }
    let turn = sine.atan2(cosine);
    let on = |angle: &f64| {
        let (sine, cosine) = (angle + turn).sin_cos();
        scale(add(scale(x, cosine), scale(y, sine)), radius)
    };
    angles.iter().map(on).collect()
}
