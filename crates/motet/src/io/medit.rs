//! Medit's `.mesh`, the text form, of versions 1 to 4.
//!
//! References are the arrays `medit:ref` on points and on cells (meshio's name);
//! those of tetrahedra are regions, those of triangles patches. Cells marked as
//! required and edges marked as ridges are cell arrays `medit:required` and
//! `medit:ridge`, vertices `medit:required` and `medit:corner`: 1 where marked.
//! Normals, tangents and other sections are passed over with a note.
//!
//! No crate in the registry reads this format (the one there is, is under the
//! LGPL and not released).

use std::io::Write as _;

use crate::base::{Result, VertexId};
use crate::io::cell_labels::{cell_labels, lost_cell_arrays, lost_names};
use crate::io::format::{Format, Input, Notes, WriteOptions, Written};
use crate::io::select::{keep_cells, lost_arrays};
use crate::io::text::{Text, push_floats, quoted};
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

pub(super) const FORMAT: Format =
    Format { name: "Medit", endings: &[".mesh"], read: Some(read), write: Some(write) };

/// Sections of cells, in the order in which they are written.
const SECTIONS: &[(&str, CellKind, usize)] = &[
    ("Edges", CellKind::LINE, 2),
    ("Triangles", CellKind::TRIANGLE, 3),
    ("Quadrilaterals", CellKind::QUAD, 4),
    ("Tetrahedra", CellKind::TETRA, 4),
    ("Hexahedra", CellKind::HEXAHEDRON, 8),
    ("Prisms", CellKind::WEDGE, 6),
    ("Pyramids", CellKind::PYRAMID, 5),
    // Nodes on edges stand in VTK's order.
    ("EdgesP2", CellKind::QUADRATIC_LINE, 3),
    ("TrianglesP2", CellKind::QUADRATIC_TRIANGLE, 6),
    ("TetrahedraP2", CellKind::QUADRATIC_TETRA, 10),
];

/// Other spellings that programs write.
const SPELLINGS: &[(&str, &str)] =
    &[("Pentahedra", "Prisms"), ("Hexaedra", "Hexahedra"), ("Quadrangles", "Quadrilaterals")];

/// Sections that list places in another section, and the array that marks them.
const MARKS: &[(&str, &str, &str)] = &[
    ("Corners", "Vertices", "medit:corner"),
    ("RequiredVertices", "Vertices", "medit:required"),
    ("Ridges", "Edges", "medit:ridge"),
    ("RequiredEdges", "Edges", "medit:required"),
    ("RequiredTriangles", "Triangles", "medit:required"),
    ("RequiredQuadrilaterals", "Quadrilaterals", "medit:required"),
    ("RequiredTetrahedra", "Tetrahedra", "medit:required"),
];

#[derive(Default)]
struct Reader {
    dim: usize,
    points: Option<Vec<[f64; 3]>>,
    point_refs: Vec<i32>,
    cells: Cells,
    cell_refs: Vec<i32>,
    /// Where the cells of each section begin and end.
    ranges: Vec<(&'static str, usize, usize)>,
    /// Marked places: section, array, place.
    marks: Vec<(&'static str, &'static str, usize)>,
}

fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut text = Text::with_comments(input.bytes, b'#');
    match text.word() {
        Some(b"MeshVersionFormatted") => {}
        Some(word) => {
            return Err(text
                .unexpected("the first word", "`MeshVersionFormatted`", word)
                .remedy("only Medit's text form is read: is this another format?"));
        }
        None => return Err(text.ends("`MeshVersionFormatted`")),
    }
    let version = text.int("version")?;
    if !(0..=4).contains(&version) {
        return Err(text.error(format!("version {version} of the format; 1 to 4 are read")));
    }
    let mut reader = Reader::default();
    while let Some(word) = text.word() {
        if word == b"End" {
            break;
        }
        reader.section(&mut text, word, input.notes)?;
    }
    reader.into_mesh(&text)
}

impl Reader {
    fn section(&mut self, text: &mut Text<'_>, word: &[u8], notes: &Notes) -> Result<()> {
        let word =
            SPELLINGS.iter().find(|(other, _)| other.as_bytes() == word).map_or(word, |s| s.1.as_bytes());
        if let Some(&(name, kind, n)) = SECTIONS.iter().find(|(name, ..)| name.as_bytes() == word) {
            return self.elements(text, name, kind, n);
        }
        if let Some(&(name, of, array)) = MARKS.iter().find(|(name, ..)| name.as_bytes() == word) {
            return self.marks(text, name, of, array);
        }
        match word {
            b"Dimension" => match text.int("dimension")? {
                dim @ 2..=3 => self.dim = dim as usize,
                other => return Err(text.error(format!("{other} dimensions; 2 and 3 are read"))),
            },
            b"Vertices" => self.vertices(text)?,
            _ if word[0].is_ascii_alphabetic() => {
                notes
                    .add(format!("section {} is passed over: a mesh here has no place for it", quoted(word)));
                while text.peek().is_some_and(|next| !next[0].is_ascii_alphabetic()) {
                    text.word();
                }
            }
            _ => {
                return Err(text.unexpected("a section", "its name", word).remedy(
                    "the number at the head of the section before is wrong, or the file is damaged",
                ));
            }
        }
        Ok(())
    }

    fn vertices(&mut self, text: &mut Text<'_>) -> Result<()> {
        if self.dim == 0 {
            return Err(text.error("vertices come before the dimension").remedy("write the file again"));
        }
        if self.points.is_some() {
            return Err(text.error("a second section of vertices").remedy("write the file again"));
        }
        let n = text.count("vertices", self.dim + 1)?;
        let mut points = Vec::with_capacity(n);
        self.point_refs.reserve(n);
        for _ in 0..n {
            let mut point = [0.0; 3];
            for x in &mut point[..self.dim] {
                *x = text.float("coordinate of a vertex")?;
            }
            points.push(point);
            self.point_refs.push(text.int32("reference of a vertex")?);
        }
        self.points = Some(points);
        Ok(())
    }

    fn elements(&mut self, text: &mut Text<'_>, name: &'static str, kind: CellKind, n: usize) -> Result<()> {
        let n_cells = text.count(name, n + 1)?;
        let n_points = self.points.as_ref().map(Vec::len);
        let begin = self.cells.len();
        let mut vertices = [VertexId::default(); 10];
        for _ in 0..n_cells {
            for vertex in &mut vertices[..n] {
                let id = text.int("vertex of a cell")?;
                *vertex = vertex_id(id, n_points, text)?;
            }
            self.cells.push(kind, vertices[..n].iter().copied());
            self.cell_refs.push(text.int32("reference of a cell")?);
        }
        self.ranges.push((name, begin, self.cells.len()));
        Ok(())
    }

    fn marks(
        &mut self,
        text: &mut Text<'_>,
        name: &str,
        of: &'static str,
        array: &'static str,
    ) -> Result<()> {
        for _ in 0..text.count(name, 1)? {
            let id = text.int("a marked place")?;
            let place = usize::try_from(id).ok().and_then(|id| id.checked_sub(1));
            let place =
                place.ok_or_else(|| text.error(format!("{name} names {id}, but counting begins at 1")))?;
            self.marks.push((of, array, place));
        }
        Ok(())
    }

    fn into_mesh(mut self, text: &Text<'_>) -> Result<Mesh> {
        let Some(points) = self.points.take() else {
            return Err(text
                .error("there is no section Vertices")
                .remedy("the file holds no mesh, or is cut off: get it again"));
        };
        let n_points = points.len();
        let n_cells = self.cells.len();
        let mut mesh = Mesh::new(points, self.cells);
        if self.point_refs.iter().any(|&r| r != 0) {
            mesh.set_point_field(Field::scalars("medit:ref", self.point_refs));
        }
        if self.cell_refs.iter().any(|&r| r != 0) {
            mesh.set_cell_field(Field::scalars("medit:ref", self.cell_refs));
        }
        for (of, array, place) in self.marks {
            let on_points = of == "Vertices";
            let range = self.ranges.iter().find(|(name, ..)| *name == of).map(|r| (r.1, r.2));
            let (begin, end) = if on_points { (0, n_points) } else { range.unwrap_or((0, 0)) };
            if place >= end - begin {
                return Err(text
                    .error(format!("{} of {} {of} is marked, which does not exist", place + 1, end - begin))
                    .remedy("the file is damaged: write it again"));
            }
            let (fields, n) =
                if on_points { (&mut mesh.point_data, n_points) } else { (&mut mesh.cell_data, n_cells) };
            if !fields.iter().any(|f| f.name == array) {
                fields.push(Field::scalars(array, vec![0u8; n]));
            }
            let field = fields.iter_mut().find(|f| f.name == array);
            if let Some(Field { values: Values::U8(values), .. }) = field {
                values[begin + place] = 1;
            }
        }
        Ok(mesh)
    }
}

/// Ids count from 1. Where the vertices come later, `Mesh::validate` has the last word.
fn vertex_id(id: i64, n_points: Option<usize>, text: &Text<'_>) -> Result<VertexId> {
    let n = n_points.unwrap_or(VertexId::MAX_COUNT);
    match usize::try_from(id).ok().and_then(|id| id.checked_sub(1)).filter(|&place| place < n) {
        Some(place) => Ok(VertexId::new(place)),
        None => Err(text
            .error(format!("a cell names vertex {id}, but there are {n} (1 to {n})"))
            .remedy("the file is damaged: write it again")),
    }
}

fn write(mesh: &Mesh, _: &WriteOptions) -> Result<Written> {
    let section_of = |kind: CellKind| SECTIONS.iter().position(|(_, k, _)| *k == kind);
    let (mesh, mut lost) = keep_cells(mesh, "Medit", |kind| section_of(kind).is_some());
    let labels = cell_labels(&mesh, None);
    if !mesh.cells.kinds().is_sorted_by_key(|&kind| section_of(kind)) {
        lost.push(
            "Medit keeps cells by their kinds: their order in the file differs from that in the mesh".into(),
        );
    }
    say_what_is_lost(&mesh, &labels, &mut lost);
    let mut out = b"MeshVersionFormatted 2\n\nDimension 3\n\n".to_vec();
    write_vertices(&mut out, &mesh);
    for &(name, kind, _) in SECTIONS {
        let places: Vec<usize> = (0..mesh.cells.len()).filter(|&i| mesh.cells.kinds()[i] == kind).collect();
        if places.is_empty() {
            continue;
        }
        line(&mut out, format_args!("\n{name}\n{}", places.len()));
        for &i in &places {
            for v in mesh.cells.connectivity().list(i) {
                write!(out, "{} ", v.0 + 1).expect("writing into memory does not fail");
            }
            line(&mut out, labels[i]);
        }
        write_marks(&mut out, name, |array| marked(mesh.cell_field(array), &places));
    }
    out.extend(b"\nEnd\n");
    Ok(Written { files: vec![(String::new(), out)], lost })
}

fn say_what_is_lost(mesh: &Mesh, labels: &[i32], lost: &mut Vec<String>) {
    let is_mark = |f: &Field| MARKS.iter().any(|(.., array)| *array == f.name);
    let mut other = mesh.clone();
    other.cell_data.retain(|f| !is_mark(f));
    lost.extend(lost_cell_arrays("Medit", &other, labels));
    let has_refs = point_refs(mesh).is_some();
    let points = mesh.point_data.iter().filter(|f| !(is_mark(f) || f.name == "medit:ref" && has_refs));
    lost.extend(lost_arrays("Medit", "point", points));
    lost.extend(lost_arrays("Medit", "field", &mesh.field_data));
    lost.extend(lost_names("Medit", mesh));
}

fn point_refs(mesh: &Mesh) -> Option<Vec<i64>> {
    mesh.point_field("medit:ref").filter(|f| f.components == 1)?.values.to_i64()
}

fn write_vertices(out: &mut Vec<u8>, mesh: &Mesh) {
    line(out, format_args!("Vertices\n{}", mesh.points.len()));
    let refs = point_refs(mesh);
    for (i, point) in mesh.points.iter().enumerate() {
        push_floats(out, point);
        line(out, format_args!(" {}", refs.as_ref().map_or(0, |r| r[i])));
    }
    let places: Vec<usize> = (0..mesh.points.len()).collect();
    write_marks(out, "Vertices", |array| marked(mesh.point_field(array), &places));
}

/// The sections that mark places of section `of`.
fn write_marks(out: &mut Vec<u8>, of: &str, marked: impl Fn(&str) -> Vec<usize>) {
    for (name, _, array) in MARKS.iter().filter(|(_, section, _)| *section == of) {
        let places = marked(array);
        if !places.is_empty() {
            line(out, format_args!("\n{name}\n{}", places.len()));
            places.iter().for_each(|place| line(out, place + 1));
        }
    }
}

/// Which of `places` a field marks, as places among them.
fn marked(field: Option<&Field>, places: &[usize]) -> Vec<usize> {
    let values = field.filter(|f| f.components == 1).and_then(|f| f.values.to_i64()).unwrap_or_default();
    let is_marked = |&(_, &i): &(usize, &usize)| values.get(i).is_some_and(|&v| v != 0);
    places.iter().enumerate().filter(is_marked).map(|(place, _)| place).collect()
}

fn line(out: &mut Vec<u8>, content: impl std::fmt::Display) {
    writeln!(out, "{content}").expect("writing into memory does not fail");
}
