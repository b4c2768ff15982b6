//! A surface that may touch others: triangles, and on which side of them there is room.

use super::input::{check_finite, vertices_of};
use super::side::Side;
use crate::base::{CellId, Csr, Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle;
use crate::geometry::vector::dot;
use crate::mesh::{Mesh, Surface, cone_volume};
use crate::spatial::NearestTriangle;

/// A surface by its triangles over the points that all bodies share. Open or closed, in one piece or many.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// What reports call it.
    pub name: String,
    /// Its triangles; a closed surface has them counter-clockwise seen from outside, or all of them clockwise.
    pub triangles: Vec<[VertexId; 3]>,
    /// The body is the wall of a room, such as a vessel, and others are within: the sign of its distances is turned.
    pub is_room: bool,
}

impl Body {
    /// Surfaces of a mesh, each with the cells that its triangles are of: the patches that `patches` name, else all its surface cells as one that is called
    /// `name`; of a mesh without surface cells its boundary. Where points of several meshes are one list, those of this one begin at `first`.
    ///
    /// # Errors
    /// When there is no such patch, no surface at all, or a point of it without a finite place.
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
            let body = Self { name: name.to_owned(), triangles: triangles.collect(), is_room: false };
            (body, of.map(|t| surface.triangle_to_cell[t]).collect())
        };
        if patches.is_empty() {
            return Ok(vec![body(name, None)]);
        }
        patches.iter().map(|patch| Ok(body(patch, Some(mesh.find_patch(patch)?)))).collect()
    }
}

/// A body with all that does not change when points move, and its tree.
#[derive(Clone, Debug)]
pub(super) struct Prepared {
    pub(super) name: String,
    pub(super) triangles: Vec<[VertexId; 3]>,
    pub(super) is_closed: bool,
    pub(super) is_room: bool,
    /// Its vertices, rising.
    pub(super) vertices: Vec<VertexId>,
    /// The vertices of each triangle, by their places in that list.
    pub(super) places: Vec<[u32; 3]>,
    /// The triangles of each of its vertices, by their places in the lists.
    pub(super) stars: Csr<u32>,
    /// Whether each of its vertices is on an edge that one triangle alone uses, where [`get_ready_to_face`](Self::get_ready_to_face) was called.
    pub(super) is_rim: Vec<bool>,
    pub(super) free: Side,
    /// Unit normals of the triangles, where that was called.
    normals: Vec<Point>,
    pub(super) tree: NearestTriangle,
}

impl Prepared {
    pub(super) fn new(body: Body, points: &[Point], threads: &Threads) -> Result<Self> {
        let Body { name, triangles, is_room } = body;
        let vertices = vertices_of(&format!("surface {name}"), &triangles, points)?;
        let mut place = vec![0; points.len()];
        vertices.iter().zip(0..).for_each(|(v, k)| place[v.index()] = k);
        let places: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(|v| place[v.index()])).collect();
        let stars = Csr::from_pairs(vertices.len(), || {
            (0..).zip(&places).flat_map(|(i, t): (u32, _)| t.iter().map(move |&v| (v as usize, i)))
        });
        let is_closed = super::inside::is_closed(&triangles);
        let tree = NearestTriangle::new(points, &triangles, threads);
        let mut body = Self {
            name,
            triangles,
            is_closed,
            is_room,
            vertices,
            places,
            stars,
            is_rim: Vec::new(),
            free: Side::Both,
            normals: Vec::new(),
            tree,
        };
        body.free = body.free_side(points);
        Ok(body)
    }

    /// # Errors
    /// When a point of the body is not finite.
    pub(super) fn check(&self, points: &[Point]) -> Result<()> {
        check_finite(&format!("surface {}", self.name), self.vertices.iter().copied(), points)
    }

    /// Takes over points that moved.
    pub(super) fn refit(&mut self, points: &[Point], threads: &Threads) {
        self.tree.refit(points, threads);
        self.free = self.free_side(points);
        if !self.normals.is_empty() {
            self.keep_normals(points);
        }
    }

    /// Works out what tells which ways lead into free space: the rim, and all normals, now and whenever points move.
    pub(super) fn get_ready_to_face(&mut self, points: &[Point]) {
        self.is_rim = rim(&self.places, self.vertices.len());
        self.keep_normals(points);
    }

    fn keep_normals(&mut self, points: &[Point]) {
        self.normals = (0..self.triangles.len() as u32).map(|t| self.unit_normal(points, t)).collect();
    }

    pub(super) fn corners(&self, points: &[Point], triangle: u32) -> [Point; 3] {
        self.triangles[triangle as usize].map(|v| points[v.index()])
    }

    /// Whether the bodies have a vertex in common.
    pub(super) fn is_joined(&self, other: &Self) -> bool {
        let (few, many) = match self.vertices.len() <= other.vertices.len() {
            true => (&self.vertices, &other.vertices),
            false => (&other.vertices, &self.vertices),
        };
        few.iter().any(|v| many.binary_search(v).is_ok())
    }

    /// Outside a closed body, inside a room; on both sides of an open one.
    fn free_side(&self, points: &[Point]) -> Side {
        if !self.is_closed {
            return Side::Both;
        }
        let origin = points[self.vertices[0].index()];
        let volume: f64 = self.triangles.iter().map(|t| cone_volume(t.iter().copied(), points, origin)).sum();
        match (volume >= 0.0) != self.is_room {
            true => Side::Outside,
            false => Side::Inside,
        }
    }

    /// The unit normal of a triangle; zero where it has no area.
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
        // In units of the largest: squares of areas of small triangles underflow.
        let area = area.map(|x| x / largest);
        area.map(|x| x / dot(area, area).sqrt())
    }
}

/// Which vertices are on an edge that one triangle alone uses.
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
