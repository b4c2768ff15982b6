//! Faults of surfaces that are to be meshed: a name, whether it prevents meshing, and where.

use std::fmt;

use serde::Serialize;

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, in_range, scale};

macro_rules! fault_kinds {
    ($($variant:ident = $name:literal, $meaning:literal, $remedy:literal;)*) => {
        /// A kind of fault. Kinds that are also among [`DefectKind`](crate::mesh::check::DefectKind) have the
        /// same names there.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
        #[non_exhaustive]
        pub enum FaultKind {
            $(#[doc = $meaning] #[serde(rename = $name)] $variant,)*
        }

        impl FaultKind {
            /// All kinds, in the order of their codes.
            pub const ALL: &'static [Self] = &[$(Self::$variant,)*];

            /// The name that scripts see.
            pub fn name(self) -> &'static str {
                match self { $(Self::$variant => $name,)* }
            }

            /// The meaning in words.
            pub fn meaning(self) -> &'static str {
                match self { $(Self::$variant => $meaning,)* }
            }

            /// What can be done about it.
            pub fn remedy(self) -> &'static str {
                match self { $(Self::$variant => $remedy,)* }
            }
        }
    };
}

fault_kinds! {
    EmptySurface = "empty_surface", "the surface has no triangles",
        "give it some, or leave it out";
    NonFinitePoint = "non_finite_point", "a coordinate is infinite, beyond 1e60 or not a number",
        "give the point finite coordinates, or remove it with its triangles";
    RepeatedVertex = "repeated_vertex", "the triangle names a vertex twice",
        "request that triangles without area be removed";
    ZeroArea = "zero_area", "the corners of the triangle lie on a line",
        "request that triangles without area be removed";
    Duplicate = "duplicate_triangle", "triangles of one surface with the same vertices",
        "request that duplicates be removed";
    Crossing = "crossing", "triangles meet in more than the vertices and edges that they share",
        "`--repair` divides edges at vertices on them and faces that overlap, \
         `--cut` also triangles that cross, `--unite` makes one of bodies that cross, \
         `--wrap` a new surface around all; or move the surfaces apart";
    OpenEdge = "open_edge", "the surface ends at the edge",
        "`motet cap SURFACE -o CLOSED` closes open ends, \
         `--repair` small holes (`--hole-edges`), `--wrap` makes a new surface without holes; \
         give a surface that may be open as a `--membrane`";
    NonManifoldEdge = "non_manifold_edge", "more than two triangles of one surface meet at the edge",
        "remove the triangles that do not belong there, or give inner walls as a surface of their own";
    NonManifoldVertex = "non_manifold_vertex", "the surface touches itself at the vertex",
        "give each sheet a vertex of its own if they should not be connected";
    MisorientedEdge = "misoriented_edge", "the two triangles at the edge face opposite sides",
        "request that triangles be oriented";
    InwardPart = "inward_part", "a closed part of the surface faces inward",
        "request that triangles be oriented";
    SharedFacet = "shared_facet", "surfaces have a triangle in common",
        "nothing needs to be done: it is meshed as one facet";
}

impl FaultKind {
    /// The number that stands for it in arrays: its index in [`Self::ALL`].
    pub fn code(self) -> i32 {
        self as i32
    }
}

/// One place where surfaces are not what meshing expects.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Fault {
    /// The kind of fault.
    #[serde(rename = "name")]
    pub kind: FaultKind,
    /// Whether surfaces with this fault cannot be meshed.
    pub is_fatal: bool,
    /// The surface, or that of the first triangle.
    pub surface: u32,
    /// The triangles concerned, in rising order; for a part that faces inward, its first one.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub triangles: Vec<u32>,
    /// The vertices concerned: the ends of an edge, the corners of a triangle, those that a crossing pair
    /// shares.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<VertexId>,
    /// A place on it; `None` if that is not finite.
    pub at: Option<Point>,
}

impl Fault {
    /// A fault located at the mean of its vertices.
    pub(super) fn new(
        kind: FaultKind,
        is_fatal: bool,
        surface: u32,
        triangles: Vec<u32>,
        vertices: &[VertexId],
        points: &[Point],
    ) -> Self {
        let at = mean(vertices, points);
        Self { kind, is_fatal, surface, triangles, vertices: vertices.to_vec(), at }
    }
}

/// The mean of some vertices; `None` if there are none, or it is not finite.
pub(super) fn mean(vertices: &[VertexId], points: &[Point]) -> Option<Point> {
    let part = 1.0 / vertices.len() as f64;
    let sum = vertices.iter().fold([0.0; 3], |sum, v| add(sum, scale(points[v.index()], part)));
    (in_range(sum) && !vertices.is_empty()).then_some(sum)
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "surface {}", self.surface)?;
        list(f, ["triangle", "triangles"], &self.triangles)?;
        list(f, ["vertex", "vertices"], &self.vertices)?;
        match self.at {
            Some([x, y, z]) => write!(f, " at ({x:.6}, {y:.6}, {z:.6})"),
            None => Ok(()),
        }
    }
}

/// Writes the first few ids.
fn list(f: &mut fmt::Formatter<'_>, [one, many]: [&str; 2], ids: &[impl fmt::Display]) -> fmt::Result {
    for (i, id) in ids.iter().take(4).enumerate() {
        match i {
            0 => write!(f, ", {} {id}", if ids.len() > 1 { many } else { one })?,
            _ => write!(f, ", {id}")?,
        }
    }
    if ids.len() > 4 { f.write_str(", ...") } else { Ok(()) }
}
