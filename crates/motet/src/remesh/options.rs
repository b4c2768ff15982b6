//! Options of the remesher.

use serde::Serialize;

use crate::base::{CellId, Error, Point, Result};
use crate::geometry::quality::dihedral::REGULAR;
use crate::geometry::vector::LARGEST;
use crate::remesh::held::Held;
use crate::remesh::sizes::Sizes;

/// Options that say what is repaired, and how.
#[derive(Clone, Debug, Serialize)]
pub struct Options {
    /// A tet below this EAS is bad. Default: 0.2.
    pub min_eas: f64,
    /// Only these tets, and the tets that replace them, can count as bad: ids of cells of the mesh, or of
    /// tets where there are only tets; ids of other cells are ignored. All other tets stay, however bad,
    /// unless a change takes them along. Default: `None`, all tets.
    pub only: Option<Vec<CellId>>,
    /// Least dihedral angle in degrees; a tet with a smaller one is bad, too. It raises the required EAS to
    /// the value that guarantees the angle: see [`Self::limit`]. Default: 0.
    pub min_dihedral_deg: f64,
    /// How far to go. Default: [`Goal::Repair`].
    pub goal: Goal,
    /// What may happen to the surface. Default: [`SurfaceRule::Keep`].
    pub surface: SurfaceRule,
    /// Whether tets of boundary layers stay as they are: thin tets that are well shaped when stretched to the
    /// width of the wall's facets. Default: true.
    pub keep_layers: bool,
    /// Regions, patches and tets that stay to the bit, however bad they are. Default: none.
    pub held: Held,
    /// Requested edge lengths; `None` leaves them as they are. Default: `None`.
    pub sizes: Option<Sizes>,
    /// Which tets are improved besides the bad ones; `None`: those that [`Goal::Best`] improves under that
    /// goal, otherwise none. Default: `None`.
    pub improve: Option<Improve>,
    /// The mesh that the given one is a part of, to be repaired as it would be within it. Default: `None`,
    /// it is no part.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part_of: Option<Whole>,
    /// The largest number of rounds over the bad tets. Default: 20.
    pub rounds: usize,
}

/// What a repair of a part depends on of the whole mesh.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Whole {
    /// Number of tets.
    pub tets: usize,
    /// Number of free vertices: inside the volume, and on no line.
    pub free_vertices: usize,
    /// The mean over all tets of (1 - EAS)^2, summed over the current pose and the
    /// [other one](Improve::pose).
    pub mean_defect: f64,
    /// The largest extent.
    pub extent: f64,
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
            part_of: None,
            rounds: 20,
        }
    }
}

impl Options {
    /// Checks that all numbers are in their ranges.
    ///
    /// # Errors
    /// If a number is out of range; the error names the first.
    pub fn check(&self) -> Result<()> {
        let refused = |what: String, remedy: &str| Err(Error::options(what).remedy(remedy));
        if !(0.0..=1.0).contains(&self.min_eas) {
            let what = format!("the least EAS must be in [0, 1]; got {}", self.min_eas);
            return refused(what, "0.2 is the default");
        }
        if !(0.0..=REGULAR.to_degrees()).contains(&self.min_dihedral_deg) {
            let what = format!(
                "the least dihedral angle must be in [0, 70.5] degrees; got {}",
                self.min_dihedral_deg
            );
            return refused(what, "leave it out");
        }
        if let Some(below) = self.improve.as_ref().map(|improve| improve.below)
            && !(0.0..=1.0).contains(&below)
        {
            let what = format!("the EAS below which tets are improved must be in [0, 1]; got {below}");
            return refused(what, "0.75 is the default of a moving mesh");
        }
        if let Some(cost) = self.improve.as_ref().map(|improve| improve.cost)
            && !(0.0..=LARGEST).contains(&cost)
        {
            let what = format!("the cost of each changed tet must be a number of 0 or more; got {cost}");
            return refused(what, "use 0 if the number of changed tets does not matter");
        }
        match self.surface {
            SurfaceRule::Adapt { distance: Some(d) } | SurfaceRule::Loose { distance: Some(d) }
                if !(0.0..=LARGEST).contains(&d) =>
            {
                refused(
                    format!("the distance by which the surface may stray must be 0 or more; got {d}"),
                    "leave it out",
                )
            }
            _ => Ok(()),
        }
    }

    /// The EAS below which a tet is bad. A tet of EAS q has no dihedral angle below q acos(1/3).
    pub fn limit(&self) -> f64 {
        self.min_eas.max(self.min_dihedral_deg.to_radians() / REGULAR)
    }
}

/// Which tets are improved besides those that are repaired: as a whole, with none left bad. The mean quality
/// rises, and the next motion makes fewer bad tets.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Improve {
    /// Tets below this EAS are improved if they are among [`Self::cells`] or share a vertex with a tet that
    /// repair has changed.
    pub below: f64,
    /// Cells to improve; ids of cells that are not tets are ignored. `None`: all tets.
    pub cells: Option<Vec<CellId>>,
    /// Whether tets that are not among [`Self::cells`], and that repair has not changed, all stay as they
    /// are.
    pub keeps_others: bool,
    /// Whether the worst tets are raised, too: with every operation, walls kept, up to a limit that rises as
    /// long as it is reached. Not done if more than one tet in a hundred is bad: then surfaces force them.
    pub raises_worst: bool,
    /// How many vertices to keep; `None`: as many as repair leaves.
    pub density: Option<Density>,
    /// A second pose in which tets are to be as good as in the current one: the position of each point of the
    /// mesh when the walls are at rest (for walls that come back), or after the next step (for walls that go
    /// on).
    pub pose: Option<Vec<Point>>,
    /// The price of changing a tet that nothing has changed yet: for each such tet, a change must lower the
    /// sum over both poses of (1 - EAS)^2 by this much more. 0 if the number of changed tets does not matter.
    pub cost: f64,
}

impl Improve {
    /// The [cost](Self::cost) for meshes where each tet that changes requires an interpolation. With a paddle
    /// that turns ten times or more in a box, 8.8 % of the tets change per step at 0.02, 8.1 % at 0.025 and
    /// 7.5 % at 0.03; the mean EAS of all steps is 0.704, 0.701 and 0.698.
    pub const FEW_CHANGES: f64 = 0.025;

    /// The EAS [below](Self::below) which tets are improved in a volume that was just filled, or brought to
    /// sizes.
    pub const NEW_TETS: f64 = 0.6;

    /// The options for a volume that was just filled: all tets are improved, and the number of changes does
    /// not matter.
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

    /// Checks that the arrays have one entry for each of the `n_points` points of the mesh.
    pub(super) fn check(&self, n_points: usize) -> Result<()> {
        let sizes = self.density.as_ref().map(|density| ("sizes", density.sizes.len()));
        let pose = self.pose.as_ref().map(|pose| ("positions in the other pose", pose.len()));
        match sizes.into_iter().chain(pose).find(|(_, n)| *n != n_points) {
            None => Ok(()),
            Some((what, n)) => Err(Error::input(format!("{n} {what} for {n_points} points"))
                .remedy("give one for each point of the mesh")),
        }
    }
}

/// How many vertices are kept, and how they are distributed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Density {
    /// The desired edge length at each vertex of the mesh, interpolated linearly in the tets. Long edges are
    /// divided where vertices are lacking, short ones collapsed where there are too many.
    pub sizes: Vec<f64>,
    /// How many free vertices the mesh lacks; it has too many if this is negative.
    pub lack: isize,
}

/// If the surplus or lack exceeds this fraction of the vertices, edges are searched for in the whole mesh and
/// not only near changes.
const FAR_OFF: f64 = 0.005;

impl Density {
    /// Whether edges are searched for in the whole mesh, which is to have `n_free` free vertices.
    pub(crate) fn is_far_off(lack: isize, n_free: usize) -> bool {
        lack.unsigned_abs() as f64 > FAR_OFF * n_free as f64
    }
}

/// What may happen to walls: the boundary, interfaces between regions, labelled facets.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum SurfaceRule {
    /// Walls stay as they are, to the bit.
    Keep,
    /// Walls may change within a distance of where they were; features and borders of patches are kept.
    Adapt {
        /// How far a wall may stray, in the unit of the mesh; `None`: [`DEFAULT_DISTANCE`] of the mesh's
        /// largest extent.
        distance: Option<f64>,
    },
    /// Walls may change within a distance of where they were. Where nothing else helps, only borders of
    /// patches are kept; creases and corners are then bound by the distance alone. For surfaces whose
    /// features are noise.
    Loose {
        /// How far a wall may stray, in the unit of the mesh; `None`: [`DEFAULT_DISTANCE`] of the mesh's
        /// largest extent.
        distance: Option<f64>,
    },
    /// Walls keep their place to rounding, but triangles in one plane may be replaced by others: a vertex
    /// within a flat part can be removed.
    Flat {
        /// How far the walls deviate from their planes to begin with, in the unit of the mesh; `None`:
        /// rounding of `f64`.
        distance: Option<f64>,
    },
}

impl SurfaceRule {
    /// How far a wall may stray, given the mesh's largest extent; `None` if walls may not change.
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

/// How far the surface may stray by default, as a fraction of the mesh's largest extent.
pub const DEFAULT_DISTANCE: f64 = 1e-3;

/// How far walls that keep their place may stray by rounding, as a fraction of the mesh's largest extent.
const IN_PLANE: f64 = 1e-9;

/// How far the remesher goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Goal {
    /// Leave no bad tet, touching as few tets as possible.
    Repair,
    /// Make the worst tets everywhere as good as possible.
    Best,
    /// As [`Self::Repair`], but of [`Options::sizes`] only the lower half is applied: edges that are too
    /// short are collapsed if no edge then exceeds its size, and none is split.
    Coarsen,
}
