//! What a refinement reports: to people a table, to programs an object.

use std::path::PathBuf;

use motet::base::Threads;
use motet::mesh::history::Ledger;
use motet::refine::{MeshRefinement, OnSurface, Refinement, Shapes, Summary};
use serde::Serialize;

use super::args::RefineArgs;
use crate::console::Console;
use crate::table::{Table, count, seconds, short};

/// All that a refinement came to.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    mesh: PathBuf,
    output: PathBuf,
    history: Option<PathBuf>,
    /// Whether all edges are as short as was asked for.
    complete: bool,
    /// The mesh as it came, then after each generation.
    steps: Vec<Step>,
    /// Tets of the first mesh.
    first_tets: usize,
    /// The worst EAS of the first mesh.
    first_worst_eas: f64,
    /// Tets worse than was to be kept, and the tets of the first mesh that they lie in.
    left: usize,
    left_roots: usize,
    /// How many tets are of each generation.
    generations: Vec<usize>,
    on_surface: Option<Surface>,
    /// By how much new tets took more or less than the volume of old ones, at most in a step, as a part of what changed.
    volume_deviation: f64,
    /// Bytes for each tet that the memory takes beside the mesh.
    memory_per_tet: f64,
    seconds: Seconds,
}

/// The mesh after a generation.
#[derive(Debug, Serialize)]
pub(super) struct Step {
    step: String,
    tets: usize,
    points: usize,
    /// Tets that a criterion marked.
    marked: usize,
    /// Tets divided, though no criterion marked them, so that all fit.
    promoted: usize,
    /// Tets cut to fit their neighbours.
    cut: usize,
    /// Tets left as they are for the sake of others.
    held: usize,
    worst_eas: f64,
    mean_eas: f64,
    worst_mean_ratio: f64,
    mean_mean_ratio: f64,
    /// The worst over the worst of the first mesh.
    eas_of_first: f64,
    mean_ratio_of_first: f64,
    seconds: f64,
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

impl Step {
    pub(super) fn new(
        step: &str,
        refinement: &Refinement,
        summary: Summary,
        marked: usize,
        seconds: f64,
        threads: &Threads,
    ) -> Self {
        let [first, now] = [&refinement.first(), refinement.mesh()].map(|mesh| Shapes::of(mesh, threads));
        Self {
            step: step.to_string(),
            tets: refinement.mesh().tets.len(),
            points: refinement.mesh().points.len(),
            marked,
            promoted: summary.n_promoted,
            cut: summary.n_cut,
            held: summary.n_held,
            worst_eas: now.worst_eas,
            mean_eas: now.mean_eas,
            worst_mean_ratio: now.worst_mean_ratio,
            mean_mean_ratio: now.mean_mean_ratio,
            eas_of_first: now.worst_eas / first.worst_eas,
            mean_ratio_of_first: now.worst_mean_ratio / first.worst_mean_ratio,
            seconds,
        }
    }
}

impl Report {
    pub(super) fn new(args: &RefineArgs) -> Self {
        Self {
            mesh: args.mesh.clone(),
            output: args.output.clone(),
            history: args.arrays.history.clone(),
            complete: true,
            steps: Vec::new(),
            first_tets: 0,
            first_worst_eas: 0.0,
            left: 0,
            left_roots: 0,
            generations: Vec::new(),
            on_surface: None,
            volume_deviation: 0.0,
            memory_per_tet: 0.0,
            seconds: Seconds::default(),
        }
    }

    pub(super) fn add(&mut self, step: Step) {
        self.seconds.refine += step.seconds;
        self.steps.push(step);
    }

    pub(super) fn add_volumes(&mut self, ledger: &Ledger) {
        let parts = ledger.regions.iter().map(|region| region.deviation / region.volume_before);
        self.volume_deviation = parts.fold(self.volume_deviation, f64::max);
    }

    pub(super) fn add_on_surface(&mut self, done: OnSurface) {
        let all = self.on_surface.get_or_insert_default();
        all.moved += done.n_moved;
        all.short += done.n_short;
        all.farthest = all.farthest.max(done.farthest);
    }

    pub(super) fn end(
        &mut self,
        mesh: &MeshRefinement,
        [read, write, total]: [f64; 3],
        complete: bool,
        threads: &Threads,
    ) {
        let refinement = mesh.refinement();
        let first = refinement.first();
        (self.first_tets, self.first_worst_eas) = (first.tets.len(), Shapes::of(&first, threads).worst_eas);
        let left = refinement.left(threads);
        let mut roots: Vec<u32> = left.iter().map(|left| left.root.0).collect();
        roots.dedup();
        (self.left, self.left_roots) = (left.len(), roots.len());
        for generation in refinement.generations().map(usize::from) {
            self.generations.resize(self.generations.len().max(generation + 1), 0);
            self.generations[generation] += 1;
        }
        self.memory_per_tet = refinement.memory() as f64 / refinement.mesh().tets.len() as f64;
        self.complete = complete;
        self.seconds = Seconds { read, write, total, refine: self.seconds.refine };
    }

    pub(super) fn tell(&self, console: &Console) {
        console.report(self);
        console.say(format_args!(
            "{}: {} tets at first, worst EAS {}",
            self.mesh.display(),
            count(self.first_tets),
            short(self.first_worst_eas)
        ));
        console.say(self.table());
        if self.left > 0 {
            console.say(format_args!(
                "{} tets in {} of the first mesh are worse than 0.95 of its worst: no way to divide these is better, or all are good",
                count(self.left),
                count(self.left_roots)
            ));
        }
        if let Some(surface) = &self.on_surface {
            console.say(format_args!(
                "{} points were put on the surface, {} only part of the way; the farthest by {}",
                count(surface.moved),
                count(surface.short),
                short(surface.farthest)
            ));
        }
        let held = self.steps.iter().map(|step| step.held).max().unwrap_or(0);
        if held > 0 {
            console.say(format_args!(
                "{} tets were left as they are, since cells of other kinds hold their edges, or one would be inverted",
                count(held)
            ));
        }
        if !self.complete {
            console.say("not all edges are as short as was asked for: a limit, or the number of generations, came first");
        }
        console.say(format_args!("wrote {}", self.output.display()));
        if let Some(history) = &self.history {
            console.say(format_args!("wrote {}", history.display()));
        }
        let Seconds { read, refine, write, total } = self.seconds;
        let [read, refine, write, total] = [read, refine, write, total].map(seconds);
        console.say(format_args!(
            "read {read}, refined {refine}, wrote {write}, all {total}; {:.0} bytes a tet remember what was divided",
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
