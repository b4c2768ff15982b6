//! Remakes some of the tets on one side of the surface from a single point inside.
//!
//! Suppose that a flat part of the surface is to have other triangles, whatever these are. If the tets on it
//! see a point just inside, tets from that point to the facets around them and to the new triangles fill the
//! same space (a cone). So the surface can be triangulated differently at the price of a point inside,
//! whatever tets there are.

use super::flatness::{is_flat, is_needle};
use super::sites::Sites;
use crate::base::{Point, TetId, VertexId};
use crate::geometry::deepest::deepest;
use crate::geometry::predicates::pair::{self, Pair, cross as cross_in_pairs, dot as dot_in_pairs};
use crate::geometry::predicates::spot::{Spot, orient3d_of};
use crate::geometry::vector::{add, cross, distance, dot, norm, scale, sub};
use crate::kernel::{HalfFacet, Tets};
use pulp::Scalar;

/// A cavity on one side of the surface, to be refilled.
#[derive(Clone, Default)]
pub(super) struct Side {
    pub(super) tets: Vec<TetId>,
    /// The facets around the tets except those on the surface: the facet behind, and the vertices seen from
    /// inside.
    pub(super) shell: Vec<(HalfFacet, [VertexId; 3])>,
    /// The new triangles of the surface, seen from inside.
    pub(super) base: Vec<[VertexId; 3]>,
}

/// Distances of the point from the surface to try, as fractions of the distance to the centre of the facets
/// around.
const FRACTIONS: [f64; 12] = [0.6, 0.4, 0.25, 0.15, 0.08, 0.04, 0.02, 0.005, 1e-3, 1e-4, 1e-6, 1e-8];

impl Side {
    pub(super) fn faces(&self) -> impl Iterator<Item = [VertexId; 3]> + Clone + '_ {
        self.shell.iter().map(|&(_, face)| face).chain(self.base.iter().copied())
    }

    /// A point near `middle` that sees all facets around; of those tried, the one with the best worst tet.
    pub(super) fn place(&self, sites: &Sites, middle: Point) -> Option<Point> {
        let (directions, reach) = self.directions(sites, middle);
        let mut best: Option<(f64, Point)> = None;
        for way in FRACTIONS {
            for direction in directions {
                let p = add(middle, scale(direction, way));
                let worst = self.worst(sites, p);
                if worst > best.map_or(0.0, |(worst, _)| worst) && self.sees(sites, p) {
                    best = Some((worst, p));
                }
            }
            if best.is_some() && way < 0.1 {
                break;
            }
        }
        best.map(|(_, p)| p).or_else(|| self.deepest(sites, middle, reach))
    }

    /// Two directions from `middle`, towards the centre of the facets around and away from the surface; and
    /// the mean distance of those facets.
    pub(super) fn directions(&self, sites: &Sites, middle: Point) -> ([Point; 2], f64) {
        let corners = || self.shell.iter().flat_map(|(_, face)| face).map(|&v| sites.near(v));
        let n = 3.0 * self.shell.len() as f64;
        let centre = scale(corners().fold([0.0; 3], add), 1.0 / n);
        let reach = corners().map(|p| distance(p, middle)).sum::<f64>() / n;
        let normals = self.base.iter().map(|face| {
            let [a, b, c] = face.map(|v| sites.near(v));
            let normal = cross(sub(b, a), sub(c, a));
            scale(normal, 1.0 / norm(normal).max(f64::MIN_POSITIVE))
        });
        let inward = normals.fold([0.0; 3], add);
        let inward = scale(inward, reach / norm(inward).max(f64::MIN_POSITIVE));
        ([sub(centre, middle), inward], reach)
    }

    /// The point farthest from the nearest plane of a facet around, at most `reach` from `middle` along each
    /// axis, if it sees all facets.
    fn deepest(&self, sites: &Sites, middle: Point, reach: f64) -> Option<Point> {
        // Facets may be needles, and the space between their planes a billion times narrower than they are
        // long.
        let half_space = |face: [VertexId; 3]| {
            let [a, b, c] = face.map(|v| sites.near(v));
            let normal = cross_in_pairs::<Scalar>(pair::difference(b, a), pair::difference(c, a));
            let offset = dot_in_pairs::<Scalar>(normal, pair::difference(a, middle)).value();
            let normal = normal.map(Pair::value);
            let length = norm(normal);
            (scale(normal, 1.0 / length), offset / length / reach)
        };
        let half_spaces = self.faces().map(half_space).filter(|(normal, _)| normal[0].is_finite());
        let (way, depth) = deepest(half_spaces);
        let p = add(middle, scale(way, reach));
        (depth > 0.0 && self.sees(sites, p)).then_some(p)
    }

    /// The least share of a tet on a facet around; a tiny positive value where it is too small for its sign
    /// to be certain.
    fn worst(&self, sites: &Sites, p: Point) -> f64 {
        let worst = self.faces().map(|face| share(sites, face, p)).fold(f64::INFINITY, f64::min);
        if worst.abs() < 1e-12 { f64::MIN_POSITIVE } else { worst }
    }

    /// The cavity of all tets at a vertex inside.
    pub(super) fn of_star(tets: &Tets, vertex: VertexId, star: &[TetId]) -> Self {
        let mut side = Self { tets: star.to_vec(), ..Self::default() };
        for half in star.iter().flat_map(|&tet| Tets::facets(tet)) {
            if tets.vertices(half.tet())[half.facet()] == vertex {
                side.shell.push((tets.across(half), tets.inward(half)));
            }
        }
        side
    }

    /// The vertex of the cavity from which the worst tet would be best, if that is better than `least` and
    /// the vertex sees all facets of which it is not a vertex.
    pub(super) fn best_apex(&self, sites: &Sites, least: f64) -> Option<VertexId> {
        let mut around: Vec<VertexId> = self.faces().flatten().collect();
        around.sort_unstable();
        around.dedup();
        let mut best = (least, None);
        for apex in around {
            let p = sites.near(apex);
            let mut faces = self.faces().filter(|face| !face.contains(&apex));
            let worst = faces.clone().map(|face| share(sites, face, p)).fold(f64::INFINITY, f64::min);
            let sees = |[a, b, c]: [VertexId; 3]| {
                sites.orient3d([a, b, c, apex]) > 0 && !makes_flat(sites, [a, b, c], p)
            };
            if worst > best.0 && faces.all(sees) {
                best = (worst, Some(apex));
            }
        }
        best.1
    }

    /// A place for an interior vertex that improves its worst tet.
    pub(super) fn better_place(&self, sites: &Sites, vertex: VertexId, worst: f64) -> Option<Point> {
        let place = self.place(sites, sites.near(vertex))?;
        (self.worst(sites, place) > 1.01 * worst && !self.is_flat_from(sites, place)).then_some(place)
    }

    /// The least share of the tets at a vertex.
    pub(super) fn worst_to(&self, sites: &Sites, vertex: VertexId) -> f64 {
        self.worst(sites, sites.near(vertex))
    }

    /// Whether the tets from `p` to all facets are positive.
    fn sees(&self, sites: &Sites, p: Point) -> bool {
        self.faces().all(|face| is_seen(sites, face, p))
    }

    /// Whether the volume of any tet from a point may be rounding alone; those on faces without area are
    /// ignored.
    pub(super) fn is_flat_from(&self, sites: &Sites, p: Point) -> bool {
        self.faces().any(|face| makes_flat(sites, face, p))
    }

    /// Makes the tets to `apex`, a new vertex or one of those around. With a new vertex, there is one tet for
    /// each facet of the shell, then one for each triangle of the base.
    pub(super) fn make(&self, tets: &mut Tets, apex: VertexId) -> Vec<TetId> {
        self.tets.iter().for_each(|&tet| tets.remove(tet));
        let base = self.base.iter().map(|&face| (HalfFacet::NONE, face));
        tets.cone(apex, self.shell.iter().copied().chain(base), &mut Vec::new())
    }
}

/// Whether the tet from a face to a point is positive.
pub(super) fn is_seen(sites: &Sites, [a, b, c]: [VertexId; 3], p: Point) -> bool {
    orient3d_of([sites.spot(a), sites.spot(b), sites.spot(c), Spot::Given(p)]) > 0
}

/// Whether the volume of the tet from a face to a point may be rounding alone, though the face has an area.
pub(super) fn makes_flat(sites: &Sites, face: [VertexId; 3], p: Point) -> bool {
    let [a, b, c] = face.map(|v| sites.near(v));
    is_flat([a, b, c, p]) && !is_needle([a, b, c])
}

/// Six times the volume of the tet from a face to p, divided by the cube of its longest edge.
fn share(sites: &Sites, face: [VertexId; 3], p: Point) -> f64 {
    let [a, b, c] = face.map(|v| sub(sites.near(v), p));
    let longest = [a, b, c, sub(a, b), sub(b, c), sub(c, a)].into_iter().map(norm).fold(0.0, f64::max);
    // Seen from p the face has the opposite orientation.
    -dot(cross(a, b), c) / longest.powi(3)
}
