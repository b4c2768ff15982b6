//! Dihedral angles: between the two facets at each edge, in radians.

use crate::base::Point;
use crate::geometry::quality::cotangents::{Parts, angle};
use crate::geometry::quality::scaled::Scaled;

/// The dihedral angle of the regular tet, acos(1/3), in radians.
pub const REGULAR: f64 = 1.230_959_417_340_774_7;

/// The dihedral angle at each edge, in the order of [`EDGES`](crate::geometry::tet::EDGES), in [0, pi]. An
/// inverted tet has the angles of its mirror image; the angles of a facet without area count as 0.
pub fn angles(tet: [Point; 4]) -> [f64; 6] {
    Parts::of(&Scaled::new(tet)).dihedral().map(angle)
}

/// The smallest dihedral angle, in radians.
pub fn min(tet: [Point; 4]) -> f64 {
    min_max(tet)[0]
}

/// The largest dihedral angle, in radians.
pub fn max(tet: [Point; 4]) -> f64 {
    min_max(tet)[1]
}

/// The smallest and the largest dihedral angle, in radians: half the work of calling [`min`] and [`max`].
pub fn min_max(tet: [Point; 4]) -> [f64; 2] {
    let cotangents = Parts::of(&Scaled::new(tet)).dihedral_extremes();
    [angle(cotangents.high), angle(cotangents.low)]
}
