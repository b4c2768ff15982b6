//! The rotation of each vertex of a wall.
//!
//! The rotation of a vertex is the part of the deformation around it that is no stretch: the polar factor of
//! its plane gradient, with the normal carried along. The gradient is the mean over the facets of the vertex,
//! weighted by area, so it does not jump from facet to facet. A wall that moves rigidly rotates every vertex
//! by exactly its own rotation, at creases as well.
//!
//! The mean gradient is linear in the displacements `d`. In a direction `c` its change is the sum of
//! `(d_j - d) (g_j . c)` over the vertices j around, where `g_j` is half the sum of `n x e` over the facets
//! at j, with the normal `n` and the edge `e` opposite to j, relative to the area around. A step needs it in
//! two directions, chosen so that it takes them to unit vectors at right angles before anything moves.
//!
//! Where facets meet at an angle, it needs three (see `crease`).

use pulp::NullaryFnOnce;

use crate::base::four::{FourLanes, Plain, cross as cross4};
#[cfg(target_arch = "x86_64")]
use crate::base::four::{Wide, wide_machine};
use crate::base::{Csr, DisjointSets, Point, Threads};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, cross, dot, norm, scale, sub};
use crate::motion::crease::Creases;
use crate::motion::polar::{IDENTITY, Quaternion, frame, quaternion};
use crate::motion::update::Padded;

/// Vertices that take one stage of the computation before any takes the next. In short loops the processor
/// overlaps several iterations, and so hides the roots and quotients.
const CHUNK: usize = 64;

/// Vertices per part of the work.
const PART: usize = 16 * CHUNK;

/// A vertex is on a crease where the mean of the squared cosines between the normals of its facets and their
/// mean is below this: where two facets meet at 26 degrees. On smoother walls the tilt that stretch causes is
/// small: 3 degrees where one of the two is stretched by half.
const MIN_FLATNESS: f64 = 0.95;

/// The vertices of a wall, numbered from 0.
#[derive(Debug)]
pub(crate) struct Wall {
    /// The first vertex of the connected part of the wall to which each vertex belongs.
    parts: Vec<u32>,
    /// The vertices around each vertex, in pairs; none for one that is on no facet with an area.
    around: Csr<Pair>,
    /// For each four vertices, the unit vectors to which the mean gradient takes the two directions at first.
    references: Vec<[FourPoints; 2]>,
    /// Those where facets meet at an angle.
    creases: Creases,
}

/// Four points, coordinate by coordinate.
type FourPoints = [[f64; 4]; 3];

/// Two vertices around another one, and their shares of the gradient there in the two directions.
#[derive(Clone, Copy, Debug)]
struct Pair {
    vertices: [u32; 2],
    shares: [[f64; 2]; 2],
}

/// The rotations of the vertices of a wall.
#[derive(Debug, Default)]
pub(crate) struct Rotations {
    first: usize,
    /// Those of consecutive vertices, beginning with `first`; no other vertex rotates.
    rotations: Vec<Quaternion>,
}

impl Rotations {
    pub(crate) fn is_empty(&self) -> bool {
        self.rotations.is_empty()
    }

    /// The rotation of a vertex; `None` where all of its part of the wall only translates.
    #[inline(always)]
    pub(crate) fn of(&self, vertex: usize) -> Option<&Quaternion> {
        self.rotations.get(vertex.wrapping_sub(self.first))
    }
}

impl Wall {
    /// The wall made of `triangles` between `points`, in its reference position. Vertices for which
    /// `is_needed` does not hold never rotate.
    pub(crate) fn new(points: &[Point], triangles: &[[u32; 3]], is_needed: impl Fn(usize) -> bool) -> Self {
        let mut parts = DisjointSets::new(points.len());
        triangles.iter().flat_map(|&[a, b, c]| [(a, b), (a, c)]).for_each(|(a, b)| parts.join(a, b));
        let facets = Csr::from_pairs(points.len(), || {
            triangles.iter().enumerate().flat_map(|(i, t)| t.map(|v| (v as usize, i as u32)))
        });
        let (mut offsets, mut pairs) = (vec![0], Vec::new());
        let mut references = vec![Default::default(); points.len().div_ceil(4)];
        let mut ring = Ring::default();
        let mut creases = Creases::default();
        for (v, facets) in facets.iter().enumerate() {
            if is_needed(v) {
                ring.set(v as u32, facets.iter().map(|&t| triangles[t as usize]), points);
                let [first, second] = ring.reference(v as u32, &mut pairs);
                let [along, across]: &mut [FourPoints; 2] = &mut references[v / 4];
                (0..3).for_each(|k| (along[k][v % 4], across[k][v % 4]) = (first[k], second[k]));
                if ring.is_creased() {
                    let around = ring.gradients.iter().map(|&(j, g)| (j, scale(g, 1.0 / ring.area)));
                    creases.push(v as u32, ring.at_first(), around);
                }
            }
            offsets.push(pairs.len() as u32);
        }
        pairs.shrink_to_fit();
        let around = Csr::new(offsets, pairs).expect("offsets rise to the number of pairs");
        creases.shrink_to_fit();
        Self { parts: parts.roots(), around, references, creases }
    }

    /// The rotations of all vertices in a motion by `displacement`.
    pub(crate) fn rotations(&self, displacement: &[Padded], threads: &Threads) -> Rotations {
        let mut rotates = vec![false; self.parts.len()];
        for (d, &part) in displacement.iter().zip(&self.parts) {
            if !d.is_same(&displacement[part as usize]) {
                rotates[part as usize] = true;
            }
        }
        let does_rotate = |part: &u32| rotates[*part as usize];
        let Some(first) = self.parts.iter().position(does_rotate) else {
            return Rotations::default();
        };
        // A multiple of four, like the references.
        let first = first - first % 4;
        let last = self.parts.iter().rposition(does_rotate).unwrap_or(first);
        let mut rotations = vec![IDENTITY; last + 1 - first];
        threads.fill(
            &mut rotations,
            PART,
            || (),
            |(), begin, rotations| {
                for (i, rotations) in rotations.chunks_mut(CHUNK).enumerate() {
                    let begin = first + begin + i * CHUNK;
                    if self.parts[begin..begin + rotations.len()].iter().any(does_rotate) {
                        self.rotate(displacement, begin, rotations);
                    }
                }
            },
        );
        Rotations { first, rotations }
    }

    /// The rotations of consecutive vertices, at most [`CHUNK`], beginning with a multiple of four.
    fn rotate(&self, displacement: &[Padded], first: usize, rotations: &mut [Quaternion]) {
        #[cfg(target_arch = "x86_64")]
        if let Some(machine) = wide_machine() {
            return machine.vectorize(Chunk::<Wide> { machine, wall: self, displacement, first, rotations });
        }
        Chunk::<Plain> { machine: (), wall: self, displacement, first, rotations }.call();
    }
}

/// What is around one vertex in its reference position.
#[derive(Debug, Default)]
struct Ring {
    area: f64,
    /// The sum of the area vectors, and the largest of them.
    normal: Point,
    largest: Point,
    /// The sum of `n n` times the area.
    squares: [Point; 3],
    /// The vertices around and their `g_j`, times the area around.
    gradients: Vec<(u32, Point)>,
}

impl Ring {
    fn set(&mut self, v: u32, facets: impl Iterator<Item = [u32; 3]>, points: &[Point]) {
        self.gradients.clear();
        *self = Self { gradients: std::mem::take(&mut self.gradients), ..Self::default() };
        for facet in facets {
            let corners = facet.map(|v| points[v as usize]);
            let vector = area_vector(corners);
            let area = norm(vector);
            let unit = scale(vector, 1.0 / area);
            if !unit.iter().all(|x| x.is_finite()) {
                continue;
            }
            self.area += area;
            self.normal = add(self.normal, vector);
            if area > norm(self.largest) {
                self.largest = vector;
            }
            for i in 0..3 {
                self.squares[i] = add(self.squares[i], scale(vector, unit[i]));
                let edge = sub(corners[(i + 2) % 3], corners[(i + 1) % 3]);
                if facet[i] != v {
                    self.add(facet[i], scale(cross(unit, edge), 0.5));
                }
            }
        }
    }

    fn add(&mut self, vertex: u32, gradient: Point) {
        match self.gradients.iter_mut().find(|(known, _)| *known == vertex) {
            Some((_, sum)) => *sum = add(*sum, gradient),
            None => self.gradients.push((vertex, gradient)),
        }
    }

    /// The direction of the mean normal or, where facets face both ways, of the normal of the largest facet.
    fn direction(&self) -> Point {
        let faces_one_way = 2.0 * norm(self.normal) > self.area;
        if faces_one_way { self.normal } else { self.largest }
    }

    /// The mean of `1 - n n`.
    fn at_first(&self) -> [Point; 3] {
        [0, 1, 2].map(|i| [0, 1, 2].map(|j| f64::from(u8::from(i == j)) - self.squares[i][j] / self.area))
    }

    fn is_creased(&self) -> bool {
        let normal = self.direction();
        let squares = dot(normal, self.squares.map(|row| dot(row, normal)));
        squares < MIN_FLATNESS * self.area * dot(normal, normal)
    }

    /// Appends the vertices around, and returns what the mean gradient makes of the two directions at first.
    /// They are in the plane at right angles to the normal.
    fn reference(&self, v: u32, pairs: &mut Vec<Pair>) -> [Point; 2] {
        let normal = self.direction();
        // Any direction that is not along the normal.
        let axis = (0..3).fold(0, |least, k| if normal[k].abs() < normal[least].abs() { k } else { least });
        let aside = [0, 1, 2].map(|k| if k == axis { 1.0 } else { 0.0 });
        let unit = |a: Point| scale(a, 1.0 / norm(a));
        let first = unit(cross(normal, aside));
        let directions = [first, cross(unit(normal), first)];
        let share = 1.0 / self.area;
        let at_first = self.at_first();
        let images = directions.map(|c| at_first.map(|row| dot(row, c)));
        let splat = |p: Point| p.map(|x| Plain::splat((), x));
        let [along, _, normal] = frame((), images.map(splat)).map(|axis| axis.map(|x| x.stored()[0]));
        let frame = [along, cross(normal, along)];
        // Combined by the inverse of this matrix, the directions have the frame for images.
        let [[a, b], [c, d]] = frame.map(|axis| images.map(|image| dot(axis, image)));
        let share = share / (a * d - b * c);
        let combined = |[x, y]: [f64; 2]| [(d * x - c * y) * share, (a * y - b * x) * share];
        if !share.is_finite() {
            return frame;
        }
        let shares = |g: Point| combined(directions.map(|c| dot(g, c)));
        for pair in self.gradients.chunks(2) {
            // An odd one makes a pair with the vertex itself.
            let other = pair.get(1).map_or((v, [0.0; 2]), |&(vertex, g)| (vertex, shares(g)));
            let (vertex, gradient) = pair[0];
            pairs.push(Pair { vertices: [vertex, other.0], shares: [shares(gradient), other.1] });
        }
        frame
    }
}

/// Consecutive vertices of a wall, to be rotated.
struct Chunk<'a, F: FourLanes> {
    machine: F::Machine,
    wall: &'a Wall,
    displacement: &'a [Padded],
    first: usize,
    rotations: &'a mut [Quaternion],
}

impl<F: FourLanes> NullaryFnOnce for Chunk<'_, F> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { machine, wall, displacement, first, rotations } = self;
        // How the images of the two directions change at each vertex.
        let mut changes = [[[[0.0; 4]; 3]; 2]; CHUNK / 4];
        for i in 0..rotations.len() {
            let own = displacement[first + i].load::<F>(machine);
            let mut images = [F::splat(machine, 0.0); 2];
            for pair in wall.around.list(first + i) {
                let [a, b] = pair.vertices;
                let a = displacement[a as usize].load::<F>(machine) - own;
                let b = displacement[b as usize].load::<F>(machine) - own;
                for (k, image) in images.iter_mut().enumerate() {
                    let [of_a, of_b] = [pair.shares[0][k], pair.shares[1][k]];
                    *image = *image + (a * F::splat(machine, of_a) + b * F::splat(machine, of_b));
                }
            }
            for k in 0..2 {
                let [x, y, z, _] = images[k].stored();
                let of_four = &mut changes[i / 4][k];
                (of_four[0][i % 4], of_four[1][i % 4], of_four[2][i % 4]) = (x, y, z);
            }
        }
        let references = &wall.references[first / 4..];
        let mut frames = [[[[0.0; 4]; 3]; 3]; CHUNK / 4];
        let mut moved = [[0.0; 4]; CHUNK / 4];
        for (i, reference) in references.iter().take(rotations.len().div_ceil(4)).enumerate() {
            let mut sum = F::splat(machine, 0.0);
            let mut images = [[sum; 3]; 2];
            for k in 0..2 {
                for j in 0..3 {
                    let change = F::load(machine, &changes[i][k][j]);
                    images[k][j] = F::load(machine, &reference[k][j]) + change;
                    sum = sum + change.abs();
                }
            }
            let axes = frame(machine, images);
            for k in 0..3 {
                frames[i][k] = [axes[k][0].stored(), axes[k][1].stored(), axes[k][2].stored()];
            }
            moved[i] = sum.stored();
        }
        for (i, rotations) in rotations.chunks_mut(4).enumerate() {
            if moved[i] == [0.0; 4] {
                continue;
            }
            let load =
                |a: &FourPoints| [F::load(machine, &a[0]), F::load(machine, &a[1]), F::load(machine, &a[2])];
            let [along, across] = [load(&references[i][0]), load(&references[i][1])];
            let to = [load(&frames[i][0]), load(&frames[i][1]), load(&frames[i][2])];
            let moved = F::load(machine, &moved[i]);
            let parts = quaternion(machine, [along, across, cross4(along, across)], to, moved);
            let [w, x, y, z] = [parts[0].stored(), parts[1].stored(), parts[2].stored(), parts[3].stored()];
            for (lane, rotation) in rotations.iter_mut().enumerate() {
                *rotation = [w[lane], x[lane], y[lane], z[lane]];
            }
        }
        wall.creases.rotate::<F>(machine, displacement, first, rotations);
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::geometry::vector::distance;
    use crate::motion::Prescribed;
    use crate::motion::polar::rotation_change;

    const TRIANGLES: [[u32; 3]; 4] = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
    const POINTS: [Point; 4] = [[0.1, 0.2, 0.0], [1.0, 0.0, 0.3], [0.2, 1.4, 0.0], [0.0, -0.2, 1.1]];

    fn rotations(points: &[Point], triangles: &[[u32; 3]], to: impl Fn(Point) -> Point) -> Vec<Quaternion> {
        let wall = Wall::new(points, triangles, |_| true);
        let displacement: Vec<Padded> = points.iter().map(|&p| Padded::new(sub(to(p), p))).collect();
        let rotations = wall.rotations(&displacement, &Threads::single());
        (0..points.len()).map(|v| rotations.of(v).copied().unwrap_or(IDENTITY)).collect()
    }

    /// The sine of half the angle between two rotations.
    fn difference(p: &Quaternion, q: &Quaternion) -> f64 {
        let length = |sign: f64| p.iter().zip(q).map(|(a, b)| (a - sign * b).powi(2)).sum::<f64>().sqrt();
        length(1.0).min(length(-1.0))
    }

    /// A sheet of `n` by `n` squares in the plane `z = 0`.
    fn sheet(n: u32) -> (Vec<Point>, Vec<[u32; 3]>) {
        let at = |i: u32, j: u32| i * (n + 1) + j;
        let points = (0..=n).flat_map(|i| (0..=n).map(move |j| [f64::from(i), f64::from(j), 0.0])).collect();
        let square = |i: u32, j: u32| {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            [[a, b, c], [a, c, d]]
        };
        (points, (0..n).flat_map(|i| (0..n).flat_map(move |j| square(i, j))).collect())
    }

    /// Four sides of a cube. Some of its vertices have triangles of unequal areas on two or three sides.
    fn cube() -> (Vec<Point>, [[u32; 3]; 8]) {
        let points = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect();
        (points, [[0, 1, 3], [0, 3, 2], [0, 4, 5], [0, 5, 1], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
    }

    /// The columns of the matrix of a rotation.
    fn columns(q: Quaternion) -> [Point; 3] {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| add(axis, rotation_change(q, axis)))
    }

    #[test]
    fn a_rigid_turn_is_found_at_any_angle() {
        let (flat, squares) = sheet(3);
        let (cube, sides) = cube();
        for degrees in [0.0, 1e-6, 30.0, 90.0, 179.9, 180.0, 250.0] {
            for axis in [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.3, 0.4, -2.0]] {
                let turn =
                    Prescribed::Turn { axis, angle: f64::to_radians(degrees), centre: [3.0, -1.0, 2.0] };
                let (v, origin) = ([0.3, -0.7, 1.9], [0.0; 3]);
                let turned = sub(turn.apply(v, 1.0), turn.apply(origin, 1.0));
                let walls: [(&[Point], &[[u32; 3]]); 3] =
                    [(&POINTS, &TRIANGLES), (&flat, &squares), (&cube, &sides)];
                for (points, triangles) in walls {
                    for q in rotations(points, triangles, |p| turn.apply(p, 1.0)) {
                        let difference = distance(add(v, rotation_change(q, v)), turned);
                        assert!(difference < 2e-14, "{degrees} {axis:?} {difference}");
                    }
                }
            }
        }
    }

    #[test]
    fn stretch_does_not_turn() {
        let anyhow = |[x, y, z]: Point| [0.7 * x, 1.9 * y, 3.0 * z];
        let (points, triangles) = sheet(2);
        let (cube, sides) = cube();
        let of_solid = rotations(&POINTS, &TRIANGLES, |p| scale(p, 0.7));
        let of_sheet = rotations(&points, &triangles, anyhow);
        let of_cube = rotations(&cube, &sides, anyhow);
        for q in of_solid.iter().chain(&of_sheet).chain(&of_cube) {
            assert!(difference(q, &IDENTITY) < 1e-15);
        }
    }

    #[test]
    fn a_stretched_crease_turns_with_its_facets() {
        let (cube, sides) = cube();
        let half = f64::to_radians(35.0);
        let turn = [half.cos(), 0.6 * half.sin(), 0.0, -0.8 * half.sin()];
        let to = |[x, y, z]: Point| {
            let stretched = [0.5 * x, 1.4 * y, 2.0 * z];
            add(stretched, rotation_change(turn, stretched))
        };
        assert!(rotations(&cube, &sides, to).iter().all(|q| difference(q, &turn) < 1e-15));
    }

    #[test]
    fn a_crease_that_is_mirrored_or_collapses_still_has_a_rotation() {
        let (points, sides) = cube();
        let flat = |[x, y, _]: Point| [x, y, 0.0];
        let line = |[x, y, z]: Point| [x + y + z, 0.0, 0.0];
        let point = |_: Point| [0.1; 3];
        let mirrored = |[x, y, z]: Point| [-x, y, z];
        let nearly_flat = |[x, y, z]: Point| [x, y, 1e-13 * z];
        for to in [flat, line, point, mirrored, nearly_flat] {
            for q in rotations(&points, &sides, to) {
                assert!((q.iter().map(|x| x * x).sum::<f64>() - 1.0).abs() < 1e-14, "{q:?}");
            }
        }
    }

    #[test]
    fn what_has_no_area_has_no_say() {
        let points = [[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let triangles = [[0, 1, 2], [0, 1, 3]];
        let bend = |[x, y, z]: Point| [x, y, z + x + 2.0 * y];
        let bent = rotations(&points, &triangles, bend);
        let alone = rotations(&points, &triangles[1..], bend);
        assert_eq!(bent[2], IDENTITY);
        assert!([0, 1, 3].iter().all(|&v| bent[v] != IDENTITY && bent[v] == alone[v]));
        let to_a_line = rotations(&points, &triangles, |[x, y, z]| [x + 0.5 * y, 0.0, z]);
        assert!(to_a_line.iter().all(|q| *q == IDENTITY));
    }

    #[test]
    fn a_wall_that_is_mirrored_in_its_plane_turns_over() {
        let (points, triangles) = sheet(2);
        let over = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
        for q in rotations(&points, &triangles, |[x, y, z]| [-x, y, z]) {
            assert!((0..3).all(|k| distance(columns(q)[k], over[k]) < 1e-14));
        }
    }

    #[test]
    fn the_front_of_a_facet_of_a_flat_wall_does_not_matter() {
        let (points, triangles) = sheet(3);
        let wave = |[x, y, _]: Point| [x + 0.1 * y * y, y, (0.7 * x).sin() + 0.3 * x * y];
        let mut mixed = triangles.clone();
        mixed.iter_mut().step_by(3).for_each(|t| t.swap(1, 2));
        let [one, other] = [triangles, mixed].map(|t| rotations(&points, &t, wave));
        assert!(one.iter().zip(&other).all(|(p, q)| *p != IDENTITY && difference(p, q) < 1e-14));
    }

    #[test]
    fn the_line_of_a_hinge_turns_by_the_mean_of_its_sides() {
        // Two squares at a right angle, opened by 2 x 20 degrees.
        let points = [
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [1.0, 0.0, 1.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 1.0],
        ];
        let triangles = [[0, 2, 3], [0, 3, 1], [0, 1, 5], [0, 5, 4]];
        let open = |p: Point| {
            let angle = f64::to_radians(if p[1] > 0.0 { 20.0 } else { -20.0 });
            Prescribed::Turn { axis: [0.0, 0.0, 1.0], angle, centre: [0.0; 3] }.apply(p, 1.0)
        };
        let rotations = rotations(&points, &triangles, open);
        let expected = |q: &Quaternion, part: f64| {
            let half = part * f64::to_radians(10.0);
            difference(q, &[half.cos(), 0.0, 0.0, half.sin()])
        };
        assert!([2, 3].iter().all(|&v| expected(&rotations[v], -1.0) < 1e-14));
        assert!([4, 5].iter().all(|&v| expected(&rotations[v], 1.0) < 1e-14));
        // The areas of the two sides at each end of the line are as 2 to 1.
        assert!(rotations[..2].iter().all(|q| expected(q, 0.0) < 0.06));
    }

    #[test]
    fn what_only_translates_is_not_rounded() {
        let (points, triangles) = sheet(20);
        let displacement = |[x, y, _]: Point| match x > 9.5 {
            true => [0.1, 0.0, 0.3 * (x - 9.5) * y],
            false => [0.1, 0.7, -1e3],
        };
        let displacement: Vec<Padded> = points.iter().map(|&p| Padded::new(displacement(p))).collect();
        let wall = Wall::new(&points, &triangles, |_| true);
        let rotations = wall.rotations(&displacement, &Threads::single());
        for (v, p) in points.iter().enumerate() {
            assert_eq!(*rotations.of(v).unwrap() == IDENTITY, p[0] < 8.5, "{p:?}");
        }
        assert!(wall.rotations(&vec![displacement[0]; points.len()], &Threads::single()).is_empty());
    }

    /// A wall with a crease that is bent, in a grid with a last four that is not full.
    fn bent() -> (Wall, Vec<Padded>) {
        let (mut points, triangles) = sheet(6);
        points.iter_mut().for_each(|p| p[2] = (3.0 - p[0]).abs());
        let bend = |[x, y, _]: Point| [0.1 * y * y, -0.01 * x * y, (0.7 * x).sin() + 0.3 * x * y];
        let displacement = points.iter().map(|&p| Padded::new(bend(p))).collect();
        (Wall::new(&points, &triangles, |_| true), displacement)
    }

    #[test]
    fn wide_and_plain_instructions_give_the_same_bits() {
        let (wall, displacement) = bent();
        let mut plain = vec![IDENTITY; displacement.len()];
        let mut wide = plain.clone();
        wall.rotate(&displacement, 0, &mut wide);
        let (wall, displacement, rotations) = (&wall, &displacement[..], &mut plain[..]);
        Chunk::<Plain> { machine: (), wall, displacement, first: 0, rotations }.call();
        assert_eq!(wide, plain);
        assert!(wide.iter().all(|q| *q != IDENTITY));
    }

    proptest! {
        /// Against singular values: `U V^T` of the plane gradient, with the normals as third vectors.
        #[test]
        fn it_is_the_polar_factor_of_the_gradient(
            rows in prop::array::uniform3(prop::array::uniform3(-1.0..1.0f64)),
            corners in prop::array::uniform3(prop::array::uniform3(-1.0..1.0f64)),
        ) {
            let size = norm(area_vector(corners));
            prop_assume!(size > 0.05);
            let map = |p: Point| rows.map(|row| dot(row, p));
            let image = corners.map(map);
            prop_assume!(norm(area_vector(image)) > 1e-3);
            for q in rotations(&corners, &[[0, 1, 2]], map) {
                let (rotation, expected) = (columns(q), by_singular_values(corners, image));
                for k in 0..3 {
                    prop_assert!(distance(rotation[k], expected[k]) < 1e-11, "{:?} {:?}", rotation, expected);
                }
            }
        }
    }

    /// The columns of the rotation: the plane gradient in an orthonormal basis of the plane, its singular
    /// vectors by one rotation of Jacobi's, and the normals before and after.
    fn by_singular_values(before: [Point; 3], after: [Point; 3]) -> [Point; 3] {
        let unit = |a: Point| scale(a, 1.0 / norm(a));
        let edges = |[a, b, c]: [Point; 3]| [sub(b, a), sub(c, a)];
        let ([e, f], [g, h]) = (edges(before), edges(after));
        // Orthonormal combinations of the first edges, and the same ones of the second.
        let (p, part) = (scale(e, 1.0 / norm(e)), dot(e, f) / dot(e, e));
        let rest = sub(f, scale(e, part));
        let (q, across) = (unit(rest), scale(sub(h, scale(g, part)), 1.0 / norm(rest)));
        let along = scale(g, 1.0 / norm(e));
        let angle = 0.5 * (2.0 * dot(along, across)).atan2(dot(along, along) - dot(across, across));
        let (sine, cosine) = angle.sin_cos();
        let mixed = |a: Point, b: Point| {
            [add(scale(a, cosine), scale(b, sine)), sub(scale(b, cosine), scale(a, sine))]
        };
        let (right, left) = (mixed(p, q), mixed(along, across).map(unit));
        let from = [right[0], right[1], cross(right[0], right[1])];
        let to = [left[0], left[1], cross(left[0], left[1])];
        [0, 1, 2].map(|k| (0..3).fold([0.0; 3], |sum, i| add(sum, scale(to[i], from[i][k]))))
    }
}
