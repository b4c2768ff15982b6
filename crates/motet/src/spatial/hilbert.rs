//! The Hilbert curve through a box, by table: neighbours on the curve are neighbours in space.
//!
//! One level of the curve visits the eight octants in the order of a rotated Gray code; which rotation, or
//! turn, applies within an octant depends only on the turn outside and on the octant. A turn is an entry
//! corner and a direction, 24 in all (Hamilton 2006, *Compact Hilbert indices*, section 2). One table lookup
//! per level takes half the time of the bit loops.

use crate::base::Point;

/// Levels of the curve: there are `2^LEVELS` cells along each axis.
pub(crate) const LEVELS: u32 = 11;
/// Bits of a key.
pub(crate) const KEY_BITS: u32 = 3 * LEVELS;

/// For each turn and octant: the place of the octant on the curve, and the turn within it.
type Table = [[(u8, u8); 8]; 24];

/// Computes the keys of points in one box.
pub(crate) struct Curve {
    table: Table,
    corner: Point,
    cells_per_length: f64,
}

impl Curve {
    /// The curve through a cube at `corner` whose edge is `extent`; an extent outside the range of its
    /// inverse only coarsens the keys.
    pub(crate) fn new(corner: Point, extent: f64) -> Self {
        Self {
            table: table(),
            corner,
            cells_per_length: f64::from(1 << LEVELS) / extent.clamp(1e-300, 1e300),
        }
    }

    /// The position along the curve of the cell that contains `p`, in [`KEY_BITS`] bits.
    #[inline]
    pub(crate) fn key(&self, p: Point) -> u64 {
        let cell = |i: usize| {
            let cell = ((p[i] - self.corner[i]) * self.cells_per_length) as u32;
            cell.min((1 << LEVELS) - 1)
        };
        let (x, y, z) = (cell(0), cell(1), cell(2));
        let mut turn = 0;
        let mut key = 0;
        for level in (0..LEVELS).rev() {
            let octant = (x >> level & 1) | (y >> level & 1) << 1 | (z >> level & 1) << 2;
            let (place, within) = self.table[turn][octant as usize];
            key = key << 3 | u64::from(place);
            turn = usize::from(within);
        }
        key
    }
}

/// The smallest corner of the box around the points, and its longest side.
pub(crate) fn bounding_cube(points: impl Iterator<Item = Point>) -> (Point, f64) {
    let start = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    let (low, high) = points.fold(start, |(low, high), p| {
        (std::array::from_fn(|i| p[i].min(low[i])), std::array::from_fn(|i| p[i].max(high[i])))
    });
    (low, (0..3).map(|i| high[i] - low[i]).fold(0.0, f64::max))
}

/// The table of all turns; turn number `3 * entry + direction`.
fn table() -> Table {
    std::array::from_fn(|turn| {
        let (entry, direction) = ((turn / 3) as u8, (turn % 3) as u32);
        std::array::from_fn(|octant| {
            let place = gray_inverse(rotate(octant as u8 ^ entry, 3 - (direction + 1) % 3));
            let within_entry = entry ^ rotate(entry_of(place), direction + 1);
            let within_direction = (direction + direction_of(place) + 1) % 3;
            (place, 3 * within_entry + within_direction as u8)
        })
    })
}

/// Three bits rotated left.
fn rotate(bits: u8, by: u32) -> u8 {
    let by = by % 3;
    (bits << by | bits >> (3 - by)) & 7
}

fn gray(i: u8) -> u8 {
    i ^ i >> 1
}

fn gray_inverse(g: u8) -> u8 {
    g ^ g >> 1 ^ g >> 2
}

/// The corner by which the curve enters octant `place`.
fn entry_of(place: u8) -> u8 {
    if place == 0 { 0 } else { gray(2 * ((place - 1) / 2)) }
}

/// The axis along which the curve runs within octant `place`.
fn direction_of(place: u8) -> u32 {
    match place {
        0 => 0,
        even if even % 2 == 0 => u32::from(even - 1).trailing_ones() % 3,
        odd => u32::from(odd).trailing_ones() % 3,
    }
}

#[cfg(test)]
mod tests {
    use super::{Curve, LEVELS};

    #[test]
    fn cells_that_follow_each_other_share_a_face() {
        // The first 16^3 cells along the curve fill one corner cube: walk them in order.
        let curve = Curve::new([0.0; 3], f64::from(1 << LEVELS));
        let n = 16;
        let mut cells: Vec<(u64, [i32; 3])> = (0..n * n * n)
            .map(|i| [i % n, i / n % n, i / n / n])
            .map(|c| (curve.key(c.map(|v| f64::from(v) + 0.5)), c))
            .collect();
        cells.sort_unstable();
        assert!(cells.iter().enumerate().all(|(i, (key, _))| *key == i as u64));
        for pair in cells.windows(2) {
            let steps: i32 = (0..3).map(|i| (pair[0].1[i] - pair[1].1[i]).abs()).sum();
            assert_eq!(steps, 1, "{pair:?}");
        }
    }
}
