//! What a vertex may do.

/// The constraint on a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Hold {
    /// None: the vertex lies inside, and may be moved or removed.
    Free,
    /// The vertex lies on a smooth part of a wall.
    Surface,
    /// The vertex lies on a feature edge: between two patches, or where a wall has a crease.
    Edge,
    /// The vertex stays.
    Fixed,
}
