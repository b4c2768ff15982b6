//! Wires as closed surfaces: round tubes along line segments, such as a braided stent or a coil given by its
//! nodes.

use std::f64::consts::TAU;

use crate::base::{Csr, Error, Point, Result, VertexId};
use crate::geometry::vector::{LARGEST, add, distance, dot, in_range, norm, scale, sub};
use crate::mesh::Mesh;
use crate::mesh::shapes::frames::{directions, frames};
use crate::mesh::shapes::labelled::surface_mesh;

/// The largest factor by which a ring is stretched where the wire bends.
const LARGEST_STRETCH: f64 = 2.0;

/// A chain of consecutive segments.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Chain {
    /// The vertices of the chain in order; the first of a closed chain is not repeated.
    pub vertices: Vec<VertexId>,
    /// Whether the last vertex is joined to the first.
    pub closed: bool,
}

/// Joins line segments into chains: first the open ones, from end to end, where an end is a point at which
/// other than two segments meet; then the closed ones. Duplicate segments count once, and segments from a
/// point to itself are left out. The order of the segments does not matter.
///
/// Panics if a segment names a point beyond `n_points`.
pub fn chains(n_points: usize, segments: &[[VertexId; 2]]) -> Vec<Chain> {
    let mut edges: Vec<[VertexId; 2]> =
        segments.iter().filter(|[a, b]| a != b).map(|&[a, b]| [a.min(b), a.max(b)]).collect();
    edges.sort_unstable();
    edges.dedup();
    let around =
        Csr::from_pairs(n_points, || (0u32..).zip(&edges).flat_map(|(e, edge)| edge.map(|v| (v.index(), e))));
    let mut used = vec![false; edges.len()];
    let mut found = Vec::new();
    let mut follow = |start: VertexId, used: &mut Vec<bool>, through_ends: bool| {
        for &first in around.list(start.index()) {
            if used[first as usize] {
                continue;
            }
            let (mut vertices, mut edge) = (vec![start], first as usize);
            let closed = loop {
                used[edge] = true;
                let at = vertices[vertices.len() - 1];
                let [a, b] = edges[edge];
                let next = if a == at { b } else { a };
                if next == start && through_ends {
                    break true;
                }
                vertices.push(next);
                let on = around.list(next.index());
                match on.iter().find(|e| !used[**e as usize]) {
                    Some(e) if on.len() == 2 => edge = *e as usize,
                    _ => break false,
                }
            };
            found.push(Chain { vertices, closed });
        }
    };
    for v in (0..n_points).filter(|&v| around.list(v).len() != 2) {
        follow(VertexId::new(v), &mut used, false);
    }
    for v in 0..n_points {
        follow(VertexId::new(v), &mut used, true);
    }
    found
}

/// A round tube of this radius with `around` sides along each chain of the segments, closed at its ends and
/// facing outward, as the patch `wire`. At bends its rings lie in the planes that halve the angle, stretched
/// so that the sides keep their distance from the line. Where wires cross or meet, so do their tubes.
///
/// # Errors
/// If a segment names a point that does not exist, has no length or an end that is not finite; if there are
/// no segments; if the radius is not positive, or there are fewer than three sides.
pub fn wire(points: &[Point], segments: &[[VertexId; 2]], radius: f64, around: usize) -> Result<Mesh> {
    check(points, segments, radius, around)?;
    let (mut out, mut triangles) = (Vec::new(), Vec::new());
    for chain in chains(points.len(), segments) {
        let line: Vec<Point> = chain.vertices.iter().map(|v| points[v.index()]).collect();
        let first = out.len();
        let at = |ring: usize, side: usize| VertexId::new(first + ring % line.len() * around + side % around);
        for (i, [u, v, _]) in frames(&line, chain.closed).into_iter().enumerate() {
            let stretch = stretch(directions(&line, chain.closed, i));
            for side in 0..around {
                let (sin, cos) = (TAU * side as f64 / around as f64).sin_cos();
                let offset = scale(add(scale(u, cos), scale(v, sin)), radius);
                out.push(add(line[i], stretch(offset)));
            }
        }
        let n_spans = line.len() - usize::from(!chain.closed);
        for ring in 0..n_spans {
            for side in 0..around {
                let [a, b] = [at(ring, side), at(ring, side + 1)];
                let [c, d] = [at(ring + 1, side + 1), at(ring + 1, side)];
                triangles.extend([[a, b, c], [a, c, d]]);
            }
        }
        if !chain.closed {
            let [start, end] = [0, 1].map(|k| VertexId::new(out.len() + k));
            out.extend([line[0], line[n_spans]]);
            for side in 0..around {
                triangles.push([start, at(0, side + 1), at(0, side)]);
                triangles.push([end, at(n_spans, side), at(n_spans, side + 1)]);
            }
        }
    }
    Ok(surface_mesh(out, &triangles, "wire"))
}

/// A function that lengthens offsets in the plane of a bend by one over the cosine of half its angle, up to
/// [`LARGEST_STRETCH`].
fn stretch([before, after]: [Point; 2]) -> impl Fn(Point) -> Point {
    let bend = sub(after, before);
    let length = norm(bend);
    let cosine = norm(add(before, after)) / 2.0;
    let (axis, more) = if length > 0.0 {
        (scale(bend, 1.0 / length), (1.0 / cosine).min(LARGEST_STRETCH) - 1.0)
    } else {
        ([0.0; 3], 0.0)
    };
    move |offset| add(offset, scale(axis, more * dot(offset, axis)))
}

fn check(points: &[Point], segments: &[[VertexId; 2]], radius: f64, around: usize) -> Result<()> {
    if !(radius > 0.0 && radius <= LARGEST) || around < 3 {
        return Err(Error::options(format!("a wire cannot have radius {radius} with {around} sides"))
            .remedy("give a radius larger than 0 and at least three sides"));
    }
    if segments.is_empty() {
        return Err(Error::input("no segments to make a wire of").remedy("give line segments between points"));
    }
    for (i, segment) in segments.iter().enumerate() {
        let refuse = |what: String| Err(Error::input(what).at(format!("segment {i}")).remedy("leave it out"));
        if let Some(v) = segment.iter().find(|v| v.index() >= points.len()) {
            return refuse(format!("refers to point {v}, but there are {} points", points.len()));
        }
        let [a, b] = segment.map(|v| points[v.index()]);
        if !in_range(a) || !in_range(b) {
            return refuse("has an end whose coordinates are not finite".into());
        }
        if distance(a, b) == 0.0 {
            return refuse("has no length".into());
        }
    }
    Ok(())
}
