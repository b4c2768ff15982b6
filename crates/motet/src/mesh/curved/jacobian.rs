//! `det J` of one quadratic cell: its sign everywhere, its least value and where that is attained.

use crate::base::Point;
use crate::geometry::bernstein::{Least, Place, least};
use crate::geometry::predicates::orient3d;
use crate::geometry::tet::{centroid, volume_6};
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
use crate::mesh::CellKind;
use crate::mesh::curved::tables::{Column, Tables, tables};

/// The determinant of the Jacobian of a quadratic cell, as a polynomial over its reference cell.
#[derive(Clone)]
pub struct Jacobian {
    tables: &'static Tables,
    /// The position in space, as Bernstein coefficients.
    net: Vec<Point>,
    /// `det J`, as Bernstein coefficients.
    coefficients: Vec<f64>,
    /// A bound on the rounding errors of the coefficients.
    rounding: f64,
    /// `det J` at the centre of the cell with straight edges.
    straight: f64,
}

/// The least `det J` of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastJacobian {
    /// The least scaled Jacobian: `det J` divided by its value at the centre of the cell with the same
    /// corners and straight edges (Gmsh's `minSJ` is a lower bound of it; Toulorge, Geuzaine, Remacle,
    /// Lambrechts 2013, *Robust untangling of curvilinear meshes*). 1 for a tet with straight edges, 0 or
    /// less if the cell is folded. If the straight cell is not upright, `det J` is divided by its largest
    /// coefficient instead.
    pub scaled: f64,
    /// `det J` there, in units of volume: for a tet with straight edges, six times its volume.
    pub determinant: f64,
    /// Where the least value is attained.
    pub place: Point,
}

/// Positive values of `det J` up to this fraction of its largest coefficient are not distinguished from 0.
const ZERO_TOLERANCE: f64 = 1e-9;
/// The least value is found to within this fraction of the largest coefficient.
const VALUE_TOLERANCE: f64 = 1e-6;
/// Bound on the rounding error of a coefficient, in units of the product of the longest columns: a few sums
/// of a few hundred terms, each off by 2^-53.
const ROUNDING: f64 = 1e-14;
/// A middle node counts as in the middle if rounding alone displaces it: by at most this many times the
/// largest coordinate.
const MIDDLE_TOLERANCE: f64 = 8.0 * f64::EPSILON;

impl Jacobian {
    /// `det J` of a cell with these nodes, in VTK's order, positive if the cell is numbered by VTK's
    /// convention. `None` if the kind is not a quadratic volume cell, or the number of nodes is wrong.
    pub fn of(kind: CellKind, nodes: &[Point]) -> Option<Self> {
        let tables = tables(kind).filter(|_| kind.n_vertices() == Some(nodes.len()))?;
        // Relative to the first node: cells far from the origin lose no digits in the products.
        let from_first: Vec<Point> = nodes.iter().map(|&p| sub(p, nodes[0])).collect();
        let weighted = |terms: &Vec<(u8, f64)>| {
            let term = |sum, &(node, weight): &(u8, f64)| add(sum, scale(from_first[node as usize], weight));
            terms.iter().fold([0.0; 3], term)
        };
        let net: Vec<Point> = tables.points.iter().map(weighted).collect();
        let [a, b, c] = [0, 1, 2].map(|i| tables.columns[i].of(&net));
        let [first, second] = &tables.products;
        let of_two = first.of(&a, &b, [0.0; 3], cross, add);
        let mut coefficients = second.of(&of_two, &c, 0.0, dot, |x: f64, y| x + y);
        for (i, x) in coefficients.iter_mut().enumerate() {
            *x /= tables.determinant.multinomial(i);
        }
        let longest = |column: &[Point]| column.iter().map(|&p| norm(p)).fold(0.0, f64::max);
        Some(Self {
            tables,
            net: net.into_iter().map(|p| add(p, nodes[0])).collect(),
            coefficients,
            rounding: ROUNDING * longest(&a) * longest(&b) * longest(&c),
            straight: straight_determinant(tables, nodes),
        })
    }

    /// `det J` of the same cell numbered the other way around.
    #[must_use]
    pub fn reversed(mut self) -> Self {
        self.coefficients.iter_mut().for_each(|x| *x = -*x);
        self.straight = -self.straight;
        self
    }

    /// Whether `det J` is positive everywhere. A least value that cannot be distinguished from 0 (within
    /// rounding, or within 1e-9 of the largest coefficient) does not count as positive.
    pub fn is_positive(&self) -> bool {
        let (rounding, close) = (self.rounding, ZERO_TOLERANCE * self.largest());
        let found = least(&self.tables.domain, &self.coefficients, |bound, value| {
            bound > rounding || value <= rounding || value - bound <= close
        });
        found.bound > rounding
    }

    /// Whether `det J` is 0 everywhere, up to rounding.
    pub fn is_zero(&self) -> bool {
        self.largest() <= self.rounding
    }

    /// A lower bound of the scaled Jacobian of the cell: the least coefficient.
    pub fn scaled_bound(&self) -> f64 {
        self.coefficients.iter().copied().fold(f64::INFINITY, f64::min) / self.scale()
    }

    /// The least `det J`, to within 1e-6 of the largest coefficient, and where it is attained.
    pub fn least(&self) -> LeastJacobian {
        let close = VALUE_TOLERANCE * self.largest();
        let Least { value, at, .. } =
            least(&self.tables.domain, &self.coefficients, |bound, value| value - bound <= close);
        LeastJacobian { scaled: value / self.scale(), determinant: value, place: self.place(&at) }
    }

    /// The divisor of the scaled Jacobian: `det J` of the straight cell at its centre or, if that is not
    /// positive, the largest coefficient, so that the sign stays. 1 if all coefficients are 0.
    fn scale(&self) -> f64 {
        let scale = if self.straight > self.rounding { self.straight } else { self.largest() };
        if scale > 0.0 { scale } else { 1.0 }
    }

    fn largest(&self) -> f64 {
        self.coefficients.iter().fold(0.0, |most: f64, x| most.max(x.abs()))
    }

    fn place(&self, at: &Place) -> Point {
        let net = self.net.iter().enumerate();
        net.fold([0.0; 3], |sum, (i, &p)| add(sum, scale(p, self.tables.net.value(i, at))))
    }
}

impl Column {
    /// The coefficients of this column for the cell with the Bernstein coefficients `net`.
    fn of(&self, net: &[Point]) -> Vec<Point> {
        let difference = |&([to, from], weight): &([u16; 2], f64)| {
            scale(sub(net[to as usize], net[from as usize]), weight)
        };
        self.terms.iter().map(difference).collect()
    }
}

/// `det J` at the centre of the cell with the same corners and straight edges.
fn straight_determinant(tables: &Tables, nodes: &[Point]) -> f64 {
    let [a, b, c] = tables.straight.each_ref().map(|weights| {
        let parts = weights.iter().zip(nodes).map(|(w, &p)| scale(sub(p, nodes[0]), *w));
        parts.fold([0.0; 3], add)
    });
    dot(cross(a, b), c)
}

/// The orientation of the cell with the same corners and straight edges: positive if it is numbered by VTK's
/// convention; 0 for kinds other than quadratic volume cells.
pub(super) fn straight_sign(kind: CellKind, nodes: &[Point]) -> i64 {
    let straight = tables(kind).map_or(0.0, |tables| straight_determinant(tables, nodes));
    i64::from(straight > 0.0) - i64::from(straight < 0.0)
}

/// What [`Jacobian::least`] finds for a quadratic tet whose edges are straight up to rounding; `None` for
/// other cells.
pub(super) fn least_of_straight_tet(
    kind: CellKind,
    nodes: &[Point],
    is_reversed: bool,
) -> Option<LeastJacobian> {
    if kind != CellKind::QUADRATIC_TETRA || !is_straight(kind, nodes) {
        return None;
    }
    let corners = [nodes[0], nodes[1], nodes[2], nodes[3]];
    let side = if is_reversed { -1.0 } else { 1.0 };
    Some(LeastJacobian {
        scaled: side * f64::from(orient3d(corners[0], corners[1], corners[2], corners[3]).signum()) + 0.0,
        determinant: side * volume_6(corners),
        place: centroid(corners),
    })
}

/// Whether a quadratic cell is upright: `det J` is positive everywhere, or negative if `is_reversed`. A tet
/// whose edges are straight up to rounding is judged by the exact sign of its volume. `false` for kinds other
/// than quadratic volume cells.
pub fn is_upright(kind: CellKind, nodes: &[Point], is_reversed: bool) -> bool {
    if kind == CellKind::QUADRATIC_TETRA && is_straight(kind, nodes) {
        let sign = orient3d(nodes[0], nodes[1], nodes[2], nodes[3]);
        return if is_reversed { sign < 0 } else { sign > 0 };
    }
    let jacobian = Jacobian::of(kind, nodes);
    jacobian.is_some_and(|jacobian| if is_reversed { jacobian.reversed() } else { jacobian }.is_positive())
}

/// Whether all middle nodes are in the middle of their corners, up to rounding.
fn is_straight(kind: CellKind, nodes: &[Point]) -> bool {
    let Some(tables) = tables(kind) else { return false };
    tables.middles.iter().all(|middle| {
        let corners = middle.corners.iter().map(|&c| nodes[c]);
        let mean = scale(corners.clone().fold([0.0; 3], add), 1.0 / middle.corners.len() as f64);
        let largest = corners.flatten().fold(0.0, |most: f64, x| most.max(x.abs()));
        sub(nodes[middle.node], mean).iter().all(|x| x.abs() <= MIDDLE_TOLERANCE * largest)
    })
}
