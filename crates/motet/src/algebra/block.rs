//! What a sparse matrix is made of.

use crate::algebra::Vector3;

/// An entry of a matrix, which turns one vector of three into another.
pub trait Block: Copy + Send + Sync + 'static {
    /// Nothing.
    const ZERO: Self;

    /// The sum.
    fn plus(self, other: Self) -> Self;

    /// Adds `self x` to `sum`.
    fn add_times(self, x: Vector3, sum: &mut Vector3);

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

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }

    #[inline(always)]
    fn add_times(self, x: Vector3, sum: &mut Vector3) {
        (0..3).for_each(|i| sum[i] += self * x[i]);
    }

    fn inverse(self) -> Option<Self> {
        (self > 0.0 && self.is_finite()).then_some(1.0 / self)
    }
}

/// Three rows of three.
pub type Block3 = [[f64; 3]; 3];

impl Block for Block3 {
    const ZERO: Self = [[0.0; 3]; 3];

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
