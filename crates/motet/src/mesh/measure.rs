//! Measures of tets as cell arrays, for display in ParaView.

use crate::base::{Point, Threads};
use crate::geometry::tet::volume;
use crate::mesh::{Field, Mesh, OrientedTets};

impl Mesh {
    /// A cell array `name` with `measure` of each linear tet as oriented by its neighbours, for example
    /// [`eas`](fn@crate::geometry::quality::eas); NaN for cells of other kinds.
    pub fn tet_field(&self, name: &str, measure: impl Fn([Point; 4]) -> f64) -> Field {
        OrientedTets::of_linear(self, &Threads::single()).field(self, name, measure)
    }

    /// Whether most linear tets have a negative volume, since some writers number the vertices the other way
    /// around.
    pub fn is_turned(&self) -> bool {
        let (mut n_tets, mut n_negative) = (0usize, 0usize);
        for (_, tet) in self.cells.tets() {
            n_tets += 1;
            n_negative += usize::from(volume(tet.map(|v| self.points[v.index()])) < 0.0);
        }
        2 * n_negative > n_tets
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::VertexId;
    use crate::geometry::quality::volume;
    use crate::mesh::{CellKind, Cells, Values};

    #[test]
    fn each_tet_has_its_measure_and_other_cells_none() {
        let mut cells = Cells::new();
        cells.push(CellKind::TRIANGLE, [0, 1, 2].map(VertexId));
        cells.push(CellKind::TETRA, [0, 1, 2, 3].map(VertexId));
        let points = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let field = Mesh::new(points, cells).tet_field("volume", volume);
        let Values::F64(values) = field.values else { panic!("double precision") };
        assert!(values[0].is_nan());
        assert!((values[1] - 1.0 / 6.0).abs() < 1e-15);
    }
}
