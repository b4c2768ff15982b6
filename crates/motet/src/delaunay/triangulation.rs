//! The Delaunay triangulation as the caller sees it: arrays under the caller's ids.

use super::finish::{Finished, by_slots};
use super::input;
use super::insert::{Division, triangulate};
use super::numbering::by_vertices;
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
        Self::divided(points, Division::USUAL, threads)
    }

    /// Triangulates as [`Self::ordered`] does, with space divided into parts as requested.
    fn divided(points: &[Point], division: Division, threads: &Threads) -> Result<(Self, Vec<u32>)> {
        input::check(points)?;
        let scaled = input::scaled(points.to_vec());
        let mut order = order(&scaled.points, threads);
        bring_tet_to_front(&mut order.ids, &scaled.points)?;
        // Vertex 0 is the one at infinity; its point is never used but may be read.
        let vertex_to_id: Vec<u32> = std::iter::once(0).chain(order.ids.iter().copied()).collect();
        let sorted: Vec<Point> = threads.map(vertex_to_id.len(), |v| scaled.points[vertex_to_id[v] as usize]);
        // Vertices are numbered from 1.
        let rounds: Vec<u32> = order.rounds.iter().map(|&place| place + 1).collect();
        let store = triangulate(&sorted, &rounds, scaled.filtered, division, threads)?;
        let arrays = store.into_arrays();
        let Finished { tets, neighbors, hull } = match division.applies(sorted.len()) {
            true => by_vertices(arrays, &vertex_to_id, threads),
            false => by_slots(arrays, &vertex_to_id, threads),
        };
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

    /// The facets of the convex hull, in the order of their tets.
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::{Division, Triangulation};
    use crate::base::{Point, TetId, Threads, VertexId, splitmix64};
    use crate::spatial::OUTSIDE;

    /// Parts of so few points that small sets are divided many times.
    const SMALL: Division = Division { least: 100, least_of_part: 40 };

    fn random(n: u64, seed: u64) -> Vec<Point> {
        let coordinate = |i: u64| (splitmix64(seed ^ i << 20) >> 11) as f64 / (1u64 << 53) as f64 - 0.5;
        (0..n).map(|i| [3 * i, 3 * i + 1, 3 * i + 2].map(coordinate)).collect()
    }

    fn on_sphere(n: u64) -> Vec<Point> {
        let unit = |p: Point| p.map(|x| x / p.iter().map(|x| x * x).sum::<f64>().sqrt());
        random(n, 5).into_iter().map(unit).collect()
    }

    fn grid(n: usize) -> Vec<Point> {
        (0..n * n * n).map(|i| [i % n, i / n % n, i / n / n].map(|x| x as f64)).collect()
    }

    /// Two clusters far apart, two skew lines, and a point far away from all.
    fn uneven() -> Vec<Point> {
        let mut points = random(1500, 7);
        points.extend(random(1500, 8).into_iter().map(|p| p.map(|x| 1e3 + 1e-6 * x)));
        points.extend((0..300).map(|i| [f64::from(i), 0.0, 50.0]));
        points.extend((0..300).map(|i| [0.0, f64::from(i), 60.0]));
        points.push([1e9; 3]);
        points
    }

    fn set_of(triangulation: &Triangulation) -> BTreeSet<[VertexId; 4]> {
        let ascending = |mut tet: [VertexId; 4]| {
            tet.sort_unstable();
            tet
        };
        triangulation.tets.iter().copied().map(ascending).collect()
    }

    fn check_neighbors(triangulation: &Triangulation) {
        for (tet, beyond) in triangulation.neighbors.iter().enumerate() {
            for (facet, &other) in beyond.iter().enumerate().filter(|(_, other)| **other != OUTSIDE) {
                let back = triangulation.neighbors[other.index()];
                assert!(back.contains(&TetId::new(tet)));
                let shared = (0..4).filter(|&i| i != facet).map(|i| triangulation.tets[tet][i]);
                assert!(shared.into_iter().all(|v| triangulation.tets[other.index()].contains(&v)));
            }
        }
    }

    #[test]
    fn parts_and_threads_change_nothing() {
        let sets = [random(6000, 1), on_sphere(5000), grid(17), uneven()];
        for points in sets {
            let whole = Triangulation::ordered(&points, &Threads::single()).unwrap().0;
            let divided = |n: usize| {
                let threads = Threads::exactly(n).unwrap();
                Triangulation::divided(&points, SMALL, &threads).unwrap().0
            };
            let first = divided(1);
            assert_eq!(set_of(&first), set_of(&whole));
            assert_eq!(first.hull.len(), whole.hull.len());
            check_neighbors(&first);
            for n in [2, 3, 7] {
                let other = divided(n);
                assert_eq!(first.tets, other.tets);
                assert_eq!(first.neighbors, other.neighbors);
                assert_eq!(first.hull, other.hull);
            }
        }
    }
}
