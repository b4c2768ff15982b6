//! `motet quality`: all quality measures of one mesh, or of several beside each other.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use clap::Args;
use motet::base::{Names as _, Threads};
use motet::geometry::quality::Measure;
use motet::mesh::{Spread, Summary};
use motet::{Error, io};
use serde::Serialize;

use crate::common::Common;
use crate::console::Console;
use crate::help::name_of;
use crate::outcome::Outcome;
use crate::table::{Table, count, short};
use crate::words;

/// Report every quality measure of tets, of one mesh or of several beside each other
///
/// Worst, 1 %, 5 %, median and mean of each measure over all tets, from the worst tet to the best: for the
/// radius, aspect and edge ratio and the largest dihedral angle, which are better if smaller, the worst is
/// the largest. Quadratic tets are measured by their corners.
#[derive(Debug, Args)]
#[command(after_help = "\
Scaled Jacobian, radius ratio and aspect ratio are those of Verdict, which VTK and ParaView use; \
1e30 stands for a radius or aspect ratio of a flat tet. A tet is bad if its EAS is below 0.2 and \
it is not in a boundary layer.

Examples:
  motet quality before.vtu after.vtu
  motet quality a.vtu b.msh --measures eas,scaled_jacobian
  motet quality a.vtu b.vtu --json | jq '.meshes[].measures.eas.mean'")]
pub(crate) struct QualityArgs {
    /// The mesh files
    #[arg(value_name = "MESH", required = true)]
    meshes: Vec<PathBuf>,
    /// Only these measures, separated by commas
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = name_of::<Measure>())]
    measures: Vec<Measure>,
}

/// What is reported of a mesh.
#[derive(Serialize)]
struct Entry<'a> {
    #[serde(serialize_with = "words::paths")]
    file: &'a Path,
    points: usize,
    tets: usize,
    bad: usize,
    inverted: usize,
    volume: f64,
    /// The shortest, the median and the longest edge length.
    edges: [f64; 3],
    measures: BTreeMap<Measure, Spread>,
}

#[derive(Serialize)]
struct Report<'a> {
    meshes: Vec<Entry<'a>>,
}

pub(crate) fn run(args: &QualityArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let threads = common.threads()?;
    let measures = if args.measures.is_empty() { Measure::ALL } else { &args.measures };
    let entry = |file| Entry::of(file, measures, &threads, console);
    let report =
        Report { meshes: args.meshes.iter().map(PathBuf::as_path).map(entry).collect::<Result<_, _>>()? };
    console.report(&report);
    console.print(report.counts());
    console.print(format_args!("\n{}", report.measures(measures)));
    Ok(Outcome::Done)
}

impl<'a> Entry<'a> {
    fn of(file: &'a Path, measures: &[Measure], threads: &Threads, console: &Console) -> motet::Result<Self> {
        let (mesh, notes) = io::read_on(file, threads)?;
        notes.iter().for_each(|note| console.warn(note));
        let (summary, measures) = Summary::with_measures(&mesh, measures, threads);
        let Some(quality) = &summary.quality else {
            return Err(Error::input("there are no tets")
                .in_file(file)
                .remedy("`motet info` describes surfaces and other cells"));
        };
        Ok(Self {
            file,
            points: summary.points,
            tets: quality.eas.histogram.iter().sum(),
            bad: quality.eas.bad,
            inverted: summary.inverted,
            volume: summary.volume,
            edges: quality.edges,
            measures: measures.into_iter().collect(),
        })
    }

    fn name(&self) -> String {
        self.file.display().to_string()
    }
}

impl Report<'_> {
    fn counts(&self) -> Table {
        let head =
            ["mesh", "points", "tets", "bad", "inverted", "volume", "shortest edge", "median", "longest"];
        let mut table = Table::new(head);
        for entry in &self.meshes {
            let counts = [entry.points, entry.tets, entry.bad, entry.inverted].map(count);
            let [least, median, longest] = entry.edges.map(short);
            let sizes = [short(entry.volume), least, median, longest];
            table.row([entry.name()].into_iter().chain(counts).chain(sizes));
        }
        table
    }

    /// A row for each measure of each mesh, with the name of the mesh if there are several.
    fn measures(&self, measures: &[Measure]) -> Table {
        let are_several = self.meshes.len() > 1;
        let mesh = |name: &str| are_several.then(|| name.to_string());
        let words = |words: [&str; 5]| words.map(str::to_string);
        let head = [String::from("measure")].into_iter().chain(mesh("mesh"));
        let mut table = Table::new(head.chain(words(["worst", "1 % worse", "5 % worse", "median", "mean"])));
        for measure in measures {
            for (i, entry) in self.meshes.iter().enumerate() {
                let Some(Spread { worst, p1, p5, median, mean }) = entry.measures.get(measure) else {
                    continue;
                };
                let name = if i == 0 { measure.to_string() } else { String::new() };
                let row = [name].into_iter().chain(mesh(&entry.name()));
                table.row(row.chain([worst, p1, p5, median, mean].map(|x| short(*x))));
            }
        }
        table
    }
}
