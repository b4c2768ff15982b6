//! Floor 6: the Delaunay triangulation of any point set in space, exact.
