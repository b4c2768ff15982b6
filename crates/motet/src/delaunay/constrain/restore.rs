//! Gives flat facets back the triangles that were given.

use std::collections::VecDeque;

use super::plane::Net;
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
        let mut net = Net::new(list);
        for edge in Net::new(&wanted).edges() {
            let mut crossing: VecDeque<_> = if net.has(edge) {
                continue;
            } else {
                net.edges().into_iter().filter(|&e| self.plane(flat as u32).cross(edge, e)).collect()
            };
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

/// The fraction of the way from `a` to `b` at which the line through p and q crosses; all lie in one plane.
fn crossing_share([a, b]: [Point; 2], [p, q]: [Point; 2]) -> f64 {
    let (along, across) = (sub(b, a), sub(q, p));
    let normal = cross(along, across);
    let share = dot(cross(sub(p, a), across), normal) / dot(normal, normal);
    if share > 0.0 && share < 1.0 { share } else { 0.5 }
}
