//! The mesh between two changes: its positions, what moves it, where each vertex was at first.

use std::ops::RangeInclusive;
use std::sync::Arc;

use crate::base::{CellId, Error, Id, Point, Result, Threads, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::vector::{add, sub};
use crate::mesh::history::{History, Rule, Rules};
use crate::mesh::{Field, Mesh};
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
#[derive(Debug)]
pub(super) struct Current {
    /// The mesh with its points at their current positions, and the user's arrays.
    pub(super) mesh: Mesh,
    pub(super) tets: Tets,
    /// Moves the vertices; its reference is the mesh after the last change.
    pub(super) mover: Mover,
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
    pub(super) vertices: Vec<VertexId>,
    pub(super) cells: Vec<CellId>,
}

impl InFirst {
    /// The ids of the first mesh itself.
    pub(super) fn same(first: &Mesh) -> Self {
        Self {
            vertices: (0..first.points.len()).map(VertexId::new).collect(),
            cells: (0..first.cells.len()).map(CellId::new).collect(),
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
fn of_kept<I: Id>(kept: &[I], before: &[I]) -> Vec<I> {
    kept.iter().map(|old| if *old == I::NONE { I::NONE } else { before[old.place()] }).collect()
}

/// A mesh with new connectivity.
pub(super) struct Derived<'a> {
    /// What it was derived from: the current mesh, with [its records](Current::put_records) as arrays.
    pub(super) given: &'a Mesh,
    pub(super) mesh: Mesh,
    /// Where its vertices and cells came from.
    pub(super) history: Arc<History>,
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
}

/// The EAS of each cell that is a tet; NaN for others.
fn first_eas(mesh: &Mesh) -> Vec<f64> {
    mesh.tet_field("eas", eas).values.to_f64().unwrap_or_default()
}

impl Current {
    /// Sets up the motion of a mesh from its current position.
    pub(super) fn new(
        mesh: Mesh,
        records: Records,
        left: Vec<LeftBad>,
        wall: &Wall,
        options: &Options,
        threads: &Threads,
    ) -> Result<Self> {
        let mover = Mover::new(&mesh, &options.motion.of(&mesh), threads)?;
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
        let tets = Tets::of(&mesh);
        Ok(Self { mesh, tets, mover, records, drive, left })
    }

    /// Continues with a mesh derived from this one.
    pub(super) fn next(
        &self,
        Derived { given, mut mesh, history }: Derived<'_>,
        left: Vec<LeftBad>,
        wall: &Wall,
        options: &Options,
        threads: &Threads,
    ) -> Result<Self> {
        pass_contents(given, &mut mesh, &history, &options.contents);
        let records = self.take_records(&mut mesh, &history)?;
        Self::new(mesh, records, left, wall, options, threads)
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

    /// Adds the records of vertices to a mesh that is about to change, as point arrays, and returns the rules
    /// with those for them. `before` is where the vertices were when the step began.
    pub(super) fn put_records(&self, mesh: &mut Mesh, before: &[Point], rules: &Rules) -> Rules {
        let mut rules = rules.clone();
        let rest = self.records.rest.as_deref().map(|rest| (REST, rest));
        for (name, values) in
            [(FIRST, self.records.first.as_slice()), (BEFORE, before)].into_iter().chain(rest)
        {
            mesh.set_point_field(Field::vectors(name, values));
            rules.points.insert(name.to_owned(), Rule::Linear);
        }
        // A rule may name an array that the user has removed since.
        rules.points.retain(|name, _| mesh.point_field(name).is_some());
        rules.cells.retain(|name, _| mesh.cell_field(name).is_some());
        rules
    }

    /// Takes the records of vertices off a mesh derived from one that [has them as arrays](Self::put_known).
    pub(super) fn take_records(&self, mesh: &mut Mesh, history: &History) -> Result<Records> {
        let mut take = |name: &str| -> Result<Field> {
            let place = mesh.point_data.iter().position(|field| field.name == name);
            let place = place
                .ok_or_else(|| Error::input(format!("the array {name} was lost while the mesh changed")))?;
            Ok(mesh.point_data.remove(place))
        };
        let (first, before) = (take(FIRST)?.to_vectors()?, take(BEFORE)?.to_vectors()?);
        let rest = self.records.rest.as_ref().map(|_| take(REST)?.to_vectors()).transpose()?;
        let node = |old: &VertexId| match *old == VertexId::NONE {
            true => NO_NODE,
            false => self.records.node[old.index()],
        };
        let eas = |old: &CellId| match *old == CellId::NONE {
            true => f64::NAN,
            false => self.records.first_eas[old.index()],
        };
        Ok(Records {
            first_eas: history.cells.kept().iter().map(eas).collect(),
            in_first: self.records.in_first.after(history),
            first,
            rest,
            before,
            node: history.vertices.kept().iter().map(node).collect(),
        })
    }
}

/// Point arrays that are carried along while a mesh changes.
pub(super) const FIRST: &str = "moving:first";
pub(super) const REST: &str = "moving:rest";
pub(super) const BEFORE: &str = "moving:before";
/// A cell array of a saved state.
pub(super) const FIRST_EAS: &str = "moving:first_eas";
