//! A vertex put in, and joined to whatever it sees well.
//!
//! The cavity begins with the tets that hold the new vertex and grows tet by tet across the facet at which the fill is worst, as long as that makes
//! it better (after Klingner and Shewchuk 2007, *Aggressive tetrahedral mesh improvement*, who find the cavity by
//! the quality of each tet of the fill).

use crate::base::{Point, TetId, VertexId};
use crate::geometry::tet::FACETS;
use crate::kernel::{Behind, Change, Complex, Hold, VertexChange};

/// The cavity has at most so many tets.
const LARGEST_CAVITY: usize = 40;

/// Room for the search, used again and again.
#[derive(Clone, Debug, Default)]
pub struct Insertion {
    /// The facets round the cavity: the tet inside, which of its facets, the quality of the tet to come.
    rim: Vec<(TetId, usize, f64)>,
}

impl Insertion {
    /// Proposes a vertex at `point`; `seed` are the tets to begin the cavity with. `false` when there is no cavity better than `bar`.
    pub fn propose(
        &mut self,
        complex: &Complex,
        seed: &[TetId],
        point: Point,
        bar: f64,
        change: &mut Change,
    ) -> bool {
        change.clear();
        change.vertex = VertexChange::Insert(point, Hold::Free);
        let apex = complex.next_vertex();
        self.rim.clear();
        for &tet in seed {
            self.take(complex, tet, point, change);
        }
        loop {
            let Some(worst) = (0..self.rim.len()).min_by(|&i, &j| self.rim[i].2.total_cmp(&self.rim[j].2))
            else {
                return false;
            };
            let (tet, facet, quality) = self.rim[worst];
            if quality > bar {
                break;
            }
            let Behind::Tet(behind) = complex.behind(tet, facet) else { return false };
            if change.cavity.len() == LARGEST_CAVITY {
                return false;
            }
            self.take(complex, behind.tet(), point, change);
        }
        for &(tet, facet, _) in &self.rim {
            let [a, b, c] = FACETS[facet].map(|corner| complex.vertices(tet)[corner]);
            change.push(complex, [a, c, b, apex], complex.region(tet));
        }
        !self.loses_a_vertex(complex, change)
    }

    /// Puts a tet into the cavity: facets towards it go from the rim, its others come.
    fn take(&mut self, complex: &Complex, tet: TetId, point: Point, change: &mut Change) {
        change.cavity.push(tet);
        for (facet, corners) in FACETS.into_iter().enumerate() {
            if let Behind::Tet(half) = complex.behind(tet, facet) {
                let known = self.rim.iter().position(|r| r.0 == half.tet() && r.1 == half.facet());
                if let Some(known) = known {
                    self.rim.swap_remove(known);
                    continue;
                }
            }
            let [a, b, c] = corners.map(|corner| complex.point(complex.vertices(tet)[corner]));
            self.rim.push((tet, facet, complex.measure([a, c, b, point])));
        }
    }

    /// Whether a vertex of the cavity is on none of its outer facets.
    fn loses_a_vertex(&self, complex: &Complex, change: &Change) -> bool {
        let is_kept = |v: VertexId| change.fill.iter().any(|tet| tet.vertices.contains(&v));
        change.cavity.iter().any(|&t| !complex.vertices(t).into_iter().all(is_kept))
    }
}
