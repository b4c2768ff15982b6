//! Reads the datasets of a file.

use std::collections::BTreeSet;

use super::kinds::{element, is_beam};
use crate::base::{Error, Point, Result};
use crate::io::format::{Input, Notes};
use crate::io::latin::decode_utf8_or_latin1;
use crate::io::named_sets::{NSET, Named, NamedSets, Rank, Runs, merged, set_arrays, set_labels};
use crate::io::tags::{Tags, push_elements};
use crate::io::text::{Text, parse_int, quoted};
use crate::mesh::{CellKind, Cells, Field, Mesh};

/// The line before and after each dataset.
const DELIMITER: &[u8] = b"-1";

/// Maximum number of nodes of an element, more than any has.
const MAX_NODES: i64 = 64;

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut text = Text::new(input.bytes);
    let mut model = Model::default();
    while let Some(word) = text.word() {
        if word != DELIMITER {
            return Err(text
                .unexpected("the start of a dataset", "`-1`", word)
                .remedy("check the format of the file"));
        }
        // Some files end with a delimiter too many.
        let Some(number) = text.word() else { break };
        model.dataset(&mut text, number, input.notes)?;
    }
    model.into_mesh(input.notes)
}

#[derive(Default)]
struct Model {
    node_ids: Vec<u64>,
    points: Vec<Point>,
    element_ids: Vec<u64>,
    kinds: Vec<CellKind>,
    /// The physical property of each element.
    properties: Vec<i32>,
    /// The nodes of all elements in VTK's order.
    nodes: Vec<u64>,
    groups: Vec<Group>,
    n_unsupported: usize,
}

struct Group {
    name: String,
    number: i32,
    nodes: Vec<u64>,
    elements: Vec<u64>,
}

impl Model {
    /// Reads a dataset up to and with the delimiter at its end.
    fn dataset(&mut self, text: &mut Text<'_>, number: &[u8], notes: &Notes) -> Result<()> {
        let mut row = |read: &mut dyn FnMut(&mut Text<'_>) -> Result<()>| -> Result<()> {
            while text.peek().is_some_and(|word| word != DELIMITER) {
                read(text)?;
            }
            text.expect("`-1` at the end of the dataset").map(drop)
        };
        match number {
            b"2411" | b"781" | b"15" => row(&mut |text| self.node(text)),
            b"2412" => row(&mut |text| self.element(text, notes)),
            b"2467" | b"2477" | b"2452" | b"2435" => row(&mut |text| self.group(text, notes)),
            b"164" => {
                units(text, notes)?;
                skip(text)
            }
            // Header, and what belongs to it.
            b"151" => skip(text),
            other => {
                notes.add(format!("dataset {} is skipped", quoted(other)));
                skip(text)
            }
        }
    }

    /// Reads `label, three numbers, coordinates`, on one line or two.
    fn node(&mut self, text: &mut Text<'_>) -> Result<()> {
        self.node_ids.push(id(text, "node number")?);
        (0..3).try_for_each(|_| text.int("attribute of a node").map(drop))?;
        self.points.push(text.point()?);
        Ok(())
    }

    /// Reads `label, descriptor, property, material, colour, number of nodes`, for beams a record of their
    /// section, then the nodes.
    fn element(&mut self, text: &mut Text<'_>, notes: &Notes) -> Result<()> {
        let number = id(text, "element number")?;
        let descriptor = text.int("type of an element")?;
        let property = text.int32("physical property")?;
        text.int("material")?;
        text.int("colour")?;
        let n = text.int("number of nodes")?;
        let Some(n_nodes) = usize::try_from(n).ok().filter(|_| n <= MAX_NODES) else {
            return Err(text.error(format!("expected at most {MAX_NODES} nodes, found {n}")));
        };
        text.skip_line();
        if is_beam(descriptor) && has_section(text, n_nodes) {
            (0..3).try_for_each(|_| text.int("section of a beam").map(drop))?;
        }
        let Some((kind, _, order)) = element(descriptor, n_nodes) else {
            if matches!(descriptor, 41..=118) {
                return Err(text
                    .error(format!("elements of type {descriptor} with {n_nodes} nodes are not supported"))
                    .remedy("mesh with elements of first or second order"));
            }
            (0..n_nodes).try_for_each(|_| text.int("node of an element").map(drop))?;
            self.n_unsupported += 1;
            notes.add(format!("elements of type {descriptor} are skipped"));
            return Ok(());
        };
        let first = self.nodes.len();
        self.nodes.resize(first + n_nodes, 0);
        for &place in *order {
            self.nodes[first + place] = id(text, "node of an element")?;
        }
        self.element_ids.push(number);
        self.kinds.push(*kind);
        self.properties.push(property);
        Ok(())
    }

    /// Reads the number of a group, six numbers, the number of its members; its name on a line; and for each
    /// member its type (7: node, 8: element), its number and two numbers more.
    fn group(&mut self, text: &mut Text<'_>, notes: &Notes) -> Result<()> {
        let number = text.int32("number of a group")?;
        (0..6).try_for_each(|_| text.int("attribute of a group").map(drop))?;
        let n = text.count("members of a group", 4)?;
        text.skip_line();
        text.line();
        let name = decode_utf8_or_latin1(text.line().unwrap_or_default().trim_ascii());
        let name = if name.is_empty() { format!("group {number}") } else { name };
        let mut group = Group { name, number, nodes: Vec::new(), elements: Vec::new() };
        for _ in 0..n {
            let kind = text.int("type of a member")?;
            let member = text.int("member of a group")?;
            (0..2).try_for_each(|_| text.int("member of a group").map(drop))?;
            let members = match kind {
                7 => &mut group.nodes,
                8 => &mut group.elements,
                _ => {
                    notes.add(format!("members of type {kind} of groups are skipped"));
                    continue;
                }
            };
            members.extend(u64::try_from(member));
        }
        self.groups.push(group);
        Ok(())
    }

    fn into_mesh(self, notes: &Notes) -> Result<Mesh> {
        if self.points.is_empty() {
            return Err(Error::input("there are no nodes (dataset 2411)")
                .remedy("the file contains no mesh or is truncated: get a new copy"));
        }
        let node_tags = Tags::new(&self.node_ids, "node")?;
        let element_tags = Tags::new(&self.element_ids, "element")?;
        let mut cells = Cells::new();
        let elements = self.element_ids.iter().copied().zip(self.kinds.iter().copied());
        push_elements(&mut cells, elements, &self.nodes, |node| node_tags.place(node))?;
        let n_cells = cells.len();
        let mut mesh = Mesh::new(self.points, cells);
        let (mut of_cells, mut of_points) = (NamedSets::default(), NamedSets::default());
        for group in &self.groups {
            let ways =
                [(&group.elements, &element_tags, &mut of_cells), (&group.nodes, &node_tags, &mut of_points)];
            for (members, tags, sets) in ways {
                let places: Vec<u32> = members.iter().filter_map(|&member| tags.place(member)).collect();
                let n_missing = members.len() - places.len();
                // Those that are no cells here were noted.
                if n_missing > 0 && self.n_unsupported == 0 {
                    notes.add(format!("group {} has nonexistent members: {n_missing}", group.name));
                }
                if !places.is_empty() {
                    sets.add(group.named(merged(places.into_iter().map(|place| place..place + 1).collect())));
                }
            }
        }
        set_labels(&mut mesh, n_cells, &of_cells.all, notes);
        if of_cells.all.is_empty() {
            label_by_property(&mut mesh, &self.properties);
        }
        let n_points = mesh.points.len();
        set_arrays(&mut mesh.point_data, NSET, of_points.all.iter(), n_points, notes);
        Ok(mesh)
    }
}

impl Group {
    fn named(&self, runs: Runs) -> Named {
        Named { name: self.name.clone(), number: self.number, runs, rank: Rank::Declared }
    }
}

/// Labels volume cells, and surface cells, by their physical properties where these differ.
fn label_by_property(mesh: &mut Mesh, properties: &[i32]) {
    for (dim, array) in [(3, "region"), (2, "patch")] {
        let of_cell =
            |(kind, &property): (&CellKind, &i32)| if kind.dim() == Some(dim) { property } else { 0 };
        let labels: Vec<i32> = mesh.cells.kinds().iter().zip(properties).map(of_cell).collect();
        let used: BTreeSet<i32> = labels.iter().copied().filter(|&label| label != 0).collect();
        if used.len() > 1 {
            mesh.set_cell_field(Field::scalars(array, labels));
        }
    }
}

fn id(text: &mut Text<'_>, what: &str) -> Result<u64> {
    let n = text.int(what)?;
    u64::try_from(n).map_err(|_| text.error(format!("{what} is negative: {n}")))
}

/// Whether the record of a beam's section comes next. Some programs omit it for rods; their two nodes are a
/// line of two numbers.
fn has_section(text: &Text<'_>, n_nodes: usize) -> bool {
    let mut ahead = text.clone();
    let mut n_words = usize::from(ahead.word().is_some());
    while ahead.word_in_line().is_some() {
        n_words += 1;
    }
    n_words == 3 && (n_nodes != 3 || has_line_of_numbers(&mut ahead, n_nodes))
}

/// Whether the next line has this many numbers.
fn has_line_of_numbers(ahead: &mut Text<'_>, n: usize) -> bool {
    let mut n_words = usize::from(ahead.word().is_some_and(|word| word != DELIMITER));
    while ahead.word_in_line().is_some_and(|word| parse_int(word).is_some()) {
        n_words += 1;
    }
    n_words == n
}

/// Skips the rest of a dataset.
fn skip(text: &mut Text<'_>) -> Result<()> {
    loop {
        match text.line() {
            Some(line) if line.trim_ascii() == DELIMITER => return Ok(()),
            Some(_) => {}
            None => return Err(text.unexpected_end("`-1` at the end of the dataset")),
        }
    }
}

/// Reads `code, description, mode of temperatures`, then how many units of the file are a metre. The code may
/// touch the description.
fn units(text: &mut Text<'_>, notes: &Notes) -> Result<()> {
    text.skip_line();
    text.line();
    let line = text.line().unwrap_or_default().trim_ascii();
    let is_number = |byte: &u8| byte.is_ascii_digit() || byte.is_ascii_whitespace();
    let start = line.iter().position(|byte| !is_number(byte)).unwrap_or(line.len());
    let end = line.iter().rposition(|byte| !is_number(byte)).map_or(start, |last| last + 1);
    let name = decode_utf8_or_latin1(&line[start..end]);
    let per_metre = text.float("factor of lengths")?;
    text.skip_line();
    if per_metre != 1.0 {
        notes.add(format!(
            "coordinates are in the unit of the file ({name}), of which {per_metre} are a metre"
        ));
    }
    Ok(())
}
