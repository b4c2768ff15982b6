//! The tets of a mesh that holds more: taken out to be worked on, and where each was.

use crate::base::{CellId, Error, Result, VertexId};
use crate::mesh::{CellKind, Mesh, TetMesh};

/// The linear tets and triangles of a mesh, as plain arrays. Cells of other kinds stay behind, and hold their vertices and edges where they are.
#[derive(Clone, Debug, Default)]
pub struct TetPart {
    /// The tets with their regions, the triangles with their patches.
    pub mesh: TetMesh,
    /// The cell that each tet is.
    pub tet_to_cell: Vec<CellId>,
    /// The cell that each triangle is.
    pub triangle_to_cell: Vec<CellId>,
}

impl TetPart {
    /// The tets of `mesh`, with every point of it.
    ///
    /// # Errors
    /// When there is no linear tet; the remedy depends on what there is.
    pub fn of(mesh: &Mesh) -> Result<Self> {
        let [regions, patches] = [mesh.regions(), mesh.patches()];
        let label = |labels: &Option<crate::mesh::Labels>, cell: CellId| {
            labels.as_ref().map_or(0, |labels| labels.ids[cell.index()])
        };
        let mut part = Self::default();
        part.mesh.points.clone_from(&mesh.points);
        for (cell, kind, vertices) in mesh.cells.iter() {
            match (kind, vertices) {
                (CellKind::TETRA, &[a, b, c, d]) => {
                    part.mesh.tets.push([a, b, c, d]);
                    part.mesh.regions.push(label(&regions, cell));
                    part.tet_to_cell.push(cell);
                }
                (CellKind::TRIANGLE, &[a, b, c]) => {
                    part.mesh.triangles.push([a, b, c]);
                    part.mesh.patches.push(label(&patches, cell));
                    part.triangle_to_cell.push(cell);
                }
                _ => part.hold(vertices),
            }
        }
        if part.mesh.tets.is_empty() {
            return Err(no_tets(mesh));
        }
        part.hold_polyhedra(mesh);
        Ok(part)
    }

    /// Vertices of a cell of another kind stay, and every edge that might be one of its edges.
    fn hold(&mut self, vertices: &[VertexId]) {
        let fixed = &mut self.mesh;
        fixed.fixed_vertices.extend_from_slice(vertices);
        for (i, &a) in vertices.iter().enumerate() {
            let others = vertices[..i].iter().filter(|&&b| b != a);
            fixed.fixed_edges.extend(others.map(|&b| [a, b]));
        }
    }

    /// Faces of polyhedra may name vertices that the polyhedra do not.
    fn hold_polyhedra(&mut self, mesh: &Mesh) {
        for face in mesh.cells.polyhedron_faces().iter().flat_map(|faces| faces.iter()) {
            self.hold(face);
        }
    }
}

fn no_tets(mesh: &Mesh) -> Error {
    let kinds: Vec<_> = mesh.cells.counts().iter().map(|(kind, n)| format!("{n} {}", kind.label())).collect();
    let error =
        Error::input(format!("has no linear tetrahedra, which remeshing works on, but {}", kinds.join(", ")));
    match mesh.cells.dim() {
        Some(3) => error.remedy("divide the cells into linear tetrahedra first"),
        _ => error.remedy("give a volume mesh"),
    }
}
