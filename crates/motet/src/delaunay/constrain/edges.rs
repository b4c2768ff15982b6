//! Makes every edge of the surface an edge of tets: by swaps of tets where possible, by points on the edge
//! elsewhere.
//!
//! As tets need not stay Delaunay, no part of the surface is lost once recovered, so there is no cascade:
//! each swap reduces the number of facets that one edge meets, and a point halves it. If all else fails,
//! points at all of these facets leave pieces that meet a single facet each, where a two-three swap of the
//! adjacent tets is always possible (George, Borouchaki and Saltel 2003, *'Ultimate' robustness in meshing an
//! arbitrary polyhedron*).

use std::collections::VecDeque;

use super::path::{SegmentPath, meets};
use super::recovery::{Order, Part, Unrecovered};
use super::segments::Segments;
use super::share::Share;
use super::sites::{OnSegment, Sites};
use super::split::{Protected, Split, faces_around, positive_part, round_between};
use super::swap::{Swap, Target};
use crate::base::{TetId, VertexId, sorted_ids};
use crate::kernel::{HalfFacet, Tets};

/// An edge that meets at most this many facets may have twice that number of swaps without gain before it
/// gets a point: such swaps may make way for one that gains.
const MAX_FACETS_FOR_NEUTRAL: usize = 12;

/// The fraction of an edge that has space for enough distinct numbers.
const MIN_INTERVAL: f64 = 1e-9;

/// The fraction of an edge that has space for an `f64`; where there is that much, the point gets few digits,
/// since signs are more expensive with more.
const MIN_INTERVAL_F64: f64 = 1e-13;

/// Where facets cannot be distinguished, a point this far beside them leaves a piece on which they are
/// farther apart.
const BESIDE: f64 = 1e-9;

/// The number of points on edges beyond which recovery is given up, in addition to [`POINTS_PER_SEGMENT`] per
/// segment.
const BASE_POINTS: usize = 2_000;
const POINTS_PER_SEGMENT: usize = 4;

/// The tets, and the edges of the surface that they are to have.
pub(super) struct Edges<'a> {
    tets: &'a mut Tets,
    sites: &'a mut Sites,
    segments: &'a mut Segments,
    way: SegmentPath,
    swap: Swap,
    split: Split,
    /// Edges that no swap can remove.
    tried: Vec<[VertexId; 2]>,
}

/// A piece that is to become an edge, among others that must not be lost.
struct Missing<'a> {
    sites: &'a Sites,
    segments: &'a Segments,
    piece: [VertexId; 2],
}

impl Protected for Missing<'_> {
    fn has_edge(&self, edge: [VertexId; 2]) -> bool {
        self.segments.has_piece(edge)
    }

    fn has_facet(&self, _: [VertexId; 3]) -> bool {
        false
    }
}

impl Target for Missing<'_> {
    fn meets_facet(&self, face: [VertexId; 3]) -> u32 {
        u32::from(meets(self.sites, self.piece, face))
    }

    fn meets_edge(&self, _: [VertexId; 2]) -> u32 {
        0
    }
}

impl<'a> Edges<'a> {
    pub(super) fn new(tets: &'a mut Tets, sites: &'a mut Sites, segments: &'a mut Segments) -> Self {
        Self {
            tets,
            sites,
            segments,
            way: SegmentPath::default(),
            swap: Swap::default(),
            split: Split::default(),
            tried: Vec::new(),
        }
    }

    /// Makes all segments edges, in pieces where necessary.
    ///
    /// # Errors
    /// When an edge would have to be divided beyond the precision of its coordinates, or passes through a
    /// vertex or another edge.
    pub(super) fn recover(mut self, order: &Order<'_>) -> Result<(), Unrecovered> {
        let mut missing = self.segments.missing(self.tets, order.threads);
        missing.sort_by_key(|&edge| order.rank(|part| part == Part::Edge(edge)));
        let mut queue = VecDeque::from(missing);
        let mut n_made = 0;
        while let Some(piece) = queue.pop_front() {
            order.watch().report_and_check(
                "recovering edges of the surface",
                n_made,
                n_made + queue.len(),
            )?;
            n_made += 1;
            let mut n_neutral = None;
            while self.way.find(self.tets, self.sites, piece) {
                let n = self.way.facets.len();
                let n_neutral = n_neutral.get_or_insert(if n > MAX_FACETS_FOR_NEUTRAL { 0 } else { 2 * n });
                if self.swap(piece, 0, 0) {
                    continue;
                }
                if *n_neutral == 0 || !self.swap(piece, 1, *n_neutral) {
                    queue.extend(self.divide(piece)?);
                    break;
                }
                *n_neutral -= 1;
            }
        }
        Ok(())
    }

    /// Makes swaps after which the piece meets fewer facets; or, where `spare` is 1, the first possible swap
    /// from the facet `from` on after which it meets no more than before. Returns whether anything was
    /// swapped.
    fn swap(&mut self, piece: [VertexId; 2], n_neutral: u32, from: usize) -> bool {
        let missing = Missing { sites: self.sites, segments: self.segments, piece };
        self.tried.clear();
        let faces: Vec<_> = self.way.facets.iter().map(|&half| (half, self.tets.inward(half))).collect();
        let mut has_swapped = false;
        for i in 0..faces.len() {
            let (half, [p, q, r]) = faces[(i + from) % faces.len()];
            if self.tets.inward(half) != [p, q, r] {
                continue;
            }
            let has_end = [p, q, r].iter().any(|v| piece.contains(v));
            if !has_end && Swap::open(self.tets, self.sites, half, &missing) {
                has_swapped = true;
                continue;
            }
            for edge in [[p, q], [q, r], [r, p]].map(sorted_ids) {
                if self.tried.contains(&edge) {
                    continue;
                }
                self.tried.push(edge);
                if self.swap.remove(self.tets, self.sites, edge, half.tet(), &missing, n_neutral) {
                    if n_neutral > 0 {
                        return true;
                    }
                    has_swapped = true;
                    break;
                }
            }
        }
        has_swapped
    }

    /// Puts a point on a piece, where it sees all tets at one of the facets met; returns the two new pieces.
    fn divide(&mut self, piece: [VertexId; 2]) -> Result<[[VertexId; 2]; 2], Unrecovered> {
        let segment = self.segments.of_piece(piece);
        if self.sites.n_on_segments() > BASE_POINTS + POINTS_PER_SEGMENT * self.segments.len() {
            return Err(self.segments.refused(
                self.sites,
                segment,
                "needs, together with other edges, too many points on edges",
            ));
        }
        let ends = self.segments.in_order(self.sites, segment, piece);
        let [low, high] = ends.map(|v| self.segments.share(self.sites, segment, v));
        let length = high.minus(low);
        let (seen, wanted) = self.room(ends, length);
        let share = if (seen[1] - seen[0]) * length > MIN_INTERVAL_F64 {
            Share::of(round_between(seen.map(|at| low.near() + length * at)))
        } else {
            low.plus(length * round_between(seen))
        };
        let is_between = |s: &Share| low.order(s).is_lt() && s.order(&high).is_lt();
        let Some(share) = [share, low.plus(0.5 * length)].into_iter().find(is_between) else {
            return Err(self.segments.refused(
                self.sites,
                segment,
                "would have to be divided beyond the precision of its coordinates",
            ));
        };
        let vertex = self.sites.add(self.segments.ends(segment), OnSegment { segment, share });
        let all = (&self.way.tets[..], &wanted[..]);
        let missing = Missing { sites: self.sites, segments: self.segments, piece };
        if !self.split.insert(self.tets, self.sites, vertex, all, &missing) {
            return Err(self.segments.refused(
                self.sites,
                segment,
                "passes through another edge or a triangle",
            ));
        }
        Ok(self.segments.divide(piece, vertex))
    }

    /// The two tets at a facet that the segment meets, or all those around the facet's edge that it meets.
    fn around_crossing(&mut self, [a, b]: [VertexId; 2], half: HalfFacet) -> Vec<TetId> {
        let [p, q, r] = self.tets.inward(half);
        let is_met = |&[p, q]: &[VertexId; 2]| self.sites.orient3d([a, b, p, q]) == 0;
        let mut tets = Vec::new();
        match [[p, q], [q, r], [r, p]].into_iter().find(is_met) {
            Some(edge) => self.tets.around_from(edge, half.tet(), &mut tets),
            None => tets.extend([half.tet(), self.tets.across(half).tet()]),
        }
        tets
    }

    /// Finds the part of the way between two vertices from which all tets at a facet met on it are seen, and
    /// returns it with those tets. The facet is the one nearest to the middle that leaves space for numbers,
    /// or else the one that leaves most. `length` is that of the way as a fraction of the segment.
    fn room(&mut self, ends: [VertexId; 2], length: f64) -> ([f64; 2], Vec<TetId>) {
        let met = self.met(ends);
        let middle = met.len() / 2;
        let Some(&(at_middle, _)) = met.get(middle) else { return ([0.0, 1.0], Vec::new()) };
        let mut from_middle: Vec<(usize, HalfFacet)> =
            met.into_iter().enumerate().map(|(i, (_, half))| (i.abs_diff(middle), half)).collect();
        from_middle.sort_unstable();
        let mut best = ([0.0, 0.0], Vec::new());
        for (_, half) in from_middle {
            let tets = self.around_crossing(ends, half);
            let of_ends =
                |[p, q, r]: [VertexId; 3]| self.sites.volume_ratios([[p, q, r, ends[0]], [p, q, r, ends[1]]]);
            let seen = positive_part(faces_around(self.tets, &tets).into_iter().map(of_ends));
            let Some(seen) = seen else { continue };
            if seen[1] - seen[0] > best.0[1] - best.0[0] {
                best = (seen, tets);
            }
            if (seen[1] - seen[0]) * length > MIN_INTERVAL {
                break;
            }
        }
        if !best.1.is_empty() {
            return best;
        }
        let beside = if at_middle < 0.5 { at_middle + BESIDE } else { at_middle - BESIDE };
        ([beside; 2], best.1)
    }

    /// The facets met on the way between two vertices, in order, each with the fraction of the way.
    fn met(&self, [a, b]: [VertexId; 2]) -> Vec<(f64, HalfFacet)> {
        let mut met: Vec<(f64, HalfFacet)> = Vec::new();
        for &half in &self.way.facets {
            let [p, q, r] = self.tets.inward(half);
            let [of_a, of_b] = self.sites.volume_ratios([[p, q, r, a], [p, q, r, b]]);
            let share = of_a / (of_a - of_b);
            if share > 0.0 && share < 1.0 {
                met.push((share, half));
            }
        }
        met.sort_by(|s, t| s.0.total_cmp(&t.0).then(s.1.cmp(&t.1)));
        met
    }
}
