//! A new closed surface around what other surfaces enclose, within a distance of them: they may be open,
//! torn, double, cross themselves or each other.
//!
//! | step | where | how |
//! |---|---|---|
//! | inside | `field` | a place is inside if the surfaces go around it more than half a time (Jacobson, Kavan and Sorkine-Hornung 2013, *Robust inside-outside segmentation using generalized winding numbers*) |
//! | first sites | `seeds` | corners of creases, and vertices far from each other |
//! | facets | `facets` | the Delaunay triangulation of the sites; a facet belongs to the surface if the centre of the circumsphere is inside on one side of it alone (Boissonnat and Oudot 2005, *Provably good sampling and meshing of surfaces*) |
//! | more sites | `rounds`, `spaced` | where facets stray or are narrow, and where given triangles are far from all facets |
//!
//! The surface is the boundary of a set of tets, so it is closed, and its triangles share all that they have
//! in common.

mod facets;
mod field;
mod rounds;
mod seeds;
mod spaced;

use crate::base::{MaybeId, Point, VertexId};

pub(crate) use field::Field;
pub(crate) use rounds::wrap;

/// A new surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Wrapped {
    /// The places of its vertices.
    pub(crate) points: Vec<Point>,
    /// The given vertex that a vertex is, if any.
    pub(crate) given: Vec<MaybeId<VertexId>>,
    /// The triangles, by their places in `points`, facing outward.
    pub(crate) triangles: Vec<[u32; 3]>,
    /// What became of each given triangle.
    pub(crate) fates: Vec<Fate>,
}

/// What became of a given triangle, judged at its centroid and where sites were missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Fate {
    /// The new surface is within the distance.
    Kept,
    /// It lies inside.
    Inside,
    /// It encloses nothing.
    Outside,
    /// It is one of a wall or a gap thinner than the distance, which is not there any more.
    Thin,
}
