//! What a remeshing did: the certificate.

use serde::Serialize;

use crate::base::{Point, TetId, reasons};
use crate::geometry::tet::centroid;
use crate::kernel::Complex;
use crate::mesh::is_inverted;
use crate::remesh::classify::classify;
use crate::remesh::left::Left;
use crate::remesh::lengths::Lengths;

/// An operation that repaired something.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
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
    /// A tet removed that was folded over the mesh.
    Peeling,
}

/// How often each operation was made.
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
pub struct Worst {
    /// Which tet.
    pub tet: u32,
    /// Its EAS.
    pub eas: f64,
    /// Its centre.
    pub place: Point,
}

/// How a mesh is at one time.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct State {
    /// How many vertices tets have.
    pub vertices: usize,
    /// How many of these nothing holds: they lie inside, and on no line.
    pub free_vertices: usize,
    /// How many tets there are.
    pub tets: usize,
    /// How many are bad: as [`crate::mesh::OrientedTets`] judges them, by the limit that was given.
    pub bad: usize,
    /// How many are below the limit and belong to a boundary layer: these are not bad.
    pub layers: usize,
    /// How many of the bad are of each type: I to IV, other.
    pub types: [usize; 5],
    /// How many are flat or inverted, by exact signs.
    pub inverted: usize,
    /// The worst tet; `None` where there is none.
    pub worst: Option<Worst>,
}

impl State {
    /// `bad` are all that are bad, flat and inverted ones among them; `id` tells which tet each is to the reader.
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
            worst: worst.map(|(t, eas)| Worst { tet: id(t).0, eas, place: centroid(complex.corners(t)) }),
        }
    }
}

/// Edges beside the sizes that are asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SizesReport {
    /// Of the mesh as it came.
    pub before: Lengths,
    /// Of the mesh as it is.
    pub after: Lengths,
}

/// Seconds by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Seconds {
    /// Checking the arrays, joining the tets, a rough look at their quality.
    pub join: f64,
    /// Finding the bad and repairing them.
    pub repair: f64,
    /// The new arrays.
    pub extract: f64,
    /// The history.
    pub history: f64,
}

/// What was found, what was done, what is left.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// A tet below this EAS counts as bad.
    pub min_eas: f64,
    /// The mesh as it came.
    pub before: State,
    /// The mesh as it is.
    pub after: State,
    /// How often each operation was made.
    pub operations: Counts,
    /// How many tets are as they came, to the bit.
    pub kept: usize,
    /// The same as a part of the tets that came.
    pub kept_share: f64,
    /// Edges beside their sizes, where sizes are asked for.
    pub sizes: Option<SizesReport>,
    /// Bad tets that are left, worst first.
    pub left: Vec<Left>,
    /// Tets of boundary layers below the limit, in the mesh as it is: not bad, and as they came.
    pub layers: usize,
    /// Tets that are held and would count as bad, and stay.
    pub held: usize,
    /// Seconds by stage.
    pub seconds: Seconds,
}

impl Report {
    /// Whether nothing bad is left, and no edge that is too long and may be split.
    pub fn is_complete(&self) -> bool {
        self.not_reached().is_none()
    }

    /// Why the requested result was not reached: bad tets are left, or edges that are too long and may be split. `None` where it was reached.
    pub fn not_reached(&self) -> Option<String> {
        let n_long = self.sizes.map_or(0, |s| s.after.too_long - s.after.too_long_held);
        let State { bad, inverted, .. } = self.after;
        let bad = (bad > 0).then(|| {
            let n_forced = self.left.iter().filter(|left| left.reason.is_forced()).count();
            format!(
                "{bad} of {} bad tets (EAS below {}) are left: {inverted} inverted or flat, {n_forced} forced by walls",
                self.before.bad.max(bad),
                self.min_eas
            )
        });
        let long =
            (n_long > 0).then(|| format!("{n_long} edges that may be split are longer than requested"));
        reasons([bad, long])
    }
}
