//! Arguments of `motet refine`, as its help shows them.

use std::path::PathBuf;
use std::sync::Arc;

use clap::{ArgGroup, Args};
use motet::refine::{Condition, Criterion, HessianSizes, Limits, Target, Wanted};

use super::parsers::{self, Near, NearSize};
use crate::arrays::ArrayArgs;
use crate::words::positive;
use crate::writing::WritingArgs;

/// Divide tets where criteria request it, many generations deep, without loss of shape; and coarsen again
///
/// Every tet that a criterion marks is divided into eight; tets beside them are divided or cut so that all
/// fit. Pieces that were cut are never divided themselves, so shapes stay as good as they were, however
/// often. The file remembers what was divided: a later call continues from there, and --coarsen takes it
/// back.
#[derive(Debug, Args)]
#[command(group = ArgGroup::new("what").required(true).multiple(true).args([
    "all", "near", "near_size", "within_box", "ball", "region", "patch", "size", "conditions", "gradient",
    "jump", "recovery", "hessian", "vorticity", "q", "coarsen", "coarsen_where",
]))]
#[command(
    override_usage = "motet refine MESH -o OUT [--near SURFACE=DISTANCE] [--size H] [--where 'ARRAY>VALUE'] .. [OPTIONS]"
)]
#[command(after_help = "\
Several criteria mark every tet that any of them marks. Lengths are in units of the mesh, values \
in those of the array. ARRAY is an array on points (where cells are not named), or a part of \
one: v:x or v[0] is a component, |v| the magnitude. Ntets, such as 500000tets, requests this many tets \
instead, divided where it helps most.

Examples:
  Fine at a stent, growing with the distance from it:
    motet refine lumen.vtu -o fine.vtu --near-size stent.stl=0.05,0.3
  All tets within 0.5 of it, twice:
    motet refine lumen.vtu -o fine.vtu --near stent.stl=0.5 --generations 2
  By pressure and velocity of the mean flow of a first simulation; solve again, and repeat:
    motet refine mean.vtu -o next.vtu --hessian pressure,velocity=2% --smallest 0.02
  Half a million tets, by jumps of a gradient:
    motet refine mean.vtu -o next.vtu --jump pressure=500000tets
  Where the wall shear is high now, and coarser where it no longer is:
    motet refine step7.vtu -o step8.vtu --where 'wss>4' --limit-generation 3 --coarsen
  One generation back, everywhere:
    motet refine fine.vtu -o coarse.vtu --coarsen

Exit status 2: no criterion, or an invalid one. 3: an array, region or patch does not \
exist, or sizes need more tets than ids can number; nothing is written. 4: a limit or the number \
of generations was reached before all edges were short enough; the mesh is written.")]
pub(crate) struct RefineArgs {
    /// The mesh file (or folder)
    #[arg(value_name = "MESH")]
    pub(crate) mesh: PathBuf,
    /// Output file, in any mesh format
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,

    /// Divide everything
    #[arg(long, help_heading = "What to divide, by place")]
    pub(crate) all: bool,
    /// Divide tets within a distance of a surface (a surface file, or a mesh: its boundary). Repeatable
    #[arg(long, value_name = "SURFACE=DISTANCE", value_parser = parsers::near, help_heading = "What to divide, by place")]
    pub(crate) near: Vec<Near>,
    /// Divide until no edge is longer than H at a surface, plus GROWTH [default: 0.5] per unit of distance
    /// from it. Repeatable
    #[arg(long, value_name = "SURFACE=H[,GROWTH]", value_parser = parsers::near_size, help_heading = "What to divide, by place")]
    pub(crate) near_size: Vec<NearSize>,
    /// Divide tets whose centre is in a box. Repeatable
    #[arg(long = "box", value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = parsers::in_box, allow_hyphen_values = true, help_heading = "What to divide, by place")]
    pub(crate) within_box: Vec<Criterion>,
    /// Divide tets that overlap a ball. Repeatable
    #[arg(long, value_name = "X,Y,Z,R", value_parser = parsers::ball, allow_hyphen_values = true, help_heading = "What to divide, by place")]
    pub(crate) ball: Vec<Criterion>,
    /// Divide tets of a region, by name or number. Repeatable
    #[arg(long, value_name = "REGION", value_parser = parsers::region, help_heading = "What to divide, by place")]
    pub(crate) region: Vec<Criterion>,
    /// Divide tets that touch a patch, or lie within a distance of it. Repeatable
    #[arg(long, value_name = "PATCH[=DISTANCE]", value_parser = parsers::patch, help_heading = "What to divide, by place")]
    pub(crate) patch: Vec<Criterion>,

    /// Divide until no edge is longer than this, or than the value of an array on points or cells. Repeatable
    #[arg(long, value_name = "H|ARRAY", value_parser = parsers::size, help_heading = "What to divide, by arrays")]
    pub(crate) size: Vec<Criterion>,
    /// Divide tets where an array satisfies a condition, on cells or at one of their points: > >= < <= == !=.
    /// Repeatable
    #[arg(long = "where", value_name = "ARRAY>VALUE", value_parser = parsers::condition, help_heading = "What to divide, by arrays")]
    pub(crate) conditions: Vec<Condition>,
    /// Divide tets through which an array changes by more than this: gradient times longest edge. Repeatable
    #[arg(long, value_name = "ARRAY>VALUE", value_parser = parsers::gradient, help_heading = "What to divide, by arrays")]
    pub(crate) gradient: Vec<Criterion>,
    /// Divide the fewest tets that hold this share of the error, such as 0.5, estimated by jumps of the
    /// gradient (Kelly). Repeatable
    #[arg(long, value_name = "ARRAY=SHARE|Ntets", value_parser = parsers::jump, help_heading = "What to divide, by arrays")]
    pub(crate) jump: Vec<Criterion>,
    /// Divide the fewest tets that hold this share of the error, estimated by a recovered gradient
    /// (Zienkiewicz and Zhu). Repeatable
    #[arg(long, value_name = "ARRAY=SHARE|Ntets", value_parser = parsers::recovery, help_heading = "What to divide, by arrays")]
    pub(crate) recovery: Vec<Criterion>,
    /// Divide until edges are short enough for the second derivatives of arrays, so that errors are at most
    /// ERROR, or P percent of the range of each array. Repeatable
    #[arg(long, value_name = "ARRAY[,ARRAY]=ERROR|P%|Ntets", value_parser = parsers::hessian, help_heading = "What to divide, by arrays")]
    pub(crate) hessian: Vec<HessianSizes>,
    /// Divide tets where the vorticity of a velocity is above this. Repeatable
    #[arg(long, value_name = "ARRAY>VALUE", value_parser = parsers::vorticity, help_heading = "What to divide, by arrays")]
    pub(crate) vorticity: Vec<Criterion>,
    /// Divide tets where Q of a velocity is above this: it rotates more than it shears. Repeatable
    #[arg(long, value_name = "ARRAY>VALUE", value_parser = parsers::q, help_heading = "What to divide, by arrays")]
    pub(crate) q: Vec<Criterion>,

    /// Divide at most this many times [default: once; for sizes as often as it takes]; where --coarsen stands
    /// alone, take back this many divisions
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=20), help_heading = "How far")]
    generations: Option<u32>,
    /// Divide no tet more often than this since the first mesh, earlier calls included
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u8).range(0..=20), help_heading = "How far")]
    limit_generation: Option<u8>,
    /// Divide no tet whose parts would have no edge as long as this
    #[arg(long, value_name = "H", value_parser = positive, help_heading = "How far")]
    smallest: Option<f64>,
    /// Divide only until there are about N tets; the tets with the largest wishes, and the largest tets,
    /// first
    #[arg(long, value_name = "N", help_heading = "How far")]
    at_most: Option<usize>,

    /// Take back divisions where no criterion marks
    #[arg(long, help_heading = "Back")]
    coarsen: bool,
    /// Take back divisions where an array satisfies a condition on all eight parts, and no criterion marks.
    /// Repeatable
    #[arg(long, value_name = "ARRAY>VALUE", value_parser = parsers::condition, help_heading = "Back")]
    coarsen_where: Vec<Condition>,
    /// Start over: take the mesh as it is now for the first one, whatever the file remembers
    #[arg(long, conflicts_with_all = ["coarsen", "coarsen_where"], help_heading = "Back")]
    pub(crate) forget: bool,

    /// The true surface: new points of the boundary are projected onto it
    #[arg(long, value_name = "FILE", help_heading = "Boundary")]
    pub(crate) surface: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) arrays: ArrayArgs,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

impl RefineArgs {
    /// The refinement that the call requests.
    pub(super) fn wanted(&self, criteria: Vec<Criterion>, surface: Option<Arc<Target>>) -> Wanted {
        Wanted {
            criteria,
            coarsen: self.coarsen,
            coarsen_where: self.coarsen_where.clone(),
            generations: self.generations,
            limits: Limits {
                generation: self.limit_generation,
                smallest: self.smallest,
                n_tets: self.at_most,
            },
            surface,
            keeps_history: self.arrays.history.is_some(),
        }
    }

    /// The value of `--smallest`, by default 0.
    pub(super) fn smallest(&self) -> f64 {
        self.smallest.unwrap_or(0.0)
    }
}
