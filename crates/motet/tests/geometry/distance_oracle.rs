//! The exact distance of two simplices, by another method than the library's: the least of the distances
//! between the affine hulls of any two faces whose closest points lie within both faces.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};

/// A point of an integer grid.
pub(crate) type Grid = [i64; 3];

fn dot(a: &Grid, b: &Grid) -> BigInt {
    (0..3).map(|k| BigInt::from(a[k]) * BigInt::from(b[k])).sum()
}

fn sub(a: &Grid, b: &Grid) -> Grid {
    [0, 1, 2].map(|k| a[k] - b[k])
}

/// Expansion along the first row; at most 4 rows.
fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    if rows.is_empty() {
        return BigInt::from(1);
    }
    let minor = |column: usize| -> Vec<Vec<BigInt>> {
        let without =
            |row: &Vec<BigInt>| (0..row.len()).filter(|&k| k != column).map(|k| row[k].clone()).collect();
        rows[1..].iter().map(without).collect()
    };
    let signed = |column: usize| {
        if column.is_multiple_of(2) { rows[0][column].clone() } else { -rows[0][column].clone() }
    };
    (0..rows.len()).filter(|&c| !rows[0][c].is_zero()).map(|c| signed(c) * determinant(&minor(c))).sum()
}

/// Squared distance of the affine hulls of `a` and `b`, if they have a unique pair of closest points that
/// lies within both.
fn of_hulls(a: &[Grid], b: &[Grid]) -> Option<BigRational> {
    let from = sub(&a[0], &b[0]);
    let mut along: Vec<Grid> = a[1..].iter().map(|p| sub(p, &a[0])).collect();
    along.extend(b[1..].iter().map(|p| sub(&b[0], p)));
    // |from + sum x_i along_i| is least where gram x = right; Cramer's rule.
    let gram: Vec<Vec<BigInt>> = along.iter().map(|u| along.iter().map(|v| dot(u, v)).collect()).collect();
    let right: Vec<BigInt> = along.iter().map(|u| -dot(u, &from)).collect();
    let all = determinant(&gram);
    if all.is_zero() {
        return None;
    }
    let parts: Vec<BigInt> = (0..along.len())
        .map(|i| {
            let mut replaced = gram.clone();
            replaced.iter_mut().zip(&right).for_each(|(row, r)| row[i] = r.clone());
            determinant(&replaced)
        })
        .collect();
    let (of_a, of_b) = parts.split_at(a.len() - 1);
    let fits = |parts: &[BigInt]| parts.iter().sum::<BigInt>() <= all;
    if parts.iter().any(BigInt::is_negative) || !fits(of_a) || !fits(of_b) {
        return None;
    }
    let gained: BigInt = parts.iter().zip(&right).map(|(x, r)| x * r).sum();
    Some(BigRational::new(dot(&from, &from) * &all - gained, all))
}

fn faces(points: &[Grid]) -> Vec<Vec<Grid>> {
    let chosen = |mask: usize| (0..points.len()).filter(|i| mask >> i & 1 == 1).map(|i| points[i]).collect();
    (1..1 << points.len()).map(chosen).collect()
}

/// The squared distance of two simplices. A closest pair within the smallest possible faces is the unique one
/// of their hulls, so it is among those examined.
pub(crate) fn distance_squared(a: &[Grid], b: &[Grid]) -> BigRational {
    let pairs = faces(a).into_iter().flat_map(|x| faces(b).into_iter().map(move |y| (x.clone(), y)));
    pairs.filter_map(|(x, y)| of_hulls(&x, &y)).min().expect("two vertices have a distance")
}

/// The distance, rounded.
pub(crate) fn distance(a: &[Grid], b: &[Grid]) -> f64 {
    distance_squared(a, b).to_f64().expect("a grid is not that large").sqrt()
}
