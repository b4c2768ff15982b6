//! The start of a run: the mesh with its devices, the motion of its walls, and how it is kept good.

use std::path::PathBuf;

use motet::base::Threads;
use motet::geometry::vector::norm;
use motet::implant::implant;
use motet::mesh::history::Rules;
use motet::mesh::mean_edge_lengths;
use motet::motion::{MethodName, Motion, Strain};
use motet::moving::{GAP, Options, Script};
use motet::refine::{Criterion, Size, Wanted};
use motet::{Error, Mesh, Result, io};

use super::course;
use super::job::{self, Job, RefineTable};
use crate::console::Console;
use crate::verbs::implant::{Names, with_file};
use crate::verbs::refine::target;

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
        let mut names = Names::of(&mesh.label_names);
        let device =
            |spec: &&job::Device| names.device(&job.path(&spec.file), &spec.implant_words(), console);
        let devices = group.iter().map(device).collect::<Result<Vec<_>>>()?;
        let files: Vec<PathBuf> = group.iter().map(|spec| job.path(&spec.file)).collect();
        let options =
            group[0].implant_words().options().map_err(|e| e.at("[[device]]").in_file(&job.file))?;
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
        Some(contact) => contact.watch.watching(&contact.gaps, mesh).map_err(|e| e.at("[contact]"))?,
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
fn wanted(job: &Job, spec: &RefineTable, threads: &Threads) -> Result<(usize, Wanted)> {
    let place = |e: Error| {
        let word = e.place().map_or_else(String::new, |word| format!(" {word}"));
        e.at(format!("[[refine]]{word}"))
    };
    let invalid = |what: &str, remedy: &str| Err(place(Error::input(what).remedy(remedy)));
    let read = |file: &std::path::Path| target(&job.path(file), threads);
    let mut criteria = spec.words.criteria(read).map_err(place)?;
    if spec.timing.gaps {
        criteria.push(Criterion::Size(Size::Array(GAP.into())));
        if spec.words.smallest.is_none() {
            return invalid(
                "gaps can become arbitrarily narrow",
                "add smallest, the edge length at which division stops",
            );
        }
    }
    let wanted = spec.words.wanted(criteria).map_err(place)?;
    match spec.timing.every {
        Some(0) => {
            invalid("every is 0", "give a number of steps, or omit it to refine once, before the first step")
        }
        every => Ok((every.unwrap_or(usize::MAX), wanted)),
    }
}
