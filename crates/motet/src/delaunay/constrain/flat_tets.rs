//! Removes tets too flat to have a volume in the digits of their coordinates.
//!
//! Delaunay tets of four vertices that were coplanar before rounding are positive, by 1e-16 of their size.
//! Such a tet has two opposite edges that nearly cross; where all tets around one of them are remade from a
//! point inside, only the other sides of the flat tets limit where that point may lie.

use super::flatness::is_flat;
use super::present::SWEEP;
use super::refill::Side;
use super::repair::{Exchange, SurfaceRepair};
use crate::base::{TetId, Threads, VertexId, sorted_ids};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::{add, scale};
use crate::kernel::Tets;

/// The number of rounds; more than one, since new tets may be flat as well.
const MAX_ROUNDS: usize = 4;

impl SurfaceRepair<'_> {
    /// Remakes tets without volume, where possible; returns those that are left.
    pub(super) fn remove_flat(&mut self, threads: &Threads) -> Vec<[VertexId; 4]> {
        let mut flat = self.find_flat(threads);
        for _ in 0..MAX_ROUNDS {
            let mut has_changed = false;
            for &(tet, v) in &flat {
                has_changed |= self.tets.vertices(tet) == v
                    && (EDGES.iter().any(|&[i, j]| self.remove_at([v[i], v[j]]).is_some())
                        || v.iter().any(|&v| self.replace(v).is_some()));
            }
            if !has_changed {
                break;
            }
            flat = self.find_flat(threads);
        }
        flat.into_iter().map(|(_, v)| v).collect()
    }

    /// The tets inside that have no volume in the digits of their coordinates.
    fn find_flat(&self, threads: &Threads) -> Vec<(TetId, [VertexId; 4])> {
        let is_inside = |tet: TetId| self.bodies.of_slot[tet.index()] != 0;
        let near = |v: [VertexId; 4]| v.map(|v| self.sites.near(v));
        threads.in_runs(self.tets.n_slots(), SWEEP, |(): &mut (), run| {
            self.tets.among(run).filter(|&(tet, v)| is_inside(tet) && is_flat(near(v))).collect()
        })
    }

    /// Replaces a Steiner point inside by another one, provided that no tet at the new one is flat.
    fn replace(&mut self, vertex: VertexId) -> Option<()> {
        if !self.sites.is_steiner_inside(vertex) {
            return None;
        }
        let star = self.star(vertex);
        let side = Side::of_star(self.tets, vertex, &star);
        self.commit(vec![side], self.sites.near(vertex), Exchange { old: &[], base: &[] }, false)
    }

    /// Remakes the tets around an edge, provided that none of the new ones is flat.
    fn remove_at(&mut self, [a, b]: [VertexId; 2]) -> Option<()> {
        let mut star = self.star(a);
        star.retain(|&tet| self.tets.vertices(tet).contains(&b));
        let mut old = Vec::new();
        let mut base = Vec::new();
        for half in star.iter().flat_map(|&tet| Tets::facets(tet)) {
            let face = self.tets.inward(half);
            if let Some(flat) = self.wall(half).filter(|_| face.contains(&a) && face.contains(&b))
                && !old.contains(&sorted_ids(face))
            {
                old.push(sorted_ids(face));
                base.push((flat, self.plane(flat).turned(face)));
            }
        }
        let sides = self.sides(&star, &old, &base, |tets, half| {
            let apex = tets.vertices(half.tet())[half.facet()];
            apex == a || apex == b
        })?;
        let [p, q] = [a, b].map(|v| self.sites.near(v));
        let middle = scale(add(p, q), 0.5);
        self.commit(sides, middle, Exchange { old: &old, base: &base }, false)
    }
}
