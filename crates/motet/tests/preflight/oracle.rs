//! Faults of surfaces by brute force, in rational numbers, by methods that the library does not use.

use std::collections::{BTreeMap, BTreeSet};

use motet::base::{Point, VertexId};
use motet::preflight::{FaultKind, Role};
use num_rational::BigRational;
use num_traits::{Signed, Zero};

type Exact = [BigRational; 3];
type Triangle = [VertexId; 3];

/// A fault as the library reports it, without its place.
pub(crate) type FaultKey = (FaultKind, bool, u32, Vec<u32>, Vec<VertexId>);

pub(crate) fn exact(p: Point) -> Exact {
    p.map(|x| BigRational::from_float(x).expect("coordinates are finite"))
}

fn sub(a: &Exact, b: &Exact) -> Exact {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

fn cross(a: &Exact, b: &Exact) -> Exact {
    [0, 1, 2].map(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        &a[i] * &b[j] - &a[j] * &b[i]
    })
}

fn dot(a: &Exact, b: &Exact) -> BigRational {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

/// The part of a convex polygon on the side of `from` to which `normal` points, border included (Sutherland
/// and Hodgman 1974, *Reentrant polygon clipping*).
fn clipped(polygon: &[Exact], from: &Exact, normal: &Exact) -> Vec<Exact> {
    let heights: Vec<BigRational> = polygon.iter().map(|p| dot(&sub(p, from), normal)).collect();
    let mut left = Vec::new();
    for i in 0..polygon.len() {
        let j = (i + 1) % polygon.len();
        if !heights[i].is_negative() {
            left.push(polygon[i].clone());
        }
        if (&heights[i] * &heights[j]).is_negative() {
            let t = &heights[i] / (&heights[i] - &heights[j]);
            let way = sub(&polygon[j], &polygon[i]);
            left.push([0, 1, 2].map(|k| &polygon[i][k] + &t * &way[k]));
        }
    }
    left
}

/// The corners of the intersection of two triangles with area: the first is clipped to the plane of the
/// second, then by each of its edges.
fn common(a: &[Exact; 3], b: &[Exact; 3]) -> Vec<Exact> {
    let normal = cross(&sub(&b[1], &b[0]), &sub(&b[2], &b[0]));
    let back = [0, 1, 2].map(|k| -&normal[k]);
    let mut left = clipped(&clipped(a, &b[0], &normal), &b[0], &back);
    for k in 0..3 {
        let inward = cross(&normal, &sub(&b[(k + 1) % 3], &b[k]));
        left = clipped(&left, &b[k], &inward);
    }
    left
}

fn is_on(p: &Exact, u: &Exact, v: &Exact) -> bool {
    let (way, from) = (sub(v, u), sub(p, u));
    let along = dot(&from, &way);
    cross(&way, &from).iter().all(Zero::is_zero) && !along.is_negative() && along <= dot(&way, &way)
}

/// Whether two triangles with area and different vertices have more in common than their common vertices and
/// edge.
pub(crate) fn crosses(points: &[Point], a: &Triangle, b: &Triangle) -> bool {
    let apart = |k: usize| {
        let side = |t: &Triangle| t.map(|v| points[v.index()][k]);
        let ends = |x: [f64; 3]| (x[0].min(x[1]).min(x[2]), x[0].max(x[1]).max(x[2]));
        let ((low, high), (other_low, other_high)) = (ends(side(a)), ends(side(b)));
        high < other_low || other_high < low
    };
    if (0..3).any(apart) {
        return false;
    }
    let at = |v: &VertexId| exact(points[v.index()]);
    let shared: Vec<Exact> = a.iter().filter(|v| b.contains(v)).map(at).collect();
    let is_shared = |p: &Exact| match &shared[..] {
        [] => false,
        [u] => p == u,
        [u, v, ..] => is_on(p, u, v),
    };
    let corners = |t: &Triangle| [at(&t[0]), at(&t[1]), at(&t[2])];
    !common(&corners(a), &corners(b)).iter().all(is_shared)
}

fn is_flat(points: &[Point], t: &Triangle) -> bool {
    let [a, b, c] = t.map(|v| exact(points[v.index()]));
    cross(&sub(&b, &a), &sub(&c, &a)).iter().all(Zero::is_zero)
}

fn sorted(mut t: Triangle) -> Triangle {
    t.sort();
    t
}

/// Surfaces, with the queries on them.
struct Scene<'a> {
    points: &'a [Point],
    triangles: &'a [Triangle],
    surface_of: &'a [u32],
    roles: &'a [Role],
}

/// Every fault, sorted; all points finite.
pub(crate) fn faults(
    points: &[Point],
    triangles: &[Triangle],
    surface_of: &[u32],
    roles: &[Role],
) -> Vec<FaultKey> {
    let scene = Scene { points, triangles, surface_of, roles };
    let mut reported = scene.single();
    reported.extend(scene.meeting());
    for surface in 0..roles.len() as u32 {
        reported.extend(scene.edges(surface));
        reported.extend(scene.pinched(surface));
        reported.extend(scene.inward(surface));
        if !surface_of.contains(&surface) {
            reported.push((FaultKind::EmptySurface, true, surface, vec![], vec![]));
        }
    }
    reported.sort_by(|x, y| (x.0, &x.3, &x.4, x.2).cmp(&(y.0, &y.3, &y.4, y.2)));
    reported
}

impl Scene<'_> {
    fn ids(&self) -> std::ops::Range<usize> {
        0..self.triangles.len()
    }

    fn has_three(&self, t: usize) -> bool {
        let [a, b, c] = self.triangles[t];
        a != b && b != c && c != a
    }

    /// The first triangle with the same vertices, of the same surface if requested.
    fn first(&self, t: usize, own: bool) -> usize {
        let same = |u: &usize| {
            sorted(self.triangles[*u]) == sorted(self.triangles[t])
                && (!own || self.surface_of[*u] == self.surface_of[t])
        };
        if self.has_three(t) { self.ids().find(same).unwrap_or(t) } else { t }
    }

    /// Whether a triangle is the first in its surface with its vertices and orientation, and these outnumber
    /// the ones of opposite orientation.
    fn stays(&self, t: usize) -> bool {
        let turns = |[a, b, c]: Triangle| [[a, b, c], [b, c, a], [c, a, b]];
        let is_like = |u: &usize| turns(self.triangles[*u]).contains(&self.triangles[t]);
        let same = |u: &usize| {
            self.surface_of[*u] == self.surface_of[t]
                && sorted(self.triangles[*u]) == sorted(self.triangles[t])
        };
        let n_like = self.ids().filter(same).filter(is_like).count();
        2 * n_like > self.ids().filter(same).count() && self.ids().filter(same).find(is_like) == Some(t)
    }

    fn single(&self) -> Vec<FaultKey> {
        let mut reported = Vec::new();
        for t in self.ids() {
            let mut add_fault = |kind, is_fatal, triangles: &[usize]| {
                let triangles = triangles.iter().map(|&t| t as u32).collect();
                reported.push((kind, is_fatal, self.surface_of[t], triangles, self.triangles[t].to_vec()));
            };
            if !self.has_three(t) {
                add_fault(FaultKind::RepeatedVertex, true, &[t]);
                continue;
            }
            if is_flat(self.points, &self.triangles[t]) {
                add_fault(FaultKind::ZeroArea, true, &[t]);
            }
            let (own, first) = (self.first(t, true), self.first(t, false));
            if own != t {
                add_fault(FaultKind::Duplicate, true, &[own, t]);
            } else if first != t {
                add_fault(FaultKind::SharedFacet, false, &[first, t]);
            }
        }
        reported
    }

    fn meeting(&self) -> Vec<FaultKey> {
        let counts = |t: &usize| {
            self.has_three(*t) && !is_flat(self.points, &self.triangles[*t]) && self.first(*t, false) == *t
        };
        let sound: Vec<usize> = self.ids().filter(counts).collect();
        let mut reported = Vec::new();
        for (k, &i) in sound.iter().enumerate() {
            for &j in &sound[k + 1..] {
                let (a, b) = (&self.triangles[i], &self.triangles[j]);
                if crosses(self.points, a, b) {
                    let shared = a.iter().copied().filter(|v| b.contains(v)).collect();
                    let triangles = vec![i as u32, j as u32];
                    reported.push((FaultKind::Crossing, true, self.surface_of[i], triangles, shared));
                }
            }
        }
        reported
    }

    /// The triangles at each edge of a surface, with the direction in which each runs along it.
    fn around(&self, surface: u32) -> BTreeMap<[VertexId; 2], Vec<(u32, bool)>> {
        let mut around: BTreeMap<_, Vec<_>> = BTreeMap::new();
        let counts = |t: &usize| self.surface_of[*t] == surface && self.has_three(*t) && self.stays(*t);
        for t in self.ids().filter(counts) {
            let [a, b, c] = self.triangles[t];
            for [u, v] in [[a, b], [b, c], [c, a]] {
                around.entry([u.min(v), u.max(v)]).or_default().push((t as u32, u < v));
            }
        }
        around
    }

    fn edges(&self, surface: u32) -> Vec<FaultKey> {
        let is_boundary = self.roles[surface as usize] == Role::Boundary;
        let mut reported = Vec::new();
        for (edge, same) in self.around(surface) {
            let (kind, is_fatal) = match same.len() {
                1 => (FaultKind::OpenEdge, is_boundary),
                2 if same[0].1 == same[1].1 => (FaultKind::MisorientedEdge, false),
                2 => continue,
                _ => (FaultKind::NonManifoldEdge, false),
            };
            reported.push((kind, is_fatal, surface, same.iter().map(|x| x.0).collect(), edge.to_vec()));
        }
        reported
    }

    /// Connected sets, each sorted; by merging until nothing changes.
    fn joined(things: BTreeSet<u32>, pairs: &[(u32, u32)]) -> Vec<Vec<u32>> {
        let mut name: BTreeMap<u32, u32> = things.iter().map(|&t| (t, t)).collect();
        let mut changes = true;
        while changes {
            changes = false;
            for (x, y) in pairs {
                let least = name[x].min(name[y]);
                changes |= name[x] != least || name[y] != least;
                name.insert(*x, least);
                name.insert(*y, least);
            }
        }
        let mut sets: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        name.iter().for_each(|(&t, &n)| sets.entry(n).or_default().push(t));
        sets.into_values().collect()
    }

    fn pinched(&self, surface: u32) -> Vec<FaultKey> {
        let around = self.around(surface);
        let vertices: BTreeSet<VertexId> = around.keys().flatten().copied().collect();
        let mut reported = Vec::new();
        for v in vertices {
            let at_v: Vec<&Vec<(u32, bool)>> =
                around.iter().filter(|(edge, _)| edge.contains(&v)).map(|x| x.1).collect();
            let things = at_v.iter().flat_map(|same| same.iter().map(|x| x.0)).collect();
            let pairs: Vec<_> = at_v.iter().flat_map(|same| same.iter().map(|x| (same[0].0, x.0))).collect();
            let fans = Self::joined(things, &pairs);
            if fans.len() > 1 {
                let firsts = fans.iter().map(|fan| fan[0]).collect();
                reported.push((FaultKind::NonManifoldVertex, false, surface, firsts, vec![v]));
            }
        }
        reported
    }

    fn inward(&self, surface: u32) -> Vec<FaultKey> {
        let around = self.around(surface);
        let things = around.values().flatten().map(|x| x.0).collect();
        let manifold = around.values().filter(|same| same.len() == 2);
        let pairs: Vec<_> = manifold.map(|same| (same[0].0, same[1].0)).collect();
        let mut reported = Vec::new();
        for part in Self::joined(things, &pairs) {
            let is_balanced = |same: &Vec<(u32, bool)>| {
                let own = same.iter().filter(|x| part.contains(&x.0));
                own.map(|x| if x.1 { 1 } else { -1 }).sum::<i32>() == 0
            };
            let volume: BigRational = part
                .iter()
                .map(|&t| {
                    let [a, b, c] = self.triangles[t as usize].map(|v| exact(self.points[v.index()]));
                    dot(&cross(&a, &b), &c)
                })
                .sum();
            if around.values().all(is_balanced) && volume.is_negative() {
                let vertices = self.triangles[part[0] as usize].to_vec();
                reported.push((FaultKind::InwardPart, false, surface, vec![part[0]], vertices));
            }
        }
        reported
    }
}
