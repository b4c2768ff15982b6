//! Types of elements: names, the order of their nodes, and their sides.

use crate::mesh::CellKind;

/// Names of types, and the kinds of cells with the names written for them. The linear kind comes first.
type Type = (&'static [&'static str], &'static [(CellKind, &'static str)]);

const TYPES: &[Type] = &[
    (&["TETRA", "TET"], &[(CellKind::TETRA, "TETRA"), (CellKind::QUADRATIC_TETRA, "TETRA10")]),
    (
        &["HEX", "HEXAHEDRON"],
        &[
            (CellKind::HEXAHEDRON, "HEX"),
            (CellKind::QUADRATIC_HEXAHEDRON, "HEX20"),
            (CellKind::TRIQUADRATIC_HEXAHEDRON, "HEX27"),
        ],
    ),
    (&["WEDGE"], &[(CellKind::WEDGE, "WEDGE"), (CellKind::QUADRATIC_WEDGE, "WEDGE15")]),
    (&["PYRAMID", "PYRA"], &[(CellKind::PYRAMID, "PYRAMID"), (CellKind::QUADRATIC_PYRAMID, "PYRAMID13")]),
    (
        &["TRI", "TRIANGLE", "TRISHELL", "SHELL"],
        &[(CellKind::TRIANGLE, "TRI"), (CellKind::QUADRATIC_TRIANGLE, "TRI6")],
    ),
    (
        &["QUAD", "SHELL", "QUADSHELL"],
        &[
            (CellKind::QUAD, "QUAD"),
            (CellKind::QUADRATIC_QUAD, "QUAD8"),
            (CellKind::BIQUADRATIC_QUAD, "QUAD9"),
        ],
    ),
    (
        &["BAR", "BEAM", "TRUSS", "EDGE", "ROD"],
        &[(CellKind::LINE, "BAR2"), (CellKind::QUADRATIC_LINE, "BAR3")],
    ),
    (&["SPHERE", "POINT", "CIRCLE"], &[(CellKind::VERTEX, "SPHERE")]),
];

/// For each node of the file its position in VTK's order, where that differs.
const ORDERS: &[(CellKind, &[usize])] = &[
    (CellKind::QUADRATIC_WEDGE, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11]),
    (CellKind::QUADRATIC_HEXAHEDRON, HEXAHEDRON.split_at(20).0),
    (CellKind::TRIQUADRATIC_HEXAHEDRON, HEXAHEDRON),
];
/// The edges of the bottom, those that go up, those of the top; the centre, the faces across z, x and y.
const HEXAHEDRON: &[usize] =
    &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 16, 17, 18, 19, 12, 13, 14, 15, 26, 24, 25, 20, 21, 22, 23];

/// The corners of each side, in the order of the sides.
const SIDES: &[(CellKind, &[&[u8]])] = &[
    (CellKind::TETRA, &[&[0, 1, 3], &[1, 2, 3], &[0, 3, 2], &[0, 2, 1]]),
    (
        CellKind::HEXAHEDRON,
        &[&[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[0, 4, 7, 3], &[0, 3, 2, 1], &[4, 5, 6, 7]],
    ),
    (CellKind::WEDGE, &[&[0, 1, 4, 3], &[1, 2, 5, 4], &[0, 3, 5, 2], &[0, 2, 1], &[3, 4, 5]]),
    (CellKind::PYRAMID, &[&[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[0, 4, 3], &[0, 3, 2, 1]]),
];

/// The kind of cell of a type, whose name may end in a number, with this number of nodes.
pub(super) fn kind(name: &str, n_nodes: usize) -> Option<CellKind> {
    let name = name.to_ascii_uppercase();
    let name = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let named = TYPES.iter().filter(|(names, _)| names.contains(&name));
    named.flat_map(|(_, kinds)| *kinds).map(|(kind, _)| *kind).find(|kind| kind.n_vertices() == Some(n_nodes))
}

/// The name of the type of a kind of cell, if it is written.
pub(super) fn name_of(kind: CellKind) -> Option<&'static str> {
    TYPES.iter().flat_map(|(_, kinds)| *kinds).find(|(known, _)| *known == kind).map(|(_, name)| *name)
}

/// For each node of the file its position in VTK's order; `None` where both are the same.
pub(super) fn order(kind: CellKind) -> Option<&'static [usize]> {
    ORDERS.iter().find(|(known, _)| *known == kind).map(|(_, order)| *order)
}

/// The corners of the sides of a volume cell; sides of quadratic cells are those of the linear one.
pub(super) fn sides(kind: CellKind) -> &'static [&'static [u8]] {
    let is_alike = |kinds: &[(CellKind, &str)]| kinds.iter().any(|(known, _)| *known == kind);
    let linear = TYPES.iter().find(|(_, kinds)| is_alike(kinds)).and_then(|(_, kinds)| kinds.first());
    let linear = linear.map(|(kind, _)| *kind);
    SIDES.iter().find(|(known, _)| Some(*known) == linear).map_or(&[], |(_, sides)| *sides)
}
