//! The report of a remeshing: its certificate.

use serde::Serialize;

use crate::base::{CellId, Point, TetId, reasons};
use crate::geometry::tet::centroid;
use crate::kernel::Complex;
use crate::mesh::is_inverted;
use crate::remesh::classify::classify;
use crate::remesh::left::Left;
use crate::remesh::lengths::Lengths;

/// An operation of the remesher.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Operation {
    /// An edge removed.
    #[default]
    EdgeRemoval,
    /// Facets removed.
    FaceRemoval,
    /// Two crossed edges split, the new vertices joined.
    SplitCrossed,
    /// An edge split at a vertex close to it.
    SplitOnto,
    /// An edge collapsed.
    Collapse,
    /// An edge split.
    SplitEdge,
    /// A vertex moved.
    Smoothing,
    /// A vertex inserted.
    Insertion,
    /// A tet removed that lay folded over the mesh.
    Peeling,
}

/// How often each operation was applied.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[allow(missing_docs, reason = "they are the variants of Operation")]
pub struct Counts {
    pub edge_removal: usize,
    pub face_removal: usize,
    pub split_crossed: usize,
    pub split_onto: usize,
    pub collapse: usize,
    pub split_edge: usize,
    pub smoothing: usize,
    pub insertion: usize,
    pub peeling: usize,
}

impl Counts {
    pub(super) fn add(&mut self, operation: Operation) {
        self.add_many(operation, 1);
    }

    pub(super) fn add_many(&mut self, operation: Operation, n: usize) {
        *match operation {
            Operation::EdgeRemoval => &mut self.edge_removal,
            Operation::FaceRemoval => &mut self.face_removal,
            Operation::SplitCrossed => &mut self.split_crossed,
            Operation::SplitOnto => &mut self.split_onto,
            Operation::Collapse => &mut self.collapse,
            Operation::SplitEdge => &mut self.split_edge,
            Operation::Smoothing => &mut self.smoothing,
            Operation::Insertion => &mut self.insertion,
            Operation::Peeling => &mut self.peeling,
        } += n;
    }
}

/// The worst tet of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Worst<Tet = CellId> {
    /// The tet: as a cell of a whole mesh, or as a tet of a mesh of tets.
    pub tet: Tet,
    /// EAS of the tet.
    pub eas: f64,
    /// Centroid of the tet.
    pub place: Point,
}

/// The size and quality of a mesh at one time.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct State<Tet = CellId> {
    /// How many vertices the tets have.
    pub vertices: usize,
    /// How many of these are free: inside the volume, and on no line.
    pub free_vertices: usize,
    /// The number of tets.
    pub tets: usize,
    /// How many tets are bad, as judged by [`crate::mesh::OrientedTets`] with the given limit.
    pub bad: usize,
    /// How many tets are below the limit but belong to a boundary layer, and so are not bad.
    pub layers: usize,
    /// How many of the bad tets are of each type: I to IV, other.
    pub types: [usize; 5],
    /// How many tets are flat or inverted, by exact signs.
    pub inverted: usize,
    /// The worst tet; `None` if there are no tets.
    pub worst: Option<Worst<Tet>>,
}

impl<Tet> State<Tet> {
    /// The state by cells of a whole mesh: `cell` gives that of a tet.
    fn in_cells(self, cell: impl Fn(Tet) -> CellId) -> State {
        let Self { vertices, free_vertices, tets, bad, layers, types, inverted, worst } = self;
        let worst = worst.map(|worst| Worst { tet: cell(worst.tet), eas: worst.eas, place: worst.place });
        State { vertices, free_vertices, tets, bad, layers, types, inverted, worst }
    }
}

impl State<TetId> {
    /// The state of a complex. `bad` lists all bad tets, including flat and inverted ones; `id` gives the id
    /// of a tet that is reported.
    pub(super) fn of(complex: &Complex, bad: &[TetId], layers: usize, id: impl Fn(TetId) -> TetId) -> Self {
        let mut types = [0; 5];
        bad.iter().for_each(|&t| types[classify(complex.corners(t)).number()] += 1);
        let worst = complex.worst();
        Self {
            vertices: complex.n_used_vertices(),
            free_vertices: complex.n_free_vertices(),
            tets: complex.n_tets(),
            bad: bad.len(),
            layers,
            types,
            inverted: bad.iter().filter(|&&t| is_inverted(complex.corners(t))).count(),
            worst: worst.map(|(t, eas)| Worst { tet: id(t), eas, place: centroid(complex.corners(t)) }),
        }
    }
}

/// Edge lengths compared with the requested sizes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct SizesReport {
    /// For the input mesh.
    pub before: Lengths,
    /// For the new mesh.
    pub after: Lengths,
}

/// Seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Checking the arrays, joining the tets, a rough evaluation of their quality.
    pub join: f64,
    /// Finding and repairing the bad tets.
    pub repair: f64,
    /// Writing the new arrays.
    pub extract: f64,
    /// Building the history.
    pub history: f64,
}

/// What was found, what was done, and what is left. Tets are those of a mesh of tets ([`TetId`]), or cells of
/// a whole mesh ([`CellId`]).
#[derive(Clone, Debug, Default, Serialize)]
#[non_exhaustive]
pub struct Report<Tet = CellId> {
    /// A tet below this EAS counts as bad.
    pub min_eas: f64,
    /// State of the input mesh.
    pub before: State<Tet>,
    /// State of the new mesh.
    pub after: State<Tet>,
    /// How often each operation was applied.
    pub operations: Counts,
    /// How many tets are as in the input, to the bit.
    pub kept: usize,
    /// [`Self::kept`] as a fraction of the input tets.
    pub kept_share: f64,
    /// Edge lengths compared with the requested sizes, if any.
    pub sizes: Option<SizesReport>,
    /// Bad tets that are left, worst first.
    pub left: Vec<Left<Tet>>,
    /// Tets of boundary layers below the limit in the new mesh: not bad, and unchanged.
    pub layers: usize,
    /// Held tets below the limit, which therefore stay.
    pub held: usize,
    /// Seconds by stage.
    pub seconds: Seconds,
}

impl<Tet> Report<Tet> {
    /// The report by cells of a whole mesh: `old` gives the cell of a tet of the input mesh, `new` that of a
    /// tet of the new mesh.
    pub(crate) fn in_cells(self, old: impl Fn(Tet) -> CellId, new: impl Fn(Tet) -> CellId + Copy) -> Report {
        Report {
            min_eas: self.min_eas,
            before: self.before.in_cells(old),
            after: self.after.in_cells(new),
            operations: self.operations,
            kept: self.kept,
            kept_share: self.kept_share,
            sizes: self.sizes,
            left: self.left.into_iter().map(|left| left.in_cells(new)).collect(),
            layers: self.layers,
            held: self.held,
            seconds: self.seconds,
        }
    }
}

impl<Tet> Report<Tet> {
    /// Whether no bad tet is left, and no edge that is too long and may be split.
    pub fn is_complete(&self) -> bool {
        self.not_reached().is_none()
    }

    /// Why the requested result was not reached: bad tets are left, or edges that are too long and may be
    /// split. `None` if it was reached.
    pub fn not_reached(&self) -> Option<String> {
        let n_long = self.sizes.map_or(0, |s| s.after.too_long - s.after.too_long_held);
        let State { bad, inverted, .. } = self.after;
        let bad = (bad > 0).then(|| {
            let n_forced = self.left.iter().filter(|left| left.reason.is_forced()).count();
            format!(
                "{bad} of {} bad tets (EAS below {}) are left: \
                 {inverted} inverted or flat, {n_forced} forced by walls",
                self.before.bad.max(bad),
                self.min_eas
            )
        });
        let long =
            (n_long > 0).then(|| format!("{n_long} edges that may be split are longer than requested"));
        reasons([bad, long])
    }
}
