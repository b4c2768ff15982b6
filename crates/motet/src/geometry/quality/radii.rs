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
    let longest_squared = longest_squared(&tet);
    let [a, b, c, d] = tet.points;
    let [b, c, d] = [b, c, d].map(|p| sub(p, a));
    // The length of this vector is 12 V R / h^2, where h is the length of the longest edge.
    let [x, y, z] = [(b, cross(c, d)), (c, cross(d, b)), (d, cross(b, c))]
        .map(|(p, n)| scale(n, dot(p, p) / longest_squared));
    let around = norm(add(add(x, y), z));
    // The radius r is 3 V over the area of the facets.
    match volume_6(&tet) {
        Some(volume_6) => {
            in_range(around * facet_area(&tet) / (3.0 * volume_6 * (volume_6 / longest_squared)))
        }
        None => LARGEST,
    }
}

/// `h / (2 sqrt(6) r)`, where h is the length of the longest edge and r the radius of the sphere inside that
/// touches the facets (Verdict's `tet_aspect_ratio`, Stimpson et al. 2007): 1 for the regular tet, at most
/// `1e30`, which also stands for a flat tet; that of its mirror image for an inverted one.
pub fn aspect_ratio(tet: [Point; 4]) -> f64 {
    let tet = Scaled::new(tet);
    match volume_6(&tet) {
        Some(volume_6) => {
            in_range(longest_squared(&tet).sqrt() * facet_area(&tet) / (6f64.sqrt() * volume_6))
        }
        None => LARGEST,
    }
}

/// The ratio between 1 and [`LARGEST`]. Neither ratio is below 1 but by rounding: by its last digits for a
/// regular tet, by far for a flat one whose volume is not computed as 0.
fn in_range(ratio: f64) -> f64 {
    if ratio < 0.5 { LARGEST } else { ratio.clamp(1.0, LARGEST) }
}

/// Six times the absolute volume, or `None` for a tet so flat or thin that both ratios are beyond
/// [`LARGEST`]. Among the tets of a volume V and a longest edge h, those that are as thick one way as the
/// other have the least facets, and both ratios grow as `sqrt(h^3 / V)`. The products in the ratios of other
/// tets do not underflow.
fn volume_6(tet: &Scaled) -> Option<f64> {
    let volume_6 = tet.volume_6().abs();
    let longest_squared = longest_squared(tet);
    (volume_6 > 1e-61 * longest_squared * longest_squared.sqrt()).then_some(volume_6)
}

fn longest_squared(tet: &Scaled) -> f64 {
    tet.lengths_squared().into_iter().fold(0.0, f64::max)
}

/// The area of all facets.
fn facet_area(tet: &Scaled) -> f64 {
    let [a, b, c, d] = tet.points;
    [[a, b, c], [a, b, d], [a, c, d], [b, c, d]].map(area).iter().sum()
}
