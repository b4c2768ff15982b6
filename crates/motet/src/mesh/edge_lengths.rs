//! How long edges are at each vertex.

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

#[cfg(test)]
mod tests {
    use super::*;

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
