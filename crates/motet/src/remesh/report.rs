//! What a remeshing did: the certificate.

use serde::Serialize;

use crate::base::{Point, TetId};
use crate::geometry::tet::centroid;
use crate::kernel::Complex;
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
    /// How many tets there are.
    pub tets: usize,
    /// How many are bad.
    pub bad: usize,
    /// How many of the bad are of each type: I to IV, other.
    pub types: [usize; 5],
    /// How many are flat or inverted.
    pub inverted: usize,
    /// The worst tet; `None` where there is none.
    pub worst: Option<Worst>,
}

impl State {
    /// `bad` are all that are bad, flat and inverted ones among them; `id` tells which tet each is to the reader.
    pub(super) fn of(complex: &Complex, bad: &[TetId], id: impl Fn(TetId) -> TetId) -> Self {
        let mut types = [0; 5];
        bad.iter().for_each(|&t| types[classify(complex.corners(t)).number()] += 1);
        let worst = complex.worst();
        Self {
            vertices: complex.n_used_vertices(),
            tets: complex.n_tets(),
            bad: bad.len(),
            types,
            inverted: bad.iter().filter(|&&t| complex.quality(t) <= 0.0).count(),
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
    /// Tets of boundary layers that would count as bad, and stay.
    pub layers: usize,
    /// Tets that are held and would count as bad, and stay.
    pub held: usize,
    /// Seconds by stage.
    pub seconds: Seconds,
}

impl Report {
    /// Whether nothing bad is left, and no edge that is too long and may be split.
    pub fn is_complete(&self) -> bool {
        let is_long = |s: SizesReport| s.after.too_long > s.after.too_long_held;
        self.after.bad == 0 && !self.sizes.is_some_and(is_long)
    }
}
