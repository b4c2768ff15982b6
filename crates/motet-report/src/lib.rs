//! Meshes, series of meshes and logs as one HTML page: a view to turn and cut, charts, tables.
//!
//! The page is one file and works offline. Its size has a budget: the surface of each frame comes first, then
//! its inside, or the cells at a number of planes, and the page says what was left out. The same inputs give
//! the same bytes.
//!
//! | file | idea |
//! |---|---|
//! | `input`, `log` | inputs: meshes, read one at a time; JSON, whatever its keys |
//! | `quality`, `arrays` | what is reported of a mesh, and by what it can be coloured |
//! | `labels` | patches and regions, and which of them are transparent at first |
//! | `skin`, `layout`, `layouts` | what is visible from outside; the order of everything on the page, shared by frames of the same cells |
//! | `codec`, `store` | compact tables of numbers, each stored once |
//! | `part`, `plan`, `shown` | packing one frame; how much of which frame fits; the result |
//! | `words` | titles of arrays and columns, with units |
//! | `charts`, `sections`, `page` | lines, tables, the page |
//! | `live` | a page whose mesh a program keeps up to date while a user moves it |
//! | `script/`, `style.css`, `page.html` | the part that runs in the browser |

mod arrays;
mod charts;
mod codec;
mod input;
mod labels;
mod layout;
mod layouts;
mod live;
mod log;
mod numbers;
mod page;
mod part;
mod plan;
mod quality;
mod sections;
mod shown;
mod skin;
mod store;
mod words;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use motet::{Error, Result, io};
use serde::Serialize;

pub use crate::live::{Live, Order, Update};

use crate::input::{Input, name_of};
use crate::page::{Look, Page};
use crate::part::Holds;
use crate::shown::Shown;
use crate::store::Store;

/// Options of a page.
#[derive(Clone, Debug)]
pub struct Options {
    /// The file to write; its extension is `.html` or `.htm`.
    pub output: PathBuf,
    /// The title of the page; by default the names of the inputs.
    pub title: Option<String>,
    /// How many bytes of the page meshes may take. Surfaces are always included.
    pub budget: usize,
}

impl Options {
    /// The default of [`Options::budget`]: 24 MB.
    pub const BUDGET: usize = 24_000_000;

    /// Options for a page at `output`, with the default budget.
    pub fn new(output: impl Into<PathBuf>) -> Self {
        Self { output: output.into(), title: None, budget: Self::BUDGET }
    }
}

/// What was written and what was left out.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The file of the page.
    pub output: PathBuf,
    /// Size of the page.
    pub bytes: usize,
    /// Number of bytes that meshes take.
    pub payload_bytes: usize,
    /// Number of bytes that meshes were allowed to take.
    pub budget_bytes: usize,
    /// A report for each input, in the order of the call.
    pub inputs: Vec<InputReport>,
}

/// What was written of one input.
#[derive(Clone, Debug, Serialize)]
pub struct InputReport {
    /// Path of the input.
    pub file: PathBuf,
    /// Number of frames of a mesh or series; 0 for a log.
    pub frames: usize,
    /// Number of frames with a picture.
    pub shown: usize,
    /// Number of frames that can be cut anywhere, since they contain all volume cells.
    pub whole: usize,
    /// Number of frames that can be cut at some planes.
    pub cut: usize,
    /// Number of rows of a log's longest table.
    pub rows: usize,
    /// What is not on the page, a sentence each.
    pub left_out: Vec<String>,
}

/// Writes a page about `inputs`: meshes and series in any format that motet reads, reports (`.json`) and logs
/// (`.jsonl`).
///
/// # Errors
/// When an input cannot be read or is empty, naming the file and the place; when the output's extension is
/// not that of a page, or the output would overwrite an input.
pub fn write(inputs: &[PathBuf], options: &Options) -> Result<Report> {
    check(inputs, options)?;
    let mut opened = inputs.iter().map(|path| Input::open(path)).collect::<Result<Vec<_>>>()?;
    let mut store = Store::default();
    let mut paid = BTreeSet::new();
    let mut parts = Vec::new();
    let mut n_meshes = opened.iter().filter(|input| matches!(input, Input::Meshes(_))).count();
    for input in opened.drain(..) {
        parts.push(match input {
            Input::Log(log) => page::Part::Log(log),
            Input::Meshes(meshes) => {
                let left = options.budget.saturating_sub(spent(&store, &paid));
                let shown = plan::shown(&meshes, left / n_meshes.max(1), &mut store, &mut paid)?;
                n_meshes -= 1;
                page::Part::Meshes(Box::new(shown))
            }
        });
    }
    let page = Page { parts: &parts, store: &store, used: &paid };
    let title = options.title.as_deref();
    let page = page.rendered(Look { title, budget: Some(options.budget), is_live: false })?;
    io::replace(&options.output, page.as_bytes())?;
    let inputs = inputs.iter().zip(&parts).map(|(file, part)| report_of(file, part)).collect();
    Ok(Report {
        output: options.output.clone(),
        bytes: page.len(),
        payload_bytes: spent(&store, &paid),
        budget_bytes: options.budget,
        inputs,
    })
}

fn spent(store: &Store, paid: &BTreeSet<usize>) -> usize {
    paid.iter().map(|&id| store.get(id).cost()).sum()
}

fn check(inputs: &[PathBuf], options: &Options) -> Result<()> {
    let output = &options.output;
    if inputs.is_empty() {
        return Err(Error::options("no input: at least one is expected")
            .remedy("give a mesh, a series, or a JSON file"));
    }
    let extension = output.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    if !matches!(extension.as_deref(), Some("html" | "htm")) {
        return Err(Error::options(format!("the name of a page must end in .html; got {}", name_of(output)))
            .in_file(output)
            .remedy("give --output a name that ends in .html"));
    }
    if inputs.iter().any(|input| io::is_same_file(input, output)) {
        return Err(Error::options("the page would overwrite one of its inputs")
            .in_file(output)
            .remedy("give --output another name"));
    }
    Ok(())
}

fn report_of(file: &Path, part: &page::Part) -> InputReport {
    let mut report = InputReport {
        file: file.to_owned(),
        frames: 0,
        shown: 0,
        whole: 0,
        cut: 0,
        rows: 0,
        left_out: Vec::new(),
    };
    match part {
        page::Part::Log(log) => report.rows = log.tables.iter().map(|table| table.n_rows).max().unwrap_or(0),
        page::Part::Meshes(shown) => report_meshes(&mut report, shown),
    }
    report
}

fn report_meshes(report: &mut InputReport, shown: &Shown) {
    let count = |is: fn(Holds) -> bool| {
        shown.frames.iter().filter(|frame| frame.inside.as_ref().is_some_and(|x| is(x.holds))).count()
    };
    report.frames = shown.facts.len();
    report.shown = shown.frames.len();
    report.whole = count(|holds| holds == Holds::All);
    report.cut = count(|holds| matches!(holds, Holds::Planes(_)));
    report.left_out.clone_from(&shown.left_out);
}
