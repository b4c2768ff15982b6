//! Three arms that meet, as triangles on an implicit surface: branching vessels, or a sac on a vessel.
//!
//! ```text
//!      \    |    /
//!       \   |   /
//!   arm  \  |  /
//!         \ | /
//!          (P)------
//!         /
//! ```
//!
//! Seen from above: the arms lie in one plane. Between each two of them a curve runs over the surface from
//! the pole above the middle to the pole below it. Two of the three curves are the first ring of an arm;
//! further rings lead to its end. All points are then projected onto the surface and spaced evenly.

use std::f64::consts::{PI, TAU};

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{add, cross, dot, scale};
use crate::mesh::disc::disc;
use crate::mesh::shapes::even_out::{Implicit, even_out};

const UP: Point = [0.0, 0.0, 1.0];

/// An arm from the origin, in the plane of x and y.
#[derive(Clone, Copy)]
pub(super) struct Arm {
    /// The direction of the arm at the origin as an angle in radians; arms are given counter-clockwise.
    pub(super) heading: f64,
    /// The change of its direction per unit of length; 0 is straight.
    pub(super) curvature: f64,
    pub(super) length: f64,
    /// Radius at its end.
    pub(super) radius: f64,
    /// Whether it ends in a flat disc; otherwise it ends in a round tip, which is part of the wall.
    pub(super) has_cap: bool,
}

impl Arm {
    /// The point on its axis at a fraction of its length, and the directions up, left and along there.
    fn axis(&self, share: f64) -> (Point, [Point; 3]) {
        let (from, s) = (self.heading, share * self.length);
        let to = from + self.curvature * s;
        let [x, y] = match self.curvature {
            0.0 => [s * from.cos(), s * from.sin()],
            k => [(to.sin() - from.sin()) / k, (from.cos() - to.cos()) / k],
        };
        let along = [to.cos(), to.sin(), 0.0];
        ([x, y, 0.0], [UP, cross(UP, along), along])
    }

    /// The position of a vertex of a ring, blended from the first ring into a circle with the radius of the
    /// end.
    fn place(&self, share: f64, angle: f64, first: Point) -> Point {
        let (_, start) = self.axis(0.0);
        let (centre, frame) = self.axis(share);
        let circle = [self.radius * angle.cos(), self.radius * angle.sin(), 0.0];
        (0..3).fold(centre, |p, k| {
            let offset = (1.0 - share) * dot(first, start[k]) + share * circle[k];
            add(p, scale(frame[k], offset))
        })
    }
}

/// The triangulated surface of three arms.
pub(super) struct Junction {
    pub(super) points: Vec<Point>,
    pub(super) wall: Vec<[VertexId; 3]>,
    /// The cap of each arm; empty where it has none.
    pub(super) caps: [Vec<[VertexId; 3]>; 3],
}

/// Triangulates three arms that meet at the origin, on this surface; every ring has `around` vertices, an
/// even number.
///
/// # Errors
/// If the end of an arm is not a circle, since the arm is too short, or too near another.
pub(super) fn junction<F: Fn(Point) -> f64>(
    arms: [Arm; 3],
    surface: &Implicit<F>,
    around: usize,
) -> Result<Junction> {
    let mut points = middle(&arms, surface, around / 2);
    let (mut wall, mut ends) = (Vec::new(), [const { Vec::new() }; 3]);
    let mut rims: Vec<VertexId> = Vec::new();
    for (i, arm) in arms.iter().enumerate() {
        let end = rings(arm, &first_ring(i, around / 2), &mut points, &mut wall);
        if arm.has_cap {
            check_circle(surface, &points, &end)?;
            rims.extend(&end);
        } else {
            wall.extend(disc(&mut points, &end));
        }
        ends[i] = end;
    }
    let mut is_fixed = vec![false; points.len()];
    rims.iter().for_each(|v| is_fixed[v.index()] = true);
    for (p, _) in points.iter_mut().zip(&is_fixed).filter(|(_, is_fixed)| !**is_fixed) {
        *p = surface.project(*p);
    }
    even_out(surface, &mut points, &mut wall, &is_fixed);
    let caps = [0, 1, 2].map(|i| match arms[i].has_cap {
        true => disc(&mut points, &ends[i]),
        false => Vec::new(),
    });
    Ok(Junction { points, wall, caps })
}

/// The two poles, and the inner vertices of the three curves between them, each curve in `half` steps.
fn middle<F: Fn(Point) -> f64>(arms: &[Arm; 3], surface: &Implicit<F>, half: usize) -> Vec<Point> {
    let reach = arms.iter().fold(0.0, |most: f64, arm| most.max(arm.length));
    let mut points = vec![surface.exit_point(UP, reach), surface.exit_point(scale(UP, -1.0), reach)];
    for i in 0..3 {
        let (from, to) = (arms[i].heading, arms[(i + 1) % 3].heading);
        let between = from + 0.5 * (to - from).rem_euclid(TAU);
        points.extend((1..half).map(|step| {
            let (sin, cos) = (PI * step as f64 / half as f64).sin_cos();
            surface.exit_point([sin * between.cos(), sin * between.sin(), cos], reach)
        }));
    }
    points
}

/// The first ring of arm `i`: curve `i`, left of it, from the upper pole to the lower one, then the curve
/// right of it, back.
fn first_ring(i: usize, half: usize) -> Vec<VertexId> {
    let inner = |curve: usize, step: usize| VertexId::new(2 + curve % 3 * (half - 1) + step - 1);
    let left = (1..half).map(|step| inner(i, step));
    let right = (1..half).rev().map(|step| inner(i + 2, step));
    std::iter::once(VertexId(0)).chain(left).chain([VertexId(1)]).chain(right).collect()
}

/// Adds the rings of an arm and the triangles between them. Returns the last ring, counter-clockwise seen
/// from beyond the arm.
fn rings(
    arm: &Arm,
    first: &[VertexId],
    points: &mut Vec<Point>,
    wall: &mut Vec<[VertexId; 3]>,
) -> Vec<VertexId> {
    let n = first.len();
    let n_rings = ((arm.length * n as f64 / (TAU * arm.radius)).round() as usize).max(2);
    let starts: Vec<Point> = first.iter().map(|v| points[v.index()]).collect();
    let mut below = first.to_vec();
    for ring in 1..=n_rings {
        let share = ring as f64 / n_rings as f64;
        let above: Vec<VertexId> = (0..n).map(|i| VertexId::new(points.len() + i)).collect();
        points.extend((0..n).map(|i| arm.place(share, TAU * i as f64 / n as f64, starts[i])));
        for i in 0..n {
            let next = (i + 1) % n;
            wall.extend([[below[i], above[i], above[next]], [below[i], above[next], below[next]]]);
        }
        below = above;
    }
    below.reverse();
    below
}

/// Checks that the rim of a cap lies on the surface.
///
/// # Errors
/// If a vertex of the rim does not.
fn check_circle<F: Fn(Point) -> f64>(
    surface: &Implicit<F>,
    points: &[Point],
    rim: &[VertexId],
) -> Result<()> {
    let is_off = |v: &VertexId| (surface.function)(points[v.index()]).abs() > 1e-9 * surface.size;
    if rim.iter().any(is_off) {
        return Err(Error::options("the end of a vessel is not round, since another vessel is too near")
            .remedy("make it longer, turn it away, or blend less"));
    }
    Ok(())
}
