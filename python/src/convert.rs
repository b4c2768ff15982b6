//! Conversion of whole meshes: into a [`Mesh`] by copying Python's arrays, and back by passing the arrays on.
//!
//! Python's `motet.Mesh` consists of numpy arrays; those of the cells are compressed rows as in [`Cells`].

use std::collections::BTreeMap;

use motet::Mesh;
use motet::base::{Csr, VertexId};
use motet::mesh::{CellKind, Cells, Field, LabelNames};
use numpy::PyArray1;
use numpy::ndarray::Ix1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Ids, Read, Vectors, from_field, ids, rows, to_field, vectors};
use crate::error::{OrRaise, input};

/// A mesh from Python, checked.
pub(crate) struct MeshArg(pub(crate) Mesh);

impl<'py> FromPyObject<'_, 'py> for MeshArg {
    type Error = PyErr;

    fn extract(mesh: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let points: Vectors<'py> = mesh.getattr("points")?.extract()?;
        let mut given = Mesh::new(rows(&points, "points")?.to_vec(), cells(&mesh)?);
        given.point_data = fields(&mesh, "point_data")?;
        given.cell_data = fields(&mesh, "cell_data")?;
        given.field_data = fields(&mesh, "field_data")?;
        let names = |of: &str| mesh.getattr(of)?.extract::<BTreeMap<i32, String>>();
        given.label_names = LabelNames { regions: names("region_names")?, patches: names("patch_names")? };
        given.validate().or_raise()?;
        Ok(Self(given))
    }
}

fn cells(mesh: &Borrowed<'_, '_, PyAny>) -> PyResult<Cells> {
    let kinds: Read<'_, u8, Ix1> = mesh.getattr("kinds")?.extract()?;
    let offsets: Ids<'_> = mesh.getattr("offsets")?.extract()?;
    let vertices: Ids<'_> = mesh.getattr("connectivity")?.extract()?;
    let faces: Ids<'_> = mesh.getattr("faces")?.extract()?;
    let kinds: Vec<CellKind> = kinds.as_array().iter().map(|&k| CellKind(k)).collect();
    let offsets = offsets.as_array().to_vec();
    let vertices: Vec<VertexId> = vertices.as_array().iter().map(|&v| VertexId(v)).collect();
    if !kinds.contains(&CellKind::POLYHEDRON) {
        return Cells::from_parts(kinds, offsets, vertices).or_raise();
    }
    let n = kinds.len();
    let lists = Csr::new(offsets, vertices).filter(|lists| lists.len() == n);
    let lists = lists.ok_or_else(|| input("the offsets of the cells do not fit their vertices"))?;
    with_polyhedra(&kinds, &lists, &faces.as_array().to_vec())
}

/// Cells with polyhedra, whose faces are listed in `faces`: for each polyhedron the number of faces, then for
/// each face the number of vertices and the vertices.
fn with_polyhedra(kinds: &[CellKind], lists: &Csr<VertexId>, faces: &[u32]) -> PyResult<Cells> {
    let mut cells = Cells::new();
    let mut rest = faces;
    let mut take = |n: usize| {
        let (taken, left) = rest.split_at_checked(n)?;
        rest = left;
        Some(taken)
    };
    for (i, (&kind, vertices)) in kinds.iter().zip(lists.iter()).enumerate() {
        let vertices = vertices.iter().copied();
        if kind != CellKind::POLYHEDRON {
            if let Some(n) = kind.n_vertices().filter(|&n| n != vertices.len()) {
                return Err(input(format!("cell {i}: expected {n} vertices, got {}", vertices.len())));
            }
            cells.push(kind, vertices);
            continue;
        }
        let short = || input(format!("cell {i}: its faces end before they are complete"));
        let n = take(1).ok_or_else(short)?[0];
        let mut of_cell = Csr::default();
        for _ in 0..n {
            let k = take(1).ok_or_else(short)?[0] as usize;
            of_cell.push(take(k).ok_or_else(short)?.iter().map(|&v| VertexId(v)));
        }
        cells.push_polyhedron(vertices, of_cell);
    }
    Ok(cells)
}

fn fields(mesh: &Borrowed<'_, '_, PyAny>, of: &str) -> PyResult<Vec<Field>> {
    let arrays = mesh.getattr(of)?;
    let arrays = arrays.cast::<PyDict>()?;
    arrays.iter().map(|(name, array)| to_field(name.extract()?, &array)).collect()
}

/// The parts from which Python builds a `motet.Mesh`, by name.
pub(crate) fn parts<'py>(py: Python<'py>, mesh: Mesh) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    let faces: Vec<u32> = mesh.cells.polyhedron_faces().iter().flat_map(stream).collect();
    all.set_item("points", vectors(py, mesh.points)?)?;
    all.set_item("kinds", PyArray1::from_vec(py, mesh.cells.kinds().iter().map(|kind| kind.0).collect()))?;
    all.set_item("offsets", PyArray1::from_slice(py, mesh.cells.connectivity().offsets()))?;
    all.set_item("connectivity", ids(py, mesh.cells.connectivity().items().to_vec()))?;
    all.set_item("faces", PyArray1::from_vec(py, faces))?;
    all.set_item("point_data", by_name(py, mesh.point_data)?)?;
    all.set_item("cell_data", by_name(py, mesh.cell_data)?)?;
    all.set_item("field_data", by_name(py, mesh.field_data)?)?;
    all.set_item("region_names", mesh.label_names.regions)?;
    all.set_item("patch_names", mesh.label_names.patches)?;
    Ok(all)
}

fn stream(faces: &Csr<VertexId>) -> Vec<u32> {
    let mut all = vec![faces.len() as u32];
    for face in faces.iter() {
        all.push(face.len() as u32);
        all.extend(face.iter().map(|v| v.0));
    }
    all
}

fn by_name<'py>(py: Python<'py>, fields: Vec<Field>) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    for field in fields {
        all.set_item(field.name.clone(), from_field(py, field)?)?;
    }
    Ok(all)
}
