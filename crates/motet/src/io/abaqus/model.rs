//! The model built from the lines of input files, one line at a time.

use std::collections::{BTreeSet, HashMap};

use super::kinds::{ElementType, vtk_to_abaqus};
use super::line::{Keyword, Label, Reference, Target, fields, float, id};
use super::scope::{Entry, Placement, Scope, Sets, SurfaceDefinition};
use crate::base::{Error, Result};
use crate::io::format::Notes;

/// Everything read so far, and the block that the next data line belongs to.
pub(super) struct Model<'n> {
    /// The flat file and the assembly.
    pub(super) top: Scope,
    parts: Vec<Scope>,
    /// Whether a part has an instance.
    is_used: Vec<bool>,
    pub(super) instances: Vec<Scope>,
    part_of_key: HashMap<String, usize>,
    here: Here,
    block: Block,
    /// Bytes taken by further instances of a part, beyond the first.
    n_copied: usize,
    skipped_keywords: BTreeSet<String>,
    notes: &'n Notes,
}

#[derive(Clone, Copy)]
enum Here {
    Top,
    Part(usize),
    Instance(usize),
}

/// The block that data lines belong to.
enum Block {
    /// No keyword has been read yet.
    Start,
    Ignored,
    Nodes(Option<usize>),
    Elements(Elements),
    Set {
        is_of_nodes: bool,
        set: usize,
        generates: bool,
        instance: Option<String>,
    },
    Surface(usize),
    /// Placement of an instance, with the number of its lines read so far.
    Placement(usize),
}

struct Elements {
    name: String,
    of: ElementType,
    /// For each node in VTK's order, its position in Abaqus's order.
    order: Vec<usize>,
    set: Option<usize>,
    /// Numbers of the element being read: its own, then those of its nodes.
    pending: Vec<u64>,
}

/// Bound in bytes on the copies made for instances, since a small file could request any amount of memory.
const MAX_COPIED_BYTES: usize = 1 << 30;

/// Keywords that generate or move nodes or elements; without them the mesh would be a different one.
const REFUSED: &[&str] =
    &["NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "SYSTEM", "SYMMETRICMODELGENERATION"];

/// Keywords that carry nothing a mesh could hold.
const SILENT: &[&str] = &["HEADING", "PREPRINT", "ASSEMBLY", "ENDPART", "ENDASSEMBLY", "ENDINSTANCE"];

impl<'n> Model<'n> {
    pub(super) fn new(notes: &'n Notes) -> Self {
        Self {
            top: Scope::default(),
            parts: Vec::new(),
            is_used: Vec::new(),
            instances: Vec::new(),
            part_of_key: HashMap::new(),
            here: Here::Top,
            block: Block::Start,
            n_copied: 0,
            skipped_keywords: BTreeSet::new(),
            notes,
        }
    }

    fn scope(&mut self) -> &mut Scope {
        match self.here {
            Here::Top => &mut self.top,
            Here::Part(i) => &mut self.parts[i],
            Here::Instance(i) => &mut self.instances[i],
        }
    }

    /// Ends the current block and begins that of a keyword.
    pub(super) fn keyword(&mut self, keyword: &Keyword) -> Result<()> {
        self.end_block()?;
        self.block = match keyword.name.as_str() {
            "NODE" => self.nodes(keyword)?,
            "ELEMENT" => self.elements(keyword)?,
            "NSET" => self.set(keyword, true)?,
            "ELSET" => self.set(keyword, false)?,
            "SURFACE" => self.surface(keyword)?,
            "PART" => self.part(keyword)?,
            "INSTANCE" => self.instance(keyword)?,
            "ENDPART" | "ASSEMBLY" | "ENDASSEMBLY" | "ENDINSTANCE" => {
                self.here = Here::Top;
                Block::Ignored
            }
            name if REFUSED.contains(&name) => {
                return Err(Error::input(format!(
                    "*{name} generates or moves nodes or elements, which is not supported"
                ))
                .remedy("have the preprocessor write all nodes and elements explicitly"));
            }
            name => {
                if name.ends_with("SECTION")
                    && let Some(label) = keyword.label("ELSET")
                {
                    self.scope().with_section.insert(label.key);
                }
                if !SILENT.contains(&name) {
                    self.skipped_keywords.insert(name.to_owned());
                }
                Block::Ignored
            }
        };
        Ok(())
    }

    fn nodes(&mut self, keyword: &Keyword) -> Result<Block> {
        match keyword.get("SYSTEM") {
            Some("" | "R" | "r") | None => {}
            Some(other) => {
                return Err(Error::input(format!("nodes in coordinate system `{other}` are not supported"))
                    .remedy("write them in Cartesian coordinates"));
            }
        }
        Ok(Block::Nodes(keyword.label("NSET").map(|label| self.scope().node_sets.named(label))))
    }

    fn elements(&mut self, keyword: &Keyword) -> Result<Block> {
        let name = Label::new(keyword.expect("TYPE")?).key;
        let Some(of) = ElementType::of(&name) else {
            self.notes.add(format!("elements of type {name} are skipped: motet has no such cell kind"));
            return Ok(Block::Ignored);
        };
        let set = keyword.label("ELSET").map(|label| self.scope().element_sets.named(label));
        let order = vtk_to_abaqus(of.kind, of.n_nodes);
        Ok(Block::Elements(Elements { name, of, order, set, pending: Vec::new() }))
    }

    fn set(&mut self, keyword: &Keyword, is_of_nodes: bool) -> Result<Block> {
        let label = Label::new(keyword.expect(if is_of_nodes { "NSET" } else { "ELSET" })?);
        let scope = self.scope();
        let sets = if is_of_nodes { &mut scope.node_sets } else { &mut scope.element_sets };
        let set = sets.named(label);
        sets.all[set].is_declared = true;
        sets.all[set].is_internal |= keyword.get("INTERNAL").is_some();
        if let Some(elements) = keyword.label("ELSET").filter(|_| is_of_nodes) {
            sets.entries.push((set, Entry::NodesOf(elements.key)));
        }
        let instance = keyword.label("INSTANCE").map(|label| label.key);
        Ok(Block::Set { is_of_nodes, set, generates: keyword.get("GENERATE").is_some(), instance })
    }

    fn surface(&mut self, keyword: &Keyword) -> Result<Block> {
        let label = Label::new(keyword.expect("NAME")?);
        let is_of_elements =
            keyword.get("TYPE").is_none_or(|t| t.is_empty() || t.eq_ignore_ascii_case("ELEMENT"));
        if !is_of_elements || ["COMBINE", "CROP"].iter().any(|p| keyword.get(p).is_some()) {
            self.notes.add(format!("surface {} is skipped: it is not made of element faces", label.shown));
            return Ok(Block::Ignored);
        }
        let is_internal = keyword.get("INTERNAL").is_some();
        let surfaces = &mut self.scope().surfaces;
        surfaces.push(SurfaceDefinition { label, is_internal, faces: Vec::new() });
        Ok(Block::Surface(surfaces.len() - 1))
    }

    fn part(&mut self, keyword: &Keyword) -> Result<Block> {
        let name = Label::new(keyword.expect("NAME")?);
        if self.part_of_key.insert(name.key.clone(), self.parts.len()).is_some() {
            return Err(
                Error::input(format!("duplicate part name `{}`", name.shown)).remedy("rename one of them")
            );
        }
        self.here = Here::Part(self.parts.len());
        self.is_used.push(false);
        self.parts.push(Scope { name: Some(name), ..Scope::default() });
        Ok(Block::Ignored)
    }

    /// Starts an instance as a copy of its part.
    fn instance(&mut self, keyword: &Keyword) -> Result<Block> {
        let name = Label::new(keyword.expect("NAME")?);
        let part = Label::new(keyword.expect("PART")?);
        let &place = self.part_of_key.get(&part.key).ok_or_else(|| {
            Error::input(format!(
                "instance `{}` refers to part `{}`, which is not defined before it",
                name.shown, part.shown
            ))
            .remedy("define the part before its instances")
        })?;
        let part = &self.parts[place];
        if std::mem::replace(&mut self.is_used[place], true) {
            self.n_copied += part.n_bytes();
        }
        if self.n_copied > MAX_COPIED_BYTES {
            return Err(Error::input(format!(
                "the copies of parts for instances would take more than {MAX_COPIED_BYTES} bytes"
            ))
            .remedy("write each part to its own file"));
        }
        let scope = Scope { name: Some(name), ..part.clone() };
        self.here = Here::Instance(self.instances.len());
        self.instances.push(scope);
        Ok(Block::Placement(0))
    }

    /// Takes a data line.
    pub(super) fn data(&mut self, line: &str) -> Result<()> {
        let mut block = std::mem::replace(&mut self.block, Block::Ignored);
        let notes = self.notes;
        let scope = self.scope();
        let taken = match &mut block {
            Block::Start => Err(Error::input("data line before the first keyword, which begins with `*`")
                .remedy("check the format of the file: AVS UCD has the same extension")),
            Block::Ignored => Ok(()),
            Block::Nodes(set) => node(scope, *set, &fields(line)),
            Block::Elements(elements) => elements.line(scope, &fields(line), notes),
            &mut Block::Set { is_of_nodes, set, generates, ref instance } => {
                let sets = if is_of_nodes { &mut scope.node_sets } else { &mut scope.element_sets };
                if generates {
                    generate(&fields(line), instance).map(|entry| sets.entries.push((set, entry)))
                } else {
                    fields(line).into_iter().try_for_each(|field| member(sets, set, field, instance))
                }
            }
            Block::Surface(surface) => {
                let row = fields(line);
                let face = row.get(1).map_or(String::new(), |face| face.to_ascii_uppercase());
                let reference = Reference::parse(row.first().copied().unwrap_or_default());
                reference.map(|of| scope.surfaces[*surface].faces.push((of, face)))
            }
            Block::Placement(n) => {
                *n += 1;
                place(&mut scope.placement, *n, &fields(line))
            }
        };
        self.block = block;
        taken
    }

    fn end_block(&mut self) -> Result<()> {
        match std::mem::replace(&mut self.block, Block::Ignored) {
            Block::Elements(elements) if !elements.pending.is_empty() => Err(elements.wrong_node_count()),
            _ => Ok(()),
        }
    }

    /// Ends the last block; parts without instances are used where they are.
    pub(super) fn finish(&mut self) -> Result<()> {
        self.end_block()?;
        if self.instances.is_empty() {
            self.instances = std::mem::take(&mut self.parts);
        }
        self.parts.clear();
        if !self.skipped_keywords.is_empty() {
            let names: Vec<_> = self.skipped_keywords.iter().map(|name| format!("*{name}")).collect();
            self.notes
                .add(format!("keywords that do not describe the mesh are skipped: {}", names.join(", ")));
        }
        Ok(())
    }
}

/// Reads a node: a number and up to three coordinates.
fn node(scope: &mut Scope, set: Option<usize>, row: &[&str]) -> Result<()> {
    let id = id(row.first().copied().unwrap_or_default(), "node number")?;
    let mut point = [0.0; 3];
    for (x, field) in point.iter_mut().zip(row.iter().skip(1)) {
        *x = float(field, "node coordinate")?;
    }
    scope.node_ids.push(id);
    scope.points.push(point);
    if let Some(set) = set {
        scope.node_sets.add(set, id, None);
    }
    Ok(())
}

impl Elements {
    /// Takes a data line; an element continues over lines until it has all its nodes.
    fn line(&mut self, scope: &mut Scope, row: &[&str], notes: &Notes) -> Result<()> {
        for field in row {
            self.pending.push(id(field, "element or node number")?);
        }
        let n = self.of.n_nodes;
        if self.of.may_have_orientation_node && self.pending.len() == n + 2 {
            notes.add("orientation nodes of beams are skipped");
            self.pending.pop();
        }
        if self.pending.len() > n + 1 {
            return Err(self.wrong_node_count());
        }
        if self.pending.len() == n + 1 {
            let number = self.pending[0];
            scope.element_ids.push(number);
            scope.kinds.push(self.of.kind);
            scope.nodes.extend(self.order.iter().map(|&place| self.pending[1 + place]));
            if let Some(set) = self.set {
                scope.element_sets.add(set, number, None);
            }
            self.pending.clear();
        }
        Ok(())
    }

    fn wrong_node_count(&self) -> Error {
        let (of, n) = (&self.name, self.of.n_nodes);
        let number = self.pending.first().copied().unwrap_or_default();
        let found = self.pending.len().saturating_sub(1);
        Error::input(format!("element {number} of type {of}: expected {n} nodes, found {found}"))
            .remedy("the file is truncated or damaged: write it again")
    }
}

/// Adds a member of a set: a number, or a set that is already defined.
fn member(sets: &mut Sets, set: usize, field: &str, instance: &Option<String>) -> Result<()> {
    let reference = Reference::parse(field)?;
    let instance = reference.instance.or_else(|| instance.clone());
    match &reference.to {
        Target::Number(id) => sets.add(set, *id, instance),
        Target::Label(label) if instance.is_none() && sets.find(&label.key).is_none() => {
            return Err(Error::input(format!("set `{}` is used before its definition", label.shown))
                .remedy("define it before the set that refers to it"));
        }
        Target::Label(_) => sets.entries.push((set, Entry::Set(Reference { instance, ..reference }))),
    }
    Ok(())
}

/// Parses a range: first, last and an optional step.
fn generate(row: &[&str], instance: &Option<String>) -> Result<Entry> {
    let what = "range of a set";
    let ids: Vec<u64> = row.iter().map(|field| id(field, what)).collect::<Result<_>>()?;
    let (first, last, step) = match ids[..] {
        [first, last] => (first, last, 1),
        [first, last, step] => (first, last, step),
        _ => {
            return Err(Error::input(format!(
                "{what}: expected two or three numbers (first, last, step), found {}",
                ids.len()
            )));
        }
    };
    if first > last {
        return Err(Error::input(format!(
            "{what}: the first number, {first}, is greater than the last, {last}"
        ))
        .remedy("write the smaller number first"));
    }
    Ok(Entry::Ids { first, last, step, instance: instance.clone() })
}

/// Takes a placement line of an instance: the first translates it, the second rotates it.
fn place(placement: &mut Placement, line: usize, row: &[&str]) -> Result<()> {
    let numbers: Vec<f64> =
        row.iter().map(|f| float(f, "placement of an instance")).collect::<Result<_>>()?;
    let at = |i: usize| numbers.get(i).copied().unwrap_or(0.0);
    match line {
        1 => placement.translation = [at(0), at(1), at(2)],
        2 => {
            let (a, b) = ([at(0), at(1), at(2)], [at(3), at(4), at(5)]);
            if a == b {
                return Err(Error::input("the two points of the rotation axis coincide")
                    .remedy("give two different points"));
            }
            placement.rotation = Some((a, b, at(6)));
        }
        _ => {
            return Err(Error::input("placement of an instance: expected at most two lines, found a third")
                .remedy("remove it"));
        }
    }
    Ok(())
}
