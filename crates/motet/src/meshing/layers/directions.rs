//! The direction in which the layers rise at each vertex of a wall.
//!
//! It is the direction that sees all surrounding triangles best: among all directions, its smallest cosine
//! with any of their normals is the largest (Aubry and Löhner 2008, *On the 'most normal' normal*). It is the
//! axis of the smallest cone around the normals, found in the same way as the smallest sphere around points
//! (Welzl 1991). Where a wall ends at a flat part on which nothing grows, such as a cap, the direction lies
//! in that plane; where it ends at two, on their line of intersection.

use super::flats::unit;
use super::neighbors::NONE;
use super::skin::Skin;
use crate::base::{Csr, Point, Threads, VertexId};
use crate::geometry::vector::{across, add, cross, dot, norm, scale, sub};

/// The smallest cosine with which a wall may be seen, 78 degrees from its normal; below that, nothing grows.
const MIN_COSINE: f64 = 0.2;

/// The sine of the smallest angle at which two planes have a usable line of intersection.
const APART: f64 = 0.05;

/// The largest deviation of a further plane from the direction of such a line.
const ALONG: f64 = 1e-3;

/// How often directions are averaged with those of neighbours.
const SWEEPS: usize = 6;

/// The smallest fraction of the best direction's cosine that averaging may leave.
const KEPT: f64 = 0.9;

/// The rounding error of cosines.
const ROUNDING: f64 = 1e-14;

/// The directions in which a vertex may move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Freedom {
    Anywhere,
    /// In the plane with this normal.
    Plane(Point),
    /// Along this direction.
    Line(Point),
    Nowhere,
}

impl Freedom {
    /// The freedom that the flat parts around a vertex leave it.
    pub(super) fn of(skin: &Skin, vertex: VertexId) -> Self {
        let mut parts = Vec::new();
        for &t in skin.stars.list(vertex.index()).iter().filter(|&&t| !skin.has_stack(t)) {
            let part = skin.flats.of[t as usize];
            if part == NONE {
                return Self::Nowhere;
            }
            // A part without a normal continues the wall.
            if !parts.contains(&part) && skin.flats.normals[part as usize] != [0.0; 3] {
                parts.push(part);
            }
        }
        let normals: Vec<Point> = parts.iter().map(|&part| skin.flats.normals[part as usize]).collect();
        match normals[..] {
            _ if !skin.is_one_fan(vertex) => Self::Nowhere,
            [] => Self::Anywhere,
            [normal] => Self::Plane(normal),
            [a, b, ref others @ ..] => {
                let line = cross(a, b);
                let is_off = |&c: &Point| dot(unit(line), c).abs() > ALONG;
                if norm(line) < APART || others.iter().any(is_off) {
                    Self::Nowhere
                } else {
                    Self::Line(unit(line))
                }
            }
        }
    }

    /// The component of a vector in the free directions.
    pub(super) fn project(self, v: Point) -> Point {
        match self {
            Self::Anywhere => v,
            Self::Plane(normal) => across(v, normal),
            Self::Line(along) => scale(along, dot(v, along)),
            Self::Nowhere => [0.0; 3],
        }
    }
}

/// Unit directions, and the smallest cosine of each with an inward normal; zero where nothing can grow.
pub(super) struct Directions {
    pub(super) ways: Vec<Point>,
    pub(super) cosines: Vec<f64>,
}

impl Directions {
    /// Finds the directions; `around` lists the neighbours of each vertex along walls.
    pub(super) fn find(skin: &Skin, around: &Csr<VertexId>, threads: &Threads) -> Self {
        let found: Vec<(Point, f64, Freedom)> = threads.map(skin.points.len(), |w| {
            let vertex = VertexId::new(w);
            let normals = inward(skin, vertex);
            if normals.is_empty() {
                return ([0.0; 3], 0.0, Freedom::Nowhere);
            }
            let mut freedom = Freedom::of(skin, vertex);
            let (mut way, mut cosine) = best_with_cosine(&normals, freedom);
            if cosine < MIN_COSINE && skin.may_slant && freedom != Freedom::Nowhere {
                freedom = Freedom::Anywhere;
                (way, cosine) = best_with_cosine(&normals, freedom);
            }
            if cosine < MIN_COSINE { ([0.0; 3], 0.0, freedom) } else { (way, cosine, freedom) }
        });
        let mut all =
            Self { ways: found.iter().map(|f| f.0).collect(), cosines: found.iter().map(|f| f.1).collect() };
        for _ in 0..SWEEPS {
            all.ways = threads.map(found.len(), |w| {
                let sum = around.list(w).iter().fold(all.ways[w], |sum, v| add(sum, all.ways[v.index()]));
                let (way, best) = (unit(sum), found[w].1);
                let may_turn = found[w].2 == Freedom::Anywhere && best > 0.0;
                let is_seen = || least(&inward(skin, VertexId::new(w)), way) >= KEPT * best;
                if may_turn && is_seen() { way } else { all.ways[w] }
            });
        }
        for (w, cosine) in all.cosines.iter_mut().enumerate().filter(|(_, cosine)| **cosine > 0.0) {
            *cosine = least(&inward(skin, VertexId::new(w)), all.ways[w]);
        }
        all
    }
}

/// The inward normals of the walls around a vertex.
fn inward(skin: &Skin, vertex: VertexId) -> Vec<Point> {
    skin.walls(vertex).map(|t| scale(skin.normals[t as usize], -1.0)).collect()
}

fn least(normals: &[Point], way: Point) -> f64 {
    normals.iter().map(|&n| dot(n, way)).fold(f64::INFINITY, f64::min)
}

/// The free direction that sees the normals best, and its smallest cosine with any of them.
fn best_with_cosine(normals: &[Point], freedom: Freedom) -> (Point, f64) {
    let way = best(normals, freedom);
    (way, least(normals, way))
}

/// The free direction that sees the normals best; zero if there is none.
fn best(normals: &[Point], freedom: Freedom) -> Point {
    match freedom {
        Freedom::Anywhere => most_normal(normals),
        Freedom::Plane(plane) => most_normal_in(normals, plane),
        Freedom::Line(line) => {
            let back = scale(line, -1.0);
            if least(normals, line) >= least(normals, back) { line } else { back }
        }
        Freedom::Nowhere => [0.0; 3],
    }
}

/// The axis of the smallest cone around some normals: one of them, or determined by two or three.
fn most_normal(normals: &[Point]) -> Point {
    let is_in = |(way, cosine): (Point, f64), n: Point| dot(way, n) >= cosine - ROUNDING;
    let cone = |way: Point, n: Point| (way, dot(way, n));
    let mut found = (normals[0], 1.0);
    for (i, &a) in normals.iter().enumerate() {
        if is_in(found, a) {
            continue;
        }
        found = (a, 1.0);
        for (j, &b) in normals[..i].iter().enumerate() {
            if is_in(found, b) {
                continue;
            }
            found = cone(unit(add(a, b)), a);
            for &c in &normals[..j] {
                if !is_in(found, c) {
                    found = cone(axis(a, b, c), a);
                }
            }
        }
    }
    found.0
}

/// The direction with equal cosines to three normals.
fn axis(a: Point, b: Point, c: Point) -> Point {
    let way = unit(cross(sub(b, a), sub(c, a)));
    if dot(way, a) < 0.0 { scale(way, -1.0) } else { way }
}

/// The direction in a plane that sees the normals best: along one normal projected onto the plane, or halfway
/// between two.
fn most_normal_in(normals: &[Point], plane: Point) -> Point {
    let seen: Vec<Point> = normals.iter().map(|&n| across(n, plane)).collect();
    let mut found = (f64::NEG_INFINITY, [0.0; 3]);
    let mut consider = |way: Point| {
        let cosine = least(&seen, way);
        if cosine > found.0 + ROUNDING {
            found = (cosine, way);
        }
    };
    for (i, &a) in seen.iter().enumerate() {
        consider(unit(a));
        for &b in &seen[..i] {
            let halfway = unit(cross(plane, sub(a, b)));
            consider(halfway);
            consider(scale(halfway, -1.0));
        }
    }
    found.1
}
