//! The words of `motet mesh`, as its help shows them.

use std::path::PathBuf;

use clap::Args;
use motet::delaunay::EdgePoints;
use motet::meshing::Options;
use motet::preflight::Repairs;
use motet::remesh;

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
  What is wrong with a surface, to look at:
    motet mesh scan.stl -o scan.vtu --culprits wrong.vtp

Exit status 3: a surface cannot be filled; nothing is written but the culprits. 4: a triangle is there in pieces only,
a tet has no volume in the digits of its coordinates, or bad tets are left; the mesh is written.")]
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
    pub(super) fn options(&self) -> Options {
        let improve = self.min_eas.or(self.size.map(|_| remesh::Options::default().min_eas));
        Options {
            edge_points: if self.delaunay { EdgePoints::Stay } else { EdgePoints::MoveInside },
            size: self.size,
            improve: improve.map(|min_eas| remesh::Options { min_eas, ..remesh::Options::default() }),
        }
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
