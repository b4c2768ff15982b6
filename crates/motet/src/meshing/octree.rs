//! An octree of cubes divided where they are too large, with neighbours differing by one level at most.

use crate::base::{Error, Point, Result, Threads};

/// Bits per coordinate of a key. Cubes use all but the highest, so that their far corners have keys as well.
const BITS: u32 = 21;
const MASK: u64 = (1 << BITS) - 1;

/// The largest number of cubes: an undivided cube gives about two points.
const MAX_CUBES: f64 = 2.5e7;

/// A cube of the tree, by its level and its position among the cubes of that level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Cube {
    level: u32,
    key: u64,
}

/// The layout of the cubes: those of level 0 stand side by side, each level halves them.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// The lowest corner in units of the side of level 0; these are integers.
    first: Point,
    side: f64,
    counts: [u64; 3],
    /// The deepest level for which keys suffice.
    depth: u32,
}

/// The divided cubes of each level, in ascending order.
#[derive(Clone, Debug)]
pub(super) struct Octree {
    pub(super) grid: Grid,
    divided: Vec<Vec<u64>>,
}

fn key([x, y, z]: [u64; 3]) -> u64 {
    x << (2 * BITS) | y << BITS | z
}

fn place(key: u64) -> [u64; 3] {
    [key >> (2 * BITS), key >> BITS & MASK, key & MASK]
}

fn too_many(side: f64) -> Error {
    Error::input(format!(
        "these sizes require more than {:.0e} points inside; sizes of {side} or less alone do",
        2.0 * MAX_CUBES
    ))
    .remedy("request larger sizes")
}

impl Grid {
    /// Lays out cubes of about the given side over a box.
    ///
    /// # Errors
    /// When there would be too many.
    pub(super) fn new([low, high]: [Point; 2], side: f64) -> Result<Self> {
        // Rounded to single precision, so that all positions are exact: points in one plane are then exactly
        // coplanar.
        let side = f64::from(side as f32);
        let first = low.map(|x| (x / side).floor());
        let counts = [0, 1, 2].map(|i| (high[i] / side).floor() - first[i] + 1.0);
        let most = counts.iter().fold(0.0, |a: f64, b| a.max(*b));
        let is_one = side > 0.0 && side.is_finite() && most.is_finite();
        if !is_one || counts.iter().product::<f64>() > MAX_CUBES || most > f64::from(1 << (BITS - 1)) {
            return Err(too_many(side));
        }
        let counts = counts.map(|n| n as u64);
        let depth = (MASK / 2).checked_div(counts.into_iter().max().unwrap_or(1)).map_or(0, u64::ilog2);
        Ok(Self { first, side, counts, depth })
    }

    pub(super) fn side(&self, level: u32) -> f64 {
        self.side / (1u64 << level) as f64
    }

    /// The point that lies `sides` sides of a level from the lowest corner.
    fn at(&self, level: u32, sides: [f64; 3]) -> Point {
        let side = self.side(level);
        let scale = (1u64 << level) as f64;
        [0, 1, 2].map(|i| (self.first[i] * scale + sides[i]) * side)
    }

    /// The lowest and the highest corner of a cube.
    pub(super) fn bounds(&self, cube: Cube) -> [Point; 2] {
        [0.0, 1.0].map(|end| self.at(cube.level, place(cube.key).map(|x| x as f64 + end)))
    }

    pub(super) fn middle(&self, cube: Cube) -> Point {
        self.at(cube.level, place(cube.key).map(|x| x as f64 + 0.5))
    }
}

impl Octree {
    /// Divides cubes as long as `is_to_be_divided` holds, then those that are too large for their neighbours.
    ///
    /// # Errors
    /// When there would be too many cubes, or they would be too small for keys.
    pub(super) fn new(
        grid: Grid,
        is_to_be_divided: impl Fn(&Grid, Cube) -> bool + Sync + Send,
        threads: &Threads,
    ) -> Result<Self> {
        let [nx, ny, nz] = grid.counts;
        let of_columns = (0..nx).flat_map(|x| (0..ny).map(move |y| (x, y)));
        let mut cubes: Vec<u64> =
            of_columns.flat_map(|(x, y)| (0..nz).map(move |z| key([x, y, z]))).collect();
        let (mut divided, mut n_cubes) = (Vec::new(), cubes.len());
        for level in 0.. {
            let is_requested =
                threads.map(cubes.len(), |i| is_to_be_divided(&grid, Cube { level, key: cubes[i] }));
            let of_level: Vec<u64> = cubes
                .iter()
                .zip(is_requested)
                .filter(|(_, is_requested)| *is_requested)
                .map(|(key, _)| *key)
                .collect();
            let Some(&one) = of_level.first() else { break };
            n_cubes += 8 * of_level.len();
            if n_cubes as f64 > MAX_CUBES {
                return Err(too_many(grid.side(level + 1)));
            }
            if level == grid.depth {
                let at = grid.middle(Cube { level, key: one });
                let what = format!("a size here is below {:.1e}, a millionth of the model", grid.side(level));
                return Err(Error::input(what)
                    .at(format!("{}, {}, {}", at[0], at[1], at[2]))
                    .remedy("request larger sizes"));
            }
            cubes = children(&of_level);
            divided.push(of_level);
        }
        let mut tree = Self { grid, divided };
        tree.balance();
        Ok(tree)
    }

    /// Divides cubes so that neighbours differ by one level at most.
    fn balance(&mut self) {
        for level in (1..self.divided.len()).rev() {
            let counts = self.grid.counts.map(|n| n << level);
            let parents = self.divided[level].iter().flat_map(|&key| neighbours(key, counts));
            let mut coarser: Vec<u64> = parents.map(|n| key(place(n).map(|x| x / 2))).collect();
            coarser.append(&mut self.divided[level - 1]);
            coarser.sort_unstable();
            coarser.dedup();
            self.divided[level - 1] = coarser;
        }
    }

    /// The undivided cubes, level by level.
    pub(super) fn leaves(&self) -> Vec<Cube> {
        let [nx, ny, nz] = self.grid.counts;
        let first = (0..nx).flat_map(|x| (0..ny).flat_map(move |y| (0..nz).map(move |z| key([x, y, z]))));
        let mut leaves: Vec<Cube> =
            first.filter(|&key| !self.is_divided(0, key)).map(|key| Cube { level: 0, key }).collect();
        for (parents, level) in self.divided.iter().zip(1u32..) {
            let of_level = children(parents).into_iter().filter(|&key| !self.is_divided(level, key));
            leaves.extend(of_level.map(|key| Cube { level, key }));
        }
        leaves
    }

    fn is_divided(&self, level: u32, key: u64) -> bool {
        self.divided.get(level as usize).is_some_and(|of_level| of_level.binary_search(&key).is_ok())
    }

    /// The corners of cubes, each once.
    pub(super) fn corners(&self, cubes: &[Cube]) -> Vec<Point> {
        let finest = self.divided.len() as u32;
        let mut corners: Vec<u64> = Vec::with_capacity(8 * cubes.len());
        for cube in cubes {
            let low = place(cube.key);
            let corner = |k: u64| key([0, 1, 2].map(|i| (low[i] + (k >> i & 1)) << (finest - cube.level)));
            corners.extend((0..8).map(corner));
        }
        corners.sort_unstable();
        corners.dedup();
        corners.into_iter().map(|key| self.grid.at(finest, place(key).map(|x| x as f64))).collect()
    }
}

/// The eight parts of each cube, in ascending order.
fn children(parents: &[u64]) -> Vec<u64> {
    let of = |&parent: &u64| {
        let low = place(parent).map(|x| 2 * x);
        (0..8).map(move |k: u64| key([0, 1, 2].map(|i| low[i] + (k >> i & 1))))
    };
    let mut all: Vec<u64> = parents.iter().flat_map(of).collect();
    all.sort_unstable();
    all
}

/// The cubes of a level around a given one, itself included.
fn neighbours(key_of: u64, counts: [u64; 3]) -> impl Iterator<Item = u64> {
    let at = place(key_of);
    let step = |x: u64, d: u64, n: u64| (x + d).checked_sub(1).filter(|x| *x < n);
    (0..27u64).filter_map(move |k| {
        Some(key([
            step(at[0], k % 3, counts[0])?,
            step(at[1], k / 3 % 3, counts[1])?,
            step(at[2], k / 9, counts[2])?,
        ]))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cubes of a box divided until their side is at most 0.02 plus a quarter of the distance of their middle
    /// from a place.
    fn round_a_place() -> Octree {
        let grid = Grid::new([[-0.3, 0.1, 0.2], [2.0, 1.4, 1.1]], 0.7).unwrap();
        let is_large = |grid: &Grid, cube| {
            let at = grid.middle(cube);
            let distance = (0..3).map(|i| (at[i] - 0.4).powi(2)).sum::<f64>().sqrt();
            grid.side(cube.level) > 0.02 + 0.25 * distance
        };
        Octree::new(grid, is_large, &Threads::single()).unwrap()
    }

    #[test]
    fn cubes_fill_the_box_and_neighbours_differ_by_one_level() {
        let tree = round_a_place();
        let leaves = tree.leaves();
        let sides = leaves.iter().map(|cube| tree.grid.side(cube.level));
        let whole = tree.grid.counts.iter().product::<u64>() as f64 * tree.grid.side.powi(3);
        assert!((sides.map(|s| s.powi(3)).sum::<f64>() - whole).abs() < 1e-9 * whole);
        assert!(leaves.iter().map(|cube| cube.level).max().unwrap() >= 4);
        let mut n_different = 0;
        for (i, a) in leaves.iter().enumerate() {
            for b in &leaves[..i] {
                let ([al, ah], [bl, bh]) = (tree.grid.bounds(*a), tree.grid.bounds(*b));
                if (0..3).all(|i| al[i] <= bh[i] && bl[i] <= ah[i]) {
                    assert!(a.level.abs_diff(b.level) <= 1, "{a:?} {b:?}");
                    n_different += usize::from(a.level != b.level);
                }
            }
        }
        assert!(n_different > 100);
    }

    #[test]
    fn corners_are_there_once_each_and_exact() {
        let tree = round_a_place();
        let leaves = tree.leaves();
        let corners = tree.corners(&leaves);
        let mut all: Vec<Point> = leaves
            .iter()
            .flat_map(|cube| {
                let ends = tree.grid.bounds(*cube);
                (0..8).map(move |k| [0, 1, 2].map(|i| ends[k >> i & 1][i]))
            })
            .collect();
        let order = |x: &Point, y: &Point| x.partial_cmp(y).unwrap();
        all.sort_by(order);
        all.dedup();
        let mut found = corners;
        found.sort_by(order);
        assert_eq!(found, all);
    }

    #[test]
    fn too_many_cubes_are_refused() {
        assert!(Grid::new([[0.0; 3], [1.0; 3]], 1e-6).unwrap_err().to_string().contains("larger"));
        assert!(Grid::new([[0.0; 3], [1e300; 3]], 1e-300).is_err());
        assert!(Grid::new([[0.0; 3]; 2], 0.0).is_err() && Grid::new([[0.0; 3]; 2], f64::NAN).is_err());
        let grid = || Grid::new([[0.0; 3], [1.0; 3]], 1.0).unwrap();
        assert!(Octree::new(grid(), |_, _| true, &Threads::single()).is_err());
        // Towards a single place there are never many cubes.
        let holds = |grid: &Grid, cube| {
            let [low, high] = grid.bounds(cube);
            low[0] <= 0.3 && 0.3 < high[0] && low[1] <= 0.3 && 0.3 < high[1] && low[2] <= 0.3 && 0.3 < high[2]
        };
        let error = Octree::new(grid(), holds, &Threads::single()).unwrap_err().to_string();
        assert!(error.contains("millionth") && error.contains("0.3"), "{error}");
    }
}
