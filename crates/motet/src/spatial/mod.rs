//! Floor 3: searching in space.
