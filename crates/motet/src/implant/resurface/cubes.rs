//! Cubes near a surface, and the tets of the body-centred lattice among them.

use crate::base::{Point, VertexId};
use crate::geometry::triangle::{area, area_vector};
use crate::geometry::vector::{add, distance, dot, norm, scale, sub};
use crate::mesh::{Surface, bounds};
use crate::meshing::EDGE_OVER_SIDE;

type Cube = [i32; 3];

/// More sides of cubes than this on the surface are too many: each yields about 12 triangles, and 100,000 a
/// few hundred MB of lattice.
const MAX_SQUARES: f64 = 1e5;

/// Triangles are processed in more pieces than this only if they are needles of extreme length.
const MAX_PIECES: f64 = 2e7;

/// The longest edge of a piece, in sides of cubes.
const MAX_EDGE: f64 = 2.0;

/// The centres of cubes that a piece passes through, and of their neighbours, are at most this far from its
/// plane, in sides: half a diagonal of a cube and a side.
const REACH: f64 = 1.87;

/// This many cubes are collected before duplicates are removed.
const FIRST_CAPACITY: usize = 1 << 20;

/// Cubes of one size, in ascending order.
pub(super) struct Cubes {
    low: Point,
    side: f64,
    cubes: Vec<Cube>,
}

/// Vertices and tets of a lattice. Edges between centres or between corners are *long*, the others short.
pub(super) struct Lattice {
    pub(super) points: Vec<Point>,
    pub(super) tets: Vec<[VertexId; 4]>,
    /// How many vertices are corners of cubes; behind them come centres.
    pub(super) n_corners: usize,
}

/// The shortest edge that a lattice near the surface may have.
pub(super) fn shortest_edge(surface: &Surface) -> f64 {
    let triangles = || (0..surface.triangles.len()).map(|t| surface.corners(t));
    let squares = triangles().map(area).sum::<f64>() / MAX_SQUARES;
    let pieces =
        triangles().map(|t| distance(t[0], t[1]).max(distance(t[1], t[2]))).sum::<f64>() / MAX_PIECES;
    EDGE_OVER_SIDE * squares.sqrt().max(pieces)
}

impl Cubes {
    /// The cubes that triangles pass through, their neighbours, and some more.
    pub(super) fn near(surface: &Surface, edge: f64) -> Self {
        let side = edge / EDGE_OVER_SIDE;
        let corners: Vec<Point> =
            surface.triangles.as_flattened().iter().map(|v| surface.points[v.index()]).collect();
        // An origin from which no coordinate of a surface is likely to be a whole number of sides away.
        let low = bounds(&corners).unwrap_or_default()[0].map(|x| x - 0.618_033_988_749 * side);
        let mut near = Self { low, side, cubes: Vec::new() };
        let mut full = FIRST_CAPACITY;
        for corners in corners.as_chunks().0 {
            near.add_triangle(*corners);
            // Neighbouring triangles have most of their cubes in common.
            if near.cubes.len() > full {
                sort_and_dedup(&mut near.cubes);
                full = FIRST_CAPACITY.max(2 * near.cubes.len());
            }
        }
        sort_and_dedup(&mut near.cubes);
        near
    }

    /// Adds the cubes near a triangle, which is halved until its box is hardly larger than what is near it.
    fn add_triangle(&mut self, corners: [Point; 3]) {
        let lengths = [0, 1, 2].map(|k| distance(corners[k], corners[(k + 1) % 3]));
        let longest = (0..3).max_by(|&i, &j| lengths[i].total_cmp(&lengths[j])).unwrap_or(0);
        if lengths[longest] > MAX_EDGE * self.side {
            let [a, b, c] = [0, 1, 2].map(|k| corners[(longest + k) % 3]);
            let middle = scale(add(a, b), 0.5);
            self.add_triangle([a, middle, c]);
            self.add_triangle([middle, b, c]);
            return;
        }
        let [along_x, along_y, along_z] = [0, 1, 2].map(|axis| {
            let x = corners.map(|p| (p[axis] - self.low[axis]) / self.side);
            let [from, to] = [x[0].min(x[1]).min(x[2]) - 1.0, x[0].max(x[1]).max(x[2]) + 1.0];
            from.floor() as i32..=to.floor() as i32
        });
        let normal = area_vector(corners);
        let reach = REACH * self.side * norm(normal);
        for i in along_x {
            for j in along_y.clone() {
                for k in along_z.clone() {
                    let middle = place([i, j, k], self.low, self.side, 0.5);
                    if dot(normal, sub(middle, corners[0])).abs() <= reach {
                        self.cubes.push([i, j, k]);
                    }
                }
            }
        }
    }

    /// Builds the lattice, with four tets on each side that two cubes share: between their centres and an
    /// edge of the side.
    pub(super) fn lattice(&self) -> Lattice {
        let mut corners: Vec<Cube> = Vec::with_capacity(self.cubes.len() * 8);
        for cube in &self.cubes {
            corners.extend((0..8).map(|k| [0, 1, 2].map(|axis| cube[axis] + (k >> axis & 1))));
        }
        sort_and_dedup(&mut corners);
        let at = |cube: Cube, shift: f64| place(cube, self.low, self.side, shift);
        let mut points: Vec<Point> = corners.iter().map(|&c| at(c, 0.0)).collect();
        points.extend(self.cubes.iter().map(|&c| at(c, 0.5)));
        let corner = |c: Cube| corners.binary_search(&c).map_or(VertexId(0), VertexId::new);
        let mut tets = Vec::new();
        for (i, cube) in self.cubes.iter().enumerate() {
            for axis in 0..3 {
                let mut next = *cube;
                next[axis] += 1;
                let Ok(j) = self.cubes.binary_search(&next) else { continue };
                let [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
                let ring = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[a, b]| {
                    let mut c = next;
                    c[u] += a;
                    c[v] += b;
                    corner(c)
                });
                let middles = [i, j].map(|i| VertexId::new(corners.len() + i));
                // Seen from the first centre, the ring runs clockwise, so these are positive.
                tets.extend((0..4).map(|k| [middles[0], ring[k], ring[(k + 1) % 4], middles[1]]));
            }
        }
        Lattice { points, tets, n_corners: corners.len() }
    }
}

fn place(cube: Cube, low: Point, side: f64, shift: f64) -> Point {
    [0, 1, 2].map(|i| low[i] + (f64::from(cube[i]) + shift) * side)
}

fn sort_and_dedup(cubes: &mut Vec<Cube>) {
    cubes.sort_unstable();
    cubes.dedup();
}
