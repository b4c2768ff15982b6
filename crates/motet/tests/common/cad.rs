//! Bodies as CAD programs write them: flat faces in several triangles, rotated, shifted and rounded, so that
//! they are flat only up to rounding.

use std::f64::consts::TAU;

use motet::base::{Point, VertexId};

/// A closed surface.
pub(crate) struct Cad {
    pub(crate) kind: &'static str,
    pub(crate) points: Vec<Point>,
    pub(crate) triangles: Vec<[VertexId; 3]>,
}

/// Numbers in [0, 1), the same for the same seed (Steele, Lea and Flood 2014, *Fast splittable pseudorandom
/// number generators*).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }
}

pub(crate) const KINDS: [&str; 7] =
    ["cylinder, fans", "cylinder, strips", "cylinder, centres", "cone", "gear", "box with a hole", "fillets"];

/// A body of `KINDS[seed % 7]`; every second one is rotated, a third are shifted by 1000, and a third of all
/// are written in `f32`.
pub(crate) fn cad(seed: usize) -> Cad {
    let mut numbers = Numbers(seed as u64);
    let kind = seed % KINDS.len();
    let n = 4 * (3 + numbers.below(13));
    let height = [0.3, 1.0, 3.0, 10.0][numbers.below(4)];
    let (mut points, mut triangles) = match kind {
        0 => prism(&circle(n), height, &fan(n)),
        1 => prism(&circle(n), height, &strip(n)),
        2 => prism(&circle(n), height, &centre(n)),
        3 => cone(&circle(n), height, &fan(n)),
        4 => prism(&gear(n), height, &centre(n)),
        5 => pierced(n, height),
        _ => prism(&rounded(n), height, &fan(n)),
    };
    if (seed / KINDS.len()).is_multiple_of(2) {
        turn(&mut points, &mut numbers);
    }
    if numbers.below(3) == 0 {
        let shift: Point = std::array::from_fn(|_| 1000.0 * (numbers.next() - 0.5));
        points.iter_mut().for_each(|p| (0..3).for_each(|i| p[i] += shift[i]));
    }
    if numbers.below(3) == 0 {
        points.iter_mut().flatten().for_each(|x| *x = f64::from(*x as f32));
    }
    if numbers.below(2) == 0 {
        triangles.reverse();
    }
    let ids = |t: [usize; 3]| t.map(VertexId::new);
    Cad { kind: KINDS[kind], points, triangles: triangles.into_iter().map(ids).collect() }
}

type Body = (Vec<Point>, Vec<[usize; 3]>);

fn circle(n: usize) -> Vec<[f64; 2]> {
    (0..n).map(|i| (TAU * i as f64 / n as f64).sin_cos()).map(|(y, x)| [x, y]).collect()
}

fn gear(n: usize) -> Vec<[f64; 2]> {
    let radius = |i: usize| if (i / 2).is_multiple_of(2) { 1.0 } else { 0.8 };
    circle(n).into_iter().enumerate().map(|(i, p)| p.map(|x| radius(i) * x)).collect()
}

/// A square with rounded corners.
fn rounded(n: usize) -> Vec<[f64; 2]> {
    let corner = |x: f64| 0.7 * x.signum() + 0.3 * x;
    // Half a step away from the axes, where corners begin.
    let place = |i: usize| (TAU * (i as f64 + 0.5) / n as f64).sin_cos();
    (0..n).map(place).map(|(y, x)| [corner(x), corner(y)]).collect()
}

/// Triangles of a polygon of n corners; n is its centre.
fn fan(n: usize) -> Vec<[usize; 3]> {
    (1..n - 1).map(|i| [0, i, i + 1]).collect()
}

fn strip(n: usize) -> Vec<[usize; 3]> {
    let (mut triangles, mut low, mut high, mut side) = (Vec::new(), 0, n - 1, false);
    while high - low > 1 {
        if side {
            triangles.push([low, high - 1, high]);
            high -= 1;
        } else {
            triangles.push([low, low + 1, high]);
            low += 1;
        }
        side = !side;
    }
    triangles
}

fn centre(n: usize) -> Vec<[usize; 3]> {
    (0..n).map(|i| [n, i, (i + 1) % n]).collect()
}

/// A prism: rings at two heights, and the sides between them.
fn prism(ring: &[[f64; 2]], height: f64, cap: &[[usize; 3]]) -> Body {
    let (n, has_centre) = (ring.len(), cap.iter().flatten().any(|&v| v == ring.len()));
    let n_level = n + usize::from(has_centre);
    let level = |z: f64| {
        let centre = has_centre.then_some([0.0, 0.0, z]);
        ring.iter().map(move |&[x, y]| [x, y, z]).chain(centre)
    };
    let points = level(0.0).chain(level(height)).collect();
    let side = |i: usize| {
        let j = (i + 1) % n;
        [[i, j, j + n_level], [i, j + n_level, i + n_level]]
    };
    let caps = cap.iter().flat_map(|&[a, b, c]| [[a, c, b], [a + n_level, b + n_level, c + n_level]]);
    (points, (0..n).flat_map(side).chain(caps).collect())
}

fn cone(ring: &[[f64; 2]], height: f64, cap: &[[usize; 3]]) -> Body {
    let n = ring.len();
    let points = ring.iter().map(|&[x, y]| [x, y, 0.0]).chain([[0.0, 0.0, height]]).collect();
    let base = cap.iter().map(|&[a, b, c]| [a, c, b]);
    (points, (0..n).map(|i| [i, (i + 1) % n, n]).chain(base).collect())
}

/// A box with a round hole; n is a multiple of 4.
fn pierced(n: usize, height: f64) -> Body {
    let per_side = n / 4;
    let outer = |i: usize| {
        let along = 2.0 * (i % per_side) as f64 / per_side as f64 - 1.0;
        [[1.0, along], [-along, 1.0], [-1.0, -along], [along, -1.0]][i / per_side]
    };
    // The first corner of the square is an eighth of a turn below the axis.
    let inner = |i: usize| {
        let (y, x) = (TAU * (i as f64 / n as f64 - 0.125)).sin_cos();
        [0.5 * x, 0.5 * y]
    };
    let ring = || (0..n).map(outer).chain((0..n).map(inner));
    let points = [0.0, height].into_iter().flat_map(|z| ring().map(move |[x, y]| [x, y, z])).collect();
    let at = |i: usize, is_inner: usize, is_top: usize| i % n + n * is_inner + 2 * n * is_top;
    let quad = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]];
    let around = |i: usize| {
        [
            [at(i, 0, 0), at(i + 1, 0, 0), at(i + 1, 0, 1), at(i, 0, 1)],
            [at(i + 1, 1, 0), at(i, 1, 0), at(i, 1, 1), at(i + 1, 1, 1)],
            [at(i, 0, 1), at(i + 1, 0, 1), at(i + 1, 1, 1), at(i, 1, 1)],
            [at(i + 1, 0, 0), at(i, 0, 0), at(i, 1, 0), at(i + 1, 1, 0)],
        ]
    };
    (points, (0..n).flat_map(around).flat_map(quad).collect())
}

/// Rotates about the origin, by a random unit quaternion (Shoemake 1992, *Uniform random rotations*).
fn turn(points: &mut [Point], numbers: &mut Numbers) {
    let [u, v, w] = [0; 3].map(|_| numbers.next());
    let [(s, c), (t, d)] = [(TAU * v).sin_cos(), (TAU * w).sin_cos()];
    let [x, y, z, w] = [(1.0 - u).sqrt() * s, (1.0 - u).sqrt() * c, u.sqrt() * t, u.sqrt() * d];
    let rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    for p in points {
        *p = rows.map(|row| row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);
    }
}
