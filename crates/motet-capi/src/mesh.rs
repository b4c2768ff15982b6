//! Meshes: made from arrays or files, and queried.

use std::ffi::{CString, c_char};

use motet::base::{CellId, VertexId};
use motet::geometry::quality::eas;
use motet::io::{self, WriteOptions};
use motet::mesh::{CellKind, Cells, Field, Summary, Values};
use motet::motion::FacetSet;
use motet::{Error, Mesh, Result};

use crate::constants::{self, On};
use crate::guard::{MotetError, guarded, or_default, text as c_text};
use crate::memory::{
    count, expect, fill_rows, free, handle, handle_mut, id, out_handle, rows, set_handle, text, values,
    values_mut, vertex,
};

/// A mesh.
#[repr(transparent)]
pub(crate) struct MotetMesh(pub(crate) Mesh);

impl MotetMesh {
    /// A mesh that is part of another object, as C sees one.
    pub(crate) fn of(mesh: &Mesh) -> *const Self {
        std::ptr::from_ref(mesh).cast()
    }
}

/// A text that the caller owns.
pub(crate) struct MotetText(CString);

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_new(
    points: *const f64,
    n: i64,
    stride: i64,
    mesh: *mut *mut MotetMesh,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(mesh, "mesh")?;
        let points = rows(points, n, stride, "points")?.into_owned();
        let mesh = Mesh::new(points, Cells::new());
        mesh.validate()?;
        set_handle(place, MotetMesh(mesh));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_add_cells(
    mesh: *mut MotetMesh,
    kind: i32,
    vertices: *const i32,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &mut handle_mut(mesh, "mesh")?.0;
        let kind = self::kind(kind)?;
        let Some(of_each) = kind.n_vertices().filter(|&k| k > 0) else {
            return Err(Error::options(format!(
                "cells of kind {} differ in their number of vertices",
                kind.0
            ))
            .remedy("read them from a file"));
        };
        let n = count(n, "cells")?;
        let all = values(vertices, n.checked_mul(of_each).ok_or_else(|| too_many(n))?, "vertices")?;
        if !mesh.cell_data.is_empty() {
            return Err(Error::options("cells are added to a mesh that has arrays on cells")
                .remedy("add cells first"));
        }
        if mesh.cells.connectivity().items().len() + all.len() > VertexId::MAX_COUNT {
            return Err(too_many(n));
        }
        let at = |k: usize| format!("cell {} of those added", k / of_each);
        let ids = all.iter().enumerate().map(|(k, &v)| vertex(v, mesh.points.len(), &at(k)));
        let ids: Vec<VertexId> = ids.collect::<Result<_>>()?;
        ids.chunks_exact(of_each).for_each(|cell| mesh.cells.push(kind, cell.iter().copied()));
        Ok(())
    })
}

fn too_many(n: usize) -> Error {
    Error::input(format!("{n} cells are more than a mesh can hold"))
}

fn kind(kind: i32) -> Result<CellKind> {
    u8::try_from(kind)
        .map(CellKind)
        .map_err(|_| Error::options(format!("unknown cell kind {kind}")).remedy("give one of VTK's numbers"))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_set_labels(
    mesh: *mut MotetMesh,
    labels: *const i32,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &mut handle_mut(mesh, "mesh")?.0;
        expect(n, mesh.cells.len(), "labels")?;
        let labels = values(labels, mesh.cells.len(), "labels")?;
        for (name, dim) in [("region", 3), ("patch", 2)] {
            let of = |(label, kind): (&i32, &CellKind)| if kind.dim() == Some(dim) { *label } else { 0 };
            let own: Vec<i32> = labels.iter().zip(mesh.cells.kinds()).map(of).collect();
            mesh.set_cell_field(Field::scalars(name, own));
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_name_region(
    mesh: *mut MotetMesh,
    label: i32,
    name: *const c_char,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &mut handle_mut(mesh, "mesh")?.0;
        mesh.label_names.regions.insert(label, text(name, "name")?.to_owned());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_name_patch(
    mesh: *mut MotetMesh,
    label: i32,
    name: *const c_char,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &mut handle_mut(mesh, "mesh")?.0;
        mesh.label_names.patches.insert(label, text(name, "name")?.to_owned());
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_set_array(
    mesh: *mut MotetMesh,
    on: i32,
    name: *const c_char,
    values: *const f64,
    n: i64,
    components: i32,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &mut handle_mut(mesh, "mesh")?.0;
        let on = constants::on(on)?;
        let field = field(text(name, "name")?, values, n, components)?;
        match on {
            On::Points => {
                expect(n, mesh.points.len(), "rows")?;
                mesh.set_point_field(field);
            }
            On::Cells => {
                expect(n, mesh.cells.len(), "rows")?;
                mesh.set_cell_field(field);
            }
        }
        Ok(())
    })
}

/// A field from a C array of `n` rows.
pub(crate) fn field(name: &str, start: *const f64, n: i64, components: i32) -> Result<Field> {
    let components = usize::try_from(components).ok().filter(|&k| k > 0);
    let components =
        components.ok_or_else(|| Error::options("an array has 1 component or more").at(name.to_owned()))?;
    let n = count(n, "rows")?.checked_mul(components);
    let n = n.ok_or_else(|| Error::options("more values than fit into memory"))?;
    Ok(Field { name: name.to_owned(), components, values: values(start, n, "values")?.to_vec().into() })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_set_points(
    mesh: *mut MotetMesh,
    points: *const f64,
    n: i64,
    stride: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &mut handle_mut(mesh, "mesh")?.0;
        expect(n, mesh.points.len(), "points")?;
        mesh.points.copy_from_slice(&rows(points, n, stride, "points")?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_read(
    path: *const c_char,
    mesh: *mut *mut MotetMesh,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(mesh, "mesh")?;
        set_handle(place, MotetMesh(io::read(text(path, "path")?)?));
        Ok(())
    })
}

/// Stores sentences as a text, one a line, where there are any.
fn set_sentences(place: &mut *mut MotetText, sentences: &[String]) {
    if !sentences.is_empty() {
        set_handle(place, MotetText(c_text(sentences.join("\n"))));
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_read_noted(
    path: *const c_char,
    mesh: *mut *mut MotetMesh,
    notes: *mut *mut MotetText,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let (place, notes) = (out_handle(mesh, "mesh")?, out_handle(notes, "notes")?);
        let (mesh, sentences) = io::read_noted(text(path, "path")?)?;
        set_sentences(notes, &sentences);
        set_handle(place, MotetMesh(mesh));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_write(
    mesh: *const MotetMesh,
    path: *const c_char,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        io::write(text(path, "path")?, &handle(mesh, "mesh")?.0, &WriteOptions::default()).map(|_| ())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_write_noted(
    mesh: *const MotetMesh,
    path: *const c_char,
    lost: *mut *mut MotetText,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let lost = out_handle(lost, "lost")?;
        let options = WriteOptions::default();
        set_sentences(lost, &io::write(text(path, "path")?, &handle(mesh, "mesh")?.0, &options)?);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_copy(
    mesh: *const MotetMesh,
    copy: *mut *mut MotetMesh,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(copy, "copy")?;
        set_handle(place, MotetMesh(handle(mesh, "mesh")?.0.clone()));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_free(mesh: *mut MotetMesh) {
    free(mesh);
}

/// A number computed from a mesh; `otherwise` for NULL.
fn number<T>(mesh: *const MotetMesh, otherwise: T, of: impl FnOnce(&Mesh) -> T) -> T {
    or_default(otherwise, || handle(mesh, "mesh").ok().map(|mesh| of(&mesh.0)))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_n_points(mesh: *const MotetMesh) -> i64 {
    number(mesh, 0, |mesh| mesh.points.len() as i64)
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_n_cells(mesh: *const MotetMesh) -> i64 {
    number(mesh, 0, |mesh| mesh.cells.len() as i64)
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_n_of_kind(mesh: *const MotetMesh, kind: i32) -> i64 {
    number(mesh, 0, |mesh| mesh.cells.kinds().iter().filter(|k| i32::from(k.0) == kind).count() as i64)
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_n_vertices_of_cells(mesh: *const MotetMesh) -> i64 {
    number(mesh, 0, |mesh| mesh.cells.connectivity().items().len() as i64)
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_points(
    mesh: *const MotetMesh,
    points: *mut f64,
    n: i64,
    stride: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &handle(mesh, "mesh")?.0;
        expect(n, mesh.points.len(), "points")?;
        fill_rows(points, n, stride, "points", |out| {
            out.copy_from_slice(&mesh.points);
            Ok(())
        })
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_of_kind(
    mesh: *const MotetMesh,
    kind: i32,
    vertices: *mut i32,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &handle(mesh, "mesh")?.0;
        let kind = self::kind(kind)?;
        let cells = mesh.cells.iter().filter(|(_, of, _)| *of == kind).map(|(_, _, vertices)| vertices);
        expect(n, cells.clone().map(<[VertexId]>::len).sum(), "vertices")?;
        let out = values_mut(vertices, count(n, "vertices")?, "vertices")?;
        out.iter_mut().zip(cells.flatten()).for_each(|(out, v)| *out = id(v.0));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_cells(
    mesh: *const MotetMesh,
    kinds: *mut i32,
    n_cells: i64,
    offsets: *mut i64,
    vertices: *mut i32,
    n_vertices: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let cells = &handle(mesh, "mesh")?.0.cells;
        let lists = cells.connectivity();
        expect(n_cells, cells.len(), "cells")?;
        expect(n_vertices, lists.items().len(), "vertices")?;
        let (kinds, offsets) =
            (values_mut(kinds, cells.len(), "kinds")?, values_mut(offsets, cells.len() + 1, "offsets")?);
        let vertices = values_mut(vertices, lists.items().len(), "vertices")?;
        kinds.iter_mut().zip(cells.kinds()).for_each(|(out, kind)| *out = kind.0.into());
        offsets.iter_mut().zip(lists.offsets()).for_each(|(out, &offset)| *out = offset.into());
        vertices.iter_mut().zip(lists.items()).for_each(|(out, v)| *out = id(v.0));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_labels(
    mesh: *const MotetMesh,
    labels: *mut i32,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &handle(mesh, "mesh")?.0;
        expect(n, mesh.cells.len(), "labels")?;
        let out = values_mut(labels, mesh.cells.len(), "labels")?;
        out.fill(0);
        for (dim, labels) in [(3, mesh.regions()), (2, mesh.patches())] {
            let Some(labels) = labels else { continue };
            for (cell, ..) in mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(dim)) {
                out[cell.index()] = labels.ids[cell.index()];
            }
        }
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_region(mesh: *const MotetMesh, name: *const c_char) -> i32 {
    let find = |mesh: &Mesh| mesh.regions()?.find(text(name, "name").ok()?);
    number(mesh, -1, |mesh| find(mesh).unwrap_or(-1))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_patch(mesh: *const MotetMesh, name: *const c_char) -> i32 {
    let find = |mesh: &Mesh| mesh.patches()?.find(text(name, "name").ok()?);
    number(mesh, -1, |mesh| find(mesh).unwrap_or(-1))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_n_patch_vertices(
    mesh: *const MotetMesh,
    name: *const c_char,
) -> i64 {
    let find = |mesh: &Mesh| Some(FacetSet::find(mesh, text(name, "name").ok()?).ok()?.vertices.len() as i64);
    number(mesh, -1, |mesh| find(mesh).unwrap_or(-1))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_patch_vertices(
    mesh: *const MotetMesh,
    name: *const c_char,
    vertices: *mut i32,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let patch = FacetSet::find(&handle(mesh, "mesh")?.0, text(name, "name")?)?;
        expect(n, patch.vertices.len(), "vertices")?;
        let out = values_mut(vertices, patch.vertices.len(), "vertices")?;
        out.iter_mut().zip(&patch.vertices).for_each(|(out, v)| *out = id(v.0));
        Ok(())
    })
}

/// An array of numbers by its name; `None` where there is none.
fn array<'a>(mesh: &'a Mesh, on: i32, name: &str) -> Result<Option<&'a Field>> {
    let found = match constants::on(on)? {
        On::Points => mesh.point_field(name),
        On::Cells => mesh.cell_field(name),
    };
    Ok(found.filter(|field| !matches!(field.values, Values::Text(_))))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_array_components(
    mesh: *const MotetMesh,
    on: i32,
    name: *const c_char,
) -> i32 {
    let find = |mesh: &Mesh| Some(array(mesh, on, text(name, "name").ok()?).ok()??.components as i32);
    number(mesh, 0, |mesh| find(mesh).unwrap_or(0))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_array(
    mesh: *const MotetMesh,
    on: i32,
    name: *const c_char,
    values: *mut f64,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &handle(mesh, "mesh")?.0;
        let name = text(name, "name")?;
        let Some(field) = array(mesh, on, name)? else {
            return Err(Error::options(format!("the mesh has no array {name} of numbers there")));
        };
        expect(n, field.n_rows(), "rows")?;
        let all = field.values.to_f64().unwrap_or_default();
        values_mut(values, all.len(), "values")?.copy_from_slice(&all);
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_eas(
    mesh: *const MotetMesh,
    values: *mut f64,
    n: i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let mesh = &handle(mesh, "mesh")?.0;
        expect(n, mesh.cells.len(), "cells")?;
        let out = values_mut(values, mesh.cells.len(), "eas")?;
        out.fill(f64::NAN);
        mesh.cells.tets().for_each(|(cell, tet): (CellId, _)| {
            out[cell.index()] = eas(tet.map(|v| mesh.points[v.index()]));
        });
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_mesh_summary(
    mesh: *const MotetMesh,
    summary: *mut *mut MotetText,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let place = out_handle(summary, "summary")?;
        let report = json(&Summary::of(&handle(mesh, "mesh")?.0))?;
        set_handle(place, MotetText(report));
        Ok(())
    })
}

/// A report as JSON text.
pub(crate) fn json(report: &impl serde::Serialize) -> Result<CString> {
    let text = serde_json::to_string(report);
    text.map(c_text).map_err(|e| Error::input(format!("the report cannot be serialized: {e}")))
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_text_get(text: *const MotetText) -> *const c_char {
    handle(text, "text").map_or(std::ptr::null(), |text| text.0.as_ptr())
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_text_free(text: *mut MotetText) {
    free(text);
}
