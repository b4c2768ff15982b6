//! Triangles of flat facets and the insertion of points: constrained Delaunay triangulations that share their
//! creases.
//!
//! A point replaces all triangles whose circumcircles contain it and that can be reached without crossing a
//! crease (Bowyer 1981, Watson 1981; with creases Lee and Lin 1986). A circle in a plane is the section of a
//! sphere through a point beside it, so signs are exact.

use hashbrown::HashMap;

use crate::base::{Point, VertexId, sorted_ids};
use crate::geometry::predicates::{insphere, orient3d};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{distance, dot, scale, sub, unit};

/// The plane of a flat facet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    /// A point beside the plane, on the side that its triangles face away from.
    beside: Point,
    /// A point of the plane.
    within: Point,
    /// The unit normal.
    normal: Point,
}

impl Plane {
    /// The plane of a triangle; `None` where its corners are in line.
    pub(super) fn of([a, b, c]: [Point; 3]) -> Option<Self> {
        let normal = unit(area_vector([a, b, c]))?;
        let reach = distance(a, b) + distance(b, c);
        let beside = |sign: f64| -> Point { std::array::from_fn(|i| a[i] + sign * reach * normal[i]) };
        let beside = [beside(1.0), beside(-1.0)].into_iter().find(|&p| orient3d(a, b, c, p) > 0)?;
        Some(Self { beside, within: a, normal })
    }

    /// The nearest point of the plane.
    pub(super) fn project(&self, p: Point) -> Point {
        sub(p, scale(self.normal, dot(sub(p, self.within), self.normal)))
    }

    /// The orientation of three points: 1 if they turn as the triangles of the facet do.
    pub(super) fn turn(&self, [a, b, c]: [Point; 3]) -> i8 {
        orient3d(a, b, c, self.beside)
    }

    fn is_in_circle(&self, [a, b, c]: [Point; 3], p: Point) -> bool {
        insphere(a, b, c, self.beside, p) > 0
    }
}

/// A triangle, by its index.
pub(super) type TriangleId = u32;

/// Why a point cannot be inserted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Blocked {
    /// A crease hides it, or is seen from it at an obtuse angle.
    By([VertexId; 2]),
    /// The triangles there have no space for it.
    NoSpace,
}

/// Triangles to be replaced, and the directed edges around them.
struct Cavity {
    triangles: Vec<TriangleId>,
    rim: Vec<[VertexId; 2]>,
}

/// Triangles of flat facets.
pub(super) struct Triangulation {
    pub(super) points: Vec<Point>,
    pub(super) triangles: Vec<[VertexId; 3]>,
    pub(super) facet_of: Vec<u32>,
    pub(super) planes: Vec<Plane>,
    /// The triangle to the left of a directed edge in a facet.
    left: HashMap<(u32, VertexId, VertexId), TriangleId>,
    /// Constrained edges, and the facets at each.
    creases: HashMap<[VertexId; 2], Vec<u32>>,
}

impl Triangulation {
    /// Builds it from triangles, given the facet of each; all must be oriented as their facet. An edge is a
    /// crease unless exactly two triangles meet there, both of one facet.
    pub(super) fn new(
        points: Vec<Point>,
        triangles: Vec<[VertexId; 3]>,
        facet_of: Vec<u32>,
        planes: Vec<Plane>,
    ) -> Self {
        let mut triangulation = Self {
            points,
            triangles: Vec::new(),
            facet_of,
            planes,
            left: HashMap::new(),
            creases: HashMap::new(),
        };
        let mut edges: Vec<([VertexId; 2], u32)> = Vec::with_capacity(3 * triangles.len());
        for (i, &[a, b, c]) in triangles.iter().enumerate() {
            edges.extend([[a, b], [b, c], [c, a]].map(|edge| (sorted_ids(edge), triangulation.facet_of[i])));
        }
        edges.sort_unstable();
        for run in edges.chunk_by(|x, y| x.0 == y.0) {
            if !matches!(run, [x, y] if x.1 == y.1) {
                let mut facets: Vec<u32> = run.iter().map(|edge| edge.1).collect();
                facets.dedup();
                triangulation.creases.insert(run[0].0, facets);
            }
        }
        triangulation.triangles = triangles;
        (0..triangulation.triangles.len()).for_each(|i| triangulation.link(i as TriangleId));
        triangulation
    }

    pub(super) fn corners(&self, triangle: TriangleId) -> [Point; 3] {
        self.triangles[triangle as usize].map(|v| self.point(v))
    }

    pub(super) fn point(&self, v: VertexId) -> Point {
        self.points[v.index()]
    }

    pub(super) fn is_crease(&self, edge: [VertexId; 2]) -> bool {
        self.creases.contains_key(&sorted_ids(edge))
    }

    /// All creases, in ascending order.
    pub(super) fn creases(&self) -> Vec<[VertexId; 2]> {
        let mut creases: Vec<[VertexId; 2]> = self.creases.keys().copied().collect();
        creases.sort_unstable();
        creases
    }

    fn link(&mut self, id: TriangleId) {
        let facet = self.facet_of[id as usize];
        let [a, b, c] = self.triangles[id as usize];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            self.left.insert((facet, from, to), id);
        }
    }

    fn unlink(&mut self, id: TriangleId) {
        let facet = self.facet_of[id as usize];
        let [a, b, c] = self.triangles[id as usize];
        for (from, to) in [(a, b), (b, c), (c, a)] {
            self.left.remove(&(facet, from, to));
        }
    }

    /// Flips edges within facets until no vertex lies in the circumcircle of a neighbour (Lawson 1977).
    pub(super) fn make_delaunay(&mut self) {
        let mut todo: Vec<(u32, [VertexId; 2])> = Vec::new();
        for (&facet, &[a, b, c]) in self.facet_of.iter().zip(&self.triangles) {
            todo.extend([[a, b], [b, c], [c, a]].map(|edge| (facet, edge)));
        }
        while let Some((facet, [a, b])) = todo.pop() {
            if self.is_crease([a, b]) {
                continue;
            }
            let sides = [self.left.get(&(facet, a, b)), self.left.get(&(facet, b, a))];
            let [Some(&s), Some(&t)] = sides else { continue };
            let third = |of: TriangleId| self.triangles[of as usize].into_iter().find(|&v| v != a && v != b);
            let (Some(p), Some(q)) = (third(s), third(t)) else { continue };
            let plane = self.planes[facet as usize];
            let at = |v: [VertexId; 3]| v.map(|v| self.point(v));
            if plane.turn(at([p, a, q])) > 0
                && plane.turn(at([q, b, p])) > 0
                && plane.is_in_circle(at([a, b, p]), self.point(q))
            {
                for old in [s, t] {
                    self.unlink(old);
                }
                self.triangles[s as usize] = [p, a, q];
                self.triangles[t as usize] = [q, b, p];
                for new in [s, t] {
                    self.link(new);
                }
                todo.extend([[a, q], [q, b], [b, p], [p, a]].map(|edge| (facet, edge)));
            }
        }
    }

    /// Inserts a point into a facet, near one of its triangles; returns the new triangles.
    pub(super) fn insert(&mut self, near: TriangleId, point: Point) -> Result<Vec<TriangleId>, Blocked> {
        let cavity = self.cavity(near, None, point)?;
        for &[a, b] in cavity.rim.iter().filter(|edge| self.is_crease(**edge)) {
            let [p, q] = [a, b].map(|v| sub(self.point(v), point));
            if dot(p, q) < 0.0 {
                return Err(Blocked::By(sorted_ids([a, b])));
            }
        }
        let facet = self.facet_of[near as usize];
        let new = self.push(point);
        Ok(self.fill(facet, &cavity, new))
    }

    /// Divides a crease at a point, in all facets that meet there; returns the new vertex and the new
    /// triangles. `None` if that is not possible.
    pub(super) fn divide(
        &mut self,
        edge: [VertexId; 2],
        point: Point,
    ) -> Option<(VertexId, Vec<TriangleId>)> {
        let [a, b] = sorted_ids(edge);
        let facets = self.creases.get(&[a, b])?.clone();
        let mut cavities = Vec::new();
        for &facet in &facets {
            for [from, to] in [[a, b], [b, a]] {
                if let Some(&side) = self.left.get(&(facet, from, to)) {
                    cavities.push((facet, self.cavity(side, Some([from, to]), point).ok()?));
                }
            }
        }
        let new = self.push(point);
        self.creases.remove(&[a, b]);
        for end in [a, b] {
            self.creases.insert(sorted_ids([end, new]), facets.clone());
        }
        let mut inserted = Vec::new();
        for (facet, cavity) in cavities {
            inserted.extend(self.fill(facet, &cavity, new));
        }
        Some((new, inserted))
    }

    fn push(&mut self, point: Point) -> VertexId {
        self.points.push(point);
        VertexId::new(self.points.len() - 1)
    }

    /// Finds the triangles that a point replaces: those whose circumcircles contain it, as far as all edges
    /// around them are visible from it. The edge `on` that the point lies on is exempt.
    fn cavity(&self, first: TriangleId, on: Option<[VertexId; 2]>, point: Point) -> Result<Cavity, Blocked> {
        let facet = self.facet_of[first as usize];
        let plane = self.planes[facet as usize];
        let mut refused: Vec<TriangleId> = Vec::new();
        loop {
            let mut triangles = vec![first];
            let (mut rim, mut next) = (Vec::new(), 0);
            while let Some(&triangle) = triangles.get(next) {
                next += 1;
                let [a, b, c] = self.triangles[triangle as usize];
                for edge in [[a, b], [b, c], [c, a]] {
                    if on == Some(edge) {
                        continue;
                    }
                    let behind = self.left.get(&(facet, edge[1], edge[0])).filter(|_| !self.is_crease(edge));
                    match behind {
                        Some(behind) if triangles.contains(behind) => {}
                        Some(&behind)
                            if !refused.contains(&behind)
                                && plane.is_in_circle(self.corners(behind), point) =>
                        {
                            triangles.push(behind)
                        }
                        _ => rim.push((edge, triangle)),
                    }
                }
            }
            // The second of two neighbouring triangles may have been added after the first one's edge was
            // examined.
            rim.retain(|(edge, _)| {
                let behind = self.left.get(&(facet, edge[1], edge[0])).filter(|_| !self.is_crease(*edge));
                behind.is_none_or(|behind| !triangles.contains(behind))
            });
            let hidden =
                rim.iter().find(|([a, b], _)| plane.turn([self.point(*a), self.point(*b), point]) <= 0);
            match hidden {
                None => {
                    return Ok(Cavity { triangles, rim: rim.into_iter().map(|(edge, _)| edge).collect() });
                }
                Some((edge, _)) if on.is_none() && self.is_crease(*edge) => {
                    return Err(Blocked::By(sorted_ids(*edge)));
                }
                Some((_, triangle)) if *triangle != first => refused.push(*triangle),
                Some(_) => return Err(Blocked::NoSpace),
            }
        }
    }

    fn fill(&mut self, facet: u32, cavity: &Cavity, apex: VertexId) -> Vec<TriangleId> {
        cavity.triangles.iter().for_each(|&old| self.unlink(old));
        let mut places = cavity.triangles.iter().copied();
        let mut inserted = Vec::with_capacity(cavity.rim.len());
        for &[a, b] in &cavity.rim {
            let id = places.next().unwrap_or_else(|| {
                self.triangles.push([a, b, apex]);
                self.facet_of.push(facet);
                (self.triangles.len() - 1) as TriangleId
            });
            self.triangles[id as usize] = [a, b, apex];
            inserted.push(id);
        }
        inserted.iter().for_each(|&id| self.link(id));
        inserted
    }
}
