//! Writes meshes and solutions, as text or binary.

use super::sink::{Sink, version_for};
use super::solution::{KINDS, Kind, places_of};
use super::{Keyword, REF, SECTIONS, SOLUTION, Section};
use crate::base::{Error, Result, Threads};
use crate::io::cell_labels::{cell_labels, labels_cover, lost_names};
use crate::io::format::Written;
use crate::io::select::{keep_cells, lost_arrays};
use crate::mesh::{CellKind, Field, Mesh, Values};

/// Writes a mesh, and its arrays `medit:sol...` as a solution beside it.
pub(super) fn mesh(mesh: &Mesh, binary: bool, threads: &Threads) -> Result<Written> {
    let (mesh, lost) = keep_cells(mesh, "Medit", |kind| section_of(kind).is_some());
    let mut parts = Parts::of(&mesh, binary, |f| is_solution(f) && f.name.starts_with(SOLUTION), lost);
    if parts.omits_any(is_solution) {
        parts.lost.push("real-valued arrays are written only to .sol and .solb files".into());
    }
    let mut files = vec![(String::new(), parts.mesh_file(threads)?)];
    if parts.has_solution() {
        files.push((if binary { ".solb" } else { ".sol" }.into(), parts.solution_file(threads)?));
    }
    Ok(Written { files, lost: parts.lost })
}

/// Writes a solution with all arrays that it can hold, and the mesh.
pub(super) fn solution(mesh: &Mesh, binary: bool, threads: &Threads) -> Result<Written> {
    let (mesh, lost) = keep_cells(mesh, "Medit", |kind| section_of(kind).is_some());
    let mut parts = Parts::of(&mesh, binary, is_solution, lost);
    if !parts.has_solution() {
        return Err(Error::input("there is no real-valued array to write as a solution")
            .remedy("write the mesh alone, as .mesh or .meshb"));
    }
    let mut files = vec![(String::new(), parts.solution_file(threads)?)];
    files.push((if binary { ".meshb" } else { ".mesh" }.into(), parts.mesh_file(threads)?));
    Ok(Written { files, lost: parts.lost })
}

/// The index in [`SECTIONS`] of cells of a kind.
fn section_of(kind: CellKind) -> Option<usize> {
    SECTIONS.iter().position(|s| s.cells.is_some_and(|c| c.0 == kind))
}

/// Whether a solution can hold an array.
fn is_solution(field: &Field) -> bool {
    matches!(field.values, Values::F32(_) | Values::F64(_)) && kind_of(field).is_some()
}

fn kind_of(field: &Field) -> Option<&'static Kind> {
    KINDS.iter().find(|kind| kind.components == field.components)
}

/// A mesh whose cells all fit the format, and the losses.
struct Parts<'m> {
    mesh: &'m Mesh,
    labels: Vec<i32>,
    version: Option<i32>,
    /// Arrays of the solution on points.
    points: Vec<&'m Field>,
    cells: Vec<&'m Field>,
    /// Arrays on points and on cells that are not part of the solution.
    other: [Vec<&'m Field>; 2],
    lost: Vec<String>,
}

impl<'m> Parts<'m> {
    /// Sorts the arrays of a mesh; `in_solution` decides which go into the solution.
    fn of(mesh: &'m Mesh, binary: bool, in_solution: impl Fn(&Field) -> bool, lost: Vec<String>) -> Self {
        let has_values = mesh.cells.kinds().iter().any(|&kind| has_solution_section(kind));
        let (points, other_points) = mesh.point_data.iter().partition(|f| in_solution(f));
        let (cells, other_cells) = mesh.cell_data.iter().partition(|f| has_values && in_solution(f));
        let mut parts = Self {
            mesh,
            labels: cell_labels(mesh, None),
            version: binary.then(|| version_for(mesh.points.len(), max_file_bytes(mesh))),
            points,
            cells,
            other: [other_points, other_cells],
            lost,
        };
        parts.report_losses();
        parts
    }

    fn has_solution(&self) -> bool {
        !self.points.is_empty() || !self.cells.is_empty()
    }

    fn omits_any(&self, is_meant: impl Fn(&Field) -> bool) -> bool {
        self.other.iter().flatten().any(|f| is_meant(f))
    }

    fn report_losses(&mut self) {
        let mesh = self.mesh;
        if !mesh.cells.kinds().is_sorted_by_key(|&kind| section_of(kind)) {
            self.lost.push("the order of the cells is not kept: Medit groups cells by kind".into());
        }
        let [points, cells] = &self.other;
        let cells = cells.iter().filter(|f| !is_mark(f) && !labels_cover(&self.labels, mesh, f));
        self.lost.extend(lost_arrays("Medit", "cell", cells.copied()));
        let has_refs = point_refs(mesh).is_some();
        let points = points.iter().filter(|f| !(is_mark(f) || f.name == REF && has_refs));
        self.lost.extend(lost_arrays("Medit", "point", points.copied()));
        self.lost.extend(lost_arrays("Medit", "field", &mesh.field_data));
        self.lost.extend(lost_names("Medit", mesh));
        self.report_solution_losses();
    }

    fn report_solution_losses(&mut self) {
        let all = || self.points.iter().chain(&self.cells);
        let names = |is_meant: fn(&Field) -> bool| -> Vec<&str> {
            all().filter(|f| is_meant(f)).map(|f| f.name.as_str()).collect()
        };
        let nameless = names(|f| !f.name.starts_with(SOLUTION));
        let single = names(|f| matches!(f.values, Values::F32(_)));
        let quadratic = self.mesh.cells.kinds().iter().filter(|&&kind| !has_solution_section(kind)).count();
        let mut lost = Vec::new();
        if !nameless.is_empty() {
            let names = nameless.join(", ");
            lost.push(format!("array names are not written (Medit solutions have none): {names}"));
        }
        if !single.is_empty() {
            lost.push(format!("arrays are converted to double precision: {}", single.join(", ")));
        }
        if quadratic > 0 && !self.cells.is_empty() {
            lost.push(format!(
                "values on {quadratic} second-order cells are not written: Medit has no solutions on them"
            ));
        }
        self.lost.extend(lost);
    }

    fn mesh_file(&mut self, threads: &Threads) -> Result<Vec<u8>> {
        let mut sink = Sink::new(self.version, threads);
        for (of, section) in SECTIONS.iter().enumerate() {
            let places = places_of(self.mesh, of);
            if places.is_empty() && section.cells.is_some() {
                continue;
            }
            sink.section(&section.list, places.len());
            match section.cells {
                None => self.points(&mut sink)?,
                Some(_) => self.cells(&mut sink, &places)?,
            }
            sink.end_section();
            self.marks(&mut sink, section, &places)?;
        }
        Ok(sink.finish())
    }

    fn points(&self, sink: &mut Sink<'_>) -> Result<()> {
        let refs = point_refs(self.mesh);
        sink.rows(self.mesh.points.len(), |sink, i| {
            self.mesh.points[i].iter().for_each(|&x| sink.float(x));
            sink.int(refs.as_ref().map_or(0, |r| r[i].into()));
        })
    }

    fn cells(&self, sink: &mut Sink<'_>, places: &[usize]) -> Result<()> {
        sink.rows(places.len(), |sink, i| {
            let cell = places[i];
            self.mesh.cells.connectivity().list(cell).iter().for_each(|v| sink.int(i64::from(v.0) + 1));
            sink.int(self.labels[cell].into());
        })
    }

    /// Writes the sections that mark entities of another section.
    fn marks(&mut self, sink: &mut Sink<'_>, section: &Section, places: &[usize]) -> Result<()> {
        let fields = if section.cells.is_none() { &self.mesh.point_data } else { &self.mesh.cell_data };
        for field in fields.iter().filter(|f| is_mark(f)) {
            let marked = marked(field, places);
            let list = section.marks.iter().find(|(list, array)| *array == field.name && sink.has(list));
            match list {
                _ if marked.is_empty() => {}
                Some((list, _)) => write_places(sink, list, &marked)?,
                None => self.lost.push(format!(
                    "{} of {} {} is not written: there is no section for it",
                    field.name,
                    marked.len(),
                    section.list.name
                )),
            }
        }
        Ok(())
    }

    fn solution_file(&self, threads: &Threads) -> Result<Vec<u8>> {
        let mut sink = Sink::new(self.version, threads);
        for (of, section) in SECTIONS.iter().enumerate() {
            let fields = if section.cells.is_none() { &self.points } else { &self.cells };
            let places = places_of(self.mesh, of);
            let Some(values) = section.values.as_ref().filter(|_| !fields.is_empty() && !places.is_empty())
            else {
                continue;
            };
            // Cells of a kind without any value, such as triangles beside tetrahedra with values.
            let has_no_values = |f: &&Field| {
                places.iter().all(|&i| (0..f.components).all(|k| value(f, i * f.components + k).is_nan()))
            };
            if section.cells.is_some() && fields.iter().all(has_no_values) {
                continue;
            }
            write_values(&mut sink, values, fields, &places)?;
        }
        Ok(sink.finish())
    }
}

fn write_places(sink: &mut Sink<'_>, list: &Keyword, places: &[usize]) -> Result<()> {
    sink.section(list, places.len());
    sink.rows(places.len(), |sink, i| sink.int(places[i] as i64 + 1))?;
    sink.end_section();
    Ok(())
}

fn write_values(sink: &mut Sink<'_>, keyword: &Keyword, fields: &[&Field], places: &[usize]) -> Result<()> {
    sink.section(keyword, places.len());
    sink.fixed_i32(fields.len() as i32);
    let kinds: Vec<&Kind> = fields.iter().filter_map(|f| kind_of(f)).collect();
    kinds.iter().for_each(|kind| sink.fixed_i32(kind.number));
    sink.end_row();
    sink.rows(places.len(), |sink, i| {
        for (field, kind) in fields.iter().zip(&kinds) {
            kind.places.iter().for_each(|k| sink.float(value(field, places[i] * kind.components + k)));
        }
    })?;
    sink.end_section();
    Ok(())
}

fn value(field: &Field, i: usize) -> f64 {
    field.values.get_f64(i).unwrap_or(f64::NAN)
}

/// Whether solutions have a section for cells of this kind.
fn has_solution_section(kind: CellKind) -> bool {
    SECTIONS.iter().any(|s| s.values.is_some() && s.cells.is_some_and(|c| c.0 == kind))
}

fn is_mark(field: &Field) -> bool {
    SECTIONS.iter().flat_map(|s| s.marks).any(|(_, array)| *array == field.name) && field.components == 1
}

fn point_refs(mesh: &Mesh) -> Option<Vec<i32>> {
    let refs = mesh.point_field(REF).filter(|f| f.components == 1)?.values.to_i64()?;
    refs.into_iter().map(|r| i32::try_from(r).ok()).collect()
}

/// The marked entries of `places`, as indices into `places`.
fn marked(field: &Field, places: &[usize]) -> Vec<usize> {
    let values = field.values.to_i64().unwrap_or_default();
    let is_marked = |&(_, &i): &(usize, &usize)| values.get(i).is_some_and(|&v| v != 0);
    places.iter().enumerate().filter(is_marked).map(|(place, _)| place).collect()
}

/// Upper bound on the size in bytes of a binary file of either kind, in version 2.
fn max_file_bytes(mesh: &Mesh) -> u64 {
    let (n_points, n_cells) = (mesh.points.len(), mesh.cells.len());
    let ids = mesh.cells.connectivity().items().len() + n_cells;
    let values = |fields: &[Field]| fields.iter().map(|f| 8 * f.values.len()).sum::<usize>();
    let solution = values(&mesh.point_data) + values(&mesh.cell_data);
    let file = 28 * n_points + 4 * ids + 4 * 2 * (n_points + n_cells);
    (file.max(solution) + 4096) as u64
}
