//! The report of `motet move`: a table for people, an object for programs.

use std::path::PathBuf;

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::vector::distance;
use motet::mesh::Boundary;
use motet::mesh::check::{HangingVertex, hanging_vertices};
use motet::motion::{Certificate, Interface, LeavesPlane, MethodName, Mover, Setup, SlidingPlane, Tried};
use serde::Serialize;

use super::args::MoveArgs;
use super::inverted;
use super::plan::Plan;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::quality;
use crate::table::{Table, count, seconds, short, time};
use crate::words;

/// Patches that deviate from their plane by less than this part of their radius count as flat: the rounding
/// of files in single precision.
const FLAT: f64 = 1e-6;

/// Openings up to this part of the mesh's size are rounding: the mesh counts as closed there.
const ROUNDING: f64 = 1e-9;

/// All results of `motet move`.
#[derive(Debug, Serialize)]
pub(crate) struct Report {
    #[serde(serialize_with = "words::paths")]
    mesh: PathBuf,
    #[serde(serialize_with = "words::paths")]
    output: PathBuf,
    /// Whether everything requested was reached.
    complete: bool,
    points: usize,
    cells: usize,
    /// Vertices that did not move, as a share of all.
    untouched: f64,
    /// How the method was chosen, if a choice was requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) choice: Option<Chosen>,
    setup: Setup,
    /// The planes that patches slide in.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    sliding: Vec<SlidingPlane>,
    /// Interfaces inside that an array moves, with the number of vertices of each.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    interfaces: Vec<MovedInterface>,
    /// Number of points inside whose displacement in the array is not used.
    unused_inside: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    hanging: Option<Hanging>,
    #[serde(skip)]
    hanging_vertices: Vec<HangingVertex>,
    /// The certificate of the input mesh.
    before: Certificate,
    /// The certificate of the last step.
    after: Certificate,
    steps: Vec<Step>,
    pub(crate) seconds: Stages,
}

/// An interface inside that an array moves.
#[derive(Debug, Serialize)]
struct MovedInterface {
    name: String,
    vertices: usize,
}

/// Vertices that lie on facets of which they are not corners: what is on both sides counts as boundary.
#[derive(Debug, Serialize)]
struct Hanging {
    vertices: usize,
    /// The first of them, and where it was.
    first: VertexId,
    place: Point,
    /// The largest distance of such a vertex from its former place on its facet, and which vertex.
    opening: f64,
    opens_at: VertexId,
    /// An opening of up to this is rounding.
    #[serde(skip)]
    rounding: f64,
}

/// How a method was chosen.
#[derive(Debug, Serialize)]
pub(crate) struct Chosen {
    pub(crate) method: MethodName,
    /// The lower bound for the worst cell.
    pub(crate) least: f64,
    pub(crate) tried: Vec<Tried>,
}

impl Chosen {
    fn print(&self, console: &Console) {
        for tried in &self.tried {
            let came_to = match (&tried.refused, tried.worst) {
                (Some(why), _) => why.clone(),
                (None, Some(worst)) => format!("worst {} in {} steps", short(worst), tried.frames),
                (None, None) => format!("{} steps", tried.frames),
            };
            console.print(format_args!("tried {}: {came_to} ({})", tried.method, seconds(tried.seconds)));
        }
        if self.tried.last().is_some_and(|last| last.kept) {
            console.print(format_args!("{} keeps every cell at or above {}", self.method, short(self.least)));
        } else {
            let least = short(self.least);
            console.warn(format_args!(
                "no method keeps every cell at or above {least}; {} comes closest",
                self.method
            ));
        }
    }
}

/// One step of a motion.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Step {
    pub(crate) step: usize,
    pub(crate) time: f64,
    /// The file it was written to, if any.
    #[serde(serialize_with = "words::paths")]
    pub(crate) file: Option<PathBuf>,
    #[serde(flatten)]
    pub(crate) certificate: Certificate,
}

/// Seconds by stage.
#[derive(Debug, Default, Serialize)]
pub(crate) struct Stages {
    pub(crate) read: f64,
    pub(crate) setup: f64,
    #[serde(rename = "move")]
    pub(crate) moving: f64,
    pub(crate) write: f64,
    total: f64,
}

impl Report {
    pub(crate) fn new(args: &MoveArgs, mesh: &Mesh) -> Self {
        Self {
            mesh: args.mesh.clone(),
            output: args.output.clone(),
            complete: false,
            points: mesh.points.len(),
            cells: mesh.cells.len(),
            untouched: 1.0,
            choice: None,
            setup: Setup::default(),
            sliding: Vec::new(),
            interfaces: Vec::new(),
            unused_inside: 0,
            hanging: None,
            hanging_vertices: Vec::new(),
            before: Certificate::default(),
            after: Certificate::default(),
            steps: Vec::new(),
            seconds: Stages::default(),
        }
    }

    /// Searches for hanging vertices.
    pub(crate) fn find_hanging(&mut self, mesh: &Mesh, boundary: &Boundary) {
        self.hanging_vertices = hanging_vertices(mesh, boundary);
        self.hanging = self.hanging_vertices.first().map(|hanging| Hanging {
            vertices: self.hanging_vertices.len(),
            first: hanging.vertex,
            place: mesh.points[hanging.vertex.index()],
            opening: 0.0,
            opens_at: hanging.vertex,
            rounding: mesh.bounds().map_or(0.0, |[low, high]| ROUNDING * distance(low, high)),
        });
    }

    /// Measures how far hanging vertices have left their facets, with the vertices at `points`.
    pub(crate) fn measure_openings(&mut self, points: &[Point]) {
        let Some(hanging) = &mut self.hanging else { return };
        for vertex in &self.hanging_vertices {
            let opening = vertex.opening(points);
            if opening > hanging.opening {
                (hanging.opening, hanging.opens_at) = (opening, vertex.vertex);
            }
        }
    }

    pub(crate) fn begin(&mut self, mover: &Mover, plan: &Plan<'_>, threads: &Threads) {
        self.setup = *mover.setup();
        self.sliding = mover.sliding().to_vec();
        self.unused_inside = plan.unused;
        let counted = |i: &Interface| MovedInterface { name: i.name.clone(), vertices: i.vertices.len() };
        self.interfaces = plan.interfaces.iter().map(counted).collect();
        self.before = mover.quality(mover.reference(), threads);
    }

    /// Warns of an input mesh with defects.
    pub(crate) fn warn(&self, console: &Console) {
        if self.before.inverted > 0 {
            console.warn(format_args!(
                "{}: {} cells of the input are inverted or flat; they do not stop the motion; `motet info` \
                 lists them",
                self.mesh.display(),
                count(self.before.inverted)
            ));
        }
        for plane in self.sliding.iter().filter(|plane| plane.sliding == 0) {
            console.warn(format_args!(
                "no vertex of the sliding patch {} can slide: all are moved, kept in place, or on facets \
                 that do not slide",
                plane.patch
            ));
        }
        if let Some(Hanging { vertices, first, place: [x, y, z], .. }) = self.hanging {
            console.warn(format_args!(
                "{}: {} vertices hang on facets of which they are not corners (hanging_vertex; the first: \
                 {first} at ({x:.6}, {y:.6}, {z:.6})): \
                 the facets on both sides count as boundary, which stays where nothing moves it; `motet info` lists them, \
                 cells that meet in whole facets move as one",
                self.mesh.display(),
                count(vertices),
            ));
        }
    }

    pub(crate) fn step(&mut self, step: Step) {
        self.after = step.certificate.clone();
        self.complete = step.certificate.complete;
        self.steps.push(step);
    }

    pub(crate) fn end(&mut self, n_moved: usize, total: f64) {
        self.untouched = 1.0 - n_moved as f64 / self.points.max(1) as f64;
        self.seconds.total = total;
    }

    pub(crate) fn print(&self, outcome: &Outcome, console: &Console) {
        console.conclude(self, outcome);
        if let Some(choice) = &self.choice {
            choice.print(console);
        }
        let follow = match self.setup.solved {
            0 => format!(
                "{} with weights in a graph of {} tets",
                count(self.setup.hanging),
                count(self.setup.graph_tets)
            ),
            n if self.setup.factor_bytes > 0 => {
                let mib = self.setup.factor_bytes as f64 / f64::from(1 << 20);
                format!("{} unknown, with a factorisation of {mib:.1} MiB", count(n))
            }
            n => {
                let iterations: usize = self.steps.iter().map(|step| step.certificate.iterations).sum();
                format!("{} solved for, in {} iterations", count(n), count(iterations))
            }
        };
        console.print(format_args!(
            "{}: {} points, {} of them driven, {follow}",
            self.mesh.display(),
            count(self.points),
            count(self.setup.driven),
        ));
        if self.setup.layer > 0 || self.setup.sliding > 0 {
            console.print(format_args!(
                "{} in the rigid layer, {} sliding",
                count(self.setup.layer),
                count(self.setup.sliding)
            ));
        }
        self.print_planes(console);
        for interface in &self.interfaces {
            let n = count(interface.vertices);
            console.print(format_args!(
                "{n} vertices of the interface {} are driven by the array",
                interface.name
            ));
        }
        console.print(step_table(&self.before, &self.steps));
        if self.before.quality.distribution.is_some() {
            console.print(self.quality_table());
        }
        self.warn_of_result(console);
        self.print_end(console);
        console.print(format_args!(
            "read {}, set-up {}, {} step{} {}, writing {}, all {}",
            seconds(self.seconds.read),
            seconds(self.seconds.setup),
            self.steps.len(),
            if self.steps.len() == 1 { "" } else { "s" },
            seconds(self.seconds.moving),
            seconds(self.seconds.write),
            seconds(self.seconds.total)
        ));
    }

    /// Why the motion was not completed.
    pub(super) fn not_reached(&self) -> Option<String> {
        let last = self.steps.last()?;
        last.certificate.not_reached().map(|why| format!("step {}: {why}", last.step))
    }

    /// Quality of all tets: of the input mesh, and after each step that was written or is the last.
    fn quality_table(&self) -> Table {
        let last = self.steps.len().saturating_sub(1);
        let reported = self.steps.iter().enumerate().filter(|(k, step)| *k == last || step.file.is_some());
        let steps =
            reported.map(|(_, step)| (format!("step {}", step.step), step.certificate.quality.distribution));
        quality::table([("input".to_owned(), self.before.quality.distribution)].into_iter().chain(steps))
    }

    /// Lists planes that are flat within the tolerance, but not exactly.
    fn print_planes(&self, console: &Console) {
        for plane in self.sliding.iter().filter(|plane| plane.deviation > FLAT * plane.radius) {
            console.print(format_args!(
                "sliding patch {}: deviates from its plane by {}, {} of its radius of {}; its vertices keep \
                 their distances from it",
                plane.patch,
                short(plane.deviation),
                short(plane.deviation / plane.radius),
                short(plane.radius)
            ));
        }
    }

    /// Warns of results that the caller may not have intended.
    fn warn_of_result(&self, console: &Console) {
        let leaving =
            self.steps.iter().filter_map(|step| Some((step, step.certificate.leaves_plane.as_ref()?)));
        let farthest = leaving.reduce(|a, b| if b.1.distance > a.1.distance { b } else { a });
        if let Some((
            step,
            LeavesPlane { patch, vertex, place: [x, y, z], distance, is_significant: true, .. },
        )) = farthest
        {
            console.warn(format_args!(
                "the rim of the sliding patch {patch} leaves its plane, by {} at vertex {vertex}, initially \
                 at ({x:.6}, {y:.6}, {z:.6}), \
                 in step {}: the patch follows its rim; keep the motion of adjacent patches within the \
                 plane, or do not let this patch slide",
                short(*distance),
                step.step
            ));
        }
        if let Some(Hanging { opening, opens_at, .. }) =
            self.hanging.as_ref().filter(|h| h.opening > h.rounding)
        {
            console.warn(format_args!(
                "hanging vertices have left their facets, by up to {} (vertex {opens_at}): the mesh opens \
                 there",
                short(*opening)
            ));
        }
        if self.unused_inside > 0 && self.untouched == 1.0 {
            console.warn(format_args!(
                "nothing has moved: the array is zero on the boundary and on interfaces, and its {} nonzero \
                 values elsewhere inside are not used",
                count(self.unused_inside)
            ));
        }
    }

    fn print_end(&self, console: &Console) {
        console.print(format_args!("wrote {}", self.output.display()));
    }
}

/// A table with a row for the input mesh and one for each step.
fn step_table(before: &Certificate, steps: &[Step]) -> Table {
    let other = before.quality.worst_eas.is_none();
    let measure = if other { "worst scaled Jacobian" } else { "worst EAS" };
    let mut table = Table::new([
        "step",
        "time",
        measure,
        "in cell",
        "mean ratio",
        "bad",
        "inverted",
        "sub-steps",
        "move",
    ]);
    let mut row = |step: &str, time: &str, certificate: &Certificate, took: &str| {
        let quality = &certificate.quality;
        let of_others = quality.worst_curved_jacobian.or(quality.worst_scaled_jacobian);
        let worst = if other { of_others } else { quality.worst_eas };
        let ratio = quality.worst_mean_ratio.map(|w| short(w.value));
        table.row([
            step.to_string(),
            time.to_string(),
            worst.map_or("-".into(), |w| short(w.value)),
            worst.map_or("-".into(), |w| w.cell.to_string()),
            ratio.unwrap_or("-".into()),
            quality.bad.to_string(),
            inverted(certificate),
            certificate.substeps.to_string(),
            took.to_string(),
        ]);
    };
    row("input", "", before, "");
    for step in steps {
        let took = seconds(step.certificate.seconds.total);
        row(&step.step.to_string(), &time(step.time), &step.certificate, &took);
    }
    table
}
