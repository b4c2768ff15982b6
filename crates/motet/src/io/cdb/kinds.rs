//! Element types: the numbers of Ansys, and the cells that their nodes make.

use crate::mesh::CellKind;

/// What the nodes of an element are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Family {
    Point,
    /// Two nodes; others give the orientation.
    Line,
    /// Two nodes and the one between them; others give the orientation.
    CurvedLine,
    /// Three corners.
    Triangle,
    /// Four corners, of which two may be one.
    Quad,
    /// Four corners.
    Tet,
    /// Eight corners, of which some may be one.
    Brick,
}

/// The family of the elements of a type; `None` if they are no cells here. `shape` is the first option of the
/// type, which for MESH200 is its shape.
pub(super) fn family(number: i64, shape: i64) -> Option<Family> {
    Some(match number {
        21 | 71 => Family::Point,
        1 | 3 | 4 | 8 | 10 | 16 | 23 | 24 | 32 | 33 | 44 | 54 | 68 | 180 | 188 | 288 => Family::Line,
        189 | 289 | 290 => Family::CurvedLine,
        2 | 35 | 146 => Family::Triangle,
        13 | 25 | 28 | 29 | 41..=43 | 53 | 55 | 57 | 63 | 67 | 75 | 77..=79 | 81..=83 | 91 | 93 | 99 => {
            Family::Quad
        }
        121 | 131 | 132 | 143 | 145 | 150 | 152 | 154 | 157 | 163 | 181..=183 | 212 | 213 | 223 | 230 => {
            Family::Quad
        }
        233 | 238 | 281 => Family::Quad,
        72 | 87 | 92 | 98 | 119 | 123 | 127 | 148 | 168 | 187 | 217 | 221 | 227 | 232 | 237 | 240 | 285
        | 291 => Family::Tet,
        5 | 30 | 45 | 46 | 62 | 64 | 65 | 69 | 70 | 73 | 80 | 89 | 90 | 95..=97 | 111 | 117 | 122 | 128 => {
            Family::Brick
        }
        147 | 164 | 185 | 186 | 190 | 191 | 215 | 216 | 220 | 225 | 226 | 231 | 236 | 239 | 278 | 279 => {
            Family::Brick
        }
        200 => match shape {
            0 | 2 => Family::Line,
            1 | 3 => Family::CurvedLine,
            4 | 5 => Family::Triangle,
            6 | 7 => Family::Quad,
            8 | 9 => Family::Tet,
            10 | 11 => Family::Brick,
            _ => return None,
        },
        _ => return None,
    })
}

/// A cell, with and without middle nodes: its kinds, and for each node in VTK's order the position in the
/// element. Corners come first.
#[derive(Debug, PartialEq)]
pub(super) struct Shape {
    linear: CellKind,
    quadratic: CellKind,
    places: &'static [usize],
}

const fn shape(linear: CellKind, quadratic: CellKind, places: &'static [usize]) -> Shape {
    Shape { linear, quadratic, places }
}

const POINT: Shape = shape(CellKind::VERTEX, CellKind::VERTEX, &[0]);
const LINE: Shape = shape(CellKind::LINE, CellKind::LINE, &[0, 1]);
const CURVED_LINE: Shape = shape(CellKind::LINE, CellKind::QUADRATIC_LINE, &[0, 1, 2]);
const TRIANGLE: Shape = shape(CellKind::TRIANGLE, CellKind::QUADRATIC_TRIANGLE, &[0, 1, 2, 3, 4, 5]);
const TET: Shape = shape(CellKind::TETRA, CellKind::QUADRATIC_TETRA, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9]);
const QUAD: Shape = shape(CellKind::QUAD, CellKind::QUADRATIC_QUAD, &[0, 1, 2, 3, 4, 5, 6, 7]);
/// A quad whose nodes K and L are one.
const QUAD_AS_TRIANGLE: Shape = shape(CellKind::TRIANGLE, CellKind::QUADRATIC_TRIANGLE, &[0, 1, 2, 4, 5, 7]);
const BRICK: Shape = shape(
    CellKind::HEXAHEDRON,
    CellKind::QUADRATIC_HEXAHEDRON,
    &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19],
);
/// A brick with K = L and O = P.
const BRICK_AS_WEDGE: Shape =
    shape(CellKind::WEDGE, CellKind::QUADRATIC_WEDGE, &[0, 1, 2, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16, 17, 18]);
/// A brick with M = N = O = P.
const BRICK_AS_PYRAMID: Shape =
    shape(CellKind::PYRAMID, CellKind::QUADRATIC_PYRAMID, &[0, 1, 2, 3, 4, 8, 9, 10, 11, 16, 17, 18, 19]);
/// A brick with K = L and M = N = O = P.
const BRICK_AS_TET: Shape =
    shape(CellKind::TETRA, CellKind::QUADRATIC_TETRA, &[0, 1, 2, 4, 8, 9, 11, 16, 17, 18]);
/// Wedges and pyramids with their own nodes, as some programs write them.
const WEDGE: Shape = shape(CellKind::WEDGE, CellKind::WEDGE, &[0, 1, 2, 3, 4, 5]);
const PYRAMID: Shape = shape(CellKind::PYRAMID, CellKind::PYRAMID, &[0, 1, 2, 3, 4]);

/// A cell of an element: its kind, and for each node in VTK's order the position in the element.
pub(super) struct Cell {
    pub(super) kind: CellKind,
    pub(super) places: &'static [usize],
    /// Whether the element has some middle nodes, but not all.
    pub(super) lacks_some: bool,
}

/// The cell that the nodes of an element make; 0 stands for a missing node. `None` if a corner is missing.
pub(super) fn cell(family: Family, nodes: &[u64]) -> Option<Cell> {
    // The fifth node of a surface element without middle nodes is one of its surroundings.
    let nodes = if family == Family::Quad && nodes.len() == 5 { &nodes[..4] } else { nodes };
    let node = |place: usize| nodes.get(place).copied().unwrap_or(0);
    let are_one = |places: &[usize]| places.iter().all(|&place| node(place) == node(places[0]));
    let shape = match family {
        Family::Point => POINT,
        Family::Line => LINE,
        Family::CurvedLine => CURVED_LINE,
        Family::Triangle => TRIANGLE,
        Family::Tet => TET,
        Family::Quad if nodes.len() == 3 => TRIANGLE,
        Family::Quad if are_one(&[2, 3]) => QUAD_AS_TRIANGLE,
        Family::Quad => QUAD,
        Family::Brick if nodes.len() == 4 => TET,
        Family::Brick if nodes.len() == 5 => PYRAMID,
        Family::Brick if nodes.len() == 6 => WEDGE,
        Family::Brick if are_one(&[2, 3]) && are_one(&[4, 5, 6, 7]) => BRICK_AS_TET,
        Family::Brick if are_one(&[4, 5, 6, 7]) => BRICK_AS_PYRAMID,
        Family::Brick if are_one(&[2, 3]) && are_one(&[6, 7]) => BRICK_AS_WEDGE,
        Family::Brick => BRICK,
    };
    let (corners, middles) = shape.places.split_at(shape.linear.n_vertices()?);
    let n_middles = middles.iter().filter(|&&place| node(place) != 0).count();
    let is_quadratic = n_middles == middles.len();
    corners.iter().all(|&place| node(place) != 0).then_some(Cell {
        kind: if is_quadratic { shape.quadratic } else { shape.linear },
        places: if is_quadratic { shape.places } else { corners },
        lacks_some: n_middles > 0 && !is_quadratic,
    })
}

/// How cells of a kind are written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Written {
    /// The element type.
    pub(super) number: i64,
    /// For MESH200, its shape.
    pub(super) shape: Option<i64>,
    /// For each node of the element its position in VTK's order.
    pub(super) nodes: &'static [usize],
}

const AS_HERE: &[usize] = &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19];
const WEDGE_NODES: &[usize] = &[0, 1, 2, 2, 3, 4, 5, 5, 6, 7, 2, 8, 9, 10, 5, 11, 12, 13, 14, 14];
const PYRAMID_NODES: &[usize] = &[0, 1, 2, 3, 4, 4, 4, 4, 5, 6, 7, 8, 4, 4, 4, 4, 9, 10, 11, 12];

/// How cells of a kind are written, if they are; surface cells as shells if `as_shells`.
pub(super) fn written(kind: CellKind, as_shells: bool) -> Option<Written> {
    let (number, shape, nodes) = match kind {
        CellKind::LINE => (200, Some(2), &AS_HERE[..2]),
        CellKind::QUADRATIC_LINE => (200, Some(3), &AS_HERE[..3]),
        CellKind::TRIANGLE if as_shells => (181, None, &[0, 1, 2, 2][..]),
        CellKind::TRIANGLE => (200, Some(4), &AS_HERE[..3]),
        CellKind::QUADRATIC_TRIANGLE if as_shells => (281, None, &[0, 1, 2, 2, 3, 4, 2, 5][..]),
        CellKind::QUADRATIC_TRIANGLE => (200, Some(5), &AS_HERE[..6]),
        CellKind::QUAD if as_shells => (181, None, &AS_HERE[..4]),
        CellKind::QUAD => (200, Some(6), &AS_HERE[..4]),
        CellKind::QUADRATIC_QUAD if as_shells => (281, None, &AS_HERE[..8]),
        CellKind::QUADRATIC_QUAD => (200, Some(7), &AS_HERE[..8]),
        CellKind::TETRA => (285, None, &AS_HERE[..4]),
        CellKind::QUADRATIC_TETRA => (187, None, &AS_HERE[..10]),
        CellKind::HEXAHEDRON => (185, None, &AS_HERE[..8]),
        CellKind::WEDGE => (185, None, &WEDGE_NODES[..8]),
        CellKind::PYRAMID => (185, None, &PYRAMID_NODES[..8]),
        CellKind::QUADRATIC_HEXAHEDRON => (186, None, AS_HERE),
        CellKind::QUADRATIC_WEDGE => (186, None, WEDGE_NODES),
        CellKind::QUADRATIC_PYRAMID => (186, None, PYRAMID_NODES),
        _ => return None,
    };
    Some(Written { number, shape, nodes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_as_the_same_cell() {
        let mut n_written = 0;
        for as_shells in [false, true] {
            for &kind in CellKind::NAMED {
                let Some(written) = written(kind, as_shells) else { continue };
                n_written += 1;
                let nodes: Vec<u64> = written.nodes.iter().map(|&place| place as u64 + 1).collect();
                let family = family(written.number, written.shape.unwrap_or(0)).unwrap();
                let cell = cell(family, &nodes).unwrap();
                assert_eq!((cell.kind, cell.lacks_some), (kind, false));
                let back: Vec<u64> = cell.places.iter().map(|&place| nodes[place]).collect();
                assert_eq!(
                    back,
                    (1..=kind.n_vertices().unwrap() as u64).collect::<Vec<_>>(),
                    "{}",
                    kind.label()
                );
            }
        }
        assert_eq!(n_written, 28);
    }

    #[test]
    fn missing_middle_nodes_and_corners_are_seen() {
        let kind = |family, nodes: &[u64]| cell(family, nodes).map(|cell| (cell.kind, cell.lacks_some));
        assert_eq!(kind(Family::Tet, &[1, 2, 3, 4, 0, 0, 0, 0, 0, 0]), Some((CellKind::TETRA, false)));
        assert_eq!(kind(Family::Tet, &[1, 2, 3, 4, 5, 0, 7]), Some((CellKind::TETRA, true)));
        assert_eq!(kind(Family::Tet, &[1, 2, 3]), None);
        assert_eq!(kind(Family::Line, &[1, 2, 9]), Some((CellKind::LINE, false)));
        assert_eq!(kind(Family::Quad, &[1, 2, 3, 4, 9]), Some((CellKind::QUAD, false)));
        assert_eq!(kind(Family::Quad, &[1, 2, 3, 4, 5, 6]), Some((CellKind::QUAD, true)));
        assert_eq!(kind(Family::Brick, &[1, 2, 3, 4, 5, 6]), Some((CellKind::WEDGE, false)));
        assert_eq!(kind(Family::Brick, &[1, 2, 3, 0, 5, 6, 7, 8]), None);
    }
}
