//! The points that triangles have in common, each once: assigned to edges and triangles, which they divide.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::Pair;
use super::common::{Location, PointKey};
use super::plane::Plane;
use crate::base::{Point, VertexId, sorted_ids};
use crate::geometry::segment;
use crate::geometry::vector::{add, distance, scale, sub};

/// All points, and the edges and triangles that they lie on.
pub(super) struct Points<'a> {
    triangles: &'a [[VertexId; 3]],
    near: f64,
    points: Vec<Point>,
    ids: HashMap<PointKey, VertexId>,
    on_edge: BTreeMap<[VertexId; 2], Vec<VertexId>>,
    inside: BTreeMap<u32, BTreeSet<VertexId>>,
    /// The vertex that each point has been merged into.
    merged_into: Vec<VertexId>,
}

/// Triangles in pieces, and the points that they use.
pub(super) struct Divided {
    pub(super) points: Vec<Point>,
    /// The pieces, oriented like the triangles, each with the triangle that it is or is part of; in the order
    /// of the triangles.
    pub(super) pieces: Vec<([VertexId; 3], u32)>,
    /// The vertex that each point has become.
    pub(super) merged_into: Vec<VertexId>,
}

impl<'a> Points<'a> {
    /// Collects the points of all pairs. Points nearer than `near` are one place.
    pub(super) fn new(points: &[Point], triangles: &'a [[VertexId; 3]], pairs: &[Pair], near: f64) -> Self {
        let mut found = Self {
            triangles,
            near,
            points: points.to_vec(),
            ids: HashMap::new(),
            on_edge: BTreeMap::new(),
            inside: BTreeMap::new(),
            merged_into: Vec::new(),
        };
        for (numbers, common) in pairs {
            for shared in &common.points {
                let id = match shared.key {
                    PointKey::Vertex(v) => v,
                    key => *found.ids.entry(key).or_insert_with(|| {
                        found.points.push(shared.at);
                        VertexId::new(found.points.len() - 1)
                    }),
                };
                (0..2).for_each(|s| found.put(id, numbers[s], shared.on[s]));
            }
        }
        found.merged_into = (0..found.points.len()).map(VertexId::new).collect();
        found.merge();
        found
    }

    /// Assigns a point to the edge or the inside of a triangle that it lies on.
    fn put(&mut self, id: VertexId, triangle: u32, on: Location) {
        let vertices = self.triangles[triangle as usize];
        match on {
            Location::Corner(_) => {}
            Location::Edge(k) => {
                self.on_edge.entry(sorted_ids([vertices[k], vertices[(k + 1) % 3]])).or_default().push(id);
            }
            Location::Inside => {
                self.inside.entry(triangle).or_default().insert(id);
            }
        }
    }

    /// The points on edges: the ends of each edge, and the points between in their order.
    pub(super) fn on_edges(&self) -> impl Iterator<Item = ([VertexId; 2], &[VertexId])> {
        self.on_edge.iter().map(|(ends, list)| (*ends, list.as_slice()))
    }

    fn at(&self, v: VertexId) -> Point {
        self.points[v.index()]
    }

    fn id(&self, mut v: VertexId) -> VertexId {
        while self.merged_into[v.index()] != v {
            v = self.merged_into[v.index()];
        }
        v
    }

    fn id_of(&self, key: PointKey) -> VertexId {
        match key {
            PointKey::Vertex(v) => self.id(v),
            key => self.id(self.ids[&key]),
        }
    }

    /// Sorts the points of each edge, and merges points at one place.
    fn merge(&mut self) {
        let mut on_edge = std::mem::take(&mut self.on_edge);
        for ([from, to], list) in &mut on_edge {
            let start = self.at(*from);
            let off = |v: VertexId| distance(start, self.points[v.index()]);
            list.sort_by(|&v, &w| off(v).total_cmp(&off(w)).then(v.cmp(&w)));
            list.dedup();
            let all: Vec<VertexId> = [*from].into_iter().chain(list.iter().copied()).chain([*to]).collect();
            all.windows(2).for_each(|pair| self.unite(pair[0], pair[1]));
        }
        let inside: Vec<Vec<VertexId>> =
            self.inside.values().map(|set| set.iter().copied().collect()).collect();
        for mut points in inside {
            points.sort_by(|&v, &w| self.at(v)[0].total_cmp(&self.at(w)[0]).then(v.cmp(&w)));
            for (i, &v) in points.iter().enumerate() {
                let is_beside = |w: &&VertexId| self.at(v)[0] - self.at(**w)[0] <= self.near;
                let beside: Vec<VertexId> = points[..i].iter().rev().take_while(is_beside).copied().collect();
                beside.into_iter().for_each(|w| self.unite(w, v));
            }
        }
        for ([from, to], list) in &mut on_edge {
            list.iter_mut().for_each(|v| *v = self.id(*v));
            list.dedup();
            list.retain(|v| v != from && v != to);
        }
        on_edge.retain(|_, list| !list.is_empty());
        self.on_edge = on_edge;
    }

    /// Merges two points if they are at one place. The smaller id stays, so given vertices take precedence
    /// over new ones.
    fn unite(&mut self, v: VertexId, w: VertexId) {
        let [v, w] = sorted_ids([self.id(v), self.id(w)]);
        if v != w && distance(self.at(v), self.at(w)) <= self.near {
            self.merged_into[w.index()] = v;
        }
    }

    /// Divides the triangles, from the last to the first: of two that overlap, the first takes over the edges
    /// of the other's pieces, so that both are divided alike. `None` if this fails.
    pub(super) fn divide(self, pairs: &[Pair]) -> Option<Divided> {
        let mut segments: BTreeMap<u32, BTreeSet<[VertexId; 2]>> = BTreeMap::new();
        let mut flat: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (i, (numbers, common)) in pairs.iter().enumerate() {
            for number in *numbers {
                let ends = common.segments.iter().map(|ends| ends.map(|i| self.id_of(common.points[i].key)));
                segments.entry(number).or_default().extend(ends.filter(|[v, w]| v != w).map(sorted_ids));
            }
            if common.is_flat {
                flat.entry(numbers[0]).or_default().push(i);
            }
        }
        let mut pieces: BTreeMap<u32, Vec<[VertexId; 3]>> = BTreeMap::new();
        for t in (0..self.triangles.len() as u32).rev() {
            let mut own = segments.remove(&t).unwrap_or_default();
            for (numbers, common) in flat.get(&t).into_iter().flatten().map(|&i| &pairs[i]) {
                let shared: BTreeSet<VertexId> = common.points.iter().map(|p| self.id_of(p.key)).collect();
                let edges = pieces[&numbers[1]].iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
                own.extend(edges.filter(|edge| edge.iter().all(|v| shared.contains(v))).map(sorted_ids));
            }
            pieces.insert(t, self.triangle(t, &own)?);
        }
        let pieces =
            pieces.into_iter().flat_map(|(t, pieces)| pieces.into_iter().map(move |piece| (piece, t)));
        let pieces = pieces.collect();
        let merged_into = (0..self.points.len()).map(|v| self.id(VertexId::new(v))).collect();
        Some(Divided { points: self.points, pieces, merged_into })
    }

    /// The pieces of one triangle: an empty list if merged points have left it without area, `None` if
    /// dividing it fails.
    fn triangle(&self, number: u32, segments: &BTreeSet<[VertexId; 2]>) -> Option<Vec<[VertexId; 3]>> {
        let given = self.triangles[number as usize];
        let triangle @ [a, b, c] = given.map(|v| self.id(v));
        if a == b || b == c || c == a {
            return Some(Vec::new());
        }
        let mut ids = triangle.to_vec();
        let mut on_edges: [Vec<usize>; 3] = Default::default();
        for (k, places) in on_edges.iter_mut().enumerate() {
            let [from, to] = [given[k], given[(k + 1) % 3]];
            let Some(list) = self.on_edge.get(&sorted_ids([from, to])) else { continue };
            let mut list = list.clone();
            if from > to {
                list.reverse();
            }
            for v in list {
                if triangle.contains(&v) {
                    return Some(Vec::new());
                }
                places.push(ids.len());
                ids.push(v);
            }
        }
        let n_on_edges = ids.len();
        let known: BTreeSet<VertexId> = ids.iter().copied().collect();
        let inside: BTreeSet<VertexId> =
            self.inside.get(&number).into_iter().flatten().map(|&v| self.id(v)).collect();
        ids.extend(inside.difference(&known));
        if ids.len() == 3 {
            return Some(vec![triangle]);
        }
        let points: Vec<Point> = ids.iter().map(|&v| self.at(v)).collect();
        let mut plane = Plane::new(&points, &on_edges)?;
        for p in n_on_edges..ids.len() {
            plane.insert(p)?;
        }
        plane.restore_delaunay_if_many();
        let local: HashMap<VertexId, usize> = ids.iter().copied().zip(0..).collect();
        let places = segments.iter().filter_map(|[v, w]| Some([*local.get(v)?, *local.get(w)?]));
        for segment in places.flat_map(|ends| self.split_segment(&points, ends)) {
            // A segment that another one blocks is divided in the next round.
            let _ = plane.insert_segment(segment);
        }
        plane.restore_delaunay();
        Some(plane.triangles().into_iter().map(|t| t.map(|i| ids[i])).collect())
    }

    /// A segment between two points, divided at the points that lie on it.
    fn split_segment(&self, points: &[Point], [p, q]: [usize; 2]) -> Vec<[usize; 2]> {
        let ends = [points[p], points[q]];
        let place = |i: usize| segment::closest(ends, points[i]);
        let is_on = |i: &usize| {
            let t = place(*i);
            let at = add(ends[0], scale(sub(ends[1], ends[0]), t));
            *i != p && *i != q && t > 0.0 && t < 1.0 && distance(at, points[*i]) <= self.near
        };
        let mut along: Vec<usize> = (0..points.len()).filter(is_on).collect();
        along.sort_by(|&i, &j| place(i).total_cmp(&place(j)).then(i.cmp(&j)));
        let along: Vec<usize> = [p].into_iter().chain(along).chain([q]).collect();
        along.windows(2).map(|pair| [pair[0], pair[1]]).collect()
    }
}
