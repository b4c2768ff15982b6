//! Makes every edge of the surface an edge of tets, in pieces where necessary.
//!
//! A segment that is not an edge of the triangulation gets points, which are inserted into the triangulation,
//! until all its pieces are edges. As every such point lies exactly on its segment, the shape of the surface
//! does not change.
//!
//! *Where to divide.* If an edge a b is missing, its diametral ball contains a vertex, and even one that is
//! joined to a: shrink the ball towards a until the last vertex leaves it. Let p be the neighbour of either
//! end in the ball that sees a b under the largest angle. Division at the foot of p on a b leaves two pieces
//! neither of which has p in its ball. On the stretched triangles of a coil and of a tube this took two
//! thirds of the points needed by halving, and half of those needed by cuts at the distance of p from an end.
//! But segments that meet at a sharp angle can divide each other at their feet forever. Small pieces are
//! therefore cut at the distance of p from the corner, which is the same on all of them (Si and Gaertner
//! 2005, *Meshing piecewise linear complexes by constrained Delaunay tetrahedralizations*; before them the
//! shells of Ruppert 1995).

use std::collections::VecDeque;

use hashbrown::HashMap;

use super::insert::Insertion;
use super::present::missing_edges;
use super::recovery::{Part, Unrecovered};
use super::share::Share;
use super::sites::{OnSegment, Place, SegmentId, Sites};
use crate::base::{Csr, Error, TetId, Threads, VertexId, sorted_ids};
use crate::geometry::vector::{distance, dot, sub};
use crate::kernel::Tets;

/// The number of points on segments beyond which recovery is given up as endless, in addition to
/// [`POINTS_PER_SEGMENT`] per segment.
const BASE_POINTS: usize = 8_000;
const POINTS_PER_SEGMENT: usize = 40;

/// Pieces below this fraction of their segment are small.
const SMALL: f64 = 1.0 / 256.0;

/// A piece is not divided nearer to an end than this fraction of its length.
const MIN_FRACTION: f64 = 0.005;

/// The edges of the surface and the pieces into which they are divided.
pub(super) struct Segments {
    /// The ends of each segment, the smaller one first; ascending.
    ends: Vec<[VertexId; 2]>,
    pieces: HashMap<[VertexId; 2], SegmentId>,
}

impl Segments {
    /// Starts with the given edges in one piece; each edge once, smaller end first, ascending.
    pub(super) fn new(ends: Vec<[VertexId; 2]>) -> Self {
        let pieces = ends.iter().enumerate().map(|(s, &e)| (e, SegmentId(s as u32))).collect();
        Self { ends, pieces }
    }

    /// The number of segments.
    pub(super) fn len(&self) -> usize {
        self.ends.len()
    }

    /// The ends of a segment.
    pub(super) fn ends(&self, segment: SegmentId) -> [VertexId; 2] {
        self.ends[segment.0 as usize]
    }

    /// The segment between two vertices of the surface.
    pub(super) fn find(&self, edge: [VertexId; 2]) -> Option<SegmentId> {
        self.ends.binary_search(&sorted_ids(edge)).ok().map(|s| SegmentId(s as u32))
    }

    /// Whether an edge is a piece of a segment.
    pub(super) fn has_piece(&self, edge: [VertexId; 2]) -> bool {
        self.pieces.contains_key(&edge)
    }

    /// The segment to which a piece belongs.
    pub(super) fn of_piece(&self, piece: [VertexId; 2]) -> SegmentId {
        self.pieces[&sorted_ids(piece)]
    }

    /// The position on a segment of one of its vertices, in [0, 1].
    pub(super) fn share(&self, sites: &Sites, segment: SegmentId, vertex: VertexId) -> Share {
        let of_end = if vertex == self.ends(segment)[0] { Share::START } else { Share::END };
        sites.on_segment(vertex).map_or(of_end, |on| on.share)
    }

    /// The ends of a piece in the order in which they lie on its segment.
    pub(super) fn in_order(
        &self,
        sites: &Sites,
        segment: SegmentId,
        mut piece: [VertexId; 2],
    ) -> [VertexId; 2] {
        let share = |v: VertexId| self.share(sites, segment, v);
        piece.sort_by(|&a, &b| share(a).order(&share(b)));
        piece
    }

    /// Puts a vertex between the ends of a piece; returns the two new pieces.
    pub(super) fn divide(&mut self, piece: [VertexId; 2], vertex: VertexId) -> [[VertexId; 2]; 2] {
        let segment = self.of_piece(piece);
        self.pieces.remove(&sorted_ids(piece));
        piece.map(|end| {
            let half = sorted_ids([end, vertex]);
            self.pieces.insert(half, segment);
            half
        })
    }

    /// The points on each segment, from its first end to its second.
    pub(super) fn points(&self, sites: &Sites) -> Csr<VertexId> {
        let key = |(v, place): (VertexId, Place)| match place {
            Place::On(place) => Some((place.segment, place.share, v)),
            Place::In(..) => None,
        };
        let mut on: Vec<(SegmentId, Share, VertexId)> = sites.all_placed().filter_map(key).collect();
        on.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.order(&b.1)));
        Csr::from_pairs(self.ends.len(), || on.iter().map(|&(s, _, v)| (s.0 as usize, v)))
    }

    /// Divides segments until all pieces are edges of tets.
    pub(super) fn recover(
        &mut self,
        tets: &mut Tets,
        sites: &mut Sites,
        threads: &Threads,
    ) -> Result<(), Unrecovered> {
        let mut queue: VecDeque<[VertexId; 2]> = self.missing(tets, threads).into();
        let most = BASE_POINTS + POINTS_PER_SEGMENT * self.ends.len();
        let (mut insertion, mut star) = (Insertion::default(), Vec::new());
        let mut n_made = 0;
        while let Some(piece) = queue.pop_front() {
            threads.watch().report_and_check(
                "recovering edges of the surface",
                n_made,
                n_made + queue.len(),
            )?;
            n_made += 1;
            let Some(&segment) = self.pieces.get(&piece) else { continue };
            if tets.find_edge(piece, &mut star).is_some() {
                continue;
            }
            if sites.n_on_segments() == most {
                return Err(self.refused(
                    sites,
                    segment,
                    "needs, together with other edges, too many points on edges",
                ));
            }
            let Some(share) = self.where_to_divide(tets, sites, segment, piece, &mut star) else {
                return Err(self.refused(
                    sites,
                    segment,
                    "would have to be divided beyond the precision of its coordinates",
                ));
            };
            let start = tets.tet_of(piece[0]);
            let vertex = sites.add(self.ends(segment), OnSegment { segment, share: Share::of(share) });
            queue.extend(self.divide(piece, vertex));
            let lost = insertion.insert(tets, sites, vertex, start);
            queue.extend(lost.into_iter().filter(|edge| self.pieces.contains_key(edge)));
        }
        Ok(())
    }

    pub(super) fn refused(&self, sites: &Sites, segment: SegmentId, why: &str) -> Unrecovered {
        let [a, b] = self.ends(segment);
        let error = Error::input(format!("the edge of points {a} and {b} {why}"))
            .at(format!("the edge from {:?} to {:?}", sites.near(a), sites.near(b)))
            .remedy("use less stretched triangles there, or keep the surface farther from itself");
        Unrecovered { what: Some(Part::Edge([a, b])), error }
    }

    /// The segments that are not edges of tets; ascending.
    pub(super) fn missing(&self, tets: &Tets, threads: &Threads) -> Vec<[VertexId; 2]> {
        missing_edges(tets, &self.ends, threads)
    }

    /// Where to divide a piece, as a fraction of its segment; `None` where no number lies between its ends.
    fn where_to_divide(
        &self,
        tets: &mut Tets,
        sites: &Sites,
        segment: SegmentId,
        piece: [VertexId; 2],
        star: &mut Vec<TetId>,
    ) -> Option<f64> {
        let ends = self.in_order(sites, segment, piece);
        let [low, high] = ends.map(|v| self.share(sites, segment, v).near());
        let sharpest = sharpest(tets, sites, ends, star);
        let from_corner = sharpest.and_then(|p| self.as_far(sites, segment, p));
        let is_well_within =
            |&s: &f64| (MIN_FRACTION..1.0 - MIN_FRACTION).contains(&((s - low) / (high - low)));
        let share = from_corner.filter(is_well_within).unwrap_or_else(|| {
            low + (high - low) * sharpest.map_or(0.5, |p| within(sites, ends, p, high - low < SMALL))
        });
        [share, low + 0.5 * (high - low)].into_iter().find(|&s| low < s && s < high)
    }

    /// The fraction of a segment that is as far from its corner as `p`, where `p` lies on another segment at
    /// that corner.
    fn as_far(&self, sites: &Sites, segment: SegmentId, p: VertexId) -> Option<f64> {
        let others = self.ends(sites.on_segment(p)?.segment);
        let [a, b] = self.ends(segment);
        let length = distance(sites.near(a), sites.near(b));
        let from = |corner: VertexId| distance(sites.near(corner), sites.near(p)) / length;
        match [a, b].map(|corner| others.contains(&corner)) {
            [true, false] => Some(from(a)),
            [false, true] => Some(1.0 - from(b)),
            _ => None,
        }
    }
}

/// Where to divide a piece, as a fraction of the way from its first end to its second, in (0, 1).
fn within(sites: &Sites, ends: [VertexId; 2], p: VertexId, is_small: bool) -> f64 {
    let ([a, b], p) = (ends.map(|v| sites.near(v)), sites.near(p));
    let length = distance(a, b);
    if !is_small {
        let foot = dot(sub(p, a), sub(b, a)) / (length * length);
        return if (MIN_FRACTION..1.0 - MIN_FRACTION).contains(&foot) { foot } else { 0.5 };
    }
    let [to_a, to_b] = [distance(a, p) / length, distance(b, p) / length];
    let or_middle = |x: f64| if x > 0.0 && x < 0.8 { x } else { 0.5 };
    match ends.map(|v| sites.on_segment(v).is_none()) {
        [true, false] => or_middle(to_a),
        [false, true] => 1.0 - or_middle(to_b),
        _ => 0.5,
    }
}

/// The neighbour of either end that lies in the diametral ball and sees the ends under the largest angle.
fn sharpest(
    tets: &mut Tets,
    sites: &Sites,
    [a, b]: [VertexId; 2],
    star: &mut Vec<TetId>,
) -> Option<VertexId> {
    let mut best: Option<(f64, VertexId)> = None;
    for end in [a, b] {
        tets.star(end, star);
        for v in star.iter().flat_map(|&tet| tets.vertices(tet)).filter(|&v| v != a && v != b) {
            let [to_a, to_b] = [a, b].map(|end| sub(sites.near(end), sites.near(v)));
            let cosine = dot(to_a, to_b) / (dot(to_a, to_a) * dot(to_b, to_b)).sqrt();
            let is_better = best.is_none_or(|(least, of)| cosine < least || cosine == least && v < of);
            if cosine <= 0.0 && is_better {
                best = Some((cosine, v));
            }
        }
    }
    best.map(|(_, v)| v)
}
