//! Triangulated tubes: rings of vertices along z, whose points can be bent onto an arc.

use std::f64::consts::TAU;
use std::ops::Range;

use crate::base::{Point, VertexId};

/// Rings of `around` vertices each, numbered ring by ring from `first` on.
#[derive(Clone, Copy)]
pub(super) struct Sleeve {
    pub(super) first: usize,
    pub(super) around: usize,
}

impl Sleeve {
    pub(super) fn at(&self, ring: usize, i: usize) -> VertexId {
        VertexId::new(self.first + ring * self.around + i % self.around)
    }

    /// The vertices of a ring, counter-clockwise seen from positive z.
    pub(super) fn ring(&self, ring: usize) -> Vec<VertexId> {
        (0..self.around).map(|i| self.at(ring, i)).collect()
    }

    /// The triangles between consecutive rings, facing away from the axis.
    pub(super) fn triangles(&self, rings: Range<usize>) -> Vec<[VertexId; 3]> {
        rings
            .flat_map(|ring| (0..self.around).map(move |i| (ring, i)))
            .flat_map(|(ring, i)| {
                split_quad(
                    [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(up, on)| self.at(ring + up, i + on)),
                    ring + i,
                )
            })
            .collect()
    }
}

/// Divides a quad into two triangles; for odd `parity` along the other diagonal, so that no direction is
/// preferred.
pub(super) fn split_quad([a, b, c, d]: [VertexId; 4], parity: usize) -> [[VertexId; 3]; 2] {
    if parity.is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
}

/// The points of the rings of a cylinder along z, `slices` steps long.
pub(super) fn cylinder(radius: f64, length: f64, around: usize, slices: usize) -> Vec<Point> {
    (0..=slices)
        .flat_map(|s| (0..around).map(move |i| (s, i)))
        .map(|(s, i)| {
            let (sin, cos) = (TAU * i as f64 / around as f64).sin_cos();
            [radius * cos, radius * sin, length * s as f64 / slices as f64]
        })
        .collect()
}

/// Bends points that lie along z, from 0 to `length`, onto an arc of `bend_deg` degrees towards x.
pub(super) fn bend(points: &mut [Point], length: f64, bend_deg: f64) {
    if bend_deg == 0.0 {
        return;
    }
    let radius = length / bend_deg.to_radians();
    for p in points {
        let (sin, cos) = (p[2] / radius).sin_cos();
        let from_centre = radius - p[0];
        *p = [radius - from_centre * cos, p[1], from_centre * sin];
    }
}

pub(super) fn reversed(triangles: Vec<[VertexId; 3]>) -> Vec<[VertexId; 3]> {
    triangles.into_iter().map(|[a, b, c]| [a, c, b]).collect()
}
