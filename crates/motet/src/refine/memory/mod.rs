//! What is remembered of a refined mesh outside of this program: a few whole numbers for each tet, so that a later run goes on.
//!
//! | step | file | how |
//! |---|---|---|
//! | tell | `tell` | of each tet where it lies in which tet of the first mesh, and which of its vertices is what there |
//! | gather | `trees` | tets of one origin come together again, where all of them are still there |
//! | dissolve | `dissolve` | what others have changed, and what cannot fit it any more, starts anew |
//! | triangles, lines | `triangles`, `lines` | triangles of patches and lines come together as the tets do |
//! | recall | `recall` | the forest, built as it was |
//!
//! A tet that came from elsewhere, such as from remeshing, becomes a root. So do the tets beside it that were divided together with one that is gone. What
//! these need of the others stays split: whatever is coarsened, the mesh fits.

mod dissolve;
mod lines;
mod recall;
mod tell;
mod trees;
mod triangles;

use crate::base::{Error, Point, Result};
use crate::kernel::{Extract, NEW};
use crate::mesh::TetMesh;

/// As a root: the tet is not known.
pub const UNKNOWN: u32 = u32::MAX;

/// What has to be kept with a refined mesh, array by array.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// Of each tet, a number that it shares with the tets that come from the same tet of the first mesh; [`UNKNOWN`] for one that does not come from refinement.
    pub roots: Vec<u32>,
    /// The way down from there: a one, then three bits for each generation that say which of the eight it lies in.
    pub paths: Vec<u64>,
    /// What its four vertices are in the tet at the end of that way, four bits each, the first in the lowest: 0 to 3 a corner, 4 to 9 the middle of an edge.
    pub pieces: Vec<u16>,
    /// How many of the divisions on that way, from the first, somebody asked for.
    pub asked: Vec<u8>,
    /// Of each triangle, which corner its first vertex is in the tet of the first mesh that it is a facet of.
    pub corners: Vec<u8>,
    /// Of each vertex, where it was when the mesh was new: that is where shapes are judged.
    pub reference: Vec<Point>,
}

impl Memory {
    /// That of the mesh that changed by others' hands: tets, triangles and vertices that came are not known.
    #[must_use]
    pub fn after(&self, change: &Extract) -> Self {
        let of_tets = || change.tet_to_old.iter().map(|&old| (old != NEW).then_some(old as usize));
        let old_point = |(i, &old): (usize, &u32)| match old {
            NEW => change.mesh.points[i],
            old => self.reference[old as usize],
        };
        Self {
            roots: of_tets().map(|old| old.map_or(UNKNOWN, |t| self.roots[t])).collect(),
            paths: of_tets().map(|old| old.map_or(0, |t| self.paths[t])).collect(),
            pieces: of_tets().map(|old| old.map_or(0, |t| self.pieces[t])).collect(),
            asked: of_tets().map(|old| old.map_or(0, |t| self.asked[t])).collect(),
            corners: change.triangle_to_old.iter().map(|&t| self.corners[t as usize]).collect(),
            reference: change.vertex_to_old.iter().enumerate().map(old_point).collect(),
        }
    }

    /// Checks that there is an entry for everything.
    fn check(&self, mesh: &TetMesh) -> Result<()> {
        let n = mesh.tets.len();
        let lengths = [self.roots.len(), self.paths.len(), self.pieces.len(), self.asked.len()];
        let fits = lengths.into_iter().all(|length| length == n)
            && self.corners.len() == mesh.triangles.len()
            && self.reference.len() == mesh.points.len();
        if fits { Ok(()) } else { Err(unfit("it has not an entry for each tet, triangle and point")) }
    }
}

/// The error of a memory that is of another mesh.
fn unfit(why: &str) -> Error {
    Error::input(format!("what is remembered of its refinement does not fit the mesh: {why}"))
        .remedy("forget it: then the mesh as it is counts as the first")
}

/// Where a way down ends: how many generations.
fn generation(path: u64) -> u32 {
    (63 - path.max(1).leading_zeros()) / 3
}

/// Which of the eight a way takes at a generation.
fn step(path: u64, generation_of_path: u32, at: u32) -> usize {
    (path >> (3 * (generation_of_path - 1 - at)) & 7) as usize
}

/// What the vertices of a tet are in the one that it is a piece of.
fn locals(piece: u16) -> [u8; 4] {
    [0, 1, 2, 3].map(|i| (piece >> (4 * i) & 15) as u8)
}
