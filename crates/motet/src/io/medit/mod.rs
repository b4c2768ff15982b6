//! Medit's meshes and solutions (the Gamma Mesh Format), of versions 1 to 4: `.mesh` and `.sol` in text,
//! `.meshb` and `.solb` in binary, in either order of bytes.
//!
//! References are the arrays `medit:ref` on points and on cells (meshio's name);
//! those of tetrahedra are regions, those of triangles patches. Cells marked as
//! required and edges marked as ridges are cell arrays `medit:required` and
//! `medit:ridge`, vertices `medit:required` and `medit:corner`: 1 where marked.
//! Normals, tangents and other sections are passed over with a note.
//!
//! A solution belongs to the mesh of the same name beside it, as MMG has it, and has no names for its arrays:
//!
//! * `a.mesh` and `a.meshb` are read with `a.sol` or `a.solb` where one lies beside: its arrays are `medit:sol`,
//!   `medit:sol_2` and so on, on points and on cells, NaN on cells of kinds without values. What is no solution,
//!   or has another number of values than the mesh has points or cells, is passed over with a note; a solution
//!   that is damaged is an error.
//! * `a.sol` and `a.solb` are read with `a.mesh` or `a.meshb` beside; all must fit.
//! * Writing `a.mesh` writes `a.sol` where there are arrays `medit:sol...`, and no others: MMG would take them for
//!   the sizes that are asked for. Writing `a.sol` writes all arrays of real numbers, and `a.mesh` beside.
//!   `.meshb` and `.solb` go together in the same way.
//!
//! Symmetric tensors stand as `xx xy yy xz yz zz` in a file (a triangle row by row), in arrays in VTK's order
//! `xx yy zz xy yz xz`. Solutions on cells of second order have no section.
//!
//! Layout: C. Dobrzynski, MMG3D: User Guide (INRIA RT-422), appendix A; the numbers of sections that are younger
//! as meshio has them. Binary files are written in version 2, in version 3 where they may pass 2 GiB, and in
//! version 4 where vertices do not count in 32 bits.
//!
//! No crate in the registry reads this format (the one there is, is under the
//! LGPL and not released).

mod beside;
mod binary;
mod content;
mod mesh;
mod sink;
mod solution;
mod source;
#[cfg(test)]
mod tests;
mod write;

use crate::io::Format;
use crate::mesh::CellKind;
use crate::mesh::marks::{CORNER, REQUIRED, RIDGE};

pub(super) const MESH: Format = Format {
    name: "Medit",
    endings: &[".mesh"],
    read: Some(beside::read_mesh),
    write: Some(|mesh, _| write::mesh(mesh, false)),
};
pub(super) const MESHB: Format = Format {
    name: "Medit binary",
    endings: &[".meshb"],
    read: Some(beside::read_mesh),
    write: Some(|mesh, _| write::mesh(mesh, true)),
};
pub(super) const SOL: Format = Format {
    name: "Medit solution",
    endings: &[".sol"],
    read: Some(beside::read_solution),
    write: Some(|mesh, _| write::solution(mesh, false)),
};
pub(super) const SOLB: Format = Format {
    name: "Medit binary solution",
    endings: &[".solb"],
    read: Some(beside::read_solution),
    write: Some(|mesh, _| write::solution(mesh, true)),
};

/// The name of a section in text and its number in binary files.
#[derive(Debug)]
struct Keyword {
    name: &'static str,
    number: i32,
}

const fn keyword(name: &'static str, number: i32) -> Keyword {
    Keyword { name, number }
}

const DIMENSION: Keyword = keyword("Dimension", 3);
const END: Keyword = keyword("End", 54);

/// What sections are about: points, or cells of a kind.
#[derive(Debug)]
struct Section {
    list: Keyword,
    /// The kind of cell and its number of vertices; `None` for points.
    cells: Option<(CellKind, usize)>,
    /// Where values on these stand in solutions.
    values: Option<Keyword>,
    /// Sections that list places in this one, each with the array that marks them.
    marks: &'static [(Keyword, &'static str)],
}

const REF: &str = "medit:ref";
const SOLUTION: &str = "medit:sol";

/// Points, then cells in the order in which they are written. Nodes on edges stand in VTK's order.
const SECTIONS: &[Section] = &[
    Section {
        list: keyword("Vertices", 4),
        cells: None,
        values: Some(keyword("SolAtVertices", 62)),
        marks: &[(keyword("Corners", 13), CORNER), (keyword("RequiredVertices", 15), REQUIRED)],
    },
    Section {
        list: keyword("Edges", 5),
        cells: Some((CellKind::LINE, 2)),
        values: Some(keyword("SolAtEdges", 63)),
        marks: &[(keyword("Ridges", 14), RIDGE), (keyword("RequiredEdges", 16), REQUIRED)],
    },
    Section {
        list: keyword("Triangles", 6),
        cells: Some((CellKind::TRIANGLE, 3)),
        values: Some(keyword("SolAtTriangles", 64)),
        marks: &[(keyword("RequiredTriangles", 17), REQUIRED)],
    },
    Section {
        list: keyword("Quadrilaterals", 7),
        cells: Some((CellKind::QUAD, 4)),
        values: Some(keyword("SolAtQuadrilaterals", 65)),
        marks: &[(keyword("RequiredQuadrilaterals", 18), REQUIRED)],
    },
    Section {
        list: keyword("Tetrahedra", 8),
        cells: Some((CellKind::TETRA, 4)),
        values: Some(keyword("SolAtTetrahedra", 66)),
        // Younger than the numbered list: text files alone have it.
        marks: &[(keyword("RequiredTetrahedra", TEXT_ONLY), REQUIRED)],
    },
    Section {
        list: keyword("Hexahedra", 10),
        cells: Some((CellKind::HEXAHEDRON, 8)),
        values: Some(keyword("SolAtHexahedra", 68)),
        marks: &[],
    },
    Section {
        list: keyword("Prisms", 9),
        cells: Some((CellKind::WEDGE, 6)),
        values: Some(keyword("SolAtPrisms", 67)),
        marks: &[],
    },
    Section {
        list: keyword("Pyramids", 49),
        cells: Some((CellKind::PYRAMID, 5)),
        values: Some(keyword("SolAtPyramids", 26)),
        marks: &[],
    },
    Section {
        list: keyword("EdgesP2", 25),
        cells: Some((CellKind::QUADRATIC_LINE, 3)),
        values: None,
        marks: &[],
    },
    Section {
        list: keyword("TrianglesP2", 24),
        cells: Some((CellKind::QUADRATIC_TRIANGLE, 6)),
        values: None,
        marks: &[],
    },
    Section {
        list: keyword("TetrahedraP2", 30),
        cells: Some((CellKind::QUADRATIC_TETRA, 10)),
        values: None,
        marks: &[],
    },
];

/// In place of a number, where a section has none in binary files.
const TEXT_ONLY: i32 = -1;

/// Other spellings that programs write.
const SPELLINGS: &[(&str, &str)] = &[
    ("Pentahedra", "Prisms"),
    ("Hexaedra", "Hexahedra"),
    ("Quadrangles", "Quadrilaterals"),
    ("SolAtPentahedra", "SolAtPrisms"),
];

/// Sections that are passed over, so that notes can name them in binary files too.
const PASSED_OVER: &[Keyword] = &[
    keyword("TangentAtEdgeVertices", 19),
    keyword("NormalAtVertices", 20),
    keyword("NormalAtTriangleVertices", 21),
    keyword("NormalAtQuadrilateralVertices", 22),
    keyword("AngleOfCornerBound", 23),
    keyword("QuadrilateralsQ2", 27),
    keyword("HexahedraQ2", 33),
    keyword("BoundingBox", 50),
    keyword("Tangents", 59),
    keyword("Normals", 60),
    keyword("TangentAtVertices", 61),
    keyword("Iterations", 77),
    keyword("Time", 78),
    keyword("PrismsP2", 86),
    keyword("PyramidsP2", 87),
];

/// The name of a section by its number.
fn name_of(number: i32) -> Option<&'static str> {
    let ours = SECTIONS.iter().flat_map(|s| {
        std::iter::once(&s.list).chain(&s.values).chain(s.marks.iter().map(|(keyword, _)| keyword))
    });
    let mut all = ours.chain([&DIMENSION, &END]).chain(PASSED_OVER);
    all.find(|keyword| keyword.number == number).map(|keyword| keyword.name)
}
