//! `motet demo`: the whole story on built-in geometry, by the very calls that a user would make.

mod shapes;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::{Args, Parser as _};
use motet::{Error, Result};
use serde_json::{Value, json};

use crate::args::{Call, Common, Verb};
use crate::console::Console;
use crate::exit::Outcome;
use crate::table::{Table, count, seconds, short};
use crate::verbs::{implant, meshing, report, run};

/// See it work: a coiled aneurysm that pulsates beside a stent, and a flap that beats in a dissection
///
/// Fills vessels, puts devices into them, and keeps the meshes good for a cycle: moved, repaired, watched, refined. Each call is one that
/// you could make yourself, and is shown.
#[derive(Debug, Args)]
pub(crate) struct DemoArgs {
    /// Where the files go
    #[arg(value_name = "DIR", default_value = "motet-demo")]
    folder: PathBuf,
}

const ANEURYSM: &str = include_str!("aneurysm.toml");
const DISSECTION: &str = include_str!("dissection.toml");

/// Each call, without the program's name; files lie in the folder of the demo.
const CALLS: [(&str, &[&str]); 6] = [
    ("a vessel with an aneurysm is filled", &["mesh", "aneurysm.vtp", "-o", "vessel.vtu", "--size", "auto"]),
    (
        "a coil in the sac and a crimped stent at its neck are put in; what flows goes round them",
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
    std::fs::create_dir_all(&args.folder).map_err(|e| Error::io(&args.folder, &e))?;
    shapes::write(&args.folder)?;
    for (name, text) in [("aneurysm.toml", ANEURYSM), ("dissection.toml", DISSECTION)] {
        let file = args.folder.join(name);
        std::fs::write(&file, text).map_err(|e| Error::io(&file, &e))?;
    }
    let (mut outcome, mut took) = (Outcome::Done, Vec::new());
    for (what, words) in CALLS {
        let call = call(&args.folder, words);
        console.say(format_args!("\n# {what}\n$ motet {}\n", as_typed(&call[1..])));
        let one = Instant::now();
        if make(&call, common, console)? == Outcome::NotReached {
            outcome = Outcome::NotReached;
        }
        took.push((what, one.elapsed().as_secs_f64()));
    }
    tell(args, &took, begin.elapsed().as_secs_f64(), console)?;
    Ok(outcome)
}

/// The words of a call, files in their folder.
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

/// As a shell would have them.
fn as_typed(call: &[String]) -> String {
    let word = |word: &String| if word.contains(' ') { format!("\"{word}\"") } else { word.clone() };
    call.iter().map(word).collect::<Vec<_>>().join(" ")
}

fn make(call: &[String], common: &Common, console: &Console) -> Result<Outcome> {
    // One object at the end is enough: those of the single calls are left out.
    let quiet = console.without_reports();
    match Call::try_parse_from(call).map(|call| call.verb) {
        Ok(Verb::Mesh(args)) => meshing::run(&args, common, &quiet),
        Ok(Verb::Implant(args)) => implant::run(&args, common, &quiet),
        Ok(Verb::Run(args)) => run::run(&args, common, &quiet),
        Ok(Verb::Report(args)) => report::run(&args, &quiet),
        _ => Err(Error::options("this name of a folder cannot be part of a call")),
    }
}

/// A table of both cycles, and where to look.
fn tell(args: &DemoArgs, took: &[(&str, f64)], total: f64, console: &Console) -> Result<()> {
    let cycles = ["aneurysm", "dissection"].map(|name| Cycle::of(&args.folder.join(format!("{name}.jsonl"))));
    let cycles = cycles.into_iter().collect::<Result<Vec<_>>>()?;
    let mut table = Table::new(["", "aneurysm", "dissection"]);
    let mut row = |what: &str, of: &dyn Fn(&Cycle) -> String| {
        table.row([what.to_owned(), of(&cycles[0]), of(&cycles[1])]);
    };
    row("steps", &|c| c.steps.to_string());
    row("tets, first and last", &|c| format!("{} and {}", count(c.tets[0]), count(c.tets[1])));
    row("steps with a change", &|c| c.changed.to_string());
    row("bad tets repaired on the way", &|c| count(c.repaired));
    row("bad tets that are left, in a step", &|c| c.most_bad.to_string());
    row("inverted", &|c| c.inverted.to_string());
    row("worst EAS, first and of all steps", &|c| format!("{:.3} and {:.3}", c.worst[0], c.worst[1]));
    row("least gap", &|c| c.gap.map_or_else(|| "-".to_owned(), short));
    row("steps that warned", &|c| c.warned.to_string());
    console.say(format_args!("\n{table}\n"));
    let mut times = Table::new(["what", "took"]);
    took.iter().for_each(|(what, s)| times.row([(*what).to_owned(), seconds(*s)]));
    times.row(["all".to_owned(), seconds(total)]);
    let folder = args.folder.display();
    console.say(format_args!(
        "{times}\n\nSee it move:\n  {folder}/report.html in a browser: turn, cut, play\n  paraview {folder}/aneurysm.pvd       (Apply, colour by eas, slice, play)\n  \
         paraview {folder}/dissection.pvd\nLook closer:\n  motet info {folder}/treated.vtu\n  motet help run"
    ));
    console.report(&json!({
        "folder": args.folder,
        "aneurysm": cycles[0].json(),
        "dissection": cycles[1].json(),
        "seconds": took.iter().map(|(what, s)| json!({ "what": what, "seconds": s })).collect::<Vec<_>>(),
        "seconds_total": total,
    }));
    Ok(())
}

/// What the log of a cycle says.
#[derive(Default)]
struct Cycle {
    steps: usize,
    tets: [usize; 2],
    changed: usize,
    repaired: usize,
    most_bad: usize,
    inverted: usize,
    worst: [f64; 2],
    gap: Option<f64>,
    warned: usize,
}

impl Cycle {
    fn of(log: &Path) -> Result<Self> {
        let text = std::fs::read_to_string(log).map_err(|e| Error::io(log, &e))?;
        let lines: Vec<Value> = text.lines().filter_map(|line| serde_json::from_str(line).ok()).collect();
        let mut cycle = Self { steps: lines.len().saturating_sub(1), worst: [1.0; 2], ..Self::default() };
        for (k, line) in lines.iter().enumerate() {
            let number = |key: &str| line[key].as_u64().unwrap_or(0) as usize;
            let worst = line["worst"]["eas"].as_f64().unwrap_or(1.0);
            if k == 0 {
                (cycle.tets[0], cycle.worst[0]) = (number("tets"), worst);
            }
            cycle.tets[1] = number("tets");
            cycle.worst[1] = cycle.worst[1].min(worst);
            cycle.most_bad = cycle.most_bad.max(number("bad"));
            cycle.inverted = cycle.inverted.max(number("inverted"));
            let changes = line["changes"].as_array().map_or(&[][..], Vec::as_slice);
            cycle.changed += usize::from(!changes.is_empty());
            cycle.repaired += changes.iter().filter_map(|c| c["bad_before"].as_u64()).sum::<u64>() as usize;
            if let Some(gap) = line["gaps"]["least"].as_f64() {
                cycle.gap = Some(cycle.gap.map_or(gap, |least| least.min(gap)));
            }
            cycle.warned += usize::from(line["gaps"]["warned"].as_u64().is_some_and(|n| n > 0));
        }
        Ok(cycle)
    }

    fn json(&self) -> Value {
        json!({
            "steps": self.steps,
            "tets": self.tets,
            "changed_steps": self.changed,
            "repaired": self.repaired,
            "most_bad": self.most_bad,
            "inverted": self.inverted,
            "worst_eas": { "first": self.worst[0], "all": self.worst[1] },
            "least_gap": self.gap,
            "warned_steps": self.warned,
        })
    }
}
