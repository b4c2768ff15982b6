//! The boundary of the volume cells: the facets that only one of them uses.

use crate::base::{CellId, Csr, Point, VertexId};
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::facets::facet_shapes;
use crate::mesh::unshared::unshared_facets;
use crate::mesh::{CellKind, Cells, cell_volume};

/// The facets that exactly one volume cell uses, whatever its kind.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Boundary {
    /// The vertices of each facet: corners first, as a ring that runs counter-clockwise seen from outside if
    /// its cell has positive volume (otherwise see [`Self::turn_outward`]), then middle nodes in VTK's order.
    pub facets: Csr<VertexId>,
    /// The kind of surface cell that each facet is.
    pub kinds: Vec<CellKind>,
    /// The volume cell of each facet, in rising order.
    pub cells: Vec<CellId>,
    /// Every vertex of the facets once, in rising order.
    pub vertices: Vec<VertexId>,
    /// Number of volume cells of a kind whose facets are not known (Lagrange cells); their boundary is
    /// missing here.
    pub n_unknown: usize,
}

impl Boundary {
    /// The boundary of the volume cells among `cells`; other cells are ignored.
    pub fn of(cells: &Cells) -> Self {
        Self::of_facets(cells, &facets_used_once(cells))
    }

    /// The boundary of the volume cells among `cells`, given their facets that are used once, in rising
    /// order.
    pub(super) fn of_facets(cells: &Cells, used_once: &[FacetUse]) -> Self {
        let facets = Facets::of(cells);
        let mut boundary = Self { n_unknown: count_unknown(cells), ..Self::default() };
        for &facet in used_once {
            let (kind, vertices) = facets.vertices(facet);
            boundary.facets.push(vertices);
            boundary.kinds.push(kind);
            boundary.cells.push(facet.cell);
        }
        boundary.vertices = unique(boundary.facets.items());
        boundary
    }

    /// Number of facets.
    pub fn len(&self) -> usize {
        self.kinds.len()
    }

    /// Whether there is no facet.
    pub fn is_empty(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Reverses the facets of cells with negative volume, so that all facets face outward: files do not
    /// always number their cells the way VTK does.
    pub fn turn_outward(&mut self, cells: &Cells, points: &[Point]) {
        let facets = Facets::of(cells);
        for i in 0..self.len() {
            if cell_volume(&facets, self.cells[i], points) < 0.0 {
                let n_corners = corners(self.kinds[i], self.facets.list(i)).len();
                reverse_facet(self.facets.list_mut(i), n_corners);
            }
        }
    }
}

/// The facets of the volume cells among `cells` that a single one uses, in rising order.
pub(super) fn facets_used_once(cells: &Cells) -> Vec<FacetUse> {
    if cells.counts().iter().all(|(kind, _)| *kind == CellKind::TETRA || kind.dim() != Some(3)) {
        return unshared_facets(cells);
    }
    let mut used_once: Vec<FacetUse> = Vec::new();
    Facets::of(cells).for_each_shared(|uses| {
        if let [single] = uses {
            used_once.push(*single);
        }
    });
    used_once.sort_unstable();
    used_once
}

/// The corners among the vertices of a surface cell or facet. A malformed Lagrange cell may have too few.
pub(crate) fn corners(kind: CellKind, vertices: &[VertexId]) -> &[VertexId] {
    let n = match kind {
        CellKind::QUADRATIC_TRIANGLE | CellKind::BIQUADRATIC_TRIANGLE | CellKind::LAGRANGE_TRIANGLE => 3,
        CellKind::QUADRATIC_QUAD
        | CellKind::BIQUADRATIC_QUAD
        | CellKind::QUADRATIC_LINEAR_QUAD
        | CellKind::LAGRANGE_QUADRILATERAL => 4,
        CellKind::QUADRATIC_POLYGON => vertices.len() / 2,
        _ => vertices.len(),
    };
    &vertices[..n.min(vertices.len())]
}

/// Reverses a facet: the ring of its corners, and its middle nodes along with their edges. The first corner
/// stays in place, except in quads with two middle nodes.
fn reverse_facet(facet: &mut [VertexId], n_corners: usize) {
    let (corners, middles) = facet.split_at_mut(n_corners);
    corners[1..].reverse();
    match middles.len() {
        // Edge i runs from corner i to corner i + 1, so the whole list is reversed.
        n if n >= n_corners => middles[..n_corners].reverse(),
        // Quads with middles on edges 0 and 2 only: their edges become 3 and 1,
        // so the ring starts one corner later.
        2 => corners.rotate_right(1),
        _ => {}
    }
}

fn count_unknown(cells: &Cells) -> usize {
    let unknown = |kind: CellKind| {
        kind.dim() == Some(3) && kind != CellKind::POLYHEDRON && facet_shapes(kind).is_none()
    };
    cells.counts().iter().filter(|(kind, _)| unknown(*kind)).map(|(_, n)| n).sum()
}

/// Every id once, in rising order.
fn unique(ids: &[VertexId]) -> Vec<VertexId> {
    let n = ids.iter().map(|v| v.index() + 1).max().unwrap_or(0);
    let mut seen = vec![false; n];
    ids.iter().for_each(|v| seen[v.index()] = true);
    (0..n).filter(|&v| seen[v]).map(VertexId::new).collect()
}
