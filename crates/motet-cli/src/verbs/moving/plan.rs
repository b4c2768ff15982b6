//! The requested motion as a list of frames: a time and the displacements of the boundary for each.

use std::path::{Path, PathBuf};

use motet::base::{Point, VertexId};
use motet::geometry::vector::{distance, norm};
use motet::io::NodalSeries;
use motet::mesh::Boundary;
use motet::motion::{BoundaryMotion, Interface, Matching, Prescribed, SurfaceMotion, match_ids};
use motet::{Error, Mesh, io};

use super::args::{Match, MoveArgs};
use super::patches::Patches;
use crate::console::Console;
use crate::table::short;

/// Number of steps of a motion written as a series, by default.
const SERIES_STEPS: u32 = 10;

/// The frames of a motion, in order.
pub(crate) struct Plan<'a> {
    mesh: &'a Mesh,
    /// The vertices with given displacements, ascending: the boundary, and vertices inside that the call
    /// names.
    pub(crate) nodes: Vec<VertexId>,
    /// The nodes that do not slide: those inside, kept in place, or on a patch that the call moves.
    pub(crate) driven: Vec<VertexId>,
    /// Interfaces inside that an array moves.
    pub(crate) interfaces: Vec<Interface>,
    /// Number of points inside whose displacement in the array is not used.
    pub(crate) unused: usize,
    /// The nodes that move: where a rigid layer goes.
    pub(crate) moving: Vec<VertexId>,
    /// The time of each frame.
    pub(crate) times: Vec<f64>,
    /// The first frame to be computed: a single output mesh does not need the initial one.
    pub(crate) first_frame: usize,
    /// Whether the times are physical, so that there are velocities.
    pub(crate) timed: bool,
    fixed: Vec<VertexId>,
    source: Source<'a>,
}

/// Where the frames come from.
enum Source<'a> {
    /// Fractions of one motion, from the reference state on.
    Parts(BoundaryMotion),
    /// A surface for each frame.
    Surfaces { motion: SurfaceMotion<'a>, files: Vec<PathBuf> },
    /// The displacements of these vertices in each frame.
    Nodal { vertices: Vec<VertexId>, series: NodalSeries },
}

/// Whether a path names a file of nodal displacements over time, by its extension.
fn is_nodal(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("dat"))
}

impl<'a> Plan<'a> {
    pub(crate) fn new(
        mesh: &'a Mesh,
        boundary: &'a Boundary,
        patches: &Patches<'_>,
        args: &MoveArgs,
        console: &Console,
    ) -> motet::Result<Self> {
        let mut fixed = Vec::new();
        for word in &args.fixed {
            fixed.extend(patches.find(word)?.vertices);
        }
        let request = Request { mesh, boundary, fixed, args, console };
        let Some(word) = &args.displacement else { return request.words(patches) };
        match Path::new(word) {
            pvd if pvd.exists() && io::is_series(pvd) => request.series(pvd),
            nodal if nodal.exists() && is_nodal(nodal) => request.nodal(nodal),
            surface if surface.exists() => request.surface(surface),
            _ => request.array(word),
        }
    }

    /// The displacement of each node in frame `k`. Frames must be requested in order.
    pub(crate) fn displacements(&mut self, k: usize) -> motet::Result<Vec<Point>> {
        let points = &self.mesh.points;
        match &mut self.source {
            Source::Parts(motion) => {
                let parts = (self.times.len() - 1).max(1);
                Ok(motion.displacements(points, k as f64 / parts as f64))
            }
            Source::Surfaces { motion, files } => {
                let surface = io::read(&files[k])?;
                let moved = motion.next(&surface).map_err(|e| e.in_file(&files[k]))?;
                Ok(self.all_nodes(&moved))
            }
            Source::Nodal { vertices, series } => {
                let moved: Vec<_> = vertices.iter().copied().zip(series.vectors(k)?).collect();
                Ok(self.all_nodes(&moved))
            }
        }
    }

    /// The displacement of each node, given those of the nodes in `moved`.
    fn all_nodes(&self, moved: &[(VertexId, Point)]) -> Vec<Point> {
        let mut all = BoundaryMotion::still(&self.nodes);
        all.hold(&self.fixed);
        all.go(moved);
        all.displacements(&self.mesh.points, 1.0)
    }
}

/// The request from which a plan is made.
struct Request<'a, 'c> {
    mesh: &'a Mesh,
    boundary: &'a Boundary,
    fixed: Vec<VertexId>,
    args: &'c MoveArgs,
    console: &'c Console,
}

impl<'a> Request<'a, '_> {
    /// The plan for `--displacement FILE.pvd`.
    fn series(self, pvd: &Path) -> motet::Result<Plan<'a>> {
        self.refuse_steps()?;
        let frames = io::read_series(pvd)?;
        let moved = self.read_surface(&frames[0].1)?;
        let mut motion = self.at_rest(moved.iter().map(|(v, _)| *v));
        motion.go(&moved);
        let (own_times, files): (Vec<f64>, Vec<PathBuf>) = frames.into_iter().unzip();
        let source = Source::Surfaces { motion: SurfaceMotion::new(self.mesh, self.matching()), files };
        Ok(self.in_time(&motion, own_times, pvd, source))
    }

    /// The plan for `--displacement FILE.dat`.
    fn nodal(self, file: &Path) -> motet::Result<Plan<'a>> {
        self.refuse_steps()?;
        let series = NodalSeries::read(file)?;
        let vertices = match_ids(self.mesh, &series.ids).map_err(|e| e.in_file(file))?;
        let first = series.vectors(0).map_err(|e| e.in_file(file))?;
        let mut motion = self.at_rest(vertices.iter().copied());
        motion.go(&vertices.iter().copied().zip(first).collect::<Vec<_>>());
        Ok(self.in_time(&motion, series.times.clone(), file, Source::Nodal { vertices, series }))
    }

    /// Refuses `--steps` for a series, each time of which is a step.
    fn refuse_steps(&self) -> motet::Result<()> {
        match self.args.steps {
            None => Ok(()),
            Some(_) => Err(Error::options("--steps applies to a single motion, not to a series")
                .remedy("omit --steps: each time of the series is a step")),
        }
    }

    /// A plan with a step for each time of a series, whose first is `motion`.
    fn in_time(self, motion: &BoundaryMotion, own: Vec<f64>, file: &Path, source: Source<'a>) -> Plan<'a> {
        let times = match self.args.dt {
            Some(dt) => (0..own.len()).map(|k| k as f64 * dt).collect(),
            None => own,
        };
        let timed = times.is_sorted_by(|a, b| a < b);
        if !timed {
            self.console.warn(format_args!(
                "{}: the times do not increase, so no velocities are written",
                file.display()
            ));
        }
        let (nodes, moving) = (motion.vertices().to_vec(), motion.ordered_to_move());
        let driven = self.driven(&nodes, self.on_interfaces(&moving));
        let (interfaces, unused) = (Vec::new(), 0);
        let (mesh, fixed) = (self.mesh, self.fixed);
        Plan { mesh, nodes, driven, interfaces, unused, moving, times, first_frame: 0, timed, fixed, source }
    }

    /// The plan for `--displacement FILE`, a surface.
    fn surface(self, file: &Path) -> motet::Result<Plan<'a>> {
        let moved = self.read_surface(file)?;
        let mut motion = self.at_rest(moved.iter().map(|(v, _)| *v));
        motion.go(&moved);
        let on_interfaces = self.on_interfaces(&motion.ordered_to_move());
        Ok(self.in_equal_parts(motion, &on_interfaces))
    }

    fn read_surface(&self, file: &Path) -> motet::Result<Vec<(VertexId, Point)>> {
        let surface = io::read(file)?;
        let moved =
            SurfaceMotion::new(self.mesh, self.matching()).next(&surface).map_err(|e| e.in_file(file))?;
        let farthest = moved.iter().map(|(_, d)| norm(*d)).fold(0.0, f64::max);
        let size = self.mesh.bounds().map_or(0.0, |[low, high]| distance(low, high));
        if farthest > 0.5 * size {
            self.console.warn(format_args!(
                "{}: moves a vertex by {}, while the whole mesh measures {}; if its ids are those of another mesh, \
                 use --match position",
                file.display(),
                short(farthest),
                short(size)
            ));
        }
        Ok(moved)
    }

    fn matching(&self) -> Matching {
        match self.args.matching {
            Match::Id => Matching::Id,
            Match::Position => Matching::Position,
        }
    }

    /// The plan for `--displacement ARRAY`: its values on the boundary, and on interfaces inside that it
    /// moves.
    fn array(self, word: &str) -> motet::Result<Plan<'a>> {
        let Some(field) = self.mesh.point_field(word) else {
            let vectors = self.mesh.point_data.iter().filter(|f| f.components == 3);
            let names: Vec<&str> = vectors.map(|f| f.name.as_str()).collect();
            let has = if names.is_empty() { "none".into() } else { names.join(", ") };
            return Err(Error::options("neither a file nor a point array of the mesh")
                .at(format!("--displacement {word}"))
                .remedy(format!("vector point arrays of the mesh: {has}")));
        };
        let rows = field.to_vectors().map_err(|e| e.in_file(&self.args.mesh))?;
        let bad = self.boundary.vertices.iter().find(|v| rows[v.index()].iter().any(|x| !x.is_finite()));
        if let Some(v) = bad {
            return Err(Error::input("a displacement is not finite")
                .at(format!("array {word}, point {v}"))
                .in_file(&self.args.mesh));
        }
        let interfaces = Interface::moved(self.mesh, self.boundary, &rows)
            .map_err(|e| e.at(format!("array {word}")).in_file(&self.args.mesh))?;
        let inside: Vec<VertexId> = interfaces.iter().flat_map(|i| i.vertices.iter().copied()).collect();
        let mut motion = self.at_rest(inside.iter().copied());
        let moved: Vec<_> = motion.vertices().iter().map(|&v| (v, rows[v.index()])).collect();
        motion.go(&moved);
        let is_unused =
            |v: VertexId| rows[v.index()] != [0.0; 3] && motion.vertices().binary_search(&v).is_err();
        let unused = (0..rows.len()).map(VertexId::new).filter(|&v| is_unused(v)).count();
        Ok(Plan { interfaces, unused, ..self.in_equal_parts(motion, &inside) })
    }

    /// The plan for `--affine`, `--rotate` and `--translate`.
    fn words(self, patches: &Patches<'_>) -> motet::Result<Plan<'a>> {
        if let Some(rows) = self.args.affine {
            let mut motion = self.at_rest([]);
            motion.follow(&self.boundary.vertices, Prescribed::Affine(rows))?;
            return Ok(self.in_equal_parts(motion, &[]));
        }
        let turned = self.args.rotate.iter().map(|turn| &turn.patch);
        let mut words: Vec<&str> = Vec::new();
        for word in turned.chain(self.args.translate.iter().map(|shift| &shift.patch)) {
            if !words.contains(&word.as_str()) {
                words.push(word);
            }
        }
        let all = words.iter().map(|word| Ok((*word, patches.find(word)?.vertices)));
        let all = all.collect::<motet::Result<Vec<_>>>()?;
        let mut motion = self.at_rest(all.iter().flat_map(|(_, vertices)| vertices.iter().copied()));
        for (word, vertices) in &all {
            let requested = self.motion_of(word, vertices);
            motion.check_alike(&self.mesh.points, word, vertices, &requested)?;
            let taken = motion.follow(vertices, requested)?;
            if taken.refused > 0 {
                self.console.detail(format_args!(
                    "{word}: {} vertices follow the motion of another patch",
                    taken.refused
                ));
            }
        }
        let moved: Vec<VertexId> = all.into_iter().flat_map(|(_, vertices)| vertices).collect();
        Ok(self.in_equal_parts(motion, &moved))
    }

    /// The motion of a patch: its rotations, then its shifts.
    fn motion_of(&self, word: &str, vertices: &[VertexId]) -> Prescribed {
        let turns = self.args.rotate.iter().filter(|turn| turn.patch == word).map(|turn| Prescribed::Turn {
            axis: turn.axis,
            angle: turn.degrees.to_radians(),
            centre: turn.centre.unwrap_or_else(|| Prescribed::middle(&self.mesh.points, vertices)),
        });
        let shifts = self.args.translate.iter().filter(|shift| shift.patch == word);
        Prescribed::sequence(turns.chain(shifts.map(|shift| Prescribed::Shift(shift.by))).collect())
    }

    /// A motion without displacements, of the boundary and of the `named` vertices inside.
    fn at_rest(&self, named: impl IntoIterator<Item = VertexId>) -> BoundaryMotion {
        let mut nodes = self.boundary.vertices.clone();
        nodes.extend(named);
        nodes.extend(&self.fixed);
        nodes.sort_unstable();
        nodes.dedup();
        let mut motion = BoundaryMotion::still(&nodes);
        motion.hold(&self.fixed);
        motion
    }

    /// The nodes that do not slide; `moved` are those that the call moves.
    fn driven(&self, nodes: &[VertexId], moved: impl IntoIterator<Item = VertexId>) -> Vec<VertexId> {
        let is_inside = |v: &VertexId| self.boundary.vertices.binary_search(v).is_err();
        let inside = nodes.iter().copied().filter(is_inside);
        let mut driven: Vec<VertexId> = inside.chain(self.fixed.iter().copied()).chain(moved).collect();
        driven.sort_unstable();
        driven.dedup();
        driven
    }

    /// The vertices of `given` on interfaces that also have a vertex of `given` inside the mesh: they move
    /// with it, up to the rims of the interfaces on sliding patches.
    fn on_interfaces(&self, given: &[VertexId]) -> Vec<VertexId> {
        let is_given = |v: &VertexId| given.binary_search(v).is_ok();
        let is_inside = |v: &VertexId| self.boundary.vertices.binary_search(v).is_err();
        if self.args.slide.is_empty() || !given.iter().any(is_inside) {
            return Vec::new();
        }
        let all = Interface::all(self.mesh, self.boundary);
        let moved = all.into_iter().filter(|i| i.vertices.iter().any(|v| is_inside(v) && is_given(v)));
        moved.flat_map(|interface| interface.vertices).filter(is_given).collect()
    }

    /// A plan that makes `motion` in equal parts. The vertices in `moved` do not slide.
    fn in_equal_parts(self, motion: BoundaryMotion, moved: &[VertexId]) -> Plan<'a> {
        let is_series = io::can_write_series(&self.args.output);
        let default = if is_series { SERIES_STEPS } else { 1 };
        let in_time = is_series || !self.args.nodal.is_empty();
        let n = self.args.steps.unwrap_or(default);
        let dt = self.args.dt.unwrap_or(1.0);
        Plan {
            mesh: self.mesh,
            nodes: motion.vertices().to_vec(),
            driven: self.driven(motion.vertices(), moved.iter().copied()),
            interfaces: Vec::new(),
            unused: 0,
            moving: motion.moving(&self.mesh.points),
            times: (0..=n).map(|k| f64::from(k) * dt).collect(),
            first_frame: usize::from(!in_time),
            timed: self.args.dt.is_some(),
            fixed: self.fixed,
            source: Source::Parts(motion),
        }
    }
}
