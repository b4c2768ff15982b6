//! Interior nodes: some vertices of the mesh, far apart where cells are large and close together where they
//! are small.

use crate::base::{Csr, Point, VertexId};
use crate::geometry::vector::{norm, sub};

/// Nodes of the graph whose motion is not given.
#[derive(Clone, Debug, Default)]
pub(crate) struct Helpers {
    /// In rising order.
    pub(crate) vertices: Vec<VertexId>,
    /// The mean edge length of the mesh at each of its vertices.
    pub(crate) lengths: Vec<f64>,
}

/// Chooses vertices of `free`, in a pseudorandom order, none of which is within `rings` edges of another or
/// next to a vertex that is not free.
pub(crate) fn choose_helpers(
    tets: &[[VertexId; 4]],
    points: &[Point],
    free: &[VertexId],
    rings: usize,
) -> Helpers {
    let edges = || {
        tets.iter().flat_map(|tet| {
            (0..4).flat_map(move |i| (0..4).filter(move |j| *j != i).map(move |j| (tet[i].index(), tet[j].0)))
        })
    };
    let neighbours = Csr::from_pairs(points.len(), edges);
    let lengths = (0..points.len()).map(|v| {
        let near = neighbours.list(v);
        let sum: f64 = near.iter().map(|&n| norm(sub(points[n as usize], points[v]))).sum();
        sum / near.len().max(1) as f64
    });
    let lengths = lengths.collect();
    let mut is_free = vec![false; points.len()];
    free.iter().for_each(|v| is_free[v.index()] = true);
    let is_inner = |v: usize| {
        let near = neighbours.list(v);
        !near.is_empty() && near.iter().all(|&n| is_free[n as usize])
    };
    let mut order: Vec<u32> = free.iter().map(|v| v.0).filter(|&v| is_inner(v as usize)).collect();
    order.sort_by_key(|&v| (hashed(v), v));
    // Which vertices are near a helper, and the last search that reached each vertex.
    let (mut is_near, mut seen) = (vec![false; points.len()], vec![u32::MAX; points.len()]);
    let mut vertices = Vec::new();
    for v in order {
        if is_near[v as usize] {
            continue;
        }
        vertices.push(VertexId(v));
        let (mut front, mut next) = (vec![v], Vec::new());
        seen[v as usize] = v;
        is_near[v as usize] = true;
        for _ in 0..rings {
            for &u in &front {
                for &n in neighbours.list(u as usize) {
                    if std::mem::replace(&mut seen[n as usize], v) != v {
                        is_near[n as usize] = true;
                        next.push(n);
                    }
                }
            }
            front.clear();
            std::mem::swap(&mut front, &mut next);
        }
    }
    vertices.sort_unstable();
    Helpers { vertices, lengths }
}

/// A pseudorandom number for a vertex, unrelated to those of its neighbours (the finaliser of MurmurHash3,
/// Appleby 2011).
fn hashed(v: u32) -> u32 {
    let v = (v ^ (v >> 16)).wrapping_mul(0x85eb_ca6b);
    let v = (v ^ (v >> 13)).wrapping_mul(0xc2b2_ae35);
    v ^ (v >> 16)
}
