//! Triangles that can be changed: an edge split, flipped or collapsed, a vertex moved. Edges may have any
//! number of triangles.

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, scale};

/// Triangles over points, each with a label, and the triangles at each vertex.
#[derive(Clone, Debug)]
pub(super) struct Sheet {
    pub(super) points: Vec<Point>,
    /// All triangles, removed ones among them.
    triangles: Vec<[VertexId; 3]>,
    labels: Vec<u32>,
    is_removed: Vec<bool>,
    at_vertex: Vec<Vec<u32>>,
}

/// What happens to a vertex in a change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Vertex {
    /// None is inserted, moved or removed.
    Unchanged,
    /// A vertex gets this place; one with the next id is new.
    Placed(VertexId, Point),
}

/// A change: triangles that are removed and those that replace them.
#[derive(Clone, Debug)]
pub(super) struct Change {
    pub(super) removed: Vec<u32>,
    pub(super) added: Vec<([VertexId; 3], u32)>,
    pub(super) vertex: Vertex,
}

impl Sheet {
    pub(super) fn new(points: Vec<Point>, triangles: Vec<[VertexId; 3]>, labels: Vec<u32>) -> Self {
        let mut at_vertex = vec![Vec::new(); points.len()];
        for (t, triangle) in (0..).zip(&triangles) {
            triangle.iter().for_each(|v| at_vertex[v.index()].push(t));
        }
        Self { points, is_removed: vec![false; triangles.len()], triangles, labels, at_vertex }
    }

    pub(super) fn exists(&self, t: u32) -> bool {
        !self.is_removed[t as usize]
    }

    pub(super) fn triangle(&self, t: u32) -> [VertexId; 3] {
        self.triangles[t as usize]
    }

    pub(super) fn label(&self, t: u32) -> u32 {
        self.labels[t as usize]
    }

    pub(super) fn corners(&self, t: u32) -> [Point; 3] {
        self.triangle(t).map(|v| self.points[v.index()])
    }

    /// The triangles that exist, by their ids.
    pub(super) fn existing(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.triangles.len() as u32).filter(|&t| self.exists(t))
    }

    /// The number of triangle ids in use or used before.
    pub(super) fn n_slots(&self) -> usize {
        self.triangles.len()
    }

    /// The triangles at a vertex.
    pub(super) fn star(&self, v: VertexId) -> &[u32] {
        &self.at_vertex[v.index()]
    }

    /// The other ends of a vertex's edges, in rising order.
    pub(super) fn neighbours(&self, v: VertexId) -> Vec<VertexId> {
        let of = self.star(v).iter().flat_map(|&t| self.triangle(t));
        let mut neighbours: Vec<VertexId> = of.filter(|&u| u != v).collect();
        neighbours.sort_unstable();
        neighbours.dedup();
        neighbours
    }

    /// The triangles at an edge.
    pub(super) fn at_edge(&self, u: VertexId, v: VertexId) -> impl Iterator<Item = u32> + '_ {
        self.star(u).iter().copied().filter(move |&t| self.triangle(t).contains(&v))
    }

    /// The edges of the triangles that exist, each once, in rising order.
    pub(super) fn edges(&self) -> Vec<[VertexId; 2]> {
        let of = |t: u32| edges_of(self.triangle(t)).map(|[u, v]| [u.min(v), u.max(v)]);
        let mut edges: Vec<_> = self.existing().flat_map(of).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// The place of a vertex after a change.
    pub(super) fn place(&self, change: &Change, v: VertexId) -> Point {
        match change.vertex {
            Vertex::Placed(placed, place) if placed == v => place,
            _ => self.points[v.index()],
        }
    }

    /// The corners of the new triangles of a change.
    pub(super) fn corners_after<'a>(&'a self, change: &'a Change) -> impl Iterator<Item = [Point; 3]> + 'a {
        change.added.iter().map(move |(t, _)| t.map(|v| self.place(change, v)))
    }

    /// Splits an edge at a place; the new vertex has the next id.
    pub(super) fn split(&self, [u, v]: [VertexId; 2], place: Point) -> Change {
        let new = VertexId::new(self.points.len());
        let removed: Vec<u32> = self.at_edge(u, v).collect();
        let halves = |&t: &u32| {
            let with = |old| self.triangle(t).map(|w| if w == old { new } else { w });
            [(with(u), self.label(t)), (with(v), self.label(t))]
        };
        let added = removed.iter().flat_map(halves).collect();
        Change { removed, added, vertex: Vertex::Placed(new, place) }
    }

    /// Flips an edge: its two triangles over the other diagonal. `None` if it has not two triangles of one
    /// label, oriented alike, or if that diagonal is an edge already.
    pub(super) fn flip(&self, [u, v]: [VertexId; 2]) -> Option<Change> {
        let removed: Vec<u32> = self.at_edge(u, v).collect();
        let &[s, t] = removed.as_slice() else { return None };
        let runs = |t: u32| edges_of(self.triangle(t)).contains(&[u, v]);
        if self.label(s) != self.label(t) || runs(s) == runs(t) {
            return None;
        }
        let apex = |t: u32| self.triangle(t).into_iter().find(|w| *w != u && *w != v);
        let (c, d) = if runs(s) { (apex(s)?, apex(t)?) } else { (apex(t)?, apex(s)?) };
        if c == d || self.at_edge(c, d).next().is_some() {
            return None;
        }
        let label = self.label(s);
        let added = vec![([c, u, d], label), ([d, v, c], label)];
        Some(Change { removed, added, vertex: Vertex::Unchanged })
    }

    /// Collapses an edge: `removed` becomes `kept`, which gets a place. `None` if triangles would be folded
    /// onto each other: the edge must have as many triangles as its ends have neighbours in common (Dey,
    /// Edelsbrunner, Guha, Nekhayev 1999), and no two triangles may get the same vertices.
    pub(super) fn collapse(&self, removed: VertexId, kept: VertexId, place: Point) -> Option<Change> {
        let [of_removed, of_kept] = [removed, kept].map(|v| self.neighbours(v));
        let common = of_removed.iter().filter(|v| of_kept.binary_search(v).is_ok()).count();
        if common != self.at_edge(removed, kept).count() {
            return None;
        }
        let mut change = self.moved(kept, place);
        let of_kept_only = change.removed.len();
        change.removed.extend(self.star(removed).iter().filter(|&&t| !self.triangle(t).contains(&kept)));
        let renamed =
            |&t: &u32| (self.triangle(t).map(|v| if v == removed { kept } else { v }), self.label(t));
        change.added.retain(|(t, _)| !t.contains(&removed));
        let others: Vec<_> = change.removed[of_kept_only..].iter().map(renamed).collect();
        // Only triangles around both ends can coincide.
        let key = |t: &[VertexId; 3]| crate::base::sorted_ids(*t);
        let keys: Vec<_> = change.added.iter().map(|(t, _)| key(t)).collect();
        if others.iter().any(|(t, _)| keys.contains(&key(t))) || keys.is_empty() && others.is_empty() {
            return None;
        }
        change.added.extend(others);
        Some(change)
    }

    /// Moves a vertex.
    pub(super) fn moved(&self, v: VertexId, place: Point) -> Change {
        let removed = self.star(v).to_vec();
        let added = removed.iter().map(|&t| (self.triangle(t), self.label(t))).collect();
        Change { removed, added, vertex: Vertex::Placed(v, place) }
    }

    /// Makes a change. Returns the ids of the new triangles, in the order of [`Change::added`]; ids of
    /// removed triangles are used again.
    pub(super) fn commit(&mut self, change: &Change) -> Vec<u32> {
        if let Vertex::Placed(v, place) = change.vertex {
            if v.index() == self.points.len() {
                self.points.push(place);
                self.at_vertex.push(Vec::new());
            }
            self.points[v.index()] = place;
        }
        for &t in &change.removed {
            self.is_removed[t as usize] = true;
            for v in self.triangle(t) {
                self.at_vertex[v.index()].retain(|other| *other != t);
            }
        }
        let mut reused = change.removed.iter();
        let mut ids = Vec::with_capacity(change.added.len());
        for &(triangle, label) in &change.added {
            let t = reused.next().copied().unwrap_or(self.triangles.len() as u32);
            if t as usize == self.triangles.len() {
                self.triangles.push(triangle);
                self.labels.push(label);
                self.is_removed.push(false);
            }
            self.triangles[t as usize] = triangle;
            self.labels[t as usize] = label;
            self.is_removed[t as usize] = false;
            triangle.iter().for_each(|v| self.at_vertex[v.index()].push(t));
            ids.push(t);
        }
        ids
    }

    /// The middle of an edge.
    pub(super) fn middle(&self, [u, v]: [VertexId; 2]) -> Point {
        scale(add(self.points[u.index()], self.points[v.index()]), 0.5)
    }
}

/// The edges of a triangle, in its direction.
pub(super) fn edges_of([a, b, c]: [VertexId; 3]) -> [[VertexId; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}
