//! What to refine in a whole mesh: by place, by region and patch, by size, by what its arrays say.
//!
//! A criterion is looked at anew in every generation, with the arrays as they have been carried to the mesh of then: it says of each tet
//! what it [wishes](Wish).

mod array;
mod by_field;
mod by_place;
mod condition;
mod fixed;
mod target;

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

/// What to refine. Lengths are in the units of the mesh, values in those of its arrays; an array is named as in [`Condition::array`].
#[derive(Clone, Debug)]
pub enum Criterion {
    /// Everything, once more.
    All,
    /// Tets with a place within a ball.
    Ball {
        /// Its centre.
        centre: Point,
        /// Its radius, 0 or more.
        radius: f64,
    },
    /// Tets whose centre lies in a box with sides along the axes, given by its lowest and highest corner.
    Box([Point; 2]),
    /// Tets with a place near a surface.
    Near {
        /// The surface.
        target: Arc<Target>,
        /// How near: 0 or more.
        within: f64,
    },
    /// Tets with an edge longer than `size` and `growth` times the distance of the tet from a surface.
    NearSize {
        /// The surface.
        target: Arc<Target>,
        /// How long edges are to be at the surface: above 0.
        size: f64,
        /// How much longer per unit of distance: 0 or more.
        growth: f64,
    },
    /// Tets of a region, by its name or number.
    Region(String),
    /// Tets at a patch, by its name or number.
    Patch {
        /// The name or number.
        patch: String,
        /// How near: tets with a place so near to it. `None`: those that have a vertex of it.
        within: Option<f64>,
    },
    /// Tets with an edge that is too long.
    Size(Size),
    /// Tets where a condition on an array holds: on cells for the tet, on points for one of its vertices or more.
    Where(Condition),
    /// Tets through which a field changes by much: its gradient times the longest edge is above a value. Of a vector all components count together, by
    /// the root of the sum of squares.
    Gradient {
        /// An array on points.
        array: String,
        /// In units of the array.
        above: f64,
    },
    /// Tets with an estimate of the error that is among the largest.
    Estimate {
        /// An array on points. Components count together, by the root of the sum of squares.
        array: String,
        /// Which estimate.
        by: Estimator,
        /// How many tets.
        amount: Amount,
    },
    /// Tets with edges too long for how much fields bend.
    Hessian(HessianSizes),
    /// Tets in which a flow turns more than so much: by the size of the [vorticity](super::estimate::vorticity).
    Vorticity {
        /// The velocity, an array of vectors on points.
        array: String,
        /// In units of a velocity over a length.
        above: f64,
    },
    /// Tets in which [Q](super::estimate::q_criterion) is above a value.
    Q {
        /// The velocity, an array of vectors on points.
        array: String,
        /// In units of a velocity over a length, squared.
        above: f64,
    },
}

/// How long edges may be.
#[derive(Clone, Debug, PartialEq)]
pub enum Size {
    /// The same everywhere: above 0.
    Uniform(f64),
    /// By an array. On points: of an edge the mean at its ends. On cells: of all edges of the tet. Infinite: as long as they are.
    Array(String),
}

/// An estimate of the error of a field in each tet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimator {
    /// By the [jumps of its gradient](super::estimate::gradient_jump).
    Jump,
    /// By how far its gradient is from a [recovered one](super::estimate::recovery).
    Recovery,
}

/// How many of the tets with the largest estimates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// As few as make up this [share](super::mark::largest_share) of the sum of squares, in (0, 1].
    Share(f64),
    /// So many that dividing them brings the mesh to about this [number of tets](super::mark::to_count).
    Tets(usize),
}

/// Sizes from second derivatives: edges so long that no field differs from its linear interpolant by more than is allowed.
#[derive(Clone, Debug, PartialEq)]
pub struct HessianSizes {
    /// Arrays on points. Of a vector each component counts by itself; the smallest size counts.
    pub arrays: Vec<String>,
    /// How small.
    pub aim: Aim,
    /// What sizes must keep to.
    pub limits: SizeLimits,
}

/// How small sizes from second derivatives are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// So that the error of each array is at most this, in its units.
    Error(f64),
    /// So that it is at most this part of the range of the array: of its largest value less its smallest, of vectors by the component where that is most.
    RangePart(f64),
    /// So that there are about so many tets, and the mean square of the errors, as parts of the ranges, is least. Where a mesh is too coarse to see how
    /// much a field bends, ask for a few times as many from one solution to the next.
    Tets(usize),
}

impl Criterion {
    /// Whether it asks for lengths, which are reached at some time; others mark the parts of what they mark.
    pub fn lasts(&self) -> bool {
        matches!(self, Self::NearSize { .. } | Self::Size(_) | Self::Hessian(_))
    }

    /// Refuses numbers that mean nothing, before any mesh is looked at.
    ///
    /// # Errors
    /// Names the first of them.
    pub fn check(&self) -> Result<()> {
        match self {
            Self::All | Self::Region(_) | Self::Size(Size::Array(_)) => Ok(()),
            Self::Ball { centre, radius } => {
                centre.iter().try_for_each(|x| finite("the centre of a ball", *x))?;
                not_below_0("the radius of a ball", *radius)
            }
            Self::Box(corners) => by_place::check_box(*corners),
            Self::Near { within, .. } => not_below_0("the distance from a surface", *within),
            Self::NearSize { size, growth, .. } => {
                above_0("the size at a surface", *size)?;
                not_below_0("the growth of sizes", *growth)
            }
            Self::Patch { within, .. } => not_below_0("the distance from a patch", within.unwrap_or(0.0)),
            Self::Size(Size::Uniform(size)) => above_0("the size", *size),
            Self::Where(condition) => condition.check(),
            Self::Gradient { above, .. } => finite("the change through a tet", *above),
            Self::Estimate { amount, .. } => match amount {
                Amount::Share(share) => a_part("the share of the error", *share),
                Amount::Tets(_) => Ok(()),
            },
            Self::Hessian(sizes) => sizes.check(),
            Self::Vorticity { above, .. } => finite("the vorticity", *above),
            Self::Q { above, .. } => finite("Q", *above),
        }
    }

    /// What is wished of each tet of `part`, the tets of `mesh`.
    ///
    /// # Errors
    /// When a [number](Self::check) means nothing; when the mesh has no such array, region or patch, and what there is; when an array has not the
    /// components that are needed, or a size that is none.
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

    /// The tets to divide, rising.
    ///
    /// # Errors
    /// As for [`wishes`](Self::wishes).
    pub fn marks(&self, mesh: &Mesh, part: &TetPart, threads: &Threads) -> Result<Vec<TetId>> {
        self.wishes(mesh, part, threads).map(|wishes| marked(&wishes))
    }
}

/// What several criteria together wish of each tet: the most that one of them does. Without criteria every division may be taken back.
///
/// # Errors
/// As for [`Criterion::wishes`]; of the first criterion that has one.
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

/// The tets that one of the criteria marks, rising.
///
/// # Errors
/// As for [`Criterion::wishes`]; of the first criterion that has one.
pub fn marks_of_all(
    criteria: &[Criterion],
    mesh: &Mesh,
    part: &TetPart,
    threads: &Threads,
) -> Result<Vec<TetId>> {
    wishes_of_all(criteria, mesh, part, threads).map(|wishes| marked(&wishes))
}

fn off(what: &str, value: f64, expected: &str) -> Error {
    Error::options(format!("{what} is {value}")).remedy(format!("give {expected}"))
}

fn finite(what: &str, value: f64) -> Result<()> {
    if value.is_finite() { Ok(()) } else { Err(off(what, value, "a finite number")) }
}

fn not_below_0(what: &str, value: f64) -> Result<()> {
    let is_fine = value >= 0.0 && value.is_finite();
    if is_fine { Ok(()) } else { Err(off(what, value, "a number of 0 or more")) }
}

fn above_0(what: &str, value: f64) -> Result<()> {
    let is_fine = value > 0.0 && value.is_finite();
    if is_fine { Ok(()) } else { Err(off(what, value, "a number above 0")) }
}

fn a_part(what: &str, value: f64) -> Result<()> {
    let is_fine = value > 0.0 && value <= 1.0;
    if is_fine { Ok(()) } else { Err(off(what, value, "a part, above 0 and at most 1")) }
}
