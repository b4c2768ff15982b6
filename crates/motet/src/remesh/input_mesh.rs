//! The mesh as it was given: finds the tet that contains a point, and interpolates values at its vertices.

use std::sync::Arc;

use crate::base::{Kept, Point, TetId, Threads, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::vector::{add, dot, scale, sub};
use crate::geometry::weights;
use crate::kernel::{Complex, VertexChange};
use crate::mesh::TetMesh;
use crate::spatial::{Bounds, BoxTree, bounding_box};

/// The tets of a mesh before anything changes, in a search tree.
#[derive(Debug)]
pub(super) struct InputMesh {
    tree: BoxTree,
    points: Vec<Point>,
    tets: Vec<[VertexId; 4]>,
}

impl InputMesh {
    pub(super) fn new(mesh: &TetMesh) -> Self {
        let boxes: Vec<Bounds> =
            mesh.tets.iter().map(|tet| bounding_box(tet.map(|v| mesh.points[v.index()]))).collect();
        Self { tree: BoxTree::new(&boxes), points: mesh.points.clone(), tets: mesh.tets.clone() }
    }

    /// The position of each vertex.
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    /// The vertices of the first tet that contains a point, and its barycentric weights; of the nearest tet
    /// if none does. `None` if there are no tets.
    pub(super) fn at(&self, point: Point) -> Option<([VertexId; 4], [f64; 4])> {
        let measure = |id: u32| {
            let tet = self.tets[id as usize].map(|v| self.points[v.index()]);
            let weights = weights(tet, point)
                .or_else(|| weights([tet[0], tet[1], tet[3], tet[2]], point).map(swapped))?;
            let pairs = tet.into_iter().zip(weights);
            let off = pairs.fold(point, |off, (corner, weight)| sub(off, scale(corner, weight)));
            Some((dot(off, off), weights))
        };
        let (_, id, weights) = self.tree.nearest(point, measure)?;
        Some((self.tets[id as usize], weights))
    }
}

fn swapped([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [a, b, d, c]
}

/// The mesh in another pose, with its vertices at other places: when the walls are at rest, or after the next
/// step. Tets are to be good there, too.
#[derive(Debug)]
pub(super) struct Pose {
    input: Arc<InputMesh>,
    /// Position in this pose of each vertex of the given mesh.
    input_points: Vec<Point>,
    /// Position in this pose of each vertex of the mesh as it is now.
    points: Vec<Point>,
    /// EAS of each tet; NaN until it is first requested.
    qualities: Vec<Kept>,
}

impl Pose {
    /// A pose in which each vertex of the given mesh is at `input_points`.
    pub(super) fn new(input: Arc<InputMesh>, input_points: Vec<Point>) -> Self {
        Self { input, points: input_points.clone(), input_points, qualities: Vec::new() }
    }

    /// Updates the pose after any number of changes.
    pub(super) fn update(&mut self, complex: &Complex, threads: &Threads) {
        self.points = threads.map(complex.n_vertex_slots(), |v| self.place(complex, VertexId::new(v)));
        self.qualities.clear();
        self.qualities.resize(complex.n_slots(), Kept::new(f64::NAN));
    }

    /// Updates the pose after one change that inserted these tets.
    pub(super) fn follow(&mut self, complex: &Complex, vertex: VertexChange, inserted: &[TetId]) {
        if let VertexChange::Move(vertex, _) = vertex {
            self.points[vertex.index()] = self.place(complex, vertex);
        }
        self.qualities.resize(complex.n_slots(), Kept::new(f64::NAN));
        inserted.iter().for_each(|tet| self.qualities[tet.index()].set(f64::NAN));
    }

    /// The position of a vertex in this pose.
    #[inline]
    pub(super) fn point(&self, vertex: VertexId) -> Point {
        self.points[vertex.index()]
    }

    /// EAS of a tet in this pose.
    #[inline]
    pub(super) fn quality(&self, complex: &Complex, tet: TetId) -> f64 {
        let known = &self.qualities[tet.index()];
        if known.get().is_nan() {
            known.set(eas(complex.vertices(tet).map(|v| self.point(v))));
        }
        known.get()
    }

    /// The position of a vertex in this pose: one that was inserted or moved is interpolated in the tet of
    /// the given mesh that contains it.
    fn place(&self, complex: &Complex, vertex: VertexId) -> Point {
        let place = complex.point(vertex);
        if self.input.points().get(vertex.index()) == Some(&place) {
            return self.input_points[vertex.index()];
        }
        let Some((vertices, weights)) = self.input.at(place) else { return place };
        vertices.into_iter().zip(weights).fold([0.0; 3], |sum, (vertex, weight)| {
            add(sum, scale(self.input_points[vertex.index()], weight))
        })
    }
}
