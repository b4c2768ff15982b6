//! Edge collapse: a vertex is moved along an edge into its other end and removed.

use crate::base::{TetId, VertexId};
use crate::kernel::{Behind, Change, Complex, HalfFacet, Hold, NewLine, NewWall, VertexChange};

/// Proposes to collapse `removed` into `kept`. `star` holds the tets of `removed`. Returns `false` if a new
/// tet would not be better than `bar`.
pub fn collapse(
    complex: &Complex,
    star: &[TetId],
    removed: VertexId,
    kept: VertexId,
    bar: f64,
    change: &mut Change,
) -> bool {
    change.clear();
    change.vertex = VertexChange::Remove(removed);
    change.cavity.extend_from_slice(star);
    walls(complex, star, removed, kept, change);
    lines(complex, star, removed, kept, change);
    for &tet in star {
        let mut vertices = complex.vertices(tet);
        if vertices.contains(&kept) {
            continue;
        }
        vertices[complex.place(tet, removed)] = kept;
        if !change.push_above(complex, vertices, complex.region(tet), bar) {
            return false;
        }
    }
    true
}

/// Moves the walls of `removed` that do not have the edge over to `kept`.
fn walls(complex: &Complex, star: &[TetId], removed: VertexId, kept: VertexId, change: &mut Change) {
    if complex.hold(removed) == Hold::Free {
        return;
    }
    for half in star.iter().flat_map(|&t| (0..4).map(move |i| HalfFacet::new(t, i))) {
        let Behind::Wall(id) = complex.behind(half.tet(), half.facet()) else { continue };
        let wall = complex.wall(id);
        let mut vertices = complex.facet(half);
        // A wall between two regions has tets of the star on both sides.
        if wall.sides[0] != half || !vertices.contains(&removed) || vertices.contains(&kept) {
            continue;
        }
        vertices.iter_mut().filter(|v| **v == removed).for_each(|v| *v = kept);
        change.walls.push(NewWall { vertices, patch: wall.patch, triangle: wall.triangle });
    }
}

/// Moves the lines of `removed`, other than the edge itself, over to `kept`.
fn lines(complex: &Complex, star: &[TetId], removed: VertexId, kept: VertexId, change: &mut Change) {
    if complex.hold(removed) == Hold::Free {
        return;
    }
    for other in complex.line_neighbors(star, removed).into_iter().filter(|&v| v != kept) {
        if let Some(line) = complex.line(removed, other) {
            change.lines.push(NewLine { vertices: [kept, other], source: line.source });
        }
    }
}
