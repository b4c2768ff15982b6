//! Arguments of `motet implant`, as its help shows them.

use std::path::PathBuf;

use clap::Args;
use motet::base::Names;
use motet::implant::{Adapt, ImplantWords, Inside, InterfaceName, Outside};

use crate::arrays::ArrayArgs;
use crate::help::{self, name_of, repeatable};
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

    #[arg(long, help = effect("interface"), value_name = "HOW", value_parser = name_of::<InterfaceName>(),
        default_value = InterfaceName::default().as_str(), help_heading = "Devices")]
    interface: InterfaceName,
    #[arg(long, help = effect("tolerance"), value_name = "D", value_parser = positive,
        help_heading = "Devices")]
    tolerance: Option<f64>,

    #[arg(long, help = effect("outside"), value_name = "WHAT", value_parser = name_of::<Outside>(),
        default_value = Outside::default().as_str(), help_heading = "Devices")]
    outside: Outside,
    #[arg(long, help = effect("stray"), value_name = "D", value_parser = not_negative,
        help_heading = "Devices")]
    stray: Option<f64>,

    #[arg(long, help = effect("adapt"), value_name = "WHAT", value_parser = name_of::<Adapt>(),
        default_value = Adapt::default().as_str(), help_heading = "Room")]
    adapt: Adapt,
    #[arg(long, help = effect("size"), value_name = "H", value_parser = positive, help_heading = "Room")]
    size: Option<f64>,
    #[arg(long, help = effect("growth"), value_name = "G", default_value_t = ImplantWords::default().growth,
        value_parser = positive, help_heading = "Room")]
    growth: f64,
    #[arg(long, help = effect("carve"), value_name = "N", default_value_t = ImplantWords::default().carve,
        value_parser = positive, help_heading = "Room")]
    carve: f64,
    #[arg(long, help = effect("reach"), value_name = "N", default_value_t = ImplantWords::default().reach,
        value_parser = positive, help_heading = "Room")]
    reach: f64,
    #[arg(long, help = effect("min_eas"), value_name = "EAS",
        default_value_t = ImplantWords::default().min_eas, value_parser = eas, help_heading = "Room")]
    min_eas: f64,

    #[arg(long, help = repeatable::<ImplantWords>("values"), value_name = "ARRAY=X[,Y,Z]",
        value_parser = start, help_heading = "Arrays")]
    value: Vec<(String, Vec<f64>)>,

    #[command(flatten)]
    pub(crate) arrays: ArrayArgs,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

/// The effect of an option, as the library says it.
fn effect(word: &str) -> String {
    help::effect::<ImplantWords>(word)
}

/// Parses `ARRAY=X[,Y,Z]`.
fn start(text: &str) -> Result<(String, Vec<f64>), String> {
    let (name, value) = named(text, "ARRAY=X[,Y,Z]")?;
    Ok((name.to_owned(), numbers(value)?))
}

impl ImplantArgs {
    /// The options of the call, in the library's words.
    pub(super) fn words(&self) -> ImplantWords {
        ImplantWords {
            inside: inside(self.hollow, self.fill),
            interface: self.interface,
            tolerance: self.tolerance,
            outside: self.outside,
            stray: self.stray,
            adapt: self.adapt,
            size: self.size,
            growth: self.growth,
            carve: self.carve,
            reach: self.reach,
            min_eas: self.min_eas,
            values: self.value.iter().cloned().collect(),
        }
    }
}

/// What the call requests for the inside of devices.
pub(crate) fn inside(hollow: bool, fill: bool) -> Inside {
    match (hollow, fill) {
        (true, _) => Inside::Hollow,
        (_, true) => Inside::Filled,
        _ => Inside::Own,
    }
}
