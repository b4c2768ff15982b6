//! The words of `motet mesh`, as its help shows them.

use std::path::PathBuf;

use clap::Args;
use motet::delaunay::EdgePoints;
use motet::meshing::{Options, Surfaces};
use motet::preflight::Repairs;
use motet::remesh;

use super::words::{self, LayersWord, layers};
use crate::verbs::convert::WritingArgs;
use crate::words::positive;

/// Fill closed surfaces with tets: every triangle is a facet of the mesh
///
/// Surfaces may be nested, side by side, or share triangles: what each of them encloses is a region of its own. They are looked at first,
/// exactly: what stops them from being filled is told, all of it, with ids and places.
#[derive(Debug, Args)]
#[command(after_help = "\
Triangles keep their patches. Points at one place, within a file or between files, are one.
Without --size the tets have the vertices of the surfaces, and few others.

Examples:
  A lumen, edges inside about 0.4 long:
    motet mesh lumen.stl -o lumen.vtu --size 0.4
  A lumen with a dissection flap, a sheet that ends inside it:
    motet mesh lumen.vtp --membrane flap.vtp -o lumen.vtu
  A surface with small holes and flat triangles, mended first:
    motet mesh scan.stl -o scan.vtu --repair
  Five thin layers on all walls but flat ends, the first 0.02 thick, each 1.2 times as thick as the one before:
    motet mesh lumen.vtp -o lumen.vtu --size 0.4 --layers 5,0.02,1.2
  The same on one patch, more on another:
    motet mesh lumen.vtp -o lumen.vtu --size 0.4 --layers wall=5,0.02,1.2 --layers sac=8,0.01,1.2
  What is wrong with a surface, to look at:
    motet mesh scan.stl -o scan.vtu --culprits wrong.vtp

Exit status 3: a surface cannot be filled; nothing is written but the culprits. 4: a triangle is there in pieces only,
a tet has no volume in the digits of its coordinates, bad tets are left, or no layer found room; the mesh is written.")]
pub(crate) struct MeshArgs {
    /// Surface files: closed each
    #[arg(value_name = "SURFACE", required = true)]
    pub(crate) surfaces: Vec<PathBuf>,
    /// Where the result goes, in any mesh format
    #[arg(short, long, value_name = "OUT")]
    pub(crate) output: PathBuf,
    /// Put points inside so that edges are about so long, in units of the surface; and repair bad tets
    #[arg(long, value_name = "H", value_parser = positive)]
    pub(crate) size: Option<f64>,
    /// Repair tets below this EAS, the surface kept [default: 0.2 with --size]
    #[arg(long, value_name = "EAS")]
    pub(crate) min_eas: Option<f64>,
    /// A surface that may end inside the others, such as a flap. Repeatable
    #[arg(long, value_name = "SURFACE")]
    pub(crate) membrane: Vec<PathBuf>,
    /// Thin layers on walls: how many, the first one's thickness, how many times as thick each next one is. On one patch, or on all that is
    /// neither a cap (flat, with a sharp crease round it) nor named. Where there is no room they are thinner, or none. Repeatable
    #[arg(long, value_name = "[PATCH=]N,FIRST,GROWTH", value_parser = layers)]
    pub(crate) layers: Vec<LayersWord>,
    /// The --layers without a patch go on this one alone, and on others named so. Repeatable
    #[arg(long, value_name = "PATCH", requires = "layers")]
    pub(crate) layers_on: Vec<String>,
    /// Leave layers as wedges and pyramids, not divided into tets: for formats that hold these, such as VTU, VTK and MSH
    #[arg(long, requires = "layers")]
    pub(crate) keep_prisms: bool,
    /// Mend first: drop triangles without area and those that are there twice, turn all outward, close small holes
    #[arg(long)]
    pub(crate) repair: bool,
    /// Close holes of at most so many edges
    #[arg(long, value_name = "N", default_value_t = 32, requires = "repair")]
    pub(crate) hole_edges: usize,
    /// Merge points nearer than this, in units of the surface
    #[arg(long, value_name = "DISTANCE", requires = "repair")]
    pub(crate) merge: Option<f64>,
    /// Let points stay on edges of the surface: triangles are then in pieces, the tets Delaunay as far as triangles allow
    #[arg(long)]
    pub(crate) delaunay: bool,
    /// Where what is wrong goes, as a surface to look at
    #[arg(long, value_name = "FILE")]
    pub(crate) culprits: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) writing: WritingArgs,
}

impl MeshArgs {
    /// # Errors
    /// When layers are asked for on a patch that is not there, or twice.
    pub(super) fn options(&self, surfaces: &Surfaces) -> motet::Result<Options> {
        let improve = self.min_eas.or(self.size.map(|_| remesh::Options::default().min_eas));
        Ok(Options {
            edge_points: if self.delaunay { EdgePoints::Stay } else { EdgePoints::MoveInside },
            size: self.size,
            improve: improve.map(|min_eas| remesh::Options { min_eas, ..remesh::Options::default() }),
            layers: words::stacks(&self.layers, &self.layers_on, self.keep_prisms, surfaces)?,
        })
    }

    pub(super) fn repairs(&self) -> Option<Repairs> {
        self.repair.then(|| Repairs {
            merge: Some(self.merge.unwrap_or(0.0)),
            drop_degenerate: true,
            drop_duplicates: true,
            orient: true,
            close_holes: Some(self.hole_edges),
        })
    }
}
