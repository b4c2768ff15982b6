//! Element types: the cell kind of each, the order of its nodes, and the numbers of its faces.

use crate::io::node_order::{Nodes, vtk_to_other};
use crate::mesh::CellKind;
use crate::mesh::facets::facet_shapes;

/// The meaning of the digits after the letters of a family.
#[derive(Clone, Copy)]
enum Digits {
    /// Number of nodes of a solid.
    Solid,
    /// Number of nodes of a face.
    Face,
    /// Number of nodes of a curve.
    Curve,
    /// Order of interpolation of a beam.
    Beam,
}

/// Element families by the letters before the digits; a suffix (`R`, `H`, `T`, ...) does not change the
/// nodes.
const FAMILIES: &[(&str, Digits)] = &[
    ("C3D", Digits::Solid),
    ("DC3D", Digits::Solid),
    ("DCC3D", Digits::Solid),
    ("AC3D", Digits::Solid),
    ("EC3D", Digits::Solid),
    ("EMC3D", Digits::Solid),
    ("FC3D", Digits::Solid),
    ("F3D", Digits::Solid),
    ("Q3D", Digits::Solid),
    ("COH3D", Digits::Solid),
    ("SC", Digits::Solid),
    ("CSS", Digits::Solid),
    ("S", Digits::Face),
    ("DS", Digits::Face),
    ("STRI", Digits::Face),
    ("M3D", Digits::Face),
    ("SFM3D", Digits::Face),
    ("R3D", Digits::Face),
    ("CPS", Digits::Face),
    ("CPE", Digits::Face),
    ("CPEG", Digits::Face),
    ("CAX", Digits::Face),
    ("CGAX", Digits::Face),
    ("DC2D", Digits::Face),
    ("DCC2D", Digits::Face),
    ("DCAX", Digits::Face),
    ("DCCAX", Digits::Face),
    ("AC2D", Digits::Face),
    ("ACAX", Digits::Face),
    ("COH2D", Digits::Face),
    ("COHAX", Digits::Face),
    ("T2D", Digits::Curve),
    ("T3D", Digits::Curve),
    ("R2D", Digits::Curve),
    ("RAX", Digits::Curve),
    ("DC1D", Digits::Curve),
    ("DCC1D", Digits::Curve),
    ("AC1D", Digits::Curve),
    ("B2", Digits::Beam),
    ("B3", Digits::Beam),
    ("PIPE2", Digits::Beam),
    ("PIPE3", Digits::Beam),
    ("ELBOW3", Digits::Beam),
];

/// An element type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ElementType {
    pub(super) kind: CellKind,
    pub(super) n_nodes: usize,
    /// Whether one more node may follow, which gives the orientation of a beam.
    pub(super) may_have_orientation_node: bool,
}

impl ElementType {
    /// The type with this name, in capitals; `None` if it has no cell kind here.
    pub(super) fn of(name: &str) -> Option<Self> {
        let digits_at = |rest: &str| rest.starts_with(|c: char| c.is_ascii_digit());
        let (digits, rest) = FAMILIES.iter().find_map(|&(letters, digits)| {
            Some((digits, name.strip_prefix(letters)?)).filter(|f| digits_at(f.1))
        })?;
        let n_digits = rest.bytes().take_while(u8::is_ascii_digit).count();
        let (number, suffix) = rest.split_at(n_digits);
        let kind = match digits {
            // Variable-node elements, some of whose nodes may be missing.
            _ if suffix.starts_with('V') => return None,
            Digits::Solid => solid(number),
            Digits::Face => face(number),
            Digits::Curve | Digits::Beam => curve(digits, number),
        }?;
        let may_have_orientation_node = matches!(digits, Digits::Beam);
        Some(Self { kind, n_nodes: kind.n_vertices()?, may_have_orientation_node })
    }
}

fn solid(digits: &str) -> Option<CellKind> {
    Some(match digits {
        "4" => CellKind::TETRA,
        "5" => CellKind::PYRAMID,
        "6" => CellKind::WEDGE,
        "8" => CellKind::HEXAHEDRON,
        "10" => CellKind::QUADRATIC_TETRA,
        // Written by Gmsh; Abaqus has no such element.
        "13" => CellKind::QUADRATIC_PYRAMID,
        "15" => CellKind::QUADRATIC_WEDGE,
        "20" => CellKind::QUADRATIC_HEXAHEDRON,
        "27" => CellKind::TRIQUADRATIC_HEXAHEDRON,
        _ => return None,
    })
}

fn face(digits: &str) -> Option<CellKind> {
    Some(match digits {
        "3" => CellKind::TRIANGLE,
        "4" => CellKind::QUAD,
        // `STRI65` has six nodes of five degrees of freedom each.
        "6" | "65" => CellKind::QUADRATIC_TRIANGLE,
        "8" => CellKind::QUADRATIC_QUAD,
        "9" => CellKind::BIQUADRATIC_QUAD,
        _ => return None,
    })
}

fn curve(digits: Digits, number: &str) -> Option<CellKind> {
    Some(match (digits, number) {
        // Cubic beams have no mid-side nodes.
        (Digits::Curve, "2") | (Digits::Beam, "1" | "3") => CellKind::LINE,
        (Digits::Curve, "3") | (Digits::Beam, "2") => CellKind::QUADRATIC_LINE,
        _ => return None,
    })
}

/// The element type written for each cell kind.
const WRITTEN: &[(CellKind, &str)] = &[
    (CellKind::LINE, "T3D2"),
    (CellKind::QUADRATIC_LINE, "T3D3"),
    (CellKind::TRIANGLE, "S3"),
    (CellKind::QUAD, "S4"),
    (CellKind::QUADRATIC_TRIANGLE, "STRI65"),
    (CellKind::QUADRATIC_QUAD, "S8R"),
    (CellKind::BIQUADRATIC_QUAD, "S9R5"),
    (CellKind::TETRA, "C3D4"),
    (CellKind::PYRAMID, "C3D5"),
    (CellKind::WEDGE, "C3D6"),
    (CellKind::HEXAHEDRON, "C3D8"),
    (CellKind::QUADRATIC_TETRA, "C3D10"),
    (CellKind::QUADRATIC_WEDGE, "C3D15"),
    (CellKind::QUADRATIC_HEXAHEDRON, "C3D20"),
    (CellKind::TRIQUADRATIC_HEXAHEDRON, "C3D27"),
];

/// The element type written for cells of a kind, if any.
pub(super) fn written_as(kind: CellKind) -> Option<&'static str> {
    WRITTEN.iter().find(|w| w.0 == kind).map(|w| w.1)
}

/// For each node in VTK's order, its position in Abaqus's order. Kinds not listed here have the same order in
/// both.
pub(super) fn vtk_to_abaqus(kind: CellKind, n_nodes: usize) -> Vec<usize> {
    match kind {
        // Abaqus numbers the nodes from one end to the other.
        CellKind::QUADRATIC_LINE => vec![0, 2, 1],
        CellKind::TRIQUADRATIC_HEXAHEDRON => vtk_to_other(kind, n_nodes, BRICK_OF_27),
        _ => (0..n_nodes).collect(),
    }
}

const BRICK_OF_27: Nodes = &[
    &[0, 1],
    &[1, 2],
    &[2, 3],
    &[3, 0],
    &[4, 5],
    &[5, 6],
    &[6, 7],
    &[7, 4],
    &[0, 4],
    &[1, 5],
    &[2, 6],
    &[3, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
    &[0, 1, 2, 3],
    &[4, 5, 6, 7],
    &[0, 1, 4, 5],
    &[1, 2, 5, 6],
    &[2, 3, 6, 7],
    &[0, 3, 4, 7],
];

/// Corners of the faces S1, S2, ... of solids by their number of corners ("Element faces" in the element
/// library).
const FACES: &[(usize, Nodes)] = &[
    (4, &[&[0, 1, 2], &[0, 3, 1], &[1, 3, 2], &[2, 3, 0]]),
    (5, &[&[0, 1, 2, 3], &[0, 4, 1], &[1, 4, 2], &[2, 4, 3], &[3, 4, 0]]),
    (6, &[&[0, 1, 2], &[3, 5, 4], &[0, 3, 4, 1], &[1, 4, 5, 2], &[2, 5, 3, 0]]),
    (8, &[&[0, 1, 2, 3], &[4, 7, 6, 5], &[0, 4, 5, 1], &[1, 5, 6, 2], &[2, 6, 7, 3], &[3, 7, 4, 0]]),
];

/// For each face S1, S2, ... of a solid, its index among the facets of the kind; empty for other kinds.
pub(super) fn faces(kind: CellKind) -> Vec<usize> {
    let shapes = facet_shapes(kind).unwrap_or_default();
    let n_corners = shapes.iter().flat_map(|s| s.corners()).max().map_or(0, |&last| usize::from(last) + 1);
    let faces = FACES.iter().find(|f| f.0 == n_corners).map_or(&[][..], |f| f.1);
    let is = |a: &[u8], b: &[u8]| a.len() == b.len() && a.iter().all(|c| b.contains(c));
    faces.iter().filter_map(|face| shapes.iter().position(|s| is(s.corners(), face))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_are_recognized_with_any_suffix() {
        for (names, kind) in [
            ("C3D4 C3D4H C3D4T DC3D4 AC3D4 Q3D4", CellKind::TETRA),
            ("C3D10 C3D10M C3D10MH C3D10HS DC3D10", CellKind::QUADRATIC_TETRA),
            ("C3D8 C3D8R C3D8I C3D8RH DC3D8 COH3D8 SC8R CSS8", CellKind::HEXAHEDRON),
            ("C3D6 C3D6H COH3D6 SC6R", CellKind::WEDGE),
            ("C3D20 C3D20R C3D20RH", CellKind::QUADRATIC_HEXAHEDRON),
            ("S3 S3R STRI3 CPS3 CPE3 CAX3 M3D3 R3D3 SFM3D3 DS3", CellKind::TRIANGLE),
            ("S4 S4R S4R5 S4RS CPE4RH CPEG4 M3D4R R3D4", CellKind::QUAD),
            ("STRI65 CPS6 CPE6M M3D6", CellKind::QUADRATIC_TRIANGLE),
            ("S8R S8R5 CPS8R CAX8", CellKind::QUADRATIC_QUAD),
            ("S9R5 M3D9", CellKind::BIQUADRATIC_QUAD),
            ("B31 B31H B33 B21 PIPE31 T3D2 R2D2", CellKind::LINE),
            ("B32 B32R B22 T3D3 T2D3 ELBOW32", CellKind::QUADRATIC_LINE),
        ] {
            for name in names.split(' ') {
                assert_eq!(ElementType::of(name).map(|t| t.kind), Some(kind), "{name}");
            }
        }
        for name in ["MASS", "SPRINGA", "CONN3D2", "U1", "C3D", "S", "C3D7", "C3D15V", "", "SAX1", "B34"] {
            assert_eq!(ElementType::of(name), None, "{name}");
        }
    }

    #[test]
    fn every_type_that_is_written_is_read_as_the_same_kind() {
        for &(kind, name) in WRITTEN {
            assert_eq!(ElementType::of(name).map(|t| t.kind), Some(kind), "{name}");
            let mut order = vtk_to_abaqus(kind, kind.n_vertices().unwrap());
            order.sort_unstable();
            assert_eq!(order, (0..kind.n_vertices().unwrap()).collect::<Vec<_>>());
        }
    }

    #[test]
    fn every_face_is_a_facet() {
        for kind in WRITTEN.iter().map(|w| w.0) {
            let mut faces = faces(kind);
            faces.sort_unstable();
            let n = facet_shapes(kind).map_or(0, <[_]>::len);
            assert_eq!(faces, (0..n).collect::<Vec<_>>(), "{}", kind.label());
        }
    }
}
