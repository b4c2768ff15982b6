//! Searches in space: the tet that contains a point, the nearest triangle.

mod locate;
mod nearest;
