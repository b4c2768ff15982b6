//! How well the volumes of old and new tets fit, region by region.

use serde::{Deserialize, Serialize};

/// What a change did to volumes, and to vertices that ended outside of the old tets.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ledger {
    /// One entry for each region with a changed tet, by rising label.
    pub regions: Vec<RegionLedger>,
    /// New and moved vertices that lie in none of the old tets that went: they take the values of the nearest place.
    pub n_outside: usize,
    /// How far the farthest of these lies from there.
    pub farthest_outside: f64,
}

/// The volumes of one region. All in the cube of the unit of length, tets of either orientation counted as positive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RegionLedger {
    /// Its label.
    pub region: i32,
    /// Volume of the old tets that went.
    pub volume_before: f64,
    /// Volume of the new tets that came.
    pub volume_after: f64,
    /// The volume that new tets took too much or too little from each old one, added up without sign: a conserved
    /// field whose values lie between -m and m changes its integral over the region by at most `m` times this. Rounding alone
    /// where old and new tets fill the same place once; more where a surface gave way or old tets lay on top of each other.
    pub deviation: f64,
}

impl Ledger {
    /// The entry of a region.
    pub fn region(&self, region: i32) -> Option<&RegionLedger> {
        self.regions.iter().find(|r| r.region == region)
    }

    /// Both changes, one after the other: volumes and deviations add up.
    pub(super) fn then(&self, later: &Self) -> Self {
        let mut both = self.clone();
        for entry in &later.regions {
            match both.regions.iter_mut().find(|r| r.region == entry.region) {
                Some(ours) => {
                    ours.volume_before += entry.volume_before;
                    ours.volume_after += entry.volume_after;
                    ours.deviation += entry.deviation;
                }
                None => both.regions.push(*entry),
            }
        }
        both.regions.sort_by_key(|r| r.region);
        both.n_outside += later.n_outside;
        both.farthest_outside = both.farthest_outside.max(later.farthest_outside);
        both
    }
}
