//! Floor 7: how far apart surfaces are, where, and when they will touch.

mod between;

pub use between::{Between, BetweenOptions, GapKind, GapTet, Least, Side, VertexPair, paper};
