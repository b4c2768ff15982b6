//! Floor 7: how far apart surfaces are, where, and when they will touch.
