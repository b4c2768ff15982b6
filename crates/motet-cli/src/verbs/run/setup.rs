//! The start of a run: the mesh with its devices, the motion of its walls, and how it is kept good.

use std::path::PathBuf;

use motet::base::Threads;
use motet::contact;
use motet::geometry::vector::norm;
use motet::implant::{self, implant};
use motet::mesh::history::Rules;
use motet::mesh::mean_edge_lengths;
use motet::motion::{Extent, Method, MethodWords, SlideTolerance, Strain};
use motet::moving::{GAP, Motion, Options, Script, Watching};
use motet::refine::{Criterion, Limits, Size, Wanted};
use motet::remesh::{self, Held, SurfaceRule};
use motet::{Error, Mesh, Result, io};

use super::course;
use super::job::{self, Job, Layer, Refine};
use crate::console::Console;
use crate::verbs::implant::{Names, inside, with_file};
use crate::verbs::moving;
use crate::verbs::refine::{parsers, target};

/// Everything that a run starts with.
pub(super) struct Setup {
    /// The mesh in its first position.
    pub(super) mesh: Mesh,
    pub(super) script: Script,
    pub(super) options: Options,
    /// What to refine, and after every how many steps.
    pub(super) refining: Vec<(usize, Wanted)>,
}

impl Setup {
    pub(super) fn of(job: &Job, threads: &Threads, console: &Console) -> Result<Self> {
        let mesh = with_devices(job, threads, console)?;
        let mut motion = motion(job, &mesh).map_err(|e| job.with_job_file(e))?;
        let script = course::script(job, &mesh, &motion, threads, console)?;
        let moves_on = moves_on(job, &mesh, &motion, &script);
        motion.strain = strain(job, &motion.method, moves_on).map_err(|e| job.with_job_file(e))?;
        let returns = job.motion.returns.unwrap_or(!moves_on);
        let options = options(job, &mesh, motion, returns).map_err(|e| job.with_job_file(e))?;
        let refining = job.refine.iter().map(|spec| wanted(job, spec, threads));
        let refining = refining.collect::<Result<_>>().map_err(|e| job.with_job_file(e))?;
        Ok(Self { mesh, script, options, refining })
    }
}

/// A body that moves farther than this many edges changes the tets around it, whether it comes back or not.
const FAR_EDGES: f64 = 3.0;

/// Whether a wall moves on without coming back, or a rigid body moves far.
fn moves_on(job: &Job, mesh: &Mesh, motion: &Motion, script: &Script) -> bool {
    if job.motion.moves.iter().any(|part| part.in_time.is_ramp()) {
        return true;
    }
    if !matches!(motion.method, Method::Bodies(_)) {
        return false;
    }
    let edges = mean_edge_lengths(&mesh.points, mesh.cells.tets().map(|(_, tet)| tet));
    let driven = motion.driven(mesh);
    let steps = job.steps_in_period();
    (1..steps).any(|k| {
        let displacement = script.at(k as f64 / steps as f64);
        driven.iter().zip(displacement).any(|(v, d)| norm(d) > FAR_EDGES * edges[v.index()])
    })
}

/// The mesh with devices put into it: first together those that keep their triangles, since they may be
/// nested, then those that get a new surface.
fn with_devices(job: &Job, threads: &Threads, console: &Console) -> Result<Mesh> {
    let mut mesh = read(job, &job.mesh, console)?;
    let matching: Vec<&job::Device> = job.device.iter().filter(|device| device.conform.is_none()).collect();
    let conforming = job.device.iter().filter(|device| device.conform.is_some()).map(|device| vec![device]);
    for group in [matching].into_iter().chain(conforming).filter(|group| !group.is_empty()) {
        let interface = match group[0].conform {
            Some(tolerance) => implant::Interface::Conform { tolerance: Some(tolerance) },
            None => implant::Interface::Match,
        };
        let mut names = Names::of(&mesh.label_names);
        let device = |spec: &&job::Device| {
            names.device(&job.path(&spec.file), inside(spec.hollow, spec.fill), console)
        };
        let devices = group.iter().map(device).collect::<Result<Vec<_>>>()?;
        let files: Vec<PathBuf> = group.iter().map(|spec| job.path(&spec.file)).collect();
        let options = implant::Options { interface, ..implant::Options::default() };
        let made = implant(&mesh, &devices, &options, &Rules::default(), threads);
        mesh = made.map_err(|e| with_file(e, &job.path(&job.mesh), &files, &devices))?.mesh;
    }
    Ok(mesh)
}

fn read(job: &Job, file: &std::path::Path, console: &Console) -> Result<Mesh> {
    let (mesh, notes) = io::read_noted(job.path(file))?;
    notes.iter().for_each(|note| console.warn(note));
    Ok(mesh)
}

fn options(job: &Job, mesh: &Mesh, motion: Motion, returns: bool) -> Result<Options> {
    let mut rules = Rules::default();
    for (name, carry) in &job.carry {
        rules.carry(mesh, name, *carry)?;
    }
    if let Some(name) = job.contents.iter().find(|name| mesh.cell_field(name).is_none()) {
        let known: Vec<&str> = mesh.cell_data.iter().map(|field| field.name.as_str()).collect();
        return Err(Error::input(format!("there is no cell array `{name}` for `contents`"))
            .remedy(format!("the mesh has: {}", known.join(", "))));
    }
    let repair = &job.repair;
    let repair_options = remesh::Options {
        min_eas: repair.min_eas,
        surface: SurfaceRule::of_name(&repair.surface, repair.distance)?,
        held: Held::of_names(mesh, &repair.hold)?,
        ..remesh::Options::default()
    };
    Ok(Options {
        motion,
        repair: (!repair.off).then_some(repair_options),
        margin: repair.margin,
        floor: repair.floor,
        improve_below: repair.improve_below,
        returns,
        valid_at_start: repair.valid_at_start,
        rules,
        contents: job.contents.clone(),
        watch: watching(job, mesh)?,
        // Histories are only for callers of the library.
        remembered: 1,
    })
}

fn motion(job: &Job, mesh: &Mesh) -> Result<Motion> {
    let spec = &job.motion;
    let method = match &spec.method {
        None => Method::default(),
        Some(name) => Method::of_name(name, MethodWords::default())?,
    };
    if !spec.bodies.is_empty() && !matches!(method, Method::Bodies(_)) {
        return Err(Error::input("motion.bodies names rigid bodies, but the method does not use them")
            .remedy("add method = \"bodies\""));
    }
    let rigid_layer = match &spec.rigid_layer {
        None => None,
        Some(layer) => Some((extent(layer)?, mesh.find_patches(&spec.rigid_layer_at)?)),
    };
    Ok(Motion {
        method,
        bodies: mesh.find_patches(&spec.bodies)?,
        within_walls: spec.within_walls,
        smoothing: spec.smooth,
        inside: mesh.find_patches(&spec.inside)?,
        sliding: mesh.find_patches(&spec.slide)?,
        slide_tolerance: spec.slide_tolerance.map_or_else(SlideTolerance::default, SlideTolerance),
        rigid_layer,
        ..Motion::default()
    })
}

/// Where bodies put the strain: as the job says; by default in a band where a body moves on.
fn strain(job: &Job, method: &Method, moves_on: bool) -> Result<Strain> {
    let is_of_bodies = matches!(method, Method::Bodies(_));
    match &job.motion.strain {
        Some(_) if !is_of_bodies => Err(Error::input(
            "motion.strain says where bodies put the strain, but the method does not use bodies",
        )
        .remedy("add method = \"bodies\"")),
        Some(name) => Strain::of_name(name),
        None if is_of_bodies && moves_on => Ok(Strain::Band),
        None => Ok(Strain::Even),
    }
}

/// An extent from a number, or from a word as on the command line of `motet move`.
fn extent(layer: &Layer) -> Result<Extent> {
    let word = match layer {
        Layer::Distance(distance) => distance.to_string(),
        Layer::Word(word) => word.clone(),
    };
    moving::parsers::layer(&word).map_err(|e| Error::input(format!("motion.rigid_layer = {word}: {e}")))
}

fn watching(job: &Job, mesh: &Mesh) -> Result<Option<Watching>> {
    let Some(spec) = &job.contact else { return Ok(None) };
    mesh.find_patches(&spec.patches)?;
    let options = contact::Options {
        warn: spec.warn,
        own: spec.own,
        within: spec.within.unwrap_or(f64::INFINITY),
        ..contact::Options::default()
    };
    let (horizon, hold) = (spec.horizon, spec.hold);
    Ok(Some(Watching { patches: spec.patches.clone(), options, horizon, hold }))
}

/// The refinement that an entry of `refine` requests, and after every how many steps: by default once, before
/// the first.
fn wanted(job: &Job, spec: &Refine, threads: &Threads) -> Result<(usize, Wanted)> {
    let mut criteria = Vec::new();
    let invalid = |what: &str| Error::input(format!("refine: {what}"));
    for text in &spec.near {
        let near = parsers::near(text).map_err(|e| invalid(&e))?;
        criteria.push(Criterion::Near {
            target: target(&job.path(&near.surface), threads)?,
            within: near.within,
        });
    }
    for text in &spec.near_size {
        let near = parsers::near_size(text).map_err(|e| invalid(&e))?;
        let target = target(&job.path(&near.surface), threads)?;
        criteria.push(Criterion::NearSize { target, size: near.size, growth: near.growth });
    }
    type Parse = fn(&str) -> std::result::Result<Criterion, String>;
    let lists: [(&[String], Parse); 6] = [
        (&spec.ball, parsers::ball),
        (&spec.in_box, parsers::in_box),
        (&spec.patch, parsers::patch),
        (&spec.region, parsers::region),
        (&spec.gradient, parsers::gradient),
        (&spec.vorticity, parsers::vorticity),
    ];
    for (texts, parse) in lists {
        for text in texts {
            criteria.push(parse(text).map_err(|e| invalid(&e))?);
        }
    }
    for text in &spec.conditions {
        criteria.push(Criterion::Where(parsers::condition(text).map_err(|e| invalid(&e))?));
    }
    if spec.gaps {
        criteria.push(Criterion::Size(Size::Array(GAP.into())));
        if spec.smallest.is_none() {
            return Err(invalid("gaps can become arbitrarily narrow")
                .remedy("add smallest, the edge length at which division stops"));
        }
    }
    if criteria.is_empty() && !spec.coarsen {
        return Err(invalid("the entry has no criterion")
            .remedy("say where: near, near_size, where, ball, box, patch, ..."));
    }
    let limits = Limits { generation: spec.limit_generation, smallest: spec.smallest, ..Limits::default() };
    let wanted = Wanted {
        criteria,
        coarsen: spec.coarsen,
        generations: spec.generations,
        limits,
        ..Wanted::default()
    };
    match spec.every {
        Some(0) => Err(invalid("every is 0")
            .remedy("give a number of steps, or omit it to refine once, before the first step")),
        every => Ok((every.unwrap_or(usize::MAX), wanted)),
    }
}
