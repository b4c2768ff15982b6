//! Gives flat facets back the triangles that were given.

use std::collections::VecDeque;

use hashbrown::HashMap;

use super::plane::{Net, Plane};
use super::repair::{Exchange, SurfaceRepair};
use crate::base::{Point, VertexId, sorted_ids};
use crate::geometry::vector::{add, cross, dot, scale, sub};
use crate::kernel::{HalfFacet, Tets};

impl SurfaceRepair<'_> {
    /// Gives a flat facet back its given triangles, edge by edge, by flips (Sloan 1993, *A fast algorithm for
    /// generating constrained Delaunay triangulations*); `None` where a flip has no space.
    pub(super) fn restore(&mut self, flat: usize, list: &mut [[VertexId; 3]]) -> Option<()> {
        let plane = |keep: &Self, t: [VertexId; 3]| keep.plane(flat as u32).turned(t);
        let wanted: Vec<_> = self
            .flats
            .triangles
            .list(flat)
            .iter()
            .map(|&i| plane(self, self.triangles[i as usize]))
            .collect();
        if wanted.len() != list.len() {
            return None;
        }
        let (mut net, mut fans) = (Net::new(list), Fans::of(list));
        for edge in Net::new(&wanted).edges() {
            if net.has(edge) {
                continue;
            }
            let mut crossing = crossing(&net, &fans, list, &self.plane(flat as u32), edge);
            let mut left = 4 * crossing.len() * crossing.len() + 16;
            let mut n_failed = 0;
            while let Some([a, b]) = crossing.pop_front() {
                let Some([(s, p), (t, q)]) = net.sides([a, b]) else { continue };
                left -= 1;
                if left == 0 {
                    return None;
                }
                if !self.plane(flat as u32).can_flip([a, b], [p, q]) {
                    crossing.push_back([a, b]);
                    continue;
                }
                if self.flip(flat as u32, [a, b], [p, q]).is_none() {
                    n_failed += 1;
                    if n_failed > crossing.len() {
                        return None;
                    }
                    crossing.push_back([a, b]);
                    continue;
                }
                n_failed = 0;
                net.flip(list, [a, b], [(s, p), (t, q)]);
                fans.add(q, s);
                fans.add(p, t);
                if self.plane(flat as u32).cross(edge, [p, q]) {
                    crossing.push_back([p, q]);
                }
            }
        }
        Some(())
    }

    /// Replaces the edge a b within a flat facet by p q.
    fn flip(&mut self, flat: u32, [a, b]: [VertexId; 2], [p, q]: [VertexId; 2]) -> Option<()> {
        let mut star = self.star(a);
        star.retain(|&tet| self.tets.vertices(tet).contains(&b));
        let old = [sorted_ids([a, b, p]), sorted_ids([b, a, q])];
        let base = [(flat, [p, a, q]), (flat, [q, b, p])];
        let exchange = Exchange { old: &old, base: &base };
        if self.hand_over(&star, [a, b, p, q], exchange).is_some() {
            return Some(());
        }
        let is_around = |tets: &Tets, half: HalfFacet| {
            let apex = tets.vertices(half.tet())[half.facet()];
            apex == a || apex == b
        };
        let sides = self.sides(&star, &old, &base, is_around)?;
        let [from, to, p, q] = [a, b, p, q].map(|v| self.sites.near(v));
        let middle = add(from, scale(sub(to, from), crossing_share([from, to], [p, q])));
        self.commit(sides, middle, exchange, true)
    }
}

/// The triangles of each vertex of a flat facet, together with some that no longer have it.
struct Fans(HashMap<VertexId, Vec<u32>>);

impl Fans {
    fn of(list: &[[VertexId; 3]]) -> Self {
        let mut fans = Self(HashMap::with_capacity(list.len()));
        for (triangle, vertices) in (0..).zip(list) {
            vertices.iter().for_each(|&v| fans.add(v, triangle));
        }
        fans
    }

    fn add(&mut self, vertex: VertexId, triangle: u32) {
        self.0.entry(vertex).or_default().push(triangle);
    }

    fn of_vertex(&self, vertex: VertexId) -> &[u32] {
        self.0.get(&vertex).map_or(&[], Vec::as_slice)
    }
}

/// The edges of a flat facet that a segment crosses; ascending, with the smaller end first.
fn crossing(
    net: &Net,
    fans: &Fans,
    list: &[[VertexId; 3]],
    plane: &Plane,
    [a, b]: [VertexId; 2],
) -> VecDeque<[VertexId; 2]> {
    let fan = fans.of_vertex(a).iter().map(|&i| list[i as usize]);
    let Some(mut edges) = net.crossed(plane, fan, [a, b]) else {
        // Where triangles overlap by rounding, any of them may be in the way.
        return net.edges().into_iter().filter(|&e| plane.cross([a, b], e)).collect();
    };
    edges.iter_mut().for_each(|edge| edge.sort_unstable());
    edges.sort_unstable();
    edges.into()
}

/// The fraction of the way from `a` to `b` at which the line through p and q crosses; all lie in one plane.
fn crossing_share([a, b]: [Point; 2], [p, q]: [Point; 2]) -> f64 {
    let (along, across) = (sub(b, a), sub(q, p));
    let normal = cross(along, across);
    let share = dot(cross(sub(p, a), across), normal) / dot(normal, normal);
    if share > 0.0 && share < 1.0 { share } else { 0.5 }
}
