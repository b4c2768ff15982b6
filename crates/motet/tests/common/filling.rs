//! Checks of what tets of given surfaces promise: every triangle is there, tets are conforming, volumes,
//! empty spheres.

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

/// The faults of a result, in words.
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
    faults.extend(volumes(points.len(), triangles, filled));
    if rule == EdgePoints::Stay {
        faults.extend(spheres(points.len(), filled, &sides, &walls));
    }
    faults
}

/// More tets than this are summed in `f64`.
const MANY: usize = 20_000;

/// The permitted distance of a rounded point from its edge or triangle, in units in the last place of the
/// largest coordinate.
const LAST_PLACES: f64 = 2.0;

type Exact = [BigRational; 3];

fn exact(p: Point) -> Exact {
    p.map(|x| BigRational::from_float(x).unwrap())
}

fn difference(a: &Exact, b: &Exact) -> Exact {
    std::array::from_fn(|i| &a[i] - &b[i])
}

fn cross(a: &Exact, b: &Exact) -> Exact {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

fn dot(a: &Exact, b: &Exact) -> BigRational {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn length(a: &Exact) -> f64 {
    dot(a, a).to_f64().unwrap().sqrt()
}

/// The points left on the surface, which follow the `n` given ones, with the distance of each from the line
/// of its edge or the plane of its triangle, caused by rounding.
fn off_surface(n: usize, triangles: &[Triangle], filled: &Constrained) -> Vec<(VertexId, f64)> {
    let at = |v: VertexId| exact(filled.points[v.index()]);
    let off_edge = |[a, b]: [VertexId; 2], v| {
        let along = difference(&at(b), &at(a));
        length(&cross(&along, &difference(&at(v), &at(a)))) / length(&along)
    };
    let off_triangle = |[a, b, c]: Triangle, v| {
        let normal = cross(&difference(&at(b), &at(a)), &difference(&at(c), &at(a)));
        dot(&normal, &difference(&at(v), &at(a))).to_f64().unwrap().abs() / length(&normal)
    };
    let vertex = |i: usize| VertexId((n + i) as u32);
    let on_edges = filled.on_edges.iter().enumerate().map(|(i, point)| (point.ends, vertex(i)));
    let in_triangles = filled.in_triangles.iter().enumerate();
    let in_triangles = in_triangles.map(|(i, point)| (point.triangle, vertex(filled.on_edges.len() + i)));
    let on_edges = on_edges.map(|(ends, v)| (v, off_edge(ends, v)));
    on_edges.chain(in_triangles.map(|(t, v)| (v, off_triangle(triangles[t as usize], v)))).collect()
}

/// Points left on the surface that are off by more than rounding, and bodies whose tets do not sum to the
/// volume that their surface encloses.
///
/// Sums are exact, except for very many tets. They are equal to the last bit where no rounded point is on the
/// surface; where there are some, they differ to first order by the distances of these points times a third
/// of the area of the facets there, and twice that is allowed.
pub(crate) fn volumes(n: usize, triangles: &[Triangle], filled: &Constrained) -> Vec<String> {
    let n_bodies = filled.bodies.iter().max().map_or(0, |&b| b as usize + 1);
    let at = |v: VertexId| filled.points[v.index()];
    let is_small = filled.tets.len() < MANY;
    let six_times = |[a, b, c, d]: [Point; 4]| {
        if !is_small {
            return BigRational::from_float(6.0 * volume([a, b, c, d])).unwrap();
        }
        let [a, b, c, d] = [a, b, c, d].map(exact);
        dot(&cross(&difference(&b, &a), &difference(&c, &a)), &difference(&d, &a))
    };
    let (mut of_tets, mut of_surface) =
        (vec![BigRational::zero(); n_bodies], vec![BigRational::zero(); n_bodies]);
    for (tet, &body) in filled.tets.iter().zip(&filled.bodies) {
        of_tets[body as usize] += six_times(tet.map(at));
    }
    let off = off_surface(n, triangles, filled);
    let reach = filled.points.as_flattened().iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let is_rounded = |&(_, off): &(VertexId, f64)| off <= LAST_PLACES * f64::EPSILON * reach;
    let mut faults: Vec<String> = off
        .iter()
        .filter(|left| !is_rounded(left))
        .map(|(v, off)| format!("point {v} lies {off} off the surface"))
        .collect();
    let off: HashMap<VertexId, f64> = off.into_iter().collect();
    let mut allowed = vec![0.0; n_bodies];
    let origin = filled.tets.first().map_or([0.0; 3], |t| at(t[0]));
    for (i, (triangle, bodies)) in triangles.iter().zip(&filled.triangle_to_bodies).enumerate() {
        let [a, b, c] = triangle.map(at);
        let part = six_times([origin, a, b, c]);
        let facets = filled.triangle_to_facets.list(i).iter();
        let rounding: f64 =
            facets.map(|f| 4.0 * area(f.map(at)) * f.iter().filter_map(|v| off.get(v)).sum::<f64>()).sum();
        for (body, is_behind) in bodies.iter().zip([false, true]) {
            let Some(body) = *body else { continue };
            of_surface[body as usize] += if is_behind { part.clone() } else { -part.clone() };
            allowed[body as usize] += if is_small { rounding } else { 1e-13 * part.to_f64().unwrap().abs() };
        }
    }
    for (body, allowed) in allowed.iter().enumerate() {
        let [made, given] = [&of_tets[body], &of_surface[body]];
        if (made - given).to_f64().unwrap().abs() > *allowed {
            faults.push(format!("body {body}: {:?} of {:?}", made.to_f64(), given.to_f64()));
        }
    }
    faults
}

/// Facets between tets, not on the surface, where the vertex of one tet is inside the sphere of the other
/// (tested exactly, so only without points on edges).
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
