//! Where the points and the triangles of a new surface lie on the given one.

use super::original::Original;
use crate::base::{Point, Threads, VertexId};
use crate::geometry::triangle::centroid;

/// A place in a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// The triangle, by its index.
    pub triangle: usize,
    /// The weights of its corners: each in [0, 1], with sum 1.
    pub weights: [f64; 3],
}

/// Where a new surface lies on the given one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Places {
    /// The nearest place of each point of the new surface; `None` for points that no triangle uses.
    pub points: Vec<Option<Place>>,
    /// The given triangle nearest to the centroid of each new one.
    pub triangles: Vec<usize>,
}

/// A surface: its points, its triangles, and the label of each triangle.
pub type Labelled<'a> = (&'a [Point], &'a [[VertexId; 3]], &'a [u32]);

/// The places of a new surface on the given one, each in the nearest triangle of the same label; a point has
/// the label of the first triangle that uses it.
///
/// Panics if the new surface has a label that the given one lacks, or a triangle names a point that does not
/// exist.
pub fn places(given: Labelled<'_>, new: Labelled<'_>, threads: &Threads) -> Places {
    let original = Original::new(given.0, given.1, given.2, 0.0, threads);
    let (points, triangles, labels) = new;
    let mut label_of = vec![None; points.len()];
    for (t, &label) in triangles.iter().zip(labels).rev() {
        t.iter().for_each(|v| label_of[v.index()] = Some(label));
    }
    let nearest = |label: u32, p: Point| {
        let found = original.near(label, p, f64::INFINITY).expect("the given surface has the label");
        Place { triangle: original.id(label, &found), weights: found.weights }
    };
    Places {
        points: threads.map(points.len(), |v| label_of[v].map(|label| nearest(label, points[v]))),
        triangles: threads.map(triangles.len(), |t| {
            nearest(labels[t], centroid(triangles[t].map(|v| points[v.index()]))).triangle
        }),
    }
}
