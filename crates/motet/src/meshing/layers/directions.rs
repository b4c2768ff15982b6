//! Which way the layers rise at each vertex of a wall.
//!
//! The direction is the one that sees all triangles around best: of all, its least cosine with one of their normals is the largest (Aubry and
//! Löhner 2008, *On the 'most normal' normal*). It is the axis of the smallest cone around the normals, and found as the smallest sphere
//! around points is (Welzl 1991). Where a wall ends at something flat on which nothing grows, a cap, the direction lies in that plane;
//! where it ends at two, on their line.

use super::flats::unit;
use super::neighbors::NONE;
use super::skin::Skin;
use crate::base::{Csr, Point, Threads, VertexId};
use crate::geometry::vector::{across, add, cross, dot, norm, scale, sub};

/// The least cosine with which a wall may be seen: 78 degrees from its normal. Below, nothing grows.
const LEAST_COSINE: f64 = 0.2;

/// Sine of the least angle at which two planes have a line that is worth sliding on.
const APART: f64 = 0.05;

/// How far off a line's direction a further plane may be.
const ALONG: f64 = 1e-3;

/// How often directions are blended with those around.
const SWEEPS: usize = 6;

/// What is left at least, when directions are blended, of the cosine that the best direction has.
const KEPT: f64 = 0.9;

/// Rounding of cosines.
const ROUNDING: f64 = 1e-14;

/// How a vertex may move.
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
    /// How the flat parts around a vertex let it move.
    pub(super) fn of(skin: &Skin, vertex: VertexId) -> Self {
        let mut parts = Vec::new();
        for &t in skin.stars.list(vertex.index()).iter().filter(|&&t| !skin.has_stack(t)) {
            let part = skin.flats.of[t as usize];
            if part == NONE {
                return Self::Nowhere;
            }
            if !parts.contains(&part) {
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

    /// The part of a vector that is free.
    pub(super) fn project(self, v: Point) -> Point {
        match self {
            Self::Anywhere => v,
            Self::Plane(normal) => across(v, normal),
            Self::Line(along) => scale(along, dot(v, along)),
            Self::Nowhere => [0.0; 3],
        }
    }
}

/// Directions of length 1, and the least cosine of each with a normal into the body; zero where nothing can grow.
pub(super) struct Directions {
    pub(super) ways: Vec<Point>,
    pub(super) cosines: Vec<f64>,
}

impl Directions {
    /// `around` has the neighbors of each vertex along walls.
    pub(super) fn find(skin: &Skin, around: &Csr<VertexId>, threads: &Threads) -> Self {
        let found: Vec<(Point, f64, Freedom)> = threads.map(skin.points.len(), |w| {
            let vertex = VertexId::new(w);
            let normals = inward(skin, vertex);
            if normals.is_empty() {
                return ([0.0; 3], 0.0, Freedom::Nowhere);
            }
            let freedom = Freedom::of(skin, vertex);
            let way = best(&normals, freedom);
            let cosine = least(&normals, way);
            if cosine < LEAST_COSINE { ([0.0; 3], 0.0, freedom) } else { (way, cosine, freedom) }
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

/// The normals of the walls around a vertex, into the body.
fn inward(skin: &Skin, vertex: VertexId) -> Vec<Point> {
    skin.walls(vertex).map(|t| scale(skin.normals[t as usize], -1.0)).collect()
}

fn least(normals: &[Point], way: Point) -> f64 {
    normals.iter().map(|&n| dot(n, way)).fold(f64::INFINITY, f64::min)
}

/// The direction that sees the normals best, of those that are free; zero where none is.
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

/// The axis of the smallest cone around some normals: one of them, between two, or amid three.
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

/// The direction with one cosine to three normals.
fn axis(a: Point, b: Point, c: Point) -> Point {
    let way = unit(cross(sub(b, a), sub(c, a)));
    if dot(way, a) < 0.0 { scale(way, -1.0) } else { way }
}

/// The same among the directions in a plane: it is that of a normal, seen in the plane, or halfway between two.
fn most_normal_in(normals: &[Point], plane: Point) -> Point {
    let seen: Vec<Point> = normals.iter().map(|&n| across(n, plane)).collect();
    let mut found = (f64::NEG_INFINITY, [0.0; 3]);
    let mut look = |way: Point| {
        let cosine = least(&seen, way);
        if cosine > found.0 + ROUNDING {
            found = (cosine, way);
        }
    };
    for (i, &a) in seen.iter().enumerate() {
        look(unit(a));
        for &b in &seen[..i] {
            let halfway = unit(cross(plane, sub(a, b)));
            look(halfway);
            look(scale(halfway, -1.0));
        }
    }
    found.1
}
