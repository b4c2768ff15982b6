//! The contents of the sections of a file, in the order of the file.

use super::solution::Solution;
use super::source::{Source, is_end};
use super::{DIMENSION, SECTIONS, Section};
use crate::base::{Result, VertexId};
use crate::io::format::Notes;
use crate::io::text::quoted;
use crate::mesh::{CellKind, Cells};

/// Everything in a file.
#[derive(Default)]
pub(super) struct Content {
    pub(super) dim: usize,
    pub(super) points: Option<Vec<[f64; 3]>>,
    pub(super) point_refs: Vec<i32>,
    pub(super) cells: Cells,
    pub(super) cell_refs: Vec<i32>,
    /// Marked entities: index in [`SECTIONS`], array, index in the section.
    pub(super) marks: Vec<(usize, &'static str, usize)>,
    pub(super) solutions: Vec<Solution>,
}

/// Maximum number of vertices of a cell.
const MAX_CELL_VERTICES: usize = 10;

impl Content {
    /// Reads a file.
    pub(super) fn read(bytes: &[u8], notes: &Notes) -> Result<Self> {
        let mut source = Source::new(bytes)?;
        let mut content = Self::default();
        loop {
            let Some(name) = source.section()? else {
                notes.add("`End` is missing: the file may be truncated after a section");
                break;
            };
            if is_end(&name) {
                break;
            }
            content.section(&mut source, &name, notes)?;
        }
        Ok(content)
    }

    fn section(&mut self, source: &mut Source<'_>, name: &str, notes: &Notes) -> Result<()> {
        if name == DIMENSION.name {
            match source.fixed_i32("dimension")? {
                dim @ 2..=3 => self.dim = dim as usize,
                other => return Err(source.error(format!("expected dimension 2 or 3, found {other}"))),
            }
            return source.end_section();
        }
        for (i, section) in SECTIONS.iter().enumerate() {
            if section.list.name == name {
                match section.cells {
                    None => self.vertices(source)?,
                    Some((kind, n)) => self.elements(source, section, kind, n)?,
                }
                return source.end_section();
            }
            if section.values.as_ref().is_some_and(|values| values.name == name) {
                self.require_dim(source, name)?;
                self.solutions.push(Solution::read(source, i, self.dim)?);
                return source.end_section();
            }
            if let Some((_, array)) = section.marks.iter().find(|(keyword, _)| keyword.name == name) {
                self.read_marks(source, name, i, array)?;
                return source.end_section();
            }
        }
        let name = quoted(name.as_bytes());
        notes.add(format!("section {name} is skipped: a mesh cannot hold it"));
        source.skip_section();
        Ok(())
    }

    fn require_dim(&self, source: &Source<'_>, what: &str) -> Result<()> {
        if self.dim == 0 {
            return Err(source
                .error(format!("{} precede the dimension", what.to_lowercase()))
                .remedy("write the file again"));
        }
        Ok(())
    }

    fn vertices(&mut self, source: &mut Source<'_>) -> Result<()> {
        self.require_dim(source, "vertices")?;
        if self.points.is_some() {
            return Err(source.error("duplicate section Vertices").remedy("write the file again"));
        }
        let n = source.count("vertices", 1, self.dim)?;
        let mut points = Vec::with_capacity(n);
        self.point_refs.reserve(n);
        for _ in 0..n {
            let mut point = [0.0; 3];
            for x in &mut point[..self.dim] {
                *x = source.float("vertex coordinate")?;
            }
            points.push(point);
            self.point_refs.push(source.int32("vertex reference")?);
        }
        self.points = Some(points);
        Ok(())
    }

    fn elements(
        &mut self,
        source: &mut Source<'_>,
        section: &Section,
        kind: CellKind,
        n: usize,
    ) -> Result<()> {
        let n_cells = source.count(section.list.name, n + 1, 0)?;
        let n_points = self.points.as_ref().map(Vec::len);
        let mut vertices = [VertexId::default(); MAX_CELL_VERTICES];
        for _ in 0..n_cells {
            for vertex in &mut vertices[..n] {
                let id = source.int("cell vertex")?;
                *vertex = vertex_id(id, n_points, source)?;
            }
            self.cells.push(kind, vertices[..n].iter().copied());
            self.cell_refs.push(source.int32("cell reference")?);
        }
        Ok(())
    }

    fn read_marks(
        &mut self,
        source: &mut Source<'_>,
        name: &str,
        of: usize,
        array: &'static str,
    ) -> Result<()> {
        for _ in 0..source.count(name, 1, 0)? {
            let id = source.int("marked entity")?;
            let place = usize::try_from(id).ok().and_then(|id| id.checked_sub(1));
            let place = place.ok_or_else(|| {
                source.error(format!("{name}: {id} is not a valid number: numbering starts at 1"))
            })?;
            self.marks.push((of, array, place));
        }
        Ok(())
    }
}

/// Converts an id, which counts from 1. If the vertices come later in the file, `Mesh::validate` checks the
/// upper bound.
fn vertex_id(id: i64, n_points: Option<usize>, source: &Source<'_>) -> Result<VertexId> {
    let n = n_points.unwrap_or(VertexId::MAX_COUNT);
    match usize::try_from(id).ok().and_then(|id| id.checked_sub(1)).filter(|&place| place < n) {
        Some(place) => Ok(VertexId::new(place)),
        None => Err(source
            .error(format!("a cell refers to vertex {id}, but there are {n} vertices, numbered from 1"))
            .remedy("the file is damaged: write it again")),
    }
}
