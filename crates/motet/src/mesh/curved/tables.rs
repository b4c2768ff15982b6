//! The tables of each kind of cell, which lead from its nodes to the coefficients of `det J`.

use std::sync::OnceLock;

use crate::geometry::bernstein::{Basis, Domain, Exponents, Product};
use crate::mesh::CellKind;
use crate::mesh::curved::nodes::{Middle, middles};

/// A reference cell: the number of barycentric coordinates of each factor, and for each corner the
/// coordinates that are 1 there.
struct Reference {
    factors: &'static [usize],
    corners: &'static [&'static [usize]],
}

const TETRAHEDRON: Reference = Reference { factors: &[4], corners: &[&[0], &[1], &[2], &[3]] };
const PRISM: Reference =
    Reference { factors: &[3, 2], corners: &[&[0, 3], &[1, 3], &[2, 3], &[0, 4], &[1, 4], &[2, 4]] };
const CUBE: Reference = Reference {
    factors: &[2, 2, 2],
    corners: &[
        &[0, 2, 4],
        &[1, 2, 4],
        &[1, 3, 4],
        &[0, 3, 4],
        &[0, 2, 5],
        &[1, 2, 5],
        &[1, 3, 5],
        &[0, 3, 5],
    ],
};
/// The whole top is the tip, which is corner 4 of the cell.
const PYRAMID: Reference =
    Reference { factors: &[2, 2, 2], corners: &[&[0, 2, 4], &[1, 2, 4], &[1, 3, 4], &[0, 3, 4], &[5]] };

/// The directions of the three derivatives, towards the first coordinate and away from the second: a
/// right-handed frame.
const OF_TETRAHEDRON: [[usize; 2]; 3] = [[1, 0], [2, 0], [3, 0]];
const OF_PRISM: [[usize; 2]; 3] = [[1, 0], [2, 0], [4, 3]];
const OF_CUBE: [[usize; 2]; 3] = [[1, 0], [3, 2], [5, 4]];

/// The coordinate that is 0 at the tip of a pyramid.
const BASE: usize = 4;

/// The derivative of the position in one direction, as the coefficients of its monomials: a column of the
/// Jacobian.
pub(super) struct Column {
    /// Each coefficient is the difference of two points of the net, times a weight.
    pub(super) terms: Vec<([u16; 2], f64)>,
}

/// The tables of one kind of cell.
pub(super) struct Tables {
    /// The nodes that are not corners.
    pub(super) middles: Vec<Middle>,
    /// The basis of the position: degree 2 in each factor.
    pub(super) net: Basis,
    /// Each point of the net as a weighted sum of nodes.
    pub(super) points: Vec<Vec<(u8, f64)>>,
    pub(super) columns: [Column; 3],
    /// The product of the first two columns, and that of the result with the third.
    pub(super) products: [Product; 2],
    /// The basis of `det J`.
    pub(super) determinant: Basis,
    pub(super) domain: Domain,
    /// The columns of the Jacobian of the cell with straight edges, at its centre, as weights of its corners.
    pub(super) straight: [Vec<f64>; 3],
}

/// Whether cells of this kind are judged by their Jacobian: quadratic volume cells.
pub fn is_curved_kind(kind: CellKind) -> bool {
    tables(kind).is_some()
}

/// The tables of a kind, built when they are first needed; `None` if it is not a quadratic volume cell.
pub(super) fn tables(kind: CellKind) -> Option<&'static Tables> {
    static ALL: [OnceLock<Tables>; 8] = [const { OnceLock::new() }; 8];
    let (i, reference, directions) = match kind {
        CellKind::QUADRATIC_TETRA => (0, TETRAHEDRON, OF_TETRAHEDRON),
        CellKind::QUADRATIC_LINEAR_WEDGE => (1, PRISM, OF_PRISM),
        CellKind::QUADRATIC_WEDGE => (2, PRISM, OF_PRISM),
        CellKind::BIQUADRATIC_QUADRATIC_WEDGE => (3, PRISM, OF_PRISM),
        CellKind::QUADRATIC_HEXAHEDRON => (4, CUBE, OF_CUBE),
        CellKind::BIQUADRATIC_QUADRATIC_HEXAHEDRON => (5, CUBE, OF_CUBE),
        CellKind::TRIQUADRATIC_HEXAHEDRON => (6, CUBE, OF_CUBE),
        CellKind::QUADRATIC_PYRAMID => (7, PYRAMID, OF_CUBE),
        _ => return None,
    };
    Some(ALL[i].get_or_init(|| Tables::new(kind, &reference, directions)))
}

impl Tables {
    fn new(kind: CellKind, reference: &Reference, directions: [[usize; 2]; 3]) -> Self {
        let is_pyramid = kind == CellKind::QUADRATIC_PYRAMID;
        let middles = middles(kind);
        let factors = reference.factors;
        let net = Basis::new(factors, &[2; 3][..factors.len()]);
        let lattice = Lattice { reference, middles: &middles, is_pyramid };
        let points = control_points(&net, net.exponents().iter().map(|e| lattice.node_weights(e)).collect());
        let factor_of = |coordinate: usize| {
            let mut ends = factors.iter().scan(0, |end, n| {
                *end += n;
                Some(*end)
            });
            ends.position(|end| coordinate < end).unwrap_or(0)
        };
        let degrees = directions.map(|[to, _]| {
            let mut degrees = vec![2u8; factors.len()];
            degrees[factor_of(to)] -= 1;
            // Columns along the base of a pyramid vanish at its tip: that factor is divided out.
            if is_pyramid && to < BASE {
                degrees[2] -= 1;
            }
            degrees
        });
        let bases = degrees.clone().map(|degrees| Basis::new(factors, &degrees));
        let sum = |a: &[u8], b: &[u8]| a.iter().zip(b).map(|(a, b)| a + b).collect::<Vec<u8>>();
        let of_two = sum(&degrees[0], &degrees[1]);
        let cross = Basis::new(factors, &of_two);
        let determinant = Basis::new(factors, &sum(&of_two, &degrees[2]));
        let column = |i: usize| {
            let lifted = is_pyramid && directions[i][0] < BASE;
            Column::new(&net, &bases[i], directions[i], lifted)
        };
        Self {
            points,
            columns: [0, 1, 2].map(column),
            products: [
                Product::new(&bases[0], &bases[1], &cross),
                Product::new(&cross, &bases[2], &determinant),
            ],
            domain: Domain::of(&determinant),
            determinant,
            straight: directions.map(|direction| straight_column(reference, direction)),
            net,
            middles,
        }
    }
}

impl Column {
    /// The derivative towards coordinate `to` and away from `from`; if `lifted`, divided by the coordinate
    /// that is 0 at the tip of a pyramid.
    fn new(net: &Basis, basis: &Basis, [to, from]: [usize; 2], lifted: bool) -> Self {
        let term = |e: &Exponents| {
            let mut e = *e;
            e[BASE] += u8::from(lifted);
            let with = |coordinate: usize| {
                let mut e = e;
                e[coordinate] += 1;
                net.number(&e) as u16
            };
            // The derivative lowers degree 2 by one: a factor of 2, and multinomials of the remaining
            // exponents.
            let factorials: f64 = e.iter().map(|&k| if k == 2 { 2.0 } else { 1.0 }).product();
            let n_factors = net.factors().len() as i32;
            ([with(to), with(from)], 2.0f64.powi(n_factors) / factorials)
        };
        Self { terms: basis.exponents().iter().map(term).collect() }
    }
}

/// Nodes at all lattice points that functions of degree 2 need, computed where a cell has none of its own.
struct Lattice<'a> {
    reference: &'a Reference,
    middles: &'a [Middle],
    is_pyramid: bool,
}

/// Weights of the nodes of a cell, which has at most 27.
type Weights = [f64; 27];

impl Lattice<'_> {
    /// The lattice point with half these exponents as coordinates, as a weighted sum of nodes.
    fn node_weights(&self, exponents: &Exponents) -> Weights {
        if self.is_pyramid && exponents[BASE] == 0 {
            return only(4);
        }
        let mut corners = self.corners_between(exponents);
        if self.is_pyramid && exponents[BASE] == 1 {
            return match corners[..] {
                [corner] => self.middle(&[corner, 4]),
                _ => self.halfway_up(&corners),
            };
        }
        corners.sort_unstable();
        self.middle(&corners)
    }

    /// The corners of the edge, face or volume that has the lattice point in its middle; for a pyramid, those
    /// of the base.
    fn corners_between(&self, exponents: &Exponents) -> Vec<usize> {
        let is_between = |coordinates: &&[usize]| {
            coordinates.len() == self.reference.factors.len() && coordinates.iter().all(|&c| exponents[c] > 0)
        };
        let corners = self.reference.corners.iter().enumerate();
        corners.filter(|(_, coordinates)| is_between(coordinates)).map(|(i, _)| i).collect()
    }

    /// The node between these corners. If the cell has none, the value of transfinite interpolation: half the
    /// sum over the parts of one dimension less, minus a quarter of the sum over those of two dimensions
    /// less, and so on.
    fn middle(&self, corners: &[usize]) -> Weights {
        if let [corner] = corners {
            return only(*corner);
        }
        if let Some(middle) = self.middles.iter().find(|middle| middle.corners == corners) {
            return only(middle.node);
        }
        let mut sum = [0.0; 27];
        let n = corners.len();
        for part in self.parts(corners) {
            let weights = self.middle(&part);
            // 1/2, -1/4, 1/8 for parts of a half, a quarter, an eighth of the corners.
            let weight = match n / part.len() {
                2 => 0.5,
                4 => -0.25,
                _ => 0.125,
            };
            (0..27).for_each(|i| sum[i] += weight * weights[i]);
        }
        sum
    }

    /// The vertices, edges and faces of an edge, a quadrilateral or a hexahedron with these corners, found
    /// from the coordinates that corners have in common.
    fn parts(&self, corners: &[usize]) -> Vec<Vec<usize>> {
        let coordinates = |corner: usize| self.reference.corners[corner];
        let mut parts: Vec<Vec<usize>> = Vec::new();
        for &a in corners {
            for &b in corners {
                let shares = |c: usize| {
                    let fixed = coordinates(a).iter().filter(|x| coordinates(b).contains(x));
                    fixed.into_iter().all(|x| coordinates(c).contains(x))
                };
                let part: Vec<usize> = corners.iter().copied().filter(|&c| shares(c)).collect();
                if part.len() < corners.len() && !parts.contains(&part) {
                    parts.push(part);
                }
            }
        }
        parts
    }

    /// The point halfway between the tip of a pyramid and the middle of `corners` of its base. A shape
    /// function of the pyramid is `t + w q + w^2 s`, with `w` from 0 at the tip to 1 at the base, where `q`
    /// is bilinear and `s` quadratic over the base (of total degree 3); its values at the nodes determine the
    /// weights.
    fn halfway_up(&self, corners: &[usize]) -> Weights {
        let mut sum = self.middle(corners).map(|x| 0.25 * x);
        let share = 1.0 / corners.len() as f64;
        for &corner in corners {
            let up = self.middle(&[corner, 4]);
            (0..27).for_each(|i| sum[i] += share * up[i]);
            sum[corner] -= 0.25 * share;
        }
        sum
    }
}

fn only(node: usize) -> Weights {
    let mut weights = [0.0; 27];
    weights[node] = 1.0;
    weights
}

/// Converts values at the points of a lattice to Bernstein coefficients of degree 2, factor by factor: the
/// coefficient in the middle of an edge is twice the value minus the mean of the ends.
fn control_points(net: &Basis, mut weights: Vec<Weights>) -> Vec<Vec<(u8, f64)>> {
    let mut first = 0;
    for &n in net.factors() {
        let before = weights.clone();
        for (i, e) in net.exponents().iter().enumerate() {
            let ends: Vec<usize> = (first..first + n).filter(|&c| e[c] == 1).collect();
            let [a, b] = ends[..] else { continue };
            let end = |to: usize, from: usize| {
                let mut e = *e;
                (e[to], e[from]) = (2, 0);
                net.number(&e)
            };
            let [x, y] = [end(a, b), end(b, a)];
            weights[i] = std::array::from_fn(|k| 2.0 * before[i][k] - 0.5 * (before[x][k] + before[y][k]));
        }
        first += n;
    }
    let nonzero = |w: &Weights| (0u8..).zip(*w).filter(|(_, w)| *w != 0.0).collect();
    weights.iter().map(nonzero).collect()
}

/// Weights of the corners in one column of the Jacobian of the cell with straight edges, at its centre: the
/// mean of the edges in that direction; towards the tip of a pyramid, the mean of its four edges to it.
fn straight_column(reference: &Reference, [to, from]: [usize; 2]) -> Vec<f64> {
    let end = |coordinate: usize| {
        let n = reference.corners.iter().filter(|c| c.contains(&coordinate)).count() as f64;
        reference.corners.iter().map(move |c| if c.contains(&coordinate) { 1.0 / n } else { 0.0 })
    };
    end(to).zip(end(from)).map(|(to, from)| to - from).collect()
}
