//! Arguments of `motet move`, as its help shows them.

use std::path::PathBuf;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{ArgGroup, Args, ValueEnum};
use motet::base::Names;
use motet::motion::{Extent, MethodName, Motion};

use super::parsers::{self, PatchFile, Rotate, Translate};
use crate::help;
use crate::words::positive;
use crate::writing::WritingArgs;

/// Move the boundary of a mesh, and let the volume follow
///
/// The boundary takes the prescribed motion; every vertex inside follows at the cost of a weighted sum
/// (Delaunay graph mapping). Boundary vertices without a prescribed motion stay. Where the motion would turn
/// a cell inside out, it is done in smaller parts. The result is certified step by step: worst quality and
/// where, bad and inverted cells.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("motion").required(true).multiple(true)
    .args(["displacement", "translate", "rotate", "affine"]))]
#[command(override_usage = "\
motet move MESH -o OUT --displacement ARRAY|FILE.vtp|FILE.pvd|FILE.dat [OPTIONS]
       motet move MESH -o OUT --translate PATCH=dx,dy,dz --rotate PATCH=ax,ay,az,deg ... [OPTIONS]
       motet move MESH -o OUT --affine A11,A12,..,A34 [OPTIONS]")]
#[command(after_help = "\
PATCH is the name or number of a patch of the mesh (`motet info MESH` lists them), or a NAME that
--patch gives to a surface file. Lengths are in units of the mesh, angles in degrees.

Examples:
  A sphere in a box, 0.5 along x in 10 steps, for ParaView:
    motet move box.vtu -o out/box.pvd --translate sphere=0.5,0,0
  A vessel wall that follows a series of displaced surfaces, inlet and outlet sliding:
    motet move lumen.vtu -o out/lumen.pvd --displacement wall.pvd \\
          --patch inlet=inlet.vtp --patch outlet=outlet.vtp --slide inlet --slide outlet
  A vessel wall with the thin cells at it kept as they are, and velocities for a flow solver:
    motet move lumen.vtu -o out/lumen.pvd --displacement wall.pvd --rigid-layer 3layers --dt 0.01
  The displacement array of a solid, boundary values only, in 4 steps, last state:
    motet move mesh.vtu -o moved.vtu --displacement u --steps 4

Exit status 4: the motion could not be completed; the mesh as far as it went is written.")]
pub(crate) struct MoveArgs {
    /// The mesh file (or folder)
    #[arg(value_name = "MESH")]
    pub(crate) mesh: PathBuf,
    /// Output file: a .pvd for a series (OUT_0000.vtu and so on beside it, in a folder that is created if
    /// missing), any mesh format for the last state
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// A vector point array of MESH (its values on the boundary, and inside on interfaces of regions and on
    /// patches that it moves); or a displaced surface; or a .pvd series of them (points matched by
    /// GlobalNodeID, else by position); or a .dat file of displacements over time, as used by svMultiPhysics
    /// (nodes by GlobalNodeID)
    #[arg(long, value_name = "ARRAY|FILE", help_heading = "Motion",
        conflicts_with_all = ["translate", "rotate", "affine"])]
    pub(crate) displacement: Option<String>,
    /// How to find the points of displaced surfaces in MESH
    #[arg(long = "match", value_name = "HOW", default_value = "id", help_heading = "Motion")]
    pub(crate) matching: Match,
    /// Shift a patch. Patches that share vertices must move them alike. Repeatable
    #[arg(long, value_name = "PATCH=dx,dy,dz", value_parser = parsers::translate, help_heading = "Motion",
        conflicts_with = "affine")]
    pub(crate) translate: Vec<Translate>,
    /// Rotate a patch about an axis, by default through the centre of its bounding box. A patch that is also
    /// shifted is rotated first. Beyond some 60 degrees cells become flat. Repeatable
    #[arg(long, value_name = "PATCH=ax,ay,az,deg[,cx,cy,cz]", value_parser = parsers::rotate, help_heading = "Motion",
        conflicts_with = "affine")]
    pub(crate) rotate: Vec<Rotate>,
    /// Map the whole boundary by the 3x4 matrix [A|b], row by row: x' = A x + b
    #[arg(long, value_name = "A11,A12,..,A34", value_parser = parsers::affine, allow_hyphen_values = true, help_heading = "Motion")]
    pub(crate) affine: Option<[[f64; 4]; 3]>,
    /// Number of equal parts in which the motion is done and written [default: 10 for a .pvd, else 1; for a
    /// series of surfaces one part each]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), help_heading = "Motion")]
    pub(crate) steps: Option<u32>,
    /// Seconds from one step to the next: adds the point array `velocity`, and times to the series. A series
    /// of surfaces brings its own times
    #[arg(long, value_name = "SECONDS", value_parser = positive, help_heading = "Motion")]
    pub(crate) dt: Option<f64>,

    /// Also write the positions of the vertices of a patch at all steps, as a .dat file that svMultiPhysics
    /// reads (temporal and spatial values). Repeatable
    #[arg(long, value_name = "PATCH=FILE", value_parser = parsers::patch_file, help_heading = "Motion")]
    pub(crate) nodal: Vec<PatchFile>,
    /// Add the cell array `eas` (equi-angle quality of tets: 1 regular, 0 flat, bad below 0.2)
    #[arg(long, help_heading = "Motion")]
    pub(crate) quality: bool,

    /// Name the part of the boundary that a surface file holds. Repeatable
    #[arg(long, value_name = "NAME=FILE", value_parser = parsers::patch_file, help_heading = "Boundary")]
    pub(crate) patch: Vec<PatchFile>,
    /// Keep a patch in place, even where it meets one that moves. Repeatable
    #[arg(long, value_name = "PATCH", help_heading = "Boundary")]
    pub(crate) fixed: Vec<String>,
    #[arg(long, help = help::repeatable::<Motion>("slide"), value_name = "PATCH", help_heading = "Boundary")]
    pub(crate) slide: Vec<String>,
    #[arg(long, help = help::effect::<Motion>("slide_tolerance"), value_name = "PART", value_parser = crate::words::part,
        default_value_t = Motion::default().slide_tolerance, help_heading = "Boundary")]
    pub(crate) slide_tolerance: f64,

    /// How the volume follows
    #[arg(long, value_name = "METHOD", value_parser = method(), default_value = MethodName::default().as_str(), help_heading = "Volume")]
    pub(crate) method: Method,
    /// With `--method auto`: no cell may have an EAS (or scaled Jacobian) below this [default: half of the
    /// worst of the input mesh, at most 0.1]
    #[arg(long, value_name = "EAS", value_parser = positive, help_heading = "Volume")]
    pub(crate) least: Option<f64>,
    #[arg(long, help = help::effect::<Motion>("within_walls"), help_heading = "Volume")]
    pub(crate) within_walls: bool,
    #[arg(long, help = help::repeatable::<Motion>("bodies"), value_name = "PATCH", help_heading = "Volume")]
    pub(crate) body: Vec<String>,
    #[arg(long, help = help::effect::<Motion>("smooth"), value_name = "SWEEPS", value_parser = clap::value_parser!(u8), default_value_t = 0,
        help_heading = "Volume")]
    pub(crate) smooth: u8,
    #[arg(long, help = help::effect::<Motion>("residual"), value_name = "RESIDUAL", value_parser = positive,
        default_value_t = Motion::default().residual, help_heading = "Volume")]
    pub(crate) residual: f64,
    #[arg(long, help = help::effect::<Motion>("factor_gib"), value_name = "GIB", value_parser = positive, help_heading = "Volume")]
    pub(crate) factor: Option<f64>,
    #[arg(long, help = help::effect::<Motion>("rigid_layer"), value_name = "DISTANCE|Nlayers", value_parser = parsers::layer,
        help_heading = "Volume")]
    pub(crate) rigid_layer: Option<Extent>,
    /// Patches that have the rigid layer [default: the moving ones]. Repeatable
    #[arg(long, value_name = "PATCH", requires = "rigid_layer", help_heading = "Volume")]
    pub(crate) rigid_layer_at: Vec<String>,

    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

/// How the volume follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    /// By this method.
    Named(MethodName),
    /// By the cheapest of some methods that is good enough.
    Auto,
}

impl Method {
    /// The method to begin with. A choice starts with the graph; bodies are tried in their turn.
    pub(crate) fn name(self) -> MethodName {
        match self {
            Self::Named(name) => name,
            Self::Auto => MethodName::Bodies,
        }
    }
}

/// A parser of methods: those of the library, and `auto`.
fn method() -> impl TypedValueParser<Value = Method> {
    let auto = "The cheapest of `delaunay`, `bodies`, `guided` and `elastic` that keeps the worst cell above \
                `--least`: all steps are tried first";
    let names = help::values_of::<MethodName>().chain([PossibleValue::new(AUTO).help(auto)]);
    PossibleValuesParser::new(names).try_map(|name| match name.as_str() {
        AUTO => Ok(Method::Auto),
        name => MethodName::of(name).map(Method::Named),
    })
}

const AUTO: &str = "auto";

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Match {
    /// By their GlobalNodeID (from 1) or vtkOriginalPointIds (from 0), by position where they have none
    Id,
    /// By position: for surfaces whose ids are those of another mesh. The first one must be undisplaced
    Position,
}
