//! Weights of a tet's vertices that reproduce a point inside, accurate to the last digits in any sliver.
//!
//! A weight is a ratio of two volumes. In a sliver the terms of the volumes cancel, and so do the digits of a
//! ratio computed in floating point: at an aspect of 1e-12 four digits are left. Here the determinants come
//! with an error bound, and where that is not small compared with their sum they are recomputed without
//! rounding.

use crate::base::Point;
use crate::geometry::predicates::{exact, orient};

/// Determinants are accurate enough when their error is below this fraction of their sum.
const GOOD: f64 = 1e-15;

/// Weights of the vertices of `tet` for the point `q`: each in `[0, 1]`, their sum 1 up to rounding. When `q`
/// lies in the closed tet (exactly, as found by a locator), `sum w_i p_i = q` up to a few roundings of the
/// size of the tet. For a point outside, negative weights are set to 0, which gives a point of the tet.
/// `None` when the tet has no volume or is negative.
pub fn weights(tet: [Point; 4], q: Point) -> Option<[f64; 4]> {
    let sub_tets: [[Point; 4]; 4] = std::array::from_fn(|i| {
        let mut sub = tet;
        sub[i] = q;
        sub
    });
    let (values, errors) = estimate(&sub_tets, orient::with_bound);
    if let Some(weights) = normalized(values, errors) {
        return Some(weights);
    }
    let (values, errors) = estimate(&sub_tets, orient::in_pairs_with_bound);
    normalized(values, errors).or_else(|| normalized(exact::orient3d_ratios(sub_tets), 0.0))
}

fn estimate(sub_tets: &[[Point; 4]; 4], determinant: impl Fn([Point; 4]) -> (f64, f64)) -> ([f64; 4], f64) {
    let parts = sub_tets.map(determinant);
    (parts.map(|p| p.0), parts.iter().map(|p| p.1).sum())
}

/// Converts volumes to weights, if their error is negligible.
fn normalized(volumes: [f64; 4], error: f64) -> Option<[f64; 4]> {
    let cut = volumes.map(|v| v.max(0.0));
    let sum: f64 = cut.iter().sum();
    // Not finite, zero or doubtful: the negation lets NaN fall through.
    if !(sum > 0.0 && sum.is_finite() && error <= GOOD * sum) || volumes.iter().sum::<f64>() <= 0.0 {
        return None;
    }
    let mut weights = cut.map(|v| v / sum);
    let largest = (1..4).fold(0, |best, i| if weights[i] > weights[best] { i } else { best });
    let others: f64 = (0..4).filter(|&i| i != largest).map(|i| weights[i]).sum();
    weights[largest] = 1.0 - others;
    Some(weights)
}
