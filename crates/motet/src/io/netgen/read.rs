//! Reads the sections of a file.

use std::collections::HashSet;

use super::Names;
use super::kinds::{MAX_NODES, element};
use super::labels::set_labels;
use crate::base::{Error, Point, Result, VertexId};
use crate::io::format::{Input, Notes};
use crate::io::gzip;
use crate::io::latin::decode_utf8_or_latin1;
use crate::io::text::Text;
use crate::mesh::{CellKind, Cells, Mesh};

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let decompressed = gzip::is_gzip(input.bytes).then(|| gzip::decompress(input.bytes)).transpose()?;
    let mut text = Text::with_comments(decompressed.as_deref().unwrap_or(input.bytes), b'#');
    match text.expect("`mesh3d`")? {
        b"mesh3d" => {}
        word => {
            return Err(text
                .unexpected("the first word", "`mesh3d`", word)
                .remedy("check the format of the file"));
        }
    }
    let mut content = Content { dim: 3, ..Content::default() };
    loop {
        let Some(word) = text.word() else {
            input.notes.add("`endmesh` is missing: the file may be truncated after a section");
            break;
        };
        if word == b"endmesh" {
            break;
        }
        content.section(&mut text, word, input.notes)?;
    }
    content.into_mesh()
}

#[derive(Default)]
struct Content {
    dim: usize,
    points: Option<Vec<Point>>,
    cells: Cells,
    indices: Vec<i32>,
    /// For each descriptor of an edge, the number of the edge.
    edges: Vec<i32>,
    /// Lines whose index is still the place of a descriptor.
    described: Vec<usize>,
    /// Lines that occurred, by their vertices in ascending order.
    known_lines: HashSet<[VertexId; 2]>,
    materials: Names,
    conditions: Names,
}

impl Content {
    fn section(&mut self, text: &mut Text<'_>, name: &[u8], notes: &Notes) -> Result<()> {
        match name {
            b"dimension" => match text.int("dimension")? {
                dim @ 2..=3 => self.dim = dim as usize,
                other => return Err(text.error(format!("expected dimension 2 or 3, found {other}"))),
            },
            b"geomtype" => drop(text.int("type of geometry")?),
            b"surfaceelements" | b"surfaceelementsgi" | b"surfaceelementsuv" => {
                self.surface_elements(text)?
            }
            b"volumeelements" => self.volume_elements(text)?,
            b"edgesegments" | b"edgesegmentsgi" => self.segments(text, Segment::Short)?,
            b"edgesegmentsgi2" => self.segments(text, Segment::Long)?,
            b"edgesegmentsgi3" => self.segments(text, Segment::Described)?,
            b"edgedescriptors" => {
                let n = text.count("descriptors of edges", 1)?;
                for _ in 0..n {
                    self.edges.push(text.int32("number of an edge")?);
                    text.skip_line();
                }
            }
            b"points" => self.points(text)?,
            b"pointelements" => {
                for _ in 0..text.count("point elements", 2)? {
                    text.start_row("a point element")?;
                    let vertex = text.vertex_in_line(1, VertexId::MAX_COUNT)?;
                    self.push(CellKind::VERTEX, [vertex], index(text, "index")?);
                    text.skip_line();
                }
            }
            b"materials" => self.materials = names(text)?,
            b"bcnames" => self.conditions = names(text)?,
            name if name[0].is_ascii_alphabetic() => skip(text, name, notes)?,
            name => {
                return Err(text
                    .unexpected("section", "a name", name)
                    .remedy("the count of the previous section is wrong, or the file is damaged"));
            }
        }
        Ok(())
    }

    fn push(&mut self, kind: CellKind, vertices: impl IntoIterator<Item = VertexId>, index: i32) {
        self.cells.push(kind, vertices);
        self.indices.push(index);
    }

    fn points(&mut self, text: &mut Text<'_>) -> Result<()> {
        if self.points.is_some() {
            return Err(text.error("duplicate section `points`").remedy("write the file again"));
        }
        let n = text.count("points", 3)?;
        let mut points = Vec::with_capacity(n);
        for _ in 0..n {
            points.push(text.point()?);
            text.skip_line();
        }
        self.points = Some(points);
        Ok(())
    }

    /// Reads rows of `surface, condition, domain inside, domain outside, number of nodes, nodes`, which
    /// parameters may follow.
    fn surface_elements(&mut self, text: &mut Text<'_>) -> Result<()> {
        for _ in 0..text.count("surface elements", 8)? {
            text.start_row("a surface element")?;
            text.int_in_line("number of the surface")?;
            let condition = index(text, "boundary condition")?;
            text.int_in_line("domain inside")?;
            text.int_in_line("domain outside")?;
            self.nodes(text, 2, condition)?;
        }
        Ok(())
    }

    /// Reads rows of `material, number of nodes, nodes`.
    fn volume_elements(&mut self, text: &mut Text<'_>) -> Result<()> {
        for _ in 0..text.count("volume elements", 6)? {
            text.start_row("a volume element")?;
            let material = index(text, "material")?;
            self.nodes(text, 3, material)?;
        }
        Ok(())
    }

    fn nodes(&mut self, text: &mut Text<'_>, dim: usize, index: i32) -> Result<()> {
        let n = text.int_in_line("number of nodes")?;
        let Some((kind, order)) = usize::try_from(n).ok().and_then(|n| element(dim, n)) else {
            return Err(text.error(format!("elements of dimension {dim} with {n} nodes are not supported")));
        };
        let mut theirs = [VertexId::default(); MAX_NODES];
        for vertex in &mut theirs[..order.len()] {
            *vertex = text.vertex_in_line(1, VertexId::MAX_COUNT)?;
        }
        text.skip_line();
        self.push(*kind, order.iter().map(|&place| theirs[place]), index);
        Ok(())
    }

    fn segments(&mut self, text: &mut Text<'_>, segment: Segment) -> Result<()> {
        let n_numbers = match segment {
            Segment::Short => 4,
            Segment::Long => 12,
            Segment::Described => 7,
        };
        for _ in 0..text.count("segments of edges", n_numbers)? {
            text.start_row("a segment of an edge")?;
            let (vertices, index) = match segment {
                Segment::Described => {
                    let vertices = segment_vertices(text)?;
                    (0..4).try_for_each(|_| text.float("segment of an edge").map(drop))?;
                    self.described.push(self.cells.len());
                    (vertices, text.int32("descriptor of an edge")?)
                }
                Segment::Short | Segment::Long => {
                    let number = index(text, "number of an edge")?;
                    text.int_in_line("segment of an edge")?;
                    let vertices = segment_vertices(text)?;
                    if segment == Segment::Long {
                        (0..8).try_for_each(|_| text.float("segment of an edge").map(drop))?;
                    }
                    (vertices, number)
                }
            };
            text.skip_line();
            let mut key = vertices;
            key.sort_unstable();
            match self.known_lines.insert(key) || self.dim == 2 {
                true => self.push(CellKind::LINE, vertices, index),
                false if segment == Segment::Described => drop(self.described.pop()),
                false => {}
            }
        }
        Ok(())
    }

    fn into_mesh(mut self) -> Result<Mesh> {
        let points = self.points.ok_or_else(|| {
            Error::input("there is no section `points`")
                .remedy("the file contains no mesh or is truncated: get a new copy")
        })?;
        for &line in &self.described {
            let place = usize::try_from(self.indices[line]).ok();
            self.indices[line] = place.and_then(|place| self.edges.get(place)).copied().unwrap_or(0);
        }
        let mut mesh = Mesh::new(points, self.cells);
        let names = match self.dim {
            2 => [Names::new(), self.materials],
            _ => [self.materials, self.conditions],
        };
        set_labels(&mut mesh, self.indices, names);
        Ok(mesh)
    }
}

/// The forms of segments of edges.
#[derive(Clone, Copy, PartialEq)]
enum Segment {
    /// Number of the edge or boundary condition, a number without meaning, two vertices.
    Short,
    /// Number of the edge or boundary condition, a number without meaning, two vertices, triangles, domains,
    /// and numbers and parameters of the edge on either side.
    Long,
    /// Two vertices, triangles, parameters, and the place of a descriptor.
    Described,
}

fn segment_vertices(text: &mut Text<'_>) -> Result<[VertexId; 2]> {
    Ok([text.vertex_in_line(1, VertexId::MAX_COUNT)?, text.vertex_in_line(1, VertexId::MAX_COUNT)?])
}

fn index(text: &mut Text<'_>, what: &str) -> Result<i32> {
    let n = text.int_in_line(what)?;
    i32::try_from(n).map_err(|_| text.error(format!("{what} {n} does not fit in 32 bits")))
}

/// Reads lines of a number and a name, which may be missing.
fn names(text: &mut Text<'_>) -> Result<Names> {
    let mut names = Names::new();
    for _ in 0..text.count("names", 1)? {
        let number = text.int32("number of a name")?;
        let name = text.line().unwrap_or_default().trim_ascii();
        if !name.is_empty() {
            names.insert(number, decode_utf8_or_latin1(name));
        }
    }
    Ok(names)
}

/// Skips a section that a mesh does not hold: the lines up to the next one that begins with a letter.
fn skip(text: &mut Text<'_>, name: &[u8], notes: &Notes) -> Result<()> {
    let is_of_interest = !matches!(name, b"facedescriptors" | b"face_colours" | b"face_transparencies");
    let mut n_lines = 0;
    while text.peek().is_some_and(|word| !word[0].is_ascii_alphabetic()) {
        text.start_row("a line")?;
        text.line();
        n_lines += 1;
    }
    // The first line is the number of those that follow.
    if is_of_interest && n_lines > 1 {
        notes.add(format!("section `{}` is skipped", String::from_utf8_lossy(name)));
    }
    Ok(())
}
