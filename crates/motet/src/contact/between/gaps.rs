//! Measures all tets and all vertices, with the points where they are now.

use super::super::Side;
use super::measure::{Pair, Part, nearest};
use super::side::starts_on;
use super::simplices::Simplex;
use super::sites::{BodyVertex, SiteId};
use super::{Between, Least, VertexPair};
use crate::base::{BodyId, MaybeId, Point, Threads, VertexId};
use crate::geometry::distance::point_triangle;
use crate::geometry::vector::{distance, sub};

/// The distance of a vertex from other bodies: where it ends, and the nearest vertex there with its body.
#[derive(Clone, Copy)]
struct Gap {
    distance: f64,
    end: Point,
    body: BodyId,
    vertex: VertexId,
}

/// What was measured in a tet.
struct Measured {
    /// Where two bodies come nearest, on the sides that count.
    least: Option<Least>,
    /// How near they come regardless of the sides: in this tet, no vertex is nearer to another body.
    bound: f64,
    /// The nearest two vertices of different bodies.
    nearest_vertices: Option<VertexPair>,
}

impl Between {
    pub(super) fn measure(&mut self, points: &[Point], threads: &Threads) {
        let measured = threads.map(self.simplices.len(), |t| self.tet(self.simplices[t], points));
        let n_vertices = self.sites.vertices.len();
        let gaps = threads.map(n_vertices, |i| self.vertex(self.sites.vertices[i], &measured, points));
        (self.least, self.nearest_vertices) = (None, None);
        for (tet, Measured { least, nearest_vertices: pair, .. }) in self.tets.iter_mut().zip(measured) {
            (tet.bodies, tet.distance) =
                least.map_or(([BodyId(0); 2], f64::INFINITY), |l| (l.bodies, l.distance));
            keep_nearer(&mut self.least, least, |l| l.distance);
            keep_nearer(&mut self.nearest_vertices, pair, |p| p.distance);
        }
        self.gap = vec![f64::INFINITY; points.len()];
        self.closest = vec![MaybeId::NONE; points.len()];
        for (&BodyVertex { body, vertex: v, .. }, gap) in self.sites.vertices.iter().zip(gaps) {
            let Some(gap) = gap else { continue };
            if gap.distance < self.gap[v.index()] {
                (self.gap[v.index()], self.closest[v.index()]) = (gap.distance, gap.vertex.into());
            }
            // Nearer than in all tets if the triangles around were measured, too, or if there is no tet.
            let turn = usize::from(body > gap.body);
            let ordered = |own, other| if turn == 0 { [own, other] } else { [other, own] };
            let bodies = [body.min(gap.body), body.max(gap.body)];
            let from = points[v.index()];
            let mut ends = [from, gap.end];
            ends.rotate_left(turn);
            let least = Least { distance: gap.distance, bodies, points: ends };
            let vertices = ordered(v, gap.vertex);
            let apart = distance(from, points[gap.vertex.index()]);
            keep_nearer(&mut self.least, Some(least), |l| l.distance);
            let pair = VertexPair { distance: apart, bodies, vertices };
            keep_nearer(&mut self.nearest_vertices, Some(pair), |p| p.distance);
        }
    }

    fn tet(&self, tet: Simplex, points: &[Point]) -> Measured {
        let parts = self.parts(tet, points);
        let (mut least, mut bound, mut nearest_vertices) = (None, f64::INFINITY, None);
        for (i, b) in parts.iter().enumerate() {
            for a in &parts[..i] {
                let pair = nearest(a, b, &self.sites);
                let bodies = [a.body, b.body];
                bound = bound.min(pair.distance_squared.sqrt());
                if self.counts(a, b, &pair, points) {
                    let ends = [a.at(&pair.on_a), b.at(&pair.on_b)];
                    let found = Least { distance: pair.distance_squared.sqrt(), bodies, points: ends };
                    keep_nearer(&mut least, Some(found), |l| l.distance);
                }
                for v in a.own_vertices() {
                    for w in b.own_vertices() {
                        let vertices = [v, w];
                        let [p, q] = vertices.map(|v| points[v.index()]);
                        let found = VertexPair { distance: distance(p, q), bodies, vertices };
                        keep_nearer(&mut nearest_vertices, Some(found), |p| p.distance);
                    }
                }
            }
        }
        Measured { least, bound, nearest_vertices }
    }

    /// The gap of a vertex of a body; `None` if no other body is near it.
    fn vertex(&self, of: BodyVertex, measured: &[Measured], points: &[Point]) -> Option<Gap> {
        let BodyVertex { body, site, .. } = of;
        let first = self.sites.vertex(site.into(), body)?;
        let mut best = None;
        for owner in self.sites.owners(site.into()).iter().filter(|owner| owner.body != body) {
            let end = points[owner.vertex.index()];
            let apart = distance(points[first.index()], end);
            let found = Gap { distance: apart, end, body: owner.body, vertex: owner.vertex };
            keep_nearer(&mut best, Some(found), |gap| gap.distance);
        }
        let mut others: Vec<(BodyId, SiteId)> = Vec::new();
        for &t in self.at_site.list(site.index()) {
            let is_far = best.is_some_and(|best: Gap| measured[t as usize].bound >= best.distance);
            if is_far && !self.stars {
                continue;
            }
            let tet = self.simplices[t as usize];
            let place = tet.iter().position(|&s| s == site.into()).unwrap_or(0);
            let own = Part::new(tet, body, &self.sites, points).vertex(place);
            for other in self.parts(tet, points).iter().filter(|part| part.body != body) {
                self.offer(&own, other, &nearest(&own, other, &self.sites), points, &mut best);
                if self.stars {
                    others.extend(other.own_sites().map(|site| (other.body, site)));
                }
            }
        }
        if self.stars {
            others.sort_unstable();
            others.dedup();
            self.stars(body, site, &others, points, &mut best);
        }
        // Vertices of one body at one place are measured once; if they have moved apart, this remains a
        // bound.
        best.map(|gap| Gap {
            distance: gap.distance + distance(points[of.vertex.index()], points[first.index()]),
            ..gap
        })
    }

    /// Measures a vertex against all triangles around these sites of other bodies.
    fn stars(
        &self,
        body: BodyId,
        site: SiteId,
        others: &[(BodyId, SiteId)],
        points: &[Point],
        best: &mut Option<Gap>,
    ) {
        let around = |&(body, s): &(BodyId, SiteId)| self.sites.star(body, s).map(move |t| (t, body));
        let mut triangles: Vec<(usize, BodyId)> = others.iter().flat_map(around).collect();
        triangles.sort_unstable();
        triangles.dedup();
        let none = MaybeId::NONE;
        let own = Part::new([site.into(), none, none, none], body, &self.sites, points);
        let from = own.at(&[1.0, 0.0, 0.0, 0.0]);
        for (t, body) in triangles {
            let closest = point_triangle::closest(from, self.sites.corners[t].map(|v| points[v.index()]));
            if best.is_none_or(|best| closest.distance() < best.distance) {
                let [a, b, c] = self.sites.triangles[t];
                let other = Part::new([a.into(), b.into(), c.into(), none], body, &self.sites, points);
                self.offer(&own, &other, &nearest(&own, &other, &self.sites), points, best);
            }
        }
    }

    fn offer(&self, own: &Part, other: &Part, pair: &Pair, points: &[Point], best: &mut Option<Gap>) {
        let distance = pair.distance_squared.sqrt();
        if best.is_none_or(|best| distance < best.distance)
            && self.counts(own, other, pair, points)
            && let Some(vertex) = other.heaviest(&pair.on_b)
        {
            let body = other.body;
            *best = Some(Gap { distance, end: other.at(&pair.on_b), body, vertex });
        }
    }

    /// The part that each body has of a tet, in the order of the bodies.
    fn parts(&self, tet: Simplex, points: &[Point]) -> Vec<Part> {
        let mut bodies: Vec<BodyId> = Vec::with_capacity(4);
        for site in tet {
            bodies.extend(self.sites.owners(site).iter().map(|owner| owner.body));
        }
        bodies.sort_unstable();
        bodies.dedup();
        bodies.into_iter().map(|body| Part::new(tet, body, &self.sites, points)).collect()
    }

    /// Whether the line between two points is on the side that counts, at both ends.
    fn counts(&self, a: &Part, b: &Part, pair: &Pair, points: &[Point]) -> bool {
        let [on_a, on_b] = [a, b].map(|part| self.sides[part.body.index()]);
        if [on_a, on_b] == [Side::Both; 2] {
            return true;
        }
        let way = sub(b.at(&pair.on_b), a.at(&pair.on_a));
        starts_on(on_a, a, &pair.on_a, way, &self.sites, points)
            && starts_on(on_b, b, &pair.on_b, sub([0.0; 3], way), &self.sites, points)
    }
}

/// Keeps the nearer of the two; among two equally near ones, the first.
fn keep_nearer<T>(best: &mut Option<T>, new: Option<T>, distance: impl Fn(&T) -> f64) {
    if let Some(new) = new
        && best.as_ref().is_none_or(|best| distance(&new) < distance(best))
    {
        *best = Some(new);
    }
}
