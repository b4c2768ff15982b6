//! Parts of divided surfaces that are connected without crossing the other one: each lies on one side of it
//! as a whole.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::cut::Cut;
use crate::base::{DisjointSets, Point, Threads, VertexId, sorted_ids};
use crate::contact::inside;
use crate::geometry::triangle::{area, centroid};

/// The triangles of the devices and the faces, divided where they meet.
pub(super) struct Divided<'a> {
    pub(super) cut: &'a Cut,
    /// The pieces of the devices' triangles.
    pub(super) devices: Parts<'a>,
    /// The pieces of the faces.
    pub(super) faces: Parts<'a>,
}

/// The pieces of the devices' triangles, or of the faces, and where they lie relative to the other surface.
pub(super) struct Parts<'a> {
    /// The pieces, with the triangle that each is, or is a part of.
    pub(super) pieces: &'a [([VertexId; 3], u32)],
    /// The part of each piece, by number; parts are connected without crossing the other surface.
    pub(super) parts: Vec<usize>,
    /// A point in each part.
    places: Vec<Point>,
}

/// The edges that pieces of both surfaces have.
pub(super) fn common_edges(cut: &Cut) -> BTreeSet<[VertexId; 2]> {
    let edges = |s: usize| {
        let vertices = cut.pieces[s].iter().map(|(t, _)| *t);
        vertices.flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]).map(sorted_ids)
    };
    // Edges of the devices whose ends are both of the other surface as well.
    let of_faces: BTreeSet<VertexId> = cut.pieces[1].iter().flat_map(|(t, _)| *t).collect();
    let candidates: BTreeSet<[VertexId; 2]> =
        edges(0).filter(|edge| edge.iter().all(|v| of_faces.contains(v))).collect();
    if candidates.is_empty() {
        candidates
    } else {
        edges(1).filter(|edge| candidates.contains(edge)).collect()
    }
}

impl<'a> Divided<'a> {
    /// `on_both` are the edges that pieces of both surfaces have.
    pub(super) fn new(cut: &'a Cut, on_both: &BTreeSet<[VertexId; 2]>) -> Self {
        let [devices, faces] = [0, 1].map(|s| Parts::new(cut, s, on_both));
        Self { cut, devices, faces }
    }
}

impl<'a> Parts<'a> {
    fn new(cut: &'a Cut, s: usize, on_both: &BTreeSet<[VertexId; 2]>) -> Self {
        let pieces = &cut.pieces[s];
        let mut first_at: HashMap<[VertexId; 2], u32> = HashMap::new();
        let mut sets = DisjointSets::new(pieces.len());
        for (i, &([a, b, c], _)) in (0u32..).zip(pieces) {
            for edge in
                [[a, b], [b, c], [c, a]].map(sorted_ids).iter().filter(|edge| !on_both.contains(*edge))
            {
                sets.join(*first_at.entry(*edge).or_insert(i), i);
            }
        }
        let mut largest: BTreeMap<u32, (f64, Point)> = BTreeMap::new();
        let roots = sets.roots();
        for (root, (t, _)) in roots.iter().zip(pieces) {
            let corners = t.map(|v| cut.points[v.index()]);
            let known = largest.entry(*root).or_default();
            if area(corners) > known.0 {
                *known = (area(corners), centroid(corners));
            }
        }
        let order: HashMap<u32, usize> = largest.keys().copied().zip(0..).collect();
        let parts = roots.iter().map(|root| order[root]).collect();
        Self { pieces, parts, places: largest.into_values().map(|(_, place)| place).collect() }
    }

    /// Which parts lie in a closed surface.
    pub(super) fn are_inside(&self, cut: &Cut, surface: &[[VertexId; 3]], threads: &Threads) -> Vec<bool> {
        let mut points = cut.points.clone();
        let first = points.len();
        points.extend(&self.places);
        let queries: Vec<VertexId> = (first..points.len()).map(VertexId::new).collect();
        inside(&points, &queries, &[], surface, &[], threads)
    }
}
