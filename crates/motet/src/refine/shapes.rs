//! How well the tets of a mesh are shaped, in four numbers.

use crate::base::Threads;
use crate::geometry::quality::{eas, mean_ratio};
use crate::mesh::TetMesh;

/// Of all tets, as if all were numbered the same way round.
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
}

impl Shapes {
    /// Looks at every tet. All are 0 where there is none.
    pub fn of(mesh: &TetMesh, threads: &Threads) -> Self {
        let each = threads.map(mesh.tets.len(), |t| {
            let corners = mesh.tets[t].map(|v| mesh.points[v.index()]);
            [eas(corners).abs(), mean_ratio(corners).abs()]
        });
        let worst = |k: usize| each.iter().map(|pair| pair[k]).reduce(f64::min).unwrap_or(0.0);
        let mean = |k: usize| each.iter().map(|pair| pair[k]).sum::<f64>() / each.len().max(1) as f64;
        Self { worst_eas: worst(0), mean_eas: mean(0), worst_mean_ratio: worst(1), mean_mean_ratio: mean(1) }
    }
}
