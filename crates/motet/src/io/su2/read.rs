//! Reads points, elements and markers.

use std::collections::HashMap;

use super::{KINDS, TAG, order_of};
use crate::base::{Error, Result, VertexId};
use crate::io::format::{Input, Notes};
use crate::io::label_numbers::{bare_number, numbers};
use crate::io::latin::decode_utf8_or_latin1;
use crate::io::text::{Text, find, quoted};
use crate::mesh::{CellKind, Cells, Field, Mesh};

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut file = File { text: Text::with_comments(input.bytes, b'%'), content: Content::default() };
    while let Some(key) = file.key()? {
        file.entry(&key, input.notes)?;
    }
    file.finish()
}

struct File<'a> {
    text: Text<'a>,
    content: Content,
}

#[derive(Default)]
struct Content {
    dim: usize,
    points: Option<Vec<[f64; 3]>>,
    /// The cells of `NELEM`.
    elements: Option<Cells>,
    /// Number of markers that the file declares.
    n_markers: Option<usize>,
    /// Names of markers, in the order of the file.
    markers: Vec<String>,
    /// The cells of all markers.
    marked: Cells,
    /// For each of these, the place of its marker.
    of_marker: Vec<usize>,
    /// Whether the last key is not known, so that the lines after it are not, either.
    is_skipping: bool,
}

impl File<'_> {
    /// Reads `KEY=`; `None` at the end of the file.
    fn key(&mut self) -> Result<Option<String>> {
        loop {
            let Some(word) = self.text.word() else { return Ok(None) };
            self.text.set_position(self.text.position() - word.len());
            let rest = self.text.rest();
            let line = &rest[..find(rest, b'\n').unwrap_or(rest.len())];
            let line = &line[..find(line, b'%').unwrap_or(line.len())];
            match find(line, b'=') {
                Some(at) => {
                    self.text.set_position(self.text.position() + at + 1);
                    self.content.is_skipping = false;
                    let key = String::from_utf8_lossy(line[..at].trim_ascii());
                    return Ok(Some(key.to_ascii_uppercase()));
                }
                None if self.content.is_skipping => self.text.skip_line(),
                None => {
                    return Err(self
                        .text
                        .unexpected("line", "`KEY= value`", line.trim_ascii())
                        .remedy("the count of the previous list is wrong, or the file is damaged"));
                }
            }
        }
    }

    fn entry(&mut self, key: &str, notes: &Notes) -> Result<()> {
        match key {
            "NDIME" => self.dimension()?,
            "NPOIN" => self.points()?,
            "NELEM" => self.elements()?,
            "NMARK" => self.content.n_markers = Some(self.text.count("markers", 1)?),
            "MARKER_TAG" => return self.marker(),
            "MARKER_ELEMS" => self.marker_elements()?,
            "NZONE" => match self.text.int("number of zones")? {
                1 => {}
                n => return Err(self.zones(format!("the file has {n} zones"))),
            },
            "IZONE" => {}
            key => {
                notes.add(format!("{} is skipped", quoted(key.as_bytes())));
                self.content.is_skipping = true;
            }
        }
        self.text.skip_line();
        Ok(())
    }

    fn zones(&self, what: String) -> Error {
        self.text
            .error(format!("{what}, of which a mesh holds one"))
            .remedy("write each zone into a file of its own")
    }

    fn dimension(&mut self) -> Result<()> {
        match self.text.int("dimension")? {
            dim @ 2..=3 => self.content.dim = dim as usize,
            other => return Err(self.text.error(format!("expected dimension 2 or 3, found {other}"))),
        }
        Ok(())
    }

    fn required_dim(&self, what: &str) -> Result<usize> {
        match self.content.dim {
            0 => Err(self.text.error(format!("{what} precede the dimension")).remedy("put NDIME first")),
            dim => Ok(dim),
        }
    }

    /// Reads the points; a number of points of the mesh's own may follow their number, and the number of a
    /// point its coordinates.
    fn points(&mut self) -> Result<()> {
        let dim = self.required_dim("points")?;
        if self.content.points.is_some() {
            return Err(self.zones("NPOIN occurs twice: there are several zones".into()));
        }
        let n = self.text.count("points", dim)?;
        self.text.skip_line();
        let mut points = Vec::with_capacity(n);
        for _ in 0..n {
            self.text.start_row("a point")?;
            let mut point = [0.0; 3];
            for x in &mut point[..dim] {
                *x = self.text.float_in_line("coordinate")?;
            }
            self.text.skip_line();
            points.push(point);
        }
        self.content.points = Some(points);
        Ok(())
    }

    fn elements(&mut self) -> Result<()> {
        let dim = self.required_dim("elements")?;
        if self.content.elements.is_some() {
            return Err(self.zones("NELEM occurs twice: there are several zones".into()));
        }
        let mut cells = Cells::new();
        self.rows(&KINDS[dim..=dim], &mut cells)?;
        self.content.elements = Some(cells);
        Ok(())
    }

    /// Reads a number, then so many elements of the given kinds.
    fn rows(&mut self, kinds: &[&[CellKind]], cells: &mut Cells) -> Result<()> {
        let n = self.text.count("elements", 2)?;
        self.text.skip_line();
        let n_points = self.content.points.as_ref().map_or(VertexId::MAX_COUNT, Vec::len);
        let mut vertices = [VertexId::default(); 8];
        for _ in 0..n {
            self.text.start_row("an element")?;
            let number = self.text.int_in_line("type of an element")?;
            let kind = kinds.iter().copied().flatten().find(|kind| i64::from(kind.0) == number);
            let kind = *kind.ok_or_else(|| {
                let known: Vec<_> =
                    kinds.iter().copied().flatten().map(|k| format!("{} ({})", k.0, k.label())).collect();
                self.text.error(format!("expected an element type {}, found {number}", known.join(", ")))
            })?;
            let order = order_of(kind);
            for vertex in &mut vertices[..order.len()] {
                *vertex = self.text.vertex_in_line(0, n_points)?;
            }
            self.end_row()?;
            cells.push(kind, order.iter().map(|&place| vertices[place]));
        }
        Ok(())
    }

    /// Reads the number of the element, which may stand at the end.
    fn end_row(&mut self) -> Result<()> {
        if self.text.word_in_line().is_some()
            && let Some(word) = self.text.word_in_line()
        {
            return Err(self
                .text
                .unexpected("element", "the end of the line", word)
                .remedy("the element has more vertices than its type, or the file is damaged"));
        }
        Ok(())
    }

    fn marker(&mut self) -> Result<()> {
        let start = self.text.rest();
        let begin = self.text.position();
        self.text.skip_line();
        let line = &start[..self.text.position() - begin];
        let name = line[..find(line, b'%').unwrap_or(line.len())].trim_ascii();
        if name.is_empty() {
            return Err(self.text.error("expected the name of a marker, found the end of the line"));
        }
        if name.eq_ignore_ascii_case(b"SEND_RECEIVE") {
            return Err(self
                .text
                .error("the file is a part of a partitioned mesh, which has no boundary of its own")
                .remedy("read the whole mesh"));
        }
        self.content.markers.push(decode_utf8_or_latin1(name));
        Ok(())
    }

    fn marker_elements(&mut self) -> Result<()> {
        let dim = self.required_dim("markers")?;
        let Some(marker) = self.content.markers.len().checked_sub(1) else {
            return Err(self.text.error("MARKER_ELEMS precedes the first MARKER_TAG"));
        };
        let mut cells = std::mem::take(&mut self.content.marked);
        self.rows(&KINDS[..dim], &mut cells)?;
        self.content.of_marker.resize(cells.len(), marker);
        self.content.marked = cells;
        Ok(())
    }

    fn finish(self) -> Result<Mesh> {
        let Content { points, elements, marked, n_markers, markers, of_marker, .. } = self.content;
        let points = points.ok_or_else(|| {
            Error::input("there are no points (NPOIN)")
                .remedy("the file contains no mesh or is truncated: get a new copy")
        })?;
        if let Some(n) = n_markers.filter(|&n| n > markers.len()) {
            return Err(self
                .text
                .error(format!("{n} markers declared, but the file has {}", markers.len()))
                .remedy("the file is truncated or damaged: get a new copy"));
        }
        let mut cells = elements.unwrap_or_default();
        let n_elements = cells.len();
        marked.iter().for_each(|(_, kind, vertices)| cells.push(kind, vertices.iter().copied()));
        let mut mesh = Mesh::new(points, cells);
        set_tags(&mut mesh, n_elements, &markers, &of_marker);
        Ok(mesh)
    }
}

/// Numbers the markers, equal names alike, and sets the array of their numbers.
fn set_tags(mesh: &mut Mesh, n_elements: usize, markers: &[String], of_marker: &[usize]) {
    let mut place_of: HashMap<&str, usize> = HashMap::new();
    let mut names: Vec<&str> = Vec::new();
    let mut place = |name| {
        *place_of.entry(name).or_insert_with(|| {
            names.push(name);
            names.len() - 1
        })
    };
    let places: Vec<usize> = markers.iter().map(|name| place(name.as_str())).collect();
    let numbers = numbers(&names, "");
    let named = names.iter().zip(&numbers).filter(|(name, number)| bare_number(name, "") != Some(**number));
    mesh.label_names.patches = named.map(|(name, &number)| (number, (*name).to_owned())).collect();
    if !of_marker.is_empty() {
        let mut tags = vec![0; n_elements];
        tags.extend(of_marker.iter().map(|&marker| numbers[places[marker]]));
        mesh.set_cell_field(Field::scalars(TAG, tags));
    }
}
