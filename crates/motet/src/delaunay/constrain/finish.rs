//! From the internal state to the caller's result: the tets inside, under the caller's ids.

use hashbrown::HashMap;

use super::bodies::Bodies;
use super::plane::Plane;
use super::present::SWEEP;
use super::sites::Place;
use super::{Back, Constrained, Filled, PointInTriangle, PointOnEdge};
use crate::base::{Csr, Point, Threads, VertexId, sorted_ids};
use crate::geometry::predicates::spot::Between;
use crate::geometry::vector::{cross, dot, sub};

impl Filled {
    /// Drops what lies outside, and numbers the rest.
    pub(super) fn finish(
        self,
        points: &[Point],
        triangles: &[[VertexId; 3]],
        back: Back,
        threads: &Threads,
    ) -> Constrained {
        let numbers = Numbers::new(&self, points.len());
        let on_edge = |v: &VertexId| match self.sites.place(*v)? {
            Place::On(place) => {
                Some(PointOnEdge { ends: self.segments.ends(place.segment), share: place.share.near() })
            }
            Place::In(..) => None,
        };
        let in_triangle = |v: &VertexId| match self.sites.place(*v)? {
            Place::In(triangle, shares) => Some(PointInTriangle { triangle, shares }),
            Place::On(_) => None,
        };
        let on_edges: Vec<_> = numbers.later.iter().filter_map(on_edge).collect();
        let in_triangles: Vec<_> = numbers.later.iter().filter_map(in_triangle).collect();
        let at = |v: VertexId| points[v.index()];
        let of_edges =
            on_edges.iter().map(|on| Between::new(at(on.ends[0]), at(on.ends[1]), [on.share, 0.0]));
        let of_triangles = in_triangles.iter().map(|on| {
            let [a, b, c] = triangles[on.triangle as usize].map(at);
            Between::within(a, [b, c], on.shares)
        });
        let placed = of_edges.chain(of_triangles).map(|between| between.rounded());
        let inside =
            numbers.later[on_edges.len() + in_triangles.len()..].iter().map(|&v| back.of(self.sites.near(v)));
        let n_slots = self.tets.n_slots();
        let inside_of = |run| self.tets.among(run).filter_map(|(tet, v)| Some((v, self.body(tet.index())?)));
        let renamed = |v: [VertexId; 4]| v.map(|v| numbers.of(v));
        Constrained {
            points: points.iter().copied().chain(placed).chain(inside).collect(),
            on_edges,
            in_triangles,
            tets: threads.in_runs(n_slots, SWEEP, |(): &mut (), run| {
                inside_of(run).map(|(v, _)| renamed(v)).collect()
            }),
            bodies: threads
                .in_runs(n_slots, SWEEP, |(): &mut (), run| inside_of(run).map(|(_, b)| b).collect()),
            triangle_to_facets: self.facets(triangles, &numbers),
            triangle_to_bodies: self.sides(triangles),
        }
    }

    /// The body of a slot, if it is not outside.
    fn body(&self, slot: usize) -> Option<u32> {
        self.bodies.of_slot[slot].checked_sub(1)
    }

    /// The flat facet of each triangle.
    fn flat_of(&self, n: usize) -> Vec<u32> {
        let mut flat_of = vec![0; n];
        for (flat, list) in self.flats.triangles.iter().enumerate() {
            list.iter().for_each(|&i| flat_of[i as usize] = flat as u32);
        }
        flat_of
    }

    fn plane(&self, flat: u32, triangles: &[[VertexId; 3]]) -> Plane<'_> {
        Plane::new(&self.sites, triangles[self.flats.triangles.list(flat as usize)[0] as usize])
    }

    /// The bodies in front of each triangle and behind it.
    fn sides(&self, triangles: &[[VertexId; 3]]) -> Vec<[Option<u32>; 2]> {
        let flat_of = self.flat_of(triangles.len());
        let side = |(&t, &flat): (&[VertexId; 3], &u32)| {
            let [front, behind] = self.bodies.sides[flat as usize].map(|b| b.checked_sub(1));
            let is_turned = self.flats.triangles.list(flat as usize).len() > 1
                && self.plane(flat, triangles).turned(t) != t;
            if is_turned { [behind, front] } else { [front, behind] }
        };
        triangles.iter().zip(&flat_of).map(side).collect()
    }

    /// The facets of each triangle, oriented like it.
    fn facets(&self, triangles: &[[VertexId; 3]], numbers: &Numbers) -> Csr<[VertexId; 3]> {
        let mut pairs: Vec<(usize, [VertexId; 3])> = Vec::with_capacity(triangles.len());
        for (flat, list) in self.flats.triangles.iter().enumerate() {
            let parts = self.surface.parts.list(flat);
            if let [one] = *list {
                pairs.extend(parts.iter().map(|&part| (one as usize, part)));
                continue;
            }
            let plane = self.plane(flat as u32, triangles);
            let mut by_vertices = HashMap::with_capacity(list.len());
            for &i in list {
                by_vertices.entry(sorted_ids(triangles[i as usize])).or_insert(i as usize);
            }
            for &part in parts {
                let same = by_vertices.get(&sorted_ids(part));
                let of = same.copied().unwrap_or_else(|| self.triangle_around(list, part, triangles));
                let is_same = plane.turned(triangles[of]) == triangles[of];
                pairs.push((of, if is_same { part } else { [part[0], part[2], part[1]] }));
            }
        }
        let renamed = || pairs.iter().map(|&(i, part)| (i, part.map(|v| numbers.of(v))));
        Csr::from_pairs(triangles.len(), renamed)
    }

    /// The triangle of a flat facet in which the centroid of a part lies deepest.
    fn triangle_around(&self, list: &[u32], part: [VertexId; 3], triangles: &[[VertexId; 3]]) -> usize {
        let corners = |t: [VertexId; 3]| t.map(|v| self.sites.near(v));
        let [a, b, c] = corners(part);
        let middle = [0, 1, 2].map(|i| (a[i] + b[i] + c[i]) / 3.0);
        let depth = |i: u32| {
            let [a, b, c] = corners(triangles[i as usize]);
            let normal = cross(sub(b, a), sub(c, a));
            let side =
                |[p, q]: [Point; 2]| dot(cross(sub(q, p), sub(middle, p)), normal) / dot(normal, normal);
            [[a, b], [b, c], [c, a]].map(side).into_iter().fold(f64::INFINITY, f64::min)
        };
        let deepest = list.iter().max_by(|&&i, &&j| depth(i).total_cmp(&depth(j)));
        deepest.map_or(0, |&i| i as usize)
    }
}

/// New numbers of vertices: given ones keep theirs, followed by points on edges, in triangles and inside.
struct Numbers {
    /// The used vertices that were not given, in their new order.
    later: Vec<VertexId>,
    old_to_new: Vec<u32>,
}

impl Numbers {
    fn new(filled: &Filled, n_given: usize) -> Self {
        let mut is_used = vec![false; filled.sites.len()];
        for (tet, v) in filled.tets.iter() {
            if filled.bodies.of_slot[tet.index()] != 0 && filled.bodies.of_slot[tet.index()] != Bodies::NONE {
                v.iter().for_each(|v| is_used[v.index()] = true);
            }
        }
        filled.surface.parts.items().as_flattened().iter().for_each(|v| is_used[v.index()] = true);
        let used = (n_given..is_used.len()).filter(|&v| is_used[v]).map(VertexId::new);
        let mut later: Vec<VertexId> = used.collect();
        later.sort_by_key(|&v| match filled.sites.place(v) {
            Some(Place::On(_)) => 0,
            Some(Place::In(..)) => 1,
            None => 2,
        });
        let mut old_to_new: Vec<u32> = (0..is_used.len() as u32).collect();
        later.iter().enumerate().for_each(|(i, v)| old_to_new[v.index()] = (n_given + i) as u32);
        Self { later, old_to_new }
    }

    fn of(&self, vertex: VertexId) -> VertexId {
        VertexId(self.old_to_new[vertex.index()])
    }
}
