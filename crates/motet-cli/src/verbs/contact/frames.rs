//! The surfaces to measure, frame by frame, as bodies that share one list of points.

use std::path::{Path, PathBuf};

use motet::base::{BodyId, CellId, Point};
use motet::contact::{Body, Contact, set_rooms};
use motet::{Error, Mesh, Result, io};

use super::args::ContactArgs;
use crate::console::Console;
use crate::words::stem;

/// The bodies of one frame.
#[derive(Debug, PartialEq)]
pub(crate) struct Frame {
    pub(crate) points: Vec<Point>,
    /// The velocity of each point, where requested.
    pub(crate) velocity: Option<Vec<Point>>,
    pub(crate) bodies: Vec<Body>,
    /// Where each body comes from.
    pub(crate) sources: Vec<Source>,
}

/// Where a body comes from.
#[derive(Debug, PartialEq)]
pub(crate) struct Source {
    pub(crate) file: PathBuf,
    /// Index of the body's first point in the list of all points.
    pub(crate) first_point: usize,
    /// The cell of the file that each triangle comes from.
    pub(crate) cells: Vec<CellId>,
}

/// The surfaces of a call, with a list of files for each.
pub(crate) struct Frames<'a> {
    args: &'a ContactArgs,
    /// The time of each frame; one frame at 0 where no surface is a series.
    pub(crate) times: Vec<f64>,
    files: Vec<Vec<PathBuf>>,
}

impl<'a> Frames<'a> {
    pub(crate) fn new(args: &'a ContactArgs) -> Result<Self> {
        let mut times: Option<(Vec<f64>, &Path)> = None;
        let mut files = Vec::new();
        for path in &args.surfaces {
            if !io::is_series(path) {
                files.push(vec![path.clone()]);
                continue;
            }
            let (own, list): (Vec<f64>, Vec<PathBuf>) = io::read_series(path)?.into_iter().unzip();
            if list.is_empty() {
                return Err(Error::input("the series has no frames").in_file(path));
            }
            if let Some((times, other)) = times.as_ref().filter(|(times, _)| times.len() != own.len()) {
                return Err(Error::input(format!(
                    "{} frames, but {} has {}: all series must have the same number of frames",
                    own.len(),
                    other.display(),
                    times.len()
                ))
                .in_file(path));
            }
            times.get_or_insert((own, path));
            files.push(list);
        }
        let times = times.map_or(vec![0.0], |(times, _)| times);
        Ok(Self { args, times, files })
    }

    /// Reads frame `k`.
    pub(crate) fn read(&self, k: usize, console: &Console) -> Result<Frame> {
        let velocity = self.args.velocity.as_ref().map(|_| Vec::new());
        let mut frame = Frame { points: Vec::new(), velocity, bodies: Vec::new(), sources: Vec::new() };
        let mut has_velocity = false;
        for (list, given) in self.files.iter().zip(&self.args.surfaces) {
            let file = &list[if list.len() == 1 { 0 } else { k }];
            let (mesh, notes) = io::read_noted(file)?;
            notes.iter().for_each(|note| console.warn(note));
            has_velocity |=
                frame.add_velocity(&mesh, self.args.velocity.as_deref()).map_err(|e| e.in_file(file))?;
            frame.add_bodies(&mesh, file, given, &self.args.patches).map_err(|e| e.in_file(file))?;
            frame.points.extend(&mesh.points);
        }
        if let (Some(name), false) = (&self.args.velocity, has_velocity) {
            return Err(Error::options(format!("no surface has a vector point array `{name}`"))
                .remedy("`motet info FILE` lists the arrays of a file"));
        }
        if self.args.no_room || !self.args.room.is_empty() {
            set_rooms(&mut frame.bodies, &self.args.room)?;
        }
        Ok(frame)
    }
}

impl Frame {
    /// Whether this frame has the same triangles as the other, so that only points have moved.
    pub(crate) fn has_same_triangles(&self, other: &Self) -> bool {
        let same = |body: &Body, other: &Body| body.name == other.name && body.triangles == other.triangles;
        self.points.len() == other.points.len()
            && self.bodies.len() == other.bodies.len()
            && self.bodies.iter().zip(&other.bodies).all(|(body, other)| same(body, other))
    }

    /// Keeps the rooms found in an earlier frame that has the same surface names but other triangles.
    pub(crate) fn keep_rooms(&mut self, earlier: &Contact) {
        let ids = (0..earlier.n_bodies()).map(BodyId::new);
        if ids.clone().map(|id| earlier.name(id)).eq(self.bodies.iter().map(|body| body.name.as_str())) {
            ids.zip(&mut self.bodies).for_each(|(id, body)| body.room = earlier.room(id));
        }
    }

    fn add_velocity(&mut self, mesh: &Mesh, name: Option<&str>) -> Result<bool> {
        let (Some(velocity), Some(name)) = (&mut self.velocity, name) else { return Ok(false) };
        let field = mesh.point_field(name);
        match field {
            Some(field) => velocity.extend(field.to_vectors().map_err(|e| e.at(format!("array {name}")))?),
            None => velocity.resize(velocity.len() + mesh.points.len(), [0.0; 3]),
        }
        Ok(field.is_some())
    }

    fn add_bodies(&mut self, mesh: &Mesh, file: &Path, given: &Path, patches: &[String]) -> Result<()> {
        let name = stem(given).unwrap_or_else(|| "surface".into());
        let first_point = self.points.len();
        for (body, cells) in Body::of_mesh(mesh, &name, patches, first_point)? {
            self.bodies.push(body);
            self.sources.push(Source { file: file.to_owned(), first_point, cells });
        }
        Ok(())
    }
}
