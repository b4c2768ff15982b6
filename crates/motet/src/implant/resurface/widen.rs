//! Widens narrow triangles of the new surface, as far as that leaves it near the old one and free of
//! crossings.
//!
//! Of all that could be done about a triangle (flip one of its edges, collapse one, move a vertex towards the
//! mean of its neighbours and back onto the old surface), the best change is made, as long as any helps.

use super::old::OriginalSurface;
use super::sheet::{Change, Sheet, largest_cosine};
use super::skin::Skin;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::triangle::centroid;
use crate::geometry::vector::{add, scale, sub};
use crate::preflight::crossings;

/// The cosine of the smallest angle that is left alone, 30 degrees.
const MAX_COSINE: f64 = 0.866_025_403_784_438_6;

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
            let mut work = Widening { old: self, sheet: Sheet::new(skin), is_held: &is_held, tolerance };
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
        let mut changes: Vec<(f64, Change)> = Vec::new();
        for change in self.changes(t) {
            let before =
                change.removed.iter().map(|&t| largest_cosine(self.sheet.corners(t))).fold(-1.0, f64::max);
            let after = self.sheet.corners_after(&change).map(largest_cosine).fold(-1.0, f64::max);
            if after < before - GAIN {
                changes.push((after, change));
            }
        }
        changes.sort_by(|x, y| x.0.total_cmp(&y.0));
        let best = changes.into_iter().map(|(_, change)| change).find(|change| self.is_allowed(change));
        best.map(|change| self.sheet.commit(change)).is_some()
    }

    fn changes(&self, t: u32) -> Vec<Change> {
        let corners = self.sheet.triangle(t);
        let mut changes = Vec::new();
        for k in 0..3 {
            let [u, v] = [corners[k], corners[(k + 1) % 3]];
            changes.extend(self.sheet.flipped(u, v));
            let ends = [u, v].map(|v| self.sheet.points[v.index()]);
            let middle = self.on_old(scale(add(ends[0], ends[1]), 0.5));
            let places = [(v, u, Some(ends[0])), (u, v, Some(ends[1])), (u, v, middle)];
            changes.extend(
                places
                    .into_iter()
                    .filter_map(|(removed, kept, place)| self.sheet.collapsed(removed, kept, place?)),
            );
            let to = sub(self.sheet.middle(u), ends[0]);
            let places = STEPS.map(|step| self.on_old(add(ends[0], scale(to, step))));
            changes.extend(places.into_iter().flatten().map(|place| self.sheet.moved(u, place)));
        }
        changes
    }

    fn on_old(&self, p: Point) -> Option<Point> {
        self.old.nearest.closest_within(p, self.tolerance).map(|found| found.point)
    }

    /// Whether nothing held changes, no triangle turns away, and all new triangles are near the old surface.
    /// Triangles that close a hole are not, and stay as they are.
    fn is_allowed(&self, change: &Change) -> bool {
        let of = |t: &u32| self.sheet.triangle(*t);
        if change.removed.iter().flat_map(of).any(|v| self.is_held[v.index()])
            || !self.sheet.keeps_facing(change)
        {
            return false;
        }
        let is_near = |reach: f64| {
            let places = self.sheet.corners_after(change).flat_map(places);
            places.into_iter().all(|p| self.old.nearest.closest_within(p, reach).is_some())
        };
        is_near(SHARE * self.tolerance)
    }
}

/// Where a triangle's distance from the old surface is measured: at corners, middles of edges, and the
/// centroid.
fn places([a, b, c]: [Point; 3]) -> [Point; 7] {
    let half = |p: Point, q: Point| scale(add(p, q), 0.5);
    [a, b, c, half(a, b), half(b, c), half(c, a), centroid([a, b, c])]
}
