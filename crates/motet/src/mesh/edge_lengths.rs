//! How long edges are, at each vertex and all together.

use crate::base::{Point, VertexId};
use crate::geometry::vector::distance;

/// The mean length of the edges of triangles, or of tets, at each point; 0 where there is none. An edge counts as often as it is one of theirs.
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

/// The least, the median and the largest length of the edges of triangles, each edge once; `None` where there is none. Edges with an end that is not finite do not
/// count.
pub fn edge_lengths(
    points: &[Point],
    triangles: impl IntoIterator<Item = [VertexId; 3]>,
) -> Option<[f64; 3]> {
    let ends = |[a, b, c]: [VertexId; 3]| [[a, b], [b, c], [c, a]].map(|[u, v]| [u.min(v), u.max(v)]);
    let mut edges: Vec<[VertexId; 2]> = triangles.into_iter().flat_map(ends).collect();
    edges.sort_unstable();
    edges.dedup();
    let length = |[u, v]: &[VertexId; 2]| distance(points[u.index()], points[v.index()]);
    let mut lengths: Vec<f64> = edges.iter().map(length).filter(|length| length.is_finite()).collect();
    lengths.sort_by(f64::total_cmp);
    Some([*lengths.first()?, lengths[lengths.len() / 2], *lengths.last()?])
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
        assert_eq!(edge_lengths(&points, []), None);
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
