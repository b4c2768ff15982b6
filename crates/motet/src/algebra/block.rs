//! The entries of sparse matrices.

use crate::algebra::Vector3;

/// An entry of a sparse matrix: a linear map of 3-vectors.
pub trait Block: Copy + std::fmt::Debug + Send + Sync + 'static {
    /// The zero entry.
    const ZERO: Self;

    /// Number of scalar rows and columns: 1 or 3.
    const WIDTH: usize;

    /// The motions of a body without strain, restricted to one row: a block of translations and, for 3 x 3
    /// blocks, one of rotations.
    type Rigid: AsRef<[Self]>;

    /// The rigid-body motions of a row at `place`, relative to the centre of the body.
    fn rigid(place: Vector3) -> Self::Rigid;

    /// The number in row `i` and column `j`, both below the width.
    fn entry(&self, i: usize, j: usize) -> f64;

    /// The sum of `self` and `other`.
    fn plus(self, other: Self) -> Self;

    /// Adds `self x` to `sum`.
    fn add_times(self, x: Vector3, sum: &mut Vector3);

    /// The product `self other`.
    fn times_block(self, other: Self) -> Self;

    /// The transpose.
    fn transposed(self) -> Self;

    /// `self` with each number multiplied by `factor`.
    fn scaled(self, factor: f64) -> Self;

    /// The inverse of a symmetric block; `None` where the block is not positive definite.
    fn inverse(self) -> Option<Self>;

    /// `self x`.
    #[inline(always)]
    fn times(self, x: Vector3) -> Vector3 {
        let mut y = [0.0; 3];
        self.add_times(x, &mut y);
        y
    }
}

/// A multiple of the identity: the same number for each of the three components.
impl Block for f64 {
    const ZERO: Self = 0.0;
    const WIDTH: usize = 1;

    /// Translations only.
    type Rigid = [Self; 1];

    fn rigid(_: Vector3) -> [Self; 1] {
        [1.0]
    }

    fn entry(&self, _: usize, _: usize) -> f64 {
        *self
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn add_times(self, x: Vector3, sum: &mut Vector3) {
        (0..3).for_each(|i| sum[i] += self * x[i]);
    }

    fn times_block(self, other: Self) -> Self {
        self * other
    }

    fn transposed(self) -> Self {
        self
    }

    fn scaled(self, factor: f64) -> Self {
        self * factor
    }

    fn inverse(self) -> Option<Self> {
        (self > 0.0 && self.is_finite()).then_some(1.0 / self)
    }
}

/// A 3 x 3 matrix, row by row.
pub type Block3 = [[f64; 3]; 3];

impl Block for Block3 {
    const ZERO: Self = [[0.0; 3]; 3];
    const WIDTH: usize = 3;

    /// Translations, and rotations by a small vector.
    type Rigid = [Self; 2];

    fn rigid([x, y, z]: Vector3) -> [Self; 2] {
        [[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]]
    }

    #[inline(always)]
    fn entry(&self, i: usize, j: usize) -> f64 {
        self[i][j]
    }

    #[inline(always)]
    fn plus(mut self, other: Self) -> Self {
        for i in 0..3 {
            (0..3).for_each(|j| self[i][j] += other[i][j]);
        }
        self
    }

    #[inline(always)]
    fn add_times(self, x: Vector3, sum: &mut Vector3) {
        for i in 0..3 {
            sum[i] += self[i][0] * x[0] + self[i][1] * x[1] + self[i][2] * x[2];
        }
    }

    fn times_block(self, other: Self) -> Self {
        std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| self[i][k] * other[k][j]).sum()))
    }

    fn transposed(self) -> Self {
        std::array::from_fn(|i| std::array::from_fn(|j| self[j][i]))
    }

    fn scaled(self, factor: f64) -> Self {
        self.map(|row| row.map(|x| x * factor))
    }

    /// By cofactors, without scaling: 3 x 3 blocks of an elastic matrix are far from singular.
    fn inverse(self) -> Option<Self> {
        let [[a, b, c], [d, e, f], [g, h, i]] = self;
        let cofactors = [
            [e * i - f * h, c * h - b * i, b * f - c * e],
            [f * g - d * i, a * i - c * g, c * d - a * f],
            [d * h - e * g, b * g - a * h, a * e - b * d],
        ];
        let det = a * cofactors[0][0] + b * cofactors[1][0] + c * cofactors[2][0];
        let is_definite = a > 0.0 && a * e - b * d > 0.0 && det > 0.0;
        let inverse = cofactors.map(|row| row.map(|x| x / det));
        (is_definite && inverse.as_flattened().iter().all(|x| x.is_finite())).then_some(inverse)
    }
}
