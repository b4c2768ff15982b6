//! What tets of given surfaces promise, asked of them: every triangle is there, all fits, volumes, empty spheres.

use std::collections::{HashMap, HashSet};

use num_rational::BigRational;
use num_traits::{ToPrimitive, Zero};

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

/// More tets than this are summed in `f64`.
const MANY: usize = 20_000;

/// Bodies whose tets do not sum to what their surface encloses: to the last bit where no rounded point is on the surface and sums are exact, which they
/// are for all but very many tets.
pub(crate) fn volumes(triangles: &[Triangle], filled: &Constrained) -> Vec<String> {
    let n = filled.bodies.iter().max().map_or(0, |&b| b as usize + 1);
    let at = |v: VertexId| filled.points[v.index()];
    let is_small = filled.tets.len() < MANY;
    let six_times = |[a, b, c, d]: [Point; 4]| {
        if !is_small {
            return BigRational::from_float(6.0 * volume([a, b, c, d])).unwrap();
        }
        let exact = |x: f64| BigRational::from_float(x).unwrap();
        let from = |p: Point| [0, 1, 2].map(|i| exact(p[i]) - exact(a[i]));
        let [b, c, d] = [b, c, d].map(from);
        let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
        minor(1, 2) * &d[0] + minor(2, 0) * &d[1] + minor(0, 1) * &d[2]
    };
    let (mut of_tets, mut of_surface) = (vec![BigRational::zero(); n], vec![BigRational::zero(); n]);
    let mut size = vec![0.0; n];
    for (tet, &body) in filled.tets.iter().zip(&filled.bodies) {
        of_tets[body as usize] += six_times(tet.map(at));
    }
    let origin = filled.tets.first().map_or([0.0; 3], |t| at(t[0]));
    for (triangle, bodies) in triangles.iter().zip(&filled.triangle_to_bodies) {
        let [a, b, c] = triangle.map(at);
        let part = six_times([origin, a, b, c]);
        for (body, is_behind) in bodies.iter().zip([false, true]) {
            let Some(body) = *body else { continue };
            size[body as usize] += part.to_f64().unwrap().abs();
            of_surface[body as usize] += if is_behind { part.clone() } else { -part.clone() };
        }
    }
    let is_exact = is_small && filled.on_edges.is_empty() && filled.in_triangles.is_empty();
    let is_off = |b: &usize| {
        let off = (&of_tets[*b] - &of_surface[*b]).to_f64().unwrap().abs();
        let whole = of_surface[*b].to_f64().unwrap();
        off > if is_exact { 0.0 } else { 1e-10 * (whole + 1e-3 * size[*b]) }
    };
    let told = |b: usize| format!("body {b}: {:?} of {:?}", of_tets[b].to_f64(), of_surface[b].to_f64());
    (0..n).filter(is_off).map(told).collect()
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
