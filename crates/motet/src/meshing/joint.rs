//! Meshes that end at a common edge are one surface: a wall, its inlet and its outlets, as programs that make vessels write them.

use crate::base::{Sets, VertexId, rising};
use crate::preflight::Role;

/// For each surface, that of which it is a part: its own number or a lower one. Only boundaries are joined: a membrane may end where it likes.
pub(super) fn joint(triangles: &[[VertexId; 3]], surface_of: &[u32], roles: &[Role]) -> Vec<u32> {
    let is_boundary = |s: u32| roles[s as usize] == Role::Boundary;
    let mut sides: Vec<([VertexId; 2], u32)> = Vec::with_capacity(3 * triangles.len());
    for (&[a, b, c], &surface) in triangles.iter().zip(surface_of).filter(|(_, s)| is_boundary(**s)) {
        sides.extend([[a, b], [b, c], [c, a]].map(|edge| (rising(edge), surface)));
    }
    sides.sort_unstable();
    let mut sets = Sets::new(roles.len());
    for at_edge in sides.chunk_by(|x, y| x.0 == y.0) {
        let mut ends_here =
            at_edge.chunk_by(|x, y| x.1 == y.1).filter(|own| own.len() == 1).map(|own| own[0].1);
        if let Some(first) = ends_here.next() {
            ends_here.for_each(|other| sets.join(first, other));
        }
    }
    (0..roles.len() as u32).map(|s| sets.root(s)).collect()
}

#[cfg(test)]
mod tests {
    use super::joint;
    use crate::base::VertexId;
    use crate::preflight::Role::{Boundary, Membrane};

    fn triangles(of: &[[u32; 3]]) -> Vec<[VertexId; 3]> {
        of.iter().map(|t| t.map(VertexId)).collect()
    }

    #[test]
    fn what_ends_at_a_common_edge_is_one() {
        // The sides of a tet: three apart, all in a chain.
        let sides = triangles(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
        assert_eq!(joint(&sides, &[2, 0, 1, 0], &[Boundary; 3]), [0, 0, 0]);
        // A closed tet beside, with an edge of the open one.
        let more = [sides.clone(), triangles(&[[4, 1, 0], [5, 0, 1], [4, 5, 1], [4, 0, 5]])].concat();
        assert_eq!(joint(&more, &[1, 1, 1, 2, 0, 0, 0, 0], &[Boundary; 3]), [0, 1, 1]);
    }

    #[test]
    fn a_membrane_stays_by_itself() {
        let sides = triangles(&[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
        assert_eq!(joint(&sides, &[0, 0, 0, 1], &[Boundary, Membrane]), [0, 1]);
    }
}
