//! Rows of new tets: each comes from the removed tets that it overlaps, in proportion to the common volume.

use std::collections::BTreeMap;

use super::{CellRow, Labelled, LocalChange, map};
use crate::base::{Error, Point, Result, Threads};
use crate::geometry::overlap::Solid;
use crate::geometry::tet;
use crate::geometry::vector::{dot, sub};
use crate::mesh::history::RegionLedger;
use crate::spatial::BoxTree;
use crate::spatial::boxes::bounding_box;

/// A new tet of which no larger fraction than this is covered by removed tets counts as outside.
const MIN_COVERED: f64 = 1e-12;

/// The removed tets, ready for searching.
pub(super) struct Removed<'a> {
    pub(super) tets: &'a [Labelled<4>],
    pub(super) solids: Vec<Solid>,
    pub(super) tree: BoxTree,
}

impl<'a> Removed<'a> {
    pub(super) fn new(points: &[Point], tets: &'a [Labelled<4>]) -> Self {
        let solids: Vec<Solid> = tets.iter().map(|t| solid(points, t)).collect();
        let boxes: Vec<_> = solids.iter().map(|s| bounding_box(s.corners())).collect();
        Self { tets, solids, tree: BoxTree::new(&boxes) }
    }

    /// The index of the removed tet nearest to `p`, in one region or in any, and the weights of its closest
    /// point.
    pub(super) fn nearest(&self, p: Point, region: Option<i32>) -> Option<(usize, [f64; 4])> {
        let measure = |i: u32| {
            let i = i as usize;
            let corners = self.solids[i].corners();
            let serves = region.is_none_or(|region| region == self.tets[i].label);
            serves.then(|| tet::closest(corners, p)).map(|weights| {
                let offset = sub(tet::at(corners, weights), p);
                (dot(offset, offset), weights)
            })
        };
        self.tree.nearest(p, measure).map(|(_, i, weights)| (i as usize, weights))
    }
}

fn solid(points: &[Point], tet: &Labelled<4>) -> Solid {
    Solid::new(tet.vertices.map(|v| points[v.index()]))
}

/// One new tet: its volume, the removed tets that it overlaps (by index, with the common volumes), and the
/// main one.
struct Parts {
    volume: f64,
    overlaps: Vec<(usize, f64)>,
    main: usize,
}

/// The row of each new tet, and the volumes of each region.
pub(super) fn trace(
    change: &LocalChange<'_>,
    removed: &Removed<'_>,
    threads: &Threads,
) -> Result<(Vec<CellRow>, Vec<RegionLedger>)> {
    let found = map(change.new_tets, threads, |tet| parts(change, removed, tet));
    let found: Vec<Parts> = found.into_iter().collect::<Result<_>>()?;
    let regions = ledger(change, removed, &found);
    let cell = |i: usize| removed.tets[i].cell;
    let rows = change.new_tets.iter().zip(found).map(|(tet, parts)| {
        let shares = parts.overlaps.iter().map(|&(i, volume)| (cell(i), volume)).collect();
        (tet.cell, shares, cell(parts.main))
    });
    Ok((rows.collect(), regions))
}

fn parts(change: &LocalChange<'_>, removed: &Removed<'_>, tet: &Labelled<4>) -> Result<Parts> {
    let solid = solid(change.new_points, tet);
    let mut candidates = Vec::new();
    removed.tree.touching(bounding_box(solid.corners()), &mut candidates);
    let mut overlaps: Vec<(usize, f64)> = Vec::new();
    for i in candidates.into_iter().map(|i| i as usize).filter(|&i| removed.tets[i].label == tet.label) {
        overlaps.extend(solid.real_overlap(&removed.solids[i]).map(|volume| (i, volume)));
    }
    let covered: f64 = overlaps.iter().map(|o| o.1).sum();
    let volume = solid.volume();
    if covered > MIN_COVERED * volume {
        let largest = overlaps.iter().fold((0, 0.0), |best, &o| if o.1 > best.1 { o } else { best });
        return Ok(Parts { volume, overlaps, main: largest.0 });
    }
    let nearest = removed.nearest(tet::centroid(solid.corners()), Some(tet.label));
    let (main, _) = nearest.ok_or_else(|| no_source(tet))?;
    Ok(Parts { volume, overlaps: vec![(main, 1.0)], main })
}

fn no_source(tet: &Labelled<4>) -> Error {
    Error::input(format!("is new in region {}, but no tet of that region was removed", tet.label))
        .at(format!("cell {}", tet.cell))
        .remedy(
            "values are not carried from one region to another: list the removed tets that it \
             replaces, in the same region",
        )
}

fn ledger(change: &LocalChange<'_>, removed: &Removed<'_>, found: &[Parts]) -> Vec<RegionLedger> {
    let mut regions: BTreeMap<i32, RegionLedger> = BTreeMap::new();
    let mut taken = vec![0.0; removed.tets.len()];
    for (tet, parts) in change.new_tets.iter().zip(found) {
        regions.entry(tet.label).or_default().volume_after += parts.volume;
        let covered: f64 = parts.overlaps.iter().map(|o| o.1).sum();
        for &(i, overlap) in &parts.overlaps {
            taken[i] += parts.volume * (overlap / covered);
        }
    }
    for ((tet, solid), taken) in removed.tets.iter().zip(&removed.solids).zip(taken) {
        let entry = regions.entry(tet.label).or_default();
        entry.volume_before += solid.volume();
        entry.deviation += (taken - solid.volume()).abs();
    }
    regions.into_iter().map(|(region, entry)| RegionLedger { region, ..entry }).collect()
}
