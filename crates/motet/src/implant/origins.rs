//! Traces where everything in the result came from.

use std::collections::HashSet;

use super::layout::{Layout, Numbering, Pieces};
use super::owner::{Owner, Patch};
use crate::base::{CellId, Point, Result, Threads, VertexId, sorted_ids};
use crate::geometry::tet::{at, centroid, closest};
use crate::geometry::vector::distance;
use crate::mesh::Mesh;
use crate::mesh::history::{History, Origins};
use crate::spatial::trace::{ChangedVertex, Labelled, LocalChange, trace};
use crate::spatial::{BoxTree, bounding_box};

/// Marks triangles that come from tets.
const OF_TETS: i32 = i32::MIN;

/// Traces everything new: it inherits from the host's tets where it lies (in devices, whatever their region),
/// triangles of devices from the removed tets beside them.
pub(super) fn history(
    pieces: &Pieces,
    layout: &Layout,
    mesh: &Mesh,
    numbering: &Numbering,
    threads: &Threads,
) -> Result<History> {
    let Pieces { host, part, gap, draft, .. } = *pieces;
    let removed_ids: Vec<usize> = (0..draft.is_removed.len()).filter(|&t| draft.is_removed[t]).collect();
    let removed: Vec<Labelled<4>> = removed_ids
        .iter()
        .map(|&t| Labelled {
            cell: part.tet_to_cell[t],
            vertices: part.mesh.tets[t],
            label: part.mesh.regions[t],
        })
        .collect();
    let cell = |i: usize| CellId::new(layout.n_host_cells + i);
    let n_triangles = draft.triangles.len();
    let lookup = RegionLookup::new(host, &removed);
    let of_new = draft.owners.iter().map(|owner| match owner {
        Owner::Host(region) => Some(*region),
        _ => None,
    });
    let mut new_tets = Vec::with_capacity(draft.tets.len() + gap.own_tets.len());
    for (i, region) in of_new.chain(gap.own_tets.iter().map(|_| None)).enumerate() {
        let cell = cell(n_triangles + i);
        let &[a, b, c, d] = mesh.cells.vertices(cell) else { continue };
        let vertices = [a, b, c, d];
        let place = || centroid(vertices.map(|v| mesh.points[v.index()]));
        new_tets.push(Labelled {
            cell,
            vertices,
            label: region.unwrap_or_else(|| lookup.region_at(place())),
        });
    }
    // Triangles of devices come from removed tets: a facet of each stands for it. Those of the host come from
    // the triangles that they were a part of.
    let facet = |tet: &Labelled<4>| {
        let [a, b, c, _] = tet.vertices;
        Labelled { cell: tet.cell, vertices: [a, b, c], label: OF_TETS }
    };
    let mut facets: Vec<Labelled<3>> = removed.iter().map(facet).collect();
    let dropped: HashSet<[VertexId; 3]> = gap.dropped.iter().map(|face| sorted_ids(face.vertices)).collect();
    for ((&cell, &vertices), &label) in
        part.triangle_to_cell.iter().zip(&part.mesh.triangles).zip(&part.mesh.patches)
    {
        if dropped.contains(&sorted_ids(vertices)) {
            facets.push(Labelled { cell, vertices, label });
        }
    }
    let triangles = draft.triangles.iter().enumerate().filter_map(|(i, (_, patch))| {
        let label = if let Patch::Host(patch) = patch { *patch } else { OF_TETS };
        match *mesh.cells.vertices(cell(i)) {
            [a, b, c] => Some(Labelled { cell: cell(i), vertices: [a, b, c], label }),
            _ => None,
        }
    });
    let triangles: Vec<Labelled<3>> = triangles.collect();
    let changed: Vec<ChangedVertex> = (0..numbering.kept.len())
        .filter(|&v| numbering.kept[v].is_none())
        .map(|v| {
            let was = Some(numbering.to_draft[v]).filter(|was| was.index() < host.points.len());
            ChangedVertex { vertex: VertexId::new(v), was }
        })
        .collect();
    let change = LocalChange {
        old_points: &host.points,
        new_points: &mesh.points,
        removed_tets: &removed,
        new_tets: &new_tets,
        removed_triangles: &facets,
        new_triangles: &triangles,
        changed_vertices: &changed,
    };
    let traced = trace(&change, threads)?;
    Ok(History {
        vertices: Origins::new(host.points.len(), numbering.kept.clone(), traced.vertices)?,
        cells: Origins::new(host.cells.len(), layout.to_old.clone(), traced.cells)?,
        ledger: traced.ledger,
    })
}

/// The regions of removed tets, by place.
struct RegionLookup<'a> {
    host: &'a Mesh,
    removed: &'a [Labelled<4>],
    /// `None` if there is only one region.
    tree: Option<BoxTree>,
}

impl<'a> RegionLookup<'a> {
    fn new(host: &'a Mesh, removed: &'a [Labelled<4>]) -> Self {
        let is_one = removed.windows(2).all(|pair| pair[0].label == pair[1].label);
        let bounds = |tet: &Labelled<4>| bounding_box(tet.vertices.map(|v| host.points[v.index()]));
        let tree = (!is_one).then(|| BoxTree::new(&removed.iter().map(bounds).collect::<Vec<_>>()));
        Self { host, removed, tree }
    }

    fn region_at(&self, place: Point) -> i32 {
        let first = self.removed.first().map_or(0, |tet| tet.label);
        let Some(tree) = &self.tree else { return first };
        let measure = |i: u32| {
            let corners = self.removed[i as usize].vertices.map(|v| self.host.points[v.index()]);
            let weights = closest(corners, place);
            let off = distance(at(corners, weights), place);
            Some((off * off, ()))
        };
        tree.nearest(place, measure).map_or(first, |(_, i, ())| self.removed[i as usize].label)
    }
}
