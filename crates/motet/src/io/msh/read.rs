//! Reads MSH files of both versions, as text or binary.

use super::data::{Data, Location};
use super::entities::{Entities, EntityLabels};
use super::kinds::{ElementType, element_types};
use super::source::{Form, Source};
use std::collections::HashMap;

use crate::base::{CellId, Point, Result, VertexId};
use crate::io::format::{Input, Notes};
use crate::io::tags::Tags;
use crate::io::text::quoted;
use crate::mesh::{Cells, Field, LabelNames, Mesh, Values};

/// Everything read so far.
#[derive(Default)]
struct Reader {
    version: Version,
    node_tags: Vec<u64>,
    nodes: Option<Tags>,
    points: Vec<Point>,
    node_entities: Vec<i32>,
    entities: Entities,
    cells: Cells,
    element_tags: Vec<u64>,
    /// The cell of each element, if several elements form one cell; otherwise empty.
    cell_of_element: Vec<u32>,
    labels: Vec<EntityLabels>,
    label_names: LabelNames,
    field_data: Vec<Field>,
    data: Vec<Data>,
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Version {
    /// `$MeshFormat` has not been read yet.
    #[default]
    Unknown,
    V2,
    V4,
}

/// Reads an MSH file.
pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut source = Source::new(input.bytes);
    let mut reader = Reader::default();
    while let Some(name) = source.section()? {
        reader.section(&mut source, &name, input.notes)?;
    }
    reader.into_mesh(&source, input.notes)
}

impl Reader {
    fn section(&mut self, source: &mut Source<'_>, name: &str, notes: &Notes) -> Result<()> {
        match (name, self.version) {
            ("MeshFormat", _) => self.format(source)?,
            ("Comments", _) => return source.skip_section(name),
            ("NOD" | "ELM", _) => {
                return Err(source
                    .error("expected MSH version 2.2 or 4.1, found version 1")
                    .remedy("convert it: gmsh FILE -save -format msh41 -o NEW.msh"));
            }
            (_, Version::Unknown) => {
                return Err(source
                    .error(format!("expected $MeshFormat at the start of the file, found ${name}"))
                    .remedy("check that it is a Gmsh mesh: a geometry (.geo) must be meshed first"));
            }
            ("PhysicalNames", _) => self.physical_names(source)?,
            ("Nodes" | "ParametricNodes", _) if self.nodes.is_some() => {
                return Err(source.error("duplicate section $Nodes"));
            }
            ("Nodes", Version::V2) => self.nodes2(source, false)?,
            ("ParametricNodes", Version::V2) => self.nodes2(source, true)?,
            ("Nodes", _) => self.nodes4(source)?,
            ("Entities", Version::V4) => self.entities.read(source, notes)?,
            ("PartitionedEntities", Version::V4) => self.entities.read_partitioned(source, notes)?,
            ("Elements", Version::V2) => self.elements2(source, notes)?,
            ("Elements", _) => self.elements4(source)?,
            ("NodeData", _) => self.data.push(Data::read(source, Location::Node)?),
            ("ElementData", _) => self.data.push(Data::read(source, Location::Element)?),
            _ => {
                notes.add(format!("section ${name} is skipped: a mesh cannot hold it"));
                return source.skip_section(name);
            }
        }
        source.end_section(name)
    }

    fn format(&mut self, source: &mut Source<'_>) -> Result<()> {
        source.form = Form::Ascii;
        let version = source.text.expect("the version of the format")?;
        self.version = match version {
            b"2" | b"2.0" | b"2.1" | b"2.2" => Version::V2,
            b"4.1" => Version::V4,
            _ => {
                return Err(source
                    .error(format!("expected MSH version 2.2 or 4.1, found version {}", quoted(version)))
                    .remedy("convert it: gmsh FILE -save -format msh41 -o NEW.msh"));
            }
        };
        let binary = source.int("the kind of file (0 ascii, 1 binary)")? != 0;
        source.size_bytes = match source.int("the size of numbers")? {
            4 => 4,
            8 => 8,
            other => return Err(source.error(format!("expected numbers of 4 or 8 bytes, found {other}"))),
        };
        if binary {
            source.text.line();
            source.form = Form::Binary { swapped: false };
            source.form = match source.int("the number 1, which determines the byte order")? {
                1 => Form::Binary { swapped: false },
                0x0100_0000 => Form::Binary { swapped: true },
                other => {
                    return Err(source
                        .error(format!("expected the number 1 in either byte order, found {other}"))
                        .remedy("the file is damaged, or not binary as declared"));
                }
            };
        }
        Ok(())
    }

    /// Reads `dimension number "name"`, one per line; text in binary files too.
    fn physical_names(&mut self, source: &mut Source<'_>) -> Result<()> {
        let text = &mut source.text;
        for _ in 0..text.count("physical names", 3)? {
            let dim = text.int("dimension of a physical group")?;
            let tag = text.int32("physical group number")?;
            let line = text.line().ok_or_else(|| text.unexpected_end("name of a physical group"))?;
            let name = unquoted(line);
            match dim {
                3 => drop(self.label_names.regions.insert(tag, name)),
                2 => drop(self.label_names.patches.insert(tag, name)),
                1 => self.field_data.push(Field::scalars(format!("curve:{name}"), vec![tag])),
                0 => self.field_data.push(Field::scalars(format!("point:{name}"), vec![tag])),
                _ => {
                    return Err(text
                        .error(format!("expected the dimension of a physical group, 0 to 3, found {dim}")));
                }
            }
        }
        Ok(())
    }

    fn nodes2(&mut self, source: &mut Source<'_>, parametric: bool) -> Result<()> {
        let n = source.text.count("nodes", 4)?;
        source.text.line();
        let n = source.checked_count(n as u64, "nodes", 4)?;
        self.reserve_nodes(n);
        for _ in 0..n {
            let tag = source.int("node number")?;
            let tag =
                u64::try_from(tag).map_err(|_| source.error(format!("node number {tag} is negative")))?;
            self.node_tags.push(tag);
            self.points.push(source.point()?);
            if parametric {
                let dim = source.int("dimension of an entity")?;
                source.int("entity number")?;
                for _ in 0..if (1..3).contains(&dim) { dim } else { 0 } {
                    source.double("parameter of a node")?;
                }
            }
        }
        self.nodes = Some(Tags::new(&self.node_tags, "node").map_err(|e| e.at("$Nodes"))?);
        Ok(())
    }

    fn nodes4(&mut self, source: &mut Source<'_>) -> Result<()> {
        let n_blocks = source.count("blocks of nodes", 4)?;
        let n_nodes = source.count("nodes", 4)?;
        source.size("the smallest node number")?;
        source.size("the largest node number")?;
        self.reserve_nodes(n_nodes);
        for _ in 0..n_blocks {
            let dim = source.int("dimension of an entity")?;
            let entity = source.int("entity number")?;
            let parametric = source.int("whether nodes are parametric")? != 0;
            let n = source.count("nodes of a block", 4)?;
            let n_parameters = if parametric { dim.clamp(0, 3) } else { 0 };
            for _ in 0..n {
                self.node_tags.push(source.size("node number")?);
            }
            for _ in 0..n {
                self.points.push(source.point()?);
                for _ in 0..n_parameters {
                    source.double("parameter of a node")?;
                }
                self.node_entities.extend([dim, entity]);
            }
        }
        if self.points.len() != n_nodes {
            return Err(source
                .error(format!("{n_nodes} nodes declared, but the blocks contain {}", self.points.len()))
                .remedy("the file is damaged: write it again"));
        }
        self.nodes = Some(Tags::new(&self.node_tags, "node").map_err(|e| e.at("$Nodes"))?);
        Ok(())
    }

    fn reserve_nodes(&mut self, n: usize) {
        self.node_tags.reserve(n);
        self.points.reserve(n);
    }

    fn elements2(&mut self, source: &mut Source<'_>, notes: &Notes) -> Result<()> {
        let types = element_types();
        let n = source.text.count("elements", 4)?;
        source.text.line();
        let n = source.checked_count(n as u64, "elements", 2)?;
        let mut done = 0;
        while done < n {
            let (header_tag, number, n_here) = match source.form {
                Form::Ascii => {
                    let tag = source.int("element number")?;
                    (Some(tag), source.int("element type")?, 1)
                }
                Form::Binary { .. } => {
                    let number = source.int("element type")?;
                    (None, number, source.int_count("elements of a block", 2)?)
                }
            };
            let element_type = find_type(&types, number, source)?;
            let n_tags = source.int_count("tags of an element", 1)?;
            for _ in 0..n_here {
                let tag = match header_tag {
                    Some(tag) => tag,
                    None => source.int("element number")?,
                };
                let labels = tags2(source, n_tags, notes)?;
                // Numbers of elements only serve as names here, so a negative one is valid.
                self.element(source, element_type, i64::from(tag) as u64, labels)?;
            }
            if n_here == 0 {
                return Err(source.error("a block contains no elements"));
            }
            done += n_here;
        }
        Ok(())
    }

    /// Merges elements that differ only in their physical group: version 2 repeats an element for each of its
    /// groups.
    fn merge_groups(&mut self, notes: &Notes) {
        let of = |cell: usize| (self.cells.kind(CellId::new(cell)), self.cells.vertices(CellId::new(cell)));
        let entity = |cell: usize| (self.labels[cell].geometrical, self.labels[cell].partition);
        let mut firsts: HashMap<_, usize> = HashMap::with_capacity(self.cells.len());
        let same: Vec<usize> = (0..self.cells.len())
            .map(|cell| {
                let first = *firsts.entry((of(cell), entity(cell))).or_insert(cell);
                // An element repeated with the same group is an error of the mesh, and is kept.
                if self.labels[first].physical == self.labels[cell].physical { cell } else { first }
            })
            .collect();
        let kept: Vec<usize> = (0..same.len()).filter(|&cell| same[cell] == cell).collect();
        if kept.len() == same.len() {
            return;
        }
        notes.add("some elements are in several physical groups: their cells keep the first");
        let mut cells = Cells::new();
        kept.iter().for_each(|&cell| cells.push(of(cell).0, of(cell).1.iter().copied()));
        let mut places = vec![0; same.len()];
        kept.iter().enumerate().for_each(|(place, &cell)| places[cell] = place as u32);
        self.cell_of_element = same.iter().map(|&first| places[first]).collect();
        self.labels = kept.iter().map(|&cell| self.labels[cell]).collect();
        self.cells = cells;
    }

    fn elements4(&mut self, source: &mut Source<'_>) -> Result<()> {
        let types = element_types();
        let n_blocks = source.count("blocks of elements", 4)?;
        let n_elements = source.count("elements", 2)?;
        source.size("the smallest element number")?;
        source.size("the largest element number")?;
        self.element_tags.reserve(n_elements);
        let before = self.cells.len();
        for _ in 0..n_blocks {
            let dim = source.int("dimension of an entity")?;
            let entity = source.int("entity number")?;
            let number = source.int("element type")?;
            let element_type = find_type(&types, number, source)?;
            let n = source.count("elements of a block", 1 + element_type.vtk_to_gmsh.len())?;
            let labels = self.entities.get(dim, entity);
            for _ in 0..n {
                let tag = source.size("element number")?;
                self.element(source, element_type, tag, labels)?;
            }
        }
        if self.cells.len() - before != n_elements {
            return Err(source
                .error(format!(
                    "{n_elements} elements declared, but the blocks contain {}",
                    self.cells.len() - before
                ))
                .remedy("the file is damaged: write it again"));
        }
        Ok(())
    }

    /// Reads the nodes of an element and stores it.
    fn element(
        &mut self,
        source: &mut Source<'_>,
        element_type: &ElementType,
        tag: u64,
        labels: EntityLabels,
    ) -> Result<()> {
        let order = &element_type.vtk_to_gmsh;
        let mut gmsh = [VertexId::default(); 32];
        let Some(nodes) = &self.nodes else {
            return Err(source.error("elements precede the nodes").remedy("write the file again"));
        };
        for vertex in &mut gmsh[..order.len()] {
            let node = match self.version {
                Version::V2 => i64::from(source.int("node of an element")?) as u64,
                _ => source.size("node of an element")?,
            };
            *vertex = VertexId(nodes.place(node).ok_or_else(|| {
                source
                    .error(format!("element {tag} refers to node {}, which does not exist", node as i64))
                    .remedy("the file is damaged: write it again")
            })?);
        }
        self.cells.push(element_type.kind, order.iter().map(|&i| gmsh[i]));
        self.element_tags.push(tag);
        self.labels.push(labels);
        Ok(())
    }

    fn into_mesh(mut self, source: &Source<'_>, notes: &Notes) -> Result<Mesh> {
        if self.version == Version::V2 {
            self.merge_groups(notes);
        }
        let Some(nodes) = &self.nodes else {
            return Err(source
                .error("there is no section $Nodes")
                .remedy("the file contains no mesh or is truncated: get a new copy"));
        };
        let mut mesh = Mesh::new(self.points, self.cells);
        if !self.node_entities.is_empty() {
            let values = Values::I32(self.node_entities);
            mesh.set_point_field(Field { name: "gmsh:dim_tags".into(), components: 2, values });
        }
        let mut label = |name: &str, of: fn(&EntityLabels) -> i32| {
            let values: Vec<i32> = self.labels.iter().map(of).collect();
            if values.iter().any(|&v| v != 0) {
                mesh.set_cell_field(Field::scalars(name, values));
            }
        };
        label("gmsh:physical", |e| e.physical);
        label("gmsh:geometrical", |e| e.geometrical);
        label("gmsh:partition", |e| e.partition);
        let of_elements = self.data.iter().any(|d| d.place == Location::Element);
        // Numbers of elements may repeat as long as no data refer to them.
        let elements = if of_elements { Some(Tags::new(&self.element_tags, "element")?) } else { None };
        let elements = elements.map(|tags| (tags, self.cell_of_element));
        for data in self.data {
            data.put(&mut mesh, nodes, elements.as_ref(), notes)?;
        }
        mesh.label_names = self.label_names;
        mesh.field_data = self.field_data;
        Ok(mesh)
    }
}

/// Reads the labels from the tags of a version 2 element: physical group, entity, number of partitions,
/// partitions.
fn tags2(source: &mut Source<'_>, n_tags: usize, notes: &Notes) -> Result<EntityLabels> {
    let mut labels = EntityLabels::default();
    for i in 0..n_tags {
        let tag = source.int("tag of an element")?;
        match i {
            0 => labels.physical = tag,
            1 => labels.geometrical = tag,
            3 => labels.partition = tag.saturating_abs(),
            4 => notes.add("some elements are in several partitions: they keep the first"),
            _ => {}
        }
    }
    Ok(labels)
}

fn find_type<'t>(types: &'t [ElementType], number: i32, source: &Source<'_>) -> Result<&'t ElementType> {
    types.iter().find(|t| t.number == number).ok_or_else(|| {
        source
            .error(format!("element type {number} is not supported: only first and second order are"))
            .remedy("write the mesh with a lower order (gmsh -order 2)")
    })
}

/// The text between quotes, or the whole line if it is not quoted.
fn unquoted(line: &[u8]) -> String {
    let line = String::from_utf8_lossy(line);
    let line = line.trim();
    line.strip_prefix('"').and_then(|l| l.strip_suffix('"')).unwrap_or(line).to_owned()
}
