//! The report of `motet surface`: a few lines for people, an object for programs.

use std::path::PathBuf;

use motet::meshing::even::{self, Measured};
use motet::meshing::tubes;
use serde::Serialize;

use super::args::SurfaceArgs;
use crate::console::Console;
use crate::outcome::{Outcome, Seconds};
use crate::table::{Table, count, counted, seconds, short};
use crate::words;

/// All results of `motet surface`.
#[derive(Debug, Serialize)]
pub(super) struct Report<'a> {
    #[serde(serialize_with = "words::paths")]
    input: Option<PathBuf>,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    /// Whether the surface is as near as requested.
    complete: bool,
    #[serde(flatten)]
    report: &'a even::Report,
    /// The wires, if the input was wires.
    wires: Option<&'a tubes::Report>,
    seconds: Seconds,
}

impl<'a> Report<'a> {
    pub(super) fn new(
        args: &SurfaceArgs,
        report: &'a even::Report,
        wires: Option<&'a tubes::Report>,
        seconds: Seconds,
    ) -> Self {
        Self {
            input: args.input.clone(),
            output: args.output.clone(),
            complete: report.not_reached().is_none(),
            report,
            wires,
            seconds,
        }
    }

    pub(super) fn print(&self, outcome: &Outcome, console: &Console) {
        console.conclude(self, outcome);
        let even::Report { before, after, repairs, .. } = self.report;
        if self.report.is_boundary {
            console.print("the mesh has no surface cells: this is the boundary of its volume cells");
        }
        if self.report.left_out > 0 {
            console.print(format_args!(
                "{} that are not of the surface are left out",
                counted(self.report.left_out, "cell")
            ));
        }
        for cut in &self.report.cuts {
            console.print(format_args!(
                "cut off: {}, {} divided",
                counted(cut.removed, "triangle"),
                count(cut.divided)
            ));
        }
        if let Some(wires) = self.wires {
            print_wires(wires, console);
        }
        if !repairs.is_empty() {
            console.print(format_args!("{} (--json lists them)", counted(repairs.len(), "repair")));
        }
        console.print(counts([("given", before), ("new", after)]));
        console.print(shapes([("given", before), ("new", after)]));
        if let Some(smoothed) = self.report.smoothed {
            console.print(format_args!(
                "smoothed in {}: at most {} from the given surface, and it from that at most {}",
                counted_passes(smoothed.passes),
                short(smoothed.to_given),
                short(smoothed.from_given)
            ));
        }
        console.print(format_args!(
            "the new surface is at most {} from the {} one, and it from that at most {} ({} allowed)",
            short(self.report.to_given),
            if self.report.smoothed.is_some() { "smoothed" } else { "given" },
            short(self.report.from_given),
            short(self.report.allowed)
        ));
        console.print(format_args!("all {}", seconds(self.seconds.total)));
    }
}

fn print_wires(wires: &tubes::Report, console: &Console) {
    let [least, largest] = wires.radii;
    let radius =
        if least == largest { short(least) } else { format!("{} to {}", short(least), short(largest)) };
    console.print(format_args!(
        "{} of {}, {} long, of radius {radius}, as tubes of {} sides",
        counted(wires.chains, "wire"),
        counted(wires.segments, "segment"),
        short(wires.length),
        wires.sides
    ));
    console.print(format_args!(
        "{} and {} joined by balls; {} joined by material between wires",
        counted(wires.branches, "branch point"),
        counted(wires.sharp_bends, "sharp bend"),
        counted(wires.bridges, "place"),
    ));
    console.print(format_args!(
        "the wires have a volume of {}, each for itself; united {}, in {}",
        short(wires.wire_volume),
        short(wires.volume),
        if wires.bodies == 1 { "1 body".into() } else { format!("{} bodies", count(wires.bodies)) }
    ));
}

fn counted_passes(n: usize) -> String {
    if n == 1 { "1 pass".into() } else { format!("{} passes", count(n)) }
}

fn counts<'a>(rows: impl IntoIterator<Item = (&'a str, &'a Measured)>) -> Table {
    let mut table = Table::new(["surface", "points", "triangles", "rims", "crossings", "area", "volume"]);
    for (name, of) in rows {
        table.row([
            name.to_owned(),
            count(of.points),
            count(of.triangles),
            count(of.rims),
            count(of.crossings),
            short(of.area),
            of.volume.map_or("open".into(), short),
        ]);
    }
    table
}

fn shapes<'a>(rows: impl IntoIterator<Item = (&'a str, &'a Measured)>) -> Table {
    let mut table = Table::new([
        "angles, edges",
        "least angle",
        "1 % below",
        "median",
        "shortest edge",
        "median",
        "longest edge",
    ]);
    for (name, of) in rows {
        let [least, median, largest] = of.edges;
        let numbers = [of.angles.worst, of.angles.p1, of.angles.median, least, median, largest].map(short);
        table.row([name.to_owned()].into_iter().chain(numbers));
    }
    table
}
