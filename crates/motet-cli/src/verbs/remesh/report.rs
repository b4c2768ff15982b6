//! The report of `motet remesh`: tables for people, an object for programs.

use std::path::PathBuf;

use motet::Mesh;
use motet::base::{Point, Threads};
use motet::mesh::Qualities;
use motet::mesh::history::{FieldLedger, History, Ledger, On, Rule};
use motet::remesh::classify::DEFECT_NAMES;
use motet::remesh::{self, Counts, LONG, Lengths, Reason, SHORT, SizesReport, SurfaceName};
use serde::Serialize;
use serde_json::{Value, json};

use super::args::RemeshArgs;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::quality;
use crate::table::{Table, count, seconds, short};
use crate::words;

/// How many of the remaining bad tets are listed without `--verbose`.
const N_LISTED: usize = 10;

/// All results of `motet remesh`.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    #[serde(serialize_with = "words::paths")]
    mesh: PathBuf,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    /// Where the history was written, if it was.
    #[serde(serialize_with = "words::paths")]
    history: Option<PathBuf>,
    /// Whether no bad tet is left.
    complete: bool,
    min_eas: f64,
    before: State,
    after: State,
    /// How often each operation was made.
    operations: Counts,
    /// Number of tets that are unchanged, to the bit.
    kept: usize,
    /// Unchanged tets as a share of the input tets.
    untouched: f64,
    /// Tets of boundary layers that would count as bad, and were kept.
    layers: usize,
    /// Held tets that would count as bad, and were kept.
    held: usize,
    /// Edges compared with the requested sizes; null where none were requested.
    sizes: Option<SizesReport>,
    left: Vec<Left>,
    /// How well the volumes of old and new tets agree; `null` where no array was carried and no history was
    /// written.
    volumes: Option<Ledger>,
    /// How well arrays of real numbers were carried.
    fields: Vec<FieldLedger>,
    passed_over: Vec<String>,
    lost: Vec<String>,
    seconds: Stages,
    #[serde(skip)]
    surface_is_kept: bool,
}

/// The state of a mesh before or after.
#[derive(Debug, Serialize)]
struct State {
    points: usize,
    cells: usize,
    tets: usize,
    bad: usize,
    /// Thin tets of boundary layers, which are not bad.
    layers: usize,
    /// Number of bad tets of each type.
    types: Value,
    inverted: usize,
    worst_eas: Option<Worst>,
    /// Quality of all tets, including those of boundary layers; null where there are none.
    quality: Option<Qualities>,
}

#[derive(Debug, Serialize)]
struct Worst {
    value: f64,
    cell: u32,
    place: Point,
}

/// A bad tet that could not be repaired.
#[derive(Debug, Serialize)]
struct Left {
    cell: u32,
    eas: f64,
    place: Point,
    #[serde(rename = "type")]
    defect: &'static str,
    reason: Reason,
    /// The reason in words.
    why: String,
}

/// Seconds by stage.
#[derive(Debug, Default, Serialize)]
struct Stages {
    read: f64,
    join: f64,
    repair: f64,
    extract: f64,
    history: f64,
    fields: f64,
    write: f64,
    total: f64,
}

impl Report {
    pub(crate) fn new(
        args: &RemeshArgs,
        [old, new]: [&Mesh; 2],
        threads: &Threads,
        report: &remesh::Report,
        history: Option<&History>,
        fields: Vec<FieldLedger>,
    ) -> Self {
        let left = |left: &remesh::Left| Left {
            cell: left.tet.0,
            eas: left.eas,
            place: left.place,
            defect: left.defect,
            reason: left.reason,
            why: left.reason.to_string(),
        };
        let remesh::Seconds { join, repair, extract, history: carried } = report.seconds;
        Self {
            mesh: args.mesh.clone(),
            output: args.output.clone(),
            history: args.arrays.history.clone(),
            complete: report.is_complete(),
            min_eas: report.min_eas,
            before: State::of(old, &report.before, threads),
            after: State::of(new, &report.after, threads),
            operations: report.operations,
            kept: report.kept,
            untouched: report.kept_share,
            layers: report.layers,
            held: report.held,
            sizes: report.sizes,
            left: report.left.iter().map(left).collect(),
            volumes: history.map(|history| history.ledger.clone()),
            fields,
            passed_over: Vec::new(),
            lost: Vec::new(),
            seconds: Stages { join, repair, extract, history: carried, ..Stages::default() },
            surface_is_kept: args.surface == SurfaceName::Keep,
        }
    }

    pub(crate) fn end(
        &mut self,
        [read, fields, write, total]: [f64; 4],
        passed_over: Vec<String>,
        lost: Vec<String>,
    ) {
        self.seconds = Stages { read, fields, write, total, ..std::mem::take(&mut self.seconds) };
        (self.passed_over, self.lost) = (passed_over, lost);
    }

    pub(crate) fn print(&self, outcome: &Outcome, console: &Console) {
        console.conclude(self, outcome);
        console.print(format_args!(
            "{}: {} points, {} tets; tets below EAS {} are bad",
            self.mesh.display(),
            count(self.before.points),
            count(self.before.tets),
            (self.min_eas * 1e4).round() / 1e4
        ));
        if self.before.bad > 0 {
            console.print(self.type_table());
        }
        if self.before.bad > 0 || self.sizes.is_some() {
            console.print(self.operation_words());
        }
        console.print(self.state_table());
        let states = [("before", self.before.quality), ("after", self.after.quality)];
        console.print(quality::table(states));
        if let Some(sizes) = &self.sizes {
            console.print(Self::size_table(sizes));
        }
        console.print(format_args!(
            "kept to the bit: {} of {} tets, {} %",
            count(self.kept),
            count(self.before.tets),
            percent(self.untouched)
        ));
        if self.layers > 0 {
            console.print(format_args!(
                "kept as boundary layers: {} thin tets, not counted as bad",
                count(self.layers)
            ));
        }
        if self.held > 0 {
            console.print(format_args!("held: {} bad tets, not counted as bad", count(self.held)));
        }
        if !self.fields.is_empty() {
            console.print(self.field_table());
        }
        self.print_remaining(console);
        console.print(format_args!("wrote {}", self.output.display()));
        if let Some(history) = &self.history {
            console.print(format_args!("wrote {}", history.display()));
        }
        let Stages { read, join, repair, extract, history, fields, write, total } = self.seconds;
        let [read, join, repair, extract, history, fields, write, total] =
            [read, join, repair, extract, history, fields, write, total].map(seconds);
        console.print(format_args!(
            "read {read}, joined {join}, repaired {repair}, extracted {extract}, arrays carried {history}, \
             reported {fields}, \
             wrote {write}, all {total}"
        ));
    }

    fn type_table(&self) -> Table {
        let mut table = Table::new(["type", "found", "left"]);
        let n = |state: &State, name: &str| count(state.types[name].as_u64().unwrap_or(0) as usize);
        for name in DEFECT_NAMES {
            table.row([name.to_string(), n(&self.before, name), n(&self.after, name)]);
        }
        table.row(["all".to_string(), count(self.before.bad), count(self.after.bad)]);
        table
    }

    fn operation_words(&self) -> String {
        let Counts {
            edge_removal,
            face_removal,
            split_crossed,
            split_onto,
            collapse,
            split_edge,
            smoothing,
            insertion,
            peeling,
        } = self.operations;
        let made = [
            ("edges removed", edge_removal),
            ("facets removed", face_removal),
            ("crossed edges split", split_crossed),
            ("edges split at a vertex", split_onto),
            ("edges collapsed", collapse),
            ("edges split", split_edge),
            ("vertices moved", smoothing),
            ("vertices inserted", insertion),
            ("folded tets removed", peeling),
        ];
        let made: Vec<String> =
            made.into_iter().filter(|m| m.1 > 0).map(|(what, n)| format!("{what} {}", count(n))).collect();
        if made.is_empty() { "nothing was changed".into() } else { format!("done: {}", made.join(", ")) }
    }

    fn state_table(&self) -> Table {
        let mut table = Table::new(["", "before", "after"]);
        let mut row = |what: &str, of: &dyn Fn(&State) -> String| {
            table.row([what.to_string(), of(&self.before), of(&self.after)]);
        };
        row("points", &|s| count(s.points));
        row("tets", &|s| count(s.tets));
        row("bad", &|s| count(s.bad));
        row("inverted", &|s| count(s.inverted));
        let worst =
            |of: fn(&Worst) -> String| move |s: &State| s.worst_eas.as_ref().map_or("-".to_string(), of);
        row("worst EAS", &worst(|w| short(w.value)));
        row("in cell", &worst(|w| w.cell.to_string()));
        row("at", &worst(|w| place(w.place)));
        table
    }

    /// A table of the arrays of real numbers: how each was carried, its range, and the deviation of its
    /// integral.
    fn field_table(&self) -> Table {
        let mut table = Table::new(["array", "on", "carried", "before", "after", "error of integral"]);
        let range =
            |r: Option<[f64; 2]>| r.map_or("-".to_string(), |[a, b]| format!("{} .. {}", short(a), short(b)));
        for field in &self.fields {
            let on = match field.on {
                On::Points => "points",
                On::Cells => "cells",
            };
            let rule = match field.rule {
                Rule::Interpolate => "interpolated",
                Rule::Linear => "interpolated linearly",
                Rule::Conserve => "conserved",
                Rule::Inherit => "inherited",
                Rule::Drop => "dropped",
            };
            table.row([
                field.name.clone(),
                on.into(),
                rule.into(),
                range(field.range_before),
                range(field.range_after),
                format!("{:.0e}", field.deviation()),
            ]);
        }
        table
    }

    /// A table of edges compared with their sizes.
    fn size_table(sizes: &SizesReport) -> Table {
        let mut table = Table::new(["edges compared with their sizes", "before", "after"]);
        let mut row = |what: &str, of: &dyn Fn(&Lengths) -> String| {
            table.row([what.to_string(), of(&sizes.before), of(&sizes.after)]);
        };
        row("all", &|l| count(l.edges));
        row(&format!("longer than {LONG}"), &|l| count(l.too_long));
        row("  of them held", &|l| count(l.too_long_held));
        row(&format!("shorter than {SHORT}"), &|l| count(l.too_short));
        row("  of them held", &|l| count(l.too_short_held));
        row("shortest", &|l| short(l.min));
        row("mean", &|l| short(l.mean));
        row("longest", &|l| short(l.max));
        row("spread", &|l| short(l.spread));
        table
    }

    fn print_remaining(&self, console: &Console) {
        if self.complete {
            return;
        }
        let n = if console.is_verbose() { self.left.len() } else { N_LISTED };
        if !self.left.is_empty() {
            console.print("left:");
        }
        for left in self.left.iter().take(n) {
            console.print(format_args!(
                "  cell {} at {}, EAS {}, type {}: {}",
                left.cell,
                place(left.place),
                short(left.eas),
                left.defect,
                left.why
            ));
        }
        if self.left.len() > n {
            console.print(format_args!("  and {} more; -v or --json lists all", count(self.left.len() - n)));
        }
    }

    /// Why the requested result was not reached, with advice.
    pub(super) fn not_reached(&self, report: &remesh::Report) -> Option<String> {
        let is_held = |left: &&Left| !matches!(left.reason, Reason::NothingHelps);
        let n_held = self.left.iter().filter(is_held).count();
        let advice = match self.surface_is_kept && n_held > 0 {
            true => format!("; the surface constrains {}, --surface adapt lets it change", count(n_held)),
            false => String::new(),
        };
        report.not_reached().map(|why| why + &advice)
    }
}

impl State {
    fn of(mesh: &Mesh, state: &remesh::State, threads: &Threads) -> Self {
        let [i, ii, iii, iv, other] = state.types;
        Self {
            points: mesh.points.len(),
            cells: mesh.cells.len(),
            tets: state.tets,
            bad: state.bad,
            layers: state.layers,
            types: json!({ "I": i, "II": ii, "III": iii, "IV": iv, "other": other }),
            inverted: state.inverted,
            worst_eas: state.worst.map(|w| Worst { value: w.eas, cell: w.tet.0, place: w.place }),
            quality: Qualities::of_mesh(mesh, threads),
        }
    }
}

fn place(p: Point) -> String {
    p.map(short).join(", ")
}

/// A share in percent, rounded down, so that only the whole gives 100.
fn percent(share: f64) -> String {
    let floored = (share * 1e4).floor() / 1e2;
    floored.to_string()
}
