//! How good all tets of a mesh are together: what the worst one does not tell.

use serde::Serialize;

use crate::base::{Point, Threads, VertexId};
use crate::geometry::quality::{eas, mean_ratio};

/// The distribution of the EAS of tets, and the mean of their mean ratios; all 1 where there is no tet.
///
/// A percentile is the value of the tet at that part of the way from the worst to the best, rounded down.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Qualities {
    /// The worst EAS.
    pub worst: f64,
    /// One tet in a hundred has a lower EAS.
    pub p1: f64,
    /// Five tets in a hundred have a lower EAS.
    pub p5: f64,
    /// Half of the tets have a lower EAS.
    pub median: f64,
    /// The mean EAS.
    pub mean: f64,
    /// The mean of the mean ratios `12 (3 V)^(2/3) / sum of squared edge lengths`.
    pub mean_ratio: f64,
}

impl Default for Qualities {
    fn default() -> Self {
        Self { worst: 1.0, p1: 1.0, p5: 1.0, median: 1.0, mean: 1.0, mean_ratio: 1.0 }
    }
}

impl Qualities {
    /// Looks at every tet, with the vertices at `points`.
    pub fn of(points: &[Point], tets: &[[VertexId; 4]], threads: &Threads) -> Self {
        let of_tet = |i: usize| {
            let corners = tets[i].map(|v| points[v.index()]);
            (eas(corners), mean_ratio(corners))
        };
        let (mut eas, ratios): (Vec<f64>, Vec<f64>) = threads.map(tets.len(), of_tet).into_iter().unzip();
        if eas.is_empty() {
            return Self::default();
        }
        let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
        let (mean_eas, mean_ratio) = (mean(&eas), mean(&ratios));
        let mut at = |part: f64| percentile(&mut eas, part);
        Self { worst: at(0.0), p1: at(0.01), p5: at(0.05), median: at(0.5), mean: mean_eas, mean_ratio }
    }
}

/// The value at a part of the way from the least of `values` to the greatest, rounded down; puts them in another order.
///
/// # Panics
/// When there is no value.
pub(super) fn percentile(values: &mut [f64], part: f64) -> f64 {
    let place = (part * (values.len() - 1) as f64) as usize;
    *values.select_nth_unstable_by(place, f64::total_cmp).1
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shapes::sphere_in_box;

    #[test]
    fn percentiles_are_those_of_the_sorted_values() {
        let mesh = sphere_in_box(6, 4);
        let tets: Vec<_> = mesh.cells.tets().map(|(_, tet)| tet).collect();
        let mut sorted: Vec<f64> = tets.iter().map(|tet| eas(tet.map(|v| mesh.points[v.index()]))).collect();
        sorted.sort_by(f64::total_cmp);
        let found = Qualities::of(&mesh.points, &tets, &Threads::single());
        let at = |part: f64| sorted[(part * (sorted.len() - 1) as f64) as usize];
        assert_eq!([found.worst, found.p1, found.p5, found.median], [sorted[0], at(0.01), at(0.05), at(0.5)]);
        assert!((found.mean - sorted.iter().sum::<f64>() / sorted.len() as f64).abs() < 1e-12);
        assert!(found.worst < found.p1 && found.p5 < found.median && found.mean_ratio > found.mean);
    }

    #[test]
    fn no_tet_is_as_good_as_can_be() {
        assert_eq!(Qualities::of(&[], &[], &Threads::single()), Qualities::default());
    }
}
