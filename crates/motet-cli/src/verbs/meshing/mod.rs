//! `motet mesh`: closed surfaces in, volume mesh out.

mod args;
mod parsers;
mod report;

use std::path::PathBuf;
use std::time::Instant;

use motet::base::Threads;
use motet::mesh::Qualities;
use motet::meshing::{Dividing, Surfaces, fill, sizes_by};
use motet::preflight::{Preflight, Role, culprits};
use motet::{Mesh, io};

pub(crate) use args::MeshArgs;

use self::report::Report;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::outputs;
use crate::table::seconds;
use crate::words::stem;

pub(crate) fn run(args: &MeshArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let begin = Instant::now();
    let words = args.words();
    let inputs = || args.surfaces.iter().chain(&args.membrane).map(PathBuf::as_path);
    outputs::check(&args.output, inputs(), "a surface")?;
    if let Some(file) = &args.culprits {
        outputs::check(file, inputs(), "a surface")?;
    }
    let meter = console.meter("meshing", None);
    let threads = common.threads()?.watched(meter.watch());
    meter.stage("reading surfaces");
    let (mut surfaces, sizes) = read(args, &threads, console)?;
    let read = begin.elapsed().as_secs_f64();
    meter.stage("checking surfaces");
    let done = words.repairs().map(|repairs| surfaces.repair(&repairs, &threads)).transpose()?;
    let sizes = match (&done, sizes) {
        (Some(done), Some(sizes)) => Some(done.at_points(&sizes)),
        (_, sizes) => sizes,
    };
    let checking = Instant::now();
    let preflight = surfaces.preflight(&threads);
    let check = checking.elapsed().as_secs_f64();
    if let Some(file) = &args.culprits {
        io::write_on(
            file,
            &culprits(&surfaces.points, &surfaces.triangles, &preflight),
            &args.writing.options(),
            &threads,
        )?;
    }
    let mut report = Report::new(args, &preflight, done.as_ref().map_or(&[], |done| &done.done));
    if !preflight.is_fit() {
        drop(meter);
        return Err(refused(args, &surfaces, &report, &preflight, console));
    }
    let filling = Instant::now();
    let options = words.options(&surfaces, sizes)?;
    let coarse = options.sizes.as_ref().and_then(|sizes| sizes.coarse(&surfaces));
    match (coarse, options.dividing) {
        (None, _) | (_, Dividing::Adapt) => {}
        (Some(coarse), Dividing::Never) => console.warn(format!("{coarse}. They are kept, so tets on them are bad, and one round of repair is made; give a larger --size, or leave out --surface keep")),
        (Some(coarse), _) => console.warn(format!("{coarse}. They are divided in their own planes; --surface keep keeps them")),
    }
    let filled = fill(&surfaces, &preflight, &options, &threads)?;
    let fill = filling.elapsed().as_secs_f64();
    let quality = Qualities::of_mesh(&filled.mesh, &threads);
    meter.stage("writing");
    let writing = Instant::now();
    let lost = io::write_on(&args.output, &filled.mesh, &args.writing.options(), &threads)?;
    let write = writing.elapsed().as_secs_f64();
    drop(meter);
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));
    lost.iter().for_each(|what| console.warn(what));
    let outcome = Outcome::of(filled.not_reached(&options));
    report.end(
        filled.report,
        filled.improved,
        filled.layers,
        quality,
        [read, check, fill, write, begin.elapsed().as_secs_f64()],
        outcome == Outcome::Done,
    );
    report.print(&outcome, console);
    Ok(outcome)
}

/// Reads the surfaces, and the sizes at their points from the array that the call names.
fn read(
    args: &MeshArgs,
    threads: &Threads,
    console: &Console,
) -> motet::Result<(Surfaces, Option<Vec<f64>>)> {
    let mut meshes: Vec<(Mesh, Role, String)> = Vec::new();
    let mut sizes = Vec::new();
    let roles = [(&args.surfaces, Role::Boundary), (&args.membrane, Role::Membrane)];
    for (file, role) in roles.into_iter().flat_map(|(files, role)| files.iter().map(move |file| (file, role)))
    {
        let (mesh, notes) = io::read_on(file, threads)?;
        notes.iter().for_each(|what| console.warn(what));
        if let Some(array) = &args.adapting.size_array {
            sizes.push(sizes_by(&mesh, array).map_err(|e| e.in_file(file))?);
        }
        meshes.push((mesh, role, stem(file).unwrap_or_default()));
    }
    let meshes: Vec<_> = meshes.iter().map(|(mesh, role, name)| (mesh, *role, name.as_str())).collect();
    let surfaces = Surfaces::new(&meshes)?;
    let sizes = args.adapting.size_array.as_ref().map(|_| surfaces.sizes(&sizes));
    Ok((surfaces, sizes))
}

/// Reports every fault; returns the first as the error.
fn refused(
    args: &MeshArgs,
    surfaces: &Surfaces,
    report: &Report,
    preflight: &Preflight,
    console: &Console,
) -> motet::Error {
    report.print(&Outcome::Done, console);
    let error =
        preflight.first_error().unwrap_or_else(|| motet::Error::input("the surfaces cannot be meshed"));
    let fault = preflight.faults.iter().find(|fault| fault.is_fatal);
    let meshes = fault.and_then(|fault| surfaces.meshes.get(fault.surface as usize));
    let files: Vec<&PathBuf> = args.surfaces.iter().chain(&args.membrane).collect();
    let names = |meshes: &Vec<u32>| {
        let of = meshes.iter().filter_map(|&mesh| files.get(mesh as usize));
        of.map(|file| file.display().to_string()).collect::<Vec<_>>().join(", ")
    };
    match meshes.map(names) {
        Some(names) => error.in_file(names),
        None => error,
    }
}
