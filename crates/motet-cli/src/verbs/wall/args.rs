//! Arguments of `motet wall`, as its help shows them.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use motet::meshing::wall::{ThicknessWord, WallWords};

use crate::help;
use crate::writing::WritingArgs;

/// Put a solid wall around a vessel: layers outward from its surface
///
/// The wall shares the vertices of the lumen and ends in the planes of caps. Where there is no space, such as
/// between branches, it is thinner. Wall and inside are regions of one mesh, the outer side and the ends are
/// patches.
#[derive(Debug, Args)]
#[command(override_usage = "motet wall IN -o OUT --thickness T [OPTIONS]")]
#[command(group = ArgGroup::new("how_thick").required(true))]
#[command(after_help = "\
IN is a volume mesh, whose boundary the wall stands on; or a surface, closed or open at its ends: \
then OUT is the wall alone. Facets for the wall must be triangles. New points and cells take the \
values of arrays at the foot of the wall.

Examples:
  Blood and wall, one mesh for FSI:
    motet mesh lumen.stl -o blood.vtu --size 0.4 --surface adapt
    motet wall blood.vtu -o fsi.vtu --thickness 0.2 --layers 2
  A wall of 15 % of the local radius, as wedges:
    motet wall lumen.vtp -o wall.vtu --of-radius 0.15 --layers 3 --keep-prisms
  On some patches, as thick as an array says:
    motet wall blood.vtu -o fsi.vtu --thickness t_wall --on wall --on sac

Exit status 3: there is no surface, or it crosses itself; nothing is written. 4: there is no space \
for a wall at some vertices; what was reached is written.")]
pub(crate) struct WallArgs {
    /// Mesh file of the vessel: a volume mesh or a surface
    #[arg(value_name = "IN")]
    pub(crate) input: PathBuf,
    /// Output file, in any mesh format
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[arg(long, help = help::effect::<WallWords>("thickness"), value_name = "T|ARRAY", group = "how_thick",
        value_parser = thickness)]
    pub(crate) thickness: Option<ThicknessWord>,
    #[arg(long, help = help::effect::<WallWords>("of_radius"), value_name = "PART", group = "how_thick",
        value_parser = crate::words::positive)]
    pub(crate) of_radius: Option<f64>,
    #[arg(long, help = help::effect::<WallWords>("layers"), value_name = "N",
        default_value_t = WallWords::default().layers)]
    pub(crate) layers: u32,
    #[arg(long, help = help::effect::<WallWords>("growth"), value_name = "RATIO",
        default_value_t = WallWords::default().growth, value_parser = crate::words::positive)]
    pub(crate) growth: f64,
    #[arg(long, help = help::repeatable::<WallWords>("on"), value_name = "PATCH")]
    pub(crate) on: Vec<String>,
    #[arg(long, help = help::effect::<WallWords>("keep_prisms"))]
    pub(crate) keep_prisms: bool,
    #[arg(long, help = help::effect::<WallWords>("name"), value_name = "NAME",
        default_value_t = WallWords::default().name)]
    pub(crate) name: String,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

fn thickness(text: &str) -> Result<ThicknessWord, String> {
    match ThicknessWord::of_text(text) {
        ThicknessWord::Length(t) if !(t > 0.0 && t.is_finite()) => {
            Err(format!("a thickness is a number above 0, or the name of an array; got {text}"))
        }
        word => Ok(word),
    }
}

impl WallArgs {
    /// What the call requests.
    pub(super) fn words(&self) -> WallWords {
        WallWords {
            thickness: self.thickness.clone(),
            of_radius: self.of_radius,
            layers: self.layers,
            growth: self.growth,
            on: self.on.clone(),
            keep_prisms: self.keep_prisms,
            name: self.name.clone(),
        }
    }
}
