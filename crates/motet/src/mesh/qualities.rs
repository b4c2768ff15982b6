//! Quality statistics over all tets of a mesh: what the worst tet alone does not show.

use crate::base::{Point, Threads, VertexId};
use crate::geometry::quality::{eas_and_mean_ratio_of_each, eas_of_each};
use crate::geometry::vector::in_range;
use crate::mesh::{Mesh, OrientedTets, Spread};

/// The distribution of the EAS of a set of tets, and the mean of their mean ratios. All values are 1 if there
/// are no tets.
///
/// A percentile is the EAS at that fraction of the way from the worst to the best tet, rounded down to a tet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
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

/// The number of tets that a thread judges at a time.
const CHUNK: usize = 1 << 13;

impl Default for Qualities {
    fn default() -> Self {
        Self { worst: 1.0, p1: 1.0, p5: 1.0, median: 1.0, mean: 1.0, mean_ratio: 1.0 }
    }
}

impl Qualities {
    /// The statistics of `tets` with vertices at `points`.
    pub fn of(points: &[Point], tets: &[[VertexId; 4]], threads: &Threads) -> Self {
        let each = Self::each(points, tets, threads);
        let mut eas: Vec<f64> = each.iter().map(|[eas, _]| *eas).collect();
        Self::of_values(&mut eas, each.iter().map(|[_, ratio]| *ratio).sum()).unwrap_or_default()
    }

    /// The EAS of each of `tets` with vertices at `points`.
    pub fn eas_of_each(points: &[Point], tets: &[[VertexId; 4]], threads: &Threads) -> Vec<f64> {
        threads.in_runs(tets.len(), CHUNK, |(): &mut (), run| eas_of_each(points, &tets[run]))
    }

    /// EAS and mean ratio of each of `tets` with vertices at `points`.
    pub(crate) fn each(points: &[Point], tets: &[[VertexId; 4]], threads: &Threads) -> Vec<[f64; 2]> {
        threads.in_runs(tets.len(), CHUNK, |(): &mut (), run| eas_and_mean_ratio_of_each(points, &tets[run]))
    }

    /// The statistics of the linear and quadratic tets of a mesh (of quadratic ones, by their corners), as
    /// oriented by their neighbours. Tets with a point that is not finite are left out; `None` if no tets
    /// remain.
    pub fn of_mesh(mesh: &Mesh, threads: &Threads) -> Option<Self> {
        let OrientedTets { mut tets, .. } = OrientedTets::of(mesh, threads);
        tets.retain(|tet| tet.iter().all(|v| in_range(mesh.points[v.index()])));
        (!tets.is_empty()).then(|| Self::of(&mesh.points, &tets, threads))
    }

    /// The statistics from the EAS of all tets, which are reordered, and the sum of their mean ratios; `None`
    /// if there are no tets.
    pub fn of_values(eas: &mut [f64], ratios: f64) -> Option<Self> {
        let n = eas.len() as f64;
        let Spread { worst, p1, p5, median, mean } = Spread::of_values(eas, true)?;
        Some(Self { worst, p1, p5, median, mean, mean_ratio: ratios / n })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::quality::eas;
    use crate::mesh::shapes::sphere_in_box;
    use crate::mesh::{CellKind, Cells, Summary};

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
    fn percentiles_of_few_or_equal_values_are_those_of_the_sorted_ones() {
        for n in [1, 2, 3, 19, 20, 21, 99, 100, 101, 102, 1000] {
            // A permutation, with each value several times where n is large.
            let values: Vec<f64> = (0..n).map(|i| f64::from((i * 7919 + 13) % n % 37) / 37.0 - 0.1).collect();
            let (mut sorted, mut shuffled) = (values.clone(), values.clone());
            sorted.sort_by(f64::total_cmp);
            let found = Qualities::of_values(&mut shuffled, 0.5 * f64::from(n)).unwrap();
            let at = |part: f64| sorted[(part * f64::from(n - 1)) as usize];
            assert_eq!(
                [found.worst, found.p1, found.p5, found.median],
                [0.0, 0.01, 0.05, 0.5].map(at),
                "{n}"
            );
            assert_eq!(found.mean_ratio, 0.5);
        }
    }

    #[test]
    fn a_mesh_that_is_numbered_the_other_way_round_is_as_good() {
        let mesh = sphere_in_box(4, 2);
        let threads = Threads::single();
        let tets: Vec<_> = mesh.cells.tets().map(|(_, tet)| tet).collect();
        let turned: Vec<_> = tets.iter().map(|&[a, b, c, d]| [a, b, d, c]).collect();
        let plain = Qualities::of(&mesh.points, &tets, &threads);
        assert_eq!(Qualities::of_mesh(&mesh, &threads), Some(plain));
        let mut cells = Cells::new();
        turned.into_iter().for_each(|tet| cells.push(CellKind::TETRA, tet));
        let other = Mesh::new(mesh.points.clone(), cells);
        let found = Qualities::of_mesh(&other, &threads).unwrap();
        assert!((found.worst - plain.worst).abs() < 1e-12 && (found.mean - plain.mean).abs() < 1e-12);
    }

    /// Threads judge parts of the mesh; the sums do not depend on the parts.
    #[test]
    fn a_summary_and_any_number_of_threads_give_the_same_bits() {
        let mesh = sphere_in_box(10, 6);
        assert!(mesh.cells.len() > 2 * CHUNK);
        let summary = Summary::of(&mesh).quality.unwrap().distribution;
        for n in [1, 2, 5] {
            assert_eq!(Qualities::of_mesh(&mesh, &Threads::new(n).unwrap()), Some(summary), "{n} threads");
        }
    }

    #[test]
    fn what_is_no_number_does_not_count() {
        let mut mesh = sphere_in_box(4, 2);
        mesh.points.iter_mut().for_each(|p| p[0] = f64::NAN);
        assert_eq!(Qualities::of_mesh(&mesh, &Threads::single()), None);
    }

    #[test]
    fn no_tet_is_as_good_as_can_be() {
        assert_eq!(Qualities::of(&[], &[], &Threads::single()), Qualities::default());
    }
}
