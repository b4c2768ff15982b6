//! Kinds of defects of a mesh, with how often and where each occurs.

use std::fmt;

use crate::base::{CellId, Point, VertexId};
use crate::geometry::vector::in_range;

macro_rules! defect_kinds {
    ($($variant:ident = $name:literal, $meaning:literal;)*) => {
        /// A kind of defect.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
        #[non_exhaustive]
        pub enum DefectKind {
            $(#[doc = $meaning] #[cfg_attr(feature = "serde", serde(rename = $name))] $variant,)*
        }

        impl DefectKind {
            /// The name that scripts see.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The meaning in words.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }
        }
    };
}

defect_kinds! {
    NonFinitePoint = "non_finite_point", "a coordinate is infinite, beyond 1e60 or not a number";
    OrphanPoint = "orphan_point", "no cell uses the point";
    DuplicatePoint = "duplicate_point", "points at exactly the same place";
    UnknownKind = "unknown_kind", "volume cells of a kind that motet does not support";
    RepeatedVertex = "repeated_vertex", "the cell names a vertex twice";
    InvertedCell = "inverted_cell", "the volume is negative";
    FlatCell = "flat_cell", "the volume is exactly zero";
    FoldedCell = "folded_cell", "the Jacobian determinant of the quadratic cell is zero or negative \
        somewhere in it, positive elsewhere";
    ZeroAreaCell = "zero_area_cell", "the surface cell has no area";
    DuplicateCell = "duplicate_cell", "cells with the same vertices";
    OversharedFacet = "overshared_facet", "more than two volume cells use the facet";
    FoldedFacet = "folded_facet", "two tets lie on the same side of the facet, one over the other";
    UnmergedFacet = "unmerged_facet", "boundary facets at exactly the same place, their vertices not shared";
    HangingVertex = "hanging_vertex", "the vertex lies on a boundary facet of which it is not a corner";
    NonManifoldEdge = "non_manifold_edge", "more than two surface facets meet at the edge";
    NonManifoldVertex = "non_manifold_vertex", "the surface touches itself at the vertex";
    OpenEdge = "open_edge", "the surface ends at the edge";
    MisorientedEdge = "misoriented_edge", "the two facets at the edge face opposite sides";
    SeparatePart = "separate_part", "a part of the mesh that is not connected to the rest";
}

/// Number of examples of a defect that are kept.
const MAX_EXAMPLES: usize = 5;

/// Where a defect is.
#[derive(Clone, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Example {
    /// The cells concerned.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub cells: Vec<CellId>,
    /// The vertices concerned.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub vertices: Vec<VertexId>,
    /// The place in space; `None` where it is not finite.
    pub at: Option<Point>,
}

/// A defect of one kind: how often it occurs, and the first few places.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct Defect {
    /// The kind of defect.
    #[cfg_attr(feature = "serde", serde(rename = "name"))]
    pub kind: DefectKind,
    /// Number of occurrences.
    pub count: usize,
    /// The first occurrences, five at most.
    pub examples: Vec<Example>,
}

impl Defect {
    /// A defect of this kind without occurrences yet.
    pub(super) fn empty(kind: DefectKind) -> Self {
        Self { kind, count: 0, examples: Vec::new() }
    }

    /// Counts one more occurrence, and keeps it as an example while there are few.
    pub(super) fn add(&mut self, example: impl FnOnce() -> Example) {
        self.count += 1;
        if self.examples.len() < MAX_EXAMPLES {
            self.examples.push(example());
        }
    }
}

impl Example {
    /// An example located at the mean of its vertices.
    pub(super) fn new(cells: &[CellId], vertices: &[VertexId], points: &[Point]) -> Self {
        let mut at = [0.0; 3];
        for v in vertices {
            (0..3).for_each(|k| at[k] += points[v.index()][k] / vertices.len() as f64);
        }
        let finite = in_range(at) && !vertices.is_empty();
        let mut cells = cells.to_vec();
        // A cell may meet itself.
        cells.dedup();
        Self { cells, vertices: vertices.to_vec(), at: finite.then_some(at) }
    }
}

impl fmt::Display for Example {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let list = |ids: Vec<String>| ids.join(", ");
        let cells = list(self.cells.iter().map(ToString::to_string).collect());
        let vertices = list(self.vertices.iter().map(ToString::to_string).collect());
        match (self.cells.is_empty(), self.vertices.is_empty()) {
            (false, _) => write!(f, "cell {cells}")?,
            (true, false) => write!(f, "point {vertices}")?,
            (true, true) => {}
        }
        match self.at {
            Some([x, y, z]) => write!(f, " at ({x:.6}, {y:.6}, {z:.6})"),
            None => Ok(()),
        }
    }
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {} ({})", self.count, self.kind.name(), self.kind.meaning())?;
        for (i, example) in self.examples.iter().enumerate() {
            write!(f, "{} {example}", if i == 0 { ":" } else { ";" })?;
        }
        if self.count > self.examples.len() { f.write_str("; ...") } else { Ok(()) }
    }
}
