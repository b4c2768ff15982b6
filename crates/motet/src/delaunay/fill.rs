//! Fills the cavity: a tet from the newcomer to each facet around it, linked to each other.

use super::cavity::{Cavity, Facet};
use super::conflict::Newcomer;
use super::edges::{Edges, Matrix, SMALL, Table};
use super::gauge::{Arm, of_ghost, of_tet};
use super::store::{INFINITY, Store, Tet};
use crate::base::Point;
use crate::geometry::vector::sub;

/// Working space, kept from one insertion to the next.
#[derive(Debug)]
pub(super) struct Fill {
    /// Vertices of the cavity; with `place` a sparse set (Briggs and Torczon 1993).
    vertices: Vec<u32>,
    /// Vertex to its place in `vertices`, true if found there.
    place: Vec<u32>,
    /// The vertices relative to the newcomer.
    arms: Vec<Arm>,
    /// The facets in places.
    corners: Vec<[u32; 3]>,
    matrix: Matrix,
    table: Table,
    /// Least error bound of a gauge; infinite where filters may not be trusted.
    least: f32,
}

impl Fill {
    /// For points 0 to `n_points` - 1.
    pub(super) fn new(n_points: usize, least: f32) -> Self {
        Self {
            vertices: Vec::new(),
            place: vec![0; n_points],
            arms: Vec::new(),
            corners: Vec::new(),
            matrix: Matrix::default(),
            table: Table::default(),
            least,
        }
    }

    /// Replaces the tets of the cavity; answers one of the new tets that is no ghost.
    #[inline(always)]
    pub(super) fn fill(
        &mut self,
        store: &mut Store,
        points: &[Point],
        cavity: &mut Cavity,
        new: Newcomer,
    ) -> u32 {
        store.fit(&mut cavity.tets, cavity.facets.len());
        let n = self.number(&cavity.facets);
        self.reach(points, n, new.point);
        let parts = Parts {
            store,
            slots: &cavity.tets,
            facets: &cavity.facets,
            corners: &self.corners[..cavity.facets.len()],
            arms: &self.arms,
            new,
            least: self.least,
        };
        if n <= SMALL {
            parts.make(&mut self.matrix)
        } else {
            self.table.clear(3 * cavity.facets.len());
            parts.make(&mut self.table)
        }
    }

    /// Numbers the vertices of the cavity in the order in which they are met; answers how many there are. Plain
    /// loops over arrays that only grow: iterator chains here were not inlined, and cost a tenth of all instructions.
    #[inline(always)]
    fn number(&mut self, facets: &[Facet]) -> usize {
        if self.corners.len() < facets.len() {
            self.corners.resize(2 * facets.len(), [0; 3]);
            self.vertices.resize(6 * facets.len(), 0);
            self.arms.resize(6 * facets.len(), Arm::new([0.0; 3]));
        }
        // Slices: their addresses stay in registers, a vector's would be read again after every write.
        let (vertices, place) = (&mut self.vertices[..], &mut self.place[..]);
        let mut n = 0;
        for (corner, facet) in self.corners.iter_mut().zip(facets) {
            for (local, &v) in corner.iter_mut().zip(&facet.vertices) {
                let known = place[v as usize];
                let fresh = known as usize >= n || vertices[known as usize] != v;
                *local = if fresh { n as u32 } else { known };
                place[v as usize] = *local;
                vertices[*local as usize] = v;
                n += usize::from(fresh);
            }
        }
        n
    }

    /// The first `n` vertices relative to the newcomer at `origin`.
    #[inline(always)]
    fn reach(&mut self, points: &[Point], n: usize, origin: Point) {
        for (arm, &v) in self.arms[..n].iter_mut().zip(&self.vertices[..n]) {
            *arm = Arm::new(sub(points[v as usize], origin));
        }
    }
}

/// All that making the new tets needs, numbered.
struct Parts<'a> {
    store: &'a mut Store,
    slots: &'a [u32],
    facets: &'a [Facet],
    corners: &'a [[u32; 3]],
    arms: &'a [Arm],
    new: Newcomer,
    least: f32,
}

impl Parts<'_> {
    /// Two facets around the cavity share an edge, in opposite directions; so do their new tets.
    #[inline(always)]
    fn make(self, edges: &mut impl Edges) -> u32 {
        for (&slot, &[a, b, c]) in self.slots.iter().zip(self.corners) {
            edges.put(b, c, 4 * slot + 1);
            edges.put(c, a, 4 * slot + 2);
            edges.put(a, b, 4 * slot + 3);
        }
        let (tets, gauges) = (&mut self.store.tets[..], &mut self.store.gauges[..]);
        let mut last = 0;
        for ((&slot, facet), &[a, b, c]) in self.slots.iter().zip(self.facets).zip(self.corners) {
            let [i, j, k] = facet.vertices;
            let links = [facet.outer, edges.get(c, b), edges.get(a, c), edges.get(b, a)];
            let [a, b, c] = [a, b, c].map(|v| &self.arms[v as usize]);
            let (minors, gauge) = if k == INFINITY {
                of_ghost([a, b], self.new.mark(), self.least)
            } else {
                last = slot;
                of_tet([a, b, c], self.new.mark(), self.least)
            };
            tets[slot as usize] = Tet { vertices: [self.new.vertex, i, j, k], links, minors };
            gauges[slot as usize] = gauge;
            tets[(facet.outer >> 2) as usize].links[(facet.outer & 3) as usize] = 4 * slot;
        }
        last
    }
}
