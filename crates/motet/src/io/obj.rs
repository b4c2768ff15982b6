//! Wavefront OBJ: vertices, points, lines, polygons, and groups as patches.
//!
//! Implemented here because `tobj` (4.0) triangulates everything, duplicates or drops vertices
//! because of texture coordinates, does not report the line of an error, and drops `l` and `p`.
//!
//! A patch is named by the last `o` or `g`; patches exist only if at least two differ. Texture coordinates,
//! normals, materials, smoothing groups and free-form geometry are skipped with a note.

use std::io::Write as _;

use crate::base::{Error, Result, VertexId};
use crate::io::cell_labels::{cell_labels, lost_cell_arrays};
use crate::io::format::{Format, Input, Write, WriteOptions};
use crate::io::output::{Output, write_all};
use crate::io::select::{keep_cells, lost_arrays, surface_of};
use crate::io::text::{Text, parse_float, parse_int, push_floats, quoted};
use crate::mesh::{CellKind, Cells, Field, Mesh};

pub(super) const FORMAT: Format = Format {
    name: "Wavefront OBJ",
    extensions: &[".obj"],
    read: Some(read),
    write: Some(Write::File(write)),
};

#[derive(Default)]
struct Reader {
    points: Vec<[f64; 3]>,
    cells: Cells,
    labels: Vec<i32>,
    names: Vec<String>,
    label: i32,
    /// The largest vertex used before it was defined, and the line of its use.
    forward_reference: Option<(usize, usize)>,
}

fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut text = Text::with_comments(without_zeros(input), b'#');
    let mut reader = Reader::default();
    while let Some(statement) = text.word() {
        match statement {
            b"v" => reader.vertex(&mut text, input)?,
            b"f" => reader.face(&mut text, input)?,
            b"l" => reader.element(&mut text, line_kind)?,
            b"p" => reader.element(&mut text, point_kind)?,
            b"g" | b"o" => reader.group(&mut text),
            _ if is_known(statement) => {
                input.notes.add(format!("statements {} are skipped", quoted(statement)));
                while next_word(&mut text).is_some() {}
            }
            _ => {
                return Err(text
                    .unexpected("statement", "one of Wavefront OBJ (v, f, l, p, g, o, ...)", statement)
                    .remedy("the file is damaged or not an OBJ file: get a new copy"));
            }
        }
    }
    reader.into_mesh()
}

/// The bytes of the file without zeros at its end, which some writers leave there.
fn without_zeros<'a>(input: &Input<'a>) -> &'a [u8] {
    let n = input.bytes.iter().rev().take_while(|byte| **byte == 0).count();
    if n > 0 {
        input.notes.add("zero bytes at the end are skipped");
    }
    &input.bytes[..input.bytes.len() - n]
}

/// Whether this is a statement of the format that is skipped here.
fn is_known(statement: &[u8]) -> bool {
    const KNOWN: &[&str] = &[
        "vn",
        "vt",
        "vp",
        "s",
        "mg",
        "usemtl",
        "mtllib",
        "usemap",
        "maplib",
        "bevel",
        "c_interp",
        "d_interp",
        "lod",
        "shadow_obj",
        "trace_obj",
        "ctech",
        "stech",
        "cstype",
        "deg",
        "bmat",
        "step",
        "curv",
        "curv2",
        "surf",
        "parm",
        "trim",
        "hole",
        "scrv",
        "sp",
        "end",
        "con",
        "call",
        "csh",
    ];
    KNOWN.iter().any(|known| known.as_bytes() == statement)
}

/// The next word of the statement, which a backslash continues on the next line.
fn next_word<'a>(text: &mut Text<'a>) -> Option<&'a [u8]> {
    loop {
        match text.word_in_line() {
            Some(b"\\") => text.line(),
            word => return word,
        };
    }
}

fn face_kind(n: usize) -> Option<CellKind> {
    match n {
        0..3 => None,
        3 => Some(CellKind::TRIANGLE),
        4 => Some(CellKind::QUAD),
        _ => Some(CellKind::POLYGON),
    }
}

fn line_kind(n: usize) -> Option<CellKind> {
    match n {
        0..2 => None,
        2 => Some(CellKind::LINE),
        _ => Some(CellKind::POLY_LINE),
    }
}

fn point_kind(n: usize) -> Option<CellKind> {
    match n {
        0 => None,
        1 => Some(CellKind::VERTEX),
        _ => Some(CellKind::POLY_VERTEX),
    }
}

impl Reader {
    fn vertex(&mut self, text: &mut Text<'_>, input: &Input<'_>) -> Result<()> {
        let mut point = [0.0; 3];
        for x in &mut point {
            let word = next_word(text).ok_or_else(|| {
                text.error("expected three coordinates of a vertex")
                    .remedy("the file is damaged: get a new copy")
            })?;
            *x = parse_float(word).ok_or_else(|| text.unexpected("coordinate", "a number", word))?;
        }
        let mut n_further = 0;
        while next_word(text).is_some() {
            n_further += 1;
        }
        if n_further > 0 {
            input.notes.add("weights and colours after the coordinates of vertices are skipped");
        }
        self.points.push(point);
        Ok(())
    }

    /// A face; one of two vertices encloses nothing and is left out.
    fn face(&mut self, text: &mut Text<'_>, input: &Input<'_>) -> Result<()> {
        let vertices = self.vertices(text)?;
        match vertices.len() {
            2 => input.notes.add("faces of two vertices are left out"),
            _ => self.push(vertices, text, face_kind)?,
        }
        Ok(())
    }

    fn element(&mut self, text: &mut Text<'_>, kind: fn(usize) -> Option<CellKind>) -> Result<()> {
        let vertices = self.vertices(text)?;
        self.push(vertices, text, kind)
    }

    fn vertices(&mut self, text: &mut Text<'_>) -> Result<Vec<VertexId>> {
        let mut vertices = Vec::with_capacity(4);
        while let Some(word) = next_word(text) {
            let id = word.split(|&b| b == b'/').next().unwrap_or_default();
            let id = parse_int(id).ok_or_else(|| text.unexpected("vertex", "a whole number", word))?;
            vertices.push(self.vertex_id(id, text)?);
        }
        Ok(vertices)
    }

    fn push(
        &mut self,
        vertices: Vec<VertexId>,
        text: &Text<'_>,
        kind: fn(usize) -> Option<CellKind>,
    ) -> Result<()> {
        let Some(kind) = kind(vertices.len()) else {
            return Err(text
                .error(format!("too few vertices for this element: {}", vertices.len()))
                .remedy("the file is damaged: get a new copy"));
        };
        self.cells.push(kind, vertices);
        self.labels.push(self.label);
        Ok(())
    }

    /// Converts an id, which counts from 1; negative ones count back from the last vertex defined.
    fn vertex_id(&mut self, id: i64, text: &Text<'_>) -> Result<VertexId> {
        let n = self.points.len();
        let place = if id > 0 { id.checked_sub(1) } else { (n as i64).checked_add(id).filter(|_| id < 0) };
        let place = place.and_then(|place| usize::try_from(place).ok()).filter(|&p| p < VertexId::MAX_COUNT);
        let Some(place) = place else {
            return Err(text
                .error(format!("an element refers to vertex {id}, but {n} vertices precede it"))
                .remedy("vertex ids start at 1; the file is damaged: get a new copy"));
        };
        if place >= n && self.forward_reference.is_none_or(|(largest, _)| place > largest) {
            self.forward_reference = Some((place, text.line_number()));
        }
        Ok(VertexId::new(place))
    }

    fn group(&mut self, text: &mut Text<'_>) {
        let mut words = Vec::new();
        while let Some(word) = next_word(text) {
            words.push(String::from_utf8_lossy(word));
        }
        let name = words.join(" ");
        let known = self.names.iter().position(|known| *known == name);
        if known.is_none() {
            self.names.push(name);
        }
        self.label = known.map_or(self.names.len(), |i| i + 1) as i32;
    }

    fn into_mesh(self) -> Result<Mesh> {
        if let Some((place, line)) = self.forward_reference.filter(|(place, _)| *place >= self.points.len()) {
            return Err(Error::input(format!(
                "an element refers to vertex {}, but the file has {} vertices",
                place + 1,
                self.points.len()
            ))
            .at(format!("line {line}"))
            .remedy("the file is truncated or damaged: get a new copy"));
        }
        if self.points.is_empty() {
            return Err(Error::input("the file contains no vertices").remedy("export the surface again"));
        }
        let mut mesh = Mesh::new(self.points, self.cells);
        if self.labels.iter().any(|&label| label != self.labels[0]) {
            mesh.set_cell_field(Field::scalars("patch", self.labels));
            let named = (1..).zip(self.names).filter(|(_, name)| !name.is_empty());
            mesh.label_names.patches = named.collect();
        }
        Ok(mesh)
    }
}

fn write(mesh: &Mesh, _: &WriteOptions, output: &mut Output<'_>) -> Result<Vec<String>> {
    let (surface, boundary_only) = surface_of(mesh, "OBJ");
    let (mesh, mut lost) = keep_cells(&surface, "OBJ", |kind| statement(kind).is_some());
    lost.extend(boundary_only);
    let labels = cell_labels(&mesh, None);
    let names = mesh.patches().map(|p| p.names).unwrap_or_default();
    lost.extend(lost_arrays("OBJ", "point", &mesh.point_data));
    lost.extend(lost_cell_arrays("OBJ", &mesh, &labels));
    lost.extend(lost_arrays("OBJ", "field", &mesh.field_data));
    let mut out = Vec::new();
    for point in &mesh.points {
        out.extend(b"v ");
        push_floats(&mut out, point);
        out.push(b'\n');
    }
    let mut group = 0;
    for (cell, kind, vertices) in mesh.cells.iter() {
        let label = labels[cell.index()];
        if label != group {
            let name =
                names.get(&label).map_or_else(|| label.to_string(), |n| n.replace(['\n', '\r', '#'], " "));
            writeln!(out, "g {name}").expect("writing into memory does not fail");
            group = label;
        }
        out.extend(statement(kind).expect("other kinds were removed").as_bytes());
        for v in vertices {
            write!(out, " {}", v.0 + 1).expect("writing into memory does not fail");
        }
        out.push(b'\n');
    }
    write_all(output, &out)?;
    Ok(lost)
}

fn statement(kind: CellKind) -> Option<&'static str> {
    match kind {
        CellKind::TRIANGLE | CellKind::QUAD | CellKind::POLYGON => Some("f"),
        CellKind::LINE | CellKind::POLY_LINE => Some("l"),
        CellKind::VERTEX | CellKind::POLY_VERTEX => Some("p"),
        _ => None,
    }
}
