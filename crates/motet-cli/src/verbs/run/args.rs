//! Arguments of `motet run`, as its help shows them.

use std::path::PathBuf;

use clap::Args;

/// Keep a mesh good through cycles of its walls: moved, repaired, refined, watched, arrays carried
///
/// The job file says what moves, and how; tets that become bad are repaired on the way. Each step is
/// certified, and written to a series whose meshes may differ from step to step; ParaView plays it.
#[derive(Debug, Args)]
#[command(after_help = "\
A job, in TOML; names of files are relative to it. Everything except `mesh` and `output` is optional:

  mesh = \"vessel.vtu\"
  output = \"out/vessel.pvd\"       # also vessel.jsonl, a line per step; vessel.state.vtu
  every = 1                       # steps between frames of the output
  contents = [\"dye\"]              # densities whose integral over each cell is conserved

  [time]
  period = 1.0                    # in the unit of time of the output
  steps = 25                      # per period [20; for measured walls one per frame]
  periods = 3

  [[device]]                      # put into the mesh first, as `motet implant` does
  file = \"coil.stl\"
  hollow = true                   # the flow goes around it

  [motion]
  method = \"delaunay\"             # bodies, guided, ... as `motet move --method`
  strain = \"band\"                 # of bodies: beside them (band) or everywhere (even) [band if one moves on or far]
  returns = true                  # walls come back: tets are kept good at rest, too [false if one moves on or far]
  smooth = 2
  rigid_layer = \"3layers\"         # or a distance
  within_walls = false
  fixed = [\"inlet\"]
  slide = [\"outlet\"]             # flat patches that follow their rims
  slide_tolerance = 0.05          # how far they may be off their planes, as a part of their radius
  inside = [\"flap\"]               # patches inside the volume that are driven
  surfaces = \"wall.pvd\"           # measured walls, over a period
  match = \"nearest\"               # id (default), position, nearest (another mesh)
  patch = \"wall\"                  # the patch that follows the surfaces, for match = \"nearest\"

  [[motion.move]]                 # or walls that move by rule; a vertex follows the first entry that contains it
  patch = \"sac\"
  swell = 0.1                     # along its normals; or one or several of
  # shift = [0.5, 0, 0]   turn = { axis = [0, 0, 1], degrees = 40, centre = [0, 0, 0] }
  # a sheet that stands on its hinge along y bends towards x:
  # bend = { hinge = [0, 0, 0], along = [0, 1, 0], towards = [1, 0, 0], length = 2, degrees = 60 }
  # affine = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]]
  in_time = \"beat\"                # swing, ramp, or a table [[0, 0], [0.3, 1], [1, 0]] over a period

  [repair]                        # off = true: nothing is repaired
  min_eas = 0.2
  surface = \"keep\"                # adapt or loose: it may stray by `distance`
  hold = [\"solid\"]                # regions and patches that repairs leave as they are
  margin = 0.05                   # repaired tets reach min_eas + margin
  floor = 0.05                    # no step goes below this before it is repaired
  improve_below = 0.75            # tets below this near a repair are improved, too, and the count is kept; 0: off
  valid_at_start = false          # true: no tet made by a repair is flat or inverted at the start of the step

  [[refine]]                      # arguments as for `motet refine`
  near_size = [\"coil.stl=0.05,0.3\"]
  every = 5
  coarsen = true
  # gaps = true   smallest = 0.02: edges of watched patches no longer than the gap between them

  [contact]
  patches = [\"flap\", \"wall\"]
  warn = 0.1
  # hold = 0.02   walls stop at this distance, whatever the requested motion: each patch gives way to those after it

  [carry]
  pressure = \"mean\"               # or linear, inherit, drop

Exit status 3: the job cannot be read, or names what does not exist (file, line). 4: a step could \
not be completed, or bad tets are left that walls do not force; what was reached is written.")]
pub(crate) struct RunArgs {
    /// The job file
    #[arg(value_name = "JOB.toml", required_unless_present = "keys")]
    pub(crate) job: Option<PathBuf>,
    /// Print all keys of a job with their defaults and effects, as tables in Markdown
    #[arg(long, exclusive = true)]
    pub(crate) keys: bool,
    /// Continue after the last step that an earlier run of the job has saved; start from the beginning where
    /// there is none
    #[arg(long)]
    pub(crate) resume: bool,
    /// Stop after this step
    #[arg(long, value_name = "STEP")]
    pub(crate) until: Option<usize>,
}
