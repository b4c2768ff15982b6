//! Symmetric 3 x 3 matrices, such as second derivatives, and their eigenvalues; the largest eigenvector of a
//! 4 x 4 one.

/// A symmetric 3 x 3 matrix: its entries xx, yy, zz, xy, yz, xz, in the order of VTK's symmetric tensors.
pub type Symmetric = [f64; 6];

/// The number of sweeps over all pairs of axes. Each sweep roughly squares what is left off the diagonal;
/// random matrices need four or five.
const SWEEPS: usize = 12;

/// The eigenvalues in ascending order, by rotations each of which makes one off-diagonal entry 0 (Jacobi
/// 1846; Golub and Van Loan 2013, *Matrix computations*, 8.5). Each is accurate to a few roundings of the
/// largest. All are NaN where an entry is not finite.
pub fn eigenvalues(matrix: Symmetric) -> [f64; 3] {
    let largest = matrix.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    if largest == 0.0 || !matrix.iter().all(|x| x.is_finite()) {
        return [matrix.iter().sum::<f64>() * 0.0; 3];
    }
    // In units of the largest entry nothing overflows.
    let [xx, yy, zz, xy, yz, xz] = matrix.map(|x| x / largest);
    let mut a = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    for _ in 0..SWEEPS {
        if [a[0][1], a[0][2], a[1][2]] == [0.0; 3] {
            break;
        }
        for pair in [[0, 1], [0, 2], [1, 2]] {
            rotate(&mut a, pair);
        }
    }
    let mut values = [0, 1, 2].map(|i| a[i][i] * largest);
    values.sort_by(f64::total_cmp);
    values
}

/// Rotates the axes `p` and `q` so that their common entry becomes 0; returns sine and cosine of the angle.
fn rotate<const N: usize>(a: &mut [[f64; N]; N], [p, q]: [usize; 2]) -> [f64; 2] {
    let off = a[p][q];
    if off == 0.0 {
        return [0.0, 1.0];
    }
    // The tangent of the smaller angle.
    let cotangent = (a[q][q] - a[p][p]) / (2.0 * off);
    let tangent = cotangent.signum() / (cotangent.abs() + cotangent.hypot(1.0));
    let cosine = 1.0 / tangent.hypot(1.0);
    let sine = tangent * cosine;
    a[p][p] -= tangent * off;
    a[q][q] += tangent * off;
    [a[p][q], a[q][p]] = [0.0; 2];
    for r in (0..N).filter(|&r| r != p && r != q) {
        let (x, y) = (a[r][p], a[r][q]);
        let turned = [cosine * x - sine * y, sine * x + cosine * y];
        [a[r][p], a[p][r]] = [turned[0]; 2];
        [a[r][q], a[q][r]] = [turned[1]; 2];
    }
    [sine, cosine]
}

/// The unit eigenvector to the largest eigenvalue, by Jacobi rotations; among equal eigenvalues, the first.
/// NaN where an entry is not finite.
pub fn largest_eigenvector(matrix: [[f64; 4]; 4]) -> [f64; 4] {
    let largest = matrix.as_flattened().iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let mut vectors = [0, 1, 2, 3].map(|i| [0, 1, 2, 3].map(|j| f64::from(u8::from(i == j))));
    if !matrix.as_flattened().iter().all(|x| x.is_finite()) {
        return [f64::NAN; 4];
    }
    if largest == 0.0 {
        return vectors[0];
    }
    let mut a = matrix.map(|row| row.map(|x| x / largest));
    for _ in 0..SWEEPS {
        for (p, q) in [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)] {
            let [sine, cosine] = rotate(&mut a, [p, q]);
            let (x, y) = (vectors[p], vectors[q]);
            vectors[p] = [0, 1, 2, 3].map(|i| cosine * x[i] - sine * y[i]);
            vectors[q] = [0, 1, 2, 3].map(|i| sine * x[i] + cosine * y[i]);
        }
    }
    let at = (1..4).fold(0, |at, i| if a[i][i] > a[at][at] { i } else { at });
    let length = vectors[at].iter().map(|x| x * x).sum::<f64>().sqrt();
    vectors[at].map(|x| x / length)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_near(found: [f64; 3], expected: [f64; 3]) -> bool {
        let largest = expected.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        (0..3).all(|i| (found[i] - expected[i]).abs() <= 4e-15 * largest)
    }

    #[test]
    fn known_matrices_have_their_eigenvalues() {
        assert_eq!(eigenvalues([0.0; 6]), [0.0; 3]);
        assert_eq!(eigenvalues([3.0, -1.0, 2.0, 0.0, 0.0, 0.0]), [-1.0, 2.0, 3.0]);
        // All ones: one direction of 3, two of 0.
        assert!(is_near(eigenvalues([1.0; 6]), [0.0, 0.0, 3.0]));
        // Second differences, with eigenvalues 2 - sqrt 2, 2, 2 + sqrt 2.
        let root = 2f64.sqrt();
        assert!(is_near(eigenvalues([2.0, 2.0, 2.0, -1.0, -1.0, 0.0]), [2.0 - root, 2.0, 2.0 + root]));
        assert!(is_near(eigenvalues([0.0, 0.0, 5.0, 1.0, 0.0, 0.0]), [-1.0, 1.0, 5.0]));
    }

    #[test]
    fn turned_diagonals_keep_theirs_at_every_scale() {
        // Q diag Q^T, with Q composed of two rotations.
        for (scale, angle) in [(1.0, 0.3), (1e-160, 1.1), (1e150, 2.0), (1.0, 1e-9)] {
            let (s, c) = f64::sin_cos(angle);
            let q = [[c, -s * c, s * s], [s, c * c, -c * s], [0.0, s, c]];
            let values = [-2.0, 0.5, 7.0].map(|x| x * scale);
            let entry = |i: usize, j: usize| (0..3).map(|k| q[i][k] * values[k] * q[j][k]).sum::<f64>();
            let matrix = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)].map(|(i, j)| entry(i, j));
            assert!(is_near(eigenvalues(matrix), values), "{scale} {angle}");
        }
    }

    #[test]
    fn what_is_not_finite_has_none() {
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(eigenvalues([1.0, bad, 2.0, 0.0, 0.0, 1.0]).iter().all(|x| x.is_nan()));
            let mut matrix = [[0.0; 4]; 4];
            [matrix[1][2], matrix[2][1]] = [bad; 2];
            assert!(largest_eigenvector(matrix).iter().all(|x| x.is_nan()));
        }
    }
}
