//! The mesh as it was given: in which of its tets a place lies, and what fields of its vertices are there.

use std::cell::Cell;
use std::sync::Arc;

use crate::base::{Point, TetId, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::vector::dot;
use crate::geometry::weights;
use crate::kernel::{Complex, VertexChange};
use crate::mesh::TetMesh;
use crate::spatial::{Bounds, BoxTree};

/// The tets of a mesh before anything changes, to be searched.
#[derive(Debug)]
pub(super) struct Given {
    tree: BoxTree,
    points: Vec<Point>,
    tets: Vec<[VertexId; 4]>,
}

impl Given {
    pub(super) fn new(mesh: &TetMesh) -> Self {
        let boxes: Vec<Bounds> =
            mesh.tets.iter().map(|tet| around(tet.map(|v| mesh.points[v.index()]))).collect();
        Self { tree: BoxTree::new(&boxes), points: mesh.points.clone(), tets: mesh.tets.clone() }
    }

    /// Where each vertex was.
    pub(super) fn points(&self) -> &[Point] {
        &self.points
    }

    /// The vertices of the tet that holds a point, the first of those that do, and the weights that make the point of them; of the nearest tet where none does. `None`: there is no tet.
    pub(super) fn at(&self, point: Point) -> Option<([VertexId; 4], [f64; 4])> {
        let measure = |id: u32| {
            let tet = self.tets[id as usize].map(|v| self.points[v.index()]);
            let weights = weights(tet, point)
                .or_else(|| weights([tet[0], tet[1], tet[3], tet[2]], point).map(swapped))?;
            let mut off = point;
            for (corner, weight) in tet.iter().zip(weights) {
                (0..3).for_each(|k| off[k] -= weight * corner[k]);
            }
            Some((dot(off, off), weights))
        };
        let (_, id, weights) = self.tree.nearest(point, measure)?;
        Some((self.tets[id as usize], weights))
    }
}

fn swapped([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [a, b, d, c]
}

fn around(tet: [Point; 4]) -> Bounds {
    let fold = |f: fn(f64, f64) -> f64| [0, 1, 2].map(|k| tet.iter().map(|p| p[k]).fold(tet[0][k], f));
    [fold(f64::min), fold(f64::max)]
}

/// The mesh at other times of its motion, when it is to be good as well.
#[derive(Debug)]
pub(super) struct Poses {
    given: Arc<Given>,
    poses: Vec<Pose>,
}

/// Where vertices are at one of these times.
#[derive(Debug)]
struct Pose {
    /// Each vertex as it was given.
    of_given: Vec<Point>,
    /// Each vertex as it is.
    points: Vec<Point>,
    /// EAS of each tet; no number until somebody has asked.
    qualities: Vec<Cell<f64>>,
}

impl Poses {
    /// `poses`: each has the place of every vertex that was given.
    pub(super) fn new(given: Arc<Given>, poses: Vec<Vec<Point>>) -> Self {
        let pose = |of_given: Vec<Point>| Pose { points: of_given.clone(), of_given, qualities: Vec::new() };
        Self { given, poses: poses.into_iter().map(pose).collect() }
    }

    /// How many there are.
    #[inline]
    pub(super) fn len(&self) -> usize {
        self.poses.len()
    }

    /// Follows all that has changed.
    pub(super) fn update(&mut self, complex: &Complex) {
        if self.poses.is_empty() {
            return;
        }
        for pose in &mut self.poses {
            pose.points.resize(complex.n_vertex_slots(), [f64::NAN; 3]);
            pose.qualities.clear();
            pose.qualities.resize(complex.n_slots(), Cell::new(f64::NAN));
        }
        for v in (0..complex.n_vertex_slots()).map(VertexId::new) {
            self.follow_vertex(complex, v);
        }
    }

    /// Follows a change that inserted tets.
    pub(super) fn follow(&mut self, complex: &Complex, vertex: VertexChange, inserted: &[TetId]) {
        if self.poses.is_empty() {
            return;
        }
        if let VertexChange::Move(vertex, _) = vertex {
            self.follow_vertex(complex, vertex);
        }
        for pose in &mut self.poses {
            pose.qualities.resize(complex.n_slots(), Cell::new(f64::NAN));
            inserted.iter().for_each(|tet| pose.qualities[tet.index()].set(f64::NAN));
        }
    }

    /// Where a vertex is in a pose.
    #[inline]
    pub(super) fn point(&self, pose: usize, vertex: VertexId) -> Point {
        self.poses[pose].points[vertex.index()]
    }

    /// EAS of a tet in a pose.
    #[inline]
    pub(super) fn quality(&self, pose: usize, complex: &Complex, tet: TetId) -> f64 {
        let pose = &self.poses[pose];
        let known = &pose.qualities[tet.index()];
        if known.get().is_nan() {
            known.set(eas(complex.vertices(tet).map(|v| pose.points[v.index()])));
        }
        known.get()
    }

    /// A vertex that was inserted or has moved is where its place in the mesh that was given goes.
    fn follow_vertex(&mut self, complex: &Complex, vertex: VertexId) {
        let (v, place) = (vertex.index(), complex.point(vertex));
        if self.given.points().get(v) == Some(&place) {
            self.poses.iter_mut().for_each(|pose| pose.points[v] = pose.of_given[v]);
            return;
        }
        let at = self.given.at(place);
        for pose in &mut self.poses {
            pose.points[v] = at.map_or(place, |(vertices, weights)| {
                let mut point = [0.0; 3];
                for (vertex, weight) in vertices.into_iter().zip(weights) {
                    (0..3).for_each(|k| point[k] += weight * pose.of_given[vertex.index()][k]);
                }
                point
            });
        }
    }
}
