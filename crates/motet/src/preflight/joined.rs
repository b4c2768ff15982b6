//! Joins meshes that end at a common edge into one surface: a wall, its inlet and its outlets, as vessel
//! modelling programs write them.

use super::sides::{edges, sorted_sides};
use super::single::Duplicates;
use super::surfaces::{Role, Surfaces};
use crate::base::{DisjointSets, Point, VertexId};

/// For each surface, the joined surface that it is part of: its own number or a lower one. Only
/// boundaries are joined, since a membrane may end anywhere.
pub(crate) fn joined_surfaces(
    points: &[Point],
    triangles: &[[VertexId; 3]],
    surface_of: &[u32],
    roles: &[Role],
) -> Vec<u32> {
    let mut sets = DisjointSets::new(roles.len());
    if roles.len() > 1 {
        let surfaces = Surfaces::new(points, triangles, surface_of, roles);
        let duplicates = Duplicates::new(&surfaces);
        let sides = sorted_sides(&surfaces, |t| {
            duplicates.remains[t as usize] && surfaces.role(surfaces.surface(t)) == Role::Boundary
        });
        let open = edges(&sides).filter(|same| same.len() == 1).map(|same| (same[0].edge, same[0].surface));
        let mut open: Vec<_> = open.collect();
        open.sort_unstable();
        open.chunk_by(|x, y| x.0 == y.0)
            .for_each(|at_edge| at_edge[1..].iter().for_each(|other| sets.join(at_edge[0].1, other.1)));
    }
    sets.roots()
}

#[cfg(test)]
mod tests {
    use super::joined_surfaces;
    use crate::base::{Point, VertexId};
    use crate::preflight::Role::{self, Boundary, Membrane};

    fn triangles(of: &[[u32; 3]]) -> Vec<[VertexId; 3]> {
        of.iter().map(|t| t.map(VertexId)).collect()
    }

    fn joined(triangles: &[[VertexId; 3]], surface_of: &[u32], roles: &[Role]) -> Vec<u32> {
        let points: Vec<Point> =
            (0..6).map(|i| [f64::from(i), f64::from(i * i), f64::from(i * i * i)]).collect();
        joined_surfaces(&points, triangles, surface_of, roles)
    }

    #[test]
    fn what_ends_at_a_common_edge_is_one() {
        // The sides of a tet in three surfaces, connected in a chain.
        let sides = triangles(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
        assert_eq!(joined(&sides, &[2, 0, 1, 0], &[Boundary; 3]), [0, 0, 0]);
        // Beside it a closed tet that has an edge of the open one.
        let more = [sides.clone(), triangles(&[[4, 1, 0], [5, 0, 1], [4, 5, 1], [4, 0, 5]])].concat();
        assert_eq!(joined(&more, &[1, 1, 1, 2, 0, 0, 0, 0], &[Boundary; 3]), [0, 1, 1]);
    }

    #[test]
    fn a_membrane_stays_by_itself() {
        let sides = triangles(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
        assert_eq!(joined(&sides, &[0, 0, 0, 1], &[Boundary, Membrane]), [0, 1]);
    }
}
