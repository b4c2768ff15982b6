//! The measures by name.

use crate::base::Point;
use crate::geometry::quality;
use crate::geometry::quality::dihedral;

crate::names! {
    /// A quality measure of tets.
    #[derive(PartialOrd, Ord)]
    pub enum Measure: "measure" {
        /// Equi-angle quality: 1 minus the equiangle skew, negative for inverted tets; 1 regular, 0 flat, bad
        /// below 0.2.
        Eas = "eas",
        /// Six times the volume times the square root of 2, over the largest product of the edges at a
        /// vertex: 1 regular, 0 flat, negative inverted. As in Verdict.
        ScaledJacobian = "scaled_jacobian",
        /// 12 (3 V)^(2/3) over the sum of the squared edge lengths: 1 regular, 0 flat, negative inverted.
        MeanRatio = "mean_ratio",
        /// Radius of the circumsphere over three times that of the insphere: 1 regular, larger otherwise. As
        /// in Verdict.
        RadiusRatio = "radius_ratio",
        /// Longest edge over the radius of the insphere, divided by 2 sqrt(6): 1 regular, larger otherwise.
        /// As in Verdict.
        AspectRatio = "aspect_ratio",
        /// Longest edge over the shortest: 1 regular, larger otherwise.
        EdgeRatio = "edge_ratio",
        /// The smallest dihedral angle in degrees: 70.53 regular, 0 flat.
        MinDihedral = "min_dihedral_deg",
        /// The largest dihedral angle in degrees: 70.53 regular, 180 flat.
        MaxDihedral = "max_dihedral_deg",
        /// The volume: negative inverted.
        Volume = "volume",
    }
}

impl Measure {
    /// The measure of a tet with these vertices.
    pub fn of_tet(self, tet: [Point; 4]) -> f64 {
        match self {
            Self::Eas => quality::eas(tet),
            Self::ScaledJacobian => quality::scaled_jacobian(tet),
            Self::MeanRatio => quality::mean_ratio(tet),
            Self::RadiusRatio => quality::radius_ratio(tet),
            Self::AspectRatio => quality::aspect_ratio(tet),
            Self::EdgeRatio => quality::edge_ratio(tet),
            Self::MinDihedral => dihedral::min(tet).to_degrees(),
            Self::MaxDihedral => dihedral::max(tet).to_degrees(),
            Self::Volume => quality::volume(tet),
        }
    }

    /// Whether a larger value is better.
    pub fn is_better_if_larger(self) -> bool {
        !matches!(self, Self::RadiusRatio | Self::AspectRatio | Self::EdgeRatio | Self::MaxDihedral)
    }
}
