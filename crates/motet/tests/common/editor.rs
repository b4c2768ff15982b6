//! Random operations on a complex.

use motet::base::TetId;
use motet::geometry::tet::{EDGES, centroid};
use motet::kernel::{Change, Complex, Hold, Shell, Star};
use motet::ops::{
    Anywhere, EdgeRemoval, FaceRemoval, Insertion, Smoothing, collapse, split_crossed, split_edge, split_onto,
};

use super::Numbers;

/// One of each operation.
#[derive(Default)]
pub(crate) struct Editor {
    change: Change,
    edge_removal: EdgeRemoval,
    face_removal: FaceRemoval,
    smoothing: Smoothing,
    insertion: Insertion,
    star: Star,
    shells: [Shell; 2],
    inserted: Vec<TetId>,
}

impl Editor {
    /// Proposes a random operation, useful or not, as long as every tet is positive.
    pub(crate) fn propose(&mut self, complex: &Complex, numbers: &mut Numbers) -> bool {
        let alive: Vec<TetId> = complex.tets().collect();
        let tet = alive[numbers.below(alive.len())];
        let vertices = complex.vertices(tet);
        let edge = numbers.below(6);
        let [a, b] = EDGES[edge].map(|i| vertices[i]);
        let [c, d] = EDGES[5 - edge].map(|i| vertices[i]);
        let [first, second] = &mut self.shells;
        first.walk(complex, tet, a, b);
        second.walk(complex, tet, c, d);
        self.star.gather(complex, a);
        let [pa, pb] = [a, b].map(|v| complex.point(v));
        let middle = [0, 1, 2].map(|i| 0.5 * (pa[i] + pb[i]));
        let hold = match complex.line(a, b) {
            Some(_) => Hold::Edge,
            None if first.walls.is_empty() => Hold::Free,
            None => Hold::Surface,
        };
        let (change, star) = (&mut self.change, &self.star.tets);
        match numbers.below(8) {
            0 => self.edge_removal.propose(complex, tet, [a, b], 0.0, change),
            1 => self.face_removal.propose(complex, tet, edge % 4, 0.0, change),
            2 => collapse(complex, star, a, b, 0.0, change),
            3 => split_edge(complex, first, [a, b], (middle, hold), 0.0, change),
            4 => split_crossed(complex, [first, second], centroid(complex.corners(tet)), 0.0, change),
            5 => split_onto(complex, first, c, 0.0, change),
            6 => self.smoothing.propose(complex, star, a, [0.0, 0.5], &Anywhere, change),
            _ => self.insertion.propose(complex, &[tet], centroid(complex.corners(tet)), [0.0, 0.5], change),
        }
    }

    /// Makes a proposal if the kernel permits it; returns whether it did.
    pub(crate) fn make(&mut self, complex: &mut Complex) -> bool {
        match complex.check_against(&self.change, 0.0) {
            Ok(checked) => {
                complex.commit(checked, &mut self.inserted);
                true
            }
            Err(_) => false,
        }
    }
}
