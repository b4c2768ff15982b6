//! Fills a hollow with constrained Delaunay tets, one facet at a time, by gift wrapping.
//!
//! The apex of the tet on a facet is the vertex whose sphere through the facet contains no other vertex
//! visible from within the tet. It exists, and is unique once ties are broken, if all edges of the facets are
//! edges of the triangulation (Shewchuk 2008, *General-dimensional constrained Delaunay and constrained
//! regular triangulations*). Visible means that the tet crosses no face of what is still hollow.
//!
//! In a large hollow the Delaunay triangulation of its vertices supplies the apex of nearly all faces. A tet
//! of that triangulation can be cut only by faces that are not facets of it, and those are few.

use hashbrown::{HashMap, HashSet};

use super::cut::{Face, Stuck};
use super::hollow::{Guide, smallest_first};
use super::sites::Sites;
use crate::base::{TetId, VertexId};
use crate::geometry::tet::{EDGES, FACETS};
use crate::kernel::{HalfFacet, Tets};

/// Hollows of at most this many faces are filled without a guide.
const MAX_UNGUIDED: usize = 32;

/// Buffers reused from one hollow to the next, and the tets made.
#[derive(Default)]
pub(super) struct GiftWrap {
    /// The faces around what is still hollow, by their vertices as seen from there: a wall inside has two
    /// sides.
    open: HashMap<[VertexId; 3], Face>,
    /// Faces in the order in which they were added; those no longer open are skipped.
    queue: Vec<[VertexId; 3]>,
    vertices: Vec<VertexId>,
    candidates: Vec<VertexId>,
    guide: Guide,
    is_guided: bool,
    /// Open faces that are not facets of the guide.
    strange: HashSet<[VertexId; 3]>,
    /// The facets of new tets on faces with nothing behind them.
    bare: HashMap<[VertexId; 3], HalfFacet>,
    made: Vec<TetId>,
}

impl GiftWrap {
    /// Fills the hollow within `faces`; `vertices` are those of its old tets.
    pub(super) fn fill(
        &mut self,
        tets: &mut Tets,
        sites: &Sites,
        faces: &[Face],
        vertices: &[VertexId],
    ) -> Result<(), Stuck> {
        self.start(sites, faces, vertices);
        let mut most = 64 + 16 * faces.len() + faces.len() * faces.len();
        while let Some(key) = self.queue.pop() {
            let Some(&face) = self.open.get(&key) else { continue };
            most = most.checked_sub(1).ok_or(Stuck)?;
            let apex = self.apex(sites, face.vertices).ok_or(Stuck)?;
            self.place(tets, face, apex);
        }
        if self.open.is_empty() { Ok(()) } else { Err(Stuck) }
    }

    /// Clears the list of tets made.
    pub(super) fn begin(&mut self) {
        self.made.clear();
    }

    /// The tets made since [`Self::begin`].
    pub(super) fn made(&self) -> &[TetId] {
        &self.made
    }

    fn start(&mut self, sites: &Sites, faces: &[Face], vertices: &[VertexId]) {
        self.open.clear();
        self.queue.clear();
        self.bare.clear();
        self.strange.clear();
        self.vertices.clear();
        self.vertices.extend(faces.iter().flat_map(|f| f.vertices).chain(vertices.iter().copied()));
        self.vertices.sort_unstable();
        self.vertices.dedup();
        self.is_guided = faces.len() > MAX_UNGUIDED;
        if self.is_guided {
            self.guide.build(sites, &self.vertices);
        }
        faces.iter().for_each(|&face| self.open(face));
    }

    fn open(&mut self, face: Face) {
        let key = smallest_first(face.vertices);
        self.open.insert(key, face);
        self.queue.push(key);
        if self.is_guided && !self.guide.has(face.vertices) {
            self.strange.insert(key);
        }
    }

    /// Removes an open face.
    fn close(&mut self, vertices: [VertexId; 3]) -> Option<Face> {
        let key = smallest_first(vertices);
        self.strange.remove(&key);
        self.open.remove(&key)
    }

    /// Adds the tet on a face: each of its other three faces closes an open one, or becomes open.
    fn place(&mut self, tets: &mut Tets, face: Face, apex: VertexId) {
        let [a, b, c] = face.vertices;
        let tet = tets.add([a, b, c, apex]);
        self.made.push(tet);
        self.close(face.vertices);
        self.join(tets, HalfFacet::new(tet, 3), face);
        for (i, facet) in FACETS.into_iter().enumerate().take(3) {
            let half = HalfFacet::new(tet, i);
            // As seen from the hollow behind it.
            let [p, q, r] = facet.map(|k| [a, b, c, apex][k]);
            match self.close([p, r, q]) {
                Some(other) => self.join(tets, half, other),
                None => self.open(Face { vertices: [p, q, r], outer: half }),
            }
        }
    }

    fn join(&mut self, tets: &mut Tets, half: HalfFacet, face: Face) {
        tets.join(half, face.outer);
        if face.outer.is_none() {
            self.bare.insert(smallest_first(face.vertices), half);
        }
    }

    /// The facet of a new tet on the inner side of a face with nothing behind it.
    pub(super) fn inner(&self, face: [VertexId; 3]) -> Option<HalfFacet> {
        self.bare.get(&smallest_first(face)).copied()
    }

    /// The apex of the tet on a face.
    fn apex(&mut self, sites: &Sites, face: [VertexId; 3]) -> Option<VertexId> {
        let [a, b, c] = face;
        let guided = if self.is_guided { self.guide.apex(face) } else { None };
        if let Some(v) = guided.filter(|v| !sites.around_all().contains(v)) {
            let is_cut = |key: &[VertexId; 3]| cuts(sites, *key, [a, b, c, v]);
            if !self.strange.iter().any(is_cut) {
                return Some(v);
            }
        }
        self.find_apex(sites, face)
    }

    /// Finds the apex of the tet on a face by trying all vertices.
    fn find_apex(&mut self, sites: &Sites, face: [VertexId; 3]) -> Option<VertexId> {
        let [a, b, c] = face;
        let is_in_front = |&v: &VertexId| !face.contains(&v) && sites.orient3d([a, b, c, v]) > 0;
        let mut candidates = std::mem::take(&mut self.candidates);
        candidates.clear();
        candidates.extend(self.vertices.iter().copied().filter(is_in_front));
        let mut apex = None;
        while !candidates.is_empty() {
            let mut best = 0;
            for i in 1..candidates.len() {
                if sites.is_inside([a, b, c, candidates[best]], candidates[i]) {
                    best = i;
                }
            }
            let v = candidates.swap_remove(best);
            if self.fits(sites, [a, b, c, v]) {
                apex = Some(v);
                break;
            }
        }
        self.candidates = candidates;
        apex
    }

    /// Whether no open face cuts into a tet.
    fn fits(&self, sites: &Sites, tet: [VertexId; 4]) -> bool {
        self.open.values().all(|face| !cuts(sites, face.vertices, tet))
    }
}

/// Whether a triangle has points in common with the interior of a positive tet.
///
/// Two convex bodies have none exactly when a plane separates them. If there is such a plane, there is one
/// through three of their vertices: it can be turned until it touches that many. The tet never lies in a
/// plane, so degenerate triples, which have all four vertices on side 0, are rejected.
fn cuts(sites: &Sites, face: [VertexId; 3], tet: [VertexId; 4]) -> bool {
    if face.iter().all(|v| tet.contains(v)) {
        return false;
    }
    let parts = |plane: [VertexId; 3]| {
        let [a, b, c] = plane;
        let side = |v: &VertexId| if plane.contains(v) { 0 } else { sites.orient3d([a, b, c, *v]) };
        let of_tet = tet.iter().map(side).fold([false; 2], |[m, p], s| [m || s < 0, p || s > 0]);
        let of_face = |bad: i8| face.iter().all(|v| side(v) != bad);
        match of_tet {
            [true, false] => of_face(-1),
            [false, true] => of_face(1),
            _ => false,
        }
    };
    let mut planes =
        FACETS.into_iter().map(|f| f.map(|i| tet[i])).chain([face]).chain(planes_between(face, tet));
    !planes.any(parts)
}

/// The planes through two vertices of one body and one vertex of the other.
fn planes_between(face: [VertexId; 3], tet: [VertexId; 4]) -> impl Iterator<Item = [VertexId; 3]> {
    let pairs_of_tet = EDGES.into_iter().map(move |[i, j]| [tet[i], tet[j]]);
    let through_face = move |[p, q]: [VertexId; 2]| face.into_iter().map(move |v| [p, q, v]);
    let pairs_of_face = (0..3).map(move |i| [face[i], face[(i + 1) % 3]]);
    let through_tet = move |[p, q]: [VertexId; 2]| tet.into_iter().map(move |v| [p, q, v]);
    let all = pairs_of_tet.flat_map(through_face).chain(pairs_of_face.flat_map(through_tet));
    all.filter(|[a, b, c]| a != b && b != c && a != c)
}
