//! Traces where everything new in a mesh came from, by geometry, in time proportional to the size of the
//! change.
//!
//! | new | comes from |
//! |---|---|
//! | a vertex, or a moved one | the vertices of the removed tet that holds its place, with its weights there |
//! | a tet | the removed tets of its region that it overlaps, with their parts of its volume |
//! | a triangle | the removed triangle of its patch that is nearest to its centre |
//!
//! The common volumes are those of the supermesh, the common refinement of old and new tets (Farrell and
//! Maddison 2011, *Conservative interpolation between volume meshes by local Galerkin projection*), of which
//! only the volumes are needed. [`between`] builds the whole history between two meshes, [`trace`] only the
//! rows of what changed.

mod between;
mod overlaps;
mod quadratic;
mod triangles;
mod vertices;

pub use between::between;
pub(crate) use quadratic::quadratic_rows;

use crate::base::{CellId, Point, Result, Threads, VertexId};
use crate::mesh::history::{Ledger, Rows};

/// A tet with its region, or a triangle with its patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Labelled<const N: usize> {
    /// The id of the cell among all cells of its mesh.
    pub cell: CellId,
    /// The vertices of the cell, in either orientation.
    pub vertices: [VertexId; N],
    /// The region or patch of the cell; 0 if it has none.
    pub label: i32,
}

/// A vertex of the new mesh that has no equal in the old one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChangedVertex {
    /// The id of the vertex in the new mesh.
    pub vertex: VertexId,
    /// The id in the old mesh of a vertex that was moved: whole numbers and texts stay with it.
    pub was: Option<VertexId>,
}

/// A local change of a mesh: what was removed, and what replaced it. Lists are in any order, without repeats.
#[derive(Clone, Copy, Debug, Default)]
pub struct LocalChange<'a> {
    /// All points of the old mesh.
    pub old_points: &'a [Point],
    /// All points of the new mesh.
    pub new_points: &'a [Point],
    /// Tets that were removed, or have a vertex that was moved; ids of the old mesh. They may be inverted or
    /// flat.
    pub removed_tets: &'a [Labelled<4>],
    /// Tets that replace them; ids of the new mesh.
    pub new_tets: &'a [Labelled<4>],
    /// Triangles that were removed; ids of the old mesh.
    pub removed_triangles: &'a [Labelled<3>],
    /// Triangles that replace them; ids of the new mesh.
    pub new_triangles: &'a [Labelled<3>],
    /// New and moved vertices.
    pub changed_vertices: &'a [ChangedVertex],
}

/// The rows of what changed, for [`Origins::new`](crate::mesh::history::Origins::new), and how well volumes
/// match.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Traced {
    /// A row for each changed vertex.
    pub vertices: Rows<VertexId>,
    /// A row for each new tet and triangle.
    pub cells: Rows<CellId>,
    /// Volumes before and after, by region, and how many vertices lay outside of all removed tets, and how
    /// far.
    pub ledger: Ledger,
}

/// Traces where everything new came from. The result does not depend on the number of threads.
///
/// A vertex outside of all removed tets takes the values at the nearest place in them. A tet that overlaps no
/// removed tet of its region takes the values of the nearest one. The ledger records both. Volumes of
/// inverted tets count as positive.
///
/// # Errors
/// When something new has no source: no tet of its region, no triangle of its patch, or no tet at all was
/// removed; and when a new vertex has coordinates that are NaN.
///
/// Panics when a vertex id is beyond the points.
pub fn trace(change: &LocalChange<'_>, threads: &Threads) -> Result<Traced> {
    let removed = overlaps::Removed::new(change.old_points, change.removed_tets);
    let (tet_rows, regions) = overlaps::trace(change, &removed, threads)?;
    let vertices = vertices::trace(change, &removed, threads)?;
    let mut cell_rows = tet_rows;
    cell_rows.extend(triangles::trace(change)?);
    cell_rows.sort_by_key(|row| row.0);
    let mut cells = Rows::new();
    for (cell, parts, main) in cell_rows {
        cells.push(cell, &parts, main);
    }
    let ledger =
        Ledger { regions, n_outside: vertices.n_outside, farthest_outside: vertices.farthest_outside };
    Ok(Traced { vertices: vertices.rows, cells, ledger })
}

/// A new cell, the old cells it comes from with their shares (whose sum is arbitrary), and the main one.
type CellRow = (CellId, Vec<(CellId, f64)>, CellId);

/// The least number of items that a thread takes at a time: a tet has some dozens of overlaps to compute.
const CHUNK: usize = 64;

/// Applies `of` to each item; results are in the order of the items.
fn map<T: Sync, U: Send>(items: &[T], threads: &Threads, of: impl Fn(&T) -> U + Sync + Send) -> Vec<U> {
    threads.map_parts(items.len(), CHUNK, |i| of(&items[i]))
}
