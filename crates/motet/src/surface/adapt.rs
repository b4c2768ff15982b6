//! Passes over a surface: long edges are split, short ones collapsed, edges flipped, vertices moved (Botsch,
//! Kobbelt 2004, *A remeshing approach to multiresolution modeling*), then narrow triangles made wider.

use std::collections::BTreeSet;

use super::features::{Kind, length};
use super::sheet::{Change, Sheet, edges_of};
use super::work::{Refusal, Work, cosines, is_due};
use crate::base::{Error, Point, Result, VertexId, entry, sorted_ids};
use crate::geometry::segment;
use crate::geometry::triangle::{area, centroid, largest_cosine, longest_side};
use crate::geometry::vector::{add, distance, scale};

/// Edges longer than this times the size are split; halves are then as near to it as the whole was.
const LONG: f64 = 4.0 / 3.0;
/// Edges shorter than this times the size are collapsed.
const SHORT: f64 = 0.8;
/// How many passes of splits a round makes at most. They end long before, except where triangles cross, so
/// that splits are refused.
const SPLITS: usize = 64;
/// Between splits of long edges short ones are collapsed while the longest becomes shorter by this.
const SHORTER: f64 = 0.9;
/// A flipped edge may be as long as this times the size, or as long as it was.
const FLIPPED: f64 = 2.0;
/// How many passes of flips are made at most.
const FLIPS: usize = 3;
/// How many rounds are made at most.
const ROUNDS: usize = 8;
/// The largest size between walls, over their distance: tets from triangles there to the opposite wall are
/// then wide enough.
const SIZE_OVER_GAP: f64 = 2.5;
/// Walls so near that the size would be less than this times the requested one would need too many triangles.
const LEAST_BETWEEN_WALLS: f64 = 0.25;
/// How much finer a surface may become in a round between lines that are near each other.
const MAX_FINER: f64 = 2.0;
/// The first round after which sizes do not rise again, so that rounds come to an end.
const SETTLED: usize = 2;
/// Rounds end when fewer than this fraction of the edges was split or collapsed.
const FEW: f64 = 0.005;
/// Rounds end when the mean of the least angles of all triangles grows by less than this, in degrees: where
/// what one round splits is collapsed by the next, they would not come to an end.
const WIDER: f64 = 0.25;
/// The cosine of the angle below which a triangle is narrow: 30 degrees.
const NARROW: f64 = 0.866;
/// The cosine of the angle that no change but one of worse triangles may fall below: 20 degrees.
const POOR: f64 = 0.94;
/// The least gain of a cosine.
const GAIN: f64 = 1e-3;
/// Vertices do not move by less than this times their size.
const STILL: f64 = 0.02;
/// The cosine of the angle below which triangles are made finer where they cannot be made wider: 26 degrees.
const HELD_BY_DISTANCE: f64 = 0.9;
/// By how much they are made finer in a round.
const FINER: f64 = 0.7;
/// A further round makes triangles finer if the last one left at most this fraction of the narrow ones.
const FEWER: f64 = 0.5;
/// How many rounds make triangles finer at most.
const FINER_ROUNDS: usize = 3;
/// How many passes are made over narrow triangles.
const WIDENINGS: usize = 12;

impl Work<'_> {
    /// Brings edges to their sizes. `sizes` gives those requested of a place of a label, `growth` how much
    /// they may grow per unit of distance.
    pub(super) fn adapt(&mut self, sizes: impl Fn(&Self, u32, Point) -> f64, growth: f64) -> Result<()> {
        let mut before = 0.0;
        for round in 0..ROUNDS {
            self.threads.watch().report_and_check("making the surface even", round, ROUNDS)?;
            let (n_changed, needed) = self.round(round >= SETTLED)?;
            self.resize(&sizes, &needed, growth, round >= SETTLED);
            let n_edges = 1.5 * self.sheet.existing().count() as f64;
            let after = self.mean_angle();
            if (n_changed as f64) < FEW * n_edges || round > SETTLED && after < before + WIDER {
                break;
            }
            before = after;
        }
        self.widen_all();
        let mut n_narrow = usize::MAX;
        for _ in 0..FINER_ROUNDS {
            let narrow = self.narrow_by_distance();
            if narrow.is_empty() || narrow.len() as f64 > FEWER * n_narrow as f64 {
                break;
            }
            n_narrow = narrow.len();
            let vertices = narrow.into_iter().flat_map(|t| self.sheet.triangle(t));
            let finer: Vec<_> = vertices.map(|v| (v, FINER * self.sizes[v.index()])).collect();
            self.resize(&sizes, &finer, growth, true);
            self.round(true)?;
            self.widen_all();
        }
        self.fit(NARROW);
        Ok(())
    }

    /// The mean of the least angles of all triangles, in degrees.
    fn mean_angle(&self) -> f64 {
        let angle = |t| largest_cosine(self.sheet.corners(t)).clamp(-1.0, 1.0).acos().to_degrees();
        let (sum, n) = self.sheet.existing().fold((0.0, 0.0), |(sum, n), t| (sum + angle(t), n + 1.0));
        sum / n
    }

    /// Splits, collapses, flips and moves once. Returns how many edges were split or collapsed, and the sizes
    /// of vertices whose edges are as short as the given surface needs.
    fn round(&mut self, is_settled: bool) -> Result<(usize, Vec<(VertexId, f64)>)> {
        let n_split = self.split_long()?;
        let (n_collapsed, needed) = self.collapse_short(is_settled);
        self.flip_all();
        self.smooth();
        Ok((n_split + n_collapsed, needed))
    }

    /// Triangles that stay narrow although not all of their corners are held: the distance leaves smaller
    /// ones more room.
    fn narrow_by_distance(&self) -> Vec<u32> {
        let mut narrow = self.narrow(HELD_BY_DISTANCE);
        let is_free = |v: &VertexId| self.features.kind(*v) == Kind::Free;
        narrow.retain(|&t| self.sheet.triangle(t).iter().any(is_free));
        narrow
    }

    /// Sets the sizes as requested, but no larger than `needed` at some vertices. Sizes that were needed
    /// before are forgotten unless `is_settled`.
    fn resize(
        &mut self,
        sizes: &impl Fn(&Self, u32, Point) -> f64,
        needed: &[(VertexId, f64)],
        growth: f64,
        is_settled: bool,
    ) {
        if !is_settled {
            self.collapses.clear();
        }
        for v in 0..self.sheet.points.len() {
            if self.is_held(VertexId::new(v)) {
                continue;
            }
            if let Some(&t) = self.sheet.star(VertexId::new(v)).first() {
                let requested = sizes(self, self.sheet.label(t), self.sheet.points[v]);
                let requested = self.between_walls(VertexId::new(v), requested);
                self.sizes[v] = if is_settled { self.sizes[v].min(requested) } else { requested };
            }
        }
        for &(v, size) in needed {
            self.sizes[v.index()] = self.sizes[v.index()].min(size);
        }
        self.grade(growth);
    }

    /// The size at a vertex where a wall opposite to it may be too near for wide tets between triangles
    /// of the requested size.
    fn between_walls(&self, v: VertexId, requested: f64) -> f64 {
        if !self.is_for_tets {
            return requested;
        }
        let Some(normal) = self.sheet.normal(v) else { return requested };
        let apart = self.original.opposite(self.sheet.points[v.index()], normal, requested / SIZE_OVER_GAP);
        match apart.map(|apart| SIZE_OVER_GAP * apart) {
            Some(size) if size > LEAST_BETWEEN_WALLS * requested => size,
            _ => requested,
        }
    }

    /// Lowers sizes that grow by more than `growth` times the distance.
    pub(super) fn grade(&mut self, growth: f64) {
        let mut edges: Vec<([VertexId; 2], f64)> =
            self.sheet.edges().into_iter().map(|edge| (edge, growth * length(&self.sheet, edge))).collect();
        loop {
            let mut is_changed = false;
            for &([u, v], more) in &edges {
                let [of_u, of_v] = [u, v].map(|v| self.sizes[v.index()]);
                // Not for the last bits.
                if of_u > (of_v + more) * (1.0 + 1e-9) {
                    self.sizes[u.index()] = of_v + more;
                    is_changed = true;
                } else if of_v > (of_u + more) * (1.0 + 1e-9) {
                    self.sizes[v.index()] = of_u + more;
                    is_changed = true;
                }
            }
            if !is_changed {
                return;
            }
            edges.reverse();
        }
    }

    /// Splits long edges, the longest first. Returns how many.
    ///
    /// # Errors
    /// When there would be more than `max_triangles`.
    fn split_long(&mut self) -> Result<usize> {
        let (mut n, mut longest, mut refused) = (0, f64::INFINITY, BTreeSet::new());
        let mut since = 0;
        for _ in 0..SPLITS {
            if self.sheet.n_slots() > self.max_triangles {
                let what = format!("the adapted surface needs more than {} triangles", self.max_triangles);
                return Err(Error::options(what).remedy("give a larger size or distance"));
            }
            let now = self.changes.now();
            let mut long = self.edges_by_ratio(since, |ratio| ratio > LONG);
            long.reverse();
            let longest_now = long.first().map_or(0.0, |x| x.0);
            let mut n_now = 0;
            for (_, edge) in long {
                if refused.contains(&edge) || self.is_beside_longer(edge, &refused) {
                    continue;
                }
                if self.split(edge) {
                    n_now += 1;
                } else {
                    refused.insert(edge);
                }
            }
            if n_now == 0 {
                break;
            }
            n += n_now;
            // Parts of needles get shorter edges, and fewer vertices, before they are split themselves.
            self.flip_once(LONG, since);
            since = now;
            if longest_now > 2.0 * LONG && longest_now < SHORTER * longest {
                longest = longest_now;
                self.collapse_short(true);
            }
        }
        Ok(n)
    }

    /// Whether a triangle at an edge has a longer one among `refused`. That triangle has long edges however
    /// often the others are split.
    fn is_beside_longer(&self, edge: [VertexId; 2], refused: &BTreeSet<[VertexId; 2]>) -> bool {
        let ratio = self.ratio(edge);
        let mut others = self.sheet.at_edge(edge[0], edge[1]).flat_map(|t| edges_of(self.sheet.triangle(t)));
        !refused.is_empty()
            && others.any(|other| refused.contains(&sorted_ids(other)) && self.ratio(other) > ratio)
    }

    /// The edges of triangles that changed since a time, or of all if that is 0.
    fn edges_since(&self, time: u32) -> Vec<[VertexId; 2]> {
        self.sheet.edges_where(|t| self.sheet.triangle(t).iter().all(|v| !self.changes.none_since(*v, time)))
    }

    /// Edges that are not held, of triangles that changed since a time, whose lengths over their sizes are
    /// wanted, from the least of these ratios to the greatest.
    fn edges_by_ratio(&self, since: u32, is_wanted: impl Fn(f64) -> bool) -> Vec<(f64, [VertexId; 2])> {
        let edges = self.edges_since(since).into_iter().filter(|edge| !self.is_held_edge(*edge));
        let edges = edges.map(|edge| (self.ratio(edge), edge));
        let mut edges: Vec<_> = edges.filter(|x| is_wanted(x.0)).collect();
        edges.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        edges
    }

    /// Collapses short edges, the shortest first. Returns how many, and the sizes of vertices whose edges are
    /// as short as the given surface needs.
    fn collapse_short(&mut self, is_settled: bool) -> (usize, Vec<(VertexId, f64)>) {
        let short = self.edges_by_ratio(0, |ratio| ratio < SHORT);
        let (mut n, mut needed) = (0, Vec::new());
        let least = 2.0 * self.original.distance;
        for (_, edge) in short {
            let [u, v] = edge;
            if self.sheet.at_edge(u, v).next().is_none() || self.ratio(edge) >= SHORT {
                continue;
            }
            // Once sizes do not rise any more, what was refused stays so, and what it needed is known.
            if !is_due(&self.changes, self.collapses.entry(edge).or_default(), &edge) && is_settled {
                continue;
            }
            let longest = LONG * self.size(edge);
            let admits = |sheet: &Sheet, change: &Change| {
                let [before, after] = cosines(sheet, change);
                let of_before =
                    change.removed.iter().map(|&t| longest_side(sheet.corners(t))).fold(longest, f64::max);
                after <= before.max(POOR) && sheet.corners_after(change).all(|t| longest_side(t) <= of_before)
            };
            match self.collapse(edge, admits) {
                Ok(()) => n += 1,
                Err(Refusal::Bad) => {}
                // Between lines that meet, each shorter edge would require still shorter ones.
                Err(Refusal::Held) if is_settled => {}
                Err(why) => {
                    let least =
                        if why == Refusal::Held { least.max(self.size(edge) / MAX_FINER) } else { least };
                    let size = (length(&self.sheet, edge) / SHORT).max(least);
                    needed.extend([(u, size), (v, size)]);
                }
            }
        }
        (n, needed)
    }

    /// Flips edges where that widens the narrower of their triangles.
    fn flip_all(&mut self) {
        let mut since = 0;
        for _ in 0..FLIPS {
            let now = self.changes.now();
            if self.flip_once(FLIPPED, since) == 0 {
                return;
            }
            since = now;
        }
    }

    /// Makes one pass of flips of edges of triangles that changed since a time. New edges are no longer than
    /// `limit` times the size, or than the old ones. Returns how many there were.
    fn flip_once(&mut self, limit: f64, since: u32) -> usize {
        let mut n = 0;
        for edge in self.edges_since(since) {
            if self.is_held_edge(edge) {
                continue;
            }
            let longest = limit * self.size(edge);
            let admits = |sheet: &Sheet, change: &Change| {
                let [before, after] = cosines(sheet, change);
                let [c, _, d] = change.added[0].0.map(|v| sheet.points[v.index()]);
                let is_short = distance(c, d) < longest.max(length(sheet, edge));
                after < before - GAIN && is_short
            };
            n += usize::from(self.flip(edge, admits));
        }
        n
    }

    /// Moves each vertex towards the centroid of its triangles, weighted so that sizes are followed.
    fn smooth(&mut self) {
        for v in (0..self.sheet.points.len()).map(VertexId::new) {
            if self.sheet.star(v).is_empty()
                || !is_due(&self.changes, entry(&mut self.moved, v.index()), &[v])
            {
                continue;
            }
            let admits = |sheet: &Sheet, change: &Change| {
                let [before, after] = cosines(sheet, change);
                after <= before.max(NARROW)
            };
            match self.features.kind(v) {
                Kind::Free => {
                    let Some(place) = self.towards_centroid(v) else { continue };
                    if distance(place, self.sheet.points[v.index()]) > STILL * self.sizes[v.index()] {
                        self.shift(v, place, admits);
                    }
                }
                Kind::OnLine => {
                    let ends = self.features.line_ends(&self.sheet, v);
                    let &[a, b] = ends.as_slice() else { continue };
                    let [of_a, of_b] = [a, b].map(|end| self.ratio([v, end]));
                    let towards = if of_a > of_b { a } else { b };
                    let [of_towards, of_from] = [of_a.max(of_b), of_a.min(of_b)];
                    let fraction = 0.5 * (of_towards - of_from) / of_towards;
                    if fraction > 0.05 {
                        let way = [v, towards].map(|v| self.sheet.points[v.index()]);
                        self.shift_line(v, segment::at(way, fraction), admits);
                    }
                }
                Kind::Corner => {}
            }
        }
    }

    /// The centroid of a vertex's triangles, weighted by size, moved onto the given surface.
    fn towards_centroid(&self, v: VertexId) -> Option<Point> {
        let star = self.sheet.star(v);
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for &t in star {
            let corners = self.sheet.corners(t);
            let size = self.sheet.triangle(t).iter().map(|v| self.sizes[v.index()]).sum::<f64>();
            let weight = area(corners) / size.powi(4);
            sum = add(sum, scale(centroid(corners), weight));
            total += weight;
        }
        if total <= 0.0 {
            return None;
        }
        let label = self.sheet.label(*star.first()?);
        let target = scale(sum, 1.0 / total);
        let found = self.original.near(label, target, self.sizes[v.index()])?;
        Some(found.point)
    }

    /// Makes narrow triangles wider: edges flipped or collapsed, vertices moved, whatever their sizes; where
    /// that does not help, without the creases there.
    fn widen_all(&mut self) {
        let mut tried = Vec::new();
        for pass in 0..WIDENINGS {
            let n = self.narrow(NARROW).into_iter().filter(|&t| self.widen(t, &mut tried)).count();
            if n == 0 || pass + 1 == WIDENINGS {
                let at_creases = self.narrow(POOR);
                let vertices: Vec<VertexId> =
                    at_creases.iter().flat_map(|&t| self.sheet.triangle(t)).collect();
                let n = vertices.into_iter().filter(|v| self.features.release(&self.sheet, *v)).count();
                if n == 0 {
                    return;
                }
            }
        }
    }

    /// Triangles with an angle whose cosine is above a limit, the narrowest first.
    fn narrow(&self, limit: f64) -> Vec<u32> {
        let of = |t| (largest_cosine(self.sheet.corners(t)), t);
        let is_held = |t: &u32| self.sheet.triangle(*t).iter().all(|v| self.is_held(*v));
        let free = self.sheet.existing().filter(|t| !is_held(t));
        let mut narrow: Vec<(f64, u32)> = free.map(of).filter(|x| x.0 > limit).collect();
        narrow.sort_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
        narrow.into_iter().map(|(_, t)| t).collect()
    }

    /// Makes a triangle wider, if it is still narrow and something changed around it since that was tried.
    /// Returns whether it changed.
    fn widen(&mut self, t: u32, tried: &mut Vec<u32>) -> bool {
        if !self.sheet.exists(t)
            || largest_cosine(self.sheet.corners(t)) <= NARROW
            || !is_due(&self.changes, entry(tried, t as usize), &self.sheet.triangle(t))
        {
            return false;
        }
        let admits = |sheet: &Sheet, change: &Change| {
            let [before, after] = cosines(sheet, change);
            after < before - GAIN
        };
        let mut edges = edges_of(self.sheet.triangle(t));
        edges.sort_by(|x, y| length(&self.sheet, *x).total_cmp(&length(&self.sheet, *y)).then(x.cmp(y)));
        if self.flip(edges[2], admits) || self.flip(edges[1], admits) {
            return true;
        }
        let longest = 2.0 * LONG * self.size(edges[0]);
        let admits_short = |sheet: &Sheet, change: &Change| {
            admits(sheet, change) && sheet.corners_after(change).all(|t| longest_side(t) <= longest)
        };
        if edges.into_iter().any(|edge| self.collapse(edge, admits_short).is_ok()) {
            return true;
        }
        let corners = self.sheet.triangle(t);
        for v in corners {
            if self.features.kind(v) != Kind::Free {
                continue;
            }
            let Some(target) = self.towards_centroid(v) else { continue };
            let old = self.sheet.points[v.index()];
            let label = self.sheet.label(t);
            for step in [1.0, 0.5, 0.25] {
                let place: Point = std::array::from_fn(|k| old[k] + step * (target[k] - old[k]));
                let found = self.original.near(label, place, self.original.distance);
                if found.is_some_and(|found| self.shift(v, found.point, admits)) {
                    return true;
                }
            }
        }
        false
    }
}
