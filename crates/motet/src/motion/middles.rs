//! Middle nodes of quadratic cells that stay in the middle of their corners, so that straight edges stay
//! straight.
//!
//! A method moves each vertex independently. The middle node of a straight edge would leave the edge wherever
//! displacements are not linear along it, and a cell whose corners move well would be folded between them.

use crate::base::{Csr, Point, Threads, VertexId};
use crate::geometry::vector::{add, norm, scale, sub};
use crate::mesh::curved::middles;
use crate::mesh::{CellKind, Mesh};

/// Middle nodes, and the corners that each stays between.
#[derive(Debug, Default)]
pub(crate) struct Middles {
    /// In rising order.
    vertices: Vec<VertexId>,
    corners: Csr<VertexId>,
}

/// A node is in the middle when it is off by no more than this fraction of the longest distance between its
/// corners: this allows for an arc that bends by less than a thousandth of a radian, and for coordinates of
/// few digits.
const STRAIGHT_TOLERANCE: f64 = 1e-4;
/// It is also in the middle when it is off by this many roundings of the largest coordinate at most, in the
/// precision of the coordinates.
const ROUNDINGS: f64 = 4.0;

impl Middles {
    /// Finds the middle nodes of a reference mesh that are not prescribed; with `also_curved`, also those of
    /// edges that are not straight, for methods that know corners alone.
    ///
    /// A node that is a corner of another volume cell follows as corners do. If several cells have a node
    /// between different corners, the first counts.
    pub(crate) fn of(mesh: &Mesh, is_prescribed: &[bool], also_curved: bool) -> Self {
        let volumes = || mesh.cells.iter().filter(|(_, kind, _)| kind.dim() == Some(3));
        let of_kind: Vec<_> = (0..=u8::MAX).map(|k| middles(CellKind(k))).collect();
        let mut is_excluded = is_prescribed.to_vec();
        for (_, kind, nodes) in volumes() {
            let n_corners = nodes.len() - of_kind[kind.0 as usize].len();
            nodes[..n_corners].iter().for_each(|v| is_excluded[v.index()] = true);
        }
        let mut found: Vec<(VertexId, Vec<VertexId>)> = Vec::new();
        for (_, kind, nodes) in volumes() {
            for middle in &of_kind[kind.0 as usize] {
                let v = nodes[middle.node];
                let corners = middle.corners.iter().map(|&c| nodes[c]);
                let places: Vec<Point> = corners.clone().map(|v| mesh.points[v.index()]).collect();
                if !is_excluded[v.index()] && (also_curved || is_between(mesh.points[v.index()], &places)) {
                    is_excluded[v.index()] = true;
                    found.push((v, corners.collect()));
                }
            }
        }
        found.sort_unstable_by_key(|(v, _)| *v);
        let mut all = Self::default();
        for (v, corners) in found {
            all.vertices.push(v);
            all.corners.push(corners);
        }
        all
    }

    pub(crate) fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    /// Moves every node by the mean displacement of its corners in `out`. A node that was off the middle at
    /// first stays off by as much, and a mesh that does not move keeps its bits.
    pub(crate) fn place(&self, reference: &[Point], out: &mut [Point], threads: &Threads) {
        let moved = |v: &VertexId| sub(out[v.index()], reference[v.index()]);
        let places = threads.map(self.vertices.len(), |i| {
            let corners = self.corners.list(i);
            let sum = corners.iter().map(moved).fold([0.0; 3], add);
            add(reference[self.vertices[i].index()], scale(sum, 1.0 / corners.len() as f64))
        });
        self.vertices.iter().zip(places).for_each(|(v, place)| out[v.index()] = place);
    }
}

/// Whether a node lies in the middle of its corners, up to rounding.
fn is_between(p: Point, corners: &[Point]) -> bool {
    let middle = scale(corners.iter().copied().fold([0.0; 3], add), 1.0 / corners.len() as f64);
    let longest = corners.iter().map(|&c| norm(sub(c, corners[0]))).fold(0.0, f64::max);
    let coordinates = || corners.iter().chain([&p]).flatten();
    let is_single = coordinates().all(|&x| f64::from(x as f32) == x);
    let epsilon = if is_single { f64::from(f32::EPSILON) } else { f64::EPSILON };
    let largest = coordinates().fold(0.0, |most: f64, x| most.max(x.abs()));
    norm(sub(p, middle)) <= (STRAIGHT_TOLERANCE * longest).max(ROUNDINGS * epsilon * largest)
}
