//! Triangles that can be changed: an edge flipped, two vertices merged, a vertex moved.

use super::skin::Skin;
use crate::base::{Point, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, dot, norm, scale, sub, unit};

/// The cosine of the largest angle between two triangles whose edge is flipped: 30 degrees.
const MIN_FLIP_COSINE: f64 = 0.866;

/// The cosine of how far a triangle may turn in a change: 25 degrees.
const MIN_TURN_COSINE: f64 = 0.906;

/// Triangles over points, and the triangles at each vertex.
pub(super) struct Sheet {
    pub(super) points: Vec<Point>,
    /// All triangles, removed ones among them.
    triangles: Vec<[VertexId; 3]>,
    is_removed: Vec<bool>,
    at_vertex: Vec<Vec<u32>>,
}

/// A change: triangles that are removed, those that replace them, and the new place of a vertex.
pub(super) struct Change {
    pub(super) removed: Vec<u32>,
    pub(super) added: Vec<[VertexId; 3]>,
    pub(super) moved: Option<(VertexId, Point)>,
    /// The unit normals that the new triangles have to keep, as far as [`MIN_TURN_COSINE`] allows.
    normals: Vec<Point>,
}

impl Sheet {
    pub(super) fn new(skin: &Skin) -> Self {
        let mut at_vertex = vec![Vec::new(); skin.points.len()];
        for (t, triangle) in (0..).zip(&skin.triangles) {
            triangle.iter().for_each(|v| at_vertex[v.index()].push(t));
        }
        let (points, triangles) = (skin.points.clone(), skin.triangles.clone());
        Self { points, is_removed: vec![false; triangles.len()], triangles, at_vertex }
    }

    pub(super) fn exists(&self, t: u32) -> bool {
        !self.is_removed[t as usize]
    }

    pub(super) fn triangle(&self, t: u32) -> [VertexId; 3] {
        self.triangles[t as usize]
    }

    /// The triangles that exist, by their ids.
    pub(super) fn existing(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.triangles.len() as u32).filter(|&t| self.exists(t))
    }

    pub(super) fn corners(&self, t: u32) -> [Point; 3] {
        self.triangles[t as usize].map(|v| self.points[v.index()])
    }

    /// The corners of the new triangles.
    pub(super) fn corners_after<'a>(&'a self, change: &'a Change) -> impl Iterator<Item = [Point; 3]> + 'a {
        let at = |v: VertexId| match change.moved {
            Some((moved, place)) if moved == v => place,
            _ => self.points[v.index()],
        };
        change.added.iter().map(move |t| t.map(at))
    }

    fn normal(&self, t: u32) -> Point {
        unit(area_vector(self.corners(t))).unwrap_or_default()
    }

    /// The other ends of a vertex's edges, in ascending order.
    fn neighbors(&self, v: VertexId) -> Vec<VertexId> {
        let of = self.at_vertex[v.index()].iter().flat_map(|&t| self.triangles[t as usize]);
        let mut neighbors: Vec<VertexId> = of.filter(|&u| u != v).collect();
        neighbors.sort_unstable();
        neighbors.dedup();
        neighbors
    }

    /// The triangles at an edge.
    fn at_edge(&self, u: VertexId, v: VertexId) -> Vec<u32> {
        let at = &self.at_vertex[u.index()];
        at.iter().copied().filter(|&t| self.triangles[t as usize].contains(&v)).collect()
    }

    /// The mean of a vertex's neighbours.
    pub(super) fn middle(&self, v: VertexId) -> Point {
        let neighbors = self.neighbors(v);
        let sum = neighbors.iter().fold([0.0; 3], |sum, u| add(sum, self.points[u.index()]));
        scale(sum, 1.0 / neighbors.len().max(1) as f64)
    }

    /// Flips an edge: two triangles over the other diagonal. `None` if that edge exists already, or the two
    /// triangles bend too far.
    pub(super) fn flipped(&self, u: VertexId, v: VertexId) -> Option<Change> {
        let removed = self.at_edge(u, v);
        let &[s, t] = removed.as_slice() else { return None };
        let normals = [s, t].map(|t| self.normal(t));
        let [c, d] = [s, t].map(|t| self.triangles[t as usize].into_iter().find(|w| *w != u && *w != v));
        let (c, d) = (c?, d?);
        let exists = c == d || !self.at_edge(c, d).is_empty();
        if exists || dot(normals[0], normals[1]) < MIN_FLIP_COSINE {
            return None;
        }
        // The edge runs from u to v in one of the two.
        let runs = |t: u32| {
            let [i, j, k] = self.triangles[t as usize];
            [[i, j], [j, k], [k, i]].contains(&[u, v])
        };
        let (c, d) = if runs(s) { (c, d) } else { (d, c) };
        let mean = unit(add(normals[0], normals[1]))?;
        Some(Change { removed, added: vec![[c, u, d], [d, v, c]], moved: None, normals: vec![mean; 2] })
    }

    /// Collapses an edge: `removed` becomes `kept`, which moves to `place`. `None` if that would fold
    /// triangles.
    pub(super) fn collapsed(&self, removed: VertexId, kept: VertexId, place: Point) -> Option<Change> {
        let [a, b] = [removed, kept].map(|v| self.neighbors(v));
        let common = a.iter().filter(|v| b.binary_search(v).is_ok()).count();
        // With more common neighbours than triangles at the edge, triangles would be folded onto each other
        // (Dey, Edelsbrunner, Guha and Nekhayev 1999).
        if common != 2 || self.at_edge(removed, kept).len() != 2 || a.len().min(b.len()) < 4 {
            return None;
        }
        let of_removed = self.at_vertex[removed.index()].iter();
        let mut change =
            self.with_vertex_at(of_removed.chain(&self.at_vertex[kept.index()]).copied(), kept, place);
        change.added.iter_mut().flatten().filter(|v| **v == removed).for_each(|v| *v = kept);
        let normals = std::mem::take(&mut change.normals);
        let is_double = |t: &[VertexId; 3]| t.iter().filter(|v| **v == kept).count() == 2;
        let added = std::mem::take(&mut change.added).into_iter().zip(normals);
        (change.added, change.normals) = added.filter(|(t, _)| !is_double(t)).unzip();
        Some(change)
    }

    /// Moves a vertex.
    pub(super) fn moved(&self, v: VertexId, place: Point) -> Change {
        self.with_vertex_at(self.at_vertex[v.index()].iter().copied(), v, place)
    }

    fn with_vertex_at(&self, triangles: impl Iterator<Item = u32>, v: VertexId, place: Point) -> Change {
        let mut removed: Vec<u32> = triangles.collect();
        removed.sort_unstable();
        removed.dedup();
        let added = removed.iter().map(|&t| self.triangles[t as usize]).collect();
        let normals = removed.iter().map(|&t| self.normal(t)).collect();
        Change { removed, added, moved: Some((v, place)), normals }
    }

    /// Whether no triangle turns away.
    pub(super) fn keeps_facing(&self, change: &Change) -> bool {
        let normals = self.corners_after(change).map(area_vector).zip(&change.normals);
        normals.into_iter().all(|(now, before)| dot(now, *before) > MIN_TURN_COSINE * norm(now))
    }

    pub(super) fn commit(&mut self, change: Change) {
        for &t in &change.removed {
            self.is_removed[t as usize] = true;
            let triangle = self.triangles[t as usize];
            triangle.iter().for_each(|v| self.at_vertex[v.index()].retain(|other| *other != t));
        }
        for (&t, triangle) in change.removed.iter().zip(&change.added) {
            self.is_removed[t as usize] = false;
            self.triangles[t as usize] = *triangle;
            triangle.iter().for_each(|v| self.at_vertex[v.index()].push(t));
        }
        if let Some((v, place)) = change.moved {
            self.points[v.index()] = place;
        }
    }
}

/// The cosine of the smallest angle of a triangle; 1 if an edge has no length.
pub(super) fn largest_cosine(corners: [Point; 3]) -> f64 {
    let cosine = |k: usize| {
        let [a, b] = [1, 2].map(|i| sub(corners[(k + i) % 3], corners[k]));
        let lengths = norm(a) * norm(b);
        if lengths > 0.0 { dot(a, b) / lengths } else { 1.0 }
    };
    cosine(0).max(cosine(1)).max(cosine(2))
}
