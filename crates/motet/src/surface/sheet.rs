//! Triangles that can be changed: an edge split, flipped or collapsed, a vertex moved. Edges may have any
//! number of triangles.

use crate::base::{Point, VertexId, sorted_ids};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, scale, unit};

/// Triangles over points, each with a label, and the triangles at each vertex.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub(crate) points: Vec<Point>,
    /// All triangles, removed ones among them.
    triangles: Vec<[VertexId; 3]>,
    labels: Vec<u32>,
    is_removed: Vec<bool>,
    /// Ids of removed triangles that are not in use again.
    unused: Vec<u32>,
    at_vertex: Vec<Vec<u32>>,
}

/// A change: triangles that are removed and those that replace them.
#[derive(Clone, Debug)]
pub(crate) struct Change {
    pub(crate) removed: Vec<u32>,
    pub(crate) added: Vec<([VertexId; 3], u32)>,
    /// A vertex, and where it is placed; one with the next id is new.
    pub(crate) placed: Option<(VertexId, Point)>,
}

impl Sheet {
    pub(crate) fn new(points: Vec<Point>, triangles: Vec<[VertexId; 3]>, labels: Vec<u32>) -> Self {
        let mut at_vertex = vec![Vec::new(); points.len()];
        for (t, triangle) in (0..).zip(&triangles) {
            triangle.iter().for_each(|v| at_vertex[v.index()].push(t));
        }
        Self {
            points,
            is_removed: vec![false; triangles.len()],
            unused: Vec::new(),
            triangles,
            labels,
            at_vertex,
        }
    }

    pub(crate) fn exists(&self, t: u32) -> bool {
        !self.is_removed[t as usize]
    }

    pub(crate) fn triangle(&self, t: u32) -> [VertexId; 3] {
        self.triangles[t as usize]
    }

    pub(crate) fn label(&self, t: u32) -> u32 {
        self.labels[t as usize]
    }

    pub(crate) fn corners(&self, t: u32) -> [Point; 3] {
        self.triangle(t).map(|v| self.points[v.index()])
    }

    /// The triangles that exist, by their ids.
    pub(crate) fn existing(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.triangles.len() as u32).filter(|&t| self.exists(t))
    }

    /// The number of triangle ids in use or used before.
    pub(crate) fn n_slots(&self) -> usize {
        self.triangles.len()
    }

    /// The triangles at a vertex.
    pub(crate) fn star(&self, v: VertexId) -> &[u32] {
        &self.at_vertex[v.index()]
    }

    /// The other ends of a vertex's edges, in rising order.
    pub(crate) fn neighbours(&self, v: VertexId) -> Vec<VertexId> {
        let of = self.star(v).iter().flat_map(|&t| self.triangle(t));
        let mut neighbours: Vec<VertexId> = of.filter(|&u| u != v).collect();
        neighbours.sort_unstable();
        neighbours.dedup();
        neighbours
    }

    /// The triangles at an edge; none at one of a vertex that is not there yet.
    pub(crate) fn at_edge(&self, u: VertexId, v: VertexId) -> impl Iterator<Item = u32> + '_ {
        let star = self.at_vertex.get(u.index()).map_or(&[][..], Vec::as_slice);
        star.iter().copied().filter(move |&t| self.triangle(t).contains(&v))
    }

    /// The edges of the triangles that exist, each once, in rising order.
    pub(crate) fn edges(&self) -> Vec<[VertexId; 2]> {
        self.edges_where(|_| true)
    }

    /// The edges of wanted triangles, each once, in rising order.
    pub(crate) fn edges_where(&self, is_wanted: impl Fn(u32) -> bool) -> Vec<[VertexId; 2]> {
        let of = |t: u32| edges_of(self.triangle(t)).map(sorted_ids);
        let mut edges: Vec<_> = self.existing().filter(|&t| is_wanted(t)).flat_map(of).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    }

    /// The place of a vertex after a change.
    pub(crate) fn place(&self, change: &Change, v: VertexId) -> Point {
        match change.placed {
            Some((placed, place)) if placed == v => place,
            _ => self.points[v.index()],
        }
    }

    /// The corners of the new triangles of a change.
    pub(crate) fn corners_after<'a>(&'a self, change: &'a Change) -> impl Iterator<Item = [Point; 3]> + 'a {
        change.added.iter().map(move |(t, _)| t.map(|v| self.place(change, v)))
    }

    /// Splits an edge at a place; the new vertex has the next id.
    pub(crate) fn split(&self, [u, v]: [VertexId; 2], place: Point) -> Change {
        let new = VertexId::new(self.points.len());
        let removed: Vec<u32> = self.at_edge(u, v).collect();
        let halves = |&t: &u32| {
            let with = |old| self.triangle(t).map(|w| if w == old { new } else { w });
            [(with(u), self.label(t)), (with(v), self.label(t))]
        };
        let added = removed.iter().flat_map(halves).collect();
        Change { removed, added, placed: Some((new, place)) }
    }

    /// Flips an edge: its two triangles over the other diagonal. `None` if it has not two triangles of one
    /// label, oriented alike, or if that diagonal is an edge already.
    pub(crate) fn flip(&self, [u, v]: [VertexId; 2]) -> Option<Change> {
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
        Some(Change { removed, added, placed: None })
    }

    /// Collapses an edge: `removed` becomes `kept`, which gets a place. `None` if triangles would be folded
    /// onto each other: the edge must have as many triangles as its ends have neighbours in common (Dey,
    /// Edelsbrunner, Guha, Nekhayev 1999), and no two triangles may get the same vertices.
    pub(crate) fn collapse(&self, removed: VertexId, kept: VertexId, place: Point) -> Option<Change> {
        let [of_removed, of_kept] = [removed, kept].map(|v| self.neighbours(v));
        let common = of_removed.iter().filter(|v| of_kept.binary_search(v).is_ok()).count();
        if common != self.at_edge(removed, kept).count() {
            return None;
        }
        let mut change = self.placed(self.star(removed).iter().chain(self.star(kept)), (kept, place));
        change.added.retain(|(t, _)| !(t.contains(&removed) && t.contains(&kept)));
        change.added.iter_mut().flat_map(|(t, _)| t).filter(|v| **v == removed).for_each(|v| *v = kept);
        let mut all: Vec<_> = change.added.iter().map(|(t, _)| sorted_ids(*t)).collect();
        all.sort_unstable();
        let is_double = all.windows(2).any(|pair| pair[0] == pair[1]);
        (!all.is_empty() && !is_double).then_some(change)
    }

    /// Moves a vertex.
    pub(crate) fn moved(&self, v: VertexId, place: Point) -> Change {
        self.placed(self.star(v).iter(), (v, place))
    }

    fn placed<'a>(&self, triangles: impl Iterator<Item = &'a u32>, placed: (VertexId, Point)) -> Change {
        let mut removed: Vec<u32> = triangles.copied().collect();
        removed.sort_unstable();
        removed.dedup();
        let added = removed.iter().map(|&t| (self.triangle(t), self.label(t))).collect();
        Change { removed, added, placed: Some(placed) }
    }

    /// Makes a change. Returns the ids of the new triangles, in the order of [`Change::added`]; ids of
    /// removed triangles are used again.
    pub(crate) fn commit(&mut self, change: &Change) -> Vec<u32> {
        if let Some((v, place)) = change.placed {
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
        let mut reused = change.removed.iter().copied();
        let mut ids = Vec::with_capacity(change.added.len());
        for &(triangle, label) in &change.added {
            let t = reused.next().or_else(|| self.unused.pop()).unwrap_or(self.triangles.len() as u32);
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
        self.unused.extend(reused);
        ids
    }

    /// The unit normal at a vertex; `None` where its triangles have none.
    pub(crate) fn normal(&self, v: VertexId) -> Option<Point> {
        unit(self.star(v).iter().map(|&t| area_vector(self.corners(t))).fold([0.0; 3], add))
    }

    /// The middle of an edge.
    pub(crate) fn middle(&self, [u, v]: [VertexId; 2]) -> Point {
        scale(add(self.points[u.index()], self.points[v.index()]), 0.5)
    }
}

/// The edges of a triangle, in its direction.
pub(crate) fn edges_of([a, b, c]: [VertexId; 3]) -> [[VertexId; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}
