//! Reports on sliding patches: how flat they are, and where their rims leave the plane.

use serde::Serialize;

use crate::base::{Point, VertexId};
use crate::geometry::vector::dot;
use crate::motion::slide::constraints::SlidingConstraints;

/// A plane in which one patch slides, or several patches side by side.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SlidingPlane {
    /// The names of the patches.
    pub patch: String,
    /// The largest distance of a vertex from the centre, in the unit of the mesh.
    pub radius: f64,
    /// The largest distance of a vertex from the plane, in the unit of the mesh.
    pub deviation: f64,
    /// How many vertices slide in the plane, those on its edges included.
    pub sliding: usize,
}

/// Where the rim of a sliding patch leaves its plane; the patch moves along with it.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[non_exhaustive]
pub struct LeavesPlane {
    /// The names of the patches in the plane.
    pub patch: String,
    /// The vertex of the rim that moves farthest out of the plane.
    pub vertex: VertexId,
    /// The position of that vertex in the reference.
    pub place: Point,
    /// How far it moves at right angles to the plane, in the unit of the mesh.
    pub distance: f64,
    /// Whether that is more than the rounding of single-precision coordinates can cause.
    pub is_significant: bool,
}

/// The driven vertices of a plane in which others slide.
#[derive(Debug)]
pub(crate) struct Rim {
    patch: String,
    normal: Point,
    /// The rounding error of single-precision coordinates.
    rounding: f64,
    nodes: Vec<u32>,
}

impl SlidingConstraints {
    /// The report on each plane.
    pub(crate) fn planes(&self) -> Vec<SlidingPlane> {
        let mut planes: Vec<SlidingPlane> = (self.patch_planes.iter())
            .map(|flat| SlidingPlane {
                patch: flat.set.name.clone(),
                radius: flat.plane.radius,
                deviation: flat.plane.deviation,
                sliding: 0,
            })
            .collect();
        for constraint in &self.constraints {
            constraint
                .planes
                .iter()
                .for_each(|&plane| planes[plane as usize].sliding += constraint.free.len());
        }
        planes
    }

    /// The rim of each plane; `node` returns the node of a vertex.
    pub(crate) fn rims(&self, points: &[Point], node: impl Fn(VertexId) -> u32) -> Vec<Rim> {
        let constraint = self.constraint_of(points.len());
        let is_driven = |v: &VertexId| constraint[v.index()].is_none();
        let rim = |flat: &super::constraints::PatchPlane| {
            let largest = (flat.set.vertices.iter())
                .flat_map(|v| points[v.index()])
                .fold(0.0, |a: f64, x| a.max(x.abs()));
            Rim {
                patch: flat.set.name.clone(),
                normal: flat.plane.normal,
                rounding: f64::from(f32::EPSILON) * (largest + flat.plane.radius),
                nodes: flat.set.vertices.iter().copied().filter(is_driven).map(&node).collect(),
            }
        };
        self.patch_planes.iter().map(rim).collect()
    }
}

/// The vertex of all rims that leaves its plane farthest; `None` where all stay. `vertices` are those of the
/// nodes; `driven` are the displacements of the driven nodes, which come first.
pub(crate) fn worst_departure(
    rims: &[Rim],
    vertices: &[VertexId],
    reference: &[Point],
    driven: &[Point],
) -> Option<LeavesPlane> {
    let mut worst: Option<(f64, &Rim, u32)> = None;
    for rim in rims {
        for &node in &rim.nodes {
            let distance = driven.get(node as usize).map_or(0.0, |&d| dot(d, rim.normal).abs());
            if distance > worst.map_or(0.0, |(worst, ..)| worst) {
                worst = Some((distance, rim, node));
            }
        }
    }
    worst.map(|(distance, rim, node)| {
        let vertex = vertices[node as usize];
        LeavesPlane {
            patch: rim.patch.clone(),
            vertex,
            place: reference[vertex.index()],
            distance,
            is_significant: distance > rim.rounding,
        }
    })
}
