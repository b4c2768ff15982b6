//! The extraction of plain arrays, and where each of their rows came from.

use crate::base::{MaybeId, Point, TetId, VertexId};
use crate::kernel::complex::Complex;
use crate::kernel::link::NO_TRIANGLE;
use crate::kernel::provenance::Origin;
use crate::mesh::TetMesh;

/// A mesh after changes, compared with the one before.
///
/// What stayed keeps its order and its bits: untouched tets come first, then new ones. New vertices take the
/// places of removed ones, the rest follow at the end.
#[derive(Clone, Debug, Default)]
pub struct Extract {
    /// The new mesh.
    pub mesh: TetMesh,
    /// For each tet its id in the old mesh; none if it is new.
    pub tet_to_old: Vec<MaybeId<TetId>>,
    /// For each vertex its id in the old mesh; none if it is new.
    pub vertex_to_old: Vec<MaybeId<VertexId>>,
    /// For each triangle the old one that it was, or is part of.
    pub triangle_to_old: Vec<u32>,
    /// For each line the old one that it was, or is part of.
    pub line_to_old: Vec<u32>,
    /// Ids in the complex of the new tets, in their order at the end of the mesh.
    pub new_tets: Vec<TetId>,
    /// Tets of the old mesh that were removed, in rising order.
    pub removed_tets: Vec<TetId>,
    /// Vertices of the new mesh that were inserted or moved, in rising order.
    pub changed_vertices: Vec<VertexId>,
}

impl Extract {
    /// The id in the mesh of a tet of the complex.
    pub fn tet(&self, tet: TetId) -> TetId {
        let n_kept = self.tet_to_old.len() - self.new_tets.len();
        let place = self.new_tets.binary_search(&tet).map(|i| n_kept + i);
        TetId::new(
            place.or_else(|_| self.tet_to_old[..n_kept].binary_search(&tet.into())).unwrap_or_default(),
        )
    }

    /// The new id of each vertex of the old mesh; none for removed ones.
    pub fn old_to_vertex(&self, n_old: usize) -> Vec<MaybeId<VertexId>> {
        let mut old_to_vertex = vec![MaybeId::NONE; n_old];
        for (new, old) in self.vertex_to_old.iter().enumerate() {
            if let Some(old) = old.get() {
                old_to_vertex[old.index()] = VertexId::new(new).into();
            }
        }
        old_to_vertex
    }
}

impl Complex {
    /// The mesh as it is now; `first` is the mesh that the complex was made of.
    pub fn extract(&self, first: &TetMesh) -> Extract {
        let mut extract = Extract::default();
        let old_to_new = self.extract_vertices(first.points.len(), &mut extract);
        let new_id = |v: VertexId| if old_to_new.is_empty() { v } else { old_to_new[v.index()] };
        let n_first = first.tets.len();
        let is_kept = |t: &TetId| self.is_original(*t);
        let first_tets = || (0..n_first).map(TetId::new);
        let tets = &mut extract.mesh.tets;
        tets.reserve_exact(self.n_tets());
        for t in first_tets().filter(is_kept) {
            tets.push(first.tets[t.index()].map(new_id));
            extract.mesh.regions.push(self.region(t));
            extract.tet_to_old.push(t.into());
        }
        for t in self.tets().filter(|&t| !self.is_original(t)) {
            let mut tet = self.vertices(t).map(new_id);
            if self.provenance.mostly_reversed {
                tet.swap(2, 3);
            }
            tets.push(tet);
            extract.mesh.regions.push(self.region(t));
            extract.tet_to_old.push(MaybeId::NONE);
            extract.new_tets.push(t);
        }
        extract.removed_tets = first_tets().filter(|t| !is_kept(t)).collect();
        self.extract_triangles(first, new_id, &mut extract);
        self.extract_lines(first, new_id, &mut extract);
        extract.mesh.fixed_vertices = first.fixed_vertices.iter().map(|&v| new_id(v)).collect();
        extract.mesh.cut_vertices = first.cut_vertices.iter().map(|&v| new_id(v)).collect();
        extract.mesh.fixed_edges = first.fixed_edges.iter().map(|edge| edge.map(new_id)).collect();
        extract
    }

    /// Extracts the points without removed ones; returns the new id of each vertex, or an empty list if none
    /// was removed.
    fn extract_vertices(&self, n_first: usize, extract: &mut Extract) -> Vec<VertexId> {
        let (all, free) = (self.vertices.points(), self.vertices.free_slots());
        let mut is_removed = vec![false; if free.is_empty() { 0 } else { all.len() }];
        free.iter().for_each(|v| is_removed[v.index()] = true);
        let mut old_to_new = Vec::new();
        let mut points: Vec<Point> = Vec::with_capacity(all.len() - free.len());
        for v in self.vertices.slots() {
            let new_id = VertexId::new(points.len());
            if !is_removed.is_empty() {
                old_to_new.push(new_id);
                if is_removed[v.index()] {
                    continue;
                }
            }
            points.push(self.point(v));
            // A vertex that moved is still the same vertex; one in the slot of a removed vertex is not.
            let origin = self.provenance.origin(v);
            let is_of_first = v.index() < n_first && origin != Origin::Inserted;
            extract.vertex_to_old.push(is_of_first.then_some(v).into());
            if origin != Origin::First {
                extract.changed_vertices.push(new_id);
            }
        }
        extract.mesh.points = points;
        old_to_new
    }

    /// Extracts unchanged lines in their order, then the new ones.
    fn extract_lines(&self, first: &TetMesh, new_id: impl Fn(VertexId) -> VertexId, extract: &mut Extract) {
        let mut push = |vertices: [VertexId; 2], old: u32| {
            extract.mesh.lines.push(vertices.map(&new_id));
            extract.mesh.line_labels.push(first.line_labels[old as usize]);
            extract.line_to_old.push(old);
        };
        let mut is_removed = vec![false; if self.lines.removed.is_empty() { 0 } else { first.lines.len() }];
        let removed = self.lines.removed.iter().flat_map(|&source| &self.lines.sources[source as usize]);
        removed.for_each(|&line| is_removed[line as usize] = true);
        for (&vertices, old) in first.lines.iter().zip(0u32..) {
            if !is_removed.get(old as usize).copied().unwrap_or(false) {
                push(vertices, old);
            }
        }
        for (edge, line) in self.lines().into_iter().filter(|(_, line)| line.is_new) {
            self.lines_of_first(line).iter().for_each(|&old| push(edge, old));
        }
    }

    /// Extracts triangles whose walls are unchanged in their order, then the new ones.
    fn extract_triangles(
        &self,
        first: &TetMesh,
        new_id: impl Fn(VertexId) -> VertexId,
        extract: &mut Extract,
    ) {
        let mut push = |vertices: [VertexId; 3], patch: i32, old: u32| {
            extract.mesh.triangles.push(vertices.map(&new_id));
            extract.mesh.patches.push(patch);
            extract.triangle_to_old.push(old);
        };
        let removed = self.provenance.removed_triangles();
        let mut is_removed = vec![false; if removed.is_empty() { 0 } else { first.triangles.len() }];
        removed.iter().for_each(|&t| is_removed[t as usize] = true);
        for (t, &vertices) in first.triangles.iter().enumerate() {
            if !is_removed.get(t).copied().unwrap_or(false) {
                push(vertices, first.patches[t], t as u32);
            }
        }
        for (_, wall) in self.walls().filter(|(_, wall)| wall.is_new && wall.triangle != NO_TRIANGLE) {
            push(self.facet(wall.sides[0]), wall.patch, wall.triangle);
        }
    }
}
