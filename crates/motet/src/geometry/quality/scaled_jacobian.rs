//! The scaled Jacobian as Verdict defines it.

use std::f64::consts::SQRT_2;

use crate::base::Point;
use crate::geometry::quality::scaled::Scaled;

/// `sqrt(2) J / L`, where J is six times the volume and L the largest product of the lengths of the three
/// edges at a vertex (Verdict's `tet_scaled_jacobian`, Stimpson et al. 2007): 1 regular, 0 flat, negative
/// inverted.
pub fn scaled_jacobian(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    let [ab, ac, ad, bc, bd, cd] = tet.lengths_squared();
    let products = [ab * ac * ad, ab * bc * bd, ac * bc * cd, ad * bd * cd];
    let jacobian = tet.volume_6();
    let largest = products.into_iter().fold(0.0, f64::max).sqrt().max(jacobian.abs());
    if largest > 0.0 { SQRT_2 * jacobian / largest } else { 0.0 }
}
