//! How a tet is degenerate: the four types of the paper.
//!
//! ```text
//!   I    two opposite edges cross closely           (sliver)     split both, join the new vertices
//!   II   a vertex lies close to an opposite edge    (spade)      split the edge at the vertex
//!   III  a vertex lies within the facet opposite    (cap)        collapse the vertex
//!   IV   an edge is short                           (needle)     collapse the edge
//! ```
//! The limits are those of Moyle and Ventikos 2008, *Local remeshing for large amplitude grid deformations*,
//! table 2. Lengths are relative to the mean edge length of the tet: the paper does not say what they are
//! relative to.

use serde::Serialize;

use crate::base::Point;
use crate::geometry::tet::{EDGES, FACETS};
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};

/// A tet with two opposite edges closer than this is of type I.
pub const EDGE_TO_EDGE: f64 = 0.18;
/// A tet with a vertex closer than this to an opposite edge is of type II.
pub const VERTEX_TO_EDGE: f64 = 0.21;
/// A tet with an edge shorter than this is of type IV.
pub const SHORTEST_EDGE: f64 = 0.2;

/// How a bad tet is degenerate, and where: its vertices and edges by local number ([`EDGES`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Defect {
    /// Type I: edges `edge` and `5 - edge` cross closely.
    CrossedEdges {
        /// The first of the two edges.
        edge: usize,
    },
    /// Type II: a vertex close to an edge that it does not belong to.
    VertexAtEdge {
        /// The vertex.
        vertex: usize,
        /// The edge.
        edge: usize,
    },
    /// Type III: a vertex whose projection lies within the opposite facet.
    VertexOverFacet {
        /// The vertex.
        vertex: usize,
    },
    /// Type IV: a short edge.
    ShortEdge {
        /// The edge.
        edge: usize,
    },
    /// None of the four types.
    Other,
}

impl Defect {
    /// Index of the type: 0 for type I to 3 for type IV, 4 for none of them.
    pub fn number(self) -> usize {
        match self {
            Self::CrossedEdges { .. } => 0,
            Self::VertexAtEdge { .. } => 1,
            Self::VertexOverFacet { .. } => 2,
            Self::ShortEdge { .. } => 3,
            Self::Other => 4,
        }
    }
}

/// Names of the types, indexed by [`Defect::number`].
pub const DEFECT_NAMES: [&str; 5] = ["I", "II", "III", "IV", "other"];

/// The type of a bad tet, by the limits of the paper.
pub fn classify(tet: [Point; 4]) -> Defect {
    classify_by(tet, |lengths| lengths.iter().sum::<f64>() / 6.0)
}

/// The type of a bad tet, with lengths relative to `unit` of its six edge lengths.
fn classify_by(tet: [Point; 4], unit: impl Fn([f64; 6]) -> f64) -> Defect {
    let lengths = EDGES.map(|[i, j]| norm(sub(tet[j], tet[i])));
    let mean = unit(lengths);
    let shortest = (1..6).fold(0, |s, e| if lengths[e] < lengths[s] { e } else { s });
    if lengths[shortest] < SHORTEST_EDGE * mean {
        return Defect::ShortEdge { edge: shortest };
    }
    let near = |(distance, _): &(f64, Defect), limit: f64| *distance < limit * mean;
    let spade = vertex_to_edge(tet);
    if near(&spade, VERTEX_TO_EDGE) {
        return spade.1;
    }
    let crossed = edge_to_edge(tet);
    if near(&crossed, EDGE_TO_EDGE) {
        return crossed.1;
    }
    (0..4)
        .filter(|&v| foot_is_inside(tet, v))
        .map(|vertex| Defect::VertexOverFacet { vertex })
        .next()
        .unwrap_or(Defect::Other)
}

/// The vertex closest to an edge that it does not belong to, where its projection lies within the edge.
fn vertex_to_edge(tet: [Point; 4]) -> (f64, Defect) {
    let mut best = (f64::INFINITY, Defect::Other);
    for (edge, [i, j]) in EDGES.into_iter().enumerate() {
        let way = sub(tet[j], tet[i]);
        for vertex in (0..4).filter(|&v| v != i && v != j) {
            let t = dot(sub(tet[vertex], tet[i]), way) / dot(way, way);
            let distance = norm(sub(tet[vertex], add(tet[i], scale(way, t))));
            if t > 0.0 && t < 1.0 && distance < best.0 {
                best = (distance, Defect::VertexAtEdge { vertex, edge });
            }
        }
    }
    best
}

/// The closest pair of opposite edges, where they pass each other between their ends.
fn edge_to_edge(tet: [Point; 4]) -> (f64, Defect) {
    let mut best = (f64::INFINITY, Defect::Other);
    for edge in 0..3 {
        let [[a, b], [c, d]] = [EDGES[edge], EDGES[5 - edge]].map(|e| e.map(|i| tet[i]));
        if let Some(distance) = passing_distance([a, b], [c, d]).filter(|d| *d < best.0) {
            best = (distance, Defect::CrossedEdges { edge });
        }
    }
    best
}

/// The distance of two segments if the closest points of their lines lie within both.
fn passing_distance([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<f64> {
    let (u, v, w) = (sub(b, a), sub(d, c), sub(c, a));
    let n = cross(u, v);
    let n_squared = dot(n, n);
    let s = dot(cross(w, v), n) / n_squared;
    let t = dot(cross(w, u), n) / n_squared;
    let within = |x: f64| x > 0.0 && x < 1.0;
    (within(s) && within(t)).then(|| dot(w, n).abs() / n_squared.sqrt())
}

/// Whether the projection of a vertex onto the plane of the opposite facet lies within the facet.
fn foot_is_inside(tet: [Point; 4], vertex: usize) -> bool {
    let [a, b, c] = FACETS[vertex].map(|i| tet[i]);
    let normal = cross(sub(b, a), sub(c, a));
    let p = tet[vertex];
    [[a, b], [b, c], [c, a]].into_iter().all(|[q, r]| dot(cross(sub(r, q), sub(p, q)), normal) > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::splitmix64;
    use crate::geometry::quality::eas;

    /// The next pseudo-random number in [-1, 1).
    fn next(state: &mut u64) -> f64 {
        let number = splitmix64(*state);
        *state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        (number >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    /// A tet degenerate by construction, of type I to IV by `kind`, with each coordinate perturbed by up to
    /// `noise`.
    fn made(state: &mut u64, kind: usize, noise: f64) -> [Point; 4] {
        let t = 0.5 + 0.3 * next(state);
        let s = 0.5 + 0.3 * next(state);
        let ideal = match kind {
            // Edges 01 and 23 cross.
            0 => [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [t, -s, 0.0], [t, 1.0 - s, 0.0]],
            1 => [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.9, 0.0], [t, 0.0, 0.0]],
            2 => [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 0.9, 0.0], [0.5, 0.3, 0.0]],
            _ => [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.5, 0.9, 0.0], [0.5, 0.3, 0.8]],
        };
        ideal.map(|p| p.map(|x| x + noise * next(state)))
    }

    /// Compares units for the limits: how often a tet constructed as one type is classified as that type.
    #[test]
    fn the_mean_edge_distinguishes_the_types_best() {
        type Unit = fn([f64; 6]) -> f64;
        let units: [Unit; 3] = [
            |l| l.into_iter().fold(f64::INFINITY, f64::min),
            |l| l.iter().sum::<f64>() / 6.0,
            |l| l.into_iter().fold(0.0, f64::max),
        ];
        let correct = [0, 1, 2].map(|u| {
            let (name, unit) = (["shortest", "mean", "longest"][u], units[u]);
            let mut state = 1;
            let (mut right, mut all) = ([0usize; 4], [0usize; 4]);
            for i in 0..40_000 {
                let kind = i % 4;
                let tet = made(&mut state, kind, 0.08);
                if eas(tet).abs() < 0.2 {
                    all[kind] += 1;
                    right[kind] += usize::from(classify_by(tet, unit).number() == kind);
                }
            }
            let shares = [0, 1, 2, 3].map(|k| right[k] as f64 / all[k] as f64);
            println!("{name:>9}: {shares:.3?} of types I to IV are found as made");
            shares.into_iter().fold(f64::INFINITY, f64::min)
        });
        assert!(correct[1] > 0.7 && correct[1] > correct[0] && correct[1] >= correct[2], "{correct:?}");
    }
}
