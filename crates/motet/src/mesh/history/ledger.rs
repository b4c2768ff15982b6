//! How well the volumes of old and new tets match, region by region.

/// What a change did to volumes, and to vertices that ended outside the old tets.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ledger {
    /// One entry for each region with a changed tet, by rising label.
    pub regions: Vec<RegionLedger>,
    /// Number of new and moved vertices that lie in none of the removed old tets: they take the values at the
    /// nearest place in these.
    pub n_outside: usize,
    /// The largest distance of such a vertex from that place.
    pub farthest_outside: f64,
}

/// The volumes of one region, in the cube of the unit of length. Tets of either orientation count as
/// positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RegionLedger {
    /// The label of the region.
    pub region: i32,
    /// Volume of the old tets that were removed.
    pub volume_before: f64,
    /// Volume of the new tets that were inserted.
    pub volume_after: f64,
    /// The volume that new tets took too much or too little from each old one, summed in absolute value. A
    /// conserved field with values between -m and m changes its integral over the region by at most `m` times
    /// this. Only rounding if old and new tets fill the same space exactly once; more if a surface changed
    /// its shape or old tets overlapped.
    pub deviation: f64,
}

impl Ledger {
    /// The entry of a region, if there is one.
    pub fn region(&self, region: i32) -> Option<&RegionLedger> {
        self.regions.iter().find(|r| r.region == region)
    }

    /// Both changes in sequence: volumes and deviations add up.
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
