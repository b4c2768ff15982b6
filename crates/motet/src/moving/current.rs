//! The mesh between two changes: its positions, what moves it, where each vertex was at first.

use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::base::{CellId, Id, MaybeId, Point, Result, Threads, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::vector::{add, sub};
use crate::mesh::history::{History, Rule, Rules};
use crate::mesh::{Connectivity, Field, Mesh};
use crate::motion::Mover;
use crate::moving::contents::{move_points, pass_contents};
use crate::moving::options::Options;
use crate::moving::shapes::{Shape, Tets};
use crate::moving::step::{InvertedAtStart, WorstTet};
use crate::moving::wall::{Drive, NO_NODE, Wall};

/// A bad tet that repair has left is tried again once the ratio of its EAS to what it was then is outside
/// this range: worse, or better because walls no longer force it.
const UNCHANGED_RATIO: RangeInclusive<f64> = 0.5..=1.25;

/// The mesh, and everything that is rebuilt when it changes.
#[derive(Clone, Debug)]
pub(super) struct Current {
    /// The mesh with its points at their current positions, and the user's arrays.
    pub(super) mesh: Mesh,
    pub(super) tets: Tets,
    /// Moves the vertices; its reference is the mesh after the last change.
    pub(super) mover: Arc<Mover>,
    /// Records of each vertex and cell.
    pub(super) records: Records,
    drive: Drive,
    /// Bad tets that repair has left, sorted by cell.
    pub(super) left: Vec<LeftBad>,
}

/// A bad tet that repair has left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct LeftBad {
    pub(super) cell: CellId,
    /// EAS of the tet when it was left.
    pub(super) eas: f64,
    /// Whether walls force it.
    pub(super) is_forced: bool,
}

/// Records of each vertex and cell besides its position.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Records {
    /// First position of each vertex; for one that was inserted later, interpolated between the vertices that
    /// it came from.
    pub(super) first: Vec<Point>,
    /// Position of each vertex when the walls were last at their first position, for walls that come back;
    /// for a vertex inserted later, interpolated between those that it came from.
    pub(super) rest: Option<Vec<Point>>,
    /// Position of each vertex when the step began.
    pub(super) before: Vec<Point>,
    /// The wall node of each vertex, or [`NO_NODE`].
    pub(super) node: Vec<u32>,
    /// For each cell that is a tet of the first mesh, its first EAS; NaN for others.
    pub(super) first_eas: Vec<f64>,
    /// Ids in the first mesh, if that may be put back.
    pub(super) in_first: InFirst,
}

/// The id of each vertex and each cell in the first mesh: none for those that were inserted later. Empty if
/// the first mesh is not remembered.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct InFirst {
    pub(super) vertices: Vec<MaybeId<VertexId>>,
    pub(super) cells: Vec<MaybeId<CellId>>,
}

impl InFirst {
    /// The ids of the first mesh itself.
    pub(super) fn same(first: &Mesh) -> Self {
        Self {
            vertices: (0..first.points.len()).map(|v| VertexId::new(v).into()).collect(),
            cells: (0..first.cells.len()).map(|c| CellId::new(c).into()).collect(),
        }
    }

    /// The ids after a change.
    fn after(&self, history: &History) -> Self {
        if self.vertices.is_empty() {
            return Self::default();
        }
        Self {
            vertices: of_kept(history.vertices.kept(), &self.vertices),
            cells: of_kept(history.cells.kept(), &self.cells),
        }
    }
}

/// The values of the old entities that were kept; none for new ones.
fn of_kept<I: Id>(kept: &[MaybeId<I>], before: &[MaybeId<I>]) -> Vec<MaybeId<I>> {
    kept.iter().map(|old| old.get().map_or(MaybeId::NONE, |old| before[old.place()])).collect()
}

/// A mesh with new connectivity.
pub(super) struct Derived<'a> {
    /// What it was derived from: the current mesh, moved or with arrays of its own where there are any.
    pub(super) given: &'a Mesh,
    pub(super) mesh: Mesh,
    /// Where its vertices and cells came from.
    pub(super) history: Arc<History>,
    /// Positions of the vertices of `given` when the step began.
    pub(super) before: Vec<Point>,
}

impl Records {
    /// The records of a mesh in its first position.
    pub(super) fn at_first(mesh: &Mesh, driven: &[VertexId]) -> Self {
        let mut node = vec![NO_NODE; mesh.points.len()];
        (0..).zip(driven).for_each(|(number, v)| node[v.index()] = number);
        Self {
            first: mesh.points.clone(),
            rest: None,
            before: mesh.points.clone(),
            node,
            first_eas: first_eas(mesh),
            in_first: InFirst::default(),
        }
    }

    /// The records after a change; `before`: where the old vertices were when the step began.
    ///
    /// # Errors
    /// If the history is of another mesh.
    fn after(&self, before: &[Point], history: &History) -> Result<Self> {
        let node = |old: &MaybeId<VertexId>| old.get().map_or(NO_NODE, |old| self.node[old.index()]);
        let eas = |old: &MaybeId<CellId>| old.get().map_or(f64::NAN, |old| self.first_eas[old.index()]);
        let rest = self.rest.as_ref().map(|rest| positions_after(rest, history));
        Ok(Self {
            first: positions_after(&self.first, history)?,
            rest: rest.transpose()?,
            before: positions_after(before, history)?,
            node: history.vertices.kept().iter().map(node).collect(),
            first_eas: history.cells.kept().iter().map(eas).collect(),
            in_first: self.in_first.after(history),
        })
    }
}

/// The EAS of each cell that is a tet; NaN for others.
fn first_eas(mesh: &Mesh) -> Vec<f64> {
    mesh.tet_field("eas", eas).values.to_f64().unwrap_or_default()
}

impl Current {
    /// Sets up the motion of a mesh from its current position.
    fn new(
        mesh: Mesh,
        connectivity: Arc<Connectivity>,
        records: Records,
        left: Vec<LeftBad>,
        wall: &Wall,
        options: &Options,
        threads: &Threads,
    ) -> Result<Self> {
        let mover = Mover::with(&mesh, || connectivity, &options.motion.options(&mesh)?, threads)?;
        Self::of(mesh, mover, records, left, wall, threads)
    }

    /// Builds the state of a mesh with a given mover, whose reference may differ from the current position.
    pub(super) fn of(
        mesh: Mesh,
        mover: Mover,
        records: Records,
        left: Vec<LeftBad>,
        wall: &Wall,
        threads: &Threads,
    ) -> Result<Self> {
        let drive = wall.drive(mover.boundary(), &records.first, &records.node, threads)?;
        let tets = Tets::of_mover(&mover);
        Ok(Self { mesh, tets, mover: Arc::new(mover), records, drive, left })
    }

    /// Continues with a mesh derived from this one.
    pub(super) fn next(
        &self,
        Derived { given, mut mesh, history, before }: Derived<'_>,
        left: Vec<LeftBad>,
        wall: &Wall,
        options: &Options,
        threads: &Threads,
    ) -> Result<Self> {
        pass_contents(given, &mut mesh, &history, &options.contents);
        let records = self.records.after(&before, &history)?;
        let connectivity = self.mover.connectivity().after(&self.mesh, &mesh, &history.cells, threads);
        Self::new(mesh, Arc::new(connectivity), records, left, wall, options, threads)
    }

    /// Continues with the vertices at other positions, from which the mesh moves on.
    ///
    /// `before`: where they were when the step began.
    pub(super) fn rebased(
        &self,
        points: &[Point],
        before: &[Point],
        left: Vec<LeftBad>,
        wall: &Wall,
        options: &Options,
        threads: &Threads,
    ) -> Result<Self> {
        let mesh = self.moved(points, &options.contents);
        let records = Records { before: before.to_vec(), ..self.records.clone() };
        let connectivity = self.mover.connectivity().moved(&mesh, threads);
        Self::new(mesh, connectivity, records, left, wall, options, threads)
    }

    /// Tets that are flat or inverted at the positions that their vertices had when the last step began.
    pub(super) fn inverted_at_start(&self, threads: &Threads) -> Option<InvertedAtStart> {
        let shape = self.tets.shape(&self.records.before, 0.0, threads);
        let worst = shape.worst.map(|(cell, eas, place)| WorstTet { eas, cell, place });
        worst.filter(|_| shape.inverted > 0).map(|worst| InvertedAtStart { tets: shape.inverted, worst })
    }

    /// The displacements of the driven vertices from the mover's reference, given those of the nodes of the
    /// wall.
    pub(super) fn target(&self, displacement: &[Point]) -> Vec<Point> {
        let carried = self.drive.carry(displacement);
        let reference = self.mover.reference();
        let of =
            |(v, d): (&VertexId, Point)| sub(add(self.records.first[v.index()], d), reference[v.index()]);
        self.mover.boundary().iter().zip(carried).map(of).collect()
    }

    /// The current displacements of the driven vertices from the mover's reference.
    pub(super) fn here(&self) -> Vec<Point> {
        let reference = self.mover.reference();
        let of = |v: &VertexId| sub(self.mesh.points[v.index()], reference[v.index()]);
        self.mover.boundary().iter().map(of).collect()
    }

    /// How many vertices are free: inside the volume.
    pub(super) fn n_free(&self) -> usize {
        self.tets.n_inside(self.mesh.points.len())
    }

    /// Whether repair has left this tet, and it is about as bad as then.
    pub(super) fn is_left(&self, cell: CellId, eas: f64) -> bool {
        let found = self.left.binary_search_by_key(&cell, |left| left.cell);
        found.is_ok_and(|i| UNCHANGED_RATIO.contains(&(eas / self.left[i].eas)) || eas == self.left[i].eas)
    }

    /// Drops the records of left tets that are no longer bad: if they become bad again they are tried again.
    pub(super) fn drop_good(&mut self, shape: &Shape) {
        let mut bad: Vec<CellId> = shape.bad.iter().map(|(cell, _)| *cell).collect();
        bad.sort_unstable();
        self.left.retain(|left| bad.binary_search(&left.cell).is_ok());
    }

    /// How many of the bad tets are forced by walls.
    pub(super) fn n_forced(&self, shape: &Shape) -> usize {
        let is_forced = |cell: CellId| {
            let found = self.left.binary_search_by_key(&cell, |left| left.cell);
            found.is_ok_and(|i| self.left[i].is_forced)
        };
        shape.bad.iter().filter(|(cell, _)| is_forced(*cell)).count()
    }

    /// The mesh with its vertices at `points`.
    pub(super) fn moved(&self, points: &[Point], contents: &[String]) -> Mesh {
        let mut mesh = self.mesh.clone();
        move_points(&mut mesh, points, contents);
        mesh
    }
}

/// The rules for arrays that a mesh still has: a rule may name one that the user has removed since.
pub(super) fn present_rules(rules: &Rules, mesh: &Mesh) -> Rules {
    let mut rules = rules.clone();
    rules.points.retain(|name, _| mesh.point_field(name).is_some());
    rules.cells.retain(|name, _| mesh.cell_field(name).is_some());
    rules
}

/// Positions of the vertices of a mesh, carried across its change: interpolated for new vertices.
///
/// # Errors
/// If there is not one position for each old vertex.
pub(super) fn positions_after(places: &[Point], history: &History) -> Result<Vec<Point>> {
    let carried = history.transfer_points_by(&Field::vectors("positions", places), Rule::Linear)?;
    carried.map_or_else(|| Ok(Vec::new()), |field| field.to_vectors())
}
