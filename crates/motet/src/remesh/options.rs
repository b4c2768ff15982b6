//! What a remesher is told beside the mesh.

/// What is to be repaired, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// A tet below this EAS is bad. Default: 0.2.
    pub min_eas: f64,
    /// How far to go. Default: [`Goal::Repair`].
    pub goal: Goal,
    /// At most so many rounds over the bad tets. Default: 12.
    pub rounds: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { min_eas: 0.2, goal: Goal::Repair, rounds: 12 }
    }
}

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goal {
    /// No bad tet left, as few tets touched as can be.
    Repair,
    /// The worst tets as good as they get, everywhere.
    Best,
}
