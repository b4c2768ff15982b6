//! How a moving mesh is kept good, in words: what files, Python and other callers give.

use crate::base::Result;
use crate::contact::GapWords;
use crate::mesh::Mesh;
use crate::moving::options::{Options, Watching};
use crate::remesh::{self, Held, SurfaceName};
use crate::words;

words! {
    /// How tets that become bad are repaired on the way.
    pub struct RepairWords {
        /// Nothing is repaired, and a step ends where a cell would invert.
        off: bool = false,
        /// A tet below this EAS is bad.
        min_eas: f64 = Options::default().limit(),
        /// What may happen to walls: `keep`, nothing; `adapt`, they may stray by `distance`, features and
        /// borders of patches are kept; `loose`, only borders of patches are kept.
        surface: SurfaceName = SurfaceName::default(),
        /// How far walls may stray, in the unit of the mesh. By default a fraction of its largest extent.
        distance: Option<f64> = None,
        /// Regions and patches that repairs leave as they are.
        hold: Vec<String> = Vec::new(),
        /// Repaired tets reach `min_eas` + `margin`.
        margin: f64 = Options::default().margin,
        /// No step takes a repairable tet below this EAS.
        floor: f64 = Options::default().floor,
        /// Where a repair changes the mesh, tets below this EAS are improved, too, and the number of vertices
        /// is kept. With 0 only bad tets are repaired.
        improve_below: f64 = Options::default().improve_below,
        /// No tet made by a repair is flat or inverted where its vertices were when the step began, as
        /// schemes need that integrate over an earlier time level.
        valid_at_start: bool = Options::default().valid_at_start,
    }
}

impl RepairWords {
    /// The options that these words determine for a mesh; all others have their defaults.
    ///
    /// # Errors
    /// If a number is not in [0, 1), a name does not exist, or a distance is given for a surface that is
    /// kept.
    pub fn options(&self, mesh: &Mesh) -> Result<Options> {
        let repair = remesh::Options {
            min_eas: self.min_eas,
            surface: self.surface.within(self.distance)?,
            held: Held::of_names(mesh, &self.hold)?,
            ..remesh::Options::default()
        };
        let options = Options {
            repair: (!self.off).then_some(repair),
            margin: self.margin,
            floor: self.floor,
            improve_below: self.improve_below,
            valid_at_start: self.valid_at_start,
            ..Options::default()
        };
        options.check()?;
        Ok(options)
    }
}

words! {
    /// Which patches are watched, and what for; [`GapWords`] determine how their gaps are measured.
    pub struct WatchWords {
        /// Patches, by name or number; each is a surface, and all pairs are measured.
        patches: Vec<String> = Vec::new(),
        /// How far ahead contact is predicted, at the present velocity, in units of time. By default as far
        /// as the last step.
        horizon: Option<f64> = None,
        /// The distance at which walls stop, whatever the requested motion: each patch gives way to all those
        /// after it, and slides along them.
        hold: Option<f64> = None,
    }
}

impl WatchWords {
    /// Which patches of a mesh are watched, and how; `None` without patches.
    ///
    /// # Errors
    /// If the mesh has no such patch, a distance is negative, or the horizon is not above 0.
    pub fn watching(&self, gaps: &GapWords, mesh: &Mesh) -> Result<Option<Watching>> {
        mesh.find_patches(&self.patches)?;
        let watching = Watching {
            patches: self.patches.clone(),
            options: gaps.options(),
            horizon: self.horizon,
            hold: self.hold,
        };
        watching.check()?;
        Ok((!self.patches.is_empty()).then_some(watching))
    }
}
