//! What each boundary vertex does: stay, follow a motion, or move by a displacement of its own.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{norm, sub};
use crate::motion::Prescribed;

/// Two displacements are equal where they differ by less than this fraction of their size and that of the
/// coordinates.
const ROUNDING: f64 = 1e-12;

/// The requested motion of the boundary of a mesh, at any fraction of it.
///
/// Interior vertices that are moved too, such as those of an interface, count as boundary. A vertex obeys the
/// first order given for it; vertices without an order stay where they are.
#[derive(Clone, Debug)]
pub struct BoundaryMotion {
    /// All boundary vertices, in rising order.
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

/// How many vertices an order reached.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Taken {
    /// Vertices that now obey it.
    pub obeying: usize,
    /// Vertices that obey an earlier order.
    pub refused: usize,
    /// Vertices that do not belong to this motion: they follow the others.
    pub unknown: usize,
}

impl BoundaryMotion {
    /// A motion without orders: nothing moves. `boundary` holds each boundary vertex once, in rising order.
    pub fn still(boundary: &[VertexId]) -> Self {
        debug_assert!(boundary.is_sorted());
        Self { vertices: boundary.to_vec(), orders: vec![Order::None; boundary.len()], motions: Vec::new() }
    }

    /// Makes `vertices` stay, unless they have an earlier order; later orders for them are refused.
    pub fn hold(&mut self, vertices: &[VertexId]) -> Taken {
        self.set_orders(vertices.iter().map(|&v| (v, Order::Stay)))
    }

    /// Refuses a motion of a patch if some of its vertices obey an earlier order, other than to stay, that
    /// takes them elsewhere.
    /// `points` are those of the undeformed mesh.
    ///
    /// # Errors
    /// When there are such vertices; reports how many, and where the first is.
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
            "patch {patch} and an earlier patch share {n} vertices but move them differently"
        ))
        .at(format!("vertex {first} at ({x:.6}, {y:.6}, {z:.6})"))
        .remedy(
            "let one patch follow the other (`--slide`) or stay where they meet (`--fixed`), move both alike, \
             or give each vertex its own displacement (`--displacement ARRAY`)",
        ))
    }

    /// Those of `vertices` that obey an earlier order, other than to stay, that takes them elsewhere than
    /// `motion` would, half-way or at the end, by more than rounding.
    fn contradicted(&self, points: &[Point], vertices: &[VertexId], motion: &Prescribed) -> Vec<VertexId> {
        let differs = |i: usize, v: VertexId| {
            let place = points[v.index()];
            [0.5, 1.0].into_iter().any(|fraction| {
                let [a, b] = [self.displacement(i, place, fraction), motion.displacement(place, fraction)];
                norm(sub(a, b)) > ROUNDING * (norm(a) + norm(b) + norm(place))
            })
        };
        let has_order = |i: usize| matches!(self.orders[i], Order::Go(_) | Order::Follow(_));
        let contradicted =
            |v: &VertexId| self.vertices.binary_search(v).is_ok_and(|i| has_order(i) && differs(i, *v));
        vertices.iter().copied().filter(contradicted).collect()
    }

    /// Makes `vertices` follow `motion`, unless they have an earlier order.
    ///
    /// # Errors
    /// The errors of [`Prescribed::check`].
    pub fn follow(&mut self, vertices: &[VertexId], motion: Prescribed) -> Result<Taken> {
        motion.check()?;
        self.motions.push(motion);
        let number = self.motions.len() - 1;
        Ok(self.set_orders(vertices.iter().map(|&v| (v, Order::Follow(number)))))
    }

    /// Gives each of these vertices its own displacement, unless it has an earlier order.
    pub fn go(&mut self, displacements: &[(VertexId, Point)]) -> Taken {
        self.set_orders(displacements.iter().map(|&(v, d)| (v, Order::Go(d))))
    }

    /// All vertices of this motion, in rising order.
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    /// The vertices with an order other than to stay, in rising order.
    pub fn ordered_to_move(&self) -> Vec<VertexId> {
        let all = self.vertices.iter().zip(&self.orders);
        all.filter(|(_, o)| matches!(o, Order::Go(_) | Order::Follow(_))).map(|(&v, _)| v).collect()
    }

    /// The vertices that are displaced half-way or at the end of the motion, in rising order.
    pub fn moving(&self, points: &[Point]) -> Vec<VertexId> {
        let half = self.displacements(points, 0.5);
        let whole = self.displacements(points, 1.0);
        let all = self.vertices.iter().zip(half.iter().zip(&whole));
        all.filter(|(_, (half, whole))| **half != [0.0; 3] || **whole != [0.0; 3]).map(|(&v, _)| v).collect()
    }

    /// The displacement of each of [`Self::vertices()`], in their order, at `fraction` of the motion;
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

    fn set_orders(&mut self, orders: impl Iterator<Item = (VertexId, Order)>) -> Taken {
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
        assert_eq!(motion.ordered_to_move(), [4, 7].map(VertexId));
        let all = [1, 3, 4, 7].map(VertexId);
        // Vertex 3 stays, which is no contradiction; vertex 4 is shifted in the same way.
        let likewise = Prescribed::Shift([2.0, 1e-15, 0.0]);
        assert_eq!(motion.contradicted(&[[0.0; 3]; 8], &all, &likewise), [VertexId(7)]);
        assert_eq!(
            motion.contradicted(&[[0.0; 3]; 8], &all, &Prescribed::Shift([0.0; 3])),
            [4, 7].map(VertexId)
        );
        motion.go(&[(VertexId(1), [0.0; 3])]);
        assert_eq!(motion.ordered_to_move(), [1, 4, 7].map(VertexId));
        assert_eq!(motion.moving(&[[0.0; 3]; 8]), [4, 7].map(VertexId));
    }
}
