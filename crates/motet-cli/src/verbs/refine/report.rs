//! The report of `motet refine`: a table for people, an object for programs.

use std::path::PathBuf;

use motet::base::Threads;
use motet::refine::{MeshRefinement, Reached, Shapes, Step, Stop};
use serde::Serialize;

use super::args::RefineArgs;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::quality;
use crate::table::{Table, count, seconds, short};
use crate::words;

/// All results of `motet refine`.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    #[serde(serialize_with = "words::paths")]
    mesh: PathBuf,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    #[serde(serialize_with = "words::paths")]
    history: Option<PathBuf>,
    /// Whether all edges are as short as requested.
    complete: bool,
    /// The reason why division ended before that.
    stopped_by: Option<Stop>,
    /// The input mesh, then the mesh after each generation.
    steps: Vec<Step>,
    /// Number of tets of the first mesh.
    first_tets: usize,
    /// The worst EAS of the first mesh.
    first_worst_eas: f64,
    /// Number of tets worse than the bound, and of the tets of the first mesh that contain them.
    left: usize,
    left_roots: usize,
    /// Number of tets of each generation.
    generations: Vec<usize>,
    on_surface: Option<Surface>,
    /// The largest difference in a step between the volumes of new and old tets, relative to the volume that
    /// changed.
    volume_deviation: f64,
    /// Bytes per tet that the memory takes in addition to the mesh.
    memory_per_tet: f64,
    seconds: Seconds,
}

#[derive(Debug, Default, Serialize)]
struct Surface {
    moved: usize,
    short: usize,
    farthest: f64,
}

#[derive(Debug, Default, Serialize)]
struct Seconds {
    read: f64,
    refine: f64,
    write: f64,
    total: f64,
}

impl Report {
    /// `done`: what was reached; seconds: for reading, for writing, and in total.
    pub(super) fn new(
        args: &RefineArgs,
        mesh: &MeshRefinement,
        done: Reached,
        [read, write, total]: [f64; 3],
        threads: &Threads,
    ) -> Self {
        let refinement = mesh.refinement();
        let first = refinement.first();
        let left = refinement.left(threads);
        let mut roots: Vec<u32> = left.iter().map(|left| left.root.0).collect();
        roots.dedup();
        let mut generations: Vec<usize> = Vec::new();
        for generation in refinement.generations().map(usize::from) {
            generations.resize(generations.len().max(generation + 1), 0);
            generations[generation] += 1;
        }
        let refine = done.steps.iter().map(|step| step.seconds).sum();
        Self {
            mesh: args.mesh.clone(),
            output: args.output.clone(),
            history: args.arrays.history.clone(),
            complete: done.is_reached,
            stopped_by: done.stopped_by,
            steps: done.steps,
            first_tets: first.tets.len(),
            first_worst_eas: Shapes::of(&first, threads).worst_eas,
            left: left.len(),
            left_roots: roots.len(),
            generations,
            on_surface: done.on_surface.map(|all| Surface {
                moved: all.n_moved,
                short: all.n_short,
                farthest: all.farthest,
            }),
            volume_deviation: done.volume_deviation,
            memory_per_tet: refinement.memory() as f64 / refinement.mesh().tets.len() as f64,
            seconds: Seconds { read, refine, write, total },
        }
    }

    pub(super) fn print(&self, outcome: &Outcome, console: &Console) {
        console.conclude(self, outcome);
        console.print(format_args!(
            "{}: initially {} tets, worst EAS {}",
            self.mesh.display(),
            count(self.first_tets),
            short(self.first_worst_eas)
        ));
        console.print(self.table());
        let at = |step: Option<&Step>| step.map(|step| step.quality);
        console.print(quality::table([
            ("input", at(self.steps.first())),
            ("at the end", at(self.steps.last())),
        ]));
        if self.left > 0 {
            console.print(format_args!(
                "{} tets in {} tets of the first mesh are below the quality bounds of these: no better \
                 division exists",
                count(self.left),
                count(self.left_roots)
            ));
        }
        if let Some(surface) = &self.on_surface {
            console.print(format_args!(
                "{} points were put on the surface, {} only part of the way; the farthest by {}",
                count(surface.moved),
                count(surface.short),
                short(surface.farthest)
            ));
        }
        let held = self.steps.iter().map(|step| step.held).max().unwrap_or(0);
        if held > 0 {
            console.print(format_args!(
                "{} tets were left unchanged, since cells of other kinds (except lines) hold their edges, \
                 or a tet would be inverted",
                count(held)
            ));
        }
        console.print(format_args!("wrote {}", self.output.display()));
        if let Some(history) = &self.history {
            console.print(format_args!("wrote {}", history.display()));
        }
        let Seconds { read, refine, write, total } = self.seconds;
        let [read, refine, write, total] = [read, refine, write, total].map(seconds);
        console.print(format_args!(
            "read {read}, refined {refine}, wrote {write}, all {total}; the memory of divisions takes {:.0} \
             bytes per tet",
            self.memory_per_tet
        ));
    }

    fn table(&self) -> Table {
        let head = ["step", "tets", "marked", "promoted", "worst EAS", "of first", "mean EAS"];
        let mut table =
            Table::new(head.into_iter().chain(["worst ratio", "of first", "mean ratio", "seconds"]));
        for step in &self.steps {
            let ratio = |x: f64| format!("{x:.3}");
            table.row([
                step.step.clone(),
                count(step.tets),
                count(step.marked),
                count(step.promoted),
                short(step.worst_eas),
                ratio(step.eas_of_first),
                ratio(step.mean_eas),
                short(step.worst_mean_ratio),
                ratio(step.mean_ratio_of_first),
                ratio(step.mean_mean_ratio),
                seconds(step.seconds),
            ]);
        }
        table
    }
}
