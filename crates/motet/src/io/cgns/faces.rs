//! A mesh with polyhedra as faces and cells of faces: each face once, surface cells first.

use std::collections::HashMap;

use crate::base::{Csr, Error, Result, rising_list};
use crate::io::cgns::parts::Part;
use crate::io::facet_key::have_same_orientation;
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::{CellKind, Mesh, corners};

/// Kinds of cells without a fixed element type, which require the mesh to be written face by face.
pub(super) fn needs_faces(kind: CellKind) -> bool {
    matches!(
        kind,
        CellKind::POLYGON | CellKind::POLYHEDRON | CellKind::PENTAGONAL_PRISM | CellKind::HEXAGONAL_PRISM
    )
}

/// Kinds of cells that a mesh of faces can hold: those with straight edges.
pub(super) fn holds(kind: CellKind) -> bool {
    needs_faces(kind)
        || matches!(
            kind,
            CellKind::VERTEX
                | CellKind::LINE
                | CellKind::TRIANGLE
                | CellKind::QUAD
                | CellKind::TETRA
                | CellKind::PYRAMID
                | CellKind::WEDGE
                | CellKind::HEXAHEDRON
        )
}

/// The faces of a mesh, and the faces of each of its cells.
pub(super) struct Faces {
    /// The ring of each face: surface cells in the order of the parts, then all others.
    pub(super) rings: Csr<u32>,
    /// For each volume cell the numbers of its faces, from 1, negative where the face is oriented inward.
    pub(super) of_cells: Vec<Vec<i64>>,
}

impl Faces {
    pub(super) fn of(mesh: &Mesh, parts: &[Part]) -> Result<Self> {
        let mut rings = Csr::default();
        let mut places: HashMap<Vec<u32>, usize> = HashMap::new();
        for &cell in parts.iter().filter(|part| part.dim == 2).flat_map(|part| &part.cells) {
            let ring = corners(mesh.cells.kinds()[cell], mesh.cells.connectivity().list(cell));
            let ring: Vec<u32> = ring.iter().map(|v| v.0).collect();
            places.entry(key(&ring)).or_insert(rings.len());
            rings.push(ring);
        }
        let facets = Facets::of(&mesh.cells);
        let mut of_cells = vec![Vec::new(); mesh.cells.len()];
        let mut too_many = None;
        facets.for_each_shared(|uses| {
            if uses.len() > 2 {
                too_many = too_many.or(uses.first().copied());
            }
            let ring_of = |facet: &FacetUse| facets.corners(*facet).map(|v| v.0).collect::<Vec<u32>>();
            let first = ring_of(&uses[0]);
            let place = places.get(&key(&first)).copied().unwrap_or_else(|| {
                rings.push(first.iter().copied());
                rings.len() - 1
            });
            for facet in uses {
                let number = place as i64 + 1;
                let outward = have_same_orientation(rings.list(place), &ring_of(facet));
                of_cells[facet.cell.index()].push(if outward { number } else { -number });
            }
        });
        if let Some(facet) = too_many {
            return Err(Error::input("more than two cells share a face").at(format!("cell {}", facet.cell)));
        }
        let is_flat = |(cell, kind): (usize, &CellKind)| kind.dim() == Some(3) && of_cells[cell].len() < 4;
        match mesh.cells.kinds().iter().enumerate().position(is_flat) {
            Some(cell) => {
                Err(Error::input("a volume cell has fewer than four faces").at(format!("cell {cell}")))
            }
            None => Ok(Self { rings, of_cells }),
        }
    }
}

/// The distinct corners of a ring, ascending; a collapsed quad has the key of the triangle that it meets.
fn key(ring: &[u32]) -> Vec<u32> {
    let mut key = rising_list(ring);
    key.dedup();
    key
}
