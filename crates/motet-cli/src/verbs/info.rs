//! `motet info`: the content, quality and defects of a mesh.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use motet::base::{Names as _, Threads};
use motet::geometry::quality::Measure;
use motet::io::{self, WriteOptions};
use motet::mesh::{OrientedTets, Spread, Summary};
use motet::{Error, Mesh};
use serde::Serialize;
use serde_json::json;

use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::quality;
use crate::table::{Table, count, short, time as time_of};
use crate::words::{self, shown};

/// Report the content, quality and defects of a mesh
///
/// Works for volumes, surfaces, curves, whatever the file holds. Defects are listed with counts, ids and
/// places; a mesh with defects is not a failure (exit status 0). For a .pvd, times and files are listed.
#[derive(Debug, Args)]
#[command(after_help = "\
Quality of tets: EAS is the equi-angle quality: 1 for a regular tet, 0 for a flat one, negative \
for an inverted one, bad below 0.2. Thin tets of boundary layers are not bad. Tets are oriented \
by their neighbours, whichever way the file numbers them. The mean ratio of a tet is 12 \
(3V)^(2/3) over the sum of its squared edge lengths; that of a triangle is 4 sqrt(3) A over that \
sum, 1 for an equilateral one.

A quadratic cell is inverted where the determinant of its Jacobian is not positive everywhere \
inside. Its scaled Jacobian is that determinant over its value at the centre of the cell with \
straight edges: 1 for a straight tet, 0 or less where the cell is folded. EAS, volume and \
boundary are those of the cell with straight edges.

Lengths are in units of the mesh, angles in degrees.

Examples:
  motet info vessel.vtu
  motet info vessel.vtu --json | jq .quality.eas.min
  motet info vessel.vtu --json | jq .quality.distribution    worst, 1 %, 5 %, median and mean EAS
  motet quality before.vtu after.vtu          all measures of several meshes
  motet info vessel.msh -o quality.vtu        colour by eas in ParaView to see where it is bad")]
pub(crate) struct InfoArgs {
    /// The mesh file (or folder, or series: .pvd, .vtkhdf with steps)
    #[arg(value_name = "MESH")]
    mesh: PathBuf,
    /// Write the mesh with a cell array for each measure of `motet quality` (of tets; other cells have none)
    #[arg(short, long, value_name = "OUT")]
    output: Option<PathBuf>,
}

pub(crate) fn run(args: &InfoArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    if io::is_series(&args.mesh) {
        return series(&args.mesh, console);
    }
    if let Some(output) = &args.output {
        io::can_write(output)?;
    }
    let threads = common.threads()?;
    let (mesh, notes) = io::read_on(&args.mesh, &threads)?;
    notes.iter().for_each(|note| console.warn(note));
    let (summary, measures) = Summary::with_measures(&mesh, Measure::ALL, &threads);
    let report = Report {
        file: &args.mesh,
        summary: &summary,
        measures: measures.into_iter().collect(),
        arrays: Arrays::of(&mesh),
        passed_over: &notes,
    };
    console.report(&report);
    report.print(console);
    if let Some(output) = &args.output {
        let lost = io::write_on(output, &measured(mesh, &threads), &WriteOptions::default(), &threads)?;
        lost.iter().for_each(|what| console.warn(what));
        console.print(format_args!("\nwrote {}", output.display()));
    }
    Ok(Outcome::Done)
}

/// Adds a cell array for each quality measure.
fn measured(mut mesh: Mesh, threads: &Threads) -> Mesh {
    let tets = OrientedTets::of_linear(&mesh, threads);
    let fields: Vec<_> = Measure::ALL
        .iter()
        .map(|measure| tets.field(&mesh, measure.as_str(), |tet| measure.of_tet(tet)))
        .collect();
    fields.into_iter().for_each(|field| mesh.set_cell_field(field));
    mesh
}

#[derive(Serialize)]
struct Report<'a> {
    #[serde(serialize_with = "words::paths")]
    file: &'a Path,
    #[serde(flatten)]
    summary: &'a Summary,
    /// Of the tets; empty if there are none.
    measures: BTreeMap<Measure, Spread>,
    arrays: Arrays<'a>,
    passed_over: &'a [String],
}

/// Names of the arrays, with their numbers of components.
#[derive(Serialize)]
struct Arrays<'a> {
    point: Vec<(&'a str, usize)>,
    cell: Vec<(&'a str, usize)>,
}

impl<'a> Arrays<'a> {
    fn of(mesh: &'a Mesh) -> Self {
        let names = |fields: &'a [motet::mesh::Field]| {
            fields.iter().map(|f| (f.name.as_str(), f.components)).collect()
        };
        Self { point: names(&mesh.point_data), cell: names(&mesh.cell_data) }
    }
}

impl Report<'_> {
    fn print(&self, console: &Console) {
        let summary = self.summary;
        console.print(format_args!("{}: {} points", self.file.display(), count(summary.points)));
        let kinds: Vec<String> =
            summary.cells.iter().map(|(kind, n)| format!("{} {kind}", count(*n))).collect();
        console.print(format_args!(
            "  cells     {}",
            if kinds.is_empty() { "none".into() } else { kinds.join(", ") }
        ));
        self.print_size(console);
        self.print_triangles(console);
        self.print_arrays(console);
        self.print_labels(console);
        self.print_quality(console);
        self.print_curved(console);
        self.print_defects(console);
    }

    fn print_size(&self, console: &Console) {
        let summary = self.summary;
        if let Some([low, high]) = summary.bounds {
            let side = |i: usize| format!("{} to {}", short(low[i]), short(high[i]));
            console.print(format_args!("  bounds    x {}, y {}, z {}", side(0), side(1), side(2)));
        }
        if let Some(boundary) = &summary.boundary {
            console.print(format_args!("  volume    {}", short(summary.volume)));
            console.print(format_args!(
                "  boundary  {} facets, {} vertices; conforming: {}",
                count(boundary.facets),
                count(boundary.vertices),
                yes_or_no(summary.conforming)
            ));
        }
        if let Some(surface) = &summary.surface {
            console.print(format_args!(
                "  surface   {} triangles, area {}, closed: {}",
                count(surface.triangles),
                short(surface.area),
                yes_or_no(surface.closed)
            ));
        }
    }

    /// Prints the edge lengths and the shape of the triangles of a surface.
    fn print_triangles(&self, console: &Console) {
        let Some(triangles) = &self.summary.triangles else { return };
        let [least, median, largest] = triangles.edges.map(short);
        let [x, y, z] = triangles.worst_at.map(short);
        console.print(format_args!("  edges     {least} to {largest} long, median {median}"));
        console.print(format_args!(
            "  triangles mean ratio at least {}, mean {}; smallest angle {} degrees; worst: cell {} at ({x}, {y}, {z})",
            short(triangles.mean_ratio.min),
            short(triangles.mean_ratio.mean),
            short(triangles.min_angle_deg),
            triangles.worst_cell
        ));
    }

    fn print_arrays(&self, console: &Console) {
        for (place, arrays) in [("on points", &self.arrays.point), ("on cells", &self.arrays.cell)] {
            let one = |(name, components): &(&str, usize)| match components {
                1 => (*name).to_string(),
                n => format!("{name} ({n})"),
            };
            if !arrays.is_empty() {
                console.print(format_args!(
                    "  {place:<9} {}",
                    arrays.iter().map(one).collect::<Vec<_>>().join(", ")
                ));
            }
        }
    }

    fn print_labels(&self, console: &Console) {
        if !self.summary.regions.is_empty() {
            let mut table = Table::new(["region", "cells", "tets", "volume"]);
            for (name, region) in &self.summary.regions {
                table.row([name.clone(), count(region.cells), count(region.tets), short(region.volume)]);
            }
            console.print(format_args!("\n{table}"));
        }
        if !self.summary.patches.is_empty() {
            let mut table = Table::new(["patch", "cells", "triangles", "area", "closed"]);
            for (name, patch) in &self.summary.patches {
                let closed = yes_or_no(patch.closed).to_string();
                table.row([
                    name.clone(),
                    count(patch.cells),
                    count(patch.triangles),
                    short(patch.area),
                    closed,
                ]);
            }
            console.print(format_args!("\n{table}"));
        }
    }

    fn print_quality(&self, console: &Console) {
        let Some(quality) = &self.summary.quality else { return };
        let eas = &quality.eas;
        let [x, y, z] = eas.worst_at.map(short);
        let table = quality::table([("the mesh", Some(quality.distribution))]);
        console.print(format_args!("\n{table}"));
        let [least, median, largest] = quality.edges.map(short);
        console.print(format_args!(
            "  worst mean ratio {}; dihedral angles {} to {} degrees; edges {least} to {largest} long, median {median}",
            short(quality.mean_ratio.min),
            short(quality.dihedral_deg.min),
            short(quality.dihedral_deg.max)
        ));
        let worst =
            |measure| self.measures.get(&measure).map_or_else(String::new, |spread| short(spread.worst));
        console.print(format_args!(
            "  scaled Jacobian at least {}; radius ratio at most {}, aspect ratio at most {} (as in Verdict)",
            worst(Measure::ScaledJacobian),
            worst(Measure::RadiusRatio),
            worst(Measure::AspectRatio)
        ));
        console.print(format_args!(
            "  {} bad (EAS < 0.2), {} inverted or flat; worst: cell {} at ({x}, {y}, {z})",
            count(eas.bad),
            count(self.summary.inverted),
            eas.worst_cell
        ));
        if eas.layers > 0 {
            console.print(format_args!(
                "  {} thin tets of boundary layers (EAS < 0.2), not counted as bad",
                count(eas.layers)
            ));
        }
        if self.summary.turned > 0 {
            console.print(format_args!(
                "  {} tets are numbered with the opposite orientation; each is judged by the orientation of \
                 its neighbours",
                count(self.summary.turned)
            ));
        }
        console.print("");
        console.print(histogram(&eas.histogram));
    }

    fn print_curved(&self, console: &Console) {
        let Some(curved) = &self.summary.curved else { return };
        let [x, y, z] = curved.worst_at.map(short);
        console.print(format_args!(
            "\n  {} quadratic cells; least scaled Jacobian {}, in cell {} at ({x}, {y}, {z})",
            count(curved.cells),
            short(curved.min_scaled_jacobian),
            curved.worst_cell
        ));
    }

    fn print_defects(&self, console: &Console) {
        match self.summary.defects.as_slice() {
            [] => console.print("\n  no defects"),
            defects => {
                console.print("\n  defects");
                defects.iter().for_each(|defect| console.print(format_args!("  - {defect}")));
            }
        }
    }
}

/// A bar for each tenth of EAS, the longest as long as the line allows.
fn histogram(counts: &[usize; 11]) -> String {
    const LONGEST: usize = 50;
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let line = |(i, n): (usize, &usize)| {
        let range = if i == 0 {
            "below 0".into()
        } else {
            format!("{:.1} - {:.1}", (i - 1) as f64 / 10.0, i as f64 / 10.0)
        };
        // A nonzero count always shows, however small.
        let bar = "#".repeat((n * LONGEST).div_ceil(most));
        format!("  {range:<9} {:>11} {bar}", count(*n)).trim_end().to_string()
    };
    let first = usize::from(counts[0] == 0);
    counts.iter().enumerate().skip(first).map(line).collect::<Vec<_>>().join("\n")
}

fn yes_or_no(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

/// Lists the times and files of a series; an error where a file is missing.
fn series(path: &Path, console: &Console) -> motet::Result<Outcome> {
    let frames = io::read_series(path)?;
    if let Some((_, file)) = frames.iter().find(|(_, file)| !io::file_of(file).exists()) {
        return Err(Error::input(format!("refers to {}, which does not exist", file.display())).in_file(path));
    }
    let mut table = Table::new(["file", "time"]);
    frames.iter().for_each(|(time, file)| table.row([file.display().to_string(), time_of(*time)]));
    console.print(format_args!("{}: a series of {} meshes\n{table}", path.display(), frames.len()));
    let frames: Vec<_> =
        frames.iter().map(|(time, file)| json!({ "time": time, "file": shown(file) })).collect();
    console.report(&json!({ "file": shown(path), "series": frames }));
    Ok(Outcome::Done)
}
