//! The mesh as it was given: finds the tet that held a point, and interpolates values at its vertices.

use crate::base::{Point, TetId, Threads, VertexId};
use crate::geometry::quality::{eas, eas_of_each};
use crate::geometry::vector::{add, dot, scale, sub};
use crate::geometry::weights;
use crate::kernel::{Complex, VertexChange};
use crate::mesh::TetMesh;
use crate::spatial::{GrowingBoxes, bounding_box};

/// The mesh before anything has changed, with the tets that changes have removed in a search table: what is
/// inserted or moved lies where they were.
#[derive(Debug)]
pub(super) struct InputMesh<'a> {
    mesh: &'a TetMesh,
    removed: GrowingBoxes,
    /// Whether removed tets are recorded.
    is_used: bool,
}

impl<'a> InputMesh<'a> {
    /// The mesh as given. Unless it `is_used`, nothing is recorded and no point is found later.
    pub(super) fn new(mesh: &'a TetMesh, is_used: bool) -> Self {
        Self { mesh, removed: GrowingBoxes::default(), is_used }
    }

    /// The position of each vertex.
    pub(super) fn points(&self) -> &'a [Point] {
        &self.mesh.points
    }

    /// Notes that a change removes the tets `cavity` of a complex of the mesh.
    pub(super) fn note_removed(&mut self, complex: &Complex, cavity: &[TetId]) {
        if self.is_used {
            for &tet in cavity.iter().filter(|&&tet| complex.is_original(tet)) {
                self.removed.add(tet.0, bounding_box(self.corners(tet)));
            }
        }
    }

    /// The vertices of the removed tet that contained a point, and its barycentric weights; of the nearest
    /// one if none did. Tets of `cavity`, which a change of `complex` would remove, count as removed. `None`
    /// if there are no such tets.
    pub(super) fn at(
        &self,
        complex: &Complex,
        point: Point,
        cavity: &[TetId],
    ) -> Option<([VertexId; 4], [f64; 4])> {
        let measure = |id: u32| {
            let tet = self.corners(TetId(id));
            let weights = weights(tet, point)
                .or_else(|| weights([tet[0], tet[1], tet[3], tet[2]], point).map(swapped))?;
            let pairs = tet.into_iter().zip(weights);
            let off = pairs.fold(point, |off, (corner, weight)| sub(off, scale(corner, weight)));
            Some((dot(off, off), weights))
        };
        let mut best = self.removed.nearest(point, measure);
        for &tet in cavity.iter().filter(|&&tet| complex.is_original(tet)) {
            if let Some((off, weights)) = measure(tet.0)
                && best.as_ref().is_none_or(|best| (off, tet.0) < (best.0, best.1))
            {
                best = Some((off, tet.0, weights));
            }
        }
        best.map(|(_, id, weights)| (self.mesh.tets[id as usize], weights))
    }

    fn corners(&self, tet: TetId) -> [Point; 4] {
        self.mesh.tets[tet.index()].map(|v| self.mesh.points[v.index()])
    }
}

fn swapped([a, b, c, d]: [f64; 4]) -> [f64; 4] {
    [a, b, d, c]
}

/// The mesh in another pose, with its vertices at other places: when the walls are at rest, or after the next
/// step. Tets are to be good there, too.
#[derive(Debug)]
pub(super) struct Pose {
    /// Position in this pose of each vertex of the given mesh.
    input_points: Vec<Point>,
    /// Position in this pose of each vertex of the mesh as it is now.
    points: Vec<Point>,
    /// EAS of each tet.
    qualities: Vec<f64>,
}

/// The number of tets that a thread judges at a time.
const CHUNK: usize = 1 << 13;

impl Pose {
    /// A pose in which each vertex of the given mesh is at `input_points`.
    pub(super) fn new(input_points: Vec<Point>) -> Self {
        Self { points: input_points.clone(), input_points, qualities: Vec::new() }
    }

    /// Updates the pose after any number of changes.
    pub(super) fn update(&mut self, complex: &Complex, input: &InputMesh, threads: &Threads) {
        self.points = threads.map(complex.n_vertex_slots(), |v| self.place(complex, input, VertexId::new(v)));
        self.qualities = threads.in_runs(complex.n_slots(), CHUNK, |(): &mut (), run| {
            // Free slots hold no tet.
            let vertices =
                |tet: TetId| if complex.is_alive(tet) { complex.vertices(tet) } else { [VertexId(0); 4] };
            eas_of_each(&self.points, &run.map(TetId::new).map(vertices).collect::<Vec<_>>())
        });
    }

    /// Updates the pose after one change that inserted these tets.
    pub(super) fn follow(
        &mut self,
        complex: &Complex,
        input: &InputMesh,
        vertex: VertexChange,
        inserted: &[TetId],
    ) {
        if let VertexChange::Move(vertex, _) = vertex {
            self.points[vertex.index()] = self.place(complex, input, vertex);
        }
        self.qualities.resize(complex.n_slots(), 0.0);
        for &tet in inserted {
            self.qualities[tet.index()] = eas(complex.vertices(tet).map(|v| self.point(v)));
        }
    }

    /// The position of a vertex in this pose.
    #[inline]
    pub(super) fn point(&self, vertex: VertexId) -> Point {
        self.points[vertex.index()]
    }

    /// EAS of a tet in this pose.
    #[inline]
    pub(super) fn quality(&self, tet: TetId) -> f64 {
        self.qualities[tet.index()]
    }

    /// The position of a vertex in this pose: one that was inserted or moved is interpolated in the tet of
    /// the given mesh that contains it.
    fn place(&self, complex: &Complex, input: &InputMesh, vertex: VertexId) -> Point {
        let place = complex.point(vertex);
        if input.points().get(vertex.index()) == Some(&place) {
            return self.input_points[vertex.index()];
        }
        let Some((vertices, weights)) = input.at(complex, place, &[]) else { return place };
        vertices.into_iter().zip(weights).fold([0.0; 3], |sum, (vertex, weight)| {
            add(sum, scale(self.input_points[vertex.index()], weight))
        })
    }
}
