//! What to refine in a whole mesh: by place, region, patch, size, or values of its arrays.
//!
//! A criterion is evaluated anew in every generation, with the arrays as transferred to the current mesh, and
//! returns a [wish](Wish) for each tet.

mod array;
mod by_field;
mod by_place;
mod condition;
mod fixed;
mod target;
mod text;

use std::sync::Arc;

use super::estimate;
use super::sizes::SizeLimits;
use super::wish::{Wish, marked};
use crate::base::{Error, Point, Result, TetId, Threads};
use crate::geometry::vector::norm;
use crate::mesh::{Mesh, TetPart};

pub use condition::{Condition, Relation};
pub use fixed::fix_sizes;
pub use target::Target;
pub(in crate::refine) use text::Stated;

/// What to refine. Lengths are in the units of the mesh, values in those of its arrays; an array is named as
/// in [`Condition::array`].
#[derive(Clone, Debug)]
pub enum Criterion {
    /// All tets, once more.
    All,
    /// Tets that come within a ball.
    Ball {
        /// The centre of the ball.
        centre: Point,
        /// The radius of the ball, 0 or more.
        radius: f64,
    },
    /// Tets whose centre lies in an axis-aligned box, given by its lowest and highest corner.
    Box([Point; 2]),
    /// Tets near a surface.
    Near {
        /// The surface.
        target: Arc<Target>,
        /// The largest distance from the surface, 0 or more.
        within: f64,
    },
    /// Tets with an edge longer than `size` plus `growth` times the distance of the tet from a surface.
    NearSize {
        /// The surface.
        target: Arc<Target>,
        /// The edge length at the surface, above 0.
        size: f64,
        /// By how much the edge length grows per unit of distance, 0 or more.
        growth: f64,
    },
    /// Tets of a region, given by name or number.
    Region(String),
    /// Tets at a patch, given by name or number.
    Patch {
        /// The name or number of the patch.
        patch: String,
        /// The largest distance from the patch. `None`: only tets that have a vertex on it.
        within: Option<f64>,
    },
    /// Tets with an edge that is too long.
    Size(Size),
    /// Tets where a condition on an array holds: for a cell array, at the tet itself; for a point array, at
    /// one or more of its vertices.
    Where(Condition),
    /// Tets across which a field changes a lot: its gradient times the longest edge is above a value. The
    /// components of a vector are combined by the root of the sum of squares.
    Gradient {
        /// The name of a point array.
        array: String,
        /// The change above which tets are divided, in units of the array.
        above: f64,
    },
    /// Tets whose error estimate is among the largest.
    Estimate {
        /// The name of a point array. Its components are combined by the root of the sum of squares.
        array: String,
        /// Which estimate.
        by: Estimator,
        /// How many tets.
        amount: Amount,
    },
    /// Tets with edges too long for the curvature of fields.
    Hessian(HessianSizes),
    /// Tets in which the magnitude of the [vorticity](super::estimate::vorticity) is above a value.
    Vorticity {
        /// The velocity, an array of vectors on points.
        array: String,
        /// The value above which tets are divided, in units of velocity over length.
        above: f64,
    },
    /// Tets in which the [Q criterion](super::estimate::q_criterion) is above a value.
    Q {
        /// The velocity, an array of vectors on points.
        array: String,
        /// The value above which tets are divided, in squared units of velocity over length.
        above: f64,
    },
}

/// Prescribed edge lengths.
#[derive(Clone, Debug, PartialEq)]
pub enum Size {
    /// One length everywhere, above 0.
    Uniform(f64),
    /// Given by an array. On points: an edge has the mean of the sizes at its ends. On cells: the size
    /// applies to all edges of the tet. Infinite: no limit.
    Array(String),
}

/// An error estimator for a field in each tet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimator {
    /// By the [jumps of the gradient](super::estimate::gradient_jump).
    Jump,
    /// By the distance of the gradient from a [recovered one](super::estimate::recovery).
    Recovery,
}

/// How many of the tets with the largest estimates to divide.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// The fewest that make up this [share](super::mark::largest_share) of the sum of squares, in (0, 1].
    Share(f64),
    /// As many as bring the mesh to about this [number of tets](super::mark::to_count) when divided.
    Tets(usize),
}

/// Sizes from second derivatives: edges short enough that no field differs from its linear interpolant by
/// more than is allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct HessianSizes {
    /// Names of point arrays. Each component of a vector counts by itself; the smallest size wins.
    pub arrays: Vec<String>,
    /// What the sizes aim for.
    pub aim: Aim,
    /// The limits on sizes.
    pub limits: SizeLimits,
}

/// What sizes from second derivatives aim for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// The error of each array is at most this, in its units.
    Error(f64),
    /// The error is at most this fraction of the range of the array, its largest value less its smallest; for
    /// vectors, of the largest range of any component.
    RangePart(f64),
    /// There are about this many tets, and the mean square of the errors relative to the ranges is least.
    /// Where a mesh is too coarse to resolve the curvature of a field, request a few times as many tets from
    /// one solution to the next.
    Tets(usize),
}

impl Criterion {
    /// Whether the criterion prescribes edge lengths, which are reached at some point. Other criteria mark
    /// the parts of what they marked again.
    pub fn lasts(&self) -> bool {
        matches!(self, Self::NearSize { .. } | Self::Size(_) | Self::Hessian(_))
    }

    /// Rejects invalid numbers, before any mesh is examined.
    ///
    /// # Errors
    /// When a number is invalid; the error names the first.
    pub fn check(&self) -> Result<()> {
        match self {
            Self::All | Self::Region(_) | Self::Size(Size::Array(_)) => Ok(()),
            Self::Ball { centre, radius } => {
                centre.iter().try_for_each(|x| finite("the centre of a ball", *x))?;
                non_negative("the radius of a ball", *radius)
            }
            Self::Box(corners) => by_place::check_box(*corners),
            Self::Near { within, .. } => non_negative("the distance from a surface", *within),
            Self::NearSize { size, growth, .. } => {
                positive("the size at a surface", *size)?;
                non_negative("the growth of sizes", *growth)
            }
            Self::Patch { within, .. } => non_negative("the distance from a patch", within.unwrap_or(0.0)),
            Self::Size(Size::Uniform(size)) => positive("the size", *size),
            Self::Where(condition) => condition.check(),
            Self::Gradient { above, .. } => finite("the change through a tet", *above),
            Self::Estimate { amount, .. } => match amount {
                Amount::Share(share) => fraction("the fraction of the error", *share),
                Amount::Tets(_) => Ok(()),
            },
            Self::Hessian(sizes) => sizes.check(),
            Self::Vorticity { above, .. } => finite("the vorticity", *above),
            Self::Q { above, .. } => finite("Q", *above),
        }
    }

    /// Returns a wish for each tet of `part`, the tets of `mesh`.
    ///
    /// # Errors
    /// When a [number](Self::check) is invalid; when the mesh has no such array, region or patch (the error
    /// lists those there are); when an array lacks the required components or has an invalid size.
    pub fn wishes(&self, mesh: &Mesh, part: &TetPart, threads: &Threads) -> Result<Vec<Wish>> {
        self.check()?;
        match self {
            Self::All => Ok(vec![Wish::Divided(1); part.mesh.tets.len()]),
            Self::Size(size) => by_field::size(size, mesh, part, threads),
            Self::Where(condition) => {
                Ok(condition.of_tets(mesh, part)?.into_iter().map(Wish::of_mark).collect())
            }
            Self::Gradient { array, above } => by_field::gradient(array, *above, mesh, part, threads),
            Self::Estimate { array, by, amount } => {
                by_field::estimate(array, *by, *amount, mesh, part, threads)
            }
            Self::Hessian(sizes) => sizes.wishes(mesh, part, threads),
            Self::Vorticity { array, above } => {
                by_field::flow(array, *above, mesh, part, |tets, velocity| {
                    estimate::vorticity(tets, velocity, threads).into_iter().map(norm).collect()
                })
            }
            Self::Q { array, above } => by_field::flow(array, *above, mesh, part, |tets, velocity| {
                estimate::q_criterion(tets, velocity, threads)
            }),
            _ => by_place::wishes(self, mesh, part, threads),
        }
    }

    /// The tets to divide, in ascending order.
    ///
    /// # Errors
    /// The errors of [`wishes`](Self::wishes).
    pub fn marks(&self, mesh: &Mesh, part: &TetPart, threads: &Threads) -> Result<Vec<TetId>> {
        self.wishes(mesh, part, threads).map(|wishes| marked(&wishes))
    }
}

/// Combines the wishes of several criteria: each tet gets the largest. Without criteria every division may be
/// taken back.
///
/// # Errors
/// The errors of [`Criterion::wishes`], for the first criterion that fails.
pub fn wishes_of_all(
    criteria: &[Criterion],
    mesh: &Mesh,
    part: &TetPart,
    threads: &Threads,
) -> Result<Vec<Wish>> {
    let mut all = vec![Wish::Coarser; part.mesh.tets.len()];
    for criterion in criteria {
        let wishes = criterion.wishes(mesh, part, threads)?;
        all.iter_mut().zip(wishes).for_each(|(all, wish)| *all = wish.max(*all));
    }
    Ok(all)
}

/// The tets that at least one of the criteria marks, in ascending order.
///
/// # Errors
/// The errors of [`Criterion::wishes`], for the first criterion that fails.
pub fn marks_of_all(
    criteria: &[Criterion],
    mesh: &Mesh,
    part: &TetPart,
    threads: &Threads,
) -> Result<Vec<TetId>> {
    wishes_of_all(criteria, mesh, part, threads).map(|wishes| marked(&wishes))
}

fn invalid(what: &str, value: f64, expected: &str) -> Error {
    Error::options(format!("{what} is {value}")).remedy(format!("give {expected}"))
}

fn finite(what: &str, value: f64) -> Result<()> {
    if value.is_finite() { Ok(()) } else { Err(invalid(what, value, "a finite number")) }
}

fn non_negative(what: &str, value: f64) -> Result<()> {
    let is_fine = value >= 0.0 && value.is_finite();
    if is_fine { Ok(()) } else { Err(invalid(what, value, "a number of 0 or more")) }
}

fn positive(what: &str, value: f64) -> Result<()> {
    let is_fine = value > 0.0 && value.is_finite();
    if is_fine { Ok(()) } else { Err(invalid(what, value, "a number above 0")) }
}

fn fraction(what: &str, value: f64) -> Result<()> {
    let is_fine = value > 0.0 && value <= 1.0;
    if is_fine { Ok(()) } else { Err(invalid(what, value, "a fraction above 0 and at most 1")) }
}
