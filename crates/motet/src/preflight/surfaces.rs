//! The given surfaces, and the role of each.

use serde::{Deserialize, Serialize};

use crate::base::{Point, VertexId};

/// What a surface is for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// It bounds what is meshed, so it has to be closed.
    #[default]
    Boundary,
    /// It lies within what is meshed, and may end anywhere.
    Membrane,
}

/// Triangles over one list of points, each from one of several surfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surfaces<'a> {
    pub(super) points: &'a [Point],
    pub(super) triangles: &'a [[VertexId; 3]],
    pub(super) surface_of: &'a [u32],
    pub(super) roles: &'a [Role],
}

impl<'a> Surfaces<'a> {
    /// Panics if the lists do not match in length, or a triangle names a point or a surface that does not
    /// exist.
    pub(super) fn new(
        points: &'a [Point],
        triangles: &'a [[VertexId; 3]],
        surface_of: &'a [u32],
        roles: &'a [Role],
    ) -> Self {
        assert_eq!(triangles.len(), surface_of.len(), "each triangle is of one surface");
        assert!(surface_of.iter().all(|&s| (s as usize) < roles.len()), "each surface has a role");
        assert!(triangles.as_flattened().iter().all(|v| v.index() < points.len()), "each vertex has a point");
        Self { points, triangles, surface_of, roles }
    }

    pub(super) fn corners(&self, triangle: u32) -> [Point; 3] {
        self.triangles[triangle as usize].map(|v| self.points[v.index()])
    }

    pub(super) fn surface(&self, triangle: u32) -> u32 {
        self.surface_of[triangle as usize]
    }

    pub(super) fn role(&self, surface: u32) -> Role {
        self.roles[surface as usize]
    }

    /// The ids of all triangles.
    pub(super) fn ids(&self) -> std::ops::Range<u32> {
        0..self.triangles.len() as u32
    }
}
