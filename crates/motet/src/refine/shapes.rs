//! Shape statistics of the tets of a mesh.

use crate::base::Threads;
use crate::mesh::{Qualities, TetMesh};

/// Shape statistics over all tets of a mesh, computed as if all tets were positively oriented.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Shapes {
    /// The least EAS.
    pub worst_eas: f64,
    /// The mean EAS.
    pub mean_eas: f64,
    /// The least mean ratio.
    pub worst_mean_ratio: f64,
    /// The mean of the mean ratios.
    pub mean_mean_ratio: f64,
    /// Quality statistics of all tets together.
    pub all: Qualities,
}

impl Shapes {
    /// Computes the statistics of all tets of a mesh. All values are 0 if there is no tet.
    pub fn of(mesh: &TetMesh, threads: &Threads) -> Self {
        let mut each = Qualities::each(&mesh.points, &mesh.tets, threads);
        each.as_flattened_mut().iter_mut().for_each(|value| *value = value.abs());
        let (sums, all) = threads.join(
            || {
                let start = ([f64::INFINITY; 2], [0.0; 2]);
                each.iter().fold(start, |([x, y], [a, b]), &[eas, ratio]| {
                    ([x.min(eas), y.min(ratio)], [a + eas, b + ratio])
                })
            },
            || {
                let mut eas: Vec<f64> = each.iter().map(|pair| pair[0]).collect();
                Qualities::of_values(&mut eas, each.iter().map(|pair| pair[1]).sum())
            },
        );
        let (worst, sums) = if each.is_empty() { ([0.0; 2], [0.0; 2]) } else { sums };
        let [mean_eas, mean_mean_ratio] = sums.map(|sum| sum / each.len().max(1) as f64);
        let [worst_eas, worst_mean_ratio] = worst;
        let all = all.unwrap_or_default();
        Self { worst_eas, mean_eas, worst_mean_ratio, mean_mean_ratio, all }
    }
}
