//! The cells and vertices of the result, before they are one mesh.

use std::collections::HashSet;

use super::devices::Devices;
use super::fill::Gap;
use super::zone::Draft;
use crate::base::{CellId, Id, MaybeId, VertexId, sorted_ids};
use crate::mesh::{CellKind, Cells, Mesh, TetPart};

/// Everything that is to be joined.
#[derive(Clone, Copy)]
pub(super) struct Pieces<'a> {
    pub(super) host: &'a Mesh,
    /// The tets and triangles of the host.
    pub(super) part: &'a TetPart,
    pub(super) devices: &'a Devices,
    pub(super) gap: &'a Gap,
    pub(super) draft: &'a Draft,
}

/// The cells of the result, and the old cell of each.
pub(super) struct Layout {
    pub(super) cells: Cells,
    pub(super) to_old: Vec<MaybeId<CellId>>,
    /// For each tet of the host, its cell if it stays.
    pub(super) host_to_cell: Vec<CellId>,
    /// How many cells of the host stay. Behind them come triangles of devices, then new tets, then those that
    /// devices kept.
    pub(super) n_host_cells: usize,
}

impl Layout {
    /// All cells, over the vertices of the draft.
    pub(super) fn new(pieces: &Pieces) -> Self {
        let Pieces { host, part, gap, draft, .. } = *pieces;
        let mut is_removed = vec![false; host.cells.len()];
        for (&cell, &removed) in part.tet_to_cell.iter().zip(&draft.is_removed) {
            is_removed[cell.index()] = removed;
        }
        let dropped: HashSet<[VertexId; 3]> =
            gap.dropped.iter().map(|face| sorted_ids(face.vertices)).collect();
        for (&cell, triangle) in part.triangle_to_cell.iter().zip(&part.mesh.triangles) {
            is_removed[cell.index()] = dropped.contains(&sorted_ids(*triangle));
        }
        let mut layout =
            Self { cells: Cells::new(), to_old: Vec::new(), host_to_cell: Vec::new(), n_host_cells: 0 };
        let mut faces = host.cells.polyhedron_faces().iter();
        for (cell, kind, vertices) in host.cells.iter() {
            let of_polyhedron =
                (kind == CellKind::POLYHEDRON).then(|| faces.next().cloned().unwrap_or_default());
            if kind == CellKind::TETRA {
                layout.host_to_cell.push(CellId::new(layout.cells.len()));
            }
            if is_removed[cell.index()] {
                continue;
            }
            match of_polyhedron {
                Some(faces) => layout.cells.push_polyhedron(vertices.iter().copied(), faces),
                None => layout.cells.push(kind, vertices.iter().copied()),
            }
            layout.to_old.push(cell.into());
        }
        layout.n_host_cells = layout.cells.len();
        draft.triangles.iter().for_each(|(t, _)| layout.cells.push(CellKind::TRIANGLE, *t));
        draft.tets.iter().for_each(|tet| layout.cells.push(CellKind::TETRA, *tet));
        gap.own_tets.iter().for_each(|tet| layout.cells.push(CellKind::TETRA, tet.vertices));
        layout.to_old.resize(layout.cells.len(), MaybeId::NONE);
        layout
    }
}

/// The numbering of the vertices of the result.
pub(super) struct Numbering {
    /// For each vertex of the result, the one of the host that it is to the bit, if any.
    pub(super) kept: Vec<MaybeId<VertexId>>,
    /// For each vertex of the result, the one of the draft that it is.
    pub(super) to_draft: Vec<VertexId>,
    /// For each vertex of the draft, the one of the result that it is.
    pub(super) to_new: Vec<VertexId>,
}

impl Numbering {
    /// Leaves out vertices that nothing uses, unless nothing in the host used them either.
    pub(super) fn new(host: &Mesh, draft: &Draft, cells: &Cells) -> Self {
        let mut is_wanted = vec![true; draft.points.len()];
        is_wanted[host.points.len()..].fill(false);
        used(&host.cells).for_each(|v| is_wanted[v.index()] = false);
        used(cells).for_each(|v| is_wanted[v.index()] = true);
        let (mut kept, mut to_draft) = (Vec::new(), Vec::new());
        let mut to_new = vec![Id::NONE; draft.points.len()];
        for v in (0..draft.points.len()).filter(|&v| is_wanted[v]) {
            to_new[v] = VertexId::new(to_draft.len());
            to_draft.push(VertexId::new(v));
            let is_as_before = draft.is_moved.get(v).is_some_and(|is_moved| !is_moved);
            kept.push(is_as_before.then(|| VertexId::new(v)).into());
        }
        Self { kept, to_draft, to_new }
    }
}

/// Every vertex that cells use, faces of polyhedra included.
fn used(cells: &Cells) -> impl Iterator<Item = VertexId> + '_ {
    let of_faces = cells.polyhedron_faces().iter().flat_map(|faces| faces.items());
    cells.connectivity().items().iter().chain(of_faces).copied()
}
