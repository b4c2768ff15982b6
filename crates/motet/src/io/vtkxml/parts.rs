//! Files that refer to others: parts of a parallel run (`.pvtu`, `.pvtp`), and blocks of several meshes
//! (`.vtm`, `.vtpd`), each a region or patch under its name.

use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

use crate::base::{Error, Result};
use crate::io::format::Input;
use crate::io::labels::extract_label_names;
use crate::io::memory_budget::MemoryBudget;
use crate::io::vtkxml::document::Element;
use crate::io::vtkxml::file::File;
use crate::io::vtkxml::pieces::{JoinedPieces, common_arrays};
use crate::io::vtkxml::{vtp, vtu};
use crate::io::weld::weld;
use crate::mesh::{CellKind, Field, Labels, Mesh};

/// Maximum depth of files that refer to files, which also stops cycles: blocks nest, and may refer to files
/// of parts.
const MAX_DEPTH: usize = 4;

/// Whether a kind of file refers to others.
pub(super) fn refers_to_parts(kind: &str) -> bool {
    matches!(kind, "PUnstructuredGrid" | "PPolyData") || is_multi_block(kind)
}

fn is_multi_block(kind: &str) -> bool {
    matches!(
        kind,
        "vtkMultiBlockDataSet"
            | "vtkPartitionedDataSet"
            | "vtkPartitionedDataSetCollection"
            | "vtkMultiPieceDataSet"
    )
}

/// A part: its name, after those of the blocks that it is in, and its mesh.
struct Part {
    path: Vec<String>,
    mesh: Mesh,
}

struct Reader<'a> {
    input: &'a Input<'a>,
    budget: Rc<MemoryBudget>,
}

/// Reads all files that `file` refers to, in its order, and joins them.
pub(super) fn read(file: &File<'_>, input: &Input<'_>) -> Result<Mesh> {
    let reader = Reader { input, budget: Rc::new(MemoryBudget::of(input.bytes.len() as u64)) };
    let mut parts = Vec::new();
    reader.parts(file, input.path, &[], &mut parts, 0)?;
    let is_multi_block = is_multi_block(file.kind());
    if is_multi_block {
        label_blocks(&mut parts);
        common_arrays(parts.iter_mut().map(|part| &mut part.mesh), input.notes);
    }
    let mut whole = JoinedPieces::default();
    for part in parts {
        whole.add(part.mesh).map_err(|e| e.at(part.path.join("/")))?;
    }
    let (mut mesh, starts) = whole.into_parts();
    weld(&mut mesh, &starts, input.notes);
    extract_label_names(&mut mesh);
    Ok(mesh)
}

impl Reader<'_> {
    /// Reads what a file refers to, which has names `names` itself.
    fn parts(
        &self,
        file: &File<'_>,
        path: &Path,
        names: &[String],
        parts: &mut Vec<Part>,
        depth: usize,
    ) -> Result<()> {
        if depth > MAX_DEPTH {
            return Err(Error::input(format!("files refer to files more than {MAX_DEPTH} levels deep"))
                .in_file(path)
                .remedy("write the data as one file"));
        }
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut sources = Vec::new();
        collect(file.data_set()?, names, &mut sources);
        for (names, source, line) in sources {
            let path = folder.join(&source);
            let place = || format!("line {line}");
            self.part(&names, &path, depth, parts).map_err(|e| e.in_file(&path).at(place()))?;
        }
        Ok(())
    }

    fn part(&self, names: &[String], path: &Path, depth: usize, parts: &mut Vec<Part>) -> Result<()> {
        let bytes = std::fs::read(path).map_err(|e| {
            Error::io(path, e)
                .remedy(format!("{} refers to it: keep its files together", self.input.path.display()))
        })?;
        self.budget.add_file(&path.to_string_lossy(), bytes.len() as u64);
        self.budget.take(bytes.len() as u64)?;
        let file = File::open_within(&bytes, self.input.threads, self.input.notes, self.budget.clone())?;
        let mesh = match file.kind() {
            "UnstructuredGrid" => vtu::read(&file)?,
            "PolyData" => vtp::read(&file)?,
            kind if refers_to_parts(kind) => return self.parts(&file, path, names, parts, depth + 1),
            other => {
                self.input.notes.add(format!(
                    "{}: {other} is skipped: it has no cells that motet supports",
                    path.display()
                ));
                return Ok(());
            }
        };
        mesh.validate()?;
        parts.push(Part { path: names.to_vec(), mesh });
        Ok(())
    }
}

/// Collects the names, file and line of every reference within an element, in the order of the file.
fn collect(element: &Element<'_>, names: &[String], found: &mut Vec<(Vec<String>, String, usize)>) {
    let own = element.attribute("name").or(element.attribute("Name")).map(str::to_owned);
    let names: Vec<String> = names.iter().cloned().chain(own).collect();
    let file = match element.name.as_str() {
        "Piece" => element.attribute("Source"),
        "DataSet" => element.attribute("file"),
        _ => None,
    };
    if let Some(file) = file {
        found.push((names.clone(), file.to_owned(), element.line));
    }
    element.children.iter().for_each(|child| collect(child, &names, found));
}

/// The names of blocks: the last one where that tells blocks apart, otherwise all. Parts of a block have one.
fn block_names(parts: &[Part]) -> Vec<String> {
    let last = |part: &Part| part.path.last().cloned().unwrap_or_default();
    let mut path_of: HashMap<String, &[String]> = HashMap::new();
    let mut repeated = HashSet::new();
    for part in parts {
        if *path_of.entry(last(part)).or_insert(&part.path) != part.path {
            repeated.insert(last(part));
        }
    }
    let name = |part: &Part| if repeated.contains(&last(part)) { part.path.join("/") } else { last(part) };
    parts.iter().map(name).collect()
}

type LabelsOf = fn(&Mesh) -> Option<Labels>;

/// Turns names of blocks into labels if the blocks have none: regions of volume cells, patches of surface
/// cells.
fn label_blocks(parts: &mut [Part]) {
    let names = block_names(parts);
    let mut label_of: HashMap<&str, i32> = HashMap::new();
    let mut numbers = Vec::new();
    for (name, label) in names.iter().zip(1..) {
        numbers.push(if name.is_empty() { label } else { *label_of.entry(name).or_insert(label) });
    }
    let labels: [(usize, &str, LabelsOf); 2] = [(3, "region", Mesh::regions), (2, "patch", Mesh::patches)];
    for (dim, array, of) in labels {
        let holds = |part: &Part| part.mesh.cells.kinds().iter().any(|kind| kind.dim() == Some(dim));
        if parts.iter().filter(|part| holds(part)).count() < 2 && dim == 3
            || parts.iter().any(|part| of(&part.mesh).is_some())
        {
            continue;
        }
        for ((&label, name), part) in numbers.iter().zip(&names).zip(parts.iter_mut()) {
            let is_of = |kind: &CellKind| if kind.dim() == Some(dim) { label } else { 0 };
            let ids: Vec<i32> = part.mesh.cells.kinds().iter().map(is_of).collect();
            if ids.iter().any(|&id| id != 0) && !name.is_empty() {
                part.mesh.field_data.push(Field::scalars(format!("{array}:{name}"), vec![label]));
            }
            part.mesh.set_cell_field(Field::scalars(array, ids));
        }
    }
}
