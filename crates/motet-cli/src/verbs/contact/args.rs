//! Arguments of `motet contact`, as its help shows them.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use motet::contact::GapWords;
use motet::{Error, Result};

use crate::help;
use crate::words::positive;
use crate::writing::WritingArgs;

/// Measure how far apart surfaces are, where, and when they will touch
///
/// Finds for every vertex the exact distance to the nearest other surface, and for every pair of surfaces the
/// nearest places, including those on edges and faces. OUT holds all surfaces, with the cell array `body` (1,
/// 2 ..) and the point arrays gap, gap_normal, closest_body, closest_cell, warning, time_to_contact. Where
/// nothing is within reach, gap is NaN and closest_body 0.
#[derive(Debug, Args)]
#[command(override_usage = "\
motet contact A B [C ..] -o OUT [--warn D] [OPTIONS]
       motet contact MESH --patches P,Q[,R ..] -o OUT [--warn D] [OPTIONS]
       motet contact A --self -o OUT [--warn D] [OPTIONS]")]
#[command(after_help = "\
A and B are surfaces (.vtp .stl .obj .vtu ..), volume meshes (their boundary counts), or series \
(.pvd: all series advance together, other files stand still, and OUT is a series). Lengths are \
in units of the mesh, times in those of the velocity or of the series.

A closed surface has an inside, where gaps are negative. A surface that encloses most of another \
surface's area in the first frame, such as a vessel closed by caps around a stent, is treated as \
its room: there gaps are negative outside. The report names rooms; --room sets them, --no-room \
makes all closed surfaces solid.

Examples:
  A stent in a vessel, warning where the gap is below 0.1:
    motet contact stent.stl lumen.vtp -o gaps.vtp --warn 0.1
  Leaflets of a valve, patches of one mesh, over a cardiac cycle:
    motet contact valve.pvd --patches LCC,NCC,RCC -o out/gaps.pvd --warn 0.05
  A flap that folds, and a coil against itself:
    motet contact flap.vtp --self -o gaps.vtp --warn 0.2
  When will it touch, at the velocities of a point array, within 0.1 s:
    motet contact a.vtp b.vtp -o gaps.vtp --velocity v --horizon 0.1

Exit status 0 whether or not there are warnings; with --fail-on-warning 4 where there are.")]
pub(crate) struct ContactArgs {
    /// Surfaces, meshes or series
    #[arg(value_name = "SURFACE", required = true)]
    pub(crate) surfaces: Vec<PathBuf>,
    /// Output file for the surfaces with their gaps: .vtp, .vtu, .vtk; a .pvd for a series
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    #[arg(long, help = effect("warn"), value_name = "D", help_heading = "Gaps", value_parser = positive)]
    pub(crate) warn: Option<f64>,
    /// Patches of the one given mesh, by name or number
    #[arg(long, value_name = "P,Q", value_delimiter = ',', help_heading = "Gaps")]
    pub(crate) patches: Vec<String>,
    #[arg(long = "self", help = effect("own"), help_heading = "Gaps")]
    pub(crate) against_self: bool,
    #[arg(long, help = effect("within"), value_name = "D", help_heading = "Gaps", value_parser = positive)]
    pub(crate) within: Option<f64>,
    /// The surface of this name (of its file or patch) is the wall of a room that the others are in: gaps are
    /// negative outside. Repeatable [default: closed surfaces that enclose most of another one in the first
    /// frame]
    #[arg(long, value_name = "NAME", help_heading = "Gaps")]
    pub(crate) room: Vec<String>,
    /// No surface is a room: gaps are negative inside closed surfaces
    #[arg(long, conflicts_with = "room", help_heading = "Gaps")]
    pub(crate) no_room: bool,
    #[arg(long, help = effect("facing"), help_heading = "Gaps")]
    pub(crate) facing: bool,
    #[arg(long, help = effect("fold"), value_name = "N", default_value_t = GapWords::default().fold,
        help_heading = "Gaps", value_parser = positive)]
    pub(crate) fold: f64,
    /// How distances are found
    #[arg(long, value_name = "HOW", default_value = "exact", help_heading = "Gaps")]
    pub(crate) method: Method,

    /// Write the Delaunay tets that span the gaps, with the arrays kind (22, 31 ..) and distance, for sealing
    /// gaps or making them porous
    #[arg(long, value_name = "FILE", help_heading = "Gaps")]
    pub(crate) gap_tets: Option<PathBuf>,

    /// Look ahead: a vector point array with the velocities of the vertices; surfaces without it have
    /// velocity 0
    #[arg(long, value_name = "ARRAY", help_heading = "Looking ahead")]
    pub(crate) velocity: Option<String>,
    /// How far to look ahead, in time [default: no limit; in a series without velocities, up to the next
    /// frame]
    #[arg(long, value_name = "T", help_heading = "Looking ahead", value_parser = positive)]
    pub(crate) horizon: Option<f64>,

    /// Exit with status 4 where there is a warning, for scripts
    #[arg(long, requires = "warn")]
    pub(crate) fail_on_warning: bool,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

/// How distances are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Method {
    /// Over all triangles, by a tree of boxes
    Exact,
    /// By the Delaunay tets between the surfaces (Moyle and Ventikos 2008): an upper bound. The exact gaps
    /// are computed as well: the array gap_error is the overestimate, and all arrays but gap and warning are
    /// exact
    Delaunay,
}

/// The effect of an option, as the library says it.
fn effect(word: &str) -> String {
    help::effect::<GapWords>(word)
}

impl ContactArgs {
    /// How gaps are measured, in the library's words.
    pub(crate) fn words(&self) -> GapWords {
        GapWords {
            warn: self.warn,
            within: self.within,
            own: self.against_self,
            facing: self.facing,
            fold: self.fold,
        }
    }

    /// Refuses options that contradict each other.
    pub(crate) fn check(&self) -> Result<()> {
        if self.horizon.is_some() && self.velocity.is_none() {
            return Err(Error::options("--horizon requires --velocity")
                .remedy("a series without velocities looks ahead to its next frame"));
        }
        if self.against_self && (self.method == Method::Delaunay || self.gap_tets.is_some()) {
            return Err(Error::options("Delaunay tets span gaps between surfaces, not within one")
                .remedy("omit --self, or --method delaunay and --gap-tets"));
        }
        if self.gap_tets.is_some() && self.surfaces.iter().any(motet::io::is_series) {
            return Err(Error::options("--gap-tets requires a single state, not a series")
                .remedy("give one of its frames"));
        }
        if !self.patches.is_empty() && self.surfaces.len() != 1 {
            return Err(Error::options("--patches requires exactly one mesh")
                .remedy("give one mesh, or surfaces without --patches"));
        }
        Ok(())
    }
}
