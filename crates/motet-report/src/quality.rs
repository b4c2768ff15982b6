//! Statistics of the quality of the tets of one frame.

use motet::Mesh;
use motet::base::{CellId, Point, Threads};
use motet::geometry::quality::{dihedral, eas, mean_ratio};
use motet::geometry::tet::centroid;
use motet::geometry::vector::is_finite;
use motet::mesh::curved::CurvedCells;
use motet::mesh::{BAD_EAS, CellKind, OrientedTets, Qualities};
use serde::Serialize;

/// Bars of the EAS histogram: one below 0, then twenty up to 1.
pub(crate) const EAS_BARS: usize = 21;
/// Bars of the histogram of the smallest dihedral angle, of 5 degrees each; that of the regular tet is 70.5.
pub(crate) const ANGLE_BARS: usize = 15;

/// Equi-angle quality and dihedral angles of the tets with finite points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Quality {
    pub(crate) tets: usize,
    pub(crate) eas_min: f64,
    /// The distribution of the quality of all tets.
    pub(crate) all: Qualities,
    /// Tets below [`BAD_EAS`] outside boundary layers.
    pub(crate) bad: usize,
    /// Tets below [`BAD_EAS`] in boundary layers.
    pub(crate) layers: usize,
    /// Flat or inverted tets.
    pub(crate) inverted: usize,
    pub(crate) worst_cell: usize,
    pub(crate) worst_at: Point,
    pub(crate) angle_min: f64,
    pub(crate) angle_max: f64,
    pub(crate) eas_bars: [usize; EAS_BARS],
    pub(crate) angle_bars: [usize; ANGLE_BARS],
}

/// The quality of the cells of a mesh.
#[derive(Default)]
pub(crate) struct ByCell {
    /// EAS of each cell, NaN where it has none.
    pub(crate) eas: Vec<f32>,
    /// Bad tets, in ascending order of cells.
    pub(crate) bad: Vec<CellId>,
}

/// The quality of the tets, overall and by cell, from the corners of quadratic ones. A quadratic tet counts
/// as inverted if it is so anywhere inside.
pub(crate) fn of(mesh: &Mesh) -> (Option<Quality>, ByCell) {
    let mut eas = vec![f32::NAN; mesh.cells.len()];
    let (mut quality, mut low) = (Quality::empty(), Vec::new());
    let (mut values, mut ratios) = (Vec::new(), 0.0);
    let tets = OrientedTets::of(mesh, &Threads::single());
    for (i, cell) in tets.cells.iter().enumerate() {
        let tet = tets.corners(i, &mesh.points);
        if tet.iter().all(|p| is_finite(*p)) {
            let value = quality.add(cell.index(), tet);
            values.push(value);
            ratios += mean_ratio(tet);
            eas[cell.index()] = value as f32;
            if value < BAD_EAS {
                low.push(i);
            }
        }
    }
    let is_linear = |i: usize| mesh.cells.kind(tets.cells[i]) == CellKind::TETRA;
    quality.inverted = low.iter().filter(|&&i| is_linear(i) && tets.is_inverted(i, &mesh.points)).count();
    let is_quadratic_tet = |cell: &&CellId| mesh.cells.kind(**cell) == CellKind::QUADRATIC_TETRA;
    quality.inverted += folded_cells(mesh).iter().filter(is_quadratic_tet).count();
    let judged = tets.judge(&mesh.points, low, BAD_EAS);
    (quality.bad, quality.layers) = (judged.bad.len(), judged.layers.len());
    let bad = judged.bad.into_iter().map(|i| tets.cells[i]).collect();
    let all = Qualities::of_values(&mut values, ratios);
    quality.all = all.unwrap_or_default();
    (all.map(|_| quality.finished()), ByCell { eas, bad })
}

/// Quadratic cells whose Jacobian determinant is not positive everywhere, in ascending order.
fn folded_cells(mesh: &Mesh) -> Vec<CellId> {
    let curved = CurvedCells::of(&mesh.cells, &mesh.points);
    let folded = (0..curved.len()).filter(|&i| !curved.is_upright(i, &mesh.points));
    folded.map(|i| curved.cells[i]).collect()
}

impl Quality {
    fn empty() -> Self {
        Self {
            tets: 0,
            eas_min: f64::INFINITY,
            all: Qualities::default(),
            bad: 0,
            layers: 0,
            inverted: 0,
            worst_cell: 0,
            worst_at: [0.0; 3],
            angle_min: f64::INFINITY,
            angle_max: 0.0,
            eas_bars: [0; EAS_BARS],
            angle_bars: [0; ANGLE_BARS],
        }
    }

    /// Adds a tet and returns its EAS. Angles are in radians until [`Self::finished`].
    fn add(&mut self, cell: usize, tet: [Point; 4]) -> f64 {
        let eas = eas(tet);
        let [low, high] = dihedral::min_max(tet);
        if eas < self.eas_min {
            (self.eas_min, self.worst_cell, self.worst_at) = (eas, cell, centroid(tet));
        }
        self.tets += 1;
        self.angle_min = self.angle_min.min(low);
        self.angle_max = self.angle_max.max(high);
        self.eas_bars[if eas < 0.0 { 0 } else { 1 + ((eas * 20.0) as usize).min(EAS_BARS - 2) }] += 1;
        self.angle_bars[((low.to_degrees() / 5.0) as usize).min(ANGLE_BARS - 1)] += 1;
        eas
    }

    fn finished(mut self) -> Self {
        self.angle_min = self.angle_min.to_degrees();
        self.angle_max = self.angle_max.to_degrees();
        self
    }
}

#[cfg(test)]
mod tests {
    use motet::mesh::Summary;
    use motet::mesh::shapes::{ball, mixed, quadratic};

    use super::*;

    #[test]
    fn it_is_what_info_says() {
        for mesh in [ball(3, 2), quadratic(&ball(2, 2)), mixed(2)] {
            let ours = of(&mesh).0.unwrap();
            let theirs = Summary::of(&mesh).quality.unwrap();
            assert_eq!(
                (ours.eas_min, ours.all, ours.bad),
                (theirs.eas.min, theirs.distribution, theirs.eas.bad)
            );
            assert_eq!(
                (ours.worst_cell, ours.worst_at),
                (theirs.eas.worst_cell.index(), theirs.eas.worst_at)
            );
            assert_eq!((ours.angle_min, ours.angle_max), (theirs.dihedral_deg.min, theirs.dihedral_deg.max));
            assert_eq!(ours.eas_bars.iter().sum::<usize>(), ours.tets);
            assert_eq!(ours.angle_bars.iter().sum::<usize>(), ours.tets);
        }
    }

    #[test]
    fn what_is_no_number_has_none() {
        let mut mesh = ball(2, 1);
        mesh.points.iter_mut().for_each(|p| p[0] = f64::NAN);
        let (quality, by_cell) = of(&mesh);
        assert!(quality.is_none() && by_cell.eas.iter().all(|q| q.is_nan()));
    }
}
