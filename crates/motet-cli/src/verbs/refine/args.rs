//! Arguments of `motet refine`, as its help shows them.

use std::path::PathBuf;

use clap::{ArgGroup, Args};
use motet::refine::RefineWords;

use crate::arrays::ArrayArgs;
use crate::help;
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

    #[arg(long, help = effect("all"), help_heading = "What to divide, by place")]
    all: bool,
    #[arg(long, help = repeatable("near"), value_name = "SURFACE=DISTANCE", value_parser = text("near"),
        help_heading = "What to divide, by place")]
    near: Vec<String>,
    #[arg(long, help = repeatable("near_size"), value_name = "SURFACE=H[,GROWTH]", value_parser = text("near_size"),
        help_heading = "What to divide, by place")]
    near_size: Vec<String>,
    #[arg(long = "box", help = repeatable("box"), value_name = "X0,Y0,Z0,X1,Y1,Z1", value_parser = text("box"),
        allow_hyphen_values = true, help_heading = "What to divide, by place")]
    within_box: Vec<String>,
    #[arg(long, help = repeatable("ball"), value_name = "X,Y,Z,R", value_parser = text("ball"),
        allow_hyphen_values = true, help_heading = "What to divide, by place")]
    ball: Vec<String>,
    #[arg(long, help = repeatable("region"), value_name = "REGION", value_parser = text("region"),
        help_heading = "What to divide, by place")]
    region: Vec<String>,
    #[arg(long, help = repeatable("patch"), value_name = "PATCH[=DISTANCE]", value_parser = text("patch"),
        help_heading = "What to divide, by place")]
    patch: Vec<String>,

    #[arg(long, help = repeatable("size"), value_name = "H|ARRAY", value_parser = text("size"),
        help_heading = "What to divide, by arrays")]
    size: Vec<String>,
    #[arg(long = "where", help = repeatable("where"), value_name = "ARRAY>VALUE", value_parser = text("where"),
        help_heading = "What to divide, by arrays")]
    conditions: Vec<String>,
    #[arg(long, help = repeatable("gradient"), value_name = "ARRAY>VALUE", value_parser = text("gradient"),
        help_heading = "What to divide, by arrays")]
    gradient: Vec<String>,
    #[arg(long, help = repeatable("jump"), value_name = "ARRAY=SHARE|Ntets", value_parser = text("jump"),
        help_heading = "What to divide, by arrays")]
    jump: Vec<String>,
    #[arg(long, help = repeatable("recovery"), value_name = "ARRAY=SHARE|Ntets", value_parser = text("recovery"),
        help_heading = "What to divide, by arrays")]
    recovery: Vec<String>,
    #[arg(long, help = repeatable("hessian"), value_name = "ARRAY[,ARRAY]=ERROR|P%|Ntets", value_parser = text("hessian"),
        help_heading = "What to divide, by arrays")]
    hessian: Vec<String>,
    #[arg(long, help = repeatable("vorticity"), value_name = "ARRAY>VALUE", value_parser = text("vorticity"),
        help_heading = "What to divide, by arrays")]
    vorticity: Vec<String>,
    #[arg(long, help = repeatable("q"), value_name = "ARRAY>VALUE", value_parser = text("q"),
        help_heading = "What to divide, by arrays")]
    q: Vec<String>,

    #[arg(long, help = effect("generations"), value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=20), help_heading = "How far")]
    generations: Option<u32>,
    #[arg(long, help = effect("limit_generation"), value_name = "N",
        value_parser = clap::value_parser!(u8).range(0..=20), help_heading = "How far")]
    limit_generation: Option<u8>,
    #[arg(long, help = effect("smallest"), value_name = "H", value_parser = positive, help_heading = "How far")]
    smallest: Option<f64>,
    #[arg(long, help = effect("at_most"), value_name = "N", help_heading = "How far")]
    at_most: Option<usize>,

    #[arg(long, help = effect("coarsen"), help_heading = "Back")]
    coarsen: bool,
    #[arg(long, help = repeatable("coarsen_where"), value_name = "ARRAY>VALUE", value_parser = text("coarsen_where"),
        help_heading = "Back")]
    coarsen_where: Vec<String>,
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
    /// What is to be divided and taken back, in the library's words.
    pub(super) fn words(&self) -> RefineWords {
        RefineWords {
            all: self.all,
            near: self.near.clone(),
            near_size: self.near_size.clone(),
            in_box: self.within_box.clone(),
            ball: self.ball.clone(),
            region: self.region.clone(),
            patch: self.patch.clone(),
            size: self.size.clone(),
            conditions: self.conditions.clone(),
            gradient: self.gradient.clone(),
            jump: self.jump.clone(),
            recovery: self.recovery.clone(),
            hessian: self.hessian.clone(),
            vorticity: self.vorticity.clone(),
            q: self.q.clone(),
            generations: self.generations,
            limit_generation: self.limit_generation,
            smallest: self.smallest,
            at_most: self.at_most,
            coarsen: self.coarsen,
            coarsen_where: self.coarsen_where.clone(),
        }
    }
}

/// The effect of an option, as the library says it.
fn effect(word: &str) -> String {
    help::effect::<RefineWords>(word)
}

/// The effect of an option that may be given several times.
fn repeatable(word: &str) -> String {
    help::repeatable::<RefineWords>(word)
}

/// Checks a text of a word, so that an error names its option.
fn text(word: &'static str) -> impl Fn(&str) -> Result<String, motet::Error> + Clone {
    move |text| RefineWords::check(word, text).map(|()| text.to_owned())
}
