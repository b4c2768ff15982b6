//! A surface that may touch others: its triangles, and on which side of them its gaps are.

use std::ops::Deref;

use super::input::check_finite;
use super::side::Side;
use crate::base::{BodyId, CellId, Csr, Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle;
use crate::geometry::vector::dot;
use crate::mesh::{Mesh, Surface, cone_volume};
use crate::spatial::NearestTriangle;

/// A surface, as triangles over the points that all bodies share. It may be open or closed, in one piece or
/// many.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// The name of the body in reports.
    pub name: String,
    /// The triangles of the body; those of a closed surface are all counter-clockwise seen from outside, or
    /// all clockwise.
    pub triangles: Vec<[VertexId; 3]>,
    /// Whether it is the wall of a room, such as a vessel, that contains others. Detected by default.
    pub room: Room,
}

/// Whether a body is the wall of a room that contains others: the sign of its distances to these is reversed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Room {
    /// Of each body most of whose area it encloses at first, if it is closed and does not lie in that body
    /// likewise. The default.
    #[default]
    Found,
    /// Of no body.
    No,
    /// Of all other bodies, except for rooms that enclose it.
    Yes,
    /// Of these bodies.
    Of(Vec<BodyId>),
}

impl Body {
    /// The surfaces of a mesh, each with the cells that its triangles belong to: the patches named by
    /// `patches`; without names, all its surface cells as one body called `name`, or the boundary of a mesh
    /// without surface cells. If points of several meshes are one list, those of this mesh begin at `first`.
    ///
    /// # Errors
    /// When there is no such patch, no surface at all, or one of its points is not finite.
    pub fn of_mesh(
        mesh: &Mesh,
        name: &str,
        patches: &[String],
        first: usize,
    ) -> Result<Vec<(Self, Vec<CellId>)>> {
        let surface = Surface::own_or_boundary_of(mesh);
        if surface.triangles.is_empty() {
            return Err(Error::input(
                "has no surface: neither surface cells nor volume cells with a boundary",
            )
            .remedy("give triangles or other surface cells"));
        }
        check_finite(name, surface.triangles.as_flattened().iter().copied(), &mesh.points)?;
        let body = |name: &str, patch: Option<i32>| {
            let of =
                (0..surface.triangles.len()).filter(|&t| patch.is_none_or(|id| surface.patches[t] == id));
            let triangles =
                of.clone().map(|t| surface.triangles[t].map(|v| VertexId::new(first + v.index())));
            let body = Self { name: name.to_owned(), triangles: triangles.collect(), room: Room::default() };
            (body, of.map(|t| surface.triangle_to_cell[t]).collect())
        };
        if patches.is_empty() {
            return Ok(vec![body(name, None)]);
        }
        patches.iter().map(|patch| Ok(body(patch, Some(mesh.find_patch(patch)?)))).collect()
    }
}

/// A body with all that does not change when points move, and its search tree.
///
/// Connectivity is that of `joined`, in which vertices repeated by [seams](fn@crate::mesh::seams) are one, so
/// answers do not depend on how a file numbers a surface. Places and answers are those of the vertices as
/// they were given.
#[derive(Clone, Debug)]
pub(super) struct PreparedBody {
    pub(super) name: String,
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// The triangles of the body with joined ids: vertices that are one at a seam share theirs.
    pub(super) joined: Vec<[VertexId; 3]>,
    pub(super) is_closed: bool,
    /// The vertices of the body, in ascending order.
    pub(super) vertices: Vec<VertexId>,
    /// The joined id of each vertex.
    pub(super) ids: Vec<VertexId>,
    /// Each joined id with the index of its vertex in the list of vertices, in ascending order.
    by_id: Vec<(VertexId, u32)>,
    /// The vertices of each triangle, as indices into the list of vertices.
    pub(super) places: Vec<[u32; 3]>,
    /// The triangles at each vertex, stored for the first vertex with the same joined id.
    stars: Csr<u32>,
    /// For each vertex, the index of the first one with the same joined id.
    first_places: Vec<u32>,
    /// Whether each vertex is on an edge that only one triangle uses; empty unless
    /// [`prepare_facing`](Self::prepare_facing) was called.
    pub(super) is_rim: Vec<bool>,
    /// On which side of its triangles the outside of a closed body is.
    outside: Side,
    /// Unit normals of the triangles; empty unless that was called.
    normals: Vec<Point>,
    pub(super) tree: NearestTriangle,
}

/// A body as seen by another one.
#[derive(Clone, Copy)]
pub(super) struct BodyView<'a> {
    pub(super) body: &'a PreparedBody,
    /// Where the other one may be: outside a closed body, inside a room, on both sides of an open one.
    pub(super) free: Side,
    /// Whether the body is the room of the other one.
    pub(super) is_room: bool,
}

impl Deref for BodyView<'_> {
    type Target = PreparedBody;

    fn deref(&self) -> &PreparedBody {
        self.body
    }
}

impl PreparedBody {
    /// `vertices` are those of the body, in ascending order; `joined` gives the joined id of every point.
    pub(super) fn new(
        body: Body,
        vertices: Vec<VertexId>,
        points: &[Point],
        joined: &[VertexId],
        threads: &Threads,
    ) -> Self {
        let Body { name, triangles, .. } = body;
        let mut place = vec![0; points.len()];
        vertices.iter().zip(0..).for_each(|(v, k)| place[v.index()] = k);
        let places: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| place[v.index()])).collect();
        let ids: Vec<VertexId> = vertices.iter().map(|v| joined[v.index()]).collect();
        let mut by_id: Vec<(VertexId, u32)> = ids.iter().copied().zip(0..).collect();
        by_id.sort_unstable();
        let mut first_places = vec![0; vertices.len()];
        for same in by_id.chunk_by(|x, y| x.0 == y.0) {
            same.iter().for_each(|(_, k)| first_places[*k as usize] = same[0].1);
        }
        let stars = Csr::from_pairs(vertices.len(), || {
            (0..).zip(&places).flat_map(|(i, t): (u32, _)| {
                t.iter().map(|&k| first_places[k as usize] as usize).map(move |k| (k, i))
            })
        });
        let joined: Vec<[VertexId; 3]> = triangles.iter().map(|t| t.map(|v| joined[v.index()])).collect();
        let is_closed = super::inside::is_closed(&joined);
        let tree = NearestTriangle::new(points, &triangles, threads);
        let mut body = Self {
            name,
            triangles,
            joined,
            is_closed,
            vertices,
            ids,
            by_id,
            places,
            stars,
            first_places,
            is_rim: Vec::new(),
            outside: Side::Both,
            normals: Vec::new(),
            tree,
        };
        body.outside = body.outside(points);
        body
    }

    /// The body as seen by another one, or by itself; `is_room` if it is the room of that one.
    pub(super) fn view(&self, is_room: bool) -> BodyView<'_> {
        let free = if is_room { self.outside.opposite() } else { self.outside };
        BodyView { body: self, free, is_room }
    }

    /// The triangles at a vertex, given by its index in the list of vertices; in ascending order.
    pub(super) fn star(&self, place: usize) -> &[u32] {
        self.stars.list(self.first_places[place] as usize)
    }

    /// For each vertex, the one to use where only its place matters: the joined one as long as both are at
    /// one place.
    pub(super) fn representatives(&self, points: &[Point]) -> Vec<VertexId> {
        let pairs = self.vertices.iter().zip(&self.ids);
        pairs.map(|(&v, &id)| if points[v.index()] == points[id.index()] { id } else { v }).collect()
    }

    /// The indices of the vertices with a joined id.
    pub(super) fn places_of(&self, joined: VertexId) -> impl Iterator<Item = usize> + '_ {
        let from = self.by_id.partition_point(|(v, _)| *v < joined);
        self.by_id[from..].iter().take_while(move |(v, _)| *v == joined).map(|(_, k)| *k as usize)
    }

    /// The joined ids of its vertices, each once, in ascending order.
    pub(super) fn joined_vertices(&self) -> Vec<VertexId> {
        let mut all: Vec<VertexId> = self.by_id.iter().map(|(v, _)| *v).collect();
        all.dedup();
        all
    }

    /// Checks the points of the body.
    ///
    /// # Errors
    /// When one of them is not finite.
    pub(super) fn check(&self, points: &[Point]) -> Result<()> {
        check_finite(&format!("surface {}", self.name), self.vertices.iter().copied(), points)
    }

    /// Takes over points that moved.
    pub(super) fn refit(&mut self, points: &[Point], threads: &Threads) {
        self.tree.refit(points, threads);
        self.outside = self.outside(points);
        if !self.normals.is_empty() {
            self.keep_normals(points);
        }
    }

    /// Computes what decides which directions lead into free space: the rim, and all normals, now and
    /// whenever points move.
    pub(super) fn prepare_facing(&mut self, points: &[Point]) {
        let firsts = |t: &[u32; 3]| t.map(|k| self.first_places[k as usize]);
        let is_rim = rim(&self.places.iter().map(firsts).collect::<Vec<_>>(), self.vertices.len());
        self.is_rim = self.first_places.iter().map(|&k| is_rim[k as usize]).collect();
        self.keep_normals(points);
    }

    fn keep_normals(&mut self, points: &[Point]) {
        self.normals = (0..self.triangles.len() as u32).map(|t| self.unit_normal(points, t)).collect();
    }

    pub(super) fn corners(&self, points: &[Point], triangle: u32) -> [Point; 3] {
        self.triangles[triangle as usize].map(|v| points[v.index()])
    }

    /// Whether the bodies have a vertex in common.
    pub(super) fn shares_vertex_with(&self, other: &Self) -> bool {
        let [few, many] = if self.ids.len() <= other.ids.len() { [self, other] } else { [other, self] };
        few.ids.iter().any(|v| many.places_of(*v).next().is_some())
    }

    /// The outside of a closed body, by the sign of its volume; both sides of an open one.
    fn outside(&self, points: &[Point]) -> Side {
        if !self.is_closed {
            return Side::Both;
        }
        let origin = points[self.vertices[0].index()];
        let volume: f64 = self.triangles.iter().map(|t| cone_volume(t.iter().copied(), points, origin)).sum();
        if volume >= 0.0 { Side::Outside } else { Side::Inside }
    }

    /// The unit normal of a triangle; zero if it has no area.
    pub(super) fn normal(&self, points: &[Point], triangle: u32) -> Point {
        let kept = self.normals.get(triangle as usize);
        kept.copied().unwrap_or_else(|| self.unit_normal(points, triangle))
    }

    fn unit_normal(&self, points: &[Point], triangle: u32) -> Point {
        let area = triangle::area_vector(self.corners(points, triangle));
        let largest = area.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if largest == 0.0 {
            return [0.0; 3];
        }
        // Relative to the largest: squares of areas of small triangles underflow.
        let area = area.map(|x| x / largest);
        area.map(|x| x / dot(area, area).sqrt())
    }
}

/// Which vertices are on an edge that only one triangle uses.
fn rim(triangles: &[[u32; 3]], n_vertices: usize) -> Vec<bool> {
    let edges = |&[a, b, c]: &[u32; 3]| [[a, b], [b, c], [c, a]].map(|[u, v]| [u.min(v), u.max(v)]);
    let mut edges: Vec<[u32; 2]> = triangles.iter().flat_map(edges).collect();
    edges.sort_unstable();
    let mut is_rim = vec![false; n_vertices];
    for same in edges.chunk_by(|x, y| x == y).filter(|same| same.len() == 1) {
        same[0].iter().for_each(|&v| is_rim[v as usize] = true);
    }
    is_rim
}
