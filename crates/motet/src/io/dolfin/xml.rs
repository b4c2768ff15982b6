//! The content of a DOLFIN XML file before conversion to a mesh.

use std::str::FromStr;

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use crate::base::{Error, Point, Result};
use crate::io::Notes;
use crate::io::text::{parse_float, quoted};

/// Minimum length of a list element in bytes, such as `<value i="0"/>`.
const MIN_ELEMENT_BYTES: usize = 12;

/// Cell types: the name in the file and the number of vertices.
const CELL_TYPES: &[(&str, usize)] = &[
    ("point", 1),
    ("interval", 2),
    ("triangle", 3),
    ("tetrahedron", 4),
    ("quadrilateral", 4),
    ("hexahedron", 8),
];

/// A mesh and its marks as stored in the file.
#[derive(Default)]
pub(super) struct Document {
    pub(super) cell_type: String,
    pub(super) points: Vec<Point>,
    /// Vertices of all cells, concatenated.
    pub(super) vertices: Vec<u32>,
    pub(super) n_vertices: usize,
    pub(super) collections: Vec<Collection>,
}

/// Marks on entities of one dimension.
#[derive(Default)]
pub(super) struct Collection {
    pub(super) dim: usize,
    pub(super) name: String,
    /// Whether entities are given by a cell and a local index, rather than by their own number.
    pub(super) by_cell: bool,
    /// Cell or entity, local index in the cell, mark.
    pub(super) marks: Vec<[i64; 3]>,
}

/// The list that is open, which receives its elements.
#[derive(Clone, Copy, PartialEq)]
enum List {
    None,
    Vertices { n: usize },
    Cells { n: usize },
    Marks { n: usize },
}

struct Parser<'a> {
    bytes: &'a [u8],
    at: usize,
    notes: &'a Notes,
    document: Document,
    list: List,
    /// Number of cells read so far; cells are in ascending order.
    n_cells: usize,
    data_name: String,
    seen_mesh: bool,
    seen_function: bool,
}

/// Parses a DOLFIN XML file.
pub(super) fn parse(bytes: &[u8], notes: &Notes) -> Result<Document> {
    let mut parser = Parser {
        bytes,
        at: 0,
        notes,
        document: Document::default(),
        list: List::None,
        n_cells: 0,
        data_name: String::new(),
        seen_mesh: false,
        seen_function: false,
    };
    let mut reader = Reader::from_reader(bytes);
    let mut depth = 0usize;
    loop {
        let event = reader.read_event();
        parser.at = usize::try_from(reader.buffer_position()).unwrap_or(bytes.len()).min(bytes.len());
        match event {
            Ok(Event::Start(e)) => {
                parser.open(&e, depth)?;
                depth += 1;
            }
            Ok(Event::Empty(e)) => {
                parser.open(&e, depth)?;
                parser.close(e.name().as_ref())?;
            }
            Ok(Event::End(e)) => {
                parser.close(e.name().as_ref())?;
                depth = depth.saturating_sub(1);
            }
            Ok(Event::Eof) => break,
            Ok(_) => {}
            Err(e) => return Err(parser.error(format!("not well-formed XML: {e}")).remedy(TRUNCATED)),
        }
    }
    if depth > 0 {
        return Err(parser.error("the file ends before all elements are closed").remedy(TRUNCATED));
    }
    parser.finish()
}

const TRUNCATED: &str = "the file is truncated or damaged: get a new copy";

impl Parser<'_> {
    fn open(&mut self, e: &BytesStart<'_>, depth: usize) -> Result<()> {
        match (e.name().as_ref(), self.list) {
            ("dolfin", _) if depth == 0 => {}
            (name, _) if depth == 0 => {
                return Err(self
                    .error(format!("expected root element `dolfin`, found {}", quoted(name.as_bytes())))
                    .remedy("files with this extension must be DOLFIN XML"));
            }
            ("mesh", _) => self.open_mesh(e)?,
            ("vertices", _) => {
                let n = self.size(e, "vertices")?;
                self.document.points = vec![[0.0; 3]; n];
                self.list = List::Vertices { n: 0 };
            }
            ("cells", _) => {
                let n = self.size(e, "cells")?;
                self.document.vertices = vec![0; n * self.document.n_vertices];
                self.list = List::Cells { n };
            }
            ("data_entry", _) => self.data_name = self.text(e, "name")?.unwrap_or_default(),
            ("mesh_value_collection", _) => self.open_collection(e, true)?,
            ("mesh_function" | "meshfunction", _) => self.open_collection(e, false)?,
            ("vertex", List::Vertices { n }) => self.vertex(e, n)?,
            ("value" | "entity", List::Marks { n }) => self.mark(e, n)?,
            (name, List::Cells { n }) if name == self.document.cell_type => self.cell(e, n)?,
            (name, List::None) => {
                if !matches!(name, "domains" | "data") {
                    self.notes.add(format!("element {} is skipped", quoted(name.as_bytes())));
                }
            }
            (name, _) => {
                return Err(self.error(format!("unexpected element {}", quoted(name.as_bytes()))));
            }
        }
        Ok(())
    }

    fn close(&mut self, name: &str) -> Result<()> {
        let (found, expected) = match (name, self.list) {
            ("vertices", List::Vertices { n }) => (n, self.document.points.len()),
            ("cells", List::Cells { n }) => (self.n_cells, n),
            ("mesh_value_collection" | "mesh_function" | "meshfunction", List::Marks { n }) => {
                (self.document.collections.last().map_or(0, |c| c.marks.len()), n)
            }
            _ => return Ok(()),
        };
        self.list = List::None;
        if found != expected {
            return Err(self.error(format!("{expected} elements declared, {found} found")).remedy(TRUNCATED));
        }
        Ok(())
    }

    fn open_mesh(&mut self, e: &BytesStart<'_>) -> Result<()> {
        if self.seen_mesh {
            return Err(self
                .error("expected one mesh, found a second")
                .remedy("write each mesh to its own file"));
        }
        self.seen_mesh = true;
        let cell_type = self.text(e, "celltype")?.unwrap_or_default();
        let Some(&(name, n)) = CELL_TYPES.iter().find(|(name, _)| *name == cell_type) else {
            return Err(self.error(format!("cell type {} is not supported", quoted(cell_type.as_bytes()))));
        };
        self.document.cell_type = name.to_owned();
        self.document.n_vertices = n;
        Ok(())
    }

    fn open_collection(&mut self, e: &BytesStart<'_>, by_cell: bool) -> Result<()> {
        self.seen_function = true;
        let n = self.size(e, "values")?;
        let dim = self.number::<usize>(e, "dim")?;
        let own_name = self.text(e, "name")?;
        let name = own_name.unwrap_or_else(|| std::mem::take(&mut self.data_name));
        self.document.collections.push(Collection { dim, name, by_cell, marks: Vec::with_capacity(n) });
        self.list = List::Marks { n };
        Ok(())
    }

    fn vertex(&mut self, e: &BytesStart<'_>, n: usize) -> Result<()> {
        let index = self.number::<usize>(e, "index")?;
        let [x, y, z] = [self.coordinate(e, "x")?, self.coordinate(e, "y")?, self.coordinate(e, "z")?];
        let n_points = self.document.points.len();
        match self.document.points.get_mut(index) {
            Some(point) if index == n => *point = [x.unwrap_or(0.0), y.unwrap_or(0.0), z.unwrap_or(0.0)],
            _ => return Err(self.out_of_order("vertex", index, n, n_points)),
        }
        self.list = List::Vertices { n: n + 1 };
        Ok(())
    }

    fn cell(&mut self, e: &BytesStart<'_>, n_cells: usize) -> Result<()> {
        let index = self.number::<usize>(e, "index")?;
        if index != self.n_cells || index >= n_cells {
            return Err(self.out_of_order("cell", index, self.n_cells, n_cells));
        }
        const NAMES: [&str; 8] = ["v0", "v1", "v2", "v3", "v4", "v5", "v6", "v7"];
        let n = self.document.n_vertices;
        for (k, name) in NAMES.iter().enumerate().take(n) {
            let vertex = self.number::<u32>(e, name)?;
            if vertex as usize >= self.document.points.len() {
                return Err(self
                    .error(format!(
                        "cell {index} refers to vertex {vertex}, but there are {} vertices, numbered from 0",
                        self.document.points.len()
                    ))
                    .remedy("the file is damaged: write it again"));
            }
            self.document.vertices[index * n + k] = vertex;
        }
        self.n_cells += 1;
        Ok(())
    }

    fn mark(&mut self, e: &BytesStart<'_>, n: usize) -> Result<()> {
        let by_cell = self.document.collections.last().is_some_and(|c| c.by_cell);
        let (entity, place) = if by_cell {
            (self.number::<i64>(e, "cell_index")?, self.number::<i64>(e, "local_entity")?)
        } else {
            (self.number::<i64>(e, "index")?, 0)
        };
        let value = self.mark_value(e)?;
        let Some(collection) = self.document.collections.last_mut().filter(|c| c.marks.len() < n) else {
            return Err(self.error(format!("{n} values declared, but there are more")).remedy(TRUNCATED));
        };
        collection.marks.push([entity, place, value]);
        Ok(())
    }

    /// The value of a mark. DOLFIN writes the largest number for unset marks; they become 0.
    fn mark_value(&self, e: &BytesStart<'_>) -> Result<i64> {
        let text = self.required_attribute(e, "value")?;
        if matches!(&*text, "18446744073709551615" | "4294967295") {
            return Ok(0);
        }
        let truth = match &*text {
            "true" => Some(1),
            "false" => Some(0),
            _ => None,
        };
        // Real-valued marks that are integers are accepted.
        let real = || parse_float(text.as_bytes()).filter(|x| *x == f64::from(*x as i32)).map(|x| x as i64);
        truth.or_else(|| text.parse().ok()).or_else(real).ok_or_else(|| {
            self.error(format!("mark: expected a whole number, found {}", quoted(text.as_bytes())))
        })
    }

    fn out_of_order(&self, what: &str, index: usize, expected: usize, n: usize) -> Error {
        self.error(format!("expected {what} {expected} of {n}, found {what} {index}"))
            .remedy("number them consecutively from 0")
    }

    fn finish(self) -> Result<Document> {
        if !self.seen_mesh {
            let error = self.error("the file contains no mesh");
            return Err(if self.seen_function {
                error.remedy("it contains marks on a mesh: give the mesh file")
            } else {
                error.remedy(TRUNCATED)
            });
        }
        Ok(self.document)
    }

    /// The declared number of elements, checked against the remaining bytes of the file.
    fn size(&self, e: &BytesStart<'_>, what: &str) -> Result<usize> {
        let n = self.number::<u64>(e, "size")?;
        let room = (self.bytes.len() - self.at) / MIN_ELEMENT_BYTES;
        usize::try_from(n).ok().filter(|n| *n <= room).ok_or_else(|| {
            self.error(format!("{n} {what} declared, but the rest of the file can hold at most {room}"))
                .remedy(TRUNCATED)
        })
    }

    fn text(&self, e: &BytesStart<'_>, name: &str) -> Result<Option<String>> {
        let attribute = e
            .try_get_attribute(name)
            .map_err(|error| self.error(format!("not well-formed XML: {error}")).remedy(TRUNCATED))?;
        let Some(attribute) = attribute else { return Ok(None) };
        let value = quick_xml::escape::unescape(&attribute.value)
            .map_err(|error| self.error(format!("not well-formed XML: {error}")))?;
        Ok(Some(value.into_owned()))
    }

    fn required_attribute(&self, e: &BytesStart<'_>, name: &str) -> Result<String> {
        self.text(e, name)?.ok_or_else(|| {
            self.error(format!("element {} has no attribute `{name}`", quoted(e.name().as_ref().as_bytes())))
                .remedy(TRUNCATED)
        })
    }

    fn number<T: FromStr>(&self, e: &BytesStart<'_>, name: &str) -> Result<T> {
        let text = self.required_attribute(e, name)?;
        text.parse().map_err(|_| {
            self.error(format!(
                "attribute `{name}`: expected a whole number, found {}",
                quoted(text.as_bytes())
            ))
        })
    }

    fn coordinate(&self, e: &BytesStart<'_>, name: &str) -> Result<Option<f64>> {
        let Some(text) = self.text(e, name)? else { return Ok(None) };
        match parse_float(text.as_bytes()) {
            Some(x) => Ok(Some(x)),
            None => Err(self
                .error(format!("coordinate `{name}`: expected a number, found {}", quoted(text.as_bytes())))),
        }
    }

    fn error(&self, what: impl Into<String>) -> Error {
        let line = 1 + self.bytes[..self.at].iter().filter(|&&b| b == b'\n').count();
        Error::input(what).at(format!("line {line}"))
    }
}
