//! `motet move`: boundary displacement in, volume mesh or series out.

mod args;
pub(crate) mod parsers;
mod patches;
mod plan;
mod report;
mod sink;

use std::path::Path;
use std::time::Instant;

use motet::base::{Point, Threads};
use motet::io;
use motet::mesh::Boundary;
use motet::motion::{
    self, Certificate, FacetSet, MethodName, Motion, MotionParts, Mover, Options, mesh_velocity,
};
use motet::{Error, Mesh, Result};

pub(crate) use args::MoveArgs;

use self::args::Method;
use self::patches::Patches;
use self::plan::Plan;
use self::report::{Chosen, Report, Step};
use self::sink::Sink;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::outputs;

pub(crate) fn run(args: &MoveArgs, common: &Common, console: &Console) -> Result<Outcome> {
    let begin = Instant::now();
    let motion = args.displacement.as_ref().map(Path::new);
    outputs::check(&args.output, motion, "the motion")?;
    for nodal in &args.nodal {
        let others = [args.output.as_path(), &args.mesh].into_iter().chain(motion);
        outputs::check_beside(&nodal.file, others, "displacements")?;
    }
    let threads = common.threads()?;
    let (mesh, notes) = io::read_on(&args.mesh, &threads)?;
    notes.iter().for_each(|note| console.warn(note));
    let mut report = Report::new(args, &mesh);
    report.seconds.read = begin.elapsed().as_secs_f64();

    let boundary = Boundary::of(&mesh.cells);
    if boundary.is_empty() {
        return Err(Error::input("has no volume cells, and `move` moves the inside of a volume")
            .in_file(&args.mesh)
            .remedy("give a mesh of tetrahedra or other volume cells"));
    }
    let patches = Patches::new(&mesh, &args.patch)?;
    let mut plan = Plan::new(&mesh, &boundary, &patches, args, console)?;
    report.find_hanging(&mesh, &boundary);
    let mut options = options(args, &boundary, &patches, &plan)?;
    let meter = console.meter("setting up the motion", None);
    let threads = threads.watched(meter.watch());
    if args.method == Method::Auto {
        report.choice = Some(choose(args, &mesh, &boundary, &patches, &mut options, &threads, console)?);
    }
    let setup = Instant::now();
    let mut mover = Mover::new(&mesh, &options, &threads).map_err(|e| e.in_file(&args.mesh))?;
    drop(meter);
    report.seconds.setup = setup.elapsed().as_secs_f64();
    report.begin(&mover, &plan, &threads);
    report.warn(console);

    let mut sink = Sink::new(args, &mesh, &patches)?;
    frames(&mut plan, &mut mover, &mut sink, &mut report, threads, console)?;
    sink.end()?;
    report.end(sink.moved(), begin.elapsed().as_secs_f64());
    let outcome = Outcome::of(report.not_reached());
    report.print(&outcome, console);
    Ok(outcome)
}

fn options(args: &MoveArgs, boundary: &Boundary, patches: &Patches<'_>, plan: &Plan<'_>) -> Result<Options> {
    let facets = |words: &[String]| words.iter().map(|word| patches.find(word)).collect::<Result<Vec<_>>>();
    let (sliding, bodies) = (facets(&args.slide)?, facets(&args.body)?);
    check_method(args)?;
    // A Laplace equation is stiff at the facets that would have the rigid layer.
    let needs_wall = args.rigid_layer.is_some() || args.method == Method::Named(MethodName::Laplace);
    let wall = needs_wall.then(|| wall(args, boundary, patches, plan, &sliding)).transpose()?;
    let motion = Motion {
        method: args.method.name(),
        within_walls: args.within_walls,
        smooth: usize::from(args.smooth),
        rigid_layer: args.rigid_layer,
        slide_tolerance: args.slide_tolerance,
        residual: args.residual,
        factor_gib: args.factor.unwrap_or(0.0),
        ..Motion::default()
    };
    motion.options_on(MotionParts { bodies, wall, sliding, also_moved: plan.driven.clone() })
}

/// Chooses a method by trying all steps, and puts it into the options.
fn choose(
    args: &MoveArgs,
    mesh: &Mesh,
    boundary: &Boundary,
    patches: &Patches<'_>,
    options: &mut Options,
    threads: &Threads,
    console: &Console,
) -> Result<Chosen> {
    let frames = || {
        // Frames are read in order, so each method needs a plan of its own.
        let mut plan = Plan::new(mesh, boundary, patches, args, console)?;
        Ok((plan.first_frame..plan.times.len()).map(move |k| plan.displacements(k)))
    };
    let choice =
        motion::choose(mesh, options, args.least, frames, threads).map_err(|e| e.in_file(&args.mesh))?;
    let chosen = Chosen { method: choice.method.name(), least: choice.least, tried: choice.tried };
    options.method = choice.method;
    Ok(chosen)
}

/// Refuses options that the method does not use.
fn check_method(args: &MoveArgs) -> Result<()> {
    if args.least.is_some() && args.method != Method::Auto {
        return Err(Error::options("--least is a criterion for choosing a method, but the method is given")
            .remedy("add --method auto"));
    }
    if !args.body.is_empty() && !matches!(args.method, Method::Named(MethodName::Bodies) | Method::Auto) {
        return Err(Error::options("--body names a rigid body, but the method does not use rigid bodies")
            .remedy("add --method bodies"));
    }
    if args.factor.is_some() && !matches!(args.method.name(), MethodName::Elastic | MethodName::Laplace) {
        return Err(Error::options(
            "--factor keeps the factorisation of a linear system, but the method solves none",
        )
        .remedy("add --method elastic"));
    }
    Ok(())
}

/// The facets that have the rigid layer: those of the named patches, otherwise all that move and do not
/// slide.
fn wall(
    args: &MoveArgs,
    boundary: &Boundary,
    patches: &Patches<'_>,
    plan: &Plan<'_>,
    sliding: &[FacetSet],
) -> Result<FacetSet> {
    if args.rigid_layer_at.is_empty() {
        let within = |all: &[motet::base::VertexId], facet: usize| {
            boundary.facets.list(facet).iter().all(|v| all.binary_search(v).is_ok())
        };
        return Ok(FacetSet::of_boundary(boundary, "the moving boundary", |i| {
            within(&plan.moving, i) && !sliding.iter().any(|slide| within(&slide.vertices, i))
        }));
    }
    let named = args.rigid_layer_at.iter().map(|word| patches.find(word)).collect::<Result<Vec<_>>>()?;
    Ok(FacetSet::joined(named).unwrap_or_default())
}

/// Processes the frames in order; stops after one that is not reached.
fn frames(
    plan: &mut Plan<'_>,
    mover: &mut Mover,
    sink: &mut Sink<'_>,
    report: &mut Report,
    threads: Threads,
    console: &Console,
) -> Result<()> {
    let n = plan.times.len();
    let meter = console.meter("moving", Some(n - plan.first_frame));
    let threads = threads.watched(meter.watch());
    let mut points = mover.reference().to_vec();
    let mut before =
        Position { time: plan.times.first().copied().unwrap_or_default(), points: points.clone() };
    for k in plan.first_frame..n {
        let displacements = plan.displacements(k)?;
        let certificate = mover.advance(&displacements, &mut points, &threads)?;
        let time = before.time + (plan.times[k] - before.time) * certificate.fraction;
        let is_last = k + 1 == n || !certificate.complete;
        let velocity = if plan.timed { Some(velocity(&before, time, &points)?) } else { None };
        let writing = Instant::now();
        let file = sink.take(time, &points, velocity, is_last, &threads)?;
        report.seconds.write += writing.elapsed().as_secs_f64();
        if let Some(file) = &file {
            console.detail(format_args!("wrote {}", file.display()));
        }
        report.seconds.moving += certificate.seconds.total;
        report.step(Step { step: k, time, file, certificate: certificate.clone() });
        report.measure_openings(&points);
        before = Position { time, points: points.clone() };
        meter.step();
        if !certificate.complete {
            return Ok(());
        }
    }
    drop(meter);
    sink.lost.iter().for_each(|what| console.warn(what));
    Ok(())
}

/// Where the points of a mesh are at one time.
struct Position {
    time: f64,
    points: Vec<Point>,
}

/// The velocities by backward difference; zero in the first frame, which has no predecessor.
fn velocity(before: &Position, time: f64, points: &[Point]) -> Result<Vec<Point>> {
    if time > before.time {
        mesh_velocity(&before.points, points, time - before.time)
    } else {
        Ok(vec![[0.0; 3]; points.len()])
    }
}

/// The number of inverted cells of a certificate, with those of the input mesh in parentheses.
pub(crate) fn inverted(certificate: &Certificate) -> String {
    match certificate.inverted_before {
        0 => certificate.inverted.to_string(),
        before => format!("{} ({before} at first)", certificate.inverted),
    }
}
