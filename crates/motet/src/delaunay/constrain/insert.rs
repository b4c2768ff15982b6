//! Inserts a point into a Delaunay triangulation: the tets whose sphere contains it are replaced by tets from
//! it to the facets around (Bowyer 1981; Watson 1981). Points on segments have the highest rank, so they
//! count as outside a sphere on which they lie.

use super::sites::Sites;
use crate::base::{TetId, VertexId, sorted_ids};
use crate::geometry::tet::EDGES;
use crate::kernel::{HalfFacet, Tets};

/// Buffers reused from one insertion to the next.
#[derive(Default)]
pub(super) struct Insertion {
    /// The tets to be removed.
    cavity: Vec<TetId>,
    /// The facets around them, as links to the tets outside, and their vertices seen from inside.
    shell: Vec<(HalfFacet, [VertexId; 3])>,
    /// Edges of the shell, each with the facets of the new tets on its two sides.
    seams: Vec<([VertexId; 2], HalfFacet)>,
    /// Edges of the removed tets, each once, sorted.
    touched: Vec<[VertexId; 2]>,
}

impl Insertion {
    /// Inserts `vertex`; the walk to it starts at `start`. Returns the edges that no longer exist.
    pub(super) fn insert(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        vertex: VertexId,
        start: TetId,
    ) -> Vec<[VertexId; 2]> {
        let first = locate(tets, sites, vertex, start);
        self.dig(tets, sites, vertex, first);
        self.list_edges(tets);
        self.cavity.iter().for_each(|&tet| tets.remove(tet));
        tets.cone(vertex, self.shell.iter().copied(), &mut self.seams);
        self.lost()
    }

    fn dig(&mut self, tets: &mut Tets, sites: &Sites, vertex: VertexId, first: TetId) {
        tets.begin();
        tets.mark(first);
        self.cavity.clear();
        self.shell.clear();
        self.cavity.push(first);
        let mut next = 0;
        while let Some(&tet) = self.cavity.get(next) {
            next += 1;
            for half in Tets::facets(tet) {
                let other = tets.across(half);
                if other.is_none() {
                    self.shell.push((other, tets.inward(half)));
                } else if tets.is_marked(other.tet()) {
                } else if sites.is_inside(tets.vertices(other.tet()), vertex) {
                    tets.mark(other.tet());
                    self.cavity.push(other.tet());
                } else {
                    self.shell.push((other, tets.inward(half)));
                }
            }
        }
    }

    fn list_edges(&mut self, tets: &Tets) {
        self.touched.clear();
        for &tet in &self.cavity {
            let v = tets.vertices(tet);
            self.touched.extend(EDGES.map(|[i, j]| sorted_ids([v[i], v[j]])));
        }
        self.touched.sort_unstable();
        self.touched.dedup();
    }

    /// The touched edges that the shell does not have.
    fn lost(&self) -> Vec<[VertexId; 2]> {
        let is_kept = |edge: &&[VertexId; 2]| self.seams.binary_search_by_key(*edge, |s| s.0).is_ok();
        self.touched.iter().filter(|edge| !is_kept(edge)).copied().collect()
    }
}

/// The tet that contains a vertex not yet inserted, found by a visibility walk: it cannot cycle in a Delaunay
/// triangulation (Edelsbrunner 1989), and the box around all points keeps it inside.
fn locate(tets: &Tets, sites: &Sites, vertex: VertexId, start: TetId) -> TetId {
    let (mut tet, mut entered) = (start, HalfFacet::NONE);
    loop {
        let leads = |half: &HalfFacet| {
            let [a, b, c] = tets.inward(*half);
            *half != entered && !tets.across(*half).is_none() && sites.orient3d([a, b, c, vertex]) < 0
        };
        let Some(half) = Tets::facets(tet).into_iter().find(leads) else { return tet };
        entered = tets.across(half);
        tet = entered.tet();
    }
}
