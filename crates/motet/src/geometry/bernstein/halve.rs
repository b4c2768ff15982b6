//! Cuts a domain in two through the middle of an edge.

use crate::base::Csr;
use crate::geometry::bernstein::Basis;

/// The cut through the middle of one edge of the domain.
#[derive(Clone, Debug)]
pub(super) struct Cut {
    /// The indices of the barycentric coordinates that belong to the two ends of the edge.
    pub(super) ends: [usize; 2],
    /// Rows of coefficients whose exponents differ in these two coordinates only, from the first end to the
    /// second: each row is a polynomial in one variable.
    rows: Csr<u16>,
}

impl Cut {
    /// All cuts of a domain: one for each edge of each factor.
    pub(super) fn all(basis: &Basis) -> Vec<Self> {
        let mut cuts = Vec::new();
        let mut first = 0;
        for &n in basis.factors() {
            for a in first..first + n {
                cuts.extend((a + 1..first + n).map(|b| Self::new(basis, [a, b])));
            }
            first += n;
        }
        cuts
    }

    fn new(basis: &Basis, ends: [usize; 2]) -> Self {
        let mut rows = Csr::default();
        let [a, b] = ends;
        for start in basis.exponents().iter().filter(|e| e[b] == 0) {
            let along = (0..=start[a]).map(|k| {
                let mut e = *start;
                (e[a], e[b]) = (start[a] - k, k);
                basis.number(&e) as u16
            });
            rows.push(along);
        }
        Self { ends, rows }
    }

    /// How far the coefficients along the edge are from a straight line: their largest second difference.
    pub(super) fn bend(&self, coefficients: &[f64]) -> f64 {
        let at = |i: u16| coefficients[i as usize];
        let bends = self.rows.iter().flat_map(|row| row.windows(3));
        bends.map(|w| (at(w[0]) - 2.0 * at(w[1]) + at(w[2])).abs()).fold(0.0, f64::max)
    }

    /// The coefficients of the half at the first end and of the half at the second (de Casteljau's algorithm,
    /// row by row).
    pub(super) fn halves(&self, coefficients: &[f64]) -> [Vec<f64>; 2] {
        let (mut near, mut far) = (coefficients.to_vec(), coefficients.to_vec());
        let mut row = Vec::new();
        for places in self.rows.iter() {
            row.clear();
            row.extend(places.iter().map(|&i| coefficients[i as usize]));
            for level in (0..row.len()).rev() {
                let done = row.len() - 1 - level;
                near[places[done] as usize] = row[0];
                far[places[level] as usize] = row[level];
                (0..level).for_each(|i| row[i] = 0.5 * (row[i] + row[i + 1]));
            }
        }
        [near, far]
    }
}
