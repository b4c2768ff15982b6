//! Floor 7: mesh motion. Boundary displacement in, volume mesh out.
