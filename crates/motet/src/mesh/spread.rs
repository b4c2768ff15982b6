//! The distribution of a quality measure over the tets of a mesh.

#[cfg(feature = "suite")]
use crate::base::{Point, Threads};
#[cfg(feature = "suite")]
use crate::geometry::quality::Measure;
#[cfg(feature = "suite")]
use crate::geometry::vector::in_range;
#[cfg(feature = "suite")]
use crate::mesh::{Mesh, OrientedTets};

/// The distribution of a quality measure over a set of tets.
///
/// A percentile is the value at that fraction of the way from the worst to the best tet, rounded down to a
/// tet.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Spread {
    /// The worst value.
    pub worst: f64,
    /// One tet in a hundred is worse.
    pub p1: f64,
    /// Five tets in a hundred are worse.
    pub p5: f64,
    /// Half of the tets are worse.
    pub median: f64,
    /// The mean.
    pub mean: f64,
}

impl Spread {
    /// The distribution of some values, which are reordered; `None` if there are none.
    pub fn of_values(values: &mut [f64], is_better_if_larger: bool) -> Option<Self> {
        let n_last = values.len().checked_sub(1)?;
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        // Each selection needs only the part that is worse than the previous, better percentile.
        let (mut low, places) = (values, [0.5, 0.05, 0.01, 0.0]);
        let mut found = [1.0; 4];
        for (value, part) in found.iter_mut().zip(places) {
            let place = (part * n_last as f64) as usize;
            let by_quality = |a: &f64, b: &f64| match is_better_if_larger {
                true => a.total_cmp(b),
                false => b.total_cmp(a),
            };
            *value = *low.select_nth_unstable_by(place, by_quality).1;
            low = &mut low[..=place];
        }
        let [median, p5, p1, worst] = found;
        Some(Self { worst, p1, p5, median, mean })
    }

    /// The distributions of some measures over tets as they are oriented, in the order of the measures. Tets
    /// with a point that is not finite are left out; empty if no tets remain.
    #[cfg(feature = "suite")]
    pub(crate) fn of_tets(
        mesh: &Mesh,
        tets: &OrientedTets,
        measures: &[Measure],
        threads: &Threads,
    ) -> Vec<(Measure, Self)> {
        let corners = (0..tets.tets.len()).map(|tet| tets.corners(tet, &mesh.points));
        let finite: Vec<[Point; 4]> = corners.filter(|tet| tet.iter().all(|&p| in_range(p))).collect();
        let of = |measure: Measure| {
            let mut values = threads.map(finite.len(), |tet| measure.of_tet(finite[tet]));
            Some((measure, Self::of_values(&mut values, measure.is_better_if_larger())?))
        };
        measures.iter().filter_map(|&measure| of(measure)).collect()
    }
}

#[cfg(all(test, feature = "suite"))]
mod tests {
    use super::*;
    use crate::base::Names;
    use crate::mesh::shapes::sphere_in_box;
    use crate::mesh::{Qualities, Summary};

    #[test]
    fn the_worst_is_the_least_or_the_largest() {
        let values = || [3.0, 1.0, 4.0, 2.0];
        let rising = Spread::of_values(&mut values(), true).unwrap();
        assert_eq!([rising.worst, rising.median, rising.mean], [1.0, 2.0, 2.5]);
        let falling = Spread::of_values(&mut values(), false).unwrap();
        assert_eq!([falling.worst, falling.median, falling.mean], [4.0, 3.0, 2.5]);
        assert_eq!(Spread::of_values(&mut [], true), None);
    }

    #[test]
    fn any_number_of_threads_gives_the_same_bits_and_those_of_the_summary() {
        let mesh = sphere_in_box(10, 6);
        let of = |n| Summary::with_measures(&mesh, Measure::ALL, &Threads::exactly(n).unwrap()).1;
        let one = of(1);
        assert_eq!(one.len(), Measure::ALL.len());
        assert!([2, 5].into_iter().all(|n| of(n) == one));
        let all = Qualities::of_mesh(&mesh, &Threads::single()).unwrap();
        let (measure, eas) = one[0];
        assert_eq!(measure, Measure::Eas);
        assert_eq!(
            [eas.worst, eas.p1, eas.p5, eas.median, eas.mean],
            [all.worst, all.p1, all.p5, all.median, all.mean]
        );
    }
}
