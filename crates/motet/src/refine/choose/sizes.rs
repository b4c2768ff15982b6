//! Edge lengths required at each vertex: from the curvature of a field, limited, graded, and scaled to a
//! number of tets.
//!
//! The size of an edge is the mean of the sizes at its ends. A tet is too large if one of its edges is longer
//! than its size.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::hessian::vertex_to_tets;
use super::wish::{Wish, expected_tets};
use crate::base::{Threads, VertexId};
use crate::geometry::tet::EDGES;
use crate::geometry::vector::distance;
use crate::mesh::TetMesh;

/// Bound on the interpolation error: in a tet, a field and its linear interpolant differ by at most this
/// constant times the largest value, over the edges, of the second derivative along the edge times the
/// squared edge length (Frey and Alauzet 2005, *Anisotropic mesh adaptation for CFD computations*: half of
/// the square of 3/4).
const LARGEST_ERROR: f64 = 9.0 / 32.0;

/// How often the interval of scales is bisected.
const HALVINGS: usize = 40;
/// The number of tets is close enough when it is within this fraction below the target.
const COUNT_TOLERANCE: f64 = 0.01;

/// Limits on sizes, whatever they are derived from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeLimits {
    /// No size is below this. Default: 0.
    pub smallest: f64,
    /// No size is above this. Default: infinite.
    pub largest: f64,
    /// By how much the size may grow per unit of length along edges; infinite: without limit. Default: 1,
    /// with which sizes double from one edge to the next, as edges of divided tets do at their border.
    /// Smaller values only spread small tets.
    pub growth: f64,
}

impl Default for SizeLimits {
    fn default() -> Self {
        Self { smallest: 0.0, largest: f64::INFINITY, growth: 1.0 }
    }
}

impl SizeLimits {
    /// Brings sizes within the limits.
    pub fn apply(&self, mesh: &TetMesh, sizes: &mut [f64]) {
        for size in sizes.iter_mut() {
            // A NaN size requests nothing.
            *size = if size.is_nan() { self.largest } else { size.max(self.smallest).min(self.largest) };
        }
        if self.growth < f64::INFINITY {
            limit_growth(mesh, sizes, self.growth);
        }
    }
}

/// Returns the sizes at which a field of the given curvature differs from its linear interpolant by at most
/// `error`, in the units of the field. Infinite where the curvature is 0 or
/// [unknown](super::hessian::curvatures).
pub fn for_error(curvatures: &[f64], error: f64) -> Vec<f64> {
    let size = |curvature: &f64| {
        if *curvature > 0.0 { (error / (LARGEST_ERROR * curvature)).sqrt() } else { f64::INFINITY }
    };
    curvatures.iter().map(size).collect()
}

/// The exponent by which sizes depend on curvature where the mean square error is to be least for a given
/// number of tets (Loseille and Alauzet 2011, *Continuous mesh framework part I*; here in space, with all
/// edges at a place equal): the sum over space of the square of `curvature * h^2`, with `h^-3` tets per unit
/// of volume, is least where `h^7` is proportional to `curvature^-2`.
const MEAN_SQUARE: f64 = -2.0 / 7.0;

/// Returns, up to a common scale, the sizes at which a field of the given curvature is closest to its linear
/// interpolant in the mean square for a given number of tets. Fields can be compared if `curvatures` are
/// relative to their ranges. Infinite where the curvature is 0 or unknown.
pub fn for_mean_square(curvatures: &[f64]) -> Vec<f64> {
    let size = |curvature: &f64| if *curvature > 0.0 { curvature.powf(MEAN_SQUARE) } else { f64::INFINITY };
    curvatures.iter().map(size).collect()
}

/// Returns the sizes times a common scale, within limits, chosen such that dividing all tets that are too
/// large brings the mesh to about `n_tets`, and not beyond if possible. The scale is found by bisection.
pub fn for_count(
    mesh: &TetMesh,
    sizes: &[f64],
    limits: &SizeLimits,
    n_tets: usize,
    threads: &Threads,
) -> Vec<f64> {
    let scaled = |scale: f64| {
        let mut scaled: Vec<f64> = sizes.iter().map(|size| size * scale).collect();
        limits.apply(mesh, &mut scaled);
        scaled
    };
    let count = |sizes: &[f64]| expected_tets(&wishes(mesh, sizes, threads));
    let target = n_tets.max(mesh.tets.len()) as f64;
    let ratios = ratios(mesh, sizes, threads);
    let mut high = ratios.into_iter().filter(|ratio| ratio.is_finite()).fold(0.0, f64::max);
    if high == 0.0 {
        return scaled(1.0);
    }
    let mut low = high / (8.0 * target).cbrt();
    // At this scale no tet is too large, except where small sizes spread.
    let mut found = scaled(high);
    for _ in 0..HALVINGS {
        if count(&found) <= target {
            break;
        }
        (low, high) = (high, 2.0 * high);
        found = scaled(high);
    }
    for _ in 0..HALVINGS {
        let scale = (low * high).sqrt();
        let sizes = scaled(scale);
        let n = count(&sizes);
        if n > target {
            low = scale;
            continue;
        }
        (high, found) = (scale, sizes);
        if n > (1.0 - COUNT_TOLERANCE) * target {
            break;
        }
    }
    found
}

/// Lowers sizes until none grows by more than `growth` times the length along any edge: for an edge of length
/// `d`, the size at one end is at most that at the other plus `growth * d` (Borouchaki, Hecht and Frey 1998,
/// *Mesh gradation control*). Processes the smallest first, so that each size is lowered once (Dijkstra
/// 1959).
pub fn limit_growth(mesh: &TetMesh, sizes: &mut [f64], growth: f64) {
    let tets = vertex_to_tets(mesh);
    // Sizes are positive, so their bit patterns sort in the same order.
    let entry = |v: usize, size: f64| Reverse((size.to_bits(), VertexId::new(v)));
    let finite = (0..sizes.len()).filter(|&v| sizes[v].is_finite());
    let mut queue: BinaryHeap<_> = finite.map(|v| entry(v, sizes[v])).collect();
    while let Some(Reverse((bits, v))) = queue.pop() {
        let size = f64::from_bits(bits);
        if size > sizes[v.index()] {
            continue;
        }
        for u in tets.list(v.index()).iter().flat_map(|t| mesh.tets[t.index()]) {
            let most = size + growth * distance(mesh.points[v.index()], mesh.points[u.index()]);
            if most < sizes[u.index()] {
                sizes[u.index()] = most;
                queue.push(entry(u.index(), most));
            }
        }
    }
}

/// By how much each tet is too large: the largest ratio of an edge length to the size of the edge.
pub fn ratios(mesh: &TetMesh, sizes: &[f64], threads: &Threads) -> Vec<f64> {
    threads.map(mesh.tets.len(), |t| {
        let ratio = |[i, j]: [usize; 2]| {
            let ends = [i, j].map(|i| mesh.tets[t][i].index());
            let [p, q] = ends.map(|v| mesh.points[v]);
            distance(p, q) / (0.5 * (sizes[ends[0]] + sizes[ends[1]]))
        };
        EDGES.into_iter().map(ratio).fold(0.0, f64::max)
    })
}

/// How often each tet must be divided so that no edge is longer than its size.
pub fn wishes(mesh: &TetMesh, sizes: &[f64], threads: &Threads) -> Vec<Wish> {
    ratios(mesh, sizes, threads).into_iter().map(Wish::of_ratio).collect()
}
