//! How badly shaped parts of tets may be.

use super::Forest;
use crate::mesh::BAD_EAS;
use crate::refine::{Options, Rule};

/// For pieces of cut tets the floor is capped at this fraction of the median EAS of the roots.
const OF_MEDIAN: f64 = 0.55;

/// The shapes that closing may leave.
#[derive(Clone, Copy, Debug)]
pub(in crate::refine) struct ShapeBounds {
    /// No part may be below this EAS, a fraction of the worst of the roots.
    floor: f64,
    /// The cap on the floor where it applies to pieces of a cut tet.
    max_floor_of_pieces: f64,
    /// No piece may be below this fraction of what dividing the tet leaves.
    share: f64,
    pub(in crate::refine) rule: Rule,
}

impl ShapeBounds {
    /// The floor for pieces is capped by the median root: in a lattice all tets are as bad as the worst, no
    /// piece is as good as the whole, and everything would be divided.
    pub(in crate::refine) fn new(options: Options, forest: &Forest) -> Self {
        let mut shapes: Vec<f64> = forest.classes[..forest.n_roots].iter().map(|root| root.eas).collect();
        shapes.sort_unstable_by(f64::total_cmp);
        let (worst, median) = (shapes.first().unwrap_or(&0.0), shapes.get(shapes.len() / 2).unwrap_or(&0.0));
        Self {
            floor: options.keep * worst,
            max_floor_of_pieces: OF_MEDIAN * median,
            share: options.share,
            rule: options.rule,
        }
    }

    /// The least EAS allowed for parts of a root of the given EAS. A root that is not bad must not get bad
    /// parts: with one floor for all, a single sliver let every tet become as bad as itself. Bad roots share
    /// a floor: where each had its own, thin tets of boundary layers could not be cut, and 255,208 tets
    /// became 859,601.
    pub(in crate::refine) fn floor(self, root_eas: f64) -> f64 {
        if root_eas >= BAD_EAS { self.floor.max(BAD_EAS) } else { self.floor }
    }

    /// The EAS required of pieces of a tet whose division into eight would leave `divided` as the worst EAS.
    /// Where dividing would leave bad parts as well, it is no alternative.
    pub(super) fn of(self, root_eas: f64, divided: f64) -> f64 {
        let floor = if divided >= BAD_EAS { self.floor(root_eas) } else { self.floor };
        floor.min(self.max_floor_of_pieces).max(self.share * divided)
    }
}
