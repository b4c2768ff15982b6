//! What is stored with a refined mesh outside of this program, a few integers per tet, so that a later run
//! can continue.
//!
//! | step | file | what it does |
//! |---|---|---|
//! | record | `record` | stores each tet's place in its tet of the first mesh and its vertices' roles there |
//! | gather | `trees` | merges tets of one origin where all of them are still there |
//! | dissolve | `dissolve` | what others have changed, and what no longer fits it, starts anew |
//! | triangles, lines | `triangles`, `lines` | triangles of patches and lines are merged as the tets are |
//! | recall | `recall` | rebuilds the forest |
//!
//! A tet from elsewhere, such as from remeshing, becomes a root. So do the tets that were divided together
//! with a removed one. Whatever edges these need split stay split: however far the mesh is coarsened, it
//! stays conforming.

mod dissolve;
mod lines;
mod recall;
mod record;
mod trees;
mod triangles;

use crate::base::{Error, MaybeId, Point, Result, TetId, VertexId};
use crate::kernel::Extract;
use crate::mesh::TetMesh;

/// The memory of a refined mesh, array by array.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Memory {
    /// For each tet, the tet of the first mesh that it lies in; none for a tet that does not come from
    /// refinement.
    pub roots: Vec<MaybeId<TetId>>,
    /// For each tet, the path down from its root: a one bit, then three bits per generation giving which of
    /// the eight parts it lies in.
    pub paths: Vec<u64>,
    /// For each tet, the roles of its four vertices in the tet at the end of that path, four bits each, the
    /// first in the lowest bits: 0 to 3 for a corner, 4 to 9 for the middle of an edge.
    pub pieces: Vec<u16>,
    /// For each tet, how many of the divisions on that path, from the first on, were requested.
    pub n_requested: Vec<u8>,
    /// For each triangle, which corner its first vertex is in the tet of the first mesh of which it is a
    /// facet.
    pub corners: Vec<u8>,
    /// For each vertex, its position when the mesh was new, where shapes are judged.
    pub reference: Vec<Point>,
}

impl Memory {
    /// The memory after others have changed the mesh: new tets and vertices are unknown.
    #[must_use]
    pub fn after(&self, change: &Extract) -> Self {
        let of_tets = || change.tet_to_old.iter().map(|old| old.get().map(TetId::index));
        let old_point = |(point, old): (&Point, &MaybeId<VertexId>)| {
            old.get().map_or(*point, |old| self.reference[old.index()])
        };
        Self {
            roots: of_tets().map(|old| old.map_or(MaybeId::NONE, |t| self.roots[t])).collect(),
            paths: of_tets().map(|old| old.map_or(0, |t| self.paths[t])).collect(),
            pieces: of_tets().map(|old| old.map_or(0, |t| self.pieces[t])).collect(),
            n_requested: of_tets().map(|old| old.map_or(0, |t| self.n_requested[t])).collect(),
            corners: change.triangle_to_old.iter().map(|&t| self.corners[t as usize]).collect(),
            reference: change.mesh.points.iter().zip(&change.vertex_to_old).map(old_point).collect(),
        }
    }

    /// Checks that there is an entry for each tet, triangle and point.
    fn check(&self, mesh: &TetMesh) -> Result<()> {
        let n = mesh.tets.len();
        let lengths = [self.roots.len(), self.paths.len(), self.pieces.len(), self.n_requested.len()];
        let fits = lengths.into_iter().all(|length| length == n)
            && self.corners.len() == mesh.triangles.len()
            && self.reference.len() == mesh.points.len();
        if fits { Ok(()) } else { Err(unfit("it does not have one entry for each tet, triangle and point")) }
    }
}

/// The error for a memory that belongs to another mesh.
fn unfit(why: &str) -> Error {
    Error::input(format!("the stored memory of its refinement does not fit the mesh: {why}"))
        .remedy("discard the memory: the mesh then counts as unrefined")
}

/// The generation at which a path ends.
fn generation(path: u64) -> u32 {
    (63 - path.max(1).leading_zeros()) / 3
}

/// Which of the eight parts a path takes at a generation.
fn step(path: u64, generation_of_path: u32, at: u32) -> usize {
    (path >> (3 * (generation_of_path - 1 - at)) & 7) as usize
}

/// The roles of the vertices of a tet in the tet that it is a piece of.
fn locals(piece: u16) -> [u8; 4] {
    [0, 1, 2, 3].map(|i| (piece >> (4 * i) & 15) as u8)
}
