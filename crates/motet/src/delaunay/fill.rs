//! Fills the cavity: a tet from the newcomer to each facet around it, each linked to its neighbours.

use super::cavity::{Cavity, Facet, grow_to};
use super::conflict::Newcomer;
use super::edges::{EdgeMap, EdgeMatrix, EdgeTable, MAX_MATRIX_VERTICES};
use super::gauge::{Arm, of_ghost, of_tet};
use super::store::{INFINITY, Slots, Tets};
use crate::base::Point;
use crate::geometry::vector::sub;
use pulp::Simd;

/// Buffers reused from one insertion to the next.
#[derive(Debug)]
pub(super) struct Fill {
    /// The distinct vertices of the cavity.
    vertices: Vec<u32>,
    /// For each vertex, `base` plus its place in `vertices`; values below `base` are from an earlier cavity.
    place: Vec<u32>,
    base: u32,
    /// The vertices relative to the newcomer.
    arms: Vec<Arm>,
    /// The facets of the cavity as places in `vertices`.
    corners: Vec<[u32; 3]>,
    matrix: EdgeMatrix,
    table: EdgeTable,
    /// Least error bound of a gauge; infinite where filters may not be trusted.
    least: f32,
}

impl Fill {
    /// Makes buffers for vertices 0 to `n_points` - 1.
    pub(super) fn new(n_points: usize, least: f32) -> Self {
        Self {
            vertices: Vec::new(),
            place: vec![0; n_points],
            base: 1,
            arms: Vec::new(),
            corners: Vec::new(),
            matrix: EdgeMatrix::default(),
            table: EdgeTable::default(),
            least,
        }
    }

    /// Replaces the tets of the cavity by new ones; returns one of these that is not a ghost, or `None`, with
    /// nothing changed, where there are too few slots.
    #[inline(always)]
    pub(super) fn fill<S: Simd>(
        &mut self,
        _: S,
        tets: Tets,
        free: &mut Slots,
        points: &[Point],
        cavity: &mut Cavity,
        new: Newcomer,
    ) -> Option<u32> {
        if !cavity.allocate_slots(tets, free) {
            return None;
        }
        let n = self.number(cavity.facets());
        self.reach::<S>(points, n, new.point);
        let (slots, facets) = (cavity.slots(), cavity.facets());
        let parts = Parts {
            tets,
            slots,
            facets,
            corners: &self.corners[..facets.len()],
            arms: &self.arms,
            new,
            least: self.least,
        };
        Some(if n <= MAX_MATRIX_VERTICES {
            parts.make::<S, _>(&mut self.matrix)
        } else {
            self.table.clear(3 * facets.len());
            parts.make::<S, _>(&mut self.table)
        })
    }

    /// Numbers the vertices of the cavity in the order in which they are met; returns how many there are. The
    /// loops are plain, branchless and over arrays that only grow: iterator chains were not inlined here, and
    /// whether a vertex is fresh is unpredictable.
    #[inline(always)]
    fn number(&mut self, facets: &[Facet]) -> usize {
        grow_to(&mut self.corners, facets.len());
        grow_to(&mut self.vertices, 3 * facets.len());
        grow_to(&mut self.arms, 3 * facets.len());
        if self.base.checked_add(3 * facets.len() as u32).is_none() {
            self.place.fill(0);
            self.base = 1;
        }
        // Slices: their addresses stay in registers; those of vectors would be reloaded after every write.
        let (vertices, place, base) = (&mut self.vertices[..], &mut self.place[..], self.base);
        let mut n = 0;
        for (corner, facet) in self.corners.iter_mut().zip(facets) {
            for (local, &v) in corner.iter_mut().zip(&facet.vertices) {
                let known = &mut place[v as usize];
                let fresh = *known < base;
                *known = if fresh { base + n } else { *known };
                *local = *known - base;
                vertices[*local as usize] = v;
                n += u32::from(fresh);
            }
        }
        self.base += n;
        n as usize
    }

    /// Computes the first `n` vertices relative to the newcomer at `origin`.
    #[inline(always)]
    fn reach<S: Simd>(&mut self, points: &[Point], n: usize, origin: Point) {
        for (arm, &v) in self.arms[..n].iter_mut().zip(&self.vertices[..n]) {
            *arm = Arm::new::<S>(sub(points[v as usize], origin));
        }
    }
}

/// Everything needed to make the new tets, in local numbers.
struct Parts<'a> {
    tets: Tets<'a>,
    slots: &'a [u32],
    facets: &'a [Facet],
    corners: &'a [[u32; 3]],
    arms: &'a [Arm],
    new: Newcomer,
    least: f32,
}

impl Parts<'_> {
    /// Writes the new tets and links them: two facets of the cavity share an edge in opposite directions, and
    /// so do their new tets.
    #[inline(always)]
    fn make<S: Simd, E: EdgeMap>(self, edges: &mut E) -> u32 {
        for (&slot, &[a, b, c]) in self.slots.iter().zip(self.corners) {
            edges.put(b, c, 4 * slot + 1);
            edges.put(c, a, 4 * slot + 2);
            edges.put(a, b, 4 * slot + 3);
        }
        let tets @ Tets { vertices, links, gauges } = self.tets;
        let (newcomer, mark) = (self.new.vertex, self.new.mark());
        let mut last = 0;
        for ((&slot, facet), &[a, b, c]) in self.slots.iter().zip(self.facets).zip(self.corners) {
            let [i, j, k] = facet.vertices;
            vertices.set(slot, [newcomer, i, j, k]);
            links.set(slot, [facet.outer, edges.get(c, b), edges.get(a, c), edges.get(b, a)]);
            tets.set_link(facet.outer, 4 * slot);
            let (a, b) = (&self.arms[a as usize], &self.arms[b as usize]);
            let gauge = if k == INFINITY {
                of_ghost::<S>(newcomer, [a, b], mark, self.least)
            } else {
                last = slot;
                of_tet::<S>(newcomer, [a, b, &self.arms[c as usize]], mark, self.least)
            };
            gauges.set(slot, gauge);
        }
        last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbering_starts_anew_where_the_numbers_end() {
        let facet = |vertices| Facet { vertices, outer: 0 };
        let facets = [facet([5, 7, 2]), facet([7, 5, 9]), facet([2, 9, 5])];
        let mut fill = Fill::new(10, 0.0);
        fill.base = u32::MAX - 20;
        for _ in 0..4 {
            assert_eq!(fill.number(&facets), 4);
            assert_eq!(fill.vertices[..4], [5, 7, 2, 9]);
            assert_eq!(fill.corners[..3], [[0, 1, 2], [1, 0, 3], [2, 3, 0]]);
        }
        assert!(fill.base < 20, "{}", fill.base);
    }
}
