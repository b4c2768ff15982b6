//! Geometry of points, triangles and tets: distances, shared volumes, quality.

mod distance;
mod distance_oracle;
mod overlap;
mod quality;
