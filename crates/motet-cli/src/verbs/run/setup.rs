//! The start of a run: the mesh with its devices, the motion of its walls, and how it is kept good.

use std::path::PathBuf;

use motet::base::Threads;
use motet::geometry::vector::norm;
use motet::implant::{self, implant};
use motet::mesh::history::Rules;
use motet::mesh::mean_edge_lengths;
use motet::motion::{MethodName, Motion, Strain};
use motet::moving::{GAP, Options, Script};
use motet::refine::{Criterion, Limits, Size, Wanted};
use motet::{Error, Mesh, Result, io};

use super::course;
use super::job::{self, Job, Refine};
use crate::console::Console;
use crate::verbs::implant::{Names, inside, with_file};
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
        let mut motion = job.motion.motion.clone();
        motion.options(&mesh).map_err(|e| job.with_job_file(e))?;
        let script = course::script(job, &mesh, &motion, threads, console)?;
        let moves_on = moves_on(job, &mesh, &motion, &script)?;
        if motion.method == MethodName::Bodies && moves_on {
            motion.strain.get_or_insert(Strain::Band);
        }
        let returns = job.motion.walls.returns.unwrap_or(!moves_on);
        let options = options(job, &mesh, motion, returns).map_err(|e| job.with_job_file(e))?;
        let refining = job.refine.iter().map(|spec| wanted(job, spec, threads));
        let refining = refining.collect::<Result<_>>().map_err(|e| job.with_job_file(e))?;
        Ok(Self { mesh, script, options, refining })
    }
}

/// A body that moves farther than this many edges changes the tets around it, whether it comes back or not.
const FAR_EDGES: f64 = 3.0;

/// Whether a wall moves on without coming back, or a rigid body moves far.
///
/// # Errors
/// When the mesh lacks a patch that is driven.
fn moves_on(job: &Job, mesh: &Mesh, motion: &Motion, script: &Script) -> Result<bool> {
    if job.motion.walls.moves.iter().any(|part| part.in_time.is_ramp()) {
        return Ok(true);
    }
    if motion.method != MethodName::Bodies {
        return Ok(false);
    }
    let edges = mean_edge_lengths(&mesh.points, mesh.cells.tets().map(|(_, tet)| tet));
    let driven = motion.driven(mesh)?;
    let steps = job.steps_in_period();
    Ok((1..steps).any(|k| {
        let displacement = script.at(k as f64 / steps as f64);
        driven.iter().zip(displacement).any(|(v, d)| norm(d) > FAR_EDGES * edges[v.index()])
    }))
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
    let watch = match &job.contact {
        Some(contact) => contact.watching(mesh).map_err(|e| e.at("[contact]"))?,
        None => None,
    };
    Ok(Options {
        motion,
        returns,
        rules,
        contents: job.contents.clone(),
        watch,
        // Histories are only for callers of the library.
        remembered: 1,
        ..job.repair.options(mesh).map_err(|e| e.at("[repair]"))?
    })
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
