//! The linear tets, triangles and lines of a mesh with any cells, extracted to be worked on, and the cell
//! that each was.

use std::collections::BTreeMap;

use crate::base::{CellId, Error, Result, VertexId};
use crate::geometry::tet::FACETS;
use crate::mesh::history::numbers_cells;
use crate::mesh::{CellKind, Mesh, TetMesh, Values};

/// The linear tets, triangles and lines of a mesh, as plain arrays. Cells of other kinds are left out; their
/// vertices and edges become fixed.
#[derive(Clone, Debug, Default)]
pub struct TetPart {
    /// The tets with their regions, the triangles with their patches, the lines with their labels.
    pub mesh: TetMesh,
    /// The cell of each tet.
    pub tet_to_cell: Vec<CellId>,
    /// The cell of each triangle.
    pub triangle_to_cell: Vec<CellId>,
    /// The cell of each line.
    pub line_to_cell: Vec<CellId>,
}

impl TetPart {
    /// Extracts the tets, triangles and lines of `mesh`; all points stay, so vertex ids are unchanged.
    ///
    /// # Errors
    /// If there is no linear tet; the remedy depends on the cells that there are.
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
                (CellKind::LINE, &[a, b]) if a != b => {
                    part.mesh.lines.push([a, b]);
                    part.line_to_cell.push(cell);
                }
                _ => part.fix(vertices),
            }
        }
        part.mesh.line_labels = line_labels(mesh, &part.line_to_cell);
        if part.mesh.tets.is_empty() {
            return Err(no_tets(mesh));
        }
        part.fix_polyhedra(mesh);
        part.fix_loose_triangles();
        Ok(part)
    }

    /// Fixes the lines like cells of other kinds and removes them from the part, for operations that do not
    /// divide lines.
    #[must_use]
    pub fn with_lines_held(mut self) -> Self {
        let lines = std::mem::take(&mut self.mesh.lines);
        lines.iter().for_each(|line| self.fix(line));
        self.mesh.line_labels.clear();
        self.line_to_cell.clear();
        self
    }

    /// The error with its place, a tet, triangle or line of this part, replaced by the cell that it is.
    /// Errors at other places are returned unchanged.
    pub fn at_cell(&self, error: Error) -> Error {
        let cell = error.place().and_then(|place| {
            let (what, id) = place.split_once(' ')?;
            let to_cell = match what {
                "tet" => &self.tet_to_cell,
                "triangle" => &self.triangle_to_cell,
                "line" => &self.line_to_cell,
                _ => return None,
            };
            to_cell.get(id.parse::<usize>().ok()?)
        });
        let Some(cell) = cell else { return error };
        let located = Error::new(error.kind(), error.what()).at(format!("cell {cell}"));
        match error.remedy_text() {
            Some(remedy) => located.remedy(remedy),
            None => located,
        }
    }

    /// Fixes the vertices of a cell of another kind, and every edge between two of them.
    fn fix(&mut self, vertices: &[VertexId]) {
        let fixed = &mut self.mesh;
        fixed.fixed_vertices.extend_from_slice(vertices);
        for (i, &a) in vertices.iter().enumerate() {
            let others = vertices[..i].iter().filter(|&&b| b != a);
            fixed.fixed_edges.extend(others.map(|&b| [a, b]));
        }
    }

    /// Fixes the faces of polyhedra, which may name vertices that the polyhedra do not.
    fn fix_polyhedra(&mut self, mesh: &Mesh) {
        for face in mesh.cells.polyhedron_faces().iter().flat_map(|faces| faces.iter()) {
            self.fix(face);
        }
    }

    /// Fixes the triangles that are not a facet of any tet, and all but the first of several with the same
    /// vertices.
    fn fix_loose_triangles(&mut self) {
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
            self.fix(&self.mesh.triangles[i].clone());
        }
    }
}

/// A label for each line: two lines have the same label if they agree in all integer and text cell arrays,
/// except those that number cells.
fn line_labels(mesh: &Mesh, lines: &[CellId]) -> Vec<i32> {
    let mut keys: Vec<Vec<String>> = vec![Vec::new(); lines.len()];
    for field in mesh.cell_data.iter().filter(|field| !lines.is_empty() && !numbers_cells(&field.name)) {
        let of_lines = field.pick(lines.iter().map(|cell| cell.index())).values;
        let words: Vec<String> = match of_lines {
            Values::Text(words) => words,
            values if values.is_integer() => {
                (values.to_i64().unwrap_or_default().iter()).map(i64::to_string).collect()
            }
            _ => continue,
        };
        let rows = words.chunks(field.components.max(1));
        keys.iter_mut().zip(rows).for_each(|(key, row)| key.extend_from_slice(row));
    }
    let mut known: BTreeMap<Vec<String>, i32> = BTreeMap::new();
    let mut labels = Vec::with_capacity(lines.len());
    for key in keys {
        let next = known.len() as i32;
        labels.push(*known.entry(key).or_insert(next));
    }
    labels
}

fn no_tets(mesh: &Mesh) -> Error {
    let kinds: Vec<_> = mesh.cells.counts().iter().map(|(kind, n)| format!("{n} {}", kind.label())).collect();
    let found = if kinds.is_empty() { "no cells".to_owned() } else { kinds.join(", ") };
    let error = Error::input(format!("has no linear tetrahedra, which remeshing requires; it has {found}"));
    match mesh.cells.dim() {
        Some(3) => error.remedy("divide the cells into linear tetrahedra first"),
        _ => error.remedy("give a volume mesh"),
    }
}
