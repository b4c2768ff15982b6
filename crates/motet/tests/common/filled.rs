//! What tets of given surfaces promise, asked of them: every triangle is there, all fits, volumes, empty spheres.

use std::collections::{HashMap, HashSet};

use motet::base::{Point, VertexId};
use motet::delaunay::{Constrained, EdgePoints};
use motet::geometry::predicates::insphere;
use motet::geometry::tet::{FACETS, volume};
use motet::geometry::triangle::area;
use motet::geometry::vector::distance;

pub(crate) type Triangle = [VertexId; 3];

fn rising(mut t: Triangle) -> Triangle {
    t.sort_unstable();
    t
}

/// What is wrong with a result, if anything.
pub(crate) fn faults(
    points: &[Point],
    triangles: &[Triangle],
    filled: &Constrained,
    rule: EdgePoints,
) -> Vec<String> {
    let mut faults = Vec::new();
    let at = |v: VertexId| filled.points[v.index()];
    if filled.points[..points.len()] != *points {
        faults.push("the points given are not the first ones".into());
    }
    let mut sides: HashMap<Triangle, Vec<(usize, VertexId)>> = HashMap::new();
    for (t, tet) in filled.tets.iter().enumerate() {
        for (i, facet) in FACETS.iter().enumerate() {
            sides.entry(rising(facet.map(|k| tet[k]))).or_default().push((t, tet[i]));
        }
    }
    let mut walls = HashSet::new();
    for (i, &triangle) in triangles.iter().enumerate() {
        let parts = filled.triangle_to_facets.list(i);
        let whole = area(triangle.map(at));
        let total: f64 = parts.iter().map(|p| area(p.map(at))).sum();
        let edge = (0..3).map(|k| distance(at(triangle[k]), at(triangle[(k + 1) % 3]))).fold(0.0, f64::max);
        let rounding = at(triangle[0]).iter().fold(0.0, |m: f64, x| m.max(x.abs())) * f64::EPSILON;
        if (total - whole).abs() > 1e-10 * edge * edge + 4.0 * rounding * edge * parts.len() as f64 {
            faults.push(format!("triangle {i}: {total} of {whole}"));
        }
        for &part in parts {
            walls.insert(rising(part));
            let n = filled.triangle_to_bodies[i].iter().filter(|b| b.is_some()).count();
            if sides.get(&rising(part)).map_or(0, Vec::len) != n {
                faults.push(format!("triangle {i}: a part with {n} bodies is not a facet of as many tets"));
            }
        }
    }
    for (facet, of) in &sides {
        match of[..] {
            [_] if walls.contains(facet) => {}
            [(s, _), (t, _)] if walls.contains(facet) || filled.bodies[s] == filled.bodies[t] => {}
            _ => faults.push(format!("facet {facet:?} of {} tets", of.len())),
        }
    }
    faults.extend(volumes(triangles, filled));
    if rule == EdgePoints::Stay {
        faults.extend(spheres(points.len(), filled, &sides, &walls));
    }
    faults
}

/// Bodies whose tets do not sum to what their surface encloses.
pub(crate) fn volumes(triangles: &[Triangle], filled: &Constrained) -> Vec<String> {
    let n = filled.bodies.iter().max().map_or(0, |&b| b as usize + 1);
    let (mut of_tets, mut of_surface, mut size) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
    let origin = filled.tets.first().map_or([0.0; 3], |t| filled.points[t[0].index()]);
    let from = |v: &VertexId| {
        let p = filled.points[v.index()];
        [0, 1, 2].map(|i| p[i] - origin[i])
    };
    for (tet, &body) in filled.tets.iter().zip(&filled.bodies) {
        of_tets[body as usize] += volume([0, 1, 2, 3].map(|k| from(&tet[k])));
    }
    for (triangle, bodies) in triangles.iter().zip(&filled.triangle_to_bodies) {
        let [a, b, c] = [0, 1, 2].map(|k| from(&triangle[k]));
        let part = volume([[0.0; 3], a, b, c]);
        for (body, sign) in bodies.iter().zip([-1.0, 1.0]) {
            if let Some(body) = body {
                of_surface[*body as usize] += sign * part;
                size[*body as usize] += part.abs();
            }
        }
    }
    let off =
        (0..n).filter(|&b| (of_tets[b] - of_surface[b]).abs() > 1e-10 * (of_tets[b].abs() + 1e-3 * size[b]));
    off.map(|b| format!("body {b}: {} of {}", of_tets[b], of_surface[b])).collect()
}

/// Facets between tets, not of the surface, with the one tet's vertex inside the sphere of the other (exact, so only without points on edges).
fn spheres(
    n: usize,
    filled: &Constrained,
    sides: &HashMap<Triangle, Vec<(usize, VertexId)>>,
    walls: &HashSet<Triangle>,
) -> Vec<String> {
    let is_given = |v: &VertexId| v.index() < n;
    let inner = sides.iter().filter(|(facet, of)| of.len() == 2 && !walls.contains(*facet));
    let bad = inner.filter(|(_, of)| {
        let (tet, other) = (filled.tets[of[0].0], of[1].1);
        let [a, b, c, d] = tet.map(|v| filled.points[v.index()]);
        tet.iter().all(is_given) && is_given(&other) && insphere(a, b, c, d, filled.points[other.index()]) > 0
    });
    bad.map(|(facet, _)| format!("facet {facet:?} is not Delaunay")).collect()
}
