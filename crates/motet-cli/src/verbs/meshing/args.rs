//! Arguments of `motet mesh`, as its help shows them.

use std::path::PathBuf;

use clap::Args;
use motet::base::Point;
use motet::delaunay::EdgePoints;
use motet::meshing::{Dividing, Options, Seed, Sizes, Surfaces};
use motet::preflight::Repairs;

use super::layer_args::{LayersArg, layers, stacks};
use super::parsers::{self, Size};
use crate::words::positive;
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
    /// Put points inside so that edges have about this length, in units of the surface, and repair bad tets.
    /// auto: the length of the surface's edges, growing inwards
    #[arg(long, value_name = "H|auto", value_parser = parsers::size)]
    pub(crate) size: Option<Size>,
    /// Whether to divide triangles of the surface to --size H within their planes, creases kept. auto: where
    /// most of them are far coarser, or narrow. divide: all of them. keep: none, so that every triangle is a
    /// facet of the mesh
    #[arg(long, value_name = "RULE", default_value = "auto", value_parser = ["auto", "divide", "keep"])]
    pub(crate) surface: String,
    /// Let sizes grow from the surface inwards, by G per unit of distance, up to --size; at most 0.7
    /// [default: 0.3 with --size auto or --size-array]
    #[arg(long, value_name = "G", value_parser = positive)]
    pub(crate) growth: Option<f64>,
    /// Take sizes at the surface from an array of its points or cells, growing inwards, up to --size
    #[arg(long, value_name = "NAME")]
    pub(crate) size_array: Option<String>,
    /// Name the region that contains a place. Repeatable
    #[arg(long, value_name = "X,Y,Z=NAME", value_parser = parsers::seed, allow_hyphen_values = true)]
    pub(crate) seed: Vec<Seed>,
    /// Leave out the region around a place. Repeatable
    #[arg(long, value_name = "X,Y,Z", value_parser = parsers::place, allow_hyphen_values = true)]
    pub(crate) hole: Vec<Point>,
    /// Leave out what closed surfaces turned inward enclose, such as the cavity of a hollow body. With
    /// --repair such surfaces stay turned inward
    #[arg(long)]
    pub(crate) voids: bool,
    /// Repair tets below this EAS, keeping the surface [default: 0.2 with sizes]
    #[arg(long, value_name = "EAS")]
    pub(crate) min_eas: Option<f64>,
    /// A surface that may end inside the others, such as a flap. Repeatable
    #[arg(long, value_name = "SURFACE")]
    pub(crate) membrane: Vec<PathBuf>,
    /// Put thin layers on walls: their number, the thickness of the first, and the ratio of each thickness to
    /// the one before. They go on one patch, or on all that are neither caps (flat, with a sharp crease all
    /// around) nor named. Where there is no space they are thinner, or absent. Repeatable
    #[arg(long, value_name = "[PATCH=]N,FIRST,GROWTH", value_parser = layers)]
    pub(crate) layers: Vec<LayersArg>,
    /// Put the --layers without a patch only on this one, and on others named so. Repeatable
    #[arg(long, value_name = "PATCH", requires = "layers")]
    pub(crate) layers_on: Vec<String>,
    /// Keep layers as wedges and pyramids instead of dividing them into tets: for formats that hold these,
    /// such as VTU, VTK and MSH
    #[arg(long, requires = "layers")]
    pub(crate) keep_prisms: bool,
    /// Repair the surfaces first: divide edges at vertices on them (T-junctions), divide faces that lie on
    /// each other alike, drop triangles without area and duplicates, turn all outward, close small holes
    #[arg(long)]
    pub(crate) repair: bool,
    /// Divide surfaces that cross along the lines where they do, and those that touch: each space between
    /// them is a region. Alone, or with --repair
    #[arg(long)]
    pub(crate) cut: bool,
    /// Close holes of at most this many edges
    #[arg(long, value_name = "N", default_value_t = 32, requires = "repair")]
    pub(crate) hole_edges: usize,
    /// Merge points nearer than this, in units of the surface
    #[arg(long, value_name = "DISTANCE", requires = "repair")]
    pub(crate) merge: Option<f64>,
    /// Allow points on edges of the surface: its triangles are then in pieces, and the tets are Delaunay as
    /// far as the triangles allow
    #[arg(long)]
    pub(crate) delaunay: bool,
    /// Write what is wrong to this file, as a surface to inspect
    #[arg(long, value_name = "FILE")]
    pub(crate) culprits: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

impl MeshArgs {
    /// What the call requests; `at_points` are the sizes from its array, one per point.
    ///
    /// # Errors
    /// When layers are requested twice for a patch, or for one that does not exist.
    pub(super) fn options(&self, at_points: Option<Vec<f64>>, surfaces: &Surfaces) -> motet::Result<Options> {
        let largest = match self.size {
            Some(Size::Length(h)) => Some(h),
            _ => None,
        };
        let sizes = Sizes::of(largest, self.size == Some(Size::Auto), self.growth, at_points);
        Ok(Options {
            edge_points: if self.delaunay { EdgePoints::Stay } else { EdgePoints::MoveInside },
            dividing: Dividing::of_name(&self.surface)?,
            seeds: self.seed.clone(),
            holes: self.hole.clone(),
            voids: self.voids,
            layers: stacks(&self.layers, &self.layers_on, self.keep_prisms, surfaces)?,
            ..Options::with_sizes(sizes, self.min_eas)
        })
    }

    pub(super) fn repairs(&self) -> Option<Repairs> {
        let all = || Repairs::all(self.merge.unwrap_or(0.0), self.hole_edges);
        let repairs = if self.repair { all() } else { Repairs::default() };
        (self.repair || self.cut).then_some(Repairs { cut: self.cut, keep_inward: self.voids, ..repairs })
    }
}
