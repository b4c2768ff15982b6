//! The sections below the view, one per input: sentences, charts and tables.

use serde::Serialize;

use crate::charts::{Chart, Drawn, Line};
use crate::input::name_of;
use crate::log::{Cell, Column, Log, Table};
use crate::numbers::{count, counted, short, time};
use crate::shown::{Facts, Shown};
use crate::words::{self, EAS_TITLE};

/// The maximum number of charts of one table; the other columns are in the table only.
const MAX_CHARTS: usize = 12;
/// The maximum number of rows of one table; of more, the first, the last and evenly chosen ones are shown.
const MAX_ROWS: usize = 400;
/// The most informative columns, in the order in which they are charted.
const INFORMATIVE: [&str; 12] = [
    "worst_eas",
    "worst_eas.value",
    "bad",
    "inverted",
    "tets",
    "points",
    "least_gap",
    "least",
    "gap",
    "touched",
    "admissible_fraction",
    "deviation",
];

/// Columns on the quality of tets in a table of frames.
const QUALITY_COLUMNS: [&str; 12] = [
    "tets",
    "worst EAS",
    "at cell",
    "near x, y, z",
    "1 % below",
    "5 % below",
    "median EAS",
    "mean EAS",
    "mean ratio",
    "bad",
    "inverted",
    "angles, degrees",
];

/// The section of one input.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Section {
    pub(crate) name: String,
    /// The index among the inputs with pictures; the section's charts follow the frame shown there.
    pub(crate) view: Option<usize>,
    pub(crate) sentences: Vec<String>,
    pub(crate) notes: Vec<String>,
    pub(crate) charts: Vec<Drawn>,
    pub(crate) has_histograms: bool,
    pub(crate) facts: Vec<(String, String)>,
    pub(crate) tables: Vec<Grid>,
}

impl Section {
    /// Removes all texts, charts and tables.
    pub(crate) fn clear_texts(&mut self) {
        self.sentences.clear();
        self.notes.clear();
        self.charts.clear();
        self.facts.clear();
        self.tables.clear();
    }
}

/// A table in printed form.
#[derive(Clone, Debug, Default, Serialize)]
pub(crate) struct Grid {
    pub(crate) name: String,
    pub(crate) head: Vec<String>,
    /// Whether each column holds numbers, which are aligned to the right.
    pub(crate) numeric: Vec<bool>,
    pub(crate) rows: Vec<Vec<String>>,
    pub(crate) note: Option<String>,
}

/// The section of a mesh or a series.
pub(crate) fn of_meshes(shown: &Shown, view: usize) -> Section {
    Section {
        name: shown.name.clone(),
        view: Some(view),
        sentences: sentences(shown),
        notes: shown.notes.iter().chain(&shown.left_out).cloned().collect(),
        charts: charts(shown),
        has_histograms: shown.facts.iter().any(|facts| facts.quality.is_some()),
        facts: Vec::new(),
        tables: vec![frames(shown)],
    }
}

fn sentences(shown: &Shown) -> Vec<String> {
    let (Some(first), Some(last)) = (shown.facts.first(), shown.facts.last()) else { return Vec::new() };
    let cells = |facts: &Facts| {
        let kinds: Vec<_> = facts.cells.iter().map(|(kind, n)| kind_of_cells(*n, kind)).collect();
        if kinds.is_empty() { "no cells".to_owned() } else { kinds.join(", ") }
    };
    let size = |facts: &Facts| format!("{} points, {}", count(facts.points), cells(facts));
    let mut sentences = Vec::new();
    if shown.is_series {
        let span = format!(
            "{}, time {} to {}",
            counted(shown.facts.len(), "frame"),
            time(first.time),
            time(last.time)
        );
        let same = size(first) == size(last);
        sentences.push(match same {
            true => format!("{span}: {}.", size(first)),
            false => format!("{span}: {} at first, {} at last.", size(first), size(last)),
        });
    } else {
        sentences.push(format!("{}.", size(first)));
    }
    sentences.extend(quality_sentence(shown));
    let gap = shown.facts.iter().filter_map(|f| f.least_gap.map(|gap| (gap.0, f.time)));
    if let Some((gap, at)) = gap.min_by(|a, b| a.0.total_cmp(&b.0)) {
        let when = if shown.is_series { format!(" at time {}", time(at)) } else { String::new() };
        sentences.push(format!("The least gap is {}{when}.", short(gap)));
    }
    sentences
}

/// The number of cells of a kind, in words.
fn kind_of_cells(n: usize, kind: &str) -> String {
    match kind {
        "tetra" => counted(n, "tet"),
        "hexahedron" | "polyhedron" if n != 1 => format!("{} {}", count(n), kind.replace("hedron", "hedra")),
        "vertex" if n != 1 => format!("{} vertices", count(n)),
        kind if kind.chars().all(char::is_alphabetic) => counted(n, kind),
        kind => format!("{} {kind}", count(n)),
    }
}

fn quality_sentence(shown: &Shown) -> Option<String> {
    let worst = shown.facts.iter().filter_map(|f| f.quality.as_ref().map(|q| (q, f.time)));
    let (worst, at) = worst.min_by(|a, b| a.0.eas_min.total_cmp(&b.0.eas_min))?;
    let [x, y, z] = worst.worst_at.map(short);
    let when = if shown.is_series { format!(" at time {}", time(at)) } else { String::new() };
    let last = shown.facts.last()?.quality.as_ref()?;
    let now = if shown.is_series { " in the last frame" } else { "" };
    Some(format!(
        "The worst tet has EAS {} (cell {}, near {x}, {y}, {z}{when}); {} of {} are bad{now}, {} inverted.",
        short(worst.eas_min),
        worst.worst_cell,
        count(last.bad),
        counted(last.tets, "tet"),
        count(last.inverted),
    ))
}

fn charts(shown: &Shown) -> Vec<Drawn> {
    let x: Vec<f64> = shown.facts.iter().map(|facts| facts.time).collect();
    let quality = |of: fn(&crate::quality::Quality) -> f64| -> Vec<Option<f64>> {
        shown.facts.iter().map(|facts| facts.quality.as_ref().map(of)).collect()
    };
    let line = |name: &str, y| Line { name: name.to_owned(), y };
    let chart = |title: &str, lines| Chart {
        title: title.to_owned(),
        x_name: "time".to_owned(),
        x: x.clone(),
        lines,
        ..Chart::default()
    };
    let eas = Chart {
        threshold: Some((motet::mesh::BAD_EAS, "bad below 0.2")),
        from_zero: true,
        ..chart(
            &format!("{EAS_TITLE}: worst, 1 % and mean"),
            vec![
                line("worst", quality(|q| q.eas_min)),
                line("1 % below", quality(|q| q.all.p1)),
                line("mean", quality(|q| q.all.mean)),
            ],
        )
    };
    let bad = Chart {
        from_zero: true,
        ..chart(
            "Number of bad and inverted tets",
            vec![line("bad", quality(|q| q.bad as f64)), line("inverted", quality(|q| q.inverted as f64))],
        )
    };
    let angle = Chart {
        from_zero: true,
        ..chart("Smallest dihedral angle, degrees", vec![line("smallest", quality(|q| q.angle_min))])
    };
    let tets = chart("Number of tets", vec![line("tets", quality(|q| q.tets as f64))]);
    let gap = shown.facts.iter().map(|facts| facts.least_gap.map(|gap| gap.0)).collect();
    let gap = Chart {
        from_zero: true,
        ..chart("Least gap between bodies, in units of the mesh", vec![line("gap", gap)])
    };
    let varies = |chart: &Chart| chart.lines[0].y.windows(2).any(|w| w[0] != w[1]);
    let tets = Some(tets).filter(varies);
    let all = [eas, bad, angle].into_iter().chain(tets).chain([gap]);
    all.filter(Chart::is_drawable).map(|chart| chart.drawn()).collect()
}

/// The table of certificates, with a row per frame.
fn frames(shown: &Shown) -> Grid {
    let has_quality = shown.facts.iter().any(|facts| facts.quality.is_some());
    let has_gap = shown.facts.iter().any(|facts| facts.least_gap.is_some());
    let mut head = vec!["frame", "time", "points", "cells"];
    if has_quality {
        head.extend(QUALITY_COLUMNS);
    }
    if has_gap {
        head.extend(["least gap", "at x, y, z"]);
    }
    let rows = shown.facts.iter().enumerate().map(|(i, facts)| {
        let n_cells = facts.cells.iter().map(|(_, n)| n).sum();
        let mut row = vec![count(i), time(facts.time), count(facts.points), count(n_cells)];
        if has_quality {
            row.extend(quality_cells(facts));
        }
        if has_gap {
            row.extend(match facts.least_gap {
                Some((gap, at)) => [short(gap), at.map(short).join(", ")],
                None => [String::new(), String::new()],
            });
        }
        row
    });
    let rows: Vec<_> = rows.collect();
    let numeric = vec![true; head.len()];
    let head = head.into_iter().map(str::to_owned).collect();
    thinned(Grid { name: "Certificate of each frame".into(), head, numeric, rows, note: None })
}

fn quality_cells(facts: &Facts) -> Vec<String> {
    let Some(q) = &facts.quality else { return vec![String::new(); QUALITY_COLUMNS.len()] };
    vec![
        count(q.tets),
        short(q.eas_min),
        q.worst_cell.to_string(),
        q.worst_at.map(short).join(", "),
        short(q.all.p1),
        short(q.all.p5),
        short(q.all.median),
        short(q.all.mean),
        short(q.all.mean_ratio),
        count(q.bad),
        count(q.inverted),
        format!("{} to {}", short(q.angle_min), short(q.angle_max)),
    ]
}

/// The section of a report or a log.
pub(crate) fn of_log(log: &Log) -> Section {
    let n_rows = log.tables.iter().map(|table| table.n_rows).max().unwrap_or(0);
    let mut sentences = Vec::new();
    if n_rows > 0 {
        sentences.push(format!("{} in {}.", counted(n_rows, "row"), counted(log.tables.len(), "table")));
    }
    let mut charts = Vec::new();
    let mut notes = Vec::new();
    for table in &log.tables {
        let (drawn, left) = table_charts(table);
        charts.extend(drawn);
        if left > 0 {
            notes.push(format!(
                "{} of `{}` have no chart; they are in its table.",
                counted(left, "column"),
                table.name
            ));
        }
    }
    Section {
        name: name_of(&log.file),
        view: None,
        sentences,
        notes,
        charts,
        has_histograms: false,
        facts: log.facts.clone(),
        tables: log.tables.iter().map(grid).collect(),
    }
}

/// Columns drawn as lines of one chart, the quality of all tets, with the names of the lines; matched by the
/// end of the column's name.
const QUALITIES: [(&str, &str); 4] = [
    ("quality.worst", "worst"),
    ("quality.p1", "1 % below"),
    ("quality.median", "median"),
    ("quality.mean", "mean"),
];

/// The distribution of the EAS of all tets over the rows; `None` where there is none.
fn quality_chart(table: &Table, (x_name, x): &(String, Vec<f64>)) -> Option<Chart> {
    let line = |(key, name): (&str, &str)| {
        table.column(key).map(|column| Line { name: name.to_owned(), y: column.numbers() })
    };
    let lines: Vec<Line> = QUALITIES.into_iter().filter_map(line).collect();
    (lines.len() == QUALITIES.len()).then(|| Chart {
        title: format!("{EAS_TITLE}, of all tets"),
        x_name: x_name.clone(),
        x: x.clone(),
        lines,
        threshold: Some((motet::mesh::BAD_EAS, "bad below 0.2")),
        from_zero: true,
    })
}

/// Charts of the columns that vary, and the number of such columns without a chart.
fn table_charts(table: &Table) -> (Vec<Drawn>, usize) {
    let (x_name, x) = abscissa(table);
    let qualities = quality_chart(table, &(x_name.clone(), x.clone()));
    let is_drawn = |name: &str| qualities.is_some() && QUALITIES.iter().any(|(key, _)| *key == name);
    let changes = |column: &&Column| {
        let numbers = column.numbers();
        let mut there = numbers.iter().flatten().filter(|x| x.is_finite());
        let first = there.next();
        !is_id(&column.name) && !is_drawn(&column.name) && there.any(|x| Some(x) != first)
    };
    let (seconds, mut others): (Vec<&Column>, Vec<&Column>) =
        table.columns.iter().filter(changes).partition(|column| is_seconds(&column.name));
    others.sort_by_key(|column| {
        INFORMATIVE.iter().position(|name| *name == column.name).unwrap_or(INFORMATIVE.len())
    });
    let chart = |title: String, columns: &[&Column]| Chart {
        title,
        x_name: x_name.clone(),
        x: x.clone(),
        lines: columns.iter().map(|c| Line { name: stage(&c.name), y: c.numbers() }).collect(),
        from_zero: columns.len() > 1,
        ..Chart::default()
    };
    let single =
        others.iter().take(MAX_CHARTS).map(|column| chart(words::title_of(&column.name), &[*column]));
    let mut charts: Vec<Chart> = qualities.iter().cloned().chain(single).collect();
    if !seconds.is_empty() {
        charts.push(chart("seconds by stage".to_owned(), &seconds[..seconds.len().min(8)]));
    }
    let left = others.len().saturating_sub(MAX_CHARTS) + seconds.len().saturating_sub(8);
    let title = |mut drawn: Drawn| {
        drawn.title =
            if table.name == "steps" { drawn.title } else { format!("{}: {}", table.name, drawn.title) };
        drawn
    };
    (charts.iter().filter(|c| c.is_drawable()).map(|c| title(c.drawn())).collect(), left)
}

/// Whether the numbers under a key are identifiers, whose course is not worth a chart.
fn is_id(name: &str) -> bool {
    let last = name.rsplit(['.', ' ']).next().unwrap_or(name);
    matches!(last, "step" | "time" | "frame" | "cell" | "vertex" | "point" | "tet" | "triangle" | "id")
}

fn is_seconds(name: &str) -> bool {
    name.starts_with("seconds") || name.contains(".seconds")
}

fn stage(name: &str) -> String {
    name.split_once("seconds.").map_or(name, |(_, stage)| stage).to_owned()
}

/// The abscissa of a table's charts: time where it increases, otherwise steps, otherwise row numbers.
fn abscissa(table: &Table) -> (String, Vec<f64>) {
    for name in ["time", "step"] {
        let numbers: Option<Vec<f64>> =
            table.column(name).and_then(|column| column.numbers().into_iter().collect());
        if let Some(x) = numbers.filter(|x| x.windows(2).all(|w| w[0] < w[1])) {
            return (name.to_owned(), x);
        }
    }
    ("row".to_owned(), (0..table.n_rows).map(|i| i as f64).collect())
}

fn grid(table: &Table) -> Grid {
    let text = |cell: &Cell| match cell {
        Cell::None => String::new(),
        Cell::Number(x) => short(*x),
        Cell::Text(text) => text.clone(),
    };
    let is_numeric = |column: &Column| !column.cells.iter().any(|cell| matches!(cell, Cell::Text(_)));
    thinned(Grid {
        name: table.name.clone(),
        head: table.columns.iter().map(|column| column.name.clone()).collect(),
        numeric: table.columns.iter().map(is_numeric).collect(),
        rows: (0..table.n_rows).map(|i| table.columns.iter().map(|c| text(&c.cells[i])).collect()).collect(),
        note: None,
    })
}

fn thinned(mut grid: Grid) -> Grid {
    let n = grid.rows.len();
    if n > MAX_ROWS {
        let kept = |i: usize| i * (n - 1) / (MAX_ROWS - 1);
        grid.rows = (0..MAX_ROWS).map(|i| grid.rows[kept(i)].clone()).collect();
        grid.note = Some(format!("{} of {} rows, evenly chosen.", count(MAX_ROWS), count(n)));
    }
    grid
}
