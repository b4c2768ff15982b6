//! Widens narrow triangles of the new surface, as far as that leaves it near the old one and free of
//! crossings.
//!
//! Of all that could be done about a triangle (flip one of its edges, collapse one, move a vertex towards the
//! mean of its neighbours and back onto the old surface), the best change is made, as long as any helps.

use super::old::OriginalSurface;
use super::skin::Skin;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::triangle::{area_vector, largest_cosine, middles};
use crate::geometry::vector::{add, dot, norm, scale, sub, unit};
use crate::preflight::crossings;
use crate::surface::{Change, Sheet};

/// The cosine of the smallest angle that is left alone, 30 degrees.
const MAX_COSINE: f64 = 0.866_025_403_784_438_6;

/// The cosine of the largest angle between two triangles whose edge is flipped: 30 degrees.
const MIN_FLIP_COSINE: f64 = 0.866;

/// The cosine of how far a triangle may turn in a change: 25 degrees.
const MIN_TURN_COSINE: f64 = 0.906;

/// How much the largest cosine has to fall, so that no work is done for negligible gains.
const GAIN: f64 = 1e-3;

/// How many passes are made over all narrow triangles.
const ROUNDS: usize = 4;

/// How often everything is done anew where triangles cross, with the vertices there held.
const RETRIES: usize = 4;

/// How much of the way to the mean of its neighbours a vertex may move.
const STEPS: [f64; 2] = [1.0, 0.5];

/// The fraction of the tolerance that changes may use.
const SHARE: f64 = 0.8;

impl OriginalSurface {
    /// The surface with wider triangles, within `tolerance` of the old one where it was before; `None` if
    /// crossings remain.
    pub(super) fn widened(&self, skin: &Skin, tolerance: f64, threads: &Threads) -> Option<Skin> {
        let mut is_held = vec![false; skin.points.len()];
        for _ in 0..RETRIES {
            let mut work = Widening {
                old: self,
                sheet: Sheet::new(skin.points.clone(), skin.triangles.clone(), vec![0; skin.triangles.len()]),
                is_held: &is_held,
                tolerance,
            };
            work.run();
            let sheet = work.sheet;
            let left: Vec<[VertexId; 3]> = sheet.existing().map(|t| sheet.triangle(t)).collect();
            let new: Vec<[VertexId; 3]> = changed(skin, &sheet).map(|t| sheet.triangle(t)).collect();
            let met = crossings(&sheet.points, &new, &left, threads);
            let mut is_free = true;
            for [i, j] in
                met.into_iter().map(|[i, j]| [new[i as usize], left[j as usize]]).filter(|[s, t]| s != t)
            {
                is_free = false;
                [i, j].as_flattened().iter().for_each(|v| is_held[v.index()] = true);
            }
            if is_free {
                return Some(Skin::compact(&sheet.points, left));
            }
        }
        None
    }
}

/// The triangles that have changed.
fn changed<'a>(before: &'a Skin, sheet: &'a Sheet) -> impl Iterator<Item = u32> + 'a {
    let is_same = |t: u32| {
        let triangle = sheet.triangle(t);
        triangle == before.triangles[t as usize]
            && triangle.iter().all(|v| sheet.points[v.index()] == before.points[v.index()])
    };
    sheet.existing().filter(move |&t| !is_same(t))
}

struct Widening<'a> {
    old: &'a OriginalSurface,
    sheet: Sheet,
    /// Vertices whose triangles must not change.
    is_held: &'a [bool],
    tolerance: f64,
}

impl Widening<'_> {
    fn run(&mut self) {
        for _ in 0..ROUNDS {
            let mut narrow: Vec<(f64, u32)> = self
                .sheet
                .existing()
                .map(|t| (largest_cosine(self.sheet.corners(t)), t))
                .filter(|(cosine, _)| *cosine > MAX_COSINE)
                .collect();
            narrow.sort_unstable_by(|x, y| y.0.total_cmp(&x.0).then(x.1.cmp(&y.1)));
            let n = narrow.into_iter().filter(|&(_, t)| self.widen(t)).count();
            if n == 0 {
                return;
            }
        }
    }

    /// Makes the best change that widens a triangle. Returns whether there was one.
    fn widen(&mut self, t: u32) -> bool {
        if !self.sheet.exists(t) || largest_cosine(self.sheet.corners(t)) <= MAX_COSINE {
            return false;
        }
        let mut proposals: Vec<(f64, Proposal)> = Vec::new();
        for proposal in self.proposals(t) {
            let Proposal { change, .. } = &proposal;
            let before =
                change.removed.iter().map(|&t| largest_cosine(self.sheet.corners(t))).fold(-1.0, f64::max);
            let after = self.sheet.corners_after(change).map(largest_cosine).fold(-1.0, f64::max);
            if after < before - GAIN {
                proposals.push((after, proposal));
            }
        }
        proposals.sort_by(|x, y| x.0.total_cmp(&y.0));
        let best = proposals.into_iter().map(|(_, proposal)| proposal).find(|best| self.is_allowed(best));
        best.map(|best| self.sheet.commit(&best.change)).is_some()
    }

    fn proposals(&self, t: u32) -> Vec<Proposal> {
        let corners = self.sheet.triangle(t);
        let mut proposals = Vec::new();
        for k in 0..3 {
            let [u, v] = [corners[k], corners[(k + 1) % 3]];
            proposals.extend(self.flipped(u, v));
            let ends = [u, v].map(|v| self.sheet.points[v.index()]);
            let middle = self.on_old(self.sheet.middle([u, v]));
            let places = [(v, u, Some(ends[0])), (u, v, Some(ends[1])), (u, v, middle)];
            proposals.extend(
                places.into_iter().filter_map(|(removed, kept, place)| self.collapsed(removed, kept, place?)),
            );
            let to = sub(self.mean_of_neighbours(u), ends[0]);
            let places = STEPS.map(|step| self.on_old(add(ends[0], scale(to, step))));
            proposals.extend(places.into_iter().flatten().map(|place| self.moved(u, place)));
        }
        proposals
    }

    fn normal(&self, t: u32) -> Point {
        unit(area_vector(self.sheet.corners(t))).unwrap_or_default()
    }

    /// Flips an edge whose two triangles do not bend too far.
    fn flipped(&self, u: VertexId, v: VertexId) -> Option<Proposal> {
        let change = self.sheet.flip([u, v])?;
        let &[s, t] = change.removed.as_slice() else { return None };
        let [m, n] = [s, t].map(|t| self.normal(t));
        let mean = unit(add(m, n))?;
        (dot(m, n) >= MIN_FLIP_COSINE).then(|| Proposal { change, normals: vec![mean; 2] })
    }

    /// Collapses an edge of two triangles, where both ends keep enough neighbours.
    fn collapsed(&self, removed: VertexId, kept: VertexId, place: Point) -> Option<Proposal> {
        let has_enough = |v: VertexId| self.sheet.neighbours(v).len() >= 4;
        if self.sheet.at_edge(removed, kept).count() != 2 || !has_enough(removed) || !has_enough(kept) {
            return None;
        }
        let change = self.sheet.collapse(removed, kept, place)?;
        let is_at_edge = |t: u32| [removed, kept].iter().all(|v| self.sheet.triangle(t).contains(v));
        let replaced = change.removed.iter().filter(|t| !is_at_edge(**t));
        let normals = replaced.map(|&t| self.normal(t)).collect();
        Some(Proposal { change, normals })
    }

    fn moved(&self, v: VertexId, place: Point) -> Proposal {
        let change = self.sheet.moved(v, place);
        let normals = change.removed.iter().map(|&t| self.normal(t)).collect();
        Proposal { change, normals }
    }

    fn mean_of_neighbours(&self, v: VertexId) -> Point {
        let neighbours = self.sheet.neighbours(v);
        let sum = neighbours.iter().fold([0.0; 3], |sum, u| add(sum, self.sheet.points[u.index()]));
        scale(sum, 1.0 / neighbours.len().max(1) as f64)
    }

    fn on_old(&self, p: Point) -> Option<Point> {
        self.old.nearest.closest_within(p, self.tolerance).map(|found| found.point)
    }

    /// Whether nothing held changes, no triangle turns away, and all new triangles are near the old surface.
    /// Triangles that close a hole are not, and stay as they are.
    fn is_allowed(&self, Proposal { change, normals }: &Proposal) -> bool {
        let of = |t: &u32| self.sheet.triangle(*t);
        let turned = self.sheet.corners_after(change).map(area_vector).zip(normals);
        if change.removed.iter().flat_map(of).any(|v| self.is_held[v.index()])
            || !turned.into_iter().all(|(now, before)| dot(now, *before) > MIN_TURN_COSINE * norm(now))
        {
            return false;
        }
        let reach = SHARE * self.tolerance;
        let places = self.sheet.corners_after(change).flat_map(|t| t.into_iter().chain(middles(t)));
        places.into_iter().all(|p| self.old.nearest.closest_within(p, reach).is_some())
    }
}

/// A change, and the unit normals that its new triangles have to keep, as far as [`MIN_TURN_COSINE`] allows.
struct Proposal {
    change: Change,
    normals: Vec<Point>,
}
