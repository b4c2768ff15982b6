//! What every boundary vertex is told to do: stay, follow a motion, or go where a file says.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{norm, sub};
use crate::motion::Prescribed;

/// Two displacements are one where they differ by less than this part of their size and that of the coordinates.
const ROUNDING: f64 = 1e-12;

/// The asked motion of the boundary of a mesh, at any fraction of it. Vertices
/// inside that are moved, too, such as those of an interface, count as boundary.
///
/// A vertex obeys the first that is told about it; vertices that nothing is told
/// about stay where they are.
#[derive(Clone, Debug)]
pub struct BoundaryMotion {
    /// Every boundary vertex, rising.
    vertices: Vec<VertexId>,
    orders: Vec<Order>,
    motions: Vec<Prescribed>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Order {
    None,
    Stay,
    Go(Point),
    Follow(usize),
}

/// How an order was taken up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taken {
    /// Vertices that now obey it.
    pub obeying: usize,
    /// Vertices that obey an order given before.
    pub refused: usize,
    /// Vertices that this is not about: they follow the others.
    pub unknown: usize,
}

impl BoundaryMotion {
    /// Nothing moves: `boundary` holds each boundary vertex once, rising.
    pub fn still(boundary: &[VertexId]) -> Self {
        debug_assert!(boundary.is_sorted());
        Self { vertices: boundary.to_vec(), orders: vec![Order::None; boundary.len()], motions: Vec::new() }
    }

    /// `vertices` stay, whatever is told about them later.
    pub fn hold(&mut self, vertices: &[VertexId]) -> Taken {
        self.give(vertices.iter().map(|&v| (v, Order::Stay)))
    }

    /// Refuses a motion of a patch some vertices of which obey an order given before, other than to stay, that takes them elsewhere.
    /// `points` are those of the undeformed mesh.
    ///
    /// # Errors
    /// With how many vertices that are, and where the first is.
    pub fn check_alike(
        &self,
        points: &[Point],
        patch: &str,
        vertices: &[VertexId],
        motion: &Prescribed,
    ) -> Result<()> {
        let contradicted = self.contradicted(points, vertices, motion);
        let Some(&first) = contradicted.first() else { return Ok(()) };
        let [x, y, z] = points[first.index()];
        let n = contradicted.len();
        Err(Error::options(format!(
            "patch {patch} and a patch moved before it share {n} vertices, and move them to different places"
        ))
        .at(format!("vertex {first} at ({x:.6}, {y:.6}, {z:.6})"))
        .remedy(
            "let one patch follow the other (`--slide`) or stay where they meet (`--fixed`), move both alike, \
             or give each vertex its own displacement (`--displacement ARRAY`)",
        ))
    }

    /// Those of `vertices` that obey an order given before, other than to stay, which takes them elsewhere than `motion`
    /// would, half of the way or all of it: by more than rounding.
    fn contradicted(&self, points: &[Point], vertices: &[VertexId], motion: &Prescribed) -> Vec<VertexId> {
        let differs = |i: usize, v: VertexId| {
            let place = points[v.index()];
            [0.5, 1.0].into_iter().any(|fraction| {
                let [a, b] = [self.displacement(i, place, fraction), motion.displacement(place, fraction)];
                norm(sub(a, b)) > ROUNDING * (norm(a) + norm(b) + norm(place))
            })
        };
        let is_told = |i: usize| matches!(self.orders[i], Order::Go(_) | Order::Follow(_));
        let contradicted =
            |v: &VertexId| self.vertices.binary_search(v).is_ok_and(|i| is_told(i) && differs(i, *v));
        vertices.iter().copied().filter(contradicted).collect()
    }

    /// `vertices` follow `motion`.
    ///
    /// # Errors
    /// As [`Prescribed::check`].
    pub fn follow(&mut self, vertices: &[VertexId], motion: Prescribed) -> Result<Taken> {
        motion.check()?;
        self.motions.push(motion);
        let number = self.motions.len() - 1;
        Ok(self.give(vertices.iter().map(|&v| (v, Order::Follow(number)))))
    }

    /// Each of these vertices goes by its own displacement.
    pub fn go(&mut self, displacements: &[(VertexId, Point)]) -> Taken {
        self.give(displacements.iter().map(|&(v, d)| (v, Order::Go(d))))
    }

    /// Every vertex that this is about, rising.
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    /// The vertices that something is told about, other than to stay; rising.
    pub fn told(&self) -> Vec<VertexId> {
        let all = self.vertices.iter().zip(&self.orders);
        all.filter(|(_, o)| matches!(o, Order::Go(_) | Order::Follow(_))).map(|(&v, _)| v).collect()
    }

    /// The vertices that the whole motion leaves elsewhere, or that a turn goes through; rising.
    pub fn moving(&self, points: &[Point]) -> Vec<VertexId> {
        let half = self.displacements(points, 0.5);
        let whole = self.displacements(points, 1.0);
        let all = self.vertices.iter().zip(half.iter().zip(&whole));
        all.filter(|(_, (half, whole))| **half != [0.0; 3] || **whole != [0.0; 3]).map(|(&v, _)| v).collect()
    }

    /// The displacement of each boundary vertex, in their order, at `fraction` of the motion;
    /// `points` are those of the undeformed mesh.
    pub fn displacements(&self, points: &[Point], fraction: f64) -> Vec<Point> {
        let one = |(i, vertex): (usize, &VertexId)| self.displacement(i, points[vertex.index()], fraction);
        self.vertices.iter().enumerate().map(one).collect()
    }

    fn displacement(&self, i: usize, place: Point, fraction: f64) -> Point {
        match &self.orders[i] {
            Order::None | Order::Stay => [0.0; 3],
            Order::Go(d) => d.map(|x| x * fraction),
            Order::Follow(motion) => self.motions[*motion].displacement(place, fraction),
        }
    }

    fn give(&mut self, orders: impl Iterator<Item = (VertexId, Order)>) -> Taken {
        let mut taken = Taken::default();
        for (vertex, order) in orders {
            match self.vertices.binary_search(&vertex) {
                Err(_) => taken.unknown += 1,
                Ok(i) if self.orders[i] == Order::None => {
                    self.orders[i] = order;
                    taken.obeying += 1;
                }
                Ok(_) => taken.refused += 1,
            }
        }
        taken
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_order_holds_and_the_untold_stay() {
        let boundary = [1, 3, 4, 7].map(VertexId);
        let mut motion = BoundaryMotion::still(&boundary);
        assert_eq!(motion.hold(&[VertexId(3)]), Taken { obeying: 1, refused: 0, unknown: 0 });
        let shift = Prescribed::Shift([2.0, 0.0, 0.0]);
        let taken = motion.follow(&[2, 3, 4].map(VertexId), shift).unwrap();
        assert_eq!(taken, Taken { obeying: 1, refused: 1, unknown: 1 });
        motion.go(&[(VertexId(4), [9.0; 3]), (VertexId(7), [0.0, 4.0, 0.0])]);
        let half = motion.displacements(&[[0.0; 3]; 8], 0.5);
        assert_eq!(half, [[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0]]);
        assert_eq!(motion.told(), [4, 7].map(VertexId));
        let all = [1, 3, 4, 7].map(VertexId);
        // Vertex 3 stays, which is no contradiction; 4 is shifted likewise.
        let likewise = Prescribed::Shift([2.0, 1e-15, 0.0]);
        assert_eq!(motion.contradicted(&[[0.0; 3]; 8], &all, &likewise), [VertexId(7)]);
        assert_eq!(
            motion.contradicted(&[[0.0; 3]; 8], &all, &Prescribed::Shift([0.0; 3])),
            [4, 7].map(VertexId)
        );
        motion.go(&[(VertexId(1), [0.0; 3])]);
        assert_eq!(motion.told(), [1, 4, 7].map(VertexId));
        assert_eq!(motion.moving(&[[0.0; 3]; 8]), [4, 7].map(VertexId));
    }
}
