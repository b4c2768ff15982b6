//! Exact signs: orientation of four points, five points and a sphere; ties are broken symbolically.
//!
//! Each predicate has stages, and the next is evaluated only where the one before cannot prove its sign:
//! 1. `f64` with a bound on its rounding error,
//! 2. pairs of `f64`, about 100 bits (see `pair`): on points of a sphere or a plane, where the first stage
//!    fails 20 to 40 times in 100, this one decides all but true ties, at a fortieth of the cost of
//!    floating-point expansions (Shewchuk 1997, *Adaptive precision floating-point arithmetic and fast robust
//!    geometric predicates*: 3 us there, 0.08 us here),
//! 3. integers (see `exact`), which are exact for every finite `f64`, from the smallest subnormal to the
//!    largest number.
//!
//! The tet a, b, c, d is positive when `(b - a) x (c - a) . (d - a) > 0`.

pub(crate) mod exact;
pub(crate) mod insphere;
mod integer;
pub(crate) mod orient;
pub(crate) mod pair;
mod perturbed;
pub(crate) mod spot;
#[cfg(test)]
mod tests;

pub use insphere::insphere;
pub use orient::{collinear, orient3d};
pub use perturbed::insphere_perturbed;
pub(crate) use perturbed::{break_tie, break_tie_of};
