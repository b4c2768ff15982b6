//! `motet demo`: a tour on built-in geometry, with the same calls that a user would make.

mod shapes;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, Parser};
use motet::moving::WorstTet;
use motet::{Error, Result};
use serde_json::json;

use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::table::{Table, count, seconds, short};
use crate::verbs::{implant, meshing, report, run};
use crate::words::shown;

/// See motet at work: a coiled aneurysm that pulsates beside a stent, and a flap that beats in a dissection
///
/// Fills vessels, puts devices into them, and keeps the meshes good for a cycle: moved, repaired, watched,
/// refined. Each call is one that you could make yourself, and is shown.
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Where the files go
    #[arg(value_name = "DIR", default_value = "motet-demo")]
    folder: PathBuf,
}

const ANEURYSM: &str = include_str!("aneurysm.toml");
const DISSECTION: &str = include_str!("dissection.toml");

/// A description and the arguments of each call, without the program's name; files lie in the folder of the
/// demo.
const CALLS: [(&str, &[&str]); 6] = [
    ("a vessel with an aneurysm is filled", &["mesh", "aneurysm.vtp", "-o", "vessel.vtu", "--size", "auto"]),
    (
        "a coil in the sac and a crimped stent at its neck are implanted; the flow goes around them",
        &["implant", "vessel.vtu", "coil.vtp", "stent.vtp", "-o", "treated.vtu", "--hollow"],
    ),
    ("the wall pulsates for a cycle; the stent is watched", &["run", "aneurysm.toml"]),
    (
        "a dissection: a vessel with a flap that is free at one edge",
        &["mesh", "lumen.vtp", "--membrane", "flap.vtp", "-o", "dissection.vtu", "--size", "auto"],
    ),
    ("the flap beats for a cycle", &["run", "dissection.toml"]),
    (
        "one page with both, to turn, cut and play",
        &[
            "report",
            "aneurysm.pvd",
            "aneurysm.jsonl",
            "dissection.pvd",
            "dissection.jsonl",
            "-o",
            "report.html",
            "--title",
            "A coiled aneurysm and a dissection",
        ],
    ),
];

pub(crate) fn run(args: &DemoArgs, common: &Common, console: &Console) -> Result<Outcome> {
    let begin = Instant::now();
    std::fs::create_dir_all(&args.folder).map_err(|e| Error::io(&args.folder, e))?;
    shapes::write(&args.folder)?;
    for (name, text) in [("aneurysm.toml", ANEURYSM), ("dissection.toml", DISSECTION)] {
        let file = args.folder.join(name);
        std::fs::write(&file, text).map_err(|e| Error::io(&file, e))?;
    }
    let (mut cycles, mut took) = (Vec::new(), Vec::new());
    let mut not_reached = Vec::new();
    for (what, words) in CALLS {
        let call = call(&args.folder, words);
        console.print(format_args!("\n# {what}\n$ motet {}\n", as_typed(&call[1..])));
        let one = Instant::now();
        if let Outcome::NotReached(why) = make(&call, common, console, &mut cycles)? {
            not_reached.push(format!("{what}: {why}"));
        }
        took.push((what, one.elapsed().as_secs_f64()));
    }
    let outcome = Outcome::of((!not_reached.is_empty()).then(|| not_reached.join("; ")));
    print(args, &cycles, &took, begin.elapsed().as_secs_f64(), &outcome, console);
    Ok(outcome)
}

/// The arguments of a call, with files in their folder.
fn call(folder: &Path, words: &[&str]) -> Vec<String> {
    let is_file = |word: &str| {
        [".vtp", ".vtu", ".toml", ".pvd", ".jsonl", ".html"].iter().any(|ending| word.ends_with(ending))
    };
    let word = |word: &&str| match is_file(word) {
        true => folder.join(word).to_string_lossy().into_owned(),
        false => (*word).to_owned(),
    };
    std::iter::once("motet".to_owned()).chain(words.iter().map(word)).collect()
}

/// The call as typed in a shell.
fn as_typed(call: &[String]) -> String {
    let word = |word: &String| if word.contains(' ') { format!("\"{word}\"") } else { word.clone() };
    call.iter().map(word).collect::<Vec<_>>().join(" ")
}

/// The arguments of one verb, parsed by themselves.
#[derive(Parser)]
struct Alone<A: Args> {
    #[command(flatten)]
    args: A,
}

/// Parses what follows the verb in a call.
fn parsed<A: Args>(call: &[String]) -> Result<A> {
    match Alone::try_parse_from(&call[1..]) {
        Ok(alone) => Ok(alone.args),
        Err(_) => Err(Error::options("this folder name cannot be used in a command")),
    }
}

/// Makes a call and keeps the reports of runs.
fn make(
    call: &[String],
    common: &Common,
    console: &Console,
    cycles: &mut Vec<run::Report>,
) -> Result<Outcome> {
    // One object at the end is enough; those of the single calls are left out.
    let quiet = console.without_reports();
    match call[1].as_str() {
        "mesh" => meshing::run(&parsed(call)?, common, &quiet),
        "implant" => implant::run(&parsed(call)?, common, &quiet),
        "report" => report::run(&parsed(call)?, &quiet),
        _ => {
            let report = run::execute(&parsed(call)?, common, &quiet)?;
            report.print(&quiet);
            let outcome = report.outcome();
            cycles.push(report);
            Ok(outcome)
        }
    }
}

/// Prints a table of both cycles, and which files to open.
fn print(
    args: &DemoArgs,
    cycles: &[run::Report],
    took: &[(&str, f64)],
    total: f64,
    outcome: &Outcome,
    console: &Console,
) {
    let mut table = Table::new(["", "aneurysm", "dissection"]);
    let mut row = |what: &str, of: &dyn Fn(&run::Report) -> String| {
        table.row(std::iter::once(what.to_owned()).chain(cycles.iter().map(of)));
    };
    let eas = |worst: Option<WorstTet>| worst.map_or_else(|| "-".to_owned(), |w| format!("{:.3}", w.eas));
    row("steps", &|c| c.steps.to_string());
    row("tets, first and last", &|c| format!("{} and {}", count(c.tets[0]), count(c.tets[1])));
    row("steps with a change", &|c| c.changed_steps.to_string());
    row("bad tets repaired on the way", &|c| count(c.repaired));
    row("bad tets that are left, in a step", &|c| c.most_bad.to_string());
    row("inverted", &|c| c.most_inverted.to_string());
    row("worst EAS, first and of all steps", &|c| format!("{} and {}", eas(c.worst_at_first), eas(c.worst)));
    row("least gap", &|c| c.least_gap.map_or_else(|| "-".to_owned(), short));
    row("steps that warned", &|c| c.warned_steps.to_string());
    console.print(format_args!("\n{table}\n"));
    let mut times = Table::new(["what", "took"]);
    took.iter().for_each(|(what, s)| times.row([(*what).to_owned(), seconds(*s)]));
    times.row(["all".to_owned(), seconds(total)]);
    let folder = args.folder.display();
    console.print(format_args!(
        "{times}\n\nSee it move:\n  {folder}/report.html in a browser: turn, cut, play\n  \
         paraview {folder}/aneurysm.pvd       (Apply, colour by eas, slice, play)\n  \
         paraview {folder}/dissection.pvd\nLook closer:\n  motet info {folder}/treated.vtu\n  motet help run"
    ));
    let report = json!({
        "folder": shown(&args.folder),
        "cycles": cycles,
        "seconds": took.iter().map(|(what, s)| json!({ "what": what, "seconds": s })).collect::<Vec<_>>(),
        "seconds_total": total,
    });
    console.conclude(&report, outcome);
}
