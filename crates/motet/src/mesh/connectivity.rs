//! What follows from the cells of a mesh alone, carried across changes: only what lies beside changed cells
//! is found anew.

use std::ops::Range;
use std::sync::Arc;

use crate::base::{CellId, MaybeId, Threads};
use crate::mesh::adjacency::{FacetUse, Facets};
use crate::mesh::boundary::facets_used_once;
use crate::mesh::cutout::cells_such_that;
use crate::mesh::history::Origins;
use crate::mesh::{Boundary, Cells, Labels, Mesh, OrientedTets};

/// Where more than this fraction of the cells has changed, everything is found anew.
const MOST_CHANGED: f64 = 0.25;

/// Volume cells with fewer vertices in common share no facet.
const FEWEST_SHARED: usize = 3;

/// Cells that a thread looks at in a run.
const CHUNK: usize = 1 << 14;

/// The boundary of a mesh, and its linear tets.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Connectivity {
    pub(crate) boundary: Boundary,
    /// The linear tets.
    pub(crate) tets: Arc<OrientedTets>,
    /// The facets of the boundary, in its order.
    used_once: Vec<FacetUse>,
    /// The regions between which facets are walls.
    regions: Option<Labels>,
}

impl Connectivity {
    pub(crate) fn of(mesh: &Mesh, threads: &Threads) -> Self {
        let used_once = facets_used_once(&mesh.cells);
        Self {
            boundary: Boundary::of_facets(&mesh.cells, &used_once),
            tets: Arc::new(OrientedTets::of_linear(mesh, threads)),
            used_once,
            regions: mesh.regions(),
        }
    }

    /// The connectivity of a mesh with the same cells as before, and its vertices elsewhere.
    pub(crate) fn moved(self: &Arc<Self>, mesh: &Mesh, threads: &Threads) -> Arc<Self> {
        let is_same = self.tets.turned.is_empty()
            && mesh.regions() == self.regions
            && self.tets.is_positive(&mesh.points, threads);
        if is_same { self.clone() } else { Arc::new(Self::of(mesh, threads)) }
    }

    /// The connectivity of `mesh`, into which `before` has changed: the same as [`Self::of`] finds.
    pub(crate) fn after(
        &self,
        before: &Mesh,
        mesh: &Mesh,
        cells: &Origins<CellId>,
        threads: &Threads,
    ) -> Self {
        let changed = self.changed(before, mesh, cells, threads);
        debug_assert!(changed.as_ref().is_none_or(|changed| *changed == Self::of(mesh, threads)));
        changed.unwrap_or_else(|| Self::of(mesh, threads))
    }

    fn changed(
        &self,
        before: &Mesh,
        mesh: &Mesh,
        cells: &Origins<CellId>,
        threads: &Threads,
    ) -> Option<Self> {
        let regions = mesh.regions();
        let is_same_array = match (&regions, &self.regions) {
            (Some(new), Some(old)) => new.array == old.array,
            (new, old) => new.is_none() && old.is_none(),
        };
        if !is_same_array || before.regions() != self.regions {
            return None;
        }
        let around = AroundChange::of(before, mesh, cells, threads)?;
        let tets = self.tets.after(mesh, &around, regions.as_ref(), threads)?;
        let used_once = self.used_once_after(mesh, &around);
        let boundary = Boundary::of_facets(&mesh.cells, &used_once);
        Some(Self { boundary, tets: Arc::new(tets), used_once, regions })
    }

    fn used_once_after(&self, mesh: &Mesh, around: &AroundChange) -> Vec<FacetUse> {
        let facets = Facets::of(&mesh.cells);
        let is_around = |facet: &FacetUse| facets.corners(*facet).all(|v| around.is_marked[v.index()]);
        let mut near = Cells::new();
        let vertices = |cell: CellId| mesh.cells.vertices(cell).iter().copied();
        around.near.iter().for_each(|&cell| near.push(mesh.cells.kind(cell), vertices(cell)));
        let found = facets_used_once(&near);
        let found = found.iter().map(|facet| FacetUse { cell: around.near[facet.cell.index()], ..*facet });
        let kept = self.used_once.iter().filter_map(|facet| {
            let cell = around.old_to_new[facet.cell.index()].get()?;
            Some(FacetUse { cell, ..*facet })
        });
        let mut all: Vec<FacetUse> = kept.filter(|facet| !is_around(facet)).collect();
        all.extend(found.filter(is_around));
        all.sort_unstable();
        all
    }
}

/// The cells of a mesh around those that were replaced.
pub(crate) struct AroundChange {
    /// The new cell of each old one that is unchanged.
    pub(super) old_to_new: Vec<MaybeId<CellId>>,
    /// Whether each vertex is one of a new cell, or was one of a removed cell. Facets with another vertex
    /// have the same cells as before.
    pub(super) is_marked: Vec<bool>,
    /// All volume cells that share a facet with marked vertices only, in rising order.
    pub(super) near: Vec<CellId>,
}

impl AroundChange {
    /// `None` if too much has changed, if unchanged cells are in another order than before, and if there are
    /// polyhedra.
    fn of(before: &Mesh, mesh: &Mesh, origins: &Origins<CellId>, threads: &Threads) -> Option<Self> {
        let (old, new) = (&before.cells, &mesh.cells);
        let n_new = origins.kept().iter().filter(|cell| cell.is_none()).count();
        let has_polyhedra = !new.polyhedron_faces().is_empty() || !old.polyhedron_faces().is_empty();
        if has_polyhedra || n_new as f64 > MOST_CHANGED * new.len() as f64 {
            return None;
        }
        let mut old_to_new: Vec<MaybeId<CellId>> = vec![MaybeId::NONE; old.len()];
        let mut last = None;
        for (i, kept) in origins.kept().iter().enumerate() {
            if let Some(kept) = kept.get() {
                if last >= Some(kept) {
                    return None;
                }
                last = Some(kept);
                old_to_new[kept.index()] = CellId::new(i).into();
            }
        }
        let mut was_marked = vec![false; before.points.len()];
        let removed = (0..old.len()).map(CellId::new).filter(|cell| old_to_new[cell.index()].is_none());
        removed.flat_map(|cell| old.vertices(cell)).for_each(|v| was_marked[v.index()] = true);
        let marked_vertices = |run: Range<usize>| {
            let mut marked = Vec::new();
            for i in run {
                let its = new.vertices(CellId::new(i));
                match origins.kept()[i].get() {
                    None => marked.extend_from_slice(its),
                    Some(kept) => {
                        let both = its.iter().zip(old.vertices(kept));
                        marked.extend(both.filter(|(_, old)| was_marked[old.index()]).map(|(v, _)| *v));
                    }
                }
            }
            marked
        };
        let marked = threads.in_runs(new.len(), CHUNK, |_: &mut (), run| marked_vertices(run));
        let mut is_marked = vec![false; mesh.points.len()];
        marked.into_iter().for_each(|v| is_marked[v.index()] = true);
        let is_near = |cell: CellId| {
            let n_marked = new.vertices(cell).iter().filter(|v| is_marked[v.index()]).count();
            n_marked >= FEWEST_SHARED && new.kind(cell).dim() == Some(3)
        };
        let near = cells_such_that(new.len(), is_near, threads);
        Some(Self { old_to_new, is_marked, near })
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::base::VertexId;
    use crate::geometry::tet;
    use crate::mesh::history::Rows;
    use crate::mesh::shapes::{box_grid, mixed};
    use crate::mesh::{CellKind, Field};

    /// A mesh in which a cell array numbers regions, and some facets of tets have triangles.
    fn labelled(mut mesh: Mesh, seed: usize) -> Mesh {
        let facets: Vec<_> =
            mesh.cells.tets().filter(|(cell, _)| (cell.index() + seed).is_multiple_of(7)).collect();
        facets.into_iter().for_each(|(_, [a, b, c, _])| mesh.cells.push(CellKind::TRIANGLE, [a, b, c]));
        let region = |cell: usize| 1 + ((cell * 31 + seed) / 97 % 3) as i32;
        mesh.set_cell_field(Field::scalars("region", (0..mesh.cells.len()).map(region).collect::<Vec<_>>()));
        mesh
    }

    /// The mesh with some cells removed, some tets divided into four, and its vertices numbered backwards.
    fn changed(mesh: &Mesh, removed: &[usize], divided: &[usize]) -> (Mesh, Origins<CellId>) {
        let n_points = mesh.points.len();
        let number = |v: VertexId| VertexId::new(n_points - 1 - v.index());
        let mut points: Vec<_> = mesh.points.iter().rev().copied().collect();
        let (mut cells, mut kept, mut rows) = (Cells::new(), Vec::new(), Rows::new());
        let mut new = Vec::new();
        for (cell, kind, vertices) in mesh.cells.iter() {
            let vertices: Vec<VertexId> = vertices.iter().map(|v| number(*v)).collect();
            if kind == CellKind::TETRA && divided.contains(&cell.index()) {
                new.push((cell, [vertices[0], vertices[1], vertices[2], vertices[3]]));
            } else if !removed.contains(&cell.index()) {
                cells.push(kind, vertices);
                kept.push(cell.into());
            }
        }
        for (old, corners) in new {
            let middle = VertexId::new(points.len());
            points.push(tet::centroid(corners.map(|v| points[v.index()])));
            for i in 0..4 {
                let mut part = corners;
                part[i] = middle;
                rows.push(CellId::new(cells.len()), &[(old, 1.0)], old);
                cells.push(CellKind::TETRA, part);
                kept.push(MaybeId::NONE);
            }
        }
        let origins = Origins::new(mesh.cells.len(), kept, rows).unwrap();
        let labels = mesh.cell_field("region").unwrap();
        let mut new = Mesh::new(points, cells);
        new.set_cell_field(labels.pick(origins.main().map(|cell| cell.index())));
        (new, origins)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn what_is_carried_across_a_change_is_what_is_found_anew(
            is_mixed in any::<bool>(),
            seed in 0..50usize,
            removed in prop::collection::vec(0..400usize, 0..12),
            divided in prop::collection::vec(0..400usize, 0..8),
        ) {
            let grid = if is_mixed { mixed(4) } else { box_grid([4; 3], [[0.0; 3], [1.0; 3]]) };
            let mesh = labelled(grid, seed);
            let (new, origins) = changed(&mesh, &removed, &divided);
            let before = Connectivity::of(&mesh, &Threads::single());
            for threads in [Threads::single(), Threads::exactly(3).unwrap()] {
                let carried = before.changed(&mesh, &new, &origins, &threads);
                prop_assert!(carried.is_some() || 4 * divided.len() * 4 > new.cells.len());
                if let Some(carried) = carried {
                    let anew = Connectivity::of(&new, &Threads::single());
                    prop_assert_eq!(&carried.used_once, &anew.used_once);
                    prop_assert!(carried == anew);
                }
            }
        }
    }

    #[test]
    fn regions_that_the_caller_has_changed_are_seen() {
        let mesh = labelled(box_grid([4; 3], [[0.0; 3], [1.0; 3]]), 0);
        let before = Connectivity::of(&mesh, &Threads::single());
        let mut relabelled = mesh.clone();
        relabelled.set_cell_field(Field::scalars("region", vec![1; mesh.cells.len()]));
        let threads = Threads::single();
        let anew = Connectivity::of(&relabelled, &threads);
        assert!(before != anew && *Arc::new(before.clone()).moved(&relabelled, &threads) == anew);
        let (new, origins) = changed(&relabelled, &[3], &[]);
        assert!(before.after(&relabelled, &new, &origins, &threads) == Connectivity::of(&new, &threads));
    }
}
