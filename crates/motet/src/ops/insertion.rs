//! Vertex insertion: a new vertex is joined to the facets of a cavity around it.
//!
//! The cavity starts with the tets that contain the new vertex. It grows tet by tet across the facet with the
//! worst new tet, as long as that improves the fill (after Klingner and Shewchuk 2007, *Aggressive
//! tetrahedral mesh improvement*, who find the cavity by the quality of each tet of the fill).

use crate::base::{Point, TetId, VertexId};
use crate::geometry::tet::FACETS;
use crate::kernel::{Behind, Change, Complex, Fill, Hold, Side, VertexChange};
use crate::ops::smoothing::Corner;
use crate::ops::{Anywhere, Smoothing};

/// The largest number of tets in the cavity.
const MAX_CAVITY: usize = 40;

/// Work arrays, reused from call to call.
#[derive(Clone, Debug, Default)]
pub struct Insertion {
    smoothing: Smoothing,
    /// The facets around the cavity: the tet inside, the number of the facet in it, and the quality of the
    /// new tet on it.
    rim: Vec<(TetId, usize, f64)>,
}

impl Insertion {
    /// Proposes a vertex at `point` or, if that is better, somewhere else in the cavity; the cavity starts
    /// with `seed`. The search stops at a worst quality of `enough`. Returns `false` if no cavity is better
    /// than `bar`.
    pub fn propose(
        &mut self,
        complex: &Complex,
        seed: &[TetId],
        point: Point,
        [bar, enough]: [f64; 2],
        change: &mut Change,
    ) -> bool {
        // A cavity that is not good enough yet may become so when the vertex moves: `bar` is applied only
        // afterwards.
        let low = bar.min(0.5 * enough);
        self.find_cavity(complex, seed, point, low, change) && {
            let rim = self.rim.iter().map(|&(tet, facet, quality)| {
                let [a, b, c] = FACETS[facet].map(|corner| complex.point(complex.vertices(tet)[corner]));
                Corner { points: [a, c, b, point], place: 3, quality, of: (tet, Some(facet)) }
            });
            let point = self.smoothing.best_place(complex, rim, point, enough, &Anywhere);
            self.fill(complex, point, change);
            change.worst() > bar && !self.loses_a_vertex(complex, change)
        }
    }

    fn fill(&self, complex: &Complex, point: Point, change: &mut Change) {
        change.vertex = VertexChange::Insert(point, Hold::Free);
        let apex = complex.next_vertex();
        for (&(tet, facet, _), quality) in self.rim.iter().zip(self.smoothing.qualities()) {
            let [a, b, c] = FACETS[facet].map(|corner| complex.vertices(tet)[corner]);
            change.fill.push(Fill { vertices: [a, c, b, apex], region: complex.region(tet), quality });
        }
    }

    /// Grows a cavity around `point` until the tets from its facets to the point are all better than `bar`.
    fn find_cavity(
        &mut self,
        complex: &Complex,
        seed: &[TetId],
        point: Point,
        bar: f64,
        change: &mut Change,
    ) -> bool {
        change.clear();
        self.rim.clear();
        let mut is_open = true;
        for &tet in seed {
            is_open &= self.take(complex, tet, point, bar, change);
        }
        while is_open {
            let worst = (0..self.rim.len()).min_by(|&i, &j| self.rim[i].2.total_cmp(&self.rim[j].2));
            let Some(worst) = worst else { return false };
            let (tet, facet, quality) = self.rim[worst];
            if quality > bar {
                return true;
            }
            let Behind::Tet(behind) = complex.behind(tet, facet) else { return false };
            if change.cavity.len() >= MAX_CAVITY {
                return false;
            }
            is_open = self.take(complex, behind.tet(), point, bar, change);
        }
        false
    }

    /// Adds a tet to the cavity: its facets shared with the rim leave the rim, its others join it. Returns
    /// `false` if one of these is a wall, which stays from then on, with a tet that is not better than `bar`:
    /// growing on until that tet is the worst took a fifth of the time of repairing a cube with a crease of
    /// needles.
    fn take(&mut self, complex: &Complex, tet: TetId, point: Point, bar: f64, change: &mut Change) -> bool {
        let mut is_open = true;
        change.cavity.push(tet);
        for (facet, corners) in FACETS.into_iter().enumerate() {
            let behind = complex.behind(tet, facet);
            if let Behind::Tet(half) = behind {
                let known = self.rim.iter().position(|r| r.0 == half.tet() && r.1 == half.facet());
                if let Some(known) = known {
                    self.rim.swap_remove(known);
                    continue;
                }
            }
            let [a, b, c] = corners.map(|corner| complex.point(complex.vertices(tet)[corner]));
            // The facet on the rim is opposite the new vertex, the others lie inside.
            let side = |i: usize| if i == 3 { complex.side(tet, facet) } else { Side::Inside };
            let quality = complex.judge([a, c, b, point], side);
            is_open &= quality > bar || matches!(behind, Behind::Tet(_));
            self.rim.push((tet, facet, quality));
        }
        is_open
    }

    /// Whether a vertex of the cavity lies on none of its outer facets.
    fn loses_a_vertex(&self, complex: &Complex, change: &Change) -> bool {
        let is_kept = |v: VertexId| change.fill.iter().any(|tet| tet.vertices.contains(&v));
        change.cavity.iter().any(|&t| !complex.vertices(t).into_iter().all(is_kept))
    }
}
