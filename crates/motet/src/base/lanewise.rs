//! Operators for several numbers processed at once.

/// Implements operators for a type `Lanes<S>(S, S::...)`, each by a method of `pulp::Simd`.
macro_rules! lanewise {
    ($($trait:ident $method:ident $simd:ident;)*) => {
        $(impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0, self.0.$simd(self.1, other.1))
            }
        })*
    };
}

pub(crate) use lanewise;
