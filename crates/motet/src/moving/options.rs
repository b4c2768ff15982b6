//! Options of a moving mesh: patches by label, since ids do not outlast a change.

use serde::Serialize;

use crate::base::{Error, Result, VertexId};
use crate::contact::{self, Room};
use crate::geometry::vector::LARGEST;
use crate::mesh::history::Rules;
use crate::mesh::{BAD_EAS, Mesh, Surface, cone_volume, seamless};
use crate::motion::Motion;
use crate::remesh;

/// How a mesh moves with its walls, and how its quality is kept.
#[derive(Clone, Debug, Serialize)]
pub struct Options {
    /// How the inside follows the walls.
    pub motion: Motion,
    /// Which tets are bad, and what may be done about them; `None`: nothing is repaired, and a step ends
    /// where a cell would turn over. Default: EAS below 0.2, the surface kept.
    pub repair: Option<remesh::Options>,
    /// Repaired tets are improved to this much above the limit, so that the next step does not bring them
    /// below it at once. Tets within this margin are repaired, too, if another fall like the one since the
    /// last change would make them bad. Default: 0.05.
    pub margin: f64,
    /// No step, or part of one, takes a repairable tet below this EAS: it is repaired on the way, as long as
    /// that is easy. Default: 0.05.
    pub floor: f64,
    /// Where a repair changes the mesh, tets below this EAS are improved as a whole, too: those near the
    /// change, and those that have deteriorated since the start. The number of free vertices is kept as well.
    /// So the next steps make fewer tets bad, and a long motion ends with a mesh like the first.
    /// Default: 0.75; with 0 only bad tets are repaired.
    pub improve_below: f64,
    /// Whether the walls come back to their first position again and again. Then
    /// [improved](Self::improve_below) tets are to be good there, too: otherwise each cycle undoes what the
    /// last one did. A mesh that still changes on the way to each return, and loses quality, is replaced by
    /// the first one when the walls are back: a change of its own ([`Why::Return`](super::Why::Return)), by
    /// which arrays are carried as by all others. From then on the mesh is improved only for its current
    /// position, and the first one is put back at each return. Meshes that settle are never replaced; nothing
    /// is put back after a refinement, or if nothing is repaired. Harmful where walls do not come back, as
    /// with a body that turns. Default: no.
    pub returns: bool,
    /// Whether a repair is repeated if it makes tets without positive volume at the positions that their
    /// vertices had when the step began, with the tets that they replaced held, and so on: schemes that
    /// integrate over an earlier time level need their volume there. Held tets may stay bad for this step.
    /// Tets left after some tries are reported as
    /// [`Step::inverted_at_start`](super::Step::inverted_at_start). Default: no.
    pub valid_at_start: bool,
    /// How arrays are carried where the mesh changes.
    pub rules: Rules,
    /// Cell arrays whose integral over each cell stays constant while the cell moves: a density decreases as
    /// its cell grows. All others keep their values.
    pub contents: Contents,
    /// Which patches are watched. Default: none.
    pub watch: Option<Watching>,
    /// How many changes are remembered for [`MovingMesh::history_since`](super::MovingMesh::history_since).
    /// Default: 64.
    pub remembered: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            motion: Motion::default(),
            repair: Some(remesh::Options::default()),
            margin: 0.05,
            floor: 0.05,
            improve_below: 0.75,
            returns: false,
            valid_at_start: false,
            rules: Rules::default(),
            contents: Contents::default(),
            watch: None,
            remembered: 64,
        }
    }
}

impl Options {
    /// Checks that all numbers are in their ranges.
    ///
    /// # Errors
    /// If a number is out of range; the error names the first.
    pub(super) fn check(&self) -> Result<()> {
        self.repair.as_ref().map_or(Ok(()), remesh::Options::check)?;
        for (what, value) in
            [("margin", self.margin), ("floor", self.floor), ("improve_below", self.improve_below)]
        {
            if !(0.0..=1.0).contains(&value) {
                let what = format!("{what} must be in [0, 1]; got {value}");
                return Err(Error::options(what).remedy("leave it out"));
            }
        }
        self.watch.as_ref().map_or(Ok(()), Watching::check)
    }

    /// The EAS below which a tet is bad.
    pub fn limit(&self) -> f64 {
        self.repair.as_ref().map_or(BAD_EAS, remesh::Options::limit)
    }
}

/// Names of cell arrays that are densities of something that stays in its cell.
pub type Contents = Vec<String>;

impl Watching {
    /// Checks that all numbers are in their ranges.
    ///
    /// # Errors
    /// If a number is out of range; the error names the first.
    pub(super) fn check(&self) -> Result<()> {
        self.options.check()?;
        if let Some(hold) = self.hold.filter(|hold| !(*hold >= 0.0 && *hold <= LARGEST)) {
            return Err(Error::options(format!(
                "the distance at which walls are kept apart must be 0 or more; got {hold}"
            ))
            .remedy("give a length of 0 or more, or leave it out"));
        }
        match self.horizon.filter(|horizon| horizon.is_nan() || *horizon <= 0.0) {
            None => Ok(()),
            Some(horizon) => {
                Err(Error::options(format!("the horizon must be a time above 0; got {horizon}"))
                    .remedy("give a time above 0, or leave it out"))
            }
        }
    }
}

/// Which patches are watched, and how.
#[derive(Clone, Debug, Serialize)]
pub struct Watching {
    /// Names or numbers of patches; each is a body. All pairs are measured.
    pub patches: Vec<String>,
    /// How distances are measured.
    pub options: contact::Options,
    /// How far contact is predicted, at the present velocity, in units of time; `None`: as far as the last
    /// step.
    pub horizon: Option<f64>,
    /// The distance at which walls stop, wherever they are requested to go: each patch gives way to all those
    /// after it, and slides along them. Within a step, walls move in a straight line from where the last one
    /// left them. No triangle is kept farther away than it was at first. Default: none; walls that meet then
    /// end a step.
    pub hold: Option<f64>,
}

impl Watching {
    /// The watched patches of a mesh as bodies. Those that are closed parts of its boundary have their free
    /// side where the volume is, however the file orders their triangles.
    ///
    /// # Errors
    /// If the mesh has no such patch.
    pub(super) fn bodies(&self, mesh: &Mesh) -> Result<Vec<contact::Body>> {
        let boundary = Surface::boundary_of(mesh);
        let bodies = contact::Body::of_mesh(mesh, "surface", &self.patches, 0)?;
        let is_closed = |triangles: &Vec<_>| contact::is_closed(&seamless(&mesh.points, triangles));
        let body = |(mut body, _): (contact::Body, _)| {
            let all = boundary.turned(&body.triangles);
            if let Some(mut triangles) = all.filter(is_closed) {
                // The outer wall is a room; any other closed patch is a body in it, and faces the volume.
                let origin = mesh.points[triangles[0][0].index()];
                let volume = |t: &[VertexId; 3]| cone_volume(t.iter().copied(), &mesh.points, origin);
                body.room = match triangles.iter().map(volume).sum::<f64>() >= 0.0 {
                    true => Room::Yes,
                    false => Room::No,
                };
                if body.room == Room::No {
                    triangles.iter_mut().for_each(|t| t.swap(1, 2));
                }
                body.triangles = triangles;
            }
            body
        };
        Ok(bodies.into_iter().map(body).collect())
    }
}
