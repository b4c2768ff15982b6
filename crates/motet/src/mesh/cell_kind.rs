//! Kinds of cells, identified by VTK's numbers.

/// A kind of cell. Any of VTK's numbers is accepted, including those of kinds that motet itself does not
/// support.
///
/// Vertices of a cell are in VTK's order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[repr(transparent)]
pub struct CellKind(pub u8);

macro_rules! kinds {
    ($($constant:ident = $number:literal, $name:literal, $dim:expr, $n:expr;)*) => {
        impl CellKind {
            $(#[doc = concat!("VTK's number ", $number, ": ", $name, ".")]
            pub const $constant: Self = Self($number);)*

            /// All kinds that have a name, by their numbers.
            pub const NAMED: &[Self] = &[$(Self($number),)*];

            /// The name used by meshio; `None` for a number that is not listed here.
            pub fn name(self) -> Option<&'static str> {
                match self.0 {
                    $($number => Some($name),)*
                    _ => None,
                }
            }

            /// The kind with this name, if there is one.
            pub fn from_name(name: &str) -> Option<Self> {
                match name {
                    $($name => Some(Self($number)),)*
                    _ => None,
                }
            }

            /// The dimension: 0 for points, 1 for curves, 2 for surfaces, 3 for volumes; `None` if unknown.
            pub fn dim(self) -> Option<usize> {
                match self.0 {
                    $($number => $dim,)*
                    _ => None,
                }
            }

            /// Number of vertices of every cell of this kind; `None` if it varies from cell to cell, or is
            /// unknown.
            pub fn n_vertices(self) -> Option<usize> {
                match self.0 {
                    $($number => $n,)*
                    _ => None,
                }
            }
        }
    };
}

kinds! {
    EMPTY = 0, "empty", None, Some(0);
    VERTEX = 1, "vertex", Some(0), Some(1);
    POLY_VERTEX = 2, "poly_vertex", Some(0), None;
    LINE = 3, "line", Some(1), Some(2);
    POLY_LINE = 4, "poly_line", Some(1), None;
    TRIANGLE = 5, "triangle", Some(2), Some(3);
    TRIANGLE_STRIP = 6, "triangle_strip", Some(2), None;
    POLYGON = 7, "polygon", Some(2), None;
    PIXEL = 8, "pixel", Some(2), Some(4);
    QUAD = 9, "quad", Some(2), Some(4);
    TETRA = 10, "tetra", Some(3), Some(4);
    VOXEL = 11, "voxel", Some(3), Some(8);
    HEXAHEDRON = 12, "hexahedron", Some(3), Some(8);
    WEDGE = 13, "wedge", Some(3), Some(6);
    PYRAMID = 14, "pyramid", Some(3), Some(5);
    PENTAGONAL_PRISM = 15, "penta_prism", Some(3), Some(10);
    HEXAGONAL_PRISM = 16, "hexa_prism", Some(3), Some(12);
    QUADRATIC_LINE = 21, "line3", Some(1), Some(3);
    QUADRATIC_TRIANGLE = 22, "triangle6", Some(2), Some(6);
    QUADRATIC_QUAD = 23, "quad8", Some(2), Some(8);
    QUADRATIC_TETRA = 24, "tetra10", Some(3), Some(10);
    QUADRATIC_HEXAHEDRON = 25, "hexahedron20", Some(3), Some(20);
    QUADRATIC_WEDGE = 26, "wedge15", Some(3), Some(15);
    QUADRATIC_PYRAMID = 27, "pyramid13", Some(3), Some(13);
    BIQUADRATIC_QUAD = 28, "quad9", Some(2), Some(9);
    TRIQUADRATIC_HEXAHEDRON = 29, "hexahedron27", Some(3), Some(27);
    QUADRATIC_LINEAR_QUAD = 30, "quad6", Some(2), Some(6);
    QUADRATIC_LINEAR_WEDGE = 31, "wedge12", Some(3), Some(12);
    BIQUADRATIC_QUADRATIC_WEDGE = 32, "wedge18", Some(3), Some(18);
    BIQUADRATIC_QUADRATIC_HEXAHEDRON = 33, "hexahedron24", Some(3), Some(24);
    BIQUADRATIC_TRIANGLE = 34, "triangle7", Some(2), Some(7);
    CUBIC_LINE = 35, "line4", Some(1), Some(4);
    QUADRATIC_POLYGON = 36, "quadratic_polygon", Some(2), None;
    POLYHEDRON = 42, "polyhedron", Some(3), None;
    LAGRANGE_CURVE = 68, "VTK_LAGRANGE_CURVE", Some(1), None;
    LAGRANGE_TRIANGLE = 69, "VTK_LAGRANGE_TRIANGLE", Some(2), None;
    LAGRANGE_QUADRILATERAL = 70, "VTK_LAGRANGE_QUADRILATERAL", Some(2), None;
    LAGRANGE_TETRAHEDRON = 71, "VTK_LAGRANGE_TETRAHEDRON", Some(3), None;
    LAGRANGE_HEXAHEDRON = 72, "VTK_LAGRANGE_HEXAHEDRON", Some(3), None;
    LAGRANGE_WEDGE = 73, "VTK_LAGRANGE_WEDGE", Some(3), None;
    LAGRANGE_PYRAMID = 74, "VTK_LAGRANGE_PYRAMID", Some(3), None;
}

impl CellKind {
    /// A readable name: meshio's if there is one, otherwise VTK's number.
    pub fn label(self) -> String {
        self.name().map_or_else(|| format!("vtk_{}", self.0), str::to_owned)
    }
}
