//! Edge lengths: the mean at each vertex, and statistics over all edges.

use crate::base::{Csr, Point, VertexId};
use crate::geometry::vector::distance;

/// For each point, the mean length of the edges of triangles or tets that end there; 0 if there are none. An
/// edge counts once for each simplex that has it.
pub fn mean_edge_lengths<const N: usize>(
    points: &[Point],
    simplices: impl IntoIterator<Item = [VertexId; N]>,
) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); points.len()];
    for corners in simplices {
        for (apart, i) in (1..N).flat_map(|apart| (0..N - apart).map(move |i| (apart, i))) {
            let ends = [corners[i], corners[i + apart]];
            let length = distance(points[ends[0].index()], points[ends[1].index()]);
            for end in ends {
                let (sum, n) = &mut sums[end.index()];
                *sum += length;
                *n += 1.0;
            }
        }
    }
    sums.into_iter().map(|(sum, n)| sum / f64::max(n, 1.0)).collect()
}

/// The shortest, the median and the longest edge length of triangles or tets, each edge counted once; `None`
/// if there are no edges. Edges with an end that is not finite do not count.
pub fn edge_lengths<const N: usize>(
    points: &[Point],
    simplices: impl IntoIterator<Item = [VertexId; N], IntoIter: Clone>,
) -> Option<[f64; 3]> {
    let mut lengths = Vec::new();
    for_each_edge(points.len(), simplices.into_iter(), |[u, v]| {
        lengths.extend(Some(distance(points[u.index()], points[v.index()])).filter(|l| l.is_finite()));
    });
    let least = lengths.iter().copied().reduce(f64::min)?;
    let largest = lengths.iter().copied().fold(least, f64::max);
    let middle = lengths.len() / 2;
    Some([least, *lengths.select_nth_unstable_by(middle, f64::total_cmp).1, largest])
}

/// The edges of a tet by its corners; the first three are those of a triangle.
const EDGES: [[usize; 2]; 6] = [[0, 1], [0, 2], [1, 2], [0, 3], [1, 3], [2, 3]];

/// Calls `found` with each edge once. Edges are gathered at their lower end, where each list is short: many
/// times faster than sorting all of them.
pub(crate) fn for_each_edge<const N: usize>(
    n_points: usize,
    simplices: impl Iterator<Item = [VertexId; N]> + Clone,
    mut found: impl FnMut([VertexId; 2]),
) {
    let ends = |corners: [VertexId; N]| {
        let pairs = EDGES[..N * (N - 1) / 2].iter().map(move |&[i, j]| [corners[i], corners[j]]);
        pairs.map(|[u, v]| (u.min(v).index(), u.max(v)))
    };
    let mut upper = Csr::from_pairs(n_points, || simplices.clone().flat_map(ends));
    for u in 0..n_points {
        let list = upper.list_mut(u);
        list.sort_unstable();
        let is_new = |k: &usize| *k == 0 || list[*k] != list[*k - 1];
        (0..list.len()).filter(is_new).for_each(|k| found([VertexId::new(u), list[k]]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_edge_of_triangles_counts_once_in_the_median() {
        // Two triangles with sides 3, 4, 5 and 5, 12, 13: they share the edge of length 5.
        let points = vec![[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 12.0], [3.0, 4.0, 0.0]];
        let triangles = [[0, 1, 2], [0, 2, 1]].map(|t| t.map(VertexId));
        assert_eq!(edge_lengths(&points, triangles), Some([3.0, 4.0, 5.0]));
        assert_eq!(edge_lengths(&points, [[0, 4, 3].map(VertexId), triangles[0]]), Some([3.0, 5.0, 13.0]));
        assert_eq!(edge_lengths::<3>(&points, []), None);
    }

    #[test]
    fn edges_of_tets_are_those_that_sorting_finds() {
        let mesh = crate::mesh::shapes::sphere_in_box(4, 2);
        let tets: Vec<_> = mesh.cells.tets().map(|(_, tet)| tet).collect();
        let pairs = [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]];
        let sorted = |[u, v]: [VertexId; 2]| [u.min(v), u.max(v)];
        let edges: std::collections::BTreeSet<_> =
            tets.iter().flat_map(|tet| pairs.map(|[i, j]| sorted([tet[i], tet[j]]))).collect();
        let mut lengths: Vec<f64> =
            edges.iter().map(|[u, v]| distance(mesh.points[u.index()], mesh.points[v.index()])).collect();
        lengths.sort_by(f64::total_cmp);
        let expected = [lengths[0], lengths[lengths.len() / 2], lengths[lengths.len() - 1]];
        assert_eq!(edge_lengths(&mesh.points, tets), Some(expected));
    }

    #[test]
    fn edges_count_as_often_as_simplices_have_them() {
        let points = vec![[0.0; 3], [3.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 12.0], [9.0; 3]];
        let triangle = [0, 1, 2].map(VertexId);
        assert_eq!(mean_edge_lengths(&points, [triangle]), [3.5, 4.0, 4.5, 0.0, 0.0]);
        let tet = [0, 1, 2, 3].map(VertexId);
        let lengths = mean_edge_lengths(&points, [tet]);
        assert!((lengths[0] - 19.0 / 3.0).abs() < 1e-15 && lengths[4] == 0.0);
    }
}
