//! Smoothing: a vertex is moved to where the worst of its tets is best.
//!
//! The worst quality is the minimum of many functions of the vertex's position. If several are nearly
//! smallest, the direction in which all of them rise fastest is the shortest vector in the convex hull of
//! their gradients (Freitag and Ollivier-Gooch 1997, *Tetrahedral mesh improvement using swapping and
//! smoothing*); the step is halved until the worst rises.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::vector::{add, dot, norm, scale, sub};
use crate::kernel::{Change, Complex, Fill, Side, VertexChange};

/// Qualities that exceed the worst by no more than this count as nearly smallest.
const NEARLY: f64 = 0.03;
/// The largest number of directions tried.
const MAX_STEPS: usize = 8;
/// The largest number of times a step is halved.
const MAX_HALVINGS: usize = 5;
/// A step that raises the worst quality by less than this is the last.
const SMALLEST_GAIN: f64 = 1e-3;
/// Step of the difference quotients for gradients, relative to the size of the star.
const DIFFERENCE: f64 = 1e-6;

/// Where a vertex may move.
pub trait Track {
    /// The position on the track for a vertex that is to move to `point`; `None` if there is none.
    fn draw(&self, point: Point) -> Option<Point>;

    /// The component of a direction along the track.
    fn along(&self, direction: Point) -> Point;
}

/// A track without constraint.
#[derive(Clone, Copy, Debug)]
pub struct Anywhere;

impl Track for Anywhere {
    #[inline(always)]
    fn draw(&self, point: Point) -> Option<Point> {
        Some(point)
    }

    #[inline(always)]
    fn along(&self, direction: Point) -> Point {
        direction
    }
}

/// Work arrays, reused from call to call.
#[derive(Clone, Debug, Default)]
pub struct Smoothing {
    tets: Vec<Corner>,
    /// The qualities of the tets at the last position tried. A third of all measurements in repairs were of
    /// tets that had been measured just before.
    tried: Vec<f64>,
    gradients: Vec<Point>,
}

/// A tet of the star: its points, the local number of the vertex, and its quality.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) points: [Point; 4],
    pub(super) place: usize,
    pub(super) quality: f64,
    /// The existing tet that this is, with `None`; or, for a new tet whose other facets lie inside, an
    /// existing tet and which of its facets is the new tet's facet 3.
    pub(super) of: (TetId, Option<usize>),
}

impl Smoothing {
    /// Proposes a better position on its track for a vertex with the tets `star`: one where the worst quality
    /// is `enough`, or as high as possible. Returns `false` if none is better than `bar`.
    pub fn propose(
        &mut self,
        complex: &Complex,
        star: &[TetId],
        vertex: VertexId,
        [bar, enough]: [f64; 2],
        track: &impl Track,
        change: &mut Change,
    ) -> bool {
        let corner = |&tet: &TetId| Corner {
            points: complex.corners(tet),
            place: complex.place(tet, vertex),
            quality: complex.quality(tet),
            of: (tet, None),
        };
        let point = self.best_place(complex, star.iter().map(corner), complex.point(vertex), enough, track);
        change.clear();
        change.vertex = VertexChange::Move(vertex, point);
        change.cavity.extend_from_slice(star);
        change.fill.extend(star.iter().zip(self.qualities()).map(|(&tet, quality)| Fill {
            vertices: complex.vertices(tet),
            region: complex.region(tet),
            quality,
        }));
        change.worst() > bar
    }

    /// The best position found for a common vertex of some tets that is at `start`.
    pub(super) fn best_place(
        &mut self,
        complex: &Complex,
        star: impl Iterator<Item = Corner>,
        start: Point,
        enough: f64,
        track: &impl Track,
    ) -> Point {
        self.tets.clear();
        self.tets.extend(star);
        let lengths = self.tets.iter().map(|tet| norm(sub(tet.points[(tet.place + 1) % 4], start)));
        let size = lengths.fold(0.0, f64::max);
        let mut place = start;
        let mut worst = self.worst();
        let mut gain = 0.05;
        for _ in 0..MAX_STEPS {
            if worst >= enough {
                break;
            }
            let direction = self.direction(complex, place, worst, size, track);
            let slope = dot(direction, direction);
            // Along the direction, the worst quality rises at the rate of its squared length if no other tet
            // interferes.
            if slope * size * size <= 1e-6 {
                break;
            }
            let mut length = (2.0 * gain / slope).min(0.5 * size / slope.sqrt());
            let mut found = None;
            for _ in 0..=MAX_HALVINGS {
                if let Some(trial) = track.draw(add(place, scale(direction, length))) {
                    let quality = self.worst_at(complex, trial, worst);
                    if quality > worst {
                        found = Some((trial, quality));
                        break;
                    }
                }
                length *= 0.5;
            }
            let Some((trial, quality)) = found else { break };
            gain = quality - worst;
            place = trial;
            self.move_to(place);
            worst = quality;
            if gain < SMALLEST_GAIN {
                break;
            }
        }
        place
    }

    /// The qualities of the tets at the position that was found, in their order.
    pub(super) fn qualities(&self) -> impl Iterator<Item = f64> + '_ {
        self.tets.iter().map(|tet| tet.quality)
    }

    fn worst(&self) -> f64 {
        self.qualities().fold(f64::INFINITY, f64::min)
    }

    /// The worst quality with the vertex at `place`; any value up to `bar` if it is not better than `bar`.
    fn worst_at(&mut self, complex: &Complex, place: Point, bar: f64) -> f64 {
        let mut worst = f64::INFINITY;
        self.tried.clear();
        for tet in &self.tets {
            let quality = tet.at(complex, place);
            self.tried.push(quality);
            worst = worst.min(quality);
            if worst <= bar {
                break;
            }
        }
        worst
    }

    /// Moves the vertex to `place`, the position tried last, in all tets.
    fn move_to(&mut self, place: Point) {
        for (tet, &quality) in self.tets.iter_mut().zip(&self.tried) {
            tet.points[tet.place] = place;
            tet.quality = quality;
        }
    }

    /// The shortest vector in the convex hull of the gradients of the nearly worst tets.
    fn direction(
        &mut self,
        complex: &Complex,
        place: Point,
        worst: f64,
        size: f64,
        track: &impl Track,
    ) -> Point {
        self.gradients.clear();
        let step = DIFFERENCE * size;
        for tet in self.tets.iter().filter(|t| t.quality <= worst + NEARLY) {
            let mut gradient = [0.0; 3];
            for axis in 0..3 {
                let mut beside = place;
                beside[axis] += step;
                gradient[axis] = (tet.at(complex, beside) - tet.quality) / step;
            }
            self.gradients.push(track.along(gradient));
        }
        shortest_in_hull(&self.gradients)
    }
}

impl Corner {
    fn at(&self, complex: &Complex, place: Point) -> f64 {
        let mut points = self.points;
        points[self.place] = place;
        complex.judge(points, |i| match self.of {
            (tet, None) => complex.side(tet, i),
            (tet, Some(facet)) if i == 3 => complex.side(tet, facet),
            _ => Side::Inside,
        })
    }
}

/// An approximation of the shortest vector in the convex hull of some vectors: starts from the shortest one
/// and moves repeatedly towards the one that lies farthest on the other side (Gilbert 1966, *An iterative
/// procedure for computing the minimum of a quadratic form on a convex set*).
fn shortest_in_hull(vectors: &[Point]) -> Point {
    let Some(mut shortest) = vectors.iter().copied().min_by(|a, b| dot(*a, *a).total_cmp(&dot(*b, *b)))
    else {
        return [0.0; 3];
    };
    for _ in 0..30 {
        let Some(farthest) =
            vectors.iter().copied().min_by(|a, b| dot(*a, shortest).total_cmp(&dot(*b, shortest)))
        else {
            break;
        };
        let way = sub(farthest, shortest);
        let (ahead, whole) = (-dot(shortest, way), dot(way, way));
        if ahead <= 1e-9 * whole {
            break;
        }
        shortest = add(shortest, scale(way, (ahead / whole).min(1.0)));
    }
    shortest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_vector_of_a_hull_is_found() {
        let near = |a: Point, b: Point| norm(sub(a, b)) < 1e-3;
        assert!(near(shortest_in_hull(&[[1.0, 1.0, 0.0], [1.0, -1.0, 0.0]]), [1.0, 0.0, 0.0]));
        assert!(near(shortest_in_hull(&[[2.0, 0.0, 0.0]]), [2.0, 0.0, 0.0]));
        let around = [[1.0, 0.0, 0.0], [-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0]];
        assert!(norm(shortest_in_hull(&around)) < 0.05);
        assert_eq!(shortest_in_hull(&[]), [0.0; 3]);
    }
}
