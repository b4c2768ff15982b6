//! Places that are apart from each other.

use hashbrown::HashMap;

use crate::base::Point;
use crate::geometry::vector::distance;

/// Places in the cells of a grid.
pub(super) struct Spaced {
    /// The side of the cells.
    least: f64,
    cells: HashMap<[i64; 3], Vec<Point>>,
}

impl Spaced {
    /// No places, for distances of up to `least`.
    pub(super) fn new(least: f64) -> Self {
        Self { least, cells: HashMap::new() }
    }

    fn cell(&self, p: Point) -> [i64; 3] {
        p.map(|x| (x / self.least).floor() as i64)
    }

    /// Whether no place is nearer than `radius`, which is at most the least distance.
    pub(super) fn is_free(&self, p: Point, radius: f64) -> bool {
        let [i, j, k] = self.cell(p);
        let around = (0..27).map(|n| [i + n / 9 - 1, j + n / 3 % 3 - 1, k + n % 3 - 1]);
        let mut near = around.filter_map(|cell| self.cells.get(&cell)).flatten();
        near.all(|other| distance(*other, p) >= radius)
    }

    pub(super) fn insert(&mut self, p: Point) {
        self.cells.entry(self.cell(p)).or_default().push(p);
    }
}
