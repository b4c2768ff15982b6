//! `motet implant`: puts devices into a mesh and writes one conforming mesh.

mod args;
mod report;

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::time::Instant;

use motet::implant::{Device, ImplantWords, implant};
use motet::mesh::history::Changed;
use motet::mesh::{LabelNames, Qualities, unused_name};
use motet::{Error, io};

pub(crate) use args::{ImplantArgs, inside};

use self::report::Report;
use crate::arrays::Written;
use crate::common::Common;
use crate::console::Console;
use crate::outcome::{Outcome, Seconds};
use crate::outputs;
use crate::table::seconds;
use crate::words::stem;

pub(crate) fn run(args: &ImplantArgs, common: &Common, console: &Console) -> motet::Result<Outcome> {
    let begin = Instant::now();
    outputs::check_with_history(&args.output, &args.host, args.arrays.history.as_deref())?;
    outputs::check(&args.output, args.devices.iter().map(AsRef::as_ref), "a device")?;
    let words = args.words();
    let options = words.options()?;
    let meter = console.meter("implanting", None);
    let threads = common.threads()?.watched(meter.watch());
    meter.stage("reading");
    let (host, notes) = io::read_on(&args.host, &threads)?;
    notes.iter().for_each(|what| console.warn(what));
    let rules = args.arrays.rules(&host).map_err(|e| e.in_file(&args.host))?;
    let devices = read(args, &words, &host.label_names, console)?;
    let read = begin.elapsed().as_secs_f64();
    let made = implant(&host, &devices, &options, &rules, &threads);
    let Changed { mut mesh, history, report, .. } =
        made.map_err(|e| with_file(e, &args.host, &args.devices, &devices))?;
    let quality = [&host, &mesh].map(|mesh| Qualities::of_mesh(mesh, &threads));
    meter.stage("writing");
    let Written { lost, seconds: write } =
        args.arrays.write(&mut mesh, Some(&history), &args.output, &args.writing, &threads)?;
    drop(meter);
    console.detail(format_args!("wrote {} in {}", args.output.display(), seconds(write)));
    lost.iter().for_each(|what| console.warn(what));
    let outcome = Outcome::of(report.not_reached());
    let seconds = Seconds { read, write, total: begin.elapsed().as_secs_f64() };
    Report::new(args, report, quality, seconds).print(&outcome, console);
    Ok(outcome)
}

/// Reads the devices of the call.
fn read(
    args: &ImplantArgs,
    words: &ImplantWords,
    taken: &LabelNames,
    console: &Console,
) -> motet::Result<Vec<Device>> {
    let mut names = Names::of(taken);
    args.devices.iter().map(|file| names.device(file, words, console)).collect()
}

/// Names of regions and patches that are in use.
pub(crate) struct Names(BTreeSet<String>);

impl Names {
    pub(crate) fn of(names: &LabelNames) -> Self {
        Self(names.regions.values().chain(names.patches.values()).cloned().collect())
    }

    /// Reads a device and gives it a unique name after its file.
    pub(crate) fn device(
        &mut self,
        file: &Path,
        words: &ImplantWords,
        console: &Console,
    ) -> motet::Result<Device> {
        let (mesh, notes) = io::read_noted(file)?;
        notes.iter().for_each(|what| console.warn(what));
        let name = unused_name(&stem(file).unwrap_or_default(), |name| self.0.contains(name));
        self.0.insert(name.clone());
        Ok(words.device(mesh, name))
    }
}

/// Adds to an error the file that it concerns: that of the device it names, otherwise that of the host.
pub(crate) fn with_file(error: Error, host: &Path, files: &[PathBuf], devices: &[Device]) -> Error {
    let named = devices.iter().position(|device| error.what().contains(&format!("`{}`", device.name)));
    error.in_file(named.map_or(host, |k| &files[k]))
}
