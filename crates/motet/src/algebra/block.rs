//! What a sparse matrix is made of.

use crate::algebra::Vector3;

/// An entry of a matrix, which turns one vector of three into another.
pub trait Block: Copy + Send + Sync + 'static {
    /// Nothing.
    const ZERO: Self;

    /// Rows and columns of numbers: 1 or 3.
    const WIDTH: usize;

    /// How a body of such rows can move without a strain, as blocks beside each other.
    type Rigid: AsRef<[Self]>;

    /// What a row of a body at this place, seen from its centre, does when the body moves.
    fn rigid(place: Vector3) -> Self::Rigid;

    /// The number in row `i` and column `j`, both below the width.
    fn entry(&self, i: usize, j: usize) -> f64;

    /// The sum.
    fn plus(self, other: Self) -> Self;

    /// Adds `self x` to `sum`.
    fn add_times(self, x: Vector3, sum: &mut Vector3);

    /// The product.
    fn times_block(self, other: Self) -> Self;

    /// Rows as columns.
    fn transposed(self) -> Self;

    /// Each number times `factor`.
    fn scaled(self, factor: f64) -> Self;

    /// The block that undoes this one, which is symmetric and positive definite; `None` where it is not.
    fn inverse(self) -> Option<Self>;

    /// `self x`.
    #[inline(always)]
    fn times(self, x: Vector3) -> Vector3 {
        let mut y = [0.0; 3];
        self.add_times(x, &mut y);
        y
    }
}

/// The same number for each of the three.
impl Block for f64 {
    const ZERO: Self = 0.0;
    const WIDTH: usize = 1;

    /// All by the same.
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

/// Three rows of three.
pub type Block3 = [[f64; 3]; 3];

impl Block for Block3 {
    const ZERO: Self = [[0.0; 3]; 3];
    const WIDTH: usize = 3;

    /// A shift, and a turn by a small vector.
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

    /// By the cofactors, of the matrix as it is: 3 x 3 blocks of an elastic matrix are far from singular.
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
