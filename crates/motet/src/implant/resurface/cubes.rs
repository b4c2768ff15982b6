//! Cubes near a surface, and the tets of the body-centred lattice among them.

use crate::base::{Point, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{dot, norm, sub};
use crate::mesh::{Surface, bounds};
use crate::meshing::EDGE_OVER_SIDE;

type Cube = [i32; 3];

/// More cubes than this, those of neighbours counted twice, are too many.
const MOST: f64 = 2e9;

/// So many cubes are kept before those that are there twice go.
const FIRST: usize = 1 << 20;

/// Cubes of one size, in rising order.
pub(super) struct Cubes {
    low: Point,
    side: f64,
    cubes: Vec<Cube>,
}

/// Vertices and tets. Edges between middles or between corners are *long*, the others short.
pub(super) struct Lattice {
    pub(super) points: Vec<Point>,
    pub(super) tets: Vec<[VertexId; 4]>,
    /// How many vertices are corners of cubes; behind them come middles.
    pub(super) n_corners: usize,
}

impl Cubes {
    /// Those that triangles come near, by a side at least; `None` where that would be far too many.
    pub(super) fn near(surface: &Surface, edge: f64) -> Option<Self> {
        let side = edge / EDGE_OVER_SIDE;
        let corners: Vec<Point> =
            surface.triangles.as_flattened().iter().map(|v| surface.points[v.index()]).collect();
        // A place that no coordinate of a surface is likely to have a whole number of sides from.
        let low = bounds(&corners).unwrap_or_default()[0].map(|x| x - 0.618_033_988_749 * side);
        let ranges = |t: usize| -> [[f64; 2]; 3] {
            let corners = surface.corners(t);
            std::array::from_fn(|axis| {
                let x = corners.map(|p| (p[axis] - low[axis]) / side);
                [(x[0].min(x[1]).min(x[2]) - 1.0).floor(), (x[0].max(x[1]).max(x[2]) + 1.0).floor()]
            })
        };
        let expected = |t: usize| ranges(t).iter().map(|[from, to]| to - from + 1.0).product::<f64>();
        if (0..surface.triangles.len()).map(expected).sum::<f64>() > MOST {
            return None;
        }
        let mut cubes: Vec<Cube> = Vec::new();
        let mut full = FIRST;
        for t in 0..surface.triangles.len() {
            let corners = surface.corners(t);
            let normal = area_vector(corners);
            let reach = 3.0 * side * norm(normal);
            let [along_x, along_y, along_z] = ranges(t).map(|[from, to]| from as i32..=to as i32);
            for i in along_x {
                for j in along_y.clone() {
                    for k in along_z.clone() {
                        let middle = place([i, j, k], low, side, 0.5);
                        if dot(normal, sub(middle, corners[0])).abs() <= reach {
                            cubes.push([i, j, k]);
                        }
                    }
                }
            }
            // Neighbours have most of their cubes in common.
            if cubes.len() > full {
                sort_once(&mut cubes);
                full = FIRST.max(2 * cubes.len());
            }
        }
        sort_once(&mut cubes);
        Some(Self { low, side, cubes })
    }

    /// Four tets on each side that two cubes share: between their middles and an edge of the side.
    pub(super) fn lattice(&self) -> Lattice {
        let mut corners: Vec<Cube> = Vec::with_capacity(self.cubes.len() * 8);
        for cube in &self.cubes {
            corners.extend((0..8).map(|k| [0, 1, 2].map(|axis| cube[axis] + (k >> axis & 1))));
        }
        sort_once(&mut corners);
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
                // Seen from the first middle the ring runs clockwise, so these are positive.
                tets.extend((0..4).map(|k| [middles[0], ring[k], ring[(k + 1) % 4], middles[1]]));
            }
        }
        Lattice { points, tets, n_corners: corners.len() }
    }
}

fn place(cube: Cube, low: Point, side: f64, shift: f64) -> Point {
    [0, 1, 2].map(|i| low[i] + (f64::from(cube[i]) + shift) * side)
}

fn sort_once(cubes: &mut Vec<Cube>) {
    cubes.sort_unstable();
    cubes.dedup();
}
