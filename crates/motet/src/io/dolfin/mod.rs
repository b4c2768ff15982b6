//! DOLFIN XML (FEniCS), also compressed with gzip. Read only.
//!
//! DOLFIN sorts the vertices of a cell by their numbers, so about half of the tetrahedra in such a file have
//! negative volume, which carries no meaning: they are made positive by exchanging the last two
//! vertices.
//!
//! Marks of cells become the array `region`. Marks of facets, given as (cell, local index in the cell),
//! become triangles with the array `patch`, one for each marked facet, appended after the cells; the local
//! index of a facet is that of the vertex opposite to it among the *sorted* vertices. The triangles face
//! outward from the first cell that refers to them. Label 0 means no label here, so if a file uses the mark
//! 0, all labels are one higher, and the marks of the file become their names.
//!
//! Marks of edges and vertices, and marks by DOLFIN's own facet numbers, are skipped with a note. No crate
//! reads this format.

mod xml;

use std::collections::HashSet;

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector;
use crate::io::format::{Format, Input, Notes};
use crate::io::gzip;
use crate::mesh::{CellKind, Cells, Field, Mesh};
use xml::{Collection, Document};

pub(super) const FORMAT: Format =
    Format { name: "DOLFIN XML", extensions: &[".xml", ".xml.gz"], read: Some(read), write: None };

fn read(input: &Input<'_>) -> Result<Mesh> {
    let decompressed = gzip::is_gzip(input.bytes).then(|| gzip::decompress(input.bytes)).transpose()?;
    let document = xml::parse(decompressed.as_deref().unwrap_or(input.bytes), input.notes)?;
    build(document, input.notes)
}

fn build(document: Document, notes: &Notes) -> Result<Mesh> {
    let (kind, order) = kind_of(&document.cell_type);
    let n_cells = document.vertices.len() / document.n_vertices;
    let mut cells = Cells::new();
    for source_vertices in document.vertices.chunks_exact(document.n_vertices) {
        let mut vtk_vertices = [VertexId::default(); 8];
        order.iter().zip(&mut vtk_vertices).for_each(|(&k, v)| *v = VertexId(source_vertices[k]));
        if kind == CellKind::TETRA && is_negative(&document.points, source_vertices) {
            vtk_vertices.swap(2, 3);
        }
        cells.push(kind, vtk_vertices[..source_vertices.len()].iter().copied());
    }
    let mut regions = vec![0; n_cells];
    let mut patches = Patches::default();
    let mut mesh = Mesh::new(Vec::new(), Cells::new());
    for mut collection in document.collections.iter().map(Collection::copy) {
        let cell_dim = kind.dim().unwrap_or(0);
        match (collection.dim, collection.by_cell) {
            (dim, _) if dim == cell_dim => {
                mesh.label_names.regions = collection.free_zero(cell_dim == 3);
                collection.put_regions(&mut regions)?;
                mesh.set_cell_field(Field::scalars("region", Vec::<i32>::new()));
            }
            (2, true) if kind == CellKind::TETRA => {
                mesh.label_names.patches.extend(collection.free_zero(true));
                patches.take(&collection, &document)?;
            }
            (0, false) => collection.put_points(&mut mesh, document.points.len())?,
            (dim, by_cell) => notes.add(format!(
                "marks on entities of dimension {dim}, given {}, are skipped",
                if by_cell { "by cell" } else { "by DOLFIN's own numbering" }
            )),
        }
    }
    let has_regions = !mesh.cell_data.is_empty();
    mesh.cell_data.clear();
    for (triangle, _) in &patches.triangles {
        cells.push(CellKind::TRIANGLE, triangle.map(VertexId));
    }
    if has_regions {
        regions.resize(cells.len(), 0);
        mesh.set_cell_field(Field::scalars("region", regions));
    }
    if !patches.triangles.is_empty() {
        let labels = patches.triangles.iter().map(|&(_, label)| label);
        mesh.set_cell_field(Field::scalars(
            "patch",
            vec![0; n_cells].into_iter().chain(labels).collect::<Vec<_>>(),
        ));
    }
    mesh.points = document.points;
    mesh.cells = cells;
    Ok(mesh)
}

/// The kind of a cell type, and for each vertex in VTK's order its position in DOLFIN's order, which follows
/// the axes of quadrilaterals and hexahedra.
fn kind_of(cell_type: &str) -> (CellKind, &'static [usize]) {
    match cell_type {
        "point" => (CellKind::VERTEX, &[0]),
        "interval" => (CellKind::LINE, &[0, 1]),
        "triangle" => (CellKind::TRIANGLE, &[0, 1, 2]),
        "quadrilateral" => (CellKind::QUAD, &[0, 1, 3, 2]),
        "hexahedron" => (CellKind::HEXAHEDRON, &[0, 1, 3, 2, 4, 5, 7, 6]),
        _ => (CellKind::TETRA, &[0, 1, 2, 3]),
    }
}

fn is_negative(points: &[Point], tet: &[u32]) -> bool {
    let [a, b, c, d] = [0, 1, 2, 3].map(|k| points[tet[k] as usize]);
    let [ab, ac, ad] = [b, c, d].map(|p| vector::sub(p, a));
    vector::dot(vector::cross(ab, ac), ad) < 0.0
}

/// Marked facets, each once.
#[derive(Default)]
struct Patches {
    triangles: Vec<([u32; 3], i32)>,
    seen: HashSet<[u32; 3]>,
}

impl Patches {
    fn take(&mut self, collection: &Collection, document: &Document) -> Result<()> {
        for &[cell, place, label] in &collection.marks {
            let begin = usize::try_from(cell).ok().and_then(|cell| cell.checked_mul(4));
            let tet = begin.and_then(|begin| document.vertices.get(begin..)?.first_chunk::<4>());
            let (Some(mut tet), 0..4) = (tet.copied(), place) else {
                return Err(collection.no_such_entity(format!("facet {place} of cell {cell}")));
            };
            tet.sort_unstable();
            let triangle = facet_outward(&document.points, tet, place as usize);
            let mut key = triangle;
            key.sort_unstable();
            if self.seen.insert(key) {
                self.triangles.push((triangle, collection.label(label)?));
            }
        }
        Ok(())
    }
}

/// The facet opposite vertex `place`, its normal pointing away from that vertex.
fn facet_outward(points: &[Point], tet: [u32; 4], place: usize) -> [u32; 3] {
    let outward = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]][place];
    let [a, b, c] = outward.map(|k: usize| tet[k]);
    if is_negative(points, &tet) { [a, c, b] } else { [a, b, c] }
}

impl Collection {
    fn copy(&self) -> Self {
        Self { dim: self.dim, name: self.name.clone(), by_cell: self.by_cell, marks: self.marks.clone() }
    }

    /// If the marks use 0 to distinguish entities, raises all marks by one and returns names with the numbers
    /// of the file.
    fn free_zero(&mut self, even_alone: bool) -> std::collections::BTreeMap<i32, String> {
        let marks: std::collections::BTreeSet<i64> = self.marks.iter().map(|m| m[2]).collect();
        if !marks.contains(&0) || !(even_alone && self.dim == 2 || marks.len() > 1) {
            return Default::default();
        }
        self.marks.iter_mut().for_each(|m| m[2] = m[2].saturating_add(1));
        let named = |&mark: &i64| Some((i32::try_from(mark.checked_add(1)?).ok()?, mark.to_string()));
        marks.iter().filter_map(named).collect()
    }

    fn label(&self, mark: i64) -> Result<i32> {
        i32::try_from(mark).map_err(|_| Error::input(format!("mark {mark} does not fit in 32 bits")))
    }

    fn no_such_entity(&self, what: String) -> Error {
        Error::input(format!("a mark refers to {what}, which does not exist"))
            .at(format!("marks of dimension {}", self.dim))
            .remedy("the file is damaged: write it again")
    }

    fn put_regions(&self, regions: &mut [i32]) -> Result<()> {
        for &[cell, _, label] in &self.marks {
            let region = usize::try_from(cell).ok().and_then(|cell| regions.get_mut(cell));
            *region.ok_or_else(|| self.no_such_entity(format!("cell {cell}")))? = self.label(label)?;
        }
        Ok(())
    }

    fn put_points(&self, mesh: &mut Mesh, n_points: usize) -> Result<()> {
        let mut values = vec![0; n_points];
        for &[vertex, _, mark] in &self.marks {
            let value = usize::try_from(vertex).ok().and_then(|vertex| values.get_mut(vertex));
            *value.ok_or_else(|| self.no_such_entity(format!("vertex {vertex}")))? = mark;
        }
        let name = if self.name.is_empty() { "mark" } else { &self.name };
        mesh.set_point_field(Field::scalars(name, values));
        Ok(())
    }
}
