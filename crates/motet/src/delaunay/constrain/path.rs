//! The tets and facets that a segment meets on its way.

use super::sites::Sites;
use crate::base::{TetId, VertexId};
use crate::kernel::{HalfFacet, Tets};

/// After this many steps around a vertex all its tets are examined: a walk may cycle among tets that are not
/// Delaunay.
const MAX_STEPS: usize = 100;

/// The tets that a segment touches, from one of its ends to the other.
#[derive(Default)]
pub(super) struct SegmentPath {
    pub(super) tets: Vec<TetId>,
    /// The facets between them that it meets, including those that it touches in an edge; each once.
    pub(super) facets: Vec<HalfFacet>,
    star: Vec<TetId>,
}

impl SegmentPath {
    /// Follows the segment between two vertices; false where it is an edge of tets already, or no tet to
    /// start from is found.
    pub(super) fn find(&mut self, tets: &mut Tets, sites: &Sites, ends: [VertexId; 2]) -> bool {
        self.tets.clear();
        self.facets.clear();
        let Some(first) = self.first(tets, sites, ends) else { return false };
        tets.begin();
        tets.mark(first);
        self.tets.push(first);
        let mut next = 0;
        while let Some(&tet) = self.tets.get(next) {
            next += 1;
            for half in Tets::facets(tet) {
                let other = tets.across(half);
                let is_done = other.is_none() || tets.is_marked(other.tet()) && other < half;
                if is_done || !meets(sites, ends, tets.inward(half)) {
                    continue;
                }
                if tets.mark(other.tet()) {
                    self.tets.push(other.tet());
                }
                if !self.facets.contains(&other) {
                    self.facets.push(half);
                }
            }
        }
        true
    }

    /// The tet at the first end into which the segment leads; `None` where it is an edge.
    fn first(&mut self, tets: &mut Tets, sites: &Sites, [a, b]: [VertexId; 2]) -> Option<TetId> {
        // A facet of the cone from a whose other side has b; `None` for the tet whose cone from a contains b.
        let step = |tets: &Tets, tet: TetId, entered: HalfFacet, turn: usize| {
            let v = tets.vertices(tet);
            let leads = |half: &HalfFacet| {
                let [p, q, r] = tets.inward(*half);
                *half != entered && v[half.facet()] != a && sites.orient3d([p, q, r, b]) < 0
            };
            (0..4).map(|i| HalfFacet::new(tet, (i + turn) % 4)).find(leads)
        };
        let (mut tet, mut entered) = (tets.tet_of(a), HalfFacet::NONE);
        for turn in 0..MAX_STEPS {
            if tets.vertices(tet).contains(&b) {
                return None;
            }
            let Some(half) = step(tets, tet, entered, turn) else { return Some(tet) };
            entered = tets.across(half);
            if entered.is_none() {
                break;
            }
            tet = entered.tet();
        }
        tets.star(a, &mut self.star);
        if self.star.iter().any(|&tet| tets.vertices(tet).contains(&b)) {
            return None;
        }
        self.star.iter().copied().find(|&tet| step(tets, tet, HalfFacet::NONE, 0).is_none())
    }
}

/// Whether the segment between two vertices meets a facet, other than in the segment's ends.
pub(super) fn meets(sites: &Sites, [a, b]: [VertexId; 2], face: [VertexId; 3]) -> bool {
    let [x, y, z] = face;
    let edges = [[x, y], [y, z], [z, x]];
    match [a, b].map(|end| face.contains(&end)) {
        [true, true] => false,
        [false, false] => match [a, b].map(|end| sites.orient3d([x, y, z, end])) {
            [0, 0] => edges.into_iter().any(|edge| meet_in_plane(sites, [a, b], edge)),
            [s, t] if s * t < 0 => {
                let turns = edges.map(|[p, q]| sites.orient3d([a, b, p, q]));
                turns.iter().all(|&t| t >= 0) || turns.iter().all(|&t| t <= 0)
            }
            // An end in the plane of a facet does not lie on the facet.
            _ => false,
        },
        _ => edges.into_iter().any(|[p, q]| {
            let is_opposite = ![p, q].contains(&a) && ![p, q].contains(&b);
            is_opposite && sites.orient3d([a, b, p, q]) == 0 && meet_in_plane(sites, [a, b], [p, q])
        }),
    }
}

/// Whether the open segment a b meets the segment p q; all lie in one plane but not on one line.
fn meet_in_plane(sites: &Sites, [a, b]: [VertexId; 2], [p, q]: [VertexId; 2]) -> bool {
    let sides = |beside: VertexId| [p, q].map(|v| sites.orient3d([a, b, v, beside]));
    let Some(beside) = sites.around_all().into_iter().find(|&v| sides(v) != [0, 0]) else { return false };
    let [of_p, of_q] = sides(beside);
    let [of_a, of_b] = [a, b].map(|v| sites.orient3d([p, q, v, beside]));
    of_p * of_q <= 0 && of_a * of_b < 0
}
