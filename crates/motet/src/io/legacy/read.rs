//! Assembles the sections of a legacy VTK file into a mesh.

use crate::base::{Csr, Error, Result, VertexId};
use crate::io::format::{Input, Notes};
use crate::io::labels::extract_label_names;
use crate::io::legacy::arrays::{Type, decode, skip_metadata, values};
use crate::io::legacy::source::{Source, truncated};
use crate::io::polygonal::{SECTIONS, kind_in_section};
use crate::io::polyhedra::next_polyhedron;
use crate::io::scalar::{Scalar, to_ids, to_points};
use crate::io::surplus_points::trim;
use crate::mesh::{CellKind, Cells, Field, Mesh, Values};

const TABLES: &str = "lookup tables are skipped: colours are not part of a mesh";
const NAMES: &str = "names of array components are skipped";

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut source = Source::new(input.bytes);
    let grid = read_header(&mut source)?;
    let mut reader =
        Reader { source, notes: input.notes, mesh: Mesh::default(), lists: Default::default(), kinds: None };
    reader.read_sections(grid)?;
    let mut mesh = reader.mesh;
    extract_label_names(&mut mesh);
    Ok(mesh)
}

/// Reads the header; returns whether the file holds an unstructured grid, rather than polygonal data.
fn read_header(source: &mut Source<'_>) -> Result<bool> {
    let first = source.line().unwrap_or_default();
    if !first.to_ascii_lowercase().starts_with(b"# vtk datafile version") {
        let xml = first.trim_ascii_start().starts_with(b"<");
        return Err(Error::input("expected `# vtk DataFile Version ...` as the first line")
            .at("line 1")
            .remedy(if xml {
                "this is an XML file: give it the extension .vtu or .vtp"
            } else {
                "this is not a legacy VTK file: give it the extension of its format"
            }));
    }
    source.line();
    source.binary = match source.text("ASCII or BINARY")?.to_ascii_uppercase().as_str() {
        "ASCII" => false,
        "BINARY" => true,
        other => {
            return Err(source.error(format!("expected ASCII or BINARY, found `{}`", truncated(other))));
        }
    };
    let word = source.text("DATASET")?;
    if !word.eq_ignore_ascii_case("DATASET") {
        return Err(source.error(format!("expected DATASET, found `{}`", truncated(word))));
    }
    match source.text("the kind of data set")?.to_ascii_uppercase().as_str() {
        "UNSTRUCTURED_GRID" => Ok(true),
        "POLYDATA" => Ok(false),
        other => {
            Err(Error::input(format!("expected UNSTRUCTURED_GRID or POLYDATA, found {}", truncated(other)))
                .at(source.place())
                .remedy("convert it to .vtu: in ParaView, apply `Append Datasets` (vtkAppendFilter)"))
        }
    }
}

/// What the next arrays belong to.
#[derive(Clone, Copy)]
enum AttributeTarget {
    Mesh,
    Points,
    Cells,
}

struct Reader<'a> {
    source: Source<'a>,
    notes: &'a Notes,
    mesh: Mesh,
    /// Cells by section of polygonal data; those of a grid are all in the first list.
    lists: [Csr<VertexId>; 4],
    kinds: Option<Vec<CellKind>>,
}

impl Reader<'_> {
    fn read_sections(&mut self, grid: bool) -> Result<()> {
        let mut owner = AttributeTarget::Mesh;
        let mut cells_done = false;
        while !self.source.peek().is_empty() {
            let word = self.source.text("a section")?.to_ascii_uppercase();
            match word.as_str() {
                "POINTS" => self.read_points()?,
                "CELLS" if grid => self.lists[0] = self.read_lists()?,
                "CELL_TYPES" if grid => self.read_kinds()?,
                "VERTICES" | "LINES" | "POLYGONS" | "TRIANGLE_STRIPS" if !grid => {
                    let section = SECTIONS.iter().position(|(_, legacy)| *legacy == word).unwrap_or_default();
                    self.lists[section] = self.read_lists()?;
                }
                "POINT_DATA" | "CELL_DATA" => {
                    if !std::mem::replace(&mut cells_done, true) {
                        self.build_cells(grid)?;
                    }
                    owner =
                        if word == "POINT_DATA" { AttributeTarget::Points } else { AttributeTarget::Cells };
                    self.check_count(&word, owner)?;
                }
                _ => self.read_attribute(&word, owner)?,
            }
        }
        if cells_done { Ok(()) } else { self.build_cells(grid) }
    }

    fn read_points(&mut self) -> Result<()> {
        let n = self.source.count("the number of points")?;
        let kind = self.read_type()?;
        if n > VertexId::MAX_COUNT {
            return Err(self.source.error(format!("{n} points are more than a mesh can hold")));
        }
        let values = values(&mut self.source, kind, 3 * n)?;
        self.mesh.points =
            to_points(values).ok_or_else(|| self.source.error("point coordinates are text, not numbers"))?;
        self.skip_metadata(3);
        Ok(())
    }

    fn read_type(&mut self) -> Result<Type> {
        let word = self.source.text("a value type")?;
        Type::parse(&self.source, word)
    }

    fn skip_metadata(&mut self, components: usize) {
        if skip_metadata(&mut self.source, components) {
            self.notes.add(NAMES);
        }
    }

    /// Reads lists of ids, in either layout.
    fn read_lists(&mut self) -> Result<Csr<VertexId>> {
        let n = self.source.count("the number of cells")?;
        let size = self.source.count("the size of the list of cells")?;
        if self.source.peek().eq_ignore_ascii_case(b"OFFSETS") {
            let offsets = self.read_named_ids("OFFSETS", n)?;
            let ids = self.read_named_ids("CONNECTIVITY", size)?;
            return Csr::new(offsets, bytemuck::allocation::cast_vec(ids)).ok_or_else(|| {
                self.source.error(format!("the offsets do not ascend from 0 to {size}, the number of ids"))
            });
        }
        let numbers = self.source.numbers(Scalar::I32, size)?;
        let numbers = self.to_ids(&numbers)?;
        split_length_prefixed(&numbers, n)
            .ok_or_else(|| self.source.error(format!("{size} numbers do not form the lists of {n} cells")))
    }

    fn read_named_ids(&mut self, name: &str, n: usize) -> Result<Vec<u32>> {
        let word = self.source.text(name)?;
        if !word.eq_ignore_ascii_case(name) {
            return Err(self.source.error(format!("expected {name}, found `{}`", truncated(word))));
        }
        let kind = self.read_type()?;
        let numbers = values(&mut self.source, kind, n)?;
        self.to_ids(&numbers)
    }

    fn to_ids(&self, numbers: &Values) -> Result<Vec<u32>> {
        to_ids(numbers).map_err(|bad| self.source.error(format!("{bad} is not a valid id")))
    }

    fn read_kinds(&mut self) -> Result<()> {
        let n = self.source.count("the number of cell types")?;
        let numbers = self.source.numbers(Scalar::I32, n)?;
        let kinds = self.to_ids(&numbers)?.into_iter().map(|k| u8::try_from(k).map(CellKind));
        self.kinds = Some(
            kinds
                .collect::<Result<_, _>>()
                .map_err(|_| self.source.error("a cell type is not between 0 and 255"))?,
        );
        Ok(())
    }

    fn build_cells(&mut self, grid: bool) -> Result<()> {
        let lists = std::mem::take(&mut self.lists);
        self.mesh.cells = if grid {
            let [lists, ..] = lists;
            let kinds = self.kinds.take().unwrap_or_default();
            grid_cells(kinds, lists, self.notes)
                .map_err(|e| e.at("CELLS").remedy("the file is damaged: write it again"))?
        } else {
            polygonal_cells(&lists)
                .ok_or_else(|| self.source.error("more vertex ids than a mesh can hold"))?
        };
        Ok(())
    }

    fn check_count(&mut self, word: &str, owner: AttributeTarget) -> Result<()> {
        let n = self.source.count(word)?;
        let expected = self.n_rows(owner);
        if n == expected {
            return Ok(());
        }
        Err(self.source.error(format!("{word}: expected {expected} rows, found {n}")))
    }

    fn n_rows(&self, owner: AttributeTarget) -> usize {
        match owner {
            AttributeTarget::Mesh => 0,
            AttributeTarget::Points => self.mesh.points.len(),
            AttributeTarget::Cells => self.mesh.cells.len(),
        }
    }

    fn read_attribute(&mut self, word: &str, owner: AttributeTarget) -> Result<()> {
        let n = self.n_rows(owner);
        match (word, owner) {
            ("FIELD", _) => return self.read_field(owner),
            ("METADATA", _) => {
                while self.source.line().is_some_and(|line| !line.trim_ascii().is_empty()) {}
                return Ok(());
            }
            ("LOOKUP_TABLE", _) => return self.skip_table(),
            (_, AttributeTarget::Mesh) => {
                return Err(self.source.error(format!("unknown section `{}`", truncated(word))));
            }
            _ => {}
        }
        let name = decode(self.source.text("the name of an array")?.as_bytes());
        let field = match word {
            "SCALARS" => self.read_scalars(name, n)?,
            "COLOR_SCALARS" => self.read_colours(name, n)?,
            "VECTORS" | "NORMALS" => self.read_array(name, 3, n)?,
            "TENSORS" => self.read_array(name, 9, n)?,
            "TENSORS6" => self.read_array(name, 6, n)?,
            "GLOBAL_IDS" | "PEDIGREE_IDS" | "EDGE_FLAGS" => self.read_array(name, 1, n)?,
            "TEXTURE_COORDINATES" => {
                let components = self.source.count("the number of texture coordinates")?;
                self.read_array(name, components, n)?
            }
            _ => return Err(self.source.error(format!("unknown section `{}`", truncated(word)))),
        };
        self.add(owner, field);
        Ok(())
    }

    fn add(&mut self, owner: AttributeTarget, field: Field) {
        self.skip_metadata(field.components);
        match owner {
            AttributeTarget::Mesh => self.mesh.field_data.push(field),
            AttributeTarget::Points => self.mesh.point_data.push(field),
            AttributeTarget::Cells => self.mesh.cell_data.push(field),
        }
    }

    fn read_array(&mut self, name: String, components: usize, n_rows: usize) -> Result<Field> {
        let kind = self.read_type()?;
        self.read_values(name, components, n_rows, kind)
    }

    fn read_values(&mut self, name: String, components: usize, n_rows: usize, kind: Type) -> Result<Field> {
        let n = n_rows.checked_mul(components).filter(|_| components > 0);
        let n = n.ok_or_else(|| {
            self.source.error(format!("invalid array size: {n_rows} rows of {components} components"))
        })?;
        let values = values(&mut self.source, kind, n).map_err(|e| e.at(format!("array {name}")))?;
        Ok(Field { name, components, values })
    }

    fn read_scalars(&mut self, name: String, n: usize) -> Result<Field> {
        let kind = self.read_type()?;
        let components = self.source.count_on_line().unwrap_or(1);
        if self.source.peek().eq_ignore_ascii_case(b"LOOKUP_TABLE") {
            self.source.word();
            self.source.text("the name of a lookup table")?;
        }
        self.read_values(name, components, n, kind)
    }

    /// Reads colours: bytes in binary files, numbers from 0 to 1 in text.
    fn read_colours(&mut self, name: String, n: usize) -> Result<Field> {
        let components = self.source.count("the number of colours")?;
        if self.source.binary {
            return self.read_values(name, components, n, Type::Number(Scalar::U8));
        }
        let mut field = self.read_values(name, components, n, Type::Number(Scalar::F32))?;
        if let Values::F32(shares) = &field.values {
            field.values = Values::U8(shares.iter().map(|share| (share * 255.0 + 0.5) as u8).collect());
        }
        Ok(field)
    }

    fn skip_table(&mut self) -> Result<()> {
        self.source.text("the name of a lookup table")?;
        let n = self.source.count("the size of a lookup table")?.saturating_mul(4);
        let kind = if self.source.binary { Scalar::U8 } else { Scalar::F32 };
        self.source.numbers(kind, n)?;
        self.notes.add(TABLES);
        Ok(())
    }

    fn read_field(&mut self, owner: AttributeTarget) -> Result<()> {
        self.source.text("the name of a field")?;
        let n_arrays = self.source.count("the number of arrays")?;
        for _ in 0..n_arrays {
            let name = decode(self.source.text("the name of an array")?.as_bytes());
            if name == "NULL_ARRAY" {
                continue;
            }
            let components = self.source.count("the number of components")?;
            let n_rows = self.source.count("the number of rows")?;
            let expected = self.n_rows(owner);
            if !matches!(owner, AttributeTarget::Mesh) && n_rows != expected {
                return Err(self
                    .source
                    .error(format!("array {name}: expected {expected} rows, found {n_rows}")));
            }
            let field = self.read_array(name, components, n_rows)?;
            self.add(owner, field);
        }
        Ok(())
    }
}

/// Splits lists in the layout before 5.0: `n id id ...`, list after list.
fn split_length_prefixed(mut numbers: &[u32], n_lists: usize) -> Option<Csr<VertexId>> {
    let mut lists = Csr::default();
    for _ in 0..n_lists {
        let (&n, rest) = numbers.split_first()?;
        let (list, rest) = rest.split_at_checked(n as usize)?;
        lists.push(list.iter().map(|&v| VertexId(v)));
        numbers = rest;
    }
    numbers.is_empty().then_some(lists)
}

/// The cells of an unstructured grid; the vertex list of a polyhedron is its face stream in these files.
fn grid_cells(kinds: Vec<CellKind>, lists: Csr<VertexId>, notes: &Notes) -> Result<Cells> {
    let (mut offsets, mut vertices) = (lists.offsets().to_vec(), lists.items().to_vec());
    trim(&kinds, &mut offsets, &mut vertices, notes);
    if !kinds.contains(&CellKind::POLYHEDRON) {
        return Cells::from_parts(kinds, offsets, vertices);
    }
    let lists = Csr::new(offsets, vertices).unwrap_or_default();
    if kinds.len() != lists.len() {
        return Err(Error::input(format!("{} cell types for {} cells", kinds.len(), lists.len())));
    }
    let mut cells = Cells::new();
    for (i, (kind, list)) in kinds.into_iter().zip(lists.iter()).enumerate() {
        if kind != CellKind::POLYHEDRON {
            if let Some(expected) = kind.n_vertices().filter(|&n| n != list.len()) {
                let (label, n) = (kind.label(), list.len());
                let what = format!("a {label} has {expected} vertices, but this one has {n}");
                return Err(Error::input(what).at(format!("cell {i}")));
            }
            cells.push(kind, list.iter().copied());
            continue;
        }
        let mut stream: &[u32] = bytemuck::cast_slice(list);
        let faces = next_polyhedron(&mut stream).filter(|_| stream.is_empty());
        let faces = faces.ok_or_else(|| {
            Error::input("the face list of the polyhedron is inconsistent").at(format!("cell {i}"))
        })?;
        let mut vertices = faces.items().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        cells.push_polyhedron(vertices, faces);
    }
    Ok(cells)
}

/// The cells of polygonal data; `None` if there are more ids than a mesh can hold.
fn polygonal_cells(lists: &[Csr<VertexId>; 4]) -> Option<Cells> {
    let n_ids: usize = lists.iter().map(|l| l.items().len()).sum();
    if n_ids > VertexId::MAX_COUNT {
        return None;
    }
    let mut cells = Cells::new();
    for (section, lists) in lists.iter().enumerate() {
        lists.iter().for_each(|list| cells.push(kind_in_section(section, list.len()), list.iter().copied()));
    }
    Some(cells)
}
