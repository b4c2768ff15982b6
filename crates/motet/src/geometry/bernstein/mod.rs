//! Polynomials in Bernstein form over a product of simplices: a tetrahedron, a prism, a cube.
//!
//! A point of the domain has barycentric coordinates in each factor: four in a tetrahedron, three and two in
//! a prism, and two in each of three factors in a cube. A polynomial of degree `d` in a factor is `sum over e
//! of c_e d! / (e_0! e_1! ...) x_0^e_0 x_1^e_1 ...` over all exponents with the sum `d`. Its values lie
//! between its least and its largest coefficient `c_e`; at the corners of the domain they are coefficients
//! `c_e` (Farin 1986, *Triangular Bernstein-Bezier patches*). Both halves of a domain that is cut through the
//! middle of an edge have coefficients of their own, nearer to the polynomial: in this way [`least()`] finds
//! bounds as sharp as needed.

mod halve;
mod least;

pub use least::{Domain, Least, least};

/// The largest number of barycentric coordinates of all factors together: six in a cube, fewer elsewhere.
pub const MOST_COORDINATES: usize = 6;

/// The exponent of each barycentric coordinate.
pub type Exponents = [u8; MOST_COORDINATES];

/// A point of the domain by its barycentric coordinates; those of each factor sum to 1.
pub type Place = [f64; MOST_COORDINATES];

/// The Bernstein polynomials of one degree in each factor of a domain.
#[derive(Clone, Debug)]
pub struct Basis {
    factors: &'static [usize],
    /// The exponents of each polynomial, in ascending order.
    exponents: Vec<Exponents>,
    multinomials: Vec<f64>,
}

impl Basis {
    /// Makes the basis: `factors` holds the number of barycentric coordinates of each factor, `degrees` the
    /// degree in each.
    pub fn new(factors: &'static [usize], degrees: &[u8]) -> Self {
        let mut exponents = vec![[0; MOST_COORDINATES]];
        let mut first = 0;
        for (&n, &degree) in factors.iter().zip(degrees) {
            for coordinate in first..first + n {
                let is_last = coordinate == first + n - 1;
                let split = |e: Exponents| {
                    let left = degree - e[first..coordinate].iter().sum::<u8>();
                    let values = if is_last { left..=left } else { 0..=left };
                    values.map(move |value| {
                        let mut e = e;
                        e[coordinate] = value;
                        e
                    })
                };
                exponents = exponents.into_iter().flat_map(split).collect();
            }
            first += n;
        }
        exponents.sort_unstable();
        let of_degrees: f64 = degrees.iter().map(|&d| factorial(d)).product();
        let multinomial = |e: &Exponents| of_degrees / e.iter().map(|&k| factorial(k)).product::<f64>();
        Self { factors, multinomials: exponents.iter().map(multinomial).collect(), exponents }
    }

    /// The number of polynomials.
    pub fn len(&self) -> usize {
        self.exponents.len()
    }

    /// Whether there are no polynomials; always false.
    pub fn is_empty(&self) -> bool {
        self.exponents.is_empty()
    }

    /// The exponents of each polynomial.
    pub fn exponents(&self) -> &[Exponents] {
        &self.exponents
    }

    /// The number of barycentric coordinates of each factor.
    pub fn factors(&self) -> &'static [usize] {
        self.factors
    }

    /// The number of the polynomial with these exponents.
    ///
    /// # Panics
    /// When there is no such polynomial.
    pub fn number(&self, exponents: &Exponents) -> usize {
        self.exponents.binary_search(exponents).expect("exponents of this degree")
    }

    /// The multinomial coefficient `d! / (e_0! e_1! ...)` of polynomial `i`, over all factors.
    pub fn multinomial(&self, i: usize) -> f64 {
        self.multinomials[i]
    }

    /// The value of polynomial `i` at a place.
    pub fn value(&self, i: usize, at: &Place) -> f64 {
        let powers = self.exponents[i].iter().zip(at).map(|(&e, &x)| x.powi(i32::from(e)));
        self.multinomials[i] * powers.product::<f64>()
    }
}

fn factorial(n: u8) -> f64 {
    (1..=n).map(f64::from).product()
}

/// The multiplication of polynomials: which coefficients of two bases contribute to which one of a third.
///
/// Here coefficients are those of the plain monomials, `c_e` times the multinomial coefficient, since
/// products of monomials are monomials.
#[derive(Clone, Debug)]
pub struct Product {
    /// The numbers of the coefficients in the two bases and in that of the product.
    terms: Vec<[u16; 3]>,
    n: usize,
}

impl Product {
    /// Prepares products from two bases over one domain into a third, whose degrees are the sums of theirs.
    pub fn new(a: &Basis, b: &Basis, product: &Basis) -> Self {
        let mut terms = Vec::with_capacity(a.len() * b.len());
        for (i, x) in (0..).zip(a.exponents()) {
            for (j, y) in (0..).zip(b.exponents()) {
                let sum: Exponents = std::array::from_fn(|k| x[k] + y[k]);
                terms.push([i, j, product.number(&sum) as u16]);
            }
        }
        Self { terms, n: product.len() }
    }

    /// Multiplies coefficients with `times`, and sums the products with `add`, starting from `zero`.
    pub fn of<A: Copy, B: Copy, C: Copy>(
        &self,
        a: &[A],
        b: &[B],
        zero: C,
        times: impl Fn(A, B) -> C,
        add: impl Fn(C, C) -> C,
    ) -> Vec<C> {
        let mut product = vec![zero; self.n];
        for &[i, j, k] in &self.terms {
            let sum = &mut product[k as usize];
            *sum = add(*sum, times(a[i as usize], b[j as usize]));
        }
        product
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CUBE: &[usize] = &[2, 2, 2];

    fn value(basis: &Basis, coefficients: &[f64], at: &Place) -> f64 {
        coefficients.iter().enumerate().map(|(i, c)| c * basis.value(i, at)).sum()
    }

    #[test]
    fn there_are_as_many_as_the_degree_says_and_they_sum_to_one() {
        let cases: [(&'static [usize], &[u8], usize); 4] =
            [(&[4], &[3], 20), (&[3, 2], &[4, 5], 90), (CUBE, &[5, 5, 5], 216), (CUBE, &[5, 5, 3], 144)];
        for (factors, degrees, n) in cases {
            let basis = Basis::new(factors, degrees);
            assert_eq!(basis.len(), n);
            let at = if factors.len() == 1 {
                [0.1, 0.2, 0.3, 0.4, 0.0, 0.0]
            } else if factors.len() == 2 {
                [0.1, 0.2, 0.7, 0.4, 0.6, 0.0]
            } else {
                [0.1, 0.9, 0.3, 0.7, 0.4, 0.6]
            };
            assert!((value(&basis, &vec![1.0; n], &at) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_product_has_the_product_of_the_values() {
        let [a, b, c] = [[1, 2, 0], [2, 1, 2], [3, 3, 2]].map(|d| Basis::new(CUBE, &d));
        let numbers = |n: usize, k: usize| (0..n).map(|i| ((i * k) % 17) as f64 - 8.0).collect::<Vec<_>>();
        let (p, q) = (numbers(a.len(), 5), numbers(b.len(), 7));
        let monomial = |basis: &Basis, c: &[f64]| -> Vec<f64> {
            c.iter().enumerate().map(|(i, c)| c * basis.multinomial(i)).collect()
        };
        let product = Product::new(&a, &b, &c);
        let both =
            product.of(&monomial(&a, &p), &monomial(&b, &q), 0.0, |x: f64, y: f64| x * y, |x, y| x + y);
        let both: Vec<f64> = both.iter().enumerate().map(|(i, x)| x / c.multinomial(i)).collect();
        for at in [[0.25, 0.75, 0.5, 0.5, 0.125, 0.875], [0.0, 1.0, 1.0, 0.0, 0.3, 0.7]] {
            let expected = value(&a, &p, &at) * value(&b, &q, &at);
            assert!((value(&c, &both, &at) - expected).abs() < 1e-12 * expected.abs().max(1.0));
        }
    }
}
