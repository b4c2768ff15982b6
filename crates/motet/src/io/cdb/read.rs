//! Reads the blocks of nodes, elements and components.

use std::collections::BTreeSet;
use std::ops::Range;

use super::columns::{Columns, field};
use super::commands::{Command, Types};
use super::kinds::cell;
use super::labels::sets_of_cells;
use crate::base::{Error, Point, Result, VertexId};
use crate::io::format::{Input, Notes};
use crate::io::named_sets::{NSET, Named, NamedSets, Rank, Runs, merged, set_arrays, set_labels};
use crate::io::tags::{Tags, push_elements};
use crate::io::text::{Text, parse_float, parse_int, quoted};
use crate::mesh::{CellKind, Cells, Mesh};

/// Maximum number of nodes of an element, more than any has.
const MAX_NODES: i64 = 64;

/// Columns before the nodes of an element, in blocks of solids and in others.
const BEFORE_NODES: [usize; 2] = [11, 5];

/// Maximum number of members of all components, of which ranges may state any number in a few bytes.
const MAX_MEMBERS: usize = 1 << 30;

/// Names of other commands that a note lists.
const MAX_LISTED: usize = 12;

/// Commands that say nothing about a mesh that would be skipped.
const WITHOUT_CONTENT: &[&str] = &[
    "EXTO", "NUMO", "SHPP", "DOFS", "FINI", "N", "MAT", "REAL", "TYPE", "SECN", "ESYS", "CSYS", "NSEL",
    "ESEL", "ALLS", "CMSE",
];

pub(super) fn read(input: &Input<'_>) -> Result<Mesh> {
    let mut file = File { text: Text::new(input.bytes), model: Model::default() };
    while let Some((command, _)) = file.line() {
        if let Some(command) = Command::parse(command) {
            file.command(&command)?;
        }
    }
    file.model.into_mesh(input.notes)
}

struct File<'a> {
    text: Text<'a>,
    model: Model,
}

#[derive(Default)]
struct Model {
    types: Types,
    node_ids: Vec<u64>,
    points: Vec<Point>,
    element_ids: Vec<u64>,
    kinds: Vec<CellKind>,
    materials: Vec<i32>,
    /// The nodes of all elements in VTK's order.
    nodes: Vec<u64>,
    components: Vec<Component>,
    /// What is skipped, once each.
    skipped: BTreeSet<String>,
    others: BTreeSet<String>,
    n_skipped: usize,
    n_lacking: usize,
    /// Number of commands that define a single node or element.
    n_single: usize,
}

struct Component {
    name: String,
    is_of_nodes: bool,
    /// Numbers; a negative one ends a range that begins with the number before it.
    members: Vec<i64>,
}

impl<'a> File<'a> {
    /// The next line, and its position.
    fn line(&mut self) -> Option<(&'a [u8], usize)> {
        let position = self.text.position();
        Some((self.text.line()?, position))
    }

    /// The error at a position.
    fn error(&self, position: usize, what: impl Into<String>) -> Error {
        let mut at = self.text.clone();
        at.set_position(position);
        at.error(what).remedy("the file is damaged: write it again")
    }

    fn command(&mut self, command: &Command) -> Result<()> {
        match command.name.as_str() {
            "NBLO" => self.nodes(),
            "EBLO" => self.elements(command),
            "CMBL" => self.component(command),
            "ETBL" => self.types(),
            _ if self.model.types.command(command) => Ok(()),
            "N" if !command.argument(2).is_empty() && command.argument(2) != "LOC" => {
                self.model.n_single += 1;
                Ok(())
            }
            "EN" | "E" | "EMOR" => {
                self.model.n_single += 1;
                Ok(())
            }
            name if name.starts_with(['*', '/']) || name.contains('=') || WITHOUT_CONTENT.contains(&name) => {
                Ok(())
            }
            name => {
                self.model.others.insert(name.to_owned());
                Ok(())
            }
        }
    }

    /// Reads the format of a block.
    fn columns(&mut self) -> Result<Columns> {
        let Some((line, position)) = self.line() else {
            return Err(self.text.unexpected_end("the format of a block, such as (19i9)"));
        };
        Columns::parse(line).ok_or_else(|| {
            self.error(
                position,
                format!("expected the format of a block, such as (19i9), found {}", quoted(line)),
            )
        })
    }

    /// The next row of a block; `None` at its end, which is -1 or the command N.
    fn row(&mut self) -> Result<Option<(&'a [u8], usize)>> {
        let Some((line, position)) = self.line() else {
            return Err(self.text.unexpected_end("`-1` at the end of the block"));
        };
        let is_end = line.trim_ascii().split(|byte| byte.is_ascii_whitespace() || *byte == b',').next();
        let is_end = matches!(is_end, Some(b"-1" | b"N" | b"n"));
        Ok((!is_end).then_some((line, position)))
    }

    /// A whole number in a column; 0 if it is blank.
    fn int(&self, row: (&[u8], usize), columns: &Columns, number: usize, what: &str) -> Result<i64> {
        let field = columns.whole.get(number).map_or(&[][..], |column| field(row.0, column));
        if field.is_empty() {
            return Ok(0);
        }
        parse_int(field).ok_or_else(|| {
            self.error(row.1, format!("{what}: expected a whole number, found {}", quoted(field)))
        })
    }

    fn id(&self, row: (&[u8], usize), columns: &Columns, number: usize, what: &str) -> Result<u64> {
        let id = self.int(row, columns, number, what)?;
        u64::try_from(id).map_err(|_| self.error(row.1, format!("the {what} is negative: {id}")))
    }

    /// Reads the number of each node, two numbers of the solid model where there are three columns, and its
    /// coordinates, of which those at the end may be missing if they are 0.
    fn nodes(&mut self) -> Result<()> {
        let columns = self.columns()?;
        if columns.whole.is_empty() || columns.real.len() < 3 {
            return Err(self.error(
                self.text.position(),
                "the block of nodes has no columns for a number and three coordinates",
            ));
        }
        while let Some(row) = self.row()? {
            let number = self.id(row, &columns, 0, "number of the node")?;
            if number == 0 {
                return Err(self
                    .error(row.1, format!("expected a node or `-1`, found {}", quoted(row.0.trim_ascii()))));
            }
            let mut point = [0.0; 3];
            for (x, column) in point.iter_mut().zip(&columns.real) {
                let field = field(row.0, column);
                if !field.is_empty() {
                    *x = parse_float(field).ok_or_else(|| {
                        self.error(row.1, format!("coordinate: expected a number, found {}", quoted(field)))
                    })?;
                }
            }
            self.model.node_ids.push(number);
            self.model.points.push(point);
        }
        Ok(())
    }

    /// Reads type, number in the library and options.
    fn types(&mut self) -> Result<()> {
        let columns = self.columns()?;
        while let Some(row) = self.row()? {
            let [of, number, option] = [(0, "type"), (1, "element type"), (2, "option")]
                .map(|(column, what)| self.int(row, &columns, column, what));
            self.model.types.define(of?, number?, option.unwrap_or(0));
        }
        Ok(())
    }

    /// Reads elements. Those of a block of solids have a material, type, six numbers, the number of nodes, a
    /// number that is not used, their own number and the nodes, eight in the first line; others have their
    /// own number, type, a number, material, coordinate system and nodes.
    fn elements(&mut self, command: &Command) -> Result<()> {
        let is_solid = command.argument(2).eq_ignore_ascii_case("SOLID");
        let columns = self.columns()?;
        let before = BEFORE_NODES[usize::from(!is_solid)];
        let n_columns = columns.whole.len();
        if n_columns <= before {
            return Err(self.error(
                self.text.position(),
                format!("a block of elements has {n_columns} columns of at least {}", before + 1),
            ));
        }
        let n_of_block = parse_int(command.argument(1).as_bytes());
        let [of_material, of_type, of_number] = if is_solid { [0, 1, 10] } else { [3, 1, 0] };
        while let Some(row) = self.row()? {
            let number = self.id(row, &columns, of_number, "number of the element")?;
            let material = self.int(row, &columns, of_material, "material")?;
            let material = i32::try_from(material)
                .map_err(|_| self.error(row.1, format!("material {material} needs more than 32 bits")))?;
            let of = self.int(row, &columns, of_type, "type of the element")?;
            let declared = if is_solid {
                self.int(row, &columns, 8, "number of nodes")?
            } else {
                n_of_block.unwrap_or(0)
            };
            let Some(n_nodes) = usize::try_from(declared).ok().filter(|_| declared <= MAX_NODES) else {
                return Err(
                    self.error(row.1, format!("expected at most {MAX_NODES} nodes, found {declared}"))
                );
            };
            let mut nodes = Vec::with_capacity(n_nodes);
            let here = if is_solid { n_columns.min(before + 8) } else { n_columns };
            for column in before..here {
                if field(row.0, &columns.whole[column]).is_empty() || is_solid && nodes.len() == n_nodes {
                    break;
                }
                nodes.push(self.id(row, &columns, column, "node of the element")?);
            }
            // The nodes of a line that is full go on in the next.
            let n_here = nodes.len();
            let lacks = |n: usize| format!("element {number} has {n} nodes of {n_nodes}");
            while nodes.len() < n_nodes && n_here == here - before {
                let Some(more) = self.row()? else { return Err(self.error(row.1, lacks(nodes.len()))) };
                let first = nodes.len();
                for column in 0..n_columns.min(n_nodes - first) {
                    if field(more.0, &columns.whole[column]).is_empty() {
                        break;
                    }
                    nodes.push(self.id(more, &columns, column, "node of the element")?);
                }
                let is_longer = columns
                    .whole
                    .get(nodes.len() - first)
                    .is_some_and(|next| !field(more.0, next).is_empty());
                if nodes.len() == first || is_longer {
                    return Err(self.error(row.1, lacks(first)));
                }
            }
            if is_solid && nodes.len() < n_nodes {
                return Err(self.error(row.1, lacks(nodes.len())));
            }
            self.element(row.1, number, of, material, &nodes)?;
        }
        Ok(())
    }

    fn element(&mut self, position: usize, number: u64, of: i64, material: i32, nodes: &[u64]) -> Result<()> {
        let family = match self.model.types.family(of) {
            Ok(family) => family,
            Err(what) => {
                self.model.skipped.insert(what);
                self.model.n_skipped += 1;
                return Ok(());
            }
        };
        let cell = cell(family, nodes).ok_or_else(|| {
            self.error(
                position,
                format!(
                    "element {number} lacks nodes: it has {}",
                    nodes.iter().filter(|node| **node != 0).count()
                ),
            )
        })?;
        self.model.n_lacking += usize::from(cell.lacks_some);
        self.model.element_ids.push(number);
        self.model.kinds.push(cell.kind);
        self.model.materials.push(material);
        self.model.nodes.extend(cell.places.iter().map(|&place| nodes[place]));
        Ok(())
    }

    /// Reads name, `NODE` or `ELEM`, and the number of members.
    fn component(&mut self, command: &Command) -> Result<()> {
        let position = self.text.position();
        let columns = self.columns()?;
        let n = parse_int(command.argument(3).as_bytes()).and_then(|n| usize::try_from(n).ok());
        let Some(n) = n.filter(|_| !columns.whole.is_empty()) else {
            return Err(self.error(
                position,
                format!("component {}: the number of members is missing", command.argument(1)),
            ));
        };
        let mut members = Vec::new();
        while members.len() < n {
            let Some(row) = self.line() else {
                return Err(self
                    .text
                    .unexpected_end(&format!("the {n} members of component {}", command.argument(1))));
            };
            let here = columns.whole.len().min(n - members.len());
            for column in 0..here {
                let member = self.int(row, &columns, column, "member of a component")?;
                if member == 0 {
                    return Err(self.error(
                        row.1,
                        format!("component {} has {} members of {n}", command.argument(1), members.len()),
                    ));
                }
                members.push(member);
            }
        }
        let is_of_nodes = match command.argument(2).to_ascii_uppercase() {
            sort if sort.starts_with("NODE") => true,
            sort if sort.starts_with("ELE") => false,
            sort => {
                self.model.skipped.insert(format!("components of {sort}"));
                return Ok(());
            }
        };
        self.model.components.push(Component { name: command.argument(1).to_owned(), is_of_nodes, members });
        Ok(())
    }
}

/// Numbers in rising order with their places, to find those in a range.
struct Places<'a> {
    tags: &'a Tags,
    rising: Vec<u64>,
}

impl<'a> Places<'a> {
    fn new(tags: &'a Tags, numbers: &[u64]) -> Self {
        let mut rising = numbers.to_vec();
        rising.sort_unstable();
        Self { tags, rising }
    }

    /// The ranks of the numbers from `first` to `last` that exist.
    fn ranks(&self, first: u64, last: u64) -> Range<u32> {
        let from = self.rising.partition_point(|&number| number < first);
        let to = self.rising.partition_point(|&number| number <= last).max(from);
        from as u32..to as u32
    }

    /// The places of the numbers with these ranks.
    fn places(&self, ranks: Runs) -> Runs {
        let numbers = merged(ranks).into_iter().flatten().map(|rank| self.rising[rank as usize]);
        merged(numbers.filter_map(|number| self.tags.place(number)).map(|place| place..place + 1).collect())
    }
}

impl Component {
    /// The component with its members' places; `None` if it has none. Ranges hold the numbers that exist, so
    /// only a single number that does not is missing.
    fn named(&self, places: &Places<'_>, may_lack: bool, notes: &Notes) -> Option<Named> {
        let mut ranks = Runs::new();
        let mut n_missing = 0;
        let mut before = 0;
        for &member in &self.members {
            let number = member.unsigned_abs();
            let own = match member {
                1.. => places.ranks(number, number),
                _ if number > before && before > 0 => places.ranks(before + 1, number),
                _ => 0..0,
            };
            n_missing += usize::from(member > 0 && own.is_empty());
            ranks.extend((!own.is_empty()).then_some(own));
            before = number;
        }
        if n_missing > 0 && !may_lack {
            notes.add(format!("component {} has nonexistent members: {n_missing}", self.name));
        }
        let runs = places.places(ranks);
        (!runs.is_empty()).then(|| Named { name: self.name.clone(), number: 0, runs, rank: Rank::Declared })
    }
}

impl Model {
    fn into_mesh(self, notes: &Notes) -> Result<Mesh> {
        if self.points.is_empty() {
            let error = Error::input("there are no nodes (NBLOCK)");
            return Err(match self.n_single {
                0 => error.remedy("the file contains no mesh or is truncated: get a new copy"),
                _ => error.remedy("write the file with blocks: CDWRITE,DB,file,cdb,,,,BLOCKED"),
            });
        }
        if self.points.len() > VertexId::MAX_COUNT {
            return Err(Error::input("more nodes than a mesh can hold"));
        }
        self.note(notes);
        let node_tags = Tags::new(&self.node_ids, "node")?;
        let element_tags = Tags::new(&self.element_ids, "element")?;
        let mut cells = Cells::new();
        let elements = self.element_ids.iter().copied().zip(self.kinds.iter().copied());
        push_elements(&mut cells, elements, &self.nodes, |node| node_tags.place(node))?;
        let (n_cells, n_points) = (cells.len(), self.points.len());
        let mut mesh = Mesh::new(self.points, cells);
        let (mut of_cells, mut of_points) = (NamedSets::default(), NamedSets::default());
        let nodes = Places::new(&node_tags, &self.node_ids);
        let elements = Places::new(&element_tags, &self.element_ids);
        let mut n_members = 0;
        for component in &self.components {
            let (places, sets) = match component.is_of_nodes {
                true => (&nodes, &mut of_points),
                false => (&elements, &mut of_cells),
            };
            let may_lack = !component.is_of_nodes && self.n_skipped > 0;
            let Some(set) = component.named(places, may_lack, notes) else { continue };
            n_members += set.runs.iter().map(Range::len).sum::<usize>();
            if n_members > MAX_MEMBERS {
                return Err(Error::input(format!(
                    "components have more than {MAX_MEMBERS} members together"
                ))
                .remedy("write the file with fewer components"));
            }
            sets.add(set);
        }
        let sets = sets_of_cells(of_cells, &self.kinds, &self.materials);
        set_labels(&mut mesh, n_cells, &sets, notes);
        set_arrays(&mut mesh.point_data, NSET, of_points.all.iter(), n_points, notes);
        Ok(mesh)
    }

    fn note(&self, notes: &Notes) {
        for what in &self.skipped {
            let elements = if what.starts_with("components") { "" } else { "elements of " };
            notes.add(format!("{elements}{what} are skipped"));
        }
        if self.n_lacking > 0 {
            let n = self.n_lacking;
            notes.add(format!(
                "{n} elements lack some of their middle nodes: they are read without middle nodes"
            ));
        }
        if self.n_single > 0 {
            notes.add("commands for single nodes and elements are skipped: only blocks are read");
        }
        if !self.others.is_empty() {
            let listed: Vec<&str> = self.others.iter().take(MAX_LISTED).map(String::as_str).collect();
            let more = if self.others.len() > MAX_LISTED { ", ..." } else { "" };
            notes.add(format!("other commands are skipped: {}{more}", listed.join(", ").escape_debug()));
        }
    }
}
