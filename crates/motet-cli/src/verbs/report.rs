//! `motet report`: meshes, series and logs as one page with pictures, charts and tables.

use std::path::PathBuf;

use clap::Args;
use motet_report::{InputReport, Options};

use crate::console::Console;
use crate::outcome::Outcome;

/// Write one HTML page with pictures, charts and tables of meshes, series and logs
///
/// The page is one file that works offline: a view to turn, cut, colour and play; quality over time; a table
/// of every frame. JSON files become charts and tables: what a verb prints with --json, and logs with an
/// object per line (.jsonl), whatever their keys.
#[derive(Debug, Args)]
#[command(after_help = "\
The budget goes to the surfaces of meshes first, then to their insides. Where an inside does not \
fit, only the cells at a number of planes can be cut; where frames do not fit, evenly chosen \
ones have pictures. The page and the report say what was left out.

Examples:
  motet report vessel.vtu -o vessel.html
  motet report out/moved.pvd -o moved.html --title 'A sphere moves'
  motet move box.vtu -o out/box.pvd --translate sphere=2,0,0 --steps 10 --quality --json > move.json
  motet report out/box.pvd move.json -o box.html
  motet report before.vtu after.vtu -o both.html --budget 60")]
pub(crate) struct ReportArgs {
    /// Meshes and series in any format that motet reads, reports (.json), logs (.jsonl)
    #[arg(value_name = "OUT", required = true)]
    inputs: Vec<PathBuf>,
    /// Output file
    #[arg(short, long, value_name = "REPORT.html")]
    output: PathBuf,
    /// Title of the page [default: the names of the inputs]
    #[arg(long, value_name = "T")]
    title: Option<String>,
    /// How many megabytes of the page meshes may take
    #[arg(long, value_name = "MB", default_value_t = Options::BUDGET as f64 / 1e6)]
    budget: f64,
}

pub(crate) fn run(args: &ReportArgs, console: &Console) -> motet::Result<Outcome> {
    if !(args.budget > 0.0 && args.budget <= 2000.0) {
        return Err(motet::Error::options(format!(
            "--budget {}: a number of megabytes is expected",
            args.budget
        ))
        .remedy("give a number above 0 and at most 2000"));
    }
    let budget = (args.budget * 1e6) as usize;
    let options = Options { output: args.output.clone(), title: args.title.clone(), budget };
    let report = motet_report::write(&args.inputs, &options)?;
    report.inputs.iter().for_each(|input| print(input, console));
    console.print(format_args!(
        "wrote {}: {:.1} MB; meshes take {:.1} of {} MB allowed",
        report.output.display(),
        report.bytes as f64 / 1e6,
        report.payload_bytes as f64 / 1e6,
        args.budget
    ));
    console.report(&report);
    Ok(Outcome::Done)
}

fn print(input: &InputReport, console: &Console) {
    let file = input.file.display();
    match input.frames {
        0 => console.print(format_args!("{file}: {} rows", input.rows)),
        1 => console.print(format_args!("{file}: a mesh")),
        n => console.print(format_args!("{file}: {n} frames, {} with a picture", input.shown)),
    }
    input.left_out.iter().for_each(|what| console.warn(format_args!("{file}: {what}")));
}
