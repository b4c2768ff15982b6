//! Medit's meshes and solutions (the Gamma Mesh Format), versions 1 to 4: `.mesh` and `.sol` as text,
//! `.meshb` and `.solb` as binary, in either byte order.
//!
//! References are the arrays `medit:ref` on points and on cells (meshio's name); those of tetrahedra are
//! regions, those of triangles patches. Cells marked as required and edges marked as ridges are cell arrays
//! `medit:required` and `medit:ridge`, marked vertices point arrays `medit:required` and `medit:corner`: 1
//! where marked. Normals, tangents and other sections are skipped with a note.
//!
//! As in MMG, a solution belongs to the mesh of the same name beside it, and its arrays have no names:
//!
//! * `a.mesh` and `a.meshb` are read together with `a.sol` or `a.solb` if there is one: its arrays are
//!   `medit:sol`, `medit:sol_2` and so on, on points and on cells, NaN on cells of kinds without values. A
//!   file that is not a solution, or whose number of values differs from that of the points or cells of the
//!   mesh, is skipped with a note; a damaged solution is an error.
//! * `a.sol` and `a.solb` are read together with `a.mesh` or `a.meshb`; all values must fit.
//! * Writing `a.mesh` also writes `a.sol` if there are arrays `medit:sol...`, with these arrays only: MMG
//!   would take others for the requested sizes. Writing `a.sol` writes all real-valued arrays, and `a.mesh`
//!   beside it. The same holds for `.meshb` and `.solb`.
//!
//! Symmetric tensors are stored as `xx xy yy xz yz zz` in a file (a triangle row by row), and in arrays in
//! VTK's order `xx yy zz xy yz xz`. There are no sections for solutions on second-order cells.
//!
//! Layout: C. Dobrzynski, MMG3D: User Guide (INRIA RT-422), appendix A; the numbers of newer sections are
//! those of meshio. Binary files are written in version 2, in version 3 where they may exceed 2 GiB, and in
//! version 4 where vertex numbers exceed 32 bits.
//!
//! No crate in the registry reads this format (the only one that exists is under the LGPL and unreleased).

mod binary;
mod companion;
mod content;
mod mesh;
mod sink;
mod solution;
mod source;
#[cfg(test)]
mod tests;
mod write;

use crate::io::{Format, Write};
use crate::mesh::CellKind;
use crate::mesh::marks::{CORNER, REQUIRED, RIDGE};

pub(super) const MESH: Format = Format {
    name: "Medit",
    extensions: &[".mesh"],
    read: Some(companion::read_mesh),
    write: Some(Write::Files(|mesh, _, threads, _| write::mesh(mesh, false, threads))),
};
pub(super) const MESHB: Format = Format {
    name: "Medit binary",
    extensions: &[".meshb"],
    read: Some(companion::read_mesh),
    write: Some(Write::Files(|mesh, _, threads, _| write::mesh(mesh, true, threads))),
};
pub(super) const SOL: Format = Format {
    name: "Medit solution",
    extensions: &[".sol"],
    read: Some(companion::read_solution),
    write: Some(Write::Files(|mesh, _, threads, _| write::solution(mesh, false, threads))),
};
pub(super) const SOLB: Format = Format {
    name: "Medit binary solution",
    extensions: &[".solb"],
    read: Some(companion::read_solution),
    write: Some(Write::Files(|mesh, _, threads, _| write::solution(mesh, true, threads))),
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

/// The sections for one kind of entity: points, or cells of a kind.
#[derive(Debug)]
struct Section {
    list: Keyword,
    /// The kind of cell and its number of vertices; `None` for points.
    cells: Option<(CellKind, usize)>,
    /// The section of solutions with values on these entities.
    values: Option<Keyword>,
    /// Sections that mark entities of this one, each with the array that stores the marks.
    marks: &'static [(Keyword, &'static str)],
}

const REF: &str = "medit:ref";
const SOLUTION: &str = "medit:sol";

/// Points, then cells in the order in which they are written. Nodes on edges are in VTK's order.
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
        // Newer than the numbered list of sections: only in text files.
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

/// Replaces the number of sections that binary files do not have.
const TEXT_ONLY: i32 = -1;

/// Alternative spellings used by other programs.
const ALIASES: &[(&str, &str)] = &[
    ("Pentahedra", "Prisms"),
    ("Hexaedra", "Hexahedra"),
    ("Quadrangles", "Quadrilaterals"),
    ("SolAtPentahedra", "SolAtPrisms"),
];

/// Skipped sections, listed so that notes can name them in binary files too.
const SKIPPED_SECTIONS: &[Keyword] = &[
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

/// The name of a section with this number.
fn name_of(number: i32) -> Option<&'static str> {
    let ours = SECTIONS.iter().flat_map(|s| {
        std::iter::once(&s.list).chain(&s.values).chain(s.marks.iter().map(|(keyword, _)| keyword))
    });
    let mut all = ours.chain([&DIMENSION, &END]).chain(SKIPPED_SECTIONS);
    all.find(|keyword| keyword.number == number).map(|keyword| keyword.name)
}
