//! Checks of a mesh: every defect by name, with ids and coordinates.
//!
//! | checked | defects |
//! |---|---|
//! | points | not finite, used by no cell, two at one place |
//! | cells | of unknown kind, a vertex named twice, inverted, flat, quadratic and folded inside, without area, duplicated |
//! | facets | of more than two cells, two tets on one side, unmerged, with hanging vertices |
//! | surface | open, misoriented and non-manifold edges, pinched vertices |
//! | the mesh | separate parts |
//!
//! The surface is the boundary of the volume cells; in a mesh without volume cells it consists of the surface
//! cells. No check has a tolerance, except the search for hanging vertices.

mod cells;
mod conformity;
mod defect;
mod edges;
mod hanging;
mod parts;
mod points;

use crate::base::{CellId, Csr, Threads, VertexId};
use crate::mesh::boundary::corners;
use crate::mesh::{Boundary, CellKind, Mesh, OrientedTets};

pub use defect::{Defect, DefectKind, Example};
pub use edges::is_closed;
pub use hanging::{HangingVertex, hanging_vertices};

/// Every defect of a mesh, each kind once, with its count and a few examples.
///
/// Ids must have been checked by [`Mesh::validate`]. A million tets take about a second.
pub fn check(mesh: &Mesh) -> Vec<Defect> {
    check_with(mesh, &Boundary::of(&mesh.cells), &OrientedTets::of(mesh, &Threads::single()))
}

/// Every defect of a mesh, as found by [`check`], for a caller that already has the boundary and the oriented
/// tets.
pub fn check_with(mesh: &Mesh, boundary: &Boundary, tets: &OrientedTets) -> Vec<Defect> {
    let coincident = points::CoincidentVertices::of(mesh);
    let mut defects = points::defects(mesh, &coincident);
    defects.extend(cells::defects(mesh, boundary, &tets.are_reversed(mesh.cells.len())));
    defects.extend(conformity::defects(mesh, boundary, &coincident));
    defects.extend(edges::defects(mesh, &SurfaceFacets::of(mesh, boundary)));
    defects.extend(parts::defects(mesh));
    defects.retain(|defect| defect.count > 0);
    defects
}

/// Whether the cells fit together facet to facet, by the defects that [`check`] found.
pub fn is_conforming(defects: &[Defect]) -> bool {
    let breaks = |kind| {
        matches!(
            kind,
            DefectKind::OversharedFacet
                | DefectKind::FoldedFacet
                | DefectKind::UnmergedFacet
                | DefectKind::HangingVertex
                | DefectKind::DuplicateCell
        )
    };
    !defects.iter().any(|defect| breaks(defect.kind))
}

/// The facets that bound the mesh, by their corners.
pub(crate) struct SurfaceFacets {
    /// The corners of each facet as a ring.
    pub(crate) rings: Csr<VertexId>,
    /// The cell of each facet.
    pub(crate) cells: Vec<CellId>,
    /// Whether they come from volume cells, whose numbering orients them.
    pub(crate) of_volume: bool,
}

impl SurfaceFacets {
    /// The boundary of the volume cells; where there are none, the surface cells.
    fn of(mesh: &Mesh, boundary: &Boundary) -> Self {
        if mesh.cells.dim() == Some(3) {
            let facets = boundary.facets.iter().zip(&boundary.kinds).zip(&boundary.cells);
            let facets = Self::from_cells(facets.map(|((ring, &kind), &cell)| (cell, kind, ring)));
            return Self { of_volume: true, ..facets };
        }
        Self::from_cells(mesh.cells.iter())
    }

    /// The surface cells among `cells`, with strips divided into triangles.
    pub(crate) fn from_cells<'a>(cells: impl Iterator<Item = (CellId, CellKind, &'a [VertexId])>) -> Self {
        let mut facets = Self { rings: Csr::default(), cells: Vec::new(), of_volume: false };
        for (cell, kind, vertices) in cells.filter(|(_, kind, _)| kind.dim() == Some(2)) {
            let mut ring = corners(kind, vertices).to_vec();
            match kind {
                CellKind::PIXEL => ring.swap(2, 3),
                CellKind::TRIANGLE_STRIP => {
                    for (i, w) in vertices.windows(3).enumerate() {
                        facets.rings.push(if i % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] });
                        facets.cells.push(cell);
                    }
                    continue;
                }
                _ => {}
            }
            facets.rings.push(ring);
            facets.cells.push(cell);
        }
        facets
    }
}
