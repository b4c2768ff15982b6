//! What a moving mesh is told: patches by label, since ids do not outlast a change.

use serde::Serialize;

use crate::base::{Error, Result, VertexId};
use crate::contact::{self, Room};
use crate::geometry::vector::LARGEST;
use crate::mesh::history::Rules;
use crate::mesh::{Boundary, Mesh, Surface, cone_volume, seamless};
use crate::motion::{self, Extent, FacetSet, Limits, Method, RigidLayer, SlideTolerance};
use crate::remesh;

/// How a mesh is kept good while its walls move.
#[derive(Clone, Debug, Serialize)]
pub struct Options {
    /// How the inside follows the walls.
    pub motion: Motion,
    /// What is bad, and what may be done about it; `None`: nothing is repaired, and a step ends where a cell would turn over. Default: EAS below 0.2, the surface kept.
    pub repair: Option<remesh::Options>,
    /// Where something is repaired, it becomes this much better than the limit, and so do tets in between that would be bad after another fall like the one since the last
    /// change: the next step is not to bring them below it at once. Default: 0.05.
    pub margin: f64,
    /// No step, or part of one, takes a tet that can be repaired below this EAS: it is repaired on the way, as long as that is easy. Default: 0.05.
    pub floor: f64,
    /// Where a repair changes the mesh, tets below this EAS are made better on the whole, too: those near it, and those that are not as they were at first. And as many vertices inside are
    /// kept as there were at first. So the next steps make fewer tets bad, and a long motion leaves the mesh that it began with. Default: 0.75; 0: bad tets are repaired, and nothing else is done.
    pub improve_below: f64,
    /// Whether the walls come back to where they were at first, again and again. Then what is [improved](Self::improve_below) is to be good there, too: otherwise each cycle undoes what
    /// the last one did. A mesh that still changes on the way to each return, and loses, is replaced by the first one when the walls are back: a change of its own
    /// ([`Why::Return`](super::Why::Return)), by which arrays are carried as by all others. From then on the mesh is improved for where it is alone, and the first one is put back at each return. Meshes that settle are
    /// never replaced; nothing is put back after a refinement, or where nothing is repaired. Harmful where walls go on, such as a body that turns. Default: no.
    pub returns: bool,
    /// Whether a repair that brings tets without volume where their vertices were as the step began is made once more with the tets that they replace held, and so on: schemes that
    /// integrate over an earlier time level need their volume there. Held tets may stay bad for this step. What is left after some tries is reported as
    /// [`Step::inverted_at_start`](super::Step::inverted_at_start). Default: no.
    pub valid_at_start: bool,
    /// What becomes of arrays where the mesh changes.
    pub rules: Rules,
    /// Cell arrays whose integral over each cell stays while the cell moves: a density goes down where its cell grows. All others keep their values.
    pub contents: Contents,
    /// Which patches are watched. Default: none.
    pub watch: Option<Watching>,
    /// So many changes are remembered for [`MovingMesh::history_since`](super::MovingMesh::history_since). Default: 64.
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
    /// Refuses numbers that mean nothing.
    ///
    /// # Errors
    /// Names the first of them.
    pub(super) fn check(&self) -> Result<()> {
        self.repair.as_ref().map_or(Ok(()), remesh::Options::check)?;
        for (what, value) in
            [("margin", self.margin), ("floor", self.floor), ("improve_below", self.improve_below)]
        {
            if !(0.0..=1.0).contains(&value) {
                let what = format!("{what} is {value}, expected a number in [0, 1]");
                return Err(Error::options(what).remedy("leave it out"));
            }
        }
        self.watch.as_ref().map_or(Ok(()), Watching::check)
    }

    /// The EAS below which a tet is bad.
    pub fn limit(&self) -> f64 {
        self.repair.as_ref().map_or(motion::BAD_EAS, remesh::Options::limit)
    }
}

/// Names of cell arrays that are densities of something that stays in its cell.
pub type Contents = Vec<String>;

/// How the inside follows the walls: as [`motion::Options`], with patches by label.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Motion {
    /// The method. Facets that it names are not looked at: see [`Self::bodies`].
    pub method: Method,
    /// As [`motion::Options::strain`].
    pub strain: motion::Strain,
    /// The patches of [`Method::Bodies`], each a body; none: as there.
    pub bodies: Vec<i32>,
    /// As [`motion::Options::within_walls`].
    pub within_walls: bool,
    /// As [`motion::Options::smoothing`]. Default: none.
    pub smoothing: usize,
    /// Patches inside the volume whose vertices are driven, such as a flap.
    pub inside: Vec<i32>,
    /// Flat patches whose vertices slide in their plane, but for those of patches inside.
    pub sliding: Vec<i32>,
    /// As [`motion::Options::slide_tolerance`].
    pub slide_tolerance: SlideTolerance,
    /// Vertices that keep their place relative to the wall, and the patches that are that wall; no patches: all that do not slide.
    pub rigid_layer: Option<(Extent, Vec<i32>)>,
    /// As [`motion::Options::limits`].
    pub limits: Limits,
}

impl Motion {
    /// The vertices of a mesh that are driven: those of its boundary, and of patches inside; rising. What [`Script`](super::Script) is about.
    pub fn driven(&self, mesh: &Mesh) -> Vec<VertexId> {
        let mut driven = Boundary::of(&mesh.cells).vertices;
        driven.extend(self.driven_inside(mesh));
        driven.sort_unstable();
        driven.dedup();
        driven
    }

    /// The same for a mesh as it is now.
    pub(super) fn of(&self, mesh: &Mesh) -> motion::Options {
        let sets = |labels: &[i32]| -> Vec<FacetSet> {
            labels.iter().map(|&label| FacetSet::of_patch(mesh, label)).collect()
        };
        let method = match &self.method {
            Method::Bodies(_) => Method::Bodies(sets(&self.bodies)),
            other => other.clone(),
        };
        let rigid_layer = self
            .rigid_layer
            .as_ref()
            .map(|(extent, wall)| RigidLayer { extent: *extent, wall: FacetSet::joined(sets(wall)) });
        motion::Options {
            method,
            strain: self.strain,
            within_walls: self.within_walls,
            smoothing: self.smoothing,
            also_moved: self.driven_inside(mesh),
            rigid_layer,
            sliding: sets(&self.sliding),
            slide_tolerance: self.slide_tolerance,
            limits: self.limits,
        }
    }

    /// The vertices of patches inside, rising; some may lie on the boundary.
    fn driven_inside(&self, mesh: &Mesh) -> Vec<VertexId> {
        let all = self.inside.iter().map(|&label| FacetSet::of_patch(mesh, label).vertices);
        let mut inside: Vec<VertexId> = all.flatten().collect();
        inside.sort_unstable();
        inside.dedup();
        inside
    }
}

impl Watching {
    /// # Errors
    /// Names the first number that means nothing.
    fn check(&self) -> Result<()> {
        self.options.check()?;
        if let Some(hold) = self.hold.filter(|hold| !(*hold >= 0.0 && *hold <= LARGEST)) {
            return Err(Error::options(format!("walls held at a distance of {hold}"))
                .remedy("give a length from 0 on, or leave it out"));
        }
        match self.horizon.filter(|horizon| horizon.is_nan() || *horizon <= 0.0) {
            None => Ok(()),
            Some(horizon) => Err(Error::options(format!("a horizon of {horizon}"))
                .remedy("give a time above 0, or leave it out")),
        }
    }
}

/// Which patches are watched, and how.
#[derive(Clone, Debug, Serialize)]
pub struct Watching {
    /// Names or numbers of patches; each is a body. All pairs are measured.
    pub patches: Vec<String>,
    /// How.
    pub options: contact::Options,
    /// How far ahead is looked at the present velocity, in units of time; `None`: as long as the last step took.
    pub horizon: Option<f64>,
    /// Walls stop at this distance, wherever they are requested to go: each of the patches gives way to all after it, and slides along them. In a step they go straight, from where the
    /// last one left them. No triangle is kept farther away than it was at first. Default: none, and walls that meet end a step.
    pub hold: Option<f64>,
}

impl Watching {
    /// The bodies in a mesh. Those that are closed parts of its boundary have their free side where the volume is, however their triangles are turned in the file.
    ///
    /// # Errors
    /// When it has no such patch.
    pub(super) fn bodies(&self, mesh: &Mesh) -> Result<Vec<contact::Body>> {
        let boundary = Surface::boundary_of(mesh);
        let bodies = contact::Body::of_mesh(mesh, "surface", &self.patches, 0)?;
        let is_closed = |triangles: &Vec<_>| contact::is_closed(&seamless(&mesh.points, triangles));
        let body = |(mut body, _): (contact::Body, _)| {
            let all = boundary.turned(&body.triangles);
            if let Some(mut triangles) = all.filter(is_closed) {
                // The outer wall is the room; what is closed otherwise is a body in it, and faces the volume.
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
