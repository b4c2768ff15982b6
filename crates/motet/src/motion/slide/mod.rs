//! Flat parts of the boundary whose vertices slide: in a plane, or along the line where two planes meet.
//!
//! An inlet is cut across a vessel; when the wall moves, its rim moves along and the vertices between must
//! follow. They are located in the Delaunay triangulation of the vertices around them in the plane, just as
//! inner vertices are located in the one in space. In fact the code is the same: with one more node above the
//! plane, the tets on the plane stand on the triangles of the plane's own Delaunay triangulation (the sphere
//! through a triangle and that node cuts the plane in the triangle's circle).
//!
//! On the line of two planes this holds with one dimension less: a vertex follows the two anchors between
//! which it lies. So an affine motion of the driven vertices is an affine motion of the sliding ones.
//! Displacements are followed as a whole: a vertex that is off its plane stays as far off, and where all of a
//! rim leaves the plane, the patch moves along.
//!
//! A rim that becomes straight flattens the triangles between its own vertices, and the vertices in them with
//! it. A motion in sub-steps therefore triangulates the planes anew at each sub-step, as it does the graph in
//! space.

mod constraints;
mod plane;
mod report;

use crate::base::{Error, Point, Result, Threads, VertexId, rising_list};
use crate::geometry::vector::{add, dot, scale, sub};
use crate::motion::graph::{embed, triangulate};
use crate::motion::slide::constraints::{Constraint, PatchPlane};
use crate::motion::update::Padded;

pub(crate) use constraints::SlidingConstraints;
pub use report::{LeavesPlane, SlidingPlane};
pub(crate) use report::{Rim, worst_departure};

/// The sliding vertices of one plane or line.
#[derive(Debug)]
pub(crate) struct Slide {
    directions: SlideDirections,
    /// Nodes of the sliding vertices.
    pub(crate) sliding: Vec<u32>,
    /// For each of these, the nodes that it follows and their weights.
    follows: Vec<([u32; 4], [f64; 4])>,
}

/// The directions in which sliding vertices can move.
#[derive(Clone, Copy, Debug)]
enum SlideDirections {
    /// At right angles to this unit vector.
    Plane(Point),
    /// Along this unit vector.
    Line(Point),
}

/// A facet by its corners, whatever their order.
type Key = Vec<VertexId>;

pub(crate) fn key(ring: &[VertexId]) -> Key {
    rising_list(ring)
}

impl Slide {
    /// Makes the free vertices for which `is_sliding` holds follow the others of their planes; `node` returns
    /// the node of a vertex.
    ///
    /// # Errors
    /// When the vertices of a plane have fewer than three to follow, or all of these lie on a line.
    pub(crate) fn new(
        points: &[Point],
        patch_planes: &[PatchPlane],
        constraint: &Constraint,
        is_sliding: impl Fn(VertexId) -> bool,
        node: impl Fn(VertexId) -> u32,
        threads: &Threads,
    ) -> Result<Self> {
        let (sliding, fixed): (Vec<VertexId>, Vec<VertexId>) =
            constraint.free.iter().copied().partition(|&v| is_sliding(v));
        let flat = &patch_planes[constraint.planes[0] as usize];
        let (directions, follows) = match constraint.along {
            Some(along) => {
                let sources: Vec<VertexId> = constraint.anchors.iter().chain(&fixed).copied().collect();
                (SlideDirections::Line(along), on_line(points, along, &sources, &sliding))
            }
            None => (SlideDirections::Plane(flat.plane.normal), in_plane(points, flat, &sliding, threads)?),
        };
        let nodes = |(of, weights): ([VertexId; 4], [f64; 4])| (of.map(&node), weights);
        Ok(Self {
            directions,
            sliding: sliding.iter().map(|&v| node(v)).collect(),
            follows: follows.into_iter().map(nodes).collect(),
        })
    }

    pub(crate) fn n_sliding(&self) -> usize {
        self.sliding.len()
    }

    /// The component of a displacement out of the plane, or off the line.
    pub(crate) fn normal_component(&self, d: Point) -> Point {
        match self.directions {
            SlideDirections::Plane(normal) => scale(normal, dot(d, normal)),
            SlideDirections::Line(along) => sub(d, scale(along, dot(d, along))),
        }
    }

    /// Computes the displacements of the sliding nodes; `start` is the displacement of a node where the
    /// weights were computed.
    pub(crate) fn apply(&self, start: impl Fn(u32) -> Point, displacement: &mut [Padded]) {
        for (&sliding, (nodes, weights)) in self.sliding.iter().zip(&self.follows) {
            let change = |node: u32| sub(displacement[node as usize].point(), start(node));
            let sum = nodes
                .iter()
                .zip(weights)
                .fold([0.0; 3], |sum, (&node, &weight)| add(sum, scale(change(node), weight)));
            displacement[sliding as usize] = Padded::new(add(start(sliding), sum));
        }
    }
}

/// What each of `sliding` follows: a triangle of the Delaunay triangulation of the other vertices in the
/// plane.
fn in_plane(
    points: &[Point],
    PatchPlane { set, plane }: &PatchPlane,
    sliding: &[VertexId],
    threads: &Threads,
) -> Result<Vec<([VertexId; 4], [f64; 4])>> {
    let place = |v: &VertexId| points[v.index()];
    let sources: Vec<VertexId> =
        set.vertices.iter().copied().filter(|v| sliding.binary_search(v).is_err()).collect();
    let mut nodes: Vec<Point> = sources.iter().map(|v| plane.flatten(place(v))).collect();
    nodes.push([0.0, 0.0, plane.radius]);
    let flat: Vec<Point> = sliding.iter().map(|v| plane.flatten(place(v))).collect();
    let graph = triangulate(&nodes, threads).map_err(|_| {
        Error::input(format!(
            "at least {} vertices on its rim that are not collinear are needed; it has {}",
            3,
            sources.len()
        ))
        .at(format!("sliding patch {}", set.name))
    })?;
    let embedding = embed(&graph, &flat, threads);
    // The node above the plane has no weight for a point in it; any node can take its place.
    let vertex = |i: u32| sources.get(i as usize).copied().unwrap_or(sources[0]);
    let above = sources.len() as u32;
    let follows = embedding.tet.iter().zip(&embedding.weights).map(|(&tet, weights)| {
        let tet = embedding.tets[tet as usize];
        let mut weights = *weights;
        (0..4).filter(|&i| tet[i] == above).for_each(|i| weights[i] = 0.0);
        (tet.map(vertex), weights)
    });
    Ok(follows.collect())
}

/// What each of `sliding` follows: the nearest source on either side along the line, or the last one at an
/// end of it.
fn on_line(
    points: &[Point],
    along: Point,
    sources: &[VertexId],
    sliding: &[VertexId],
) -> Vec<([VertexId; 4], [f64; 4])> {
    // Measured from a place on the line, so that no digits are lost far from the origin.
    let origin = points[sources[0].index()];
    let at = |v: VertexId| dot(sub(points[v.index()], origin), along);
    let mut sorted: Vec<(f64, VertexId)> = sources.iter().map(|&v| (at(v), v)).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let follow = |&v: &VertexId| {
        let x = at(v);
        let next = sorted.partition_point(|(source, _)| *source <= x);
        let (low, a) = sorted[next.saturating_sub(1)];
        let (high, b) = sorted[next.min(sorted.len() - 1)];
        let part = if high > low { ((x - low) / (high - low)).clamp(0.0, 1.0) } else { 0.0 };
        ([a, b, a, a], [1.0 - part, part, 0.0, 0.0])
    };
    sliding.iter().map(follow).collect()
}
