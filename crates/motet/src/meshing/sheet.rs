//! The triangles of several surfaces as one sheet, in which a triangle that surfaces share is there once.

use super::surfaces::Surfaces;
use crate::base::{Point, VertexId, same_orientation, sorted_ids};

/// How a surface uses a triangle: the surface, its patch, and whether the triangle has the orientation of the
/// first one with these vertices.
pub(super) type Label = (u32, i32, bool);

/// The triangles of surfaces, coincident ones merged.
pub(super) struct Sheet {
    pub(super) triangles: Vec<[VertexId; 3]>,
    /// For each triangle, how the surfaces that contain it use it.
    pub(super) labels: Vec<Vec<Label>>,
}

impl Sheet {
    pub(super) fn of(surfaces: &Surfaces) -> Self {
        let mut order: Vec<usize> = (0..surfaces.triangles.len()).collect();
        let key = |t: usize| sorted_ids(surfaces.triangles[t]);
        order.sort_by_key(|&t| (key(t), t));
        let mut groups: Vec<&[usize]> = order.chunk_by(|&s, &t| key(s) == key(t)).collect();
        groups.sort_by_key(|group| group[0]);
        let label = |first: usize, t: usize| {
            let is_alike = same_orientation(surfaces.triangles[first], surfaces.triangles[t]);
            (surfaces.surface_of[t], surfaces.patches[t], is_alike)
        };
        Self {
            triangles: groups.iter().map(|group| surfaces.triangles[group[0]]).collect(),
            labels: groups.iter().map(|group| group.iter().map(|&t| label(group[0], t)).collect()).collect(),
        }
    }
}

impl Surfaces {
    /// The surfaces with other points and triangles, each with how the surfaces use it.
    pub(super) fn with_sheet<'a>(
        &self,
        points: Vec<Point>,
        triangles: impl ExactSizeIterator<Item = ([VertexId; 3], &'a [Label])>,
    ) -> Self {
        let n = triangles.len();
        let mut surfaces = Self {
            points,
            triangles: Vec::with_capacity(n),
            surface_of: Vec::with_capacity(n),
            patches: Vec::with_capacity(n),
            ..self.clone()
        };
        for ([a, b, c], labels) in triangles {
            for &(surface, patch, is_alike) in labels {
                surfaces.triangles.push(if is_alike { [a, b, c] } else { [a, c, b] });
                surfaces.surface_of.push(surface);
                surfaces.patches.push(patch);
            }
        }
        surfaces
    }
}
