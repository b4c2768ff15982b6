//! How well edges match the requested sizes.

use serde::Serialize;

use crate::base::{TetId, VertexId};
use crate::geometry::tet::EDGES;
use crate::kernel::{Complex, Hold};
use crate::remesh::input_mesh::InputMesh;
use crate::remesh::sizes::{LONG, SHORT, SizeField, SizesIn};

/// Statistics of the edge lengths of a mesh, each length divided by the mean size at its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Lengths {
    /// The number of edges of the tets.
    pub edges: usize,
    /// How many are longer than [`LONG`](crate::remesh::LONG).
    pub too_long: usize,
    /// How many are shorter than [`SHORT`](crate::remesh::SHORT).
    pub too_short: usize,
    /// How many edges that are too long are held: on a surface that is kept, of boundary layers that are
    /// kept, or of cells of other kinds.
    pub too_long_held: usize,
    /// How many edges that are too short are held in this way.
    pub too_short_held: usize,
    /// The smallest ratio; 0 if there are no edges.
    pub min: f64,
    /// The mean ratio over all edges.
    pub mean: f64,
    /// The standard deviation of the natural logarithm of the ratio: 0 if every edge has its size, or all
    /// miss it by the same factor.
    pub spread: f64,
    /// The largest ratio.
    pub max: f64,
}

impl Lengths {
    pub(super) fn of(complex: &Complex, field: &mut SizeField, input: &InputMesh) -> Self {
        field.learn(complex, input, complex.tets());
        let sizes = SizesIn { field, input, complex };
        let mut edges = edges_of(complex, complex.tets());
        let locked = locked_edges(complex);
        let mut lengths = Self { edges: edges.len(), min: f64::INFINITY, ..Self::default() };
        let mut logarithms = [0.0; 2];
        for edge in edges.drain(..) {
            let ratio = sizes.of_edge(edge);
            let logarithm = ratio.ln();
            logarithms = [logarithms[0] + logarithm, logarithms[1] + logarithm * logarithm];
            lengths.min = lengths.min.min(ratio);
            lengths.max = lengths.max.max(ratio);
            lengths.mean += ratio;
            if (SHORT..=LONG).contains(&ratio) {
                continue;
            }
            let is_held = complex.is_fixed_edge(edge[0], edge[1])
                || locked.binary_search(&edge).is_ok()
                || complex.keeps_surface() && edge.iter().any(|&v| complex.hold(v) != Hold::Free);
            let (n, n_held) = match ratio > LONG {
                true => (&mut lengths.too_long, &mut lengths.too_long_held),
                false => (&mut lengths.too_short, &mut lengths.too_short_held),
            };
            *n += 1;
            *n_held += usize::from(is_held);
        }
        lengths.min = if lengths.edges == 0 { 0.0 } else { lengths.min };
        let n = lengths.edges.max(1) as f64;
        lengths.mean /= n;
        let [mean, mean_square] = logarithms.map(|sum| sum / n);
        lengths.spread = (mean_square - mean * mean).max(0.0).sqrt();
        lengths
    }
}

/// Edges of locked tets and of fixed walls, sorted.
pub(super) fn locked_edges(complex: &Complex) -> Vec<[VertexId; 2]> {
    let mut edges = edges_of(complex, complex.tets().filter(|&t| complex.is_locked(t)));
    for (_, wall) in complex.walls().filter(|(id, _)| complex.is_fixed_wall(*id)) {
        let [a, b, c] = complex.facet(wall.sides[0]);
        edges.extend([[a, b], [b, c], [a, c]].map(|[a, b]| [a.min(b), a.max(b)]));
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// Every edge of some tets once, lower vertex first, sorted.
fn edges_of(complex: &Complex, tets: impl Iterator<Item = TetId>) -> Vec<[VertexId; 2]> {
    let of = |tet: [VertexId; 4]| EDGES.map(|[i, j]| [tet[i].min(tet[j]), tet[i].max(tet[j])]);
    let mut edges: Vec<_> = tets.flat_map(|t| of(complex.vertices(t))).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
