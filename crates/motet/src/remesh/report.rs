//! What a remeshing did: the certificate.

use serde::Serialize;

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
}

impl Operation {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::EdgeRemoval,
        Self::FaceRemoval,
        Self::SplitCrossed,
        Self::SplitOnto,
        Self::Collapse,
        Self::SplitEdge,
        Self::Smoothing,
        Self::Insertion,
    ];
}

/// What was found, what was done, what is left.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Report {
    /// Bad tets by type (I to IV, other) before.
    pub found: [usize; 5],
    /// Bad tets by type after.
    pub left: [usize; 5],
    /// How often each operation was made, in the order of [`Operation::ALL`].
    pub operations: [usize; 8],
    /// Tets before and after.
    pub tets: [usize; 2],
    /// Tets of the first mesh that are still there, to the bit.
    pub kept: usize,
    /// Worst EAS before and after.
    pub worst_eas: [f64; 2],
    /// Inverted or flat tets before and after.
    pub inverted: [usize; 2],
    /// Seconds: joining the tets and measuring them, repairing.
    pub seconds: [f64; 2],
}
