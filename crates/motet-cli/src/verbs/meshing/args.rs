//! Arguments of `motet mesh`, as its help shows them.

use std::path::PathBuf;

use clap::Args;
use motet::base::Point;
use motet::meshing::{Dividing, MeshingWords, Seed, WallLayers};

use super::parsers;
use crate::adapting::AdaptArgs;
use crate::help;
use crate::writing::WritingArgs;

/// Fill closed surfaces with tets: every triangle becomes a facet of the mesh
///
/// Surfaces may be nested, side by side, or share triangles: what each of them encloses is a region of its
/// own. They are checked first, exactly: everything that prevents filling is reported, with ids and places.
#[derive(Debug, Args)]
#[command(after_help = "\
Triangles keep their patches. Points at one place, within a file or between files, are merged. \
Without --size the tets have the vertices of the surfaces, and few others. A size that grows is, \
at a place, the least of `size there + G * distance` over all places of the surface; the size at \
the surface is that of its edges, or of an array. Regions are numbered from the outside in. Of \
several surfaces, a region without a seed is named after the smallest that encloses it.

Examples:
  A lumen, edges inside about 0.4 long:
    motet mesh lumen.stl -o lumen.vtu --size 0.4
  As long as those of the surface, growing inwards by 0.2 of the distance, up to 2:
    motet mesh lumen.stl -o lumen.vtu --size 2 --growth 0.2
  By an array of the surface, such as a part of the radius:
    motet mesh lumen.vtp -o lumen.vtu --size-array h
  A lumen within its wall, named:
    motet mesh lumen.stl outside.stl -o vessel.vtu --seed 0,0,5=blood --seed 1.1,0,5=wall
  A lumen with a dissection flap, a sheet that ends inside it:
    motet mesh lumen.vtp --membrane flap.vtp -o lumen.vtu
  A surface with small holes and flat triangles, repaired first:
    motet mesh scan.stl -o scan.vtu --repair
  Five thin layers on all walls but flat ends, the first 0.02 thick, growing by 1.2:
    motet mesh lumen.vtp -o lumen.vtu --size 0.4 --layers 5,0.02,1.2
  Layers of the wall and thinner ones of the sac:
    motet mesh lumen.vtp -o lumen.vtu --size 0.4 --layers wall=5,0.02,1.2 --layers sac=8,0.01,1.2
  Two bodies that overlap, as three regions; faults that cross each other:
    motet mesh bodies.stl -o bodies.vtu --cut
    motet mesh box.stl --membrane fault1.stl --membrane fault2.stl -o box.vtu --cut
  The same bodies as one, without what lies inside:
    motet mesh bodies.stl -o body.vtu --unite
  The defects of a surface, to look at:
    motet mesh scan.stl -o scan.vtu --culprits wrong.vtp

Exit status 3: a surface cannot be filled; nothing is written but the culprits. 4: a triangle is \
there in pieces only, a tet has no volume in the digits of its coordinates, bad tets are left, \
or no layer had room; the mesh is written.")]
pub(crate) struct MeshArgs {
    /// Surface files: each closed, or closed together with others that end at the same edges
    #[arg(value_name = "SURFACE", required = true)]
    pub(crate) surfaces: Vec<PathBuf>,
    /// Output file, in any mesh format
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) adapting: AdaptArgs<MeshingWords>,
    #[arg(long, help = help::effect::<MeshingWords>("surface"), value_name = "RULE", value_parser = help::name_of::<Dividing>(),
        default_value_t = MeshingWords::default().surface)]
    pub(crate) surface: Dividing,
    #[arg(long, help = help::repeatable::<MeshingWords>("seeds"), value_name = "X,Y,Z=NAME", value_parser = parsers::seed,
        allow_hyphen_values = true)]
    pub(crate) seed: Vec<Seed>,
    #[arg(long, help = help::repeatable::<MeshingWords>("holes"), value_name = "X,Y,Z", value_parser = parsers::place,
        allow_hyphen_values = true)]
    pub(crate) hole: Vec<Point>,
    #[arg(long, help = help::effect::<MeshingWords>("voids"))]
    pub(crate) voids: bool,
    #[arg(long, help = help::effect::<MeshingWords>("min_eas"), value_name = "EAS")]
    pub(crate) min_eas: Option<f64>,
    /// A surface that may end inside the others, such as a flap. Repeatable
    #[arg(long, value_name = "SURFACE")]
    pub(crate) membrane: Vec<PathBuf>,
    #[arg(long, help = help::repeatable::<MeshingWords>("layers"), value_name = "[PATCH=]N,FIRST,GROWTH",
        value_parser = WallLayers::of_text)]
    pub(crate) layers: Vec<WallLayers>,
    #[arg(long, help = help::repeatable::<MeshingWords>("layers_on"), value_name = "PATCH", requires = "layers")]
    pub(crate) layers_on: Vec<String>,
    #[arg(long, help = help::effect::<MeshingWords>("keep_prisms"), requires = "layers")]
    pub(crate) keep_prisms: bool,
    #[arg(long, help = help::effect::<MeshingWords>("cut"), conflicts_with_all = ["unite", "wrap"])]
    pub(crate) cut: bool,
    #[arg(long, help = help::effect::<MeshingWords>("hole_edges"), value_name = "N",
        default_value_t = MeshingWords::default().hole_edges, requires = "repair")]
    pub(crate) hole_edges: usize,
    #[arg(long, help = help::effect::<MeshingWords>("delaunay"))]
    pub(crate) delaunay: bool,
    /// Write what is wrong to this file, as a surface to inspect
    #[arg(long, value_name = "FILE")]
    pub(crate) culprits: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

impl MeshArgs {
    /// What the call requests.
    pub(super) fn words(&self) -> MeshingWords {
        let usual = MeshingWords::default();
        MeshingWords {
            size: self.adapting.size,
            surface: self.surface,
            distance: self.adapting.distance,
            feature_angle: self.adapting.feature_angle,
            growth: self.adapting.growth,
            size_array: self.adapting.size_array.clone(),
            seeds: self.seed.clone(),
            holes: self.hole.clone(),
            voids: self.voids,
            min_eas: self.min_eas,
            layers: self.layers.clone(),
            layers_on: self.layers_on.clone(),
            keep_prisms: self.keep_prisms,
            repair: self.adapting.repair,
            cut: self.cut,
            unite: self.adapting.unite,
            wrap: self.adapting.wrap,
            hole_edges: self.hole_edges,
            merge: self.adapting.merge.unwrap_or(usual.merge),
            delaunay: self.delaunay,
        }
    }
}
