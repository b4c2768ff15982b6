//! Recovers cells from their faces.

use crate::base::{Csr, Error, Result, VertexId};
use crate::mesh::facets::facet_shapes;
use crate::mesh::{CellKind, Cells};

/// Cell kinds identified by their faces: numbers of triangles and of quads.
const KINDS: [(CellKind, usize, usize); 4] = [
    (CellKind::TETRA, 4, 0),
    (CellKind::PYRAMID, 4, 1),
    (CellKind::WEDGE, 2, 3),
    (CellKind::HEXAHEDRON, 0, 6),
];

/// Appends the cell with these faces, each a ring that runs counter-clockwise seen from outside. Faces that
/// fit no fixed kind make a polyhedron.
pub(super) fn push(cells: &mut Cells, faces: &[Vec<VertexId>]) {
    let count = |n: usize| faces.iter().filter(|face| face.len() == n).count();
    let kind = KINDS.iter().find(|&&(_, triangles, quads)| {
        count(3) == triangles && count(4) == quads && faces.len() == triangles + quads
    });
    match kind.and_then(|&(kind, ..)| Some((kind, corners(kind, faces)?))) {
        Some((kind, vertices)) => cells.push(kind, vertices),
        None => {
            let mut vertices: Vec<VertexId> = faces.iter().flatten().copied().collect();
            vertices.sort_unstable();
            vertices.dedup();
            let mut rings = Csr::default();
            faces.iter().for_each(|face| rings.push(face.iter().copied()));
            cells.push_polyhedron(vertices, rings);
        }
    }
}

/// The vertices of a cell of the given kind, in VTK's order; `None` if the faces do not form one.
///
/// One face is matched with the first face of the kind of that size; each other vertex is found along an edge
/// from it.
fn corners(kind: CellKind, faces: &[Vec<VertexId>]) -> Option<Vec<VertexId>> {
    let shapes = facet_shapes(kind)?;
    let n = kind.n_vertices()?;
    // The quad of a pyramid, or a triangle of a wedge.
    let size = if kind == CellKind::PYRAMID {
        4
    } else if kind == CellKind::WEDGE {
        3
    } else {
        faces[0].len()
    };
    let base = faces.iter().find(|face| face.len() == size)?;
    let shape = shapes.iter().find(|shape| shape.n_corners == size)?.corners();
    let mut vertices: Vec<Option<VertexId>> = vec![None; n];
    for (&place, &v) in shape.iter().zip(base) {
        vertices[place as usize] = Some(v);
    }
    for (&place, &v) in shape.iter().zip(base) {
        let rings = shapes.iter().map(|shape| shape.corners());
        let beyond = successors(rings, place).find(|p| !shape.contains(p))?;
        let found = successors(faces.iter().map(Vec::as_slice), v).find(|v| !base.contains(v))?;
        let known = &mut vertices[beyond as usize];
        if known.is_some_and(|known| known != found) {
            return None;
        }
        *known = Some(found);
    }
    let vertices: Vec<VertexId> = vertices.into_iter().collect::<Option<_>>()?;
    let is_there = |corners: &[u8]| {
        let ring: Vec<VertexId> = corners.iter().map(|&place| vertices[place as usize]).collect();
        faces.iter().any(|face| is_same_ring(face, &ring))
    };
    shapes.iter().all(|shape| is_there(shape.corners())).then_some(vertices)
}

/// The successors of `of` in the rings that contain it.
fn successors<'a, T: Copy + PartialEq + 'a>(
    rings: impl Iterator<Item = &'a [T]>,
    of: T,
) -> impl Iterator<Item = T> {
    rings.filter_map(move |ring| {
        let place = ring.iter().position(|&x| x == of)?;
        Some(ring[(place + 1) % ring.len()])
    })
}

/// Whether two rings pass through the same vertices in the same direction, whatever their starting points.
fn is_same_ring(a: &[VertexId], b: &[VertexId]) -> bool {
    let start = b.iter().position(|v| a.first() == Some(v));
    a.len() == b.len() && start.is_some_and(|start| a.iter().eq(b[start..].iter().chain(&b[..start])))
}

/// Appends a face as a surface cell.
pub(super) fn push_face(cells: &mut Cells, face: &[u32]) {
    let kind = match face.len() {
        3 => CellKind::TRIANGLE,
        4 => CellKind::QUAD,
        _ => CellKind::POLYGON,
    };
    cells.push(kind, face.iter().map(|&v| VertexId(v)));
}

/// The faces of each cell, and whether the cell owns them.
pub(super) struct Sides<'a> {
    faces: &'a Csr<u32>,
    of_cells: Vec<Vec<(u32, bool)>>,
}

impl<'a> Sides<'a> {
    /// Of faces, each a ring that runs counter-clockwise seen from outside its owner; the first ones have
    /// neighbours, too, unless these are negative.
    pub(super) fn new(
        faces: &'a Csr<u32>,
        owner: &[i64],
        neighbour: &[i64],
        n_points: usize,
    ) -> Result<Self> {
        if owner.len() != faces.len() || neighbour.len() > faces.len() {
            return Err(Error::input(format!(
                "{} faces have {} owners and {} neighbours",
                faces.len(),
                owner.len(),
                neighbour.len()
            )));
        }
        if let Some(i) =
            faces.iter().position(|face| face.len() < 3 || face.iter().any(|&v| v as usize >= n_points))
        {
            return Err(Error::input("has fewer than three points, or a point that does not exist")
                .at(format!("face {i}")));
        }
        // A cell has at least four faces, so valid cell numbers are below the number of faces.
        let sides = owner.iter().enumerate().map(|(face, &cell)| (face, cell, true));
        let sides = sides.chain(neighbour.iter().enumerate().map(|(face, &cell)| (face, cell, false)));
        let most = faces.len();
        let mut of_cells: Vec<Vec<(u32, bool)>> = Vec::new();
        // In some versions of OpenFOAM every face has a neighbour, which is -1 at the boundary.
        for (face, cell, is_owner) in sides.filter(|&(_, cell, is_owner)| is_owner || cell >= 0) {
            let cell = usize::try_from(cell).ok().filter(|&cell| cell < most).ok_or_else(|| {
                Error::input(format!(
                    "refers to cell {cell}, but cell numbers must be below the number of faces, {most}"
                ))
                .at(format!("face {face}"))
            })?;
            if of_cells.len() <= cell {
                of_cells.resize_with(cell + 1, Vec::new);
            }
            of_cells[cell].push((face as u32, is_owner));
        }
        match of_cells.iter().position(|sides| sides.len() < 4) {
            Some(cell) => Err(Error::input("has fewer than four faces").at(format!("cell {cell}"))),
            None => Ok(Self { faces, of_cells }),
        }
    }

    /// The cells, in the order of their numbers.
    pub(super) fn cells(&self) -> Cells {
        let mut cells = Cells::new();
        for sides in &self.of_cells {
            let rings = sides.iter().map(|&(face, is_owner)| {
                let ring = self.faces.list(face as usize).iter().map(|&v| VertexId(v));
                if is_owner { ring.collect::<Vec<_>>() } else { ring.rev().collect() }
            });
            push(&mut cells, &rings.collect::<Vec<_>>());
        }
        cells
    }
}
