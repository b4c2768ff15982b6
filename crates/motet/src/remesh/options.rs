//! What a remesher is told beside the mesh.

use serde::Serialize;

use crate::base::{CellId, Error, Point, Result};
use crate::geometry::quality::dihedral::REGULAR;
use crate::geometry::vector::LARGEST;
use crate::remesh::held::Held;
use crate::remesh::sizes::Sizes;

/// What is to be repaired, and how.
#[derive(Clone, Debug, Serialize)]
pub struct Options {
    /// A tet below this EAS is bad. Default: 0.2.
    pub min_eas: f64,
    /// Only these tets can be bad, and what comes of them: cells of a mesh, tets where there are only tets; ids of anything else say nothing. Others stay as they are, however bad, where no
    /// change takes them along. Default: `None`, all tets.
    pub only: Option<Vec<CellId>>,
    /// A tet is bad, too, when one of its dihedral angles is smaller than this, in degrees. It raises the EAS that is asked to the one that makes sure of
    /// the angle: see [`Self::limit`]. Default: 0.
    pub min_dihedral_deg: f64,
    /// How far to go. Default: [`Goal::Repair`].
    pub goal: Goal,
    /// What may happen to the surface. Default: [`SurfaceRule::Keep`].
    pub surface: SurfaceRule,
    /// Whether tets of boundary layers stay as they are: thin, but well shaped when stretched to the width of the wall's facets. Default: true.
    pub keep_layers: bool,
    /// Regions and patches that stay to the bit, however bad their tets are. Default: none.
    pub held: Held,
    /// How long edges are to be; `None`: as they are. Default: `None`.
    pub sizes: Option<Sizes>,
    /// Which tets are improved beside the bad ones; `None`: those that goal [`Goal::Best`] improves, otherwise none. Default: `None`.
    pub improve: Option<Improve>,
    /// At most so many rounds over the bad tets. Default: 20.
    pub rounds: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            min_eas: 0.2,
            only: None,
            min_dihedral_deg: 0.0,
            goal: Goal::Repair,
            surface: SurfaceRule::Keep,
            keep_layers: true,
            held: Held::default(),
            sizes: None,
            improve: None,
            rounds: 20,
        }
    }
}

impl Options {
    /// Refuses numbers that mean nothing.
    ///
    /// # Errors
    /// Names the first of them.
    pub fn check(&self) -> Result<()> {
        let refused = |what: String, remedy: &str| Err(Error::options(what).remedy(remedy));
        if !(0.0..=1.0).contains(&self.min_eas) {
            let what = format!("an EAS of {} as the least, expected a number in [0, 1]", self.min_eas);
            return refused(what, "0.2 is the default");
        }
        if !(0.0..=REGULAR.to_degrees()).contains(&self.min_dihedral_deg) {
            let what = format!(
                "dihedral angles of at least {} degrees, expected a number in [0, 70.5]",
                self.min_dihedral_deg
            );
            return refused(what, "leave it out");
        }
        if let Some(below) = self.improve.as_ref().map(|improve| improve.below)
            && !(0.0..=1.0).contains(&below)
        {
            let what = format!("tets to be improved below an EAS of {below}, expected a number in [0, 1]");
            return refused(what, "0.75 is the default of a moving mesh");
        }
        if let Some(cost) = self.improve.as_ref().map(|improve| improve.cost)
            && !(0.0..=LARGEST).contains(&cost)
        {
            let what = format!("a cost of {cost} for each tet that changes, expected a number from 0");
            return refused(what, "0 says that it does not matter how many change");
        }
        match self.surface {
            SurfaceRule::Adapt { distance: Some(d) } | SurfaceRule::Loose { distance: Some(d) }
                if !(0.0..=LARGEST).contains(&d) =>
            {
                refused(format!("a surface that may stray by {d}, expected a length from 0"), "leave it out")
            }
            _ => Ok(()),
        }
    }

    /// The EAS below which a tet is bad. One of EAS q has no dihedral angle below q acos(1/3).
    pub fn limit(&self) -> f64 {
        self.min_eas.max(self.min_dihedral_deg.to_radians() / REGULAR)
    }
}

/// Tets that are made better on the whole, none of them bad, beside those that are repaired: the mean gets better, and the next motion makes fewer bad.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Improve {
    /// Tets below this EAS are improved where they share a vertex with what repair has changed, and among [`Self::cells`].
    pub below: f64,
    /// Further cells; ids of cells that are no tets say nothing. `None`: all tets.
    pub cells: Option<Vec<CellId>>,
    /// Whether all tets stay that are not among [`Self::cells`] and that repair has not changed.
    pub keeps_others: bool,
    /// Whether the worst are raised, too: with every operation, walls kept, up to a limit that rises as long as it is in reach. Where more than a hundredth of the tets are bad they are not: surfaces force them.
    pub raises_worst: bool,
    /// How many vertices are to be kept; `None`: as many as repair leaves.
    pub density: Option<Density>,
    /// Another pose: where each point of the mesh is when the walls are at rest, for walls that come back, or will be after the next step, for walls that go on. There tets are to be good as much as where they are.
    pub pose: Option<Vec<Point>>,
    /// By how much more a change has to lower the sum, over both poses, of the squares of what EAS lacks of 1, for each tet that nothing has changed yet: 0 where it does not matter how many tets change.
    pub cost: f64,
}

impl Improve {
    /// The [cost](Self::cost) where each tet that changes costs an interpolation. Of a paddle that turns in a box ten times or more 8.8 % of the tets change in a step with 0.02, 8.1 % with 0.025, 7.5 %
    /// with 0.03; the mean EAS of all steps is 0.704, 0.701 and 0.698.
    pub const FEW_CHANGES: f64 = 0.025;

    /// The EAS [below](Self::below) which tets of a volume that was just filled, or brought to sizes, are improved.
    pub const NEW_TETS: f64 = 0.6;

    /// All tets of a volume that was just filled, where it does not matter how many change.
    pub fn filled() -> Self {
        Self {
            below: Self::NEW_TETS,
            cells: None,
            keeps_others: false,
            raises_worst: false,
            density: None,
            pose: None,
            cost: 0.0,
        }
    }

    /// Refuses arrays that are not about the points of a mesh of so many.
    pub(super) fn check(&self, n_points: usize) -> Result<()> {
        let sizes = self.density.as_ref().map(|density| ("sizes", density.sizes.len()));
        let pose = self.pose.as_ref().map(|pose| ("places of the other pose", pose.len()));
        match sizes.into_iter().chain(pose).find(|(_, n)| *n != n_points) {
            None => Ok(()),
            Some((what, n)) => Err(Error::input(format!("{n} {what} for {n_points} points"))
                .remedy("give one for each point of the mesh")),
        }
    }
}

/// The number of vertices that is kept, and where they belong.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Density {
    /// For each vertex of the mesh how long edges are to be there; between vertices linear in the tets. Long edges are divided where vertices lack, short ones collapsed where there are too
    /// many.
    pub sizes: Vec<f64>,
    /// How many vertices that nothing holds there are to be; `None`: as many as the mesh has.
    pub free_vertices: Option<usize>,
}

/// What may happen to walls: the boundary, interfaces between regions, labelled facets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum SurfaceRule {
    /// They stay as they are, to the bit.
    Keep,
    /// They may change within a distance of where they were, features and borders of patches kept.
    Adapt {
        /// How far a wall may stray, in the unit of the mesh; `None`: [`DEFAULT_DISTANCE`] of the mesh's largest extent.
        distance: Option<f64>,
    },
    /// The same, but of features only borders of patches are kept where nothing else helps: creases and corners are held by the distance alone. For
    /// surfaces whose features are noise.
    Loose {
        /// As for [`Self::Adapt`].
        distance: Option<f64>,
    },
    /// They keep their place to rounding, but triangles in one plane may become others: a vertex within a flat part can go.
    Flat {
        /// How far walls were off their planes before, in the unit of the mesh; `None`: rounding of `f64`.
        distance: Option<f64>,
    },
}

impl SurfaceRule {
    /// The rule of a name: `keep`, `adapt` or `loose`, as the command line has them.
    ///
    /// # Errors
    /// When none is called that, or the surface is kept and a distance is given.
    pub fn of_name(name: &str, distance: Option<f64>) -> Result<Self> {
        match (name, distance) {
            ("keep", None) => Ok(Self::Keep),
            ("keep", Some(_)) => {
                Err(Error::options("a distance says how far a surface may stray, and this one is kept")
                    .remedy("let the surface `adapt`"))
            }
            ("adapt", distance) => Ok(Self::Adapt { distance }),
            ("loose", distance) => Ok(Self::Loose { distance }),
            _ => Err(Error::options(format!("there is no rule `{name}` for a surface"))
                .remedy("give one of keep, adapt, loose")),
        }
    }

    /// How far a wall may stray, given the mesh's largest extent; `None` where it may not.
    pub(super) fn distance(self, extent: impl FnOnce() -> f64) -> Option<f64> {
        match self {
            Self::Keep => None,
            Self::Adapt { distance } | Self::Loose { distance } => {
                Some(distance.unwrap_or_else(|| DEFAULT_DISTANCE * extent()))
            }
            Self::Flat { distance } => Some((IN_PLANE * extent()).max(distance.unwrap_or(0.0))),
        }
    }
}

/// How far the surface may stray, as a part of the mesh's largest extent, where nobody said.
pub const DEFAULT_DISTANCE: f64 = 1e-3;

/// The same for what is to keep its place: rounding.
const IN_PLANE: f64 = 1e-9;

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Goal {
    /// No bad tet left, as few tets touched as can be.
    Repair,
    /// The worst tets as good as they get, everywhere.
    Best,
    /// As [`Self::Repair`]; of [`Options::sizes`] the lower half alone: edges that are too short are collapsed where that brings none that is longer than its size, and none is split.
    Coarsen,
}
