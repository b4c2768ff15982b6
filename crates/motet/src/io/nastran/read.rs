//! Reads points and elements.

use std::collections::BTreeSet;

use super::REF;
use super::cards::{Card, next};
use super::kinds::{Element, order};
use super::names::{Names, name_in};
use super::number::parse_real;
use crate::base::{Error, Point, Result};
use crate::io::format::{Input, Notes};
use crate::io::tags::{Tags, push_elements};
use crate::io::text::{Text, parse_int, quoted};
use crate::mesh::{CellKind, Cells, Field, Mesh};

/// Names of other cards that a note lists.
const MAX_LISTED: usize = 12;

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut text = Text::new(input.bytes);
    skip_to_bulk(&mut text);
    let (mut model, mut names) = (Model::default(), Names::new());
    let mut comment = |line: &[u8]| names.extend(name_in(line));
    while let Some(card) = next(&mut text, &mut comment) {
        if card.name == "ENDDATA" {
            break;
        }
        model.card(&card).map_err(|what| {
            let mut at = text.clone();
            at.set_position(card.position);
            at.error(format!("{}: {what}", card.name)).remedy("the file is damaged: write it again")
        })?;
    }
    model.into_mesh(&names, input.notes)
}

/// Skips the parts that tell the solver what to do. A file without them starts with bulk data.
fn skip_to_bulk(text: &mut Text<'_>) {
    let mut ahead = text.clone();
    while let Some(line) = ahead.line() {
        let mut words = line.split(|byte| byte.is_ascii_whitespace()).filter(|word| !word.is_empty());
        if words.next().is_some_and(|word| word.eq_ignore_ascii_case(b"BEGIN")) {
            *text = ahead;
            return;
        }
    }
}

#[derive(Default)]
struct Model {
    node_ids: Vec<u64>,
    points: Vec<Point>,
    /// Coordinate systems of points other than the basic one, and those that are defined.
    systems: BTreeSet<i64>,
    defined_systems: BTreeSet<i64>,
    element_ids: Vec<u64>,
    kinds: Vec<CellKind>,
    properties: Vec<i32>,
    /// The nodes of all elements in VTK's order.
    nodes: Vec<u64>,
    others: BTreeSet<String>,
}

impl Model {
    fn card(&mut self, card: &Card<'_>) -> Result<(), String> {
        if card.name == "GRID" {
            return self.point(card);
        }
        if let Some(element) = Element::named(&card.name) {
            return self.element(card, element);
        }
        if card.name.starts_with("CORD") {
            self.defined_systems.extend(parse_int(card.field(1)));
        }
        // The cards of the properties of the cells that are read.
        if !matches!(card.name.as_str(), "PSOLID" | "PSHELL" | "PROD" | "") {
            self.others.insert(card.name.clone());
        }
        Ok(())
    }

    /// Reads `number, coordinate system, x, y, z`; blank fields are 0.
    fn point(&mut self, card: &Card<'_>) -> Result<(), String> {
        let number = id(card, 1, "number of the point")?;
        let system = int(card, 2, "coordinate system")?.unwrap_or(0);
        let mut point = [0.0; 3];
        for (x, i) in point.iter_mut().zip(3..) {
            let field = card.field(i);
            if !field.is_empty() {
                *x = parse_real(field)
                    .ok_or_else(|| format!("coordinate: expected a number, found {}", quoted(field)))?;
            }
        }
        self.node_ids.push(number);
        self.points.push(point);
        self.systems.extend((system != 0).then_some(system));
        Ok(())
    }

    /// Reads `number, property, nodes`.
    fn element(&mut self, card: &Card<'_>, element: &Element) -> Result<(), String> {
        let number = id(card, 1, "number of the element")?;
        let first = element.first_node();
        let property = if first == 3 { int(card, 2, "property")?.unwrap_or(0) } else { 0 };
        let property =
            i32::try_from(property).map_err(|_| format!("property {property} needs more than 32 bits"))?;
        let has_node = |i: usize| !matches!(card.field(first + i), b"" | b"0");
        let kind = element.kind(has_node).map_err(|[n_corners, n_all]| {
            let has = (0..n_all).filter(|&i| has_node(i)).count();
            let needs = if n_all > n_corners {
                format!("{n_corners} nodes, or {n_all}")
            } else {
                format!("{n_corners} nodes")
            };
            format!("element {number} needs {needs}, but has {has}")
        })?;
        let n_nodes = kind.n_vertices().unwrap_or(0);
        let start = self.nodes.len();
        self.nodes.resize(start + n_nodes, 0);
        for i in 0..n_nodes {
            let place = order(kind).map_or(i, |order| order[i]);
            self.nodes[start + place] = id(card, first + i, "node of the element")?;
        }
        self.element_ids.push(number);
        self.kinds.push(kind);
        self.properties.push(property);
        Ok(())
    }

    fn into_mesh(self, names: &Names, notes: &Notes) -> Result<Mesh> {
        if self.points.is_empty() {
            return Err(Error::input("there are no points (GRID)")
                .remedy("the file contains no mesh or includes it: give the file with the mesh"));
        }
        if let Some(system) = self.systems.intersection(&self.defined_systems).next() {
            return Err(Error::input(format!("points are in coordinate system {system}"))
                .remedy("write them in the basic coordinate system, 0"));
        }
        if let Some(system) = self.systems.first() {
            notes.add(format!("coordinate system {system} is not defined: the basic one is used"));
        }
        if !self.others.is_empty() {
            let listed: Vec<&str> = self.others.iter().take(MAX_LISTED).map(String::as_str).collect();
            let more = if self.others.len() > MAX_LISTED { ", ..." } else { "" };
            notes.add(format!("other cards are skipped: {}{more}", listed.join(", ").escape_debug()));
        }
        let tags = Tags::new(&self.node_ids, "point")?;
        let mut cells = Cells::new();
        let elements = self.element_ids.iter().copied().zip(self.kinds.iter().copied());
        push_elements(&mut cells, elements, &self.nodes, |node| tags.place(node))?;
        let mut mesh = Mesh::new(self.points, cells);
        for (dim, to) in [(3, &mut mesh.label_names.regions), (2, &mut mesh.label_names.patches)] {
            let of_dim = self.kinds.iter().zip(&self.properties).filter(|(kind, _)| kind.dim() == Some(dim));
            let used: BTreeSet<i32> = of_dim.map(|(_, &property)| property).collect();
            to.extend(
                names.iter().filter(|(number, _)| used.contains(number)).map(|(&n, name)| (n, name.clone())),
            );
        }
        if self.properties.iter().any(|&property| property != 0) {
            mesh.set_cell_field(Field::scalars(REF, self.properties));
        }
        Ok(mesh)
    }
}

/// A whole number; `None` for a blank field.
fn int(card: &Card<'_>, number: usize, what: &str) -> Result<Option<i64>, String> {
    let field = card.field(number);
    let wrong = || format!("{what}: expected a whole number, found {}", quoted(field));
    if field.is_empty() { Ok(None) } else { parse_int(field).map(Some).ok_or_else(wrong) }
}

fn id(card: &Card<'_>, number: usize, what: &str) -> Result<u64, String> {
    let id = int(card, number, what)?.ok_or_else(|| format!("the {what} is missing"))?;
    u64::try_from(id).map_err(|_| format!("the {what} is negative: {id}"))
}
