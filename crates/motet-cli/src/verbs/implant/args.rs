//! Arguments of `motet implant`, as its help shows them.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use motet::Error;
use motet::implant::{self, Options};
use motet::remesh;

use crate::arrays::ArrayArgs;
use crate::verbs::remesh::eas;
use crate::words::{named, not_negative, numbers, positive};
use crate::writing::WritingArgs;

/// Put devices into a mesh: a coil into an aneurysm, a stent into a vessel; one conforming mesh comes out
///
/// Tets of the host that lie in a device or near it are replaced. Every triangle of the device's surface
/// becomes a facet of the new mesh, so that the tets inside and outside it share their vertices. Farther away
/// everything stays as it is, to the bit. Regions, patches and all arrays are carried over.
#[derive(Debug, Args)]
#[command(override_usage = "motet implant HOST DEVICE... -o OUT [OPTIONS]")]
#[command(after_help = "\
A device is a closed surface, or a mesh of tets. It becomes a region of the new mesh and its \
surface a patch, both named after its file. A device of tets keeps them; a closed surface is \
filled. Devices may be nested and share triangles, but must not touch each other otherwise.

A device may touch walls of the host (its boundary, interfaces of its regions) and go through \
them: both are divided where they meet. What lies outside of the host is cut off or kept \
(--outside); triangles common to both are a patch of their own, `NAME-contact`. Interfaces end \
at the device. A device that keeps its tets cannot be divided: use --fill.

New tets have edges as long as those of the device beside them, growing by --growth of the \
distance, up to those of the host. --carve and --reach are in lengths of the host's edges at the \
place.

Arrays of real numbers are interpolated on points and averaged over what each new tet overlaps \
on cells; whole numbers, names and directions are inherited. Values in a device come from the \
tets of the host that were there.

Examples:
  motet implant aneurysm.vtu coil.stl -o coiled.vtu
  motet implant aneurysm.vtu coil.stl -o coiled.vtu --hollow        flow around the coil only
  motet implant vessel.vtu stent.vtu thrombus.stl -o out.vtu --growth 0.3
  motet implant aneurysm.vtu coil.stl -o coiled.vtu --json | jq .report.devices

Exit status 3: a device is not a valid closed surface, keeps its tets and meets a wall, lies \
outside of the host or encloses it; nothing is written. 4: a triangle of a device is there in \
pieces only, or a bad tet is left that no angle of a surface forces; the mesh is written, and \
the report says what is left and why.")]
pub(crate) struct ImplantArgs {
    /// Mesh file (or folder) of the host, which consists of tets
    #[arg(value_name = "HOST")]
    pub(crate) host: PathBuf,
    /// Files of devices: closed surfaces, or tets
    #[arg(value_name = "DEVICE", required = true)]
    pub(crate) devices: Vec<PathBuf>,
    /// Output file, in any mesh format
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// Leave the space inside devices out of the mesh
    #[arg(long, help_heading = "Devices")]
    pub(crate) hollow: bool,
    /// Fill devices with new tets, even those that consist of tets
    #[arg(long, conflicts_with = "hollow", help_heading = "Devices")]
    pub(crate) fill: bool,

    /// What the surface of a device becomes
    #[arg(long, value_name = "HOW", default_value = "match", help_heading = "Devices")]
    interface: Interface,
    /// How far a new surface may be from the old one, with --interface conform [default: a fifth of the
    /// radius of a wire as thick as the device]
    #[arg(long, value_name = "D", value_parser = positive, help_heading = "Devices")]
    tolerance: Option<f64>,

    /// What to do with the part of a device outside the host, where the device crosses its boundary
    #[arg(long, value_name = "WHAT", default_value = "cut", help_heading = "Devices")]
    outside: Outside,
    /// How far surfaces may stray where a device meets a wall, to avoid narrow triangles there; 0: not at all
    /// [default: a twentieth of the device's edges]
    #[arg(long, value_name = "D", value_parser = not_negative, help_heading = "Devices")]
    stray: Option<f64>,

    /// What to refine in the host before carving
    #[arg(long, value_name = "WHAT", default_value = "walls", help_heading = "Room")]
    adapt: Adapt,
    /// Length of edges beside the devices where the host is refined, and of edges of new surfaces [default:
    /// that of the devices' edges, and as --tolerance requires]
    #[arg(long, value_name = "H", value_parser = positive, help_heading = "Room")]
    size: Option<f64>,
    /// How much edge lengths grow per unit of distance from the devices, at most 0.7
    #[arg(long, value_name = "G", default_value_t = 0.5, value_parser = positive, help_heading = "Room")]
    growth: f64,
    /// Replace tets nearer to a device than this many edges
    #[arg(long, value_name = "N", default_value_t = 1.0, value_parser = positive, help_heading = "Room")]
    carve: f64,
    /// Keep everything farther from all devices than this many edges, to the bit
    #[arg(long, value_name = "N", default_value_t = 3.0, value_parser = positive, help_heading = "Room")]
    reach: f64,
    /// Repair tets below this EAS within --reach
    #[arg(long, value_name = "EAS", default_value_t = 0.2, value_parser = eas, help_heading = "Room")]
    min_eas: f64,

    /// Initial value of a host array in the devices, a number for each component [default: what the host had
    /// there]. Repeatable
    #[arg(long, value_name = "ARRAY=X[,Y,Z]", value_parser = start, help_heading = "Arrays")]
    value: Vec<(String, Vec<f64>)>,

    #[command(flatten)]
    pub(crate) arrays: ArrayArgs,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Interface {
    /// Each triangle of the device is a facet of the mesh
    Match,
    /// A new surface is made near it, within --tolerance: for devices that touch or cross themselves, have
    /// open ends or bad triangles
    Conform,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Outside {
    /// It is cut off, and the host's wall bounds the device there
    Cut,
    /// It is kept, and the host's wall ends at the device
    Keep,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Adapt {
    /// Nothing
    None,
    /// Walls nearer to a device than half of their edges, which cannot be carved
    Walls,
    /// Everything near, by --size and --growth: for fields whose values vary within tets and are to be kept
    /// in their parts
    All,
}

/// Parses `ARRAY=X[,Y,Z]`.
fn start(text: &str) -> Result<(String, Vec<f64>), String> {
    let (name, value) = named(text, "ARRAY=X[,Y,Z]")?;
    Ok((name.to_owned(), numbers(value)?))
}

impl ImplantArgs {
    /// Options for the library.
    ///
    /// # Errors
    /// When options contradict each other.
    pub(super) fn options(&self) -> motet::Result<Options> {
        let interface = match (self.interface, self.tolerance) {
            (Interface::Match, None) => implant::Interface::Match,
            (Interface::Conform, tolerance) => implant::Interface::Conform { tolerance },
            (Interface::Match, Some(_)) => {
                let what = "--tolerance applies to a new surface, but the triangles are to be kept";
                return Err(Error::options(what).remedy("add --interface conform"));
            }
        };
        Ok(Options {
            interface,
            outside: match self.outside {
                Outside::Cut => implant::Outside::Cut,
                Outside::Keep => implant::Outside::Keep,
            },
            stray: self.stray,
            size: self.size,
            growth: self.growth,
            adapt: match self.adapt {
                Adapt::None => implant::Adapt::No,
                Adapt::Walls => implant::Adapt::Walls,
                Adapt::All => implant::Adapt::All,
            },
            carve: self.carve,
            reach: self.reach,
            starts: self.value.iter().cloned().collect(),
            improve: remesh::Options { min_eas: self.min_eas, ..remesh::Options::default() },
        })
    }
}
