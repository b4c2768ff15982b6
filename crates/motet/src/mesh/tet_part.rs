//! The tets of a mesh that holds more: taken out to be worked on, and where each was.

use crate::base::{CellId, Error, Result, VertexId};
use crate::geometry::tet::FACETS;
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
        part.hold_loose_triangles();
        Ok(part)
    }

    /// An error whose place is a tet or a triangle, with the cell that it is in its place.
    pub fn at_cell(&self, error: Error) -> Error {
        let cell = error.place().and_then(|place| {
            let (what, id) = place.split_once(' ')?;
            let to_cell = match what {
                "tet" => &self.tet_to_cell,
                "triangle" => &self.triangle_to_cell,
                _ => return None,
            };
            to_cell.get(id.parse::<usize>().ok()?)
        });
        let Some(cell) = cell else { return error };
        let told = Error::new(error.kind(), error.what()).at(format!("cell {cell}"));
        match error.remedy_text() {
            Some(remedy) => told.remedy(remedy),
            None => told,
        }
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

    /// Triangles that are no facet of a tet, and all but the first of those that are the same, stay as well.
    fn hold_loose_triangles(&mut self) {
        let fixed = &self.mesh;
        let sorted = |mut triangle: [VertexId; 3]| {
            triangle.sort_unstable();
            triangle
        };
        let mut open: Vec<_> = fixed.triangles.iter().map(|&t| sorted(t)).zip(0usize..).collect();
        open.sort_unstable();
        let mut is_loose = vec![true; open.len()];
        let mut has_triangle = vec![false; fixed.points.len()];
        fixed.triangles.iter().flatten().for_each(|v| has_triangle[v.index()] = true);
        for tet in &fixed.tets {
            // Few tets have three vertices on the surface.
            if tet.iter().filter(|v| has_triangle[v.index()]).count() < 3 {
                continue;
            }
            for facet in FACETS.map(|facet| sorted(facet.map(|i| tet[i]))) {
                let first = open.partition_point(|(triangle, _)| *triangle < facet);
                if let Some((_, i)) = open.get(first).filter(|(triangle, _)| *triangle == facet) {
                    is_loose[*i] = false;
                }
            }
        }
        for i in (0..is_loose.len()).filter(|&i| is_loose[i]) {
            self.hold(&self.mesh.triangles[i].clone());
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
