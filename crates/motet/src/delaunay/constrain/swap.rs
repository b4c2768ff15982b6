//! Replaces tets by others that fill the same space, so that less is in the way of an edge or a triangle to
//! be recovered.
//!
//! Two tets become three around the edge between their apexes, or the tets around an edge become two for each
//! triangle of the polygon around it (George 1991; Freitag and Ollivier-Gooch 1997). The triangulation chosen
//! is the one with the least in the way (Klincsek 1980, *Minimal triangulations of polygonal domains*, by
//! dynamic programming).

use super::sites::Sites;
use super::split::Protected;
use crate::base::{TetId, VertexId};
use crate::kernel::{HalfFacet, Tets};

/// The most tets that an edge may have to be removed.
const MAX_RING: usize = 10;

/// Counts what would be in the way of the part to be recovered; edges and facets that must not be lost are
/// never swapped away.
pub(super) trait Target: Protected {
    fn meets_facet(&self, face: [VertexId; 3]) -> u32;
    fn meets_edge(&self, edge: [VertexId; 2]) -> u32;
}

/// Buffers reused from one swap to the next.
#[derive(Default)]
pub(super) struct Swap {
    ring: Vec<TetId>,
    around: Vec<VertexId>,
    /// For each part of the polygon, how much is in the way at best, and the corner at which the part is
    /// split for that.
    best: Vec<Option<(u32, usize)>>,
}

impl Swap {
    /// Replaces the two tets at a facet that is in the way by three, if these are positive and the facets and
    /// the edge that they share are not in the way. Returns whether it did.
    pub(super) fn open(tets: &mut Tets, sites: &Sites, half: HalfFacet, wanted: &impl Target) -> bool {
        let ([p, q, r], other) = (tets.inward(half), tets.across(half));
        let [c, d] = [half, other].map(|half| tets.vertices(half.tet())[half.facet()]);
        let new = [[p, q, d, c], [q, r, d, c], [r, p, d, c]];
        let is_better = !wanted.has_facet([p, q, r])
            && new.iter().all(|&v| sites.orient3d(v) > 0)
            && [p, q, r].into_iter().all(|v| wanted.meets_facet([c, d, v]) == 0)
            && wanted.meets_edge([c, d]) == 0;
        if is_better {
            tets.replace(&[half.tet(), other.tet()], &new);
        }
        is_better
    }

    /// Replaces the tets around an edge, one of which is `first`, if afterwards there is less in the way than
    /// now plus `spare`. Returns whether it did.
    pub(super) fn remove(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        edge: [VertexId; 2],
        first: TetId,
        wanted: &impl Target,
        n_neutral: u32,
    ) -> bool {
        let [u, v] = edge;
        if wanted.has_edge(edge)
            || self.go_round(tets, edge, first).is_none()
            || self.around.iter().any(|&w| wanted.has_facet([u, v, w]))
        {
            return false;
        }
        let facets = self.around.iter().map(|&w| wanted.meets_facet([u, v, w]));
        let now = wanted.meets_edge(edge) + facets.sum::<u32>();
        let n = self.around.len();
        self.plan(sites, edge, now + n_neutral, wanted);
        if self.best[n - 1].is_none() {
            return false;
        }
        let mut new = Vec::with_capacity(2 * n);
        let mut parts = vec![(0, n - 1)];
        while let Some((i, k)) = parts.pop() {
            if let Some((_, j)) = self.best[i * n + k].filter(|_| k > i + 1) {
                let [a, b, c] = [i, j, k].map(|i| self.around[i]);
                new.extend([[a, b, c, v], [a, c, b, u]]);
                parts.extend([(i, j), (j, k)]);
            }
        }
        tets.replace(&self.ring, &new);
        true
    }

    /// Finds the best triangulation of the polygon around `edge` among those with less than `limit` in the
    /// way.
    fn plan(&mut self, sites: &Sites, [u, v]: [VertexId; 2], limit: u32, wanted: &impl Target) {
        let (n, w) = (self.around.len(), &self.around);
        self.best.clear();
        self.best.resize(n * n, None);
        (0..n - 1).for_each(|i| self.best[i * n + i + 1] = Some((0, 0)));
        for width in 2..n {
            for i in 0..n - width {
                let k = i + width;
                // Evaluated only where it matters: it is the most expensive part.
                let mut diagonal = if width == n - 1 { Some(0) } else { None };
                for j in i + 1..k {
                    let (Some(left), Some(right)) = (self.best[i * n + j], self.best[j * n + k]) else {
                        continue;
                    };
                    let best = self.best[i * n + k].map_or(limit, |best| best.0);
                    let is_positive = || {
                        sites.orient3d([w[i], w[j], w[k], v]) > 0 && sites.orient3d([w[i], w[k], w[j], u]) > 0
                    };
                    if left.0 + right.0 + diagonal.unwrap_or(0) >= best || !is_positive() {
                        continue;
                    }
                    let of_diagonal = *diagonal.get_or_insert_with(|| {
                        wanted.meets_edge([w[i], w[k]])
                            + wanted.meets_facet([u, w[i], w[k]])
                            + wanted.meets_facet([v, w[i], w[k]])
                    });
                    let least = left.0 + right.0 + of_diagonal;
                    if least >= best {
                        continue;
                    }
                    let of = least + wanted.meets_facet([w[i], w[j], w[k]]);
                    if of < best {
                        self.best[i * n + k] = Some((of, j));
                    }
                }
            }
        }
    }

    /// Collects the tets around an edge and the polygon around it, counter-clockwise seen from the edge's
    /// second end. `None` where there are too many, or the tets do not close around the edge.
    fn go_round(&mut self, tets: &Tets, [u, v]: [VertexId; 2], first: TetId) -> Option<()> {
        self.ring.clear();
        self.around.clear();
        let of_edge = |half: &HalfFacet| ![u, v].contains(&tets.vertices(first)[half.facet()]);
        // Whether the edge runs from u to v in the facet, seen from inside.
        let runs = |half: &HalfFacet| {
            let [a, b, c] = tets.inward(*half);
            [[a, b], [b, c], [c, a]].contains(&[u, v])
        };
        let last = Tets::facets(first).into_iter().find(|half| of_edge(half) && runs(half))?;
        let mut half = Tets::facets(first).into_iter().find(|half| of_edge(half) && !runs(half))?;
        // Vertices u, v, p, q of a positive tet: q is opposite `last`, and p opposite `half`.
        let (mut tet, mut q) = (first, tets.vertices(first)[last.facet()]);
        self.around.push(tets.vertices(first)[half.facet()]);
        loop {
            self.ring.push(tet);
            let other = tets.across(half);
            if other.is_none() || self.ring.len() > MAX_RING {
                return None;
            }
            if other.tet() == first {
                return (self.ring.len() > 2).then_some(());
            }
            self.around.push(q);
            tet = other.tet();
            let opposite_q = tets.vertices(tet).iter().position(|&x| x == q)?;
            half = HalfFacet::new(tet, opposite_q);
            q = tets.vertices(tet)[other.facet()];
        }
    }
}
