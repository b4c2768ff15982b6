//! The original surface of a device: how often it goes around places, and where it cuts edges.

use super::cubes::Lattice;
use super::facing::{face, volume};
use crate::base::{DisjointSets, Error, Point, Result, Threads};
use crate::contact::is_closed;
use crate::geometry::distance::segment_triangle::meet;
use crate::geometry::tet::{self, EDGES};
use crate::geometry::triangle::area;
use crate::geometry::vector::{distance, in_range};
use crate::mesh::{Surface, firsts_at_place};
use crate::preflight::renamed;
use crate::spatial::{BoxTree, NearestTriangle, WindingNumber, bounding_box};

/// A point is inside above this winding number.
const INSIDE: f64 = 0.5;

/// Balls count as overlapping if they do by more than this fraction, so that rounding joins none.
const OVERLAP: f64 = 1e-9;

/// The original surface, and what finds its triangles.
pub(super) struct OriginalSurface {
    pub(super) surface: Surface,
    pub(super) nearest: NearestTriangle,
    winding: WindingNumber,
    boxes: BoxTree,
    /// Whether it goes around each place a whole number of times.
    is_closed: bool,
    /// The radius of a round wire with the same volume per area.
    pub(super) radius: f64,
}

pub(super) fn encloses_nothing(name: &str) -> Error {
    Error::input(format!("the surface of the device `{name}` encloses no volume"))
        .at("its surface")
        .remedy("close the larger openings of the surface")
}

impl OriginalSurface {
    /// Orients the surface and prepares it for searching.
    ///
    /// # Errors
    /// When it encloses nothing or has corners that are not finite.
    pub(super) fn new(mut surface: Surface, name: &str, threads: &Threads) -> Result<Self> {
        let off = surface.vertices().into_iter().find(|v| !in_range(surface.points[v.index()]));
        if let Some(v) = off {
            return Err(Error::input(format!(
                "the device `{name}` has a coordinate that is not finite or too large"
            ))
            .at(format!("point {v}"))
            .remedy("correct the point, or remove it with its triangles"));
        }
        surface.triangles = renamed(&surface.triangles, &firsts_at_place(&surface.points));
        face(&mut surface, threads)?;
        let corners = || (0..surface.triangles.len()).map(|t| surface.corners(t));
        let volume = volume(&surface.points, &surface.triangles);
        let whole = corners().map(area).sum::<f64>();
        if volume <= 0.0 || whole <= 0.0 {
            return Err(encloses_nothing(name));
        }
        Ok(Self {
            nearest: NearestTriangle::new(&surface.points, &surface.triangles, threads),
            winding: WindingNumber::new(&surface.points, &surface.triangles),
            boxes: BoxTree::new(&corners().map(bounding_box).collect::<Vec<_>>()),
            is_closed: is_closed(&surface.triangles),
            radius: 2.0 * volume / whole,
            surface,
        })
    }

    /// How often the surface goes around a place.
    pub(super) fn winding(&self, p: Point) -> f64 {
        let winding = self.winding.at(p);
        if self.is_closed { winding.round() } else { winding }
    }

    /// Whether a place with this winding number is inside. A closed surface contains whatever it goes around,
    /// in either direction.
    pub(super) fn is_inside(&self, winding: f64) -> bool {
        (if self.is_closed { winding.abs() } else { winding }) > INSIDE
    }

    /// The winding number at each vertex.
    ///
    /// The winding number of a closed surface changes only across triangles. No triangle is in the ball
    /// around a vertex that reaches to the nearest one; so where the balls at the two ends of an edge
    /// overlap, both have the same number. It is computed for only one vertex of each part connected in this
    /// way: for the lattice of the public coil, 1 in 20.
    pub(super) fn windings(&self, lattice: &Lattice, threads: &Threads) -> Vec<f64> {
        let n = lattice.points.len();
        if !self.is_closed {
            return threads.map(n, |v| self.winding(lattice.points[v]));
        }
        let found = self.nearest.closest_all(&lattice.points, None, threads);
        let radius = |v: usize| found[v].map_or(0.0, |found| found.distance_squared.sqrt());
        let radii: Vec<f64> = (0..n).map(radius).collect();
        let mut sets = DisjointSets::new(n);
        for tet in &lattice.tets {
            for [u, v] in EDGES.map(|edge| edge.map(|k| tet[k].index())) {
                let length = distance(lattice.points[u], lattice.points[v]);
                if radii[u] + radii[v] > length * (1.0 + OVERLAP) {
                    sets.join(u as u32, v as u32);
                }
            }
        }
        let roots: Vec<usize> = sets.roots().into_iter().map(|root| root as usize).collect();
        let queries: Vec<usize> = (0..n).filter(|&v| roots[v] == v).collect();
        let answers = threads.map(queries.len(), |i| self.winding(lattice.points[queries[i]]));
        let mut windings = vec![0.0; n];
        queries.iter().zip(answers).for_each(|(&v, winding)| windings[v] = winding);
        (0..n).for_each(|v| windings[v] = windings[roots[v]]);
        windings
    }

    /// Where the surface ends on the way from a place inside to one outside: as a fraction of the way, from
    /// the winding numbers of both.
    ///
    /// The number falls by one where the way leaves through a triangle, and rises by one where it enters; the
    /// rest of the difference, near open ends, is spread evenly. Several triangles that meet where the way
    /// passes through count more than once: it ends there all the same.
    pub(super) fn crossing_on_way(&self, way: [Point; 2], [from, to]: [f64; 2], near: &mut Vec<u32>) -> f64 {
        self.boxes.touching(bounding_box(way), near);
        let mut passed: Vec<(f64, f64)> = Vec::new();
        for &t in near.iter() {
            let [a, b, c] = self.surface.corners(t as usize);
            // Positive behind the triangle.
            let [before, after] = way.map(|p| tet::volume([a, c, b, p]));
            if before != after && meet(way, [a, b, c]) {
                let share = (before / (before - after)).clamp(0.0, 1.0);
                passed.push((share, if before > after { -1.0 } else { 1.0 }));
            }
        }
        passed.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.total_cmp(&y.1)));
        let slope = to - from - passed.iter().map(|(_, change)| change).sum::<f64>();
        let mut sum = from;
        let mut last = 0.0;
        for (share, change) in passed.into_iter().chain([(1.0, 0.0)]) {
            let (here, there) = (sum + slope * last, sum + slope * share);
            if !self.is_inside(there) {
                return last + (share - last) * crossed(here, there);
            }
            sum += change;
            if !self.is_inside(sum + slope * share) {
                return share;
            }
            last = share;
        }
        last
    }
}

/// Where the limit lies between two numbers, one of a place inside and one of a place outside; as a fraction
/// of the way.
fn crossed(inside: f64, outside: f64) -> f64 {
    let limit = INSIDE.copysign(inside);
    ((inside - limit) / (inside - outside)).clamp(0.0, 1.0)
}
