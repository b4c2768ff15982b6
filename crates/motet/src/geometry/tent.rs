//! The tent over a triangle: the tet on it with the same dihedral angle at its three edges.
//!
//! A tet on the triangle whose dihedral angles there are all larger than that of a tent contains the tent. So
//! where the tent contains something that no tet may contain, no tet on the triangle has a smallest dihedral
//! angle above that of the tent.

use crate::base::Point;
use crate::geometry::vector::{cross, dot, norm, scale, sub};

/// A triangle prepared for finding the steepest tent over it that stays clear of something.
#[derive(Clone, Copy, Debug)]
pub struct Tent {
    corner: [Point; 3],
    /// The unit normal on the side of the tent.
    up: Point,
    /// For each edge, numbered like the opposite corner, the unit normal within the plane, pointing inward.
    inward: [Point; 3],
}

/// A point by its height above the triangle's plane, and its inward distances, parallel to the plane, from
/// the edges' lines.
#[derive(Clone, Copy, Debug)]
struct Place {
    height: f64,
    inside: [f64; 3],
}

impl Place {
    /// `(1 - s) self + s other`.
    fn toward(self, other: Self, s: f64) -> Self {
        let mix = |a: f64, b: f64| (1.0 - s) * a + s * b;
        Self {
            height: mix(self.height, other.height),
            inside: std::array::from_fn(|i| mix(self.inside[i], other.inside[i])),
        }
    }

    /// The tangent of the angle of the tent on which the point lies; `None` where it lies on none.
    fn slope(self) -> Option<f64> {
        let least = self.inside.into_iter().fold(f64::INFINITY, f64::min);
        (self.height > 0.0 && least > 0.0).then(|| self.height / least)
    }
}

impl Tent {
    /// The tents over a triangle that is counter-clockwise seen from their side; `None` where it has no area.
    pub fn over(corner: [Point; 3]) -> Option<Self> {
        let [a, b, c] = corner;
        let normal = cross(sub(b, a), sub(c, a));
        let unit = |v: Point| (norm(v) > 0.0).then(|| scale(v, 1.0 / norm(v)));
        let up = unit(normal)?;
        let inward = [sub(c, b), sub(a, c), sub(b, a)].map(|along| unit(cross(up, along)));
        let [Some(u), Some(v), Some(w)] = inward else { return None };
        Some(Self { corner, up, inward: [u, v, w] })
    }

    /// The angle, in radians, of the steepest tent that has nothing of `triangle` inside; `None` where no
    /// tent has. Corners that coincide with corners of the tent's own triangle must be equal to the bit.
    ///
    /// A point lies on the tent whose tangent is the largest of `height / inside`. Height and distances are
    /// linear, so the least value of that maximum over the triangle is at a corner, at a point of an edge
    /// where two distances are equal, or where all three are.
    pub fn angle_below(&self, triangle: [Point; 3]) -> Option<f64> {
        let places = triangle.map(|p| self.place(p));
        let slopes = places.into_iter().filter_map(Place::slope);
        let on_edges = [(0, 1), (1, 2), (2, 0)].into_iter().flat_map(|(i, j)| {
            let (p, q) = (places[i], places[j]);
            [(0, 1), (1, 2), (2, 0)].into_iter().filter_map(move |(k, l)| {
                let (at_p, at_q) = (p.inside[k] - p.inside[l], q.inside[k] - q.inside[l]);
                let s = at_p / (at_p - at_q);
                (0.0 < s && s < 1.0).then(|| p.toward(q, s).slope()).flatten()
            })
        });
        slopes.chain(on_edges).chain(above_incentre(places)).reduce(f64::min).map(f64::atan)
    }

    fn place(&self, p: Point) -> Place {
        if let Some(k) = self.corner.iter().position(|corner| *corner == p) {
            let mut inside = [0.0; 3];
            inside[k] = dot(self.inward[k], sub(p, self.corner[(k + 1) % 3]));
            return Place { height: 0.0, inside };
        }
        let from = [1, 2, 0].map(|k| sub(p, self.corner[k]));
        Place { height: dot(self.up, from[2]), inside: std::array::from_fn(|k| dot(self.inward[k], from[k])) }
    }
}

/// The slope at which the line through the incentre, whose points are equally far from all edges, meets a
/// triangle.
fn above_incentre([p, q, r]: [Place; 3]) -> Option<f64> {
    let differences = [p, q, r].map(|x| [x.inside[0] - x.inside[1], x.inside[1] - x.inside[2]]);
    let det = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let [a, b, c] = differences;
    let weights = [det(b, c), det(c, a), det(a, b)];
    let sum: f64 = weights.iter().sum();
    if sum == 0.0 {
        return None;
    }
    let [u, v, w] = weights.map(|weight| weight / sum);
    if u < 0.0 || v < 0.0 || w < 0.0 {
        return None;
    }
    let mix = |of: fn(&Place) -> f64| u * of(&p) + v * of(&q) + w * of(&r);
    let inside = [mix(|x| x.inside[0]), mix(|x| x.inside[1]), mix(|x| x.inside[2])];
    Place { height: mix(|x| x.height), inside }.slope()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::quality::dihedral;
    use crate::geometry::triangle::at;

    const BASE: [Point; 3] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.3, 1.5, 0.0]];

    fn tent() -> Tent {
        Tent::over(BASE).expect("an area")
    }

    /// A fixed sequence of pseudorandom numbers in [0, 1).
    fn chance() -> impl FnMut() -> f64 {
        let mut state = 1u64;
        move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    #[test]
    fn the_tent_of_a_point_is_the_least_angle_of_a_tet_that_has_it_as_its_top() {
        let [[a, b, c], top] = [BASE, [[0.7, 0.5, 0.2]; 3]];
        let angle = tent().angle_below(top).expect("above the base");
        // The dihedral angles at the edges of the first three vertices.
        let angles = dihedral::angles([a, b, c, top[0]]);
        let at_base = crate::geometry::tet::EDGES.iter().zip(angles).filter(|(e, _)| !e.contains(&3));
        let largest = at_base.map(|(_, angle)| angle).fold(0.0, f64::max);
        assert!((angle - largest).abs() < 1e-12, "{angle} {largest}");
    }

    #[test]
    fn no_point_of_a_triangle_lies_lower_than_is_said_and_one_lies_there() {
        let (mut chance, tent) = (chance(), tent());
        let (mut hits, mut misses) = (0, 0);
        for _ in 0..300 {
            let triangle =
                std::array::from_fn(|_| [4.0 * chance() - 1.0, 4.0 * chance() - 1.5, 1.2 * chance() + 1e-3]);
            let said = tent.angle_below(triangle);
            let mut least = f64::INFINITY;
            for i in 0..=200 {
                for j in 0..=200 - i {
                    let (u, v) = (f64::from(i) / 200.0, f64::from(j) / 200.0);
                    let slope = tent.place(at(triangle, [u, v, 1.0 - u - v])).slope();
                    least = slope.map_or(least, |slope| least.min(slope.atan()));
                }
            }
            match said {
                Some(angle) => {
                    assert!(angle <= least + 1e-12, "{angle} {least}");
                    assert!(least < angle + 0.05, "{angle} {least}");
                    hits += 1;
                }
                None => {
                    assert_eq!(least, f64::INFINITY);
                    misses += 1;
                }
            }
        }
        assert!(hits > 100 && misses > 20, "{hits} {misses}");
    }

    #[test]
    fn a_wall_at_an_edge_leaves_the_angle_to_it() {
        let leaning = [BASE[0], BASE[1], [0.8, 0.8, 0.4]];
        let angle = tent().angle_below(leaning).expect("above the base");
        assert!((angle - 0.5f64.atan()).abs() < 1e-12, "{angle}");
        let beside = [BASE[1], BASE[0], [0.8, -0.8, 0.4]];
        assert_eq!(tent().angle_below(beside), None);
        assert_eq!(tent().angle_below(BASE), None);
        assert!(Tent::over([BASE[0], BASE[1], BASE[1]]).is_none());
    }
}
