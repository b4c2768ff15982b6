//! Bodies around a point or along a line: spiky stars, convex hulls, knots, coils.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use motet::base::{Point, Threads, VertexId};
use motet::delaunay::Triangulation;
use motet::geometry::tet::volume;
use motet::geometry::vector::{add, cross, dot, norm, scale};
use motet::mesh::Surface;
use motet::mesh::shapes::{Coil, wire};

use super::super::Numbers;
use super::body::Body;

/// Corners and triangles of an icosahedron, with each triangle divided into four this many times, projected
/// onto the unit sphere.
pub(crate) fn icosphere(times: usize) -> (Vec<Point>, Vec<[usize; 3]>) {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut points: Vec<Point> = Vec::new();
    for axis in 0..3 {
        for (s, t) in [(1.0, golden), (-1.0, golden), (1.0, -golden), (-1.0, -golden)] {
            let mut p = [0.0, s, t];
            p.rotate_right(axis);
            points.push(scale(p, 1.0 / norm(p)));
        }
    }
    // Corners are neighbours if their distance is minimal.
    let near = |i: usize, j: usize| i != j && dot(points[i], points[j]) > 0.4;
    let outward = |[i, j, k]: [usize; 3]| dot(points[i], cross(points[j], points[k])) > 0.0;
    let mut triangles = Vec::new();
    for i in 0..12 {
        for j in (i + 1..12).filter(|&j| near(i, j)) {
            for k in (j + 1..12).filter(|&k| near(i, k) && near(j, k)) {
                triangles.push(if outward([i, j, k]) { [i, j, k] } else { [i, k, j] });
            }
        }
    }
    for _ in 0..times {
        triangles = in_four(&mut points, &triangles);
    }
    (points, triangles)
}

fn in_four(points: &mut Vec<Point>, triangles: &[[usize; 3]]) -> Vec<[usize; 3]> {
    let mut middles = BTreeMap::new();
    let mut middle = |a: usize, b: usize| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let sum = add(points[a], points[b]);
            points.push(scale(sum, 1.0 / norm(sum)));
            points.len() - 1
        })
    };
    let divide = |&[a, b, c]: &[usize; 3]| {
        let [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
        [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
    };
    triangles.iter().flat_map(divide).collect()
}

/// A star-shaped body about the origin, with radii from `least` to 1.
pub(crate) fn star(times: usize, least: f64, numbers: &mut Numbers) -> Body {
    let (mut points, triangles) = icosphere(times);
    points.iter_mut().for_each(|p| *p = scale(*p, least + (1.0 - least) * numbers.unit()));
    Body::new(points, &triangles, None)
}

/// The convex hull of points, with the volume that their Delaunay tets fill.
fn hull(points: &[Point]) -> Body {
    let delaunay = Triangulation::new(points, &Threads::single()).expect("they span a volume");
    let filled = delaunay.tets().iter().map(|t| volume(t.map(|v| points[v.index()]))).sum();
    let triangles: Vec<_> = delaunay.hull().iter().map(|f| f.vertices.map(VertexId::index)).collect();
    let all = Body::new(points.to_vec(), &triangles, Some(filled));
    used(&all)
}

/// The body without points that no triangle uses.
fn used(body: &Body) -> Body {
    let mut ids = BTreeMap::new();
    let mut points = Vec::new();
    let mut new = |v: VertexId| {
        *ids.entry(v).or_insert_with(|| {
            points.push(body.points[v.index()]);
            points.len() - 1
        })
    };
    let triangles: Vec<_> = body.triangles.iter().map(|t| t.map(&mut new)).collect();
    Body::new(points, &triangles, body.volume)
}

pub(crate) fn hull_of_sphere(n: usize, numbers: &mut Numbers) -> Body {
    let mut on_sphere = || {
        let (z, turn) = (2.0 * numbers.unit() - 1.0, TAU * numbers.unit());
        let across = (1.0 - z * z).sqrt();
        [across * turn.cos(), across * turn.sin(), z]
    };
    hull(&(0..n).map(|_| on_sphere()).collect::<Vec<_>>())
}

pub(crate) fn hull_of_cube(n: usize, numbers: &mut Numbers) -> Body {
    hull(&(0..n).map(|_| [(); 3].map(|()| numbers.unit())).collect::<Vec<_>>())
}

/// The hull of points with integer coordinates: many in one plane, many on one sphere, some twice.
pub(crate) fn hull_of_lattice(n: usize, side: usize, numbers: &mut Numbers) -> Body {
    let mut points: Vec<Point> = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    points.extend((0..n).map(|_| [(); 3].map(|()| numbers.below(side) as f64)));
    hull(&points)
}

/// A closed tube along a knot on a torus that passes `2 p - 1` times through its hole while it goes around
/// twice.
pub(crate) fn knot(p: usize, steps: usize, around: usize) -> Body {
    let q = 2 * p - 1;
    let line: Vec<Point> = (0..steps)
        .map(|i| {
            let turn = TAU * i as f64 / steps as f64;
            let (sin, cos) = (q as f64 * turn).sin_cos();
            let (s, c) = (2.0 * turn).sin_cos();
            let radius = 2.0 + 0.8 * cos;
            [radius * c, radius * s, 0.8 * sin]
        })
        .collect();
    let segments: Vec<_> = (0..steps).map(|i| [i, (i + 1) % steps].map(VertexId::new)).collect();
    of_wire(&wire(&line, &segments, 0.12, around).expect("the line is sound"))
}

pub(crate) fn coil(turns: usize, steps: usize, around: usize) -> Body {
    let coil = Coil { centre: [0.0; 3], radius: 1.0, pitch: 0.5, turns: turns as f64, wire_radius: 0.2 };
    of_wire(&coil.mesh(steps, around).expect("the options are sound"))
}

fn of_wire(mesh: &motet::Mesh) -> Body {
    let surface = Surface::of(mesh);
    Body { points: surface.points, triangles: surface.triangles, ..Body::default() }
}
