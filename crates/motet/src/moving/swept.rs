//! The volume that each facet sweeps while its vertices move along straight lines.
//!
//! A scheme that keeps uniform flow uniform on a moving mesh takes the mesh fluxes from these: over the
//! facets of a cell they sum to the change of its volume, to rounding (the geometric conservation law; Thomas
//! and Lombard 1979). Velocities of facets times areas at one time do not.

use crate::base::{CellId, MaybeId, Point, VertexId};
use crate::geometry::vector::{add, cross, dot, scale, sub};
use crate::mesh::Cells;
use crate::mesh::adjacency::Facets;

/// The triangular facets of tets, and the volume that each sweeps. All lists have one entry per facet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweptVolumes {
    /// The corners of each facet, counter-clockwise seen from outside its owner.
    pub facets: Vec<[VertexId; 3]>,
    /// The tet that owns the facet.
    pub owners: Vec<CellId>,
    /// The tet on the other side; none at the boundary.
    pub neighbors: Vec<MaybeId<CellId>>,
    /// The swept volume, in the unit of the points cubed: positive if the owner grows.
    pub volumes: Vec<f64>,
}

/// The volumes that the facets of the tets among `cells` sweep from `before` to `after`.
///
/// Panics if a vertex of a tet has no entry in `before` or `after`.
pub fn swept_volumes(cells: &Cells, before: &[Point], after: &[Point]) -> SweptVolumes {
    let facets = Facets::of(cells);
    let mut swept = SweptVolumes::default();
    facets.for_each_shared(|uses| {
        let corners: Vec<VertexId> = facets.corners(uses[0]).collect();
        let &[a, b, c] = corners.as_slice() else { return };
        swept.facets.push([a, b, c]);
        swept.owners.push(uses[0].cell);
        swept.neighbors.push(uses.get(1).map(|other| other.cell).into());
        let [x, y] = [before, after].map(|points| [a, b, c].map(|v| points[v.index()]));
        swept.volumes.push(sweep(x, y));
    });
    swept
}

/// The mean displacement of the corners times the mean of the area vector over the motion: quadratic in time,
/// so three terms are exact.
fn sweep(before: [Point; 3], after: [Point; 3]) -> f64 {
    let moved = [0, 1, 2].map(|i| sub(after[i], before[i]));
    let [e, f] = [1, 2].map(|i| sub(before[i], before[0]));
    let [u, v] = [1, 2].map(|i| sub(moved[i], moved[0]));
    let mixed = add(cross(e, v), cross(u, f));
    let area = add(add(cross(e, f), scale(mixed, 0.5)), scale(cross(u, v), 1.0 / 3.0));
    let sum = moved.iter().fold([0.0; 3], |sum, &d| add(sum, d));
    dot(sum, area) / 6.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::tet::volume;
    use crate::mesh::shapes::sphere_in_box;

    #[test]
    fn what_the_facets_of_a_tet_sweep_is_what_it_gains() {
        let mesh = sphere_in_box(3, 3);
        // Displacements in all directions: if they lie in one plane, terms of the third order vanish.
        let moved = |i: usize, k: usize| 0.3 * (((5 + 2 * k) * i) as f64).sin();
        let after: Vec<Point> =
            mesh.points.iter().enumerate().map(|(i, p)| [0, 1, 2].map(|k| p[k] + moved(i, k))).collect();
        let swept = swept_volumes(&mesh.cells, &mesh.points, &after);
        let mut gained = vec![0.0; mesh.cells.len()];
        for (i, &v) in swept.volumes.iter().enumerate() {
            gained[swept.owners[i].index()] += v;
            if let Some(neighbor) = swept.neighbors[i].get() {
                gained[neighbor.index()] -= v;
            }
        }
        let mut n_moved = 0;
        for (cell, tet) in mesh.cells.tets() {
            let of = |points: &[Point]| volume(tet.map(|v| points[v.index()]));
            let gain = of(&after) - of(&mesh.points);
            assert!((gain - gained[cell.index()]).abs() < 1e-13, "{gain} {}", gained[cell.index()]);
            n_moved += usize::from(gain.abs() > 1e-3);
        }
        assert!(n_moved > mesh.cells.tets().count() / 2);
        assert_eq!(swept.volumes.len(), swept.facets.len());
    }
}
