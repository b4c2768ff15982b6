//! Types of cells: their names and codes, and the order of their nodes.

use crate::mesh::CellKind;

/// A type of cells.
pub(super) struct Geometry {
    pub(super) kind: CellKind,
    pub(super) name: &'static str,
    /// The dimension in hundreds, and the number of nodes.
    pub(super) code: i64,
    /// For each node of the file its position in VTK's order; empty where both are the same.
    pub(super) order: &'static [usize],
}

const fn geometry(kind: CellKind, name: &'static str, code: i64, order: &'static [usize]) -> Geometry {
    Geometry { kind, name, code, order }
}

/// Types in which all cells have the same number of nodes.
pub(super) const GEOMETRIES: &[Geometry] = &[
    geometry(CellKind::VERTEX, "PO1", 1, &[]),
    geometry(CellKind::LINE, "SE2", 102, &[]),
    geometry(CellKind::QUADRATIC_LINE, "SE3", 103, &[]),
    geometry(CellKind::CUBIC_LINE, "SE4", 104, &[]),
    geometry(CellKind::TRIANGLE, "TR3", 203, &[]),
    geometry(CellKind::QUADRATIC_TRIANGLE, "TR6", 206, &[]),
    geometry(CellKind::BIQUADRATIC_TRIANGLE, "TR7", 207, &[]),
    geometry(CellKind::QUAD, "QU4", 204, &[]),
    geometry(CellKind::QUADRATIC_QUAD, "QU8", 208, &[]),
    geometry(CellKind::BIQUADRATIC_QUAD, "QU9", 209, &[]),
    geometry(CellKind::TETRA, "TE4", 304, &[0, 2, 1, 3]),
    geometry(CellKind::QUADRATIC_TETRA, "T10", 310, &[0, 2, 1, 3, 6, 5, 4, 7, 9, 8]),
    geometry(CellKind::HEXAHEDRON, "HE8", 308, &[0, 3, 2, 1, 4, 7, 6, 5]),
    geometry(CellKind::QUADRATIC_HEXAHEDRON, "H20", 320, HEXAHEDRON.split_at(20).0),
    geometry(CellKind::TRIQUADRATIC_HEXAHEDRON, "H27", 327, HEXAHEDRON),
    geometry(CellKind::WEDGE, "PE6", 306, &[0, 2, 1, 3, 5, 4]),
    geometry(CellKind::QUADRATIC_WEDGE, "P15", 315, WEDGE.split_at(15).0),
    geometry(CellKind::BIQUADRATIC_QUADRATIC_WEDGE, "P18", 318, WEDGE),
    geometry(CellKind::PYRAMID, "PY5", 305, &[0, 3, 2, 1, 4]),
    geometry(CellKind::QUADRATIC_PYRAMID, "P13", 313, &[0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10]),
];

const HEXAHEDRON: &[usize] =
    &[0, 3, 2, 1, 4, 7, 6, 5, 11, 10, 9, 8, 15, 14, 13, 12, 16, 19, 18, 17, 24, 20, 23, 21, 22, 25, 26];
const WEDGE: &[usize] = &[0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13, 17, 16, 15];

/// Polygons, and polyhedra.
pub(super) const POLYGONS: (&str, i64) = ("POG", 400);
pub(super) const POLYHEDRA: (&str, i64) = ("POE", 500);

/// The type with this name.
pub(super) fn named(name: &str) -> Option<&'static Geometry> {
    GEOMETRIES.iter().find(|geometry| geometry.name == name)
}

/// How cells of a kind are written, if they are: name and code of the type.
pub(super) fn written_as(kind: CellKind) -> Option<(&'static str, i64)> {
    match kind {
        CellKind::POLYGON => Some(POLYGONS),
        CellKind::POLYHEDRON => Some(POLYHEDRA),
        // Unknown to readers of files of version 3.0.
        CellKind::BIQUADRATIC_QUADRATIC_WEDGE => None,
        kind => GEOMETRIES.iter().find(|g| g.kind == kind).map(|geometry| (geometry.name, geometry.code)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_those_of_all_nodes_and_their_own_inverse() {
        for geometry in GEOMETRIES {
            let n = geometry.kind.n_vertices().unwrap();
            assert_eq!(geometry.code % 100, n as i64);
            let written = Some((geometry.name, geometry.code)).filter(|(name, _)| *name != "P18");
            assert_eq!(written_as(geometry.kind), written);
            assert_eq!(geometry.code / 100, geometry.kind.dim().unwrap() as i64);
            let mut sorted = geometry.order.to_vec();
            sorted.sort_unstable();
            assert!(sorted.is_empty() || sorted == (0..n).collect::<Vec<_>>(), "{}", geometry.name);
        }
    }
}
