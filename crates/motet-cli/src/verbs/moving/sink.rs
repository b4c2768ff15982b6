//! Writes the frames of a motion.

use std::path::{Path, PathBuf};

use motet::Mesh;
use motet::base::{Point, Threads, VertexId};
use motet::geometry::quality::eas;
use motet::geometry::vector::sub;
use motet::io::{self, NodalSeries, SeriesWriter, WriteOptions};
use motet::mesh::Field;
use motet::motion::node_ids;

use super::args::MoveArgs;
use super::patches::Patches;

/// Destination of frames: each into a series, or the last into one file.
pub(super) struct Sink<'a> {
    path: &'a Path,
    options: WriteOptions,
    reference: &'a Mesh,
    /// The mesh to write, with everything of the input kept.
    mesh: Mesh,
    series: Option<SeriesWriter>,
    with_quality: bool,
    /// What the last file could not hold.
    pub(super) lost: Vec<String>,
    nodal: Vec<Nodal<'a>>,
    times: Vec<f64>,
}

/// The positions over time of the vertices of a patch.
struct Nodal<'a> {
    path: &'a Path,
    vertices: Vec<VertexId>,
    frames: Vec<Vec<Point>>,
}

impl<'a> Sink<'a> {
    pub(super) fn new(args: &'a MoveArgs, reference: &'a Mesh, patches: &Patches<'_>) -> motet::Result<Self> {
        let (path, options) = (args.output.as_path(), args.writing.options());
        let mut series = io::can_write_series(path).then(|| SeriesWriter::new(path, options.clone()));
        series.as_mut().map_or(Ok(true), SeriesWriter::lock)?;
        let nodal = args.nodal.iter().map(|request| {
            let vertices = patches.find(&request.name)?.vertices;
            Ok(Nodal { path: &request.file, vertices, frames: Vec::new() })
        });
        Ok(Self {
            path,
            options,
            reference,
            mesh: reference.clone(),
            series,
            with_quality: args.quality,
            lost: Vec::new(),
            nodal: nodal.collect::<motet::Result<_>>()?,
            times: Vec::new(),
        })
    }

    /// Takes a frame; returns its file if it was written.
    pub(super) fn take(
        &mut self,
        time: f64,
        points: &[Point],
        velocity: Option<Vec<Point>>,
        is_last: bool,
        threads: &Threads,
    ) -> motet::Result<Option<PathBuf>> {
        let displacement_of = |v: usize| sub(points[v], self.reference.points[v]);
        self.times.push(time);
        for nodal in &mut self.nodal {
            nodal.frames.push(nodal.vertices.iter().map(|v| displacement_of(v.index())).collect());
        }
        if self.series.is_none() && !is_last {
            return Ok(None);
        }
        let displacement: Vec<Point> = (0..points.len()).map(displacement_of).collect();
        self.mesh.points.copy_from_slice(points);
        self.mesh.set_point_field(Field::vectors("displacement", &displacement));
        if let Some(velocity) = velocity {
            self.mesh.set_point_field(Field::vectors("velocity", &velocity));
        }
        if self.with_quality {
            self.mesh.set_cell_field(self.mesh.tet_field("eas", eas));
        }
        match &mut self.series {
            None => {
                self.lost = io::write_on(self.path, &self.mesh, &self.options, threads)?;
                Ok(Some(self.path.to_owned()))
            }
            Some(series) => {
                let (file, lost) = series.add_on(time, &self.mesh, threads)?;
                self.lost = lost;
                Ok(Some(file))
            }
        }
    }

    /// Writes the files that need all frames.
    pub(super) fn end(&self) -> motet::Result<()> {
        let ids = node_ids(self.reference);
        self.nodal.iter().try_for_each(|nodal| {
            let ids = nodal.vertices.iter().map(|v| ids[v.index()]).collect();
            NodalSeries::of_vectors(self.times.clone(), ids, &nodal.frames).write(nodal.path)
        })
    }

    /// Number of vertices that have moved.
    pub(super) fn moved(&self) -> usize {
        self.mesh.points.iter().zip(&self.reference.points).filter(|(a, b)| a != b).count()
    }
}
