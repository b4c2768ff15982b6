//! The points that two surfaces have in common: each once, put on edges and in triangles, and those divided.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::common::{Name, On};
use super::plane::Plane;
use super::{Cut, Pair};
use crate::base::{Point, VertexId, rising};
use crate::geometry::vector::distance;

/// All points, and where they go.
pub(super) struct Points {
    points: Vec<Point>,
    names: HashMap<Name, VertexId>,
    on_edge: BTreeMap<[VertexId; 2], Vec<VertexId>>,
    inside: [BTreeMap<u32, BTreeSet<VertexId>>; 2],
    /// What points that turned out to be others are called.
    same: HashMap<VertexId, VertexId>,
}

impl Points {
    pub(super) fn new(points: &[Point], pairs: &[Pair], surfaces: [&[[VertexId; 3]]; 2]) -> Self {
        let mut found = Self {
            points: points.to_vec(),
            names: HashMap::new(),
            on_edge: BTreeMap::new(),
            inside: Default::default(),
            same: HashMap::new(),
        };
        for (numbers, common) in pairs {
            for shared in &common.points {
                let id = match shared.name {
                    Name::Vertex(v) => v,
                    name => *found.names.entry(name).or_insert_with(|| {
                        found.points.push(shared.at);
                        VertexId::new(found.points.len() - 1)
                    }),
                };
                for s in 0..2 {
                    let vertices = surfaces[s][numbers[s] as usize];
                    match shared.on[s] {
                        On::Corner(_) => {}
                        On::Edge(k) => {
                            let list = found.on_edge.entry(rising([vertices[k], vertices[(k + 1) % 3]]));
                            let list = list.or_default();
                            if !list.contains(&id) {
                                list.push(id);
                            }
                        }
                        On::Inside => {
                            found.inside[s].entry(numbers[s]).or_default().insert(id);
                        }
                    }
                }
            }
        }
        found
    }

    fn at(&self, v: VertexId) -> Point {
        self.points[v.index()]
    }

    fn id(&self, mut v: VertexId) -> VertexId {
        while let Some(&of) = self.same.get(&v) {
            v = of;
        }
        v
    }

    fn id_of(&self, name: Name) -> VertexId {
        match name {
            Name::Vertex(v) => self.id(v),
            name => self.id(self.names[&name]),
        }
    }

    /// Puts the points of edges in their order, and makes points at one place one.
    pub(super) fn merge(&mut self, near: f64) {
        let mut on_edge = std::mem::take(&mut self.on_edge);
        for ([from, to], list) in &mut on_edge {
            let start = self.at(*from);
            let off = |v: VertexId| distance(start, self.points[v.index()]);
            list.sort_by(|&v, &w| off(v).total_cmp(&off(w)).then(v.cmp(&w)));
            let all: Vec<VertexId> = [*from].into_iter().chain(list.iter().copied()).chain([*to]).collect();
            for pair in all.windows(2) {
                self.unite(pair[0], pair[1], near);
            }
        }
        let inside: Vec<Vec<VertexId>> =
            self.inside.iter().flat_map(|of| of.values().map(|set| set.iter().copied().collect())).collect();
        for points in inside {
            for (i, &v) in points.iter().enumerate() {
                points[..i].iter().for_each(|&w| self.unite(w, v, near));
            }
        }
        for ([from, to], list) in &mut on_edge {
            list.iter_mut().for_each(|v| *v = self.id(*v));
            list.dedup();
            list.retain(|v| v != from && v != to);
        }
        self.on_edge = on_edge;
    }

    /// Given vertices come before those that were found: the smaller id stays.
    fn unite(&mut self, v: VertexId, w: VertexId, near: f64) {
        let [v, w] = rising([self.id(v), self.id(w)]);
        if v != w && distance(self.at(v), self.at(w)) <= near {
            self.same.insert(w, v);
        }
    }

    /// Divides the second surface, then the first, so that what they have in common is divided alike.
    pub(super) fn divide(
        self,
        pairs: &[Pair],
        surfaces: [&[[VertexId; 3]]; 2],
        mut names: Vec<VertexId>,
    ) -> Option<Cut> {
        let mut segments: [BTreeMap<u32, BTreeSet<[VertexId; 2]>>; 2] = Default::default();
        for (numbers, common) in pairs {
            for s in 0..2 {
                let list = segments[s].entry(numbers[s]).or_default();
                let ends = common.segments.iter().map(|ends| ends.map(|i| self.id_of(common.points[i].name)));
                list.extend(ends.filter(|[v, w]| v != w).map(rising));
            }
        }
        let second = self.pieces(1, surfaces[1], &segments[1])?;
        let mut of_second: BTreeMap<u32, Vec<[VertexId; 3]>> = BTreeMap::new();
        for &(piece, t) in &second {
            of_second.entry(t).or_default().push(piece);
        }
        for (numbers, common) in pairs.iter().filter(|(_, common)| common.is_flat) {
            let shared: BTreeSet<VertexId> = common.points.iter().map(|p| self.id_of(p.name)).collect();
            let edges = of_second[&numbers[1]].iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
            let within = edges.filter(|edge| edge.iter().all(|v| shared.contains(v)));
            segments[0].entry(numbers[0]).or_default().extend(within.map(rising));
        }
        let first = self.pieces(0, surfaces[0], &segments[0])?;
        names.iter_mut().for_each(|v| *v = self.id(*v));
        Some(Cut { points: self.points, pieces: [first, second], names })
    }

    fn pieces(
        &self,
        s: usize,
        surface: &[[VertexId; 3]],
        segments: &BTreeMap<u32, BTreeSet<[VertexId; 2]>>,
    ) -> Option<Vec<([VertexId; 3], u32)>> {
        let mut pieces = Vec::with_capacity(surface.len());
        for (t, triangle) in (0u32..).zip(surface) {
            let of = self.triangle(s, t, triangle.map(|v| self.id(v)), segments.get(&t))?;
            pieces.extend(of.into_iter().map(|piece| (piece, t)));
        }
        Some(pieces)
    }

    /// The pieces of one triangle.
    fn triangle(
        &self,
        s: usize,
        number: u32,
        triangle: [VertexId; 3],
        segments: Option<&BTreeSet<[VertexId; 2]>>,
    ) -> Option<Vec<[VertexId; 3]>> {
        let mut ids = triangle.to_vec();
        let mut on_edges: [Vec<usize>; 3] = Default::default();
        for (k, places) in on_edges.iter_mut().enumerate() {
            let [from, to] = [triangle[k], triangle[(k + 1) % 3]];
            let Some(list) = self.on_edge.get(&rising([from, to])) else { continue };
            let mut list = list.clone();
            if from > to {
                list.reverse();
            }
            for v in list {
                places.push(ids.len());
                ids.push(v);
            }
        }
        let inside = self.inside[s].get(&number).into_iter().flatten().map(|&v| self.id(v));
        let mut n = ids.len();
        for v in inside {
            if !ids.contains(&v) {
                ids.push(v);
            }
        }
        let local = |v: VertexId| ids.iter().position(|w| *w == v);
        let segments: Vec<[usize; 2]> =
            segments.into_iter().flatten().filter_map(|&[v, w]| Some([local(v)?, local(w)?])).collect();
        if ids.len() == 3 {
            return Some(vec![triangle]);
        }
        let points: Vec<Point> = ids.iter().map(|&v| self.at(v)).collect();
        let mut plane = Plane::new(&points, &on_edges)?;
        while n < ids.len() {
            plane.insert(n)?;
            n += 1;
        }
        for segment in segments {
            plane.join(segment)?;
        }
        plane.even_out();
        Some(plane.triangles().into_iter().map(|t| t.map(|i| ids[i])).collect())
    }
}
