//! Edge collapse: a vertex is moved along an edge into its other end and removed.

use crate::base::{TetId, VertexId};
use crate::kernel::{Behind, Change, Complex, HalfFacet, Hold, NewLine, NewWall, VertexChange};

/// Proposes to collapse `gone` into `kept`. `star` holds the tets of `gone`. Returns `false` if a new tet
/// would not be better than `bar`.
pub fn collapse(
    complex: &Complex,
    star: &[TetId],
    gone: VertexId,
    kept: VertexId,
    bar: f64,
    change: &mut Change,
) -> bool {
    change.clear();
    change.vertex = VertexChange::Remove(gone);
    change.cavity.extend_from_slice(star);
    walls(complex, star, gone, kept, change);
    lines(complex, star, gone, kept, change);
    for &tet in star {
        let mut vertices = complex.vertices(tet);
        if vertices.contains(&kept) {
            continue;
        }
        vertices[complex.place(tet, gone)] = kept;
        if !change.push_above(complex, vertices, complex.region(tet), bar) {
            return false;
        }
    }
    true
}

/// Moves the walls of `gone` that do not have the edge over to `kept`.
fn walls(complex: &Complex, star: &[TetId], gone: VertexId, kept: VertexId, change: &mut Change) {
    if complex.hold(gone) == Hold::Free {
        return;
    }
    for half in star.iter().flat_map(|&t| (0..4).map(move |i| HalfFacet::new(t, i))) {
        let Behind::Wall(id) = complex.behind(half.tet(), half.facet()) else { continue };
        let wall = complex.wall(id);
        let mut vertices = complex.facet(half);
        // A wall between two regions has tets of the star on both sides.
        if wall.sides[0] != half || !vertices.contains(&gone) || vertices.contains(&kept) {
            continue;
        }
        vertices.iter_mut().filter(|v| **v == gone).for_each(|v| *v = kept);
        change.walls.push(NewWall { vertices, patch: wall.patch, triangle: wall.triangle });
    }
}

/// Moves the lines of `gone`, other than the edge itself, over to `kept`.
fn lines(complex: &Complex, star: &[TetId], gone: VertexId, kept: VertexId, change: &mut Change) {
    if complex.hold(gone) == Hold::Free {
        return;
    }
    for other in complex.line_neighbors(star, gone).into_iter().filter(|&v| v != kept) {
        if let Some(line) = complex.line(gone, other) {
            change.lines.push(NewLine { vertices: [kept, other], source: line.source });
        }
    }
}
