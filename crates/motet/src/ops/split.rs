//! Splits: one edge or two crossed ones are divided by a new vertex, or one edge at a vertex that exists.

use crate::base::{Point, TetId, VertexId};
use crate::kernel::{Change, Complex, Hold, NewLine, NewWall, Shell, VertexChange};
use crate::ops::cone;
use crate::ops::cone::cone_on_edge;

/// Proposes a new vertex at `point`, with the constraint `hold`, on the edge `ab` whose shell is given; walls
/// at the edge, and its line, are split with it. Returns `false` if a tet would not be better than `bar`.
pub fn split_edge(
    complex: &Complex,
    shell: &Shell,
    [a, b]: [VertexId; 2],
    (point, hold): (Point, Hold),
    bar: f64,
    change: &mut Change,
) -> bool {
    change.clear();
    let middle = complex.next_vertex();
    change.vertex = VertexChange::Insert(point, hold);
    change.cavity.extend_from_slice(&shell.tets);
    for &place in &shell.walls {
        let wall = complex.wall(shell.wall_at(complex, place));
        for end in [a, b] {
            let vertices = [end, middle, shell.ring[place]];
            change.walls.push(NewWall { vertices, patch: wall.patch, triangle: wall.triangle });
        }
    }
    if let Some(line) = complex.line(a, b) {
        change.lines.extend([a, b].map(|end| NewLine { vertices: [end, middle], source: line.source }));
    }
    cone_on_edge(complex, middle, Some([a, b]), bar, change)
}

/// Proposes a new vertex at `point` between two edges that pass each other closely, replacing the tets around
/// both: equivalent to splitting each of them and collapsing the short edge between the two new vertices.
pub fn split_crossed(
    complex: &Complex,
    shells: [&Shell; 2],
    point: Point,
    bar: f64,
    change: &mut Change,
) -> bool {
    change.clear();
    change.vertex = VertexChange::Insert(point, Hold::Free);
    let [first, second] = shells;
    change.cavity.extend_from_slice(&first.tets);
    let is_other = |tet: &&TetId| !first.tets.contains(tet);
    change.cavity.extend(second.tets.iter().filter(is_other));
    first.is_free() && second.is_free() && cone(complex, complex.next_vertex(), bar, change)
}

/// Proposes to join the vertex `onto`, which is on the shell's ring, to everything around the edge:
/// equivalent to splitting the edge and collapsing the new vertex into `onto`.
pub fn split_onto(complex: &Complex, shell: &Shell, onto: VertexId, bar: f64, change: &mut Change) -> bool {
    change.clear();
    change.cavity.extend_from_slice(&shell.tets);
    shell.is_free() && cone(complex, onto, bar, change)
}
