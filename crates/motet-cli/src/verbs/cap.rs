//! `motet cap`: closes the open rims of a surface, or of every frame of a moving one.

use std::path::{Path, PathBuf};

use clap::Args;
use motet::base::{Point, Threads};
use motet::meshing::{Caps, RimPlane};
use motet::{Error, Mesh, Result, io};
use serde_json::json;

use crate::common::Common;
use crate::console::Console;
use crate::outcome::Outcome;
use crate::outputs;
use crate::table::{count, counted, short};
use crate::words::shown;
use crate::writing::WritingArgs;

/// Close the open rims of a surface, or of every frame of a moving one
///
/// Each rim gets a cap of triangles about as long as the rim's edges: a patch `cap_1`, `cap_2`, ..., the
/// longest rim first. The caps of all frames have the same triangles, and follow the rims.
#[derive(Debug, Args)]
#[command(override_usage = "motet cap SURFACE... -o OUT [OPTIONS]")]
#[command(after_help = "\
Examples:
  motet cap ventricle.vtk -o closed.vtp
  motet cap frame_*.vtk -o wall.pvd --period 0.8          frames of one cycle, evenly in time
  motet cap wall.pvd -o closed.pvd
  motet cap lumen.stl -o closed.vtp --flatten             uneven rims, caps that can slide
  motet cap lumen.stl -o long.vtp --inlet largest --extend inlet=5 --extend 3   straight tubes at the ends
  motet mesh closed_0000.vtu -o lumen.vtu --size 2        then the inside

Exit status 3: the surface has no open rim, rims touch, or frames have different numbers of \
points, or an extension meets the surface; nothing is written.")]
pub(crate) struct CapArgs {
    /// A surface, several files that are frames of one, or a series
    #[arg(value_name = "SURFACE", required = true)]
    surfaces: Vec<PathBuf>,
    /// Output file: a .pvd for frames, any mesh format for one surface
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    /// Move the vertices of each rim onto the rim's plane, so that caps are flat and can slide (`motet move
    /// --slide`); otherwise the surface stays to the bit, and a cap is as flat as its rim. The report says
    /// how far rims are off
    #[arg(long)]
    flatten: bool,
    /// Name the ends by size instead: `inlet` the largest, or the one nearest to a place; the others
    /// `outlet_1`, `outlet_2`, ..., by falling size, or `outlet` if there is only one
    #[arg(long, value_name = "largest|X,Y,Z", value_parser = inlet, allow_hyphen_values = true)]
    inlet: Option<Inlet>,
    /// Continue the vessel beyond each open end, or the one that its cap names, by a straight tube of this
    /// length; its cross-section becomes a circle of the same area; may be repeated
    #[arg(long, value_name = "[END=]LENGTH", value_parser = extension)]
    extend: Vec<Extension>,
    /// Duration of one period, for frames given as files; after the last frame the first follows again
    #[arg(long, value_name = "TIME", default_value_t = 1.0, value_parser = crate::words::positive)]
    period: f64,

    #[command(flatten)]
    writing: WritingArgs,
}

pub(crate) fn run(args: &CapArgs, common: &Common, console: &Console) -> Result<Outcome> {
    let threads = common.threads()?;
    outputs::check(&args.output, args.surfaces.iter().map(PathBuf::as_path), "a surface")?;
    let frames = frames(args)?;
    let is_series = io::can_write_series(&args.output);
    if frames.len() > 1 && !is_series {
        return Err(Error::options("several frames need a series")
            .in_file(&args.output)
            .remedy("use a name that ends in .pvd"));
    }
    let first = read(&frames[0].1, &threads, console)?;
    let caps = caps(args, &first).map_err(|e| e.in_file(&frames[0].1))?;
    let mut planes = Vec::new();
    let mut closed = |file: &Path| {
        let (closed, found) =
            close(args, &caps, &read(file, &threads, console)?).map_err(|e| e.in_file(file))?;
        keep_worst(&mut planes, found);
        Ok(closed)
    };
    let options = args.writing.options();
    let lost = match is_series {
        true => {
            // Close all frames first: where one does not fit, nothing is written.
            let meshes = frames.iter().map(|(time, file)| Ok((*time, closed(file)?)));
            let meshes = meshes.collect::<Result<Vec<_>>>()?;
            io::write_series(&args.output, meshes.into_iter().map(Ok), &options, &threads)?
        }
        false => io::write_on(&args.output, &closed(&frames[0].1)?, &options, &threads)?,
    };
    lost.iter().for_each(|what| console.warn(what));
    let whole = caps.close(&first)?;
    let added = whole.points.len() - first.points.len();
    console.print(format_args!(
        "{}: {}, {} capped, {} points and {} triangles added",
        args.output.display(),
        counted(frames.len(), "frame"),
        counted(caps.len(), "rim"),
        count(added),
        count(whole.cells.len() - motet::mesh::Surface::of(&first).triangles.len())
    ));
    for plane in planes.iter().filter(|plane| args.flatten || plane.deviation > FLAT * plane.radius) {
        console.print(format_args!(
            "{}: its rim {} {} away from its plane, {} of its radius of {}",
            plane.patch,
            if args.flatten { "is now flat; it was" } else { "is" },
            short(plane.deviation),
            short(plane.deviation / plane.radius),
            short(plane.radius)
        ));
    }
    console.report(&json!({
        "output": shown(&args.output),
        "frames": frames.len(),
        "rims": caps.len(),
        "points": whole.points.len(),
        "triangles": whole.cells.len(),
        "flattened": args.flatten,
        "planes": planes,
    }));
    Ok(Outcome::Done)
}

/// Which end is the inlet.
#[derive(Clone, Copy, Debug)]
enum Inlet {
    Largest,
    Nearest(Point),
}

fn inlet(text: &str) -> std::result::Result<Inlet, String> {
    match text {
        "largest" => Ok(Inlet::Largest),
        _ => match crate::words::numbers(text)?[..] {
            [x, y, z] => Ok(Inlet::Nearest([x, y, z])),
            _ => Err(format!("`largest`, or a place X,Y,Z; got `{text}`")),
        },
    }
}

/// The length of extensions, of one end or of all others.
#[derive(Clone, Debug)]
struct Extension {
    end: Option<String>,
    length: f64,
}

fn extension(text: &str) -> std::result::Result<Extension, String> {
    let (end, length) = match text.rsplit_once('=') {
        Some((end, length)) => (Some(end.to_owned()), length),
        None => (None, text),
    };
    crate::words::positive(length).map(|length| Extension { end, length })
}

/// The caps that a call requests, made from the first frame.
fn caps(args: &CapArgs, first: &Mesh) -> Result<Caps> {
    let mut caps = Caps::of(first)?;
    match args.inlet {
        Some(Inlet::Largest) => caps.name_ends(first, None)?,
        Some(Inlet::Nearest(place)) => caps.name_ends(first, Some(place))?,
        None => {}
    }
    // Those with a name first: the others are for ends without an extension of their own.
    for one in args.extend.iter().filter(|one| one.end.is_some()) {
        caps.extend(first, one.end.as_deref(), one.length)?;
    }
    for one in args.extend.iter().filter(|one| one.end.is_none()) {
        caps.extend(first, None, one.length)?;
    }
    Ok(caps)
}

/// Rims that deviate from their plane by less than this part of their radius count as flat: the rounding of
/// files in single precision.
const FLAT: f64 = 1e-6;

/// Closes a frame; also returns the planes of its rims.
fn close(args: &CapArgs, caps: &Caps, frame: &Mesh) -> Result<(Mesh, Vec<RimPlane>)> {
    match args.flatten {
        true => {
            let (flat, planes) = caps.flatten(frame)?;
            Ok((caps.close(&flat)?, planes))
        }
        // A rim without area has no plane but still gets a cap.
        false => Ok((caps.close(frame)?, caps.planes(frame).unwrap_or_default())),
    }
}

/// Keeps, for each rim, the frame in which it is farthest from its plane.
fn keep_worst(worst: &mut Vec<RimPlane>, found: Vec<RimPlane>) {
    if worst.len() < found.len() {
        *worst = found;
        return;
    }
    for (worst, found) in worst.iter_mut().zip(found) {
        if found.deviation * worst.radius > worst.deviation * found.radius {
            *worst = found;
        }
    }
}

/// The frames: times and files.
fn frames(args: &CapArgs) -> Result<Vec<(f64, PathBuf)>> {
    match args.surfaces.as_slice() {
        [one] if io::is_series(one) => io::read_series(one),
        files => {
            let n = files.len() as f64;
            Ok(files.iter().enumerate().map(|(k, file)| (args.period * k as f64 / n, file.clone())).collect())
        }
    }
}

fn read(file: &Path, threads: &Threads, console: &Console) -> Result<Mesh> {
    let (mesh, notes) = io::read_on(file, threads)?;
    notes.iter().for_each(|note| console.warn(note));
    Ok(mesh)
}
