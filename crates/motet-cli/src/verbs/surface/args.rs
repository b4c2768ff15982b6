//! Arguments of `motet surface`, as its help shows them.

use std::path::PathBuf;

use clap::Args;
use motet::meshing::even::{Cut, SurfaceWords};
use motet::meshing::tubes::{BraidWords, CoilWords, TubeWords};

use super::shape;
use crate::adapting::AdaptArgs;
use crate::help;
use crate::words::not_negative;
use crate::writing::WritingArgs;

/// Give a surface even triangles, within a distance of it; it may be open
///
/// Long edges are split, short ones collapsed, edges flipped and vertices moved along the surface. Rims,
/// borders of patches, edges of more than two triangles and creases stay. Triangles that cross none before
/// cross none afterwards. Arrays and patches are carried.
#[derive(Debug, Args)]
#[command(
    override_usage = "motet surface IN -o OUT [OPTIONS]\n       motet surface LINES -o OUT --tubes R [OPTIONS]"
)]
#[command(after_help = "\
IN is a surface of triangles, quads or polygons; of a volume mesh, its surface cells with their \
patches or, where it has none, its boundary. Points at the same place are merged and triangles \
without area dropped. The distance is measured both ways, at vertices, middles of edges and \
centroids. On points, real numbers are interpolated in the nearest triangle of the same patch; \
whole numbers, names and directions are those of one of its corners. Triangles get the values of \
the nearest one.

Examples:
  Even triangles, as many as there are, within a thousandth of the extent:
    motet surface scan.stl -o even.stl
  Edges about 0.4 long, at most 0.02 away:
    motet surface lumen.vtp -o even.vtp --size 0.4 --distance 0.02
  Sizes from an array, such as a part of the radius:
    motet surface lumen.vtp -o even.vtp --size-array h
  Cut a branch off at a place, then close and extend the ends:
    motet surface scan.stl -o cut.vtp --clip 12,3,-40,0,0.5,-1 --smooth 10
    motet cap cut.vtp -o lumen.vtp --inlet largest --extend 20
  Steps of a segmentation smoothed first:
    motet surface scan.stl -o even.stl --smooth 20 --feature-angle 120
  Round wires of radius 0.03 along the lines of a file, one closed surface:
    motet surface stent.vtk -o stent.stl --tubes 0.03
  From positions and pairs of their numbers, as beam codes write them:
    motet surface positions.txt --segments pairs.txt -o stent.stl --tubes 0.065
  A braided stent, and a coil:
    motet surface -o stent.stl --stent radius=2,length=10,wires=48,pitch=8,wire=0.02
    motet surface -o coil.stl --coil radius=1,pitch=0.4,turns=5,wire=0.1

Exit status 3: there is no surface or line, or a coordinate is not finite; nothing is written. 4: the \
surface is farther away than allowed, or smoothing made triangles cross; it is written.")]
pub(crate) struct SurfaceArgs {
    /// Mesh file of the surface; with --tubes, of centre lines; with --segments, a text of positions
    #[arg(value_name = "IN", required_unless_present_any = ["stent", "coil"], conflicts_with_all = ["stent", "coil"])]
    pub(crate) input: Option<PathBuf>,
    /// Output file, in any mesh format
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) adapting: AdaptArgs<SurfaceWords>,
    #[arg(long, help = help::repeatable::<SurfaceWords>("clip"), value_name = "X,Y,Z,NX,NY,NZ|X,Y,Z,R",
        value_parser = clip, allow_hyphen_values = true)]
    pub(crate) clip: Vec<Vec<f64>>,
    #[arg(long, help = help::effect::<SurfaceWords>("hole_edges"), value_name = "N",
        default_value_t = SurfaceWords::default().hole_edges, requires = "repair")]
    pub(crate) hole_edges: usize,
    #[arg(long, help = help::effect::<SurfaceWords>("smooth"), value_name = "N",
        default_value_t = SurfaceWords::default().smooth)]
    pub(crate) smooth: usize,
    #[arg(long, help = help::effect::<TubeWords>("tubes"), value_name = "R|ARRAY", help_heading = "Wires")]
    pub(crate) tubes: Option<String>,
    /// IN is a text of positions, three numbers a row, and this one has the segments between them: two
    /// numbers of positions a row, counted from 1.
    #[arg(long, value_name = "FILE", requires = "tubes", help_heading = "Wires")]
    pub(crate) segments: Option<PathBuf>,
    #[arg(long, help = help::effect::<TubeWords>("sides"), value_name = "N", help_heading = "Wires")]
    pub(crate) sides: Option<usize>,
    #[arg(long, help = help::effect::<TubeWords>("join"), value_name = "GAP", value_parser = not_negative,
        help_heading = "Wires")]
    pub(crate) join: Option<f64>,
    #[arg(long, help = shape::help::<BraidWords>("The wires of a braided stent, such as a flow diverter, along z from 0"),
        value_name = "NAME=X,...", value_parser = shape::words::<BraidWords>, conflicts_with = "coil",
        help_heading = "Wires")]
    pub(crate) stent: Option<BraidWords>,
    #[arg(long, help = shape::help::<CoilWords>("A coil around the z axis, its middle at 0"),
        value_name = "NAME=X,...", value_parser = shape::words::<CoilWords>, help_heading = "Wires")]
    pub(crate) coil: Option<CoilWords>,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

fn clip(text: &str) -> Result<Vec<f64>, String> {
    let numbers = crate::words::numbers(text)?;
    Cut::of_numbers(&numbers).map(|_| numbers).map_err(|e| e.to_string())
}

impl SurfaceArgs {
    /// How wires become tubes, if the input is wires.
    pub(super) fn tube_words(&self) -> TubeWords {
        let is_shape = self.stent.is_some() || self.coil.is_some();
        let tubes = self.tubes.clone().or_else(|| is_shape.then(|| "radius".to_owned()));
        TubeWords { tubes, sides: self.sides, join: self.join }
    }

    /// What the call requests.
    pub(super) fn words(&self) -> SurfaceWords {
        let AdaptArgs { size, distance, feature_angle, growth, repair, unite, wrap, .. } = self.adapting;
        SurfaceWords {
            size,
            distance,
            feature_angle,
            growth,
            size_array: self.adapting.size_array.clone(),
            clip: self.clip.clone(),
            repair,
            unite,
            wrap,
            hole_edges: self.hole_edges,
            merge: self.adapting.merge.unwrap_or(SurfaceWords::default().merge),
            smooth: self.smooth,
        }
    }
}
