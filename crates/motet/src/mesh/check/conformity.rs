//! Cells that do not fit together facet to facet.

use std::collections::BTreeSet;

use crate::base::{CellId, Point, VertexId, rising_list};
use crate::geometry::predicates::orient3d;
use crate::geometry::vector::in_range;
use crate::mesh::adjacency::Facets;
use crate::mesh::boundary::corners;
use crate::mesh::check::defect::{Defect, DefectKind, Example};
use crate::mesh::check::hanging;
use crate::mesh::check::points::CoincidentVertices;
use crate::mesh::{Boundary, CellKind, Mesh};

pub(super) fn defects(mesh: &Mesh, boundary: &Boundary, coincident: &CoincidentVertices) -> Vec<Defect> {
    let mut overshared = Defect::empty(DefectKind::OversharedFacet);
    let mut folded = Defect::empty(DefectKind::FoldedFacet);
    let mut twins: BTreeSet<(CellId, CellId)> = BTreeSet::new();
    let facets = Facets::of(&mesh.cells);
    facets.for_each_shared(|uses| {
        if uses.len() > 2 {
            let cells: Vec<_> = uses.iter().map(|u| u.cell).collect();
            overshared
                .add(|| Example::new(&cells, &facets.corners(uses[0]).collect::<Vec<_>>(), &mesh.points));
        }
        if let [x, y] = *uses
            && is_folded(mesh, x.cell, y.cell)
        {
            folded.add(|| {
                Example::new(&[x.cell, y.cell], &facets.corners(x).collect::<Vec<_>>(), &mesh.points)
            });
        }
        // Cells with the same vertices share every facet, so their pairs are found here.
        match uses {
            [_] => {}
            [x, y] if !may_be_twins(mesh, x.cell, y.cell) => {}
            _ => twins.extend(pairs(uses.iter().map(|u| by_vertices(mesh, u.cell)).collect())),
        }
    });
    let mut duplicate = Defect::empty(DefectKind::DuplicateCell);
    twins.extend(surface_twins(mesh));
    for (x, y) in twins {
        duplicate.add(|| Example::new(&[x, y], mesh.cells.vertices(x), &mesh.points));
    }
    vec![
        duplicate,
        overshared,
        folded,
        unmerged(mesh, boundary, coincident),
        hanging::defects(mesh, boundary),
    ]
}

/// Whether two tets that share a facet lie on the same side of it, although their volumes have the same sign.
fn is_folded(mesh: &Mesh, x: CellId, y: CellId) -> bool {
    let is_tet = |cell| mesh.cells.kind(cell) == CellKind::TETRA;
    if !is_tet(x) || !is_tet(y) {
        return false;
    }
    let [x, y] = [x, y].map(|cell| mesh.cells.vertices(cell));
    let corners = |ids: &[VertexId]| [0, 1, 2, 3].map(|i| mesh.points[ids[i].index()]);
    let sign = |[a, b, c, d]: [Point; 4]| orient3d(a, b, c, d).signum();
    let apart = |of: &[VertexId], other: &[VertexId]| of.iter().position(|v| !other.contains(v));
    let (Some(i), Some(j)) = (apart(x, y), apart(y, x)) else { return false };
    let (of_x, of_y) = (corners(x), corners(y));
    let mut across = of_x;
    across[i] = of_y[j];
    let are_numbers = of_x.iter().chain(&of_y).all(|p| in_range(*p));
    are_numbers && sign(of_x) != 0 && sign(across) == sign(of_x) && sign(of_y) == sign(of_x)
}

/// A quick test before sorting, which nearly all neighbours fail: whether two cells may have the same
/// vertices.
fn may_be_twins(mesh: &Mesh, x: CellId, y: CellId) -> bool {
    let [x, y] = [x, y].map(|cell| mesh.cells.vertices(cell));
    x.len() == y.len() && x.iter().take(8).all(|v| y.contains(v))
}

/// A cell, keyed by its sorted vertices.
fn by_vertices(mesh: &Mesh, cell: CellId) -> (Vec<VertexId>, CellId) {
    (rising_list(mesh.cells.vertices(cell)), cell)
}

/// Pairs of surface cells with the same vertices.
fn surface_twins(mesh: &Mesh) -> Vec<(CellId, CellId)> {
    let surface = mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(2));
    pairs(surface.map(|(cell, ..)| by_vertices(mesh, cell)).collect())
}

/// Pairs of equal key that are consecutive after sorting.
fn pairs<T: Ord + Copy>(mut keyed: Vec<(Vec<VertexId>, T)>) -> Vec<(T, T)> {
    keyed.sort_unstable();
    keyed.dedup();
    keyed.windows(2).filter(|w| w[0].0 == w[1].0).map(|w| (w[0].1, w[1].1)).collect()
}

/// Boundary facets whose corners are at the same places as those of another: a crack.
fn unmerged(mesh: &Mesh, boundary: &Boundary, coincident: &CoincidentVertices) -> Defect {
    let mut defect = Defect::empty(DefectKind::UnmergedFacet);
    let ring = |i: usize| corners(boundary.kinds[i], boundary.facets.list(i));
    let on_a_double = |i: &usize| ring(*i).iter().any(|&v| coincident.is_duplicated(v));
    let candidates = (0..boundary.len()).filter(on_a_double);
    let places = |i: usize| ring(i).iter().map(|&v| coincident.first(v)).collect::<Vec<_>>();
    let keyed = candidates.map(|i| (rising_list(&places(i)), i)).collect();
    for (i, j) in pairs(keyed) {
        defect.add(|| Example::new(&[boundary.cells[i], boundary.cells[j]], ring(i), &mesh.points));
    }
    defect
}
