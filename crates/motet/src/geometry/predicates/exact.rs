//! The last stage: determinants of coordinates without any rounding, for every finite `f64`.
//!
//! Coordinates become integer multiples of the largest common power of two. Where all differences stay below
//! 2^61 (as for points of a grid, even one of step 0.1), integers of fixed width suffice: about 0.1 us for a
//! tie of five grid points, where floating-point expansions (Shewchuk 1997) took 0.9 us. All else uses
//! integers of any width, up to some 10,000 bits for points that span the whole range of `f64`.

use super::integer::{Big, Fixed};
use crate::base::Point;

/// A row of a determinant: the difference of two points in units of the common power of two.
type Row = [i64; 3];
type BigRow = [Big; 3];

/// Sign of `(b-a) x (c-a) . (d-a)`.
#[cold]
#[inline(never)]
pub(crate) fn orient3d(a: Point, others: [Point; 3]) -> i8 {
    match small_rows(a, others) {
        Some([b, c, d]) => det3_small(b, c, d).sign(),
        None => {
            let [b, c, d] = big_rows(a, others);
            det3(&b, &c, &d).sign()
        }
    }
}

/// Sign of the in-sphere determinant of `others` = b, c, d, e relative to `a`: positive when
/// e lies inside the sphere of a positively oriented tet a, b, c, d.
#[cold]
#[inline(never)]
pub(crate) fn insphere(a: Point, others: [Point; 4]) -> i8 {
    match small_rows(a, others) {
        Some(rows) => insphere_small(rows),
        None => insphere_big(&big_rows(a, others)),
    }
}

/// Determinants `(b-a) x (c-a) . (d-a)` of several tets as floats, each accurate to the last digits and all
/// divided by one power of two, so that their ratios are accurate too.
#[cold]
#[inline(never)]
pub(crate) fn orient3d_ratios<const N: usize>(tets: [[Point; 4]; N]) -> [f64; N] {
    let all: Vec<Point> = tets.iter().flatten().copied().collect();
    let unit = common_exponent(&all);
    let determinants = tets.map(|[a, b, c, d]| {
        let row = |p: Point| big_difference(p, a, unit);
        det3(&row(b), &row(c), &row(d))
    });
    let bits = determinants.iter().map(Big::bits).max().unwrap_or(0);
    determinants.map(|x| x.ratio_to_power(bits))
}

/// The number `mantissa * 2^exponent`.
#[derive(Clone, Copy)]
struct Dyadic {
    /// Odd, or zero.
    mantissa: i64,
    /// `i32::MAX` for zero.
    exponent: i32,
}

impl Dyadic {
    /// The number as a multiple of `2^unit`, which divides it.
    fn in_big_units(self, unit: i32) -> Big {
        Big::shifted(self.mantissa, if self.mantissa == 0 { 0 } else { self.exponent.abs_diff(unit) })
    }
}

/// Decodes a finite number.
#[inline]
fn decode(x: f64) -> Dyadic {
    let bits = x.to_bits();
    let biased = ((bits >> 52) & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let (mantissa, exponent) =
        if biased == 0 { (fraction, -1074) } else { (fraction | 1 << 52, biased - 1075) };
    if mantissa == 0 {
        return Dyadic { mantissa: 0, exponent: i32::MAX };
    }
    let zeros = mantissa.trailing_zeros();
    let odd = mantissa >> zeros;
    Dyadic { mantissa: if x < 0.0 { -odd } else { odd }, exponent: exponent + zeros as i32 }
}

/// The exponent of the largest power of two of which all coordinates are integer multiples.
fn common_exponent(points: &[Point]) -> i32 {
    points.iter().flatten().map(|&x| decode(x).exponent).min().unwrap_or(0)
}

/// `x` in units of `2^unit`, if that stays below 2^120.
#[inline]
fn in_units(x: Dyadic, unit: i32) -> Option<i128> {
    let shift = if x.mantissa == 0 { 0 } else { x.exponent - unit };
    (shift <= 66).then(|| i128::from(x.mantissa) << shift)
}

/// The differences from `a` in common units, if all stay below 2^61.
#[inline]
fn small_rows<const N: usize>(a: Point, others: [Point; N]) -> Option<[Row; N]> {
    let origin = a.map(decode);
    let decoded = others.map(|p| p.map(decode));
    let unit = decoded.iter().flatten().chain(&origin).map(|x| x.exponent).min()?;
    let mut rows = [[0; 3]; N];
    for i in 0..3 {
        let from = in_units(origin[i], unit)?;
        for (row, point) in rows.iter_mut().zip(&decoded) {
            let difference = in_units(point[i], unit)? - from;
            row[i] = i64::try_from(difference).ok().filter(|d| d.unsigned_abs() < 1 << 61)?;
        }
    }
    Some(rows)
}

/// `p_x q_y - p_y q_x`, below 2^123.
#[inline]
fn minor_small(p: Row, q: Row) -> i128 {
    i128::from(p[0]) * i128::from(q[1]) - i128::from(p[1]) * i128::from(q[0])
}

#[inline]
fn det3_small(p: Row, q: Row, r: Row) -> Fixed<3> {
    det3_of_minors(p[2], minor_small(q, r), q[2], minor_small(r, p), r[2], minor_small(p, q))
}

/// `a x + b y + c z`: three products of 61 and 123 bits.
#[inline]
fn det3_of_minors(a: i64, x: i128, b: i64, y: i128, c: i64, z: i128) -> Fixed<3> {
    let wide = |x: i128| Fixed::<2>::from(x).resized::<3>();
    let product = |a: i64, x: i128| wide(a.into()).times(wide(x));
    product(a, x).plus(product(b, y)).plus(product(c, z))
}

/// The sign of |b|^2 [c,d,x] - |c|^2 [b,d,x] + |d|^2 [b,c,x] - |x|^2 [b,c,d], which stays below 2^313.
fn insphere_small([b, c, d, x]: [Row; 4]) -> i8 {
    let squared = |p: Row| p.iter().map(|&v| i128::from(v) * i128::from(v)).sum::<i128>();
    let lifted = |p: Row, det: Fixed<3>| Fixed::<2>::from(squared(p)).resized::<5>().times(det.resized());
    let plus = lifted(b, det3_small(c, d, x)).plus(lifted(d, det3_small(b, c, x)));
    let minus = lifted(c, det3_small(b, d, x)).plus(lifted(x, det3_small(b, c, d)));
    plus.minus(minus).sign()
}

fn big_difference(p: Point, a: Point, unit: i32) -> BigRow {
    std::array::from_fn(|i| in_big_units(p[i], unit).minus(&in_big_units(a[i], unit)))
}

fn big_rows<const N: usize>(a: Point, others: [Point; N]) -> [BigRow; N] {
    let unit = common_exponent(&others).min(common_exponent(&[a]));
    others.map(|p| big_difference(p, a, unit))
}

fn det3(p: &BigRow, q: &BigRow, r: &BigRow) -> Big {
    let minor = |a: &BigRow, b: &BigRow| a[0].times(&b[1]).minus(&a[1].times(&b[0]));
    let sum = p[2].times(&minor(q, r)).plus(&q[2].times(&minor(r, p)));
    sum.plus(&r[2].times(&minor(p, q)))
}

fn insphere_big([b, c, d, x]: &[BigRow; 4]) -> i8 {
    let squared = |p: &BigRow| p.iter().map(|v| v.times(v)).fold(Big::default(), |sum, v| sum.plus(&v));
    let lifted = |p: &BigRow, det: Big| squared(p).times(&det);
    let plus = lifted(b, det3(c, d, x)).plus(&lifted(d, det3(b, c, x)));
    let minus = lifted(c, det3(b, d, x)).plus(&lifted(x, det3(b, c, d)));
    plus.minus(&minus).sign()
}

/// A point with exact coordinates of any length: integer multiples of a power of two.
pub(crate) struct Exact {
    units: BigRow,
    exponent: i32,
}

impl Exact {
    /// A point with the given coordinates.
    pub(crate) fn given(p: Point) -> Self {
        let exponent = common_exponent(&[p]);
        Self { units: p.map(|x| in_big_units(x, exponent)), exponent }
    }

    /// The point `from + s (to - from) + t (third - from)`.
    pub(crate) fn between(from: Point, to: [Point; 2], shares: [f64; 2]) -> Self {
        let unit = common_exponent(&[from, to[0], to[1]]);
        let shares = shares.map(decode);
        // Shares below 1 have exponents below 0, so a unit of the corners is an integer multiple of the
        // result's.
        let down = shares[0].exponent.min(shares[1].exponent).min(0);
        let shares = shares.map(|share| share.in_big_units(down));
        let coordinate = |i: usize| {
            let start = in_big_units(from[i], unit);
            let along = |k: usize| in_big_units(to[k][i], unit).minus(&start).times(&shares[k]);
            in_big_units(from[i], unit.saturating_add(down)).plus(&along(0)).plus(&along(1))
        };
        Self { units: [coordinate(0), coordinate(1), coordinate(2)], exponent: unit.saturating_add(down) }
    }

    fn is_origin(&self) -> bool {
        self.units.iter().all(|x| x.sign() == 0)
    }

    /// The coordinates as multiples of a smaller power of two.
    fn in_units(&self, exponent: i32) -> BigRow {
        let factor = Big::shifted(1, self.exponent.abs_diff(exponent));
        std::array::from_fn(|i| self.units[i].times(&factor))
    }
}

/// `x` as a multiple of `2^unit`, which divides it.
fn in_big_units(x: f64, unit: i32) -> Big {
    decode(x).in_big_units(unit)
}

/// The exponent of the largest power of two of which all coordinates of the points are known to be multiples.
fn unit_of(points: &[Exact]) -> i32 {
    points.iter().filter(|p| !p.is_origin()).map(|p| p.exponent).min().unwrap_or(0)
}

/// Differences from the first point, in one common unit.
fn rows_of<const N: usize, const M: usize>(points: &[Exact; N], unit: i32) -> [BigRow; M] {
    let units = |p: &Exact| if p.is_origin() { Default::default() } else { p.in_units(unit) };
    let origin = units(&points[0]);
    std::array::from_fn(|k| {
        let p = units(&points[k + 1]);
        std::array::from_fn(|i| p[i].minus(&origin[i]))
    })
}

/// [`orient3d`] for points with coordinates of any length.
#[cold]
pub(crate) fn orient3d_of(points: [Exact; 4]) -> i8 {
    let [b, c, d] = rows_of(&points, unit_of(&points));
    det3(&b, &c, &d).sign()
}

/// [`orient3d_ratios`] for points with coordinates of any length.
#[cold]
pub(crate) fn orient3d_ratios_of<const N: usize>(tets: [[Exact; 4]; N]) -> [f64; N] {
    let unit = tets.iter().map(|points| unit_of(points)).min().unwrap_or(0);
    let determinants = tets.map(|points| {
        let [b, c, d] = rows_of(&points, unit);
        det3(&b, &c, &d)
    });
    let bits = determinants.iter().map(Big::bits).max().unwrap_or(0);
    determinants.map(|x| x.ratio_to_power(bits))
}

/// [`insphere`] for points with coordinates of any length.
#[cold]
pub(crate) fn insphere_of(points: [Exact; 5]) -> i8 {
    insphere_big(&rows_of(&points, unit_of(&points)))
}
