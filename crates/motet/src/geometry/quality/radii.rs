//! Ratios of the radii of the spheres in and around a tet, and of its edges to them, as Verdict defines them.

use crate::base::Point;
use crate::geometry::quality::edge_ratio::LARGEST;
use crate::geometry::quality::scaled::Scaled;
use crate::geometry::triangle::area;
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};

/// `R / (3 r)`, where R is the radius of the sphere through the vertices and r that of the sphere inside that
/// touches the facets (Verdict's `tet_radius_ratio`, Stimpson et al. 2007): 1 for the regular tet, at most
/// `1e30`, which also stands for a flat tet; that of its mirror image for an inverted one. The inverse, which
/// is 1 for the regular tet and 0 for a flat one, is called the radius ratio, too.
pub fn radius_ratio(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    let [a, b, c, d] = tet.points;
    let [b, c, d] = [b, c, d].map(|p| sub(p, a));
    // The length of this vector is 12 V R.
    let [x, y, z] = [(b, cross(c, d)), (c, cross(d, b)), (d, cross(b, c))].map(|(p, n)| scale(n, dot(p, p)));
    let around = norm(add(add(x, y), z));
    // The radius r is 3 V over the area of the facets.
    let volume_6 = tet.volume_6();
    at_most_largest(around * facet_area(&tet), 3.0 * volume_6 * volume_6)
}

/// `h / (2 sqrt(6) r)`, where h is the length of the longest edge and r the radius of the sphere inside that
/// touches the facets (Verdict's `tet_aspect_ratio`, Stimpson et al. 2007): 1 for the regular tet, at most
/// `1e30`, which also stands for a flat tet; that of its mirror image for an inverted one.
pub fn aspect_ratio(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    let longest = tet.lengths_squared().into_iter().fold(0.0, f64::max).sqrt();
    at_most_largest(longest * facet_area(&tet), 6f64.sqrt() * tet.volume_6().abs())
}

/// The area of all facets.
fn facet_area(tet: &Scaled) -> f64 {
    let [a, b, c, d] = tet.points;
    [[a, b, c], [a, b, d], [a, c, d], [b, c, d]].map(area).iter().sum()
}

fn at_most_largest(numerator: f64, denominator: f64) -> f64 {
    if denominator > 0.0 { (numerator / denominator).min(LARGEST) } else { LARGEST }
}
