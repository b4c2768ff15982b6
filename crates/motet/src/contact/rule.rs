//! Which places count as a gap, and which are only neighbours or lie behind a wall.

use super::body::{BodyView, PreparedBody};
use super::facing::{Place, Sight, may_face, see_each_other};
use super::options::Options;
use super::surface_graph::{PathEnd, PathSearch, SurfaceGraph};
use crate::base::{Point, VertexId};
use crate::geometry::distance::Closest;
use crate::geometry::triangle;
use crate::geometry::vector::{distance, dot, sub};
use crate::spatial;

/// How two bodies are compared. Nothing is left out between bodies that share no vertex, unless requested.
#[derive(Clone, Copy)]
pub(super) struct Rule<'a> {
    pub(super) points: &'a [Point],
    pub(super) a: BodyView<'a>,
    pub(super) b: BodyView<'a>,
    /// Paths along the surface, if the bodies have vertices in common.
    graph: Option<&'a SurfaceGraph>,
    facing: bool,
    fold: f64,
}

impl<'a> Rule<'a> {
    pub(super) fn new(
        points: &'a [Point],
        [a, b]: [BodyView<'a>; 2],
        graph: Option<&'a SurfaceGraph>,
        options: &Options,
    ) -> Self {
        Self { points, a, b, graph, facing: options.facing || graph.is_some(), fold: options.fold }
    }

    /// Whether everything counts.
    pub(super) fn admits_all(&self) -> bool {
        !self.facing
    }

    /// A function that decides whether triangles of the second body count as near to one vertex of the first.
    pub(super) fn at_vertex(
        self,
        place: usize,
        paths: &mut PathSearch,
    ) -> impl FnMut(u32, &spatial::Closest) -> bool {
        let vertex = self.a.ids[place];
        let start = self.points[self.a.vertices[place].index()];
        let sight = Sight::new(self.points, self.a, place);
        move |j, found| {
            let corners = self.b.joined[j as usize];
            if self.graph.is_some() && corners.contains(&vertex) {
                return false;
            }
            let way = sub(found.point, start);
            let place = Place { body: self.b, triangle: j, weights: found.weights };
            if !sight.sees(self.points, place, way) {
                return false;
            }
            if self.is_in_one_triangle(&[vertex], &held(corners, found.weights)) {
                return false;
            }
            let length = self.fold * found.distance_squared.sqrt();
            self.is_gap(vertex, PathEnd { corners, place: found.point }, length, paths)
        }
    }

    /// Whether some triangle has all these vertices: places on them are neighbours, however long the path
    /// along its edges.
    fn is_in_one_triangle(&self, own: &[VertexId], other: &[VertexId]) -> bool {
        let is_all_of = |body: &PreparedBody, t: u32| {
            own.iter().chain(other).all(|v| body.joined[t as usize].contains(v))
        };
        self.graph.is_some()
            && [self.a, self.b].into_iter().any(|body| {
                let place = own.first().and_then(|v| body.places_of(*v).next());
                place.is_some_and(|place| body.star(place).iter().any(|&t| is_all_of(&body, t)))
            })
    }

    /// The distance of a vertex of the first body from a triangle of the second; `None` if that does not
    /// count.
    pub(super) fn distance(&self, place: usize, j: u32, paths: &mut PathSearch) -> Option<f64> {
        let p = self.points[self.a.vertices[place].index()];
        let corners = self.b.triangles.get(j as usize)?.map(|v| self.points[v.index()]);
        let weights = triangle::closest(corners, p);
        let point = triangle::at(corners, weights);
        let off = sub(point, p);
        let distance_squared = dot(off, off);
        let found = spatial::Closest { triangle: j as usize, weights, point, distance_squared };
        self.at_vertex(place, paths)(j, &found).then(|| distance_squared.sqrt())
    }

    /// Whether a place is farther than `length` along the surface.
    fn is_gap(&self, from: VertexId, to: PathEnd, length: f64, paths: &mut PathSearch) -> bool {
        self.graph.is_none_or(|graph| !graph.is_within(self.points, from, to, length, paths))
    }

    /// Whether two triangles count as near to each other.
    pub(super) fn admits(&self, [i, j]: [u32; 2], found: &Closest<3, 3>, paths: &mut PathSearch) -> bool {
        if self.admits_all() {
            return true;
        }
        let (own, other) = (self.a.joined[i as usize], self.b.joined[j as usize]);
        let from = triangle::at(self.a.corners(self.points, i), found.on_a);
        let to = triangle::at(self.b.corners(self.points, j), found.on_b);
        let place_a = Place { body: self.a, triangle: i, weights: found.on_a };
        let place_b = Place { body: self.b, triangle: j, weights: found.on_b };
        if !see_each_other(self.points, place_a, place_b, sub(to, from)) {
            return false;
        }
        if self.is_in_one_triangle(&held(own, found.on_a), &held(other, found.on_b)) {
            return false;
        }
        let heaviest = (1..3).fold(0, |best, k| if found.on_a[k] > found.on_a[best] { k } else { best });
        let first = distance(from, self.points[own[heaviest].index()]);
        let end = PathEnd { corners: other, place: to };
        self.is_gap(own[heaviest], end, self.fold * found.distance() - first, paths)
    }

    /// Whether two triangles are worth measuring: not the same, without a common vertex, and not turned away
    /// from each other.
    pub(super) fn may_admit(&self, [i, j]: [u32; 2]) -> bool {
        let (own, other) = (self.a.joined[i as usize], self.b.joined[j as usize]);
        let is_joined = self.graph.is_some() && own.iter().any(|v| other.contains(v));
        !is_joined && (!self.facing || may_face(self.points, [self.a, self.b], [i, j]))
    }
}

/// The vertices whose weights are not 0.
fn held(corners: [VertexId; 3], weights: [f64; 3]) -> Vec<VertexId> {
    corners.into_iter().zip(weights).filter(|(_, w)| *w != 0.0).map(|(v, _)| v).collect()
}
