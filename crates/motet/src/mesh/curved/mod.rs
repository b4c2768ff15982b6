//! Curved cells: quadratic ones, judged by the determinant of their Jacobian everywhere inside.
//!
//! A quadratic cell is the image of a straight reference cell. It is upright if the determinant of the
//! Jacobian of that map, `det J`, is positive everywhere; at its corners, or with its edges taken as
//! straight, a cell may look sound and still be folded inside. `det J` is a polynomial: its Bernstein
//! coefficients bound it from both sides, and more closely when the cell is subdivided (Johnen, Remacle,
//! Geuzaine 2013, *Geometrical validity of curvilinear finite elements*, J. Comput. Phys. 233). One method
//! serves all kinds, which differ in their reference cell alone:
//!
//! | cells | reference | degree of `det J` | coefficients |
//! |---|---|---|---|
//! | tetra10 | tetrahedron | 3 | 20 |
//! | wedge12, 15, 18 | triangle x interval | 4, 5 | 90 |
//! | hexahedron20, 24, 27 | cube | 5, 5, 5 | 216 |
//! | pyramid13 | cube whose top is a single point | 5, 5, 3 | 144 |
//!
//! Cells without nodes in the middle of faces or of the volume get them where their own (serendipity) shape
//! functions put these places, by transfinite interpolation (Gordon and Hall 1973). The pyramid has the
//! rational shape functions of Bedrosian (1992), as in Gmsh and most finite element codes; they are
//! polynomials on the cube, where `det J` is that of the pyramid times a square, which is divided out.
//! Volumes elsewhere in motet take edges as straight.

mod cells;
mod jacobian;
mod nodes;
mod tables;

pub use cells::{CurvedCells, CurvedSummary};
pub use jacobian::{Jacobian, LeastJacobian, is_upright};
pub use nodes::middles;
pub use tables::is_curved_kind;
