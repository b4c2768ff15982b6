//! The closest points of a point and a triangle.

use super::Closest;
use super::frame::{Frame, offset};
use crate::base::Point;
use crate::geometry::triangle;

/// The closest points of a point and a triangle. A triangle without area is treated as its edges.
pub fn closest(p: Point, triangle: [Point; 3]) -> Closest<1, 3> {
    let (frame, p, triangle) = Frame::around([p], triangle);
    let on_b = triangle::closest(triangle, p[0]);
    frame.closest([1.0], on_b, offset(&p, &[1.0], &triangle, &on_b))
}
