//! Criteria based on the arrays of a mesh: sizes, gradients, error estimates, vortices.

use super::array::{On, column, point_columns, point_vectors};
use super::{Aim, Amount, Criterion, Estimator, HessianSizes, Size, fraction, non_negative, positive};
use crate::base::{Error, Point, Result, Threads};
use crate::geometry::vector::{dot, norm, sub};
use crate::mesh::{Field, Mesh, TetMesh, TetPart, bounds};
use crate::refine::estimate::{self, corners, longest_edge};
use crate::refine::hessian::curvatures;
use crate::refine::wish::Wish;
use crate::refine::{mark, sizes};

/// The ratio of the squared estimate of a tet to that of one of its eight parts, where the field is smooth:
/// jumps and differences of gradients scale with the length, areas with its square, and so the estimates with
/// the power 5/2.
const PARENT_SQUARED: f64 = 32.0;

/// A field that bends over the extent of the mesh by less than this fraction of its range counts as linear:
/// the rest is rounding.
const ROUNDING: f64 = 1e-9;

pub(super) fn size(size: &Size, mesh: &Mesh, part: &TetPart, threads: &Threads) -> Result<Vec<Wish>> {
    let tets = &part.mesh;
    let name = match size {
        Size::Uniform(h) => return Ok(by_ratio(part, threads, |t| longest(part, t) / h)),
        Size::Array(name) => name,
    };
    let column = column(mesh, name)?;
    let check = |row: usize, what: &str| match column.values[row] {
        h if h > 0.0 => Ok(()),
        h => Err(Error::input(format!("the size {h} is not a valid edge length"))
            .at(format!("array {name}, {what} {row}"))
            .remedy(format!("give every {what} of a tet a number above 0"))),
    };
    match column.on {
        On::Points => {
            tets.tets.as_flattened().iter().try_for_each(|v| check(v.index(), "point"))?;
            Ok(sizes::wishes(tets, &column.values, threads))
        }
        On::Cells => {
            part.tet_to_cell.iter().try_for_each(|cell| check(cell.index(), "cell"))?;
            Ok(by_ratio(part, threads, |t| longest(part, t) / column.values[part.tet_to_cell[t].index()]))
        }
    }
}

fn longest(part: &TetPart, t: usize) -> f64 {
    longest_edge(corners(&part.mesh, part.mesh.tets[t]))
}

fn by_ratio(part: &TetPart, threads: &Threads, ratio: impl Fn(usize) -> f64 + Sync + Send) -> Vec<Wish> {
    threads.map(part.mesh.tets.len(), |t| Wish::of_ratio(ratio(t)))
}

pub(super) fn gradient(
    array: &str,
    above: f64,
    mesh: &Mesh,
    part: &TetPart,
    threads: &Threads,
) -> Result<Vec<Wish>> {
    let mut squares = vec![0.0; part.mesh.tets.len()];
    for values in point_columns(mesh, array)? {
        let gradients = estimate::gradients(&part.mesh, &values, threads);
        squares.iter_mut().zip(gradients).for_each(|(sum, gradient)| *sum += dot(gradient, gradient));
    }
    let change = |t: usize| squares[t].sqrt() * longest(part, t);
    // Across a tet twice as large the change is twice as much. Fields may be steep everywhere, so how often
    // to divide is not estimated.
    Ok(threads.map(squares.len(), |t| match change(t) {
        change if change > above => Wish::Divided(1),
        change if 2.0 * change > above => Wish::Kept,
        _ => Wish::Coarser,
    }))
}

pub(super) fn estimate(
    array: &str,
    by: Estimator,
    amount: Amount,
    mesh: &Mesh,
    part: &TetPart,
    threads: &Threads,
) -> Result<Vec<Wish>> {
    let estimator = match by {
        Estimator::Jump => estimate::gradient_jump,
        Estimator::Recovery => estimate::recovery,
    };
    let mut squares = vec![0.0; part.mesh.tets.len()];
    for values in point_columns(mesh, array)? {
        let estimates = estimator(&part.mesh, &values, threads);
        squares.iter_mut().zip(estimates).for_each(|(sum, estimate)| *sum += estimate * estimate);
    }
    let estimates: Vec<f64> = squares.iter().map(|square| square.sqrt()).collect();
    let marks = match amount {
        Amount::Share(share) => mark::largest_share(&estimates, share),
        Amount::Tets(n) => mark::to_count(&estimates, n),
    };
    let least = marks.iter().map(|t| squares[t.index()]).fold(f64::INFINITY, f64::min);
    let mut wishes: Vec<Wish> = squares
        .iter()
        .map(|square| if PARENT_SQUARED * square < least { Wish::Coarser } else { Wish::Kept })
        .collect();
    marks.iter().for_each(|t| wishes[t.index()] = Wish::Divided(1));
    Ok(wishes)
}

/// Marks tets where a quantity derived from a velocity is above a value.
pub(super) fn flow(
    array: &str,
    above: f64,
    mesh: &Mesh,
    part: &TetPart,
    of: impl Fn(&TetMesh, &[Point]) -> Vec<f64>,
) -> Result<Vec<Wish>> {
    let found = of(&part.mesh, &point_vectors(mesh, array)?);
    Ok(found.into_iter().map(|x| Wish::of_mark(x > above)).collect())
}

impl HessianSizes {
    pub(super) fn check(&self) -> Result<()> {
        if self.arrays.is_empty() {
            return Err(Error::options("sizes from second derivatives need an array"));
        }
        match self.aim {
            Aim::Error(error) => positive("the error", error)?,
            Aim::RangePart(part) => fraction("the error as a fraction of the range", part)?,
            Aim::Tets(_) => {}
        }
        non_negative("the smallest size", self.limits.smallest)?;
        if !(self.limits.largest >= self.limits.smallest && self.limits.largest > 0.0) {
            return Err(Error::options(format!(
                "the largest size, {}, is below the smallest, {}",
                self.limits.largest, self.limits.smallest
            )));
        }
        match self.limits.growth >= 0.0 {
            true => Ok(()),
            false => non_negative("the growth of sizes", self.limits.growth),
        }
    }

    pub(super) fn wishes(&self, mesh: &Mesh, part: &TetPart, threads: &Threads) -> Result<Vec<Wish>> {
        Ok(sizes::wishes(&part.mesh, &self.sizes(mesh, part, threads)?, threads))
    }

    /// Puts the sizes into the mesh as a point array, and returns the criterion that divides until edges are
    /// no longer than that.
    ///
    /// Arrays are linear in each tet of the mesh they were computed on. Transferred to its parts, they have
    /// no curvature within these and too much between them; so sizes are computed once for each solution and
    /// transferred themselves. They are capped at the extent of the mesh.
    ///
    /// # Errors
    /// The errors of [`sizes`](Self::sizes).
    pub fn put(&self, mesh: &mut Mesh, part: &TetPart, name: &str, threads: &Threads) -> Result<Criterion> {
        let mut sizes = self.sizes(mesh, part, threads)?;
        let [low, high] = bounds(&mesh.points).unwrap_or_default();
        let extent = norm(sub(high, low));
        sizes.iter_mut().for_each(|size| *size = size.min(extent));
        mesh.set_point_field(Field::scalars(name, sizes));
        Ok(Criterion::Size(Size::Array(name.to_owned())))
    }

    /// Returns the size at each vertex.
    ///
    /// # Errors
    /// When the mesh has no such point array, or when a number is invalid.
    pub fn sizes(&self, mesh: &Mesh, part: &TetPart, threads: &Threads) -> Result<Vec<f64>> {
        self.check()?;
        let mut least = vec![f64::INFINITY; mesh.points.len()];
        let [low, high] = bounds(&mesh.points).unwrap_or_default();
        let extent_squared = dot(sub(high, low), sub(high, low));
        for array in &self.arrays {
            let columns = point_columns(mesh, array)?;
            let mut curvatures = curvatures(&part.mesh, columns.iter().map(Vec::as_slice), threads);
            let range = range(&columns, part);
            let min_curvature = ROUNDING * range / extent_squared;
            curvatures
                .iter_mut()
                .filter(|curvature| **curvature < min_curvature)
                .for_each(|curvature| *curvature = 0.0);
            let of_array = match self.aim {
                Aim::Error(error) => sizes::for_error(&curvatures, error),
                Aim::RangePart(share) => sizes::for_error(&curvatures, share * range),
                Aim::Tets(_) => {
                    curvatures.iter_mut().for_each(|curvature| *curvature /= range);
                    sizes::for_mean_square(&curvatures)
                }
            };
            // A constant array requests nothing.
            let pairs = least.iter_mut().zip(of_array).filter(|_| range > 0.0);
            pairs.for_each(|(least, size)| *least = least.min(size));
        }
        if let Aim::Tets(n) = self.aim {
            return Ok(sizes::for_count(&part.mesh, &least, &self.limits, n, threads));
        }
        self.limits.apply(&part.mesh, &mut least);
        Ok(least)
    }
}

/// The largest value less the smallest at vertices of tets; the largest over all components.
fn range(columns: &[Vec<f64>], part: &TetPart) -> f64 {
    let of_column = |values: &Vec<f64>| {
        let used = part.mesh.tets.as_flattened().iter().map(|v| values[v.index()]);
        let [low, high] =
            used.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)]);
        (high - low).max(0.0)
    };
    columns.iter().map(of_column).fold(0.0, f64::max)
}
