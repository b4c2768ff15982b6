//! The Delaunay triangulation as the caller sees it: arrays under the caller's ids.

use super::finish::{Finished, finish};
use super::input;
use super::insert::triangulate;
use super::order::order;
use super::start::bring_tet_to_front;
use crate::base::{Point, Result, TetId, Threads, VertexId};
use crate::spatial::{Located, Locator};

/// A facet of the convex hull.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HullFacet {
    /// The three vertices, counter-clockwise seen from outside.
    pub vertices: [VertexId; 3],
    /// The tet behind it.
    pub tet: TetId,
    /// The number of this facet in that tet: it lies opposite this vertex.
    pub facet: u8,
}

/// The Delaunay triangulation of a set of points: tets that fill the convex hull, with no point inside the
/// circumsphere of any of them. Where more than four points lie on one sphere, the choice depends only on the
/// set of points.
#[derive(Clone, Debug)]
pub struct Triangulation {
    points: Vec<Point>,
    tets: Vec<[VertexId; 4]>,
    neighbors: Vec<[TetId; 4]>,
    hull: Vec<HullFacet>,
    duplicates: Vec<(VertexId, VertexId)>,
}

impl Triangulation {
    /// Triangulates any set of finite points. The result is the same for any number of threads and, apart
    /// from ids, for any order of the points.
    ///
    /// # Errors
    /// When a coordinate is not finite, when the points do not span a volume (fewer than four distinct ones,
    /// or all on a line or in a plane), or when there are more than 2^30.
    pub fn new(points: &[Point], threads: &Threads) -> Result<Self> {
        Self::ordered(points, threads).map(|(triangulation, _)| triangulation)
    }

    /// Returns the triangulation, and its points in the order by which ties are broken, from 1 on; entry 0 is
    /// unused.
    pub(super) fn ordered(points: &[Point], threads: &Threads) -> Result<(Self, Vec<u32>)> {
        input::check(points)?;
        let scaled = input::scaled(points.to_vec());
        let mut order = order(&scaled.points, threads);
        bring_tet_to_front(&mut order.ids, &scaled.points)?;
        // Vertex 0 is the one at infinity; its point is never used but may be read.
        let vertex_to_id: Vec<u32> = std::iter::once(0).chain(order.ids.iter().copied()).collect();
        let sorted: Vec<Point> = vertex_to_id.iter().map(|&id| scaled.points[id as usize]).collect();
        let store = triangulate(&sorted, scaled.filtered, threads.watch())?;
        let Finished { tets, neighbors, hull } = finish(store, &vertex_to_id, threads);
        let duplicates = order.duplicates.iter().map(|&(d, kept)| (VertexId(d), VertexId(kept))).collect();
        Ok((Self { points: points.to_vec(), tets, neighbors, hull, duplicates }, vertex_to_id))
    }

    /// The points as they were given.
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// The tets, positively oriented.
    pub fn tets(&self) -> &[[VertexId; 4]] {
        &self.tets
    }

    /// For each tet, the tets across the facets opposite its vertices; [`crate::spatial::OUTSIDE`] where
    /// there is none.
    pub fn neighbors(&self) -> &[[TetId; 4]] {
        &self.neighbors
    }

    /// The facets of the convex hull.
    pub fn hull(&self) -> &[HullFacet] {
        &self.hull
    }

    /// Points that coincide with another one, as `(duplicate, kept)` in ascending order. The kept point, the
    /// one with the smallest id, is the vertex of tets.
    pub fn duplicates(&self) -> &[(VertexId, VertexId)] {
        &self.duplicates
    }

    /// A locator that finds the tets of points.
    pub fn locator(&self) -> Locator<'_> {
        Locator::new(&self.points, &self.tets, &self.neighbors)
    }

    /// Finds where `q` lies; the walk starts at `hint`, any tet.
    pub fn locate(&self, q: Point, hint: TetId) -> Located {
        self.locator().locate(q, hint)
    }
}
