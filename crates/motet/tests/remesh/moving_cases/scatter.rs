//! Random points with a minimum distance, for meshes of ordinary quality.

use std::collections::HashMap;

use motet::base::Point;
use motet::geometry::vector::distance;

/// An endless stream of random numbers.
pub struct Numbers(pub u64);

impl Numbers {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ z >> 31
    }

    /// A number from 0 to 1.
    pub fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// The number of failed throws in a row after which an area counts as full.
const FULL: usize = 20_000;

/// Points, with a grid to find neighbours.
pub struct Scatter {
    pub points: Vec<Point>,
    pub numbers: Numbers,
    cell: f64,
    places: HashMap<[i64; 3], Vec<usize>>,
}

impl Scatter {
    /// An empty set; distances requested later must not exceed `largest`.
    pub fn new(seed: u64, largest: f64) -> Self {
        Self { points: Vec::new(), numbers: Numbers(seed), cell: largest, places: HashMap::new() }
    }

    fn place(&self, p: Point) -> [i64; 3] {
        p.map(|x| (x / self.cell).floor() as i64)
    }

    pub fn push(&mut self, p: Point) {
        self.places.entry(self.place(p)).or_default().push(self.points.len());
        self.points.push(p);
    }

    /// Whether no point is nearer than `least`.
    fn is_free(&self, p: Point, least: f64) -> bool {
        let [i, j, k] = self.place(p);
        let cells = (0..27).map(|n| [i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1]);
        let near = cells.filter_map(|cell| self.places.get(&cell)).flatten();
        near.map(|&v| distance(self.points[v], p)).all(|d| d >= least)
    }

    /// Throws points, `least(p)` apart, until the area is full; `None` is a miss.
    pub fn fill(&mut self, least: impl Fn(Point) -> f64, throw: impl Fn(&mut Numbers) -> Option<Point>) {
        let mut n_missed = 0;
        while n_missed < FULL {
            match throw(&mut self.numbers) {
                Some(p) if self.is_free(p, least(p)) => {
                    self.push(p);
                    n_missed = 0;
                }
                _ => n_missed += 1,
            }
        }
    }
}
