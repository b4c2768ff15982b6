//! The rotations of vertices where facets of a wall meet at an angle.
//!
//! The mean gradient in two directions does not say how such a vertex rotates: the plane of the two is not
//! that of any facet, and what stretches the facets on one side more than those on the other tilts it. So the
//! mean gradient is taken in all three directions, and the rotation is its polar factor: the one nearest to
//! what all facets do. Where the wall is nearly flat it is that of two directions.

use std::ops::Range;

use crate::base::Point;
use crate::base::four::FourLanes;
use crate::motion::polar::{Quaternion, polar, quaternion};
use crate::motion::update::Padded;

/// The vertices of a wall where facets meet at an angle.
#[derive(Debug, Default)]
pub(super) struct Creases {
    /// In rising order of their vertices.
    list: Vec<Crease>,
    /// The vertices around each, and their shares of the gradient in the directions of the axes.
    around: Vec<(u32, Point)>,
}

#[derive(Clone, Copy, Debug)]
struct Crease {
    vertex: u32,
    /// The vertices around: where they begin in `around`, and where they end.
    around: [u32; 2],
    /// What the mean gradient makes of the three axes at first; a symmetric matrix.
    at_first: [Point; 3],
}

impl Creases {
    /// Appends a vertex, higher than all before.
    pub(super) fn push(
        &mut self,
        vertex: u32,
        at_first: [Point; 3],
        around: impl Iterator<Item = (u32, Point)>,
    ) {
        let begin = self.around.len() as u32;
        self.around.extend(around);
        self.list.push(Crease { vertex, around: [begin, self.around.len() as u32], at_first });
    }

    pub(super) fn shrink_to_fit(&mut self) {
        self.list.shrink_to_fit();
        self.around.shrink_to_fit();
    }

    /// The places in the list of those among `n` vertices from `first` on.
    fn among(&self, first: usize, n: usize) -> Range<usize> {
        let before = |end: usize| self.list.partition_point(|c| (c.vertex as usize) < end);
        before(first)..before(first + n)
    }

    /// Sets the rotations of those among consecutive vertices, beginning with `first`, that the wall does not
    /// mirror.
    #[inline(always)]
    pub(super) fn rotate<F: FourLanes>(
        &self,
        machine: F::Machine,
        displacement: &[Padded],
        first: usize,
        rotations: &mut [Quaternion],
    ) {
        let Range { start, end } = self.among(first, rotations.len());
        for begin in (start..end).step_by(4) {
            let four = &self.list[begin..end.min(begin + 4)];
            self.rotate_four::<F>(machine, displacement, four, first, rotations);
        }
    }

    /// Sets the rotations of up to four.
    #[inline(always)]
    fn rotate_four<F: FourLanes>(
        &self,
        machine: F::Machine,
        displacement: &[Padded],
        four: &[Crease],
        first: usize,
        rotations: &mut [Quaternion],
    ) {
        let zero = F::splat(machine, 0.0);
        // How the images of the three axes change, and what they are at first.
        let mut changes = [[[0.0; 4]; 3]; 3];
        let mut at_first = [[[0.0; 4]; 3]; 3];
        for (lane, crease) in four.iter().enumerate() {
            let own = displacement[crease.vertex as usize].load::<F>(machine);
            let mut images = [zero; 3];
            let [begin, end] = crease.around;
            for (vertex, shares) in &self.around[begin as usize..end as usize] {
                let change = displacement[*vertex as usize].load::<F>(machine) - own;
                for k in 0..3 {
                    images[k] = images[k] + change * F::splat(machine, shares[k]);
                }
            }
            for k in 0..3 {
                let image = images[k].stored();
                for j in 0..3 {
                    (changes[k][j][lane], at_first[k][j][lane]) = (image[j], crease.at_first[k][j]);
                }
            }
        }
        let mut moved = zero;
        let mut images = [[zero; 3]; 3];
        let mut axes = [[zero; 3]; 3];
        for k in 0..3 {
            for j in 0..3 {
                let change = F::load(machine, &changes[k][j]);
                images[k][j] = F::load(machine, &at_first[k][j]) + change;
                moved = moved + change.abs();
            }
            axes[k][k] = F::splat(machine, 1.0);
        }
        if moved.stored() == [0.0; 4] {
            return;
        }
        let (to, is_rotation) = polar(machine, images);
        let parts = quaternion(machine, axes, to, moved);
        let [w, x, y, z] = [parts[0].stored(), parts[1].stored(), parts[2].stored(), parts[3].stored()];
        let is_rotation = is_rotation.stored();
        for (lane, crease) in four.iter().enumerate() {
            if is_rotation[lane] > 0.0 {
                rotations[crease.vertex as usize - first] = [w[lane], x[lane], y[lane], z[lane]];
            }
        }
    }
}
