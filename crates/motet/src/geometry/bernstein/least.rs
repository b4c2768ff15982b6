//! The least value of a polynomial, found between bounds that converge.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::geometry::bernstein::halve::Cut;
use crate::geometry::bernstein::{Basis, MOST_COORDINATES, Place};

/// The corners of the domain of one basis, and the ways to cut the domain.
#[derive(Clone, Debug)]
pub struct Domain {
    cuts: Vec<Cut>,
    /// The corners of the domain: the number of the coefficient that is the value there, and for each factor
    /// the index of the coordinate that is 1.
    corners: Vec<(usize, Vec<usize>)>,
}

/// Bounds on the least value of a polynomial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Least {
    /// A lower bound on all values.
    pub bound: f64,
    /// The least value found, an upper bound on the minimum.
    pub value: f64,
    /// The place of that value.
    pub at: Place,
}

/// The number of parts of the domain after which a search is given up.
const MAX_PARTS: usize = 1 << 10;

impl Domain {
    /// Prepares the domain for polynomials of this basis.
    pub fn of(basis: &Basis) -> Self {
        let mut corners = vec![Vec::new()];
        let mut first = 0;
        for &n in basis.factors() {
            let more =
                |corner: Vec<usize>| (first..first + n).map(move |c| [corner.as_slice(), &[c]].concat());
            corners = corners.into_iter().flat_map(more).collect();
            first += n;
        }
        let number = |corner: &Vec<usize>| {
            let is_value = |e: &[u8; MOST_COORDINATES]| (0..first).all(|c| e[c] == 0 || corner.contains(&c));
            basis.exponents().iter().position(is_value).unwrap_or(0)
        };
        Self { cuts: Cut::all(basis), corners: corners.iter().map(|c| (number(c), c.clone())).collect() }
    }
}

/// A part of the domain, which is a product of simplices as well.
struct Part {
    coefficients: Vec<f64>,
    /// A lower bound on the values in this part.
    bound: f64,
    /// For each coordinate, the corner of its factor for which it stands, in barycentric coordinates of the
    /// whole domain.
    corners: [Place; MOST_COORDINATES],
    /// Parts are numbered in the order in which they were made: of two with equal bounds the earlier one is
    /// examined first.
    number: usize,
}

impl Part {
    fn new(coefficients: Vec<f64>, corners: [Place; MOST_COORDINATES], number: usize) -> Self {
        let bound = coefficients.iter().copied().fold(f64::INFINITY, f64::min);
        Self { coefficients, bound, corners, number }
    }

    /// The least value at the corners of the part, and its place.
    fn least_corner(&self, domain: &Domain) -> (f64, Place) {
        let mut least = (f64::INFINITY, Place::default());
        for (number, coordinates) in &domain.corners {
            let value = self.coefficients[*number];
            if value < least.0 {
                let add = |sum: Place, &c: &usize| std::array::from_fn(|k| sum[k] + self.corners[c][k]);
                least = (value, coordinates.iter().fold(Place::default(), add));
            }
        }
        least
    }

    /// The two halves of a part, cut along the edge where the coefficients deviate most from straight lines.
    fn halves(&self, domain: &Domain, n_made: usize) -> [Self; 2] {
        let mut most = (-1.0, &domain.cuts[0]);
        for cut in &domain.cuts {
            let bend = cut.bend(&self.coefficients);
            if bend > most.0 {
                most = (bend, cut);
            }
        }
        let [a, b] = most.1.ends;
        let [near, far] = most.1.halves(&self.coefficients);
        let middle = std::array::from_fn(|k| 0.5 * (self.corners[a][k] + self.corners[b][k]));
        let with = |end: usize| {
            let mut corners = self.corners;
            corners[end] = middle;
            corners
        };
        [Self::new(near, with(b), n_made), Self::new(far, with(a), n_made + 1)]
    }
}

/// A binary heap returns the largest element first: here the part with the least bound.
impl Ord for Part {
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Part {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Part {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Part {}

/// The least value of the polynomial with these coefficients over the whole domain. The search stops when
/// `is_enough(bound, value)`, when both bounds meet, or when a thousand parts have been made.
pub fn least(domain: &Domain, coefficients: &[f64], is_enough: impl Fn(f64, f64) -> bool) -> Least {
    let whole: [Place; MOST_COORDINATES] =
        std::array::from_fn(|c| std::array::from_fn(|k| f64::from(u8::from(c == k))));
    let whole = Part::new(coefficients.to_vec(), whole, 0);
    let (value, at) = whole.least_corner(domain);
    let mut least = Least { bound: whole.bound, value, at };
    let mut parts = BinaryHeap::from([whole]);
    let mut n_made = 1;
    while let Some(part) = parts.pop() {
        least.bound = part.bound.min(least.value);
        if least.bound == least.value || is_enough(least.bound, least.value) || n_made >= MAX_PARTS {
            return least;
        }
        for half in part.halves(domain, n_made) {
            let (value, at) = half.least_corner(domain);
            if value < least.value {
                (least.value, least.at) = (value, at);
            }
            parts.push(half);
        }
        n_made += 2;
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_close_in_on_a_least_value_inside() {
        // (x - 0.3)^2 + (y - 0.6)^2 + (z - 0.45)^2 on the unit cube, 0 at one place inside.
        let basis = Basis::new(&[2, 2, 2], &[2, 2, 2]);
        let square = |low: f64, k: u8| [low * low, low * (low - 1.0), (1.0 - low) * (1.0 - low)][k as usize];
        let coefficients: Vec<f64> = (basis.exponents().iter())
            .map(|e| square(0.3, e[1]) + square(0.6, e[3]) + square(0.45, e[5]))
            .collect();
        let found = least(&Domain::of(&basis), &coefficients, |bound, value| value - bound < 1e-6);
        assert!(found.bound <= 0.0 && found.value >= 0.0 && found.value - found.bound < 1e-6, "{found:?}");
        let expected = [0.7, 0.3, 0.4, 0.6, 0.55, 0.45];
        assert!(found.at.iter().zip(expected).all(|(x, y)| (x - y).abs() < 1e-2), "{found:?}");
    }

    #[test]
    fn halves_have_the_values_of_the_whole() {
        for (factors, degrees) in [(&[4][..], &[3][..]), (&[3, 2], &[4, 5]), (&[2, 2, 2], &[2, 3, 1])] {
            let basis = Basis::new(factors, degrees);
            let domain = Domain::of(&basis);
            let coefficients: Vec<f64> = (0..basis.len()).map(|i| ((i * 29) % 31) as f64 - 15.0).collect();
            let value =
                |c: &[f64], at: &Place| -> f64 { (0..c.len()).map(|i| c[i] * basis.value(i, at)).sum() };
            // A place in each factor with all coordinates equal, except the first two.
            let mut at = Place::default();
            let mut first = 0;
            for &n in factors {
                (first..first + n).for_each(|c| at[c] = 1.0 / n as f64);
                (at[first], at[first + 1]) = (0.25 * at[first], 1.75 * at[first]);
                first += n;
            }
            for cut in &domain.cuts {
                let [a, b] = cut.ends;
                for (half, kept, dropped) in
                    cut.halves(&coefficients).into_iter().zip([(a, b), (b, a)]).map(|(h, (k, g))| (h, k, g))
                {
                    let mut in_whole = at;
                    in_whole[kept] = at[kept] + 0.5 * at[dropped];
                    in_whole[dropped] = 0.5 * at[dropped];
                    let (x, y) = (value(&half, &at), value(&coefficients, &in_whole));
                    assert!((x - y).abs() < 1e-12 * y.abs().max(1.0), "{factors:?} {a} {b}");
                }
            }
        }
    }
}
