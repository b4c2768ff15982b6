//! Boundary layers: tets that are thin on purpose.
//!
//! ```text
//!     v2 ------- .        A column rises from a wall vertex along the normal of the wall, edge by edge, each much shorter than
//!     |  layer 2          the edges of the wall. A tet belongs to a layer when its vertices stand in the columns of one
//!     v1 ------- .        wall facet, at most one level apart. It is well shaped when it is so after it has been
//!     |  layer 1          stretched along the normal to the width of the facet.
//!     w ======== .  wall
//! ```
//! A sliver in a mesh without layers has no short edge, and a needle's short edge does not stand in columns side by side: neither is taken
//! for a layer.

use crate::base::{Csr, Point, TetId, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, dot, norm, scale, sub};
use crate::kernel::{Complex, Star};

/// A column's edges are shorter than this part of the wall's edges at its foot.
const SHORT: f64 = 0.6;
/// A column leans from the normal by less: cosine of 35 degrees.
const UPRIGHT: f64 = 0.82;
/// An edge of a column is at most so many times as long as the one below.
const GROWTH: f64 = 3.0;
/// Layers are looked for only where this part of some wall vertices has a column.
const ENOUGH: f64 = 0.1;
/// How many wall vertices are looked at to tell.
const SAMPLE: usize = 256;
/// No column is higher.
const MOST_LEVELS: u32 = 64;

/// Which vertex stands in which column.
pub(super) struct Layers {
    /// For each vertex the wall vertex at the foot of its column, and how many edges it stands above; [`NO_COLUMN`].
    columns: Vec<(VertexId, u32)>,
    /// For each foot the way in which its column rises.
    ways: Vec<Point>,
}

const NO_COLUMN: (VertexId, u32) = (VertexId(u32::MAX), 0);

impl Layers {
    /// The layers of a mesh; `None` where it has none.
    pub(super) fn of(complex: &Complex) -> Option<Self> {
        let n = complex.n_vertex_slots();
        let mut walls = vec![Foot::default(); n];
        let mut normals = Vec::new();
        for (_, wall) in complex.walls() {
            let facet = complex.facet(wall.sides[0]);
            let points = facet.map(|v| complex.point(v));
            let normal = area_vector(points);
            normals.push(scale(normal, 1.0 / norm(normal)));
            for i in 0..3 {
                let foot = &mut walls[facet[i].index()];
                foot.width +=
                    norm(sub(points[(i + 1) % 3], points[i])) + norm(sub(points[(i + 2) % 3], points[i]));
                foot.n_edges += 2;
            }
        }
        let facets: Vec<_> = complex.walls().map(|(_, wall)| complex.facet(wall.sides[0])).collect();
        let vertex_to_walls = Csr::from_pairs(n, || {
            (0..).zip(&facets).flat_map(|(wall, facet)| facet.map(|v| (v.index(), wall)))
        });
        let feet: Vec<VertexId> =
            (0..n).map(VertexId::new).filter(|v| walls[v.index()].n_edges > 0).collect();
        let mut climber = Climber { complex, star: Star::default(), normals, vertex_to_walls };
        let sample = feet.iter().step_by(feet.len() / SAMPLE + 1);
        let n_sampled = sample.clone().count();
        let n_columns = sample.filter(|v| climber.first(**v, &walls[v.index()]).is_some()).count();
        if (n_columns as f64) < ENOUGH * n_sampled as f64 || feet.is_empty() {
            return None;
        }
        let mut columns = vec![NO_COLUMN; n];
        feet.iter().for_each(|&v| columns[v.index()] = (v, 0));
        let mut ways = vec![[0.0; 3]; n];
        for &foot in &feet {
            ways[foot.index()] = climber.climb(foot, &walls[foot.index()], &mut columns);
        }
        Some(Self { columns, ways })
    }

    /// Whether a tet of the first mesh belongs to a layer and is well shaped there: at least `min_eas` when it is as high as it is wide.
    pub(super) fn holds(&self, complex: &Complex, tet: TetId, min_eas: f64) -> bool {
        let vertices = complex.vertices(tet);
        let columns = vertices.map(|v| self.columns.get(v.index()).copied().unwrap_or(NO_COLUMN));
        let levels = columns.map(|c| c.1);
        let mut feet: Vec<VertexId> = columns.iter().map(|c| c.0).collect();
        feet.sort_unstable();
        feet.dedup();
        let step = levels.into_iter().max().unwrap_or(0) - levels.into_iter().min().unwrap_or(0);
        if columns.contains(&NO_COLUMN) || feet.len() != 3 || step != 1 {
            return false;
        }
        let corners = complex.corners(tet);
        let way = feet.iter().fold([0.0; 3], |sum, foot| add(sum, self.ways[foot.index()]));
        eas(corners) > 0.0 && stretched_eas(corners, scale(way, 1.0 / norm(way))) >= min_eas
    }
}

/// The EAS of a tet stretched along `normal` until it is as high as it is wide.
fn stretched_eas(corners: [Point; 4], normal: Point) -> f64 {
    let heights = corners.map(|p| dot(sub(p, corners[0]), normal));
    let height = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        - heights.iter().copied().fold(f64::INFINITY, f64::min);
    let mut flat = corners;
    for i in 0..4 {
        flat[i] = sub(corners[i], scale(normal, heights[i]));
    }
    let mut width = 0.0f64;
    for i in 0..4 {
        for j in 0..i {
            width = width.max(norm(sub(flat[i], flat[j])));
        }
    }
    let mut stretched = flat;
    for i in 0..4 {
        stretched[i] = add(flat[i], scale(normal, heights[i] * width / height));
    }
    eas(stretched)
}

/// What a column stands on.
#[derive(Clone, Copy, Default)]
struct Foot {
    /// The sum of the lengths of the edges of the walls at the vertex.
    width: f64,
    n_edges: u32,
}

impl Foot {
    fn limit(&self) -> f64 {
        SHORT * self.width / f64::from(self.n_edges)
    }
}

struct Climber<'a> {
    complex: &'a Complex,
    star: Star,
    /// Of each wall.
    normals: Vec<Point>,
    vertex_to_walls: Csr<u32>,
}

impl Climber<'_> {
    /// The end of the shortest edge from a vertex that `is_upright` and shorter than `limit`, and the way there.
    fn above(
        &mut self,
        from: VertexId,
        limit: f64,
        is_upright: impl Fn(&Self, Point, f64) -> bool,
    ) -> Option<(VertexId, Point)> {
        let complex = self.complex;
        let mut star = std::mem::take(&mut self.star);
        star.gather(complex, from);
        let start = complex.point(from);
        let mut best: Option<(f64, VertexId, Point)> = None;
        for v in star.tets.iter().flat_map(|&t| complex.vertices(t)).filter(|&v| v != from) {
            let way = sub(complex.point(v), start);
            let length = norm(way);
            let is_shorter = best.is_none_or(|b| (length, v) < (b.0, b.1));
            if length < limit && is_shorter && is_upright(self, way, length) {
                best = Some((length, v, way));
            }
        }
        self.star = star;
        best.map(|(_, v, way)| (v, way))
    }

    /// The first vertex of a column: upright on one of the walls at its foot. It may lie on another wall, that of an inlet say.
    fn first(&mut self, foot: VertexId, wall: &Foot) -> Option<(VertexId, Point)> {
        self.above(foot, wall.limit(), |climber, way, length| {
            let walls = climber.vertex_to_walls.list(foot.index());
            walls.iter().any(|&wall| dot(way, climber.normals[wall as usize]).abs() > UPRIGHT * length)
        })
    }

    /// Follows the column of a wall vertex up, level by level, until no short edge leads on; the way in which it sets out.
    fn climb(&mut self, foot: VertexId, wall: &Foot, columns: &mut [(VertexId, u32)]) -> Point {
        let mut next = self.first(foot, wall);
        let first = next.map_or([0.0; 3], |(_, way)| scale(way, 1.0 / norm(way)));
        for level in 1..MOST_LEVELS {
            let Some((vertex, up)) = next else { break };
            let column = &mut columns[vertex.index()];
            if *column != NO_COLUMN && *column != (vertex, 0) {
                break;
            }
            *column = (foot, level);
            let step = norm(up);
            next = self.above(vertex, (GROWTH * step).min(wall.limit()), |_, way, length| {
                dot(way, up) > UPRIGHT * length * step
            });
        }
        first
    }
}
