//! Detection of boundary layers: tets that are thin on purpose.
//!
//! ```text
//!     v2 ------- .
//!     |  layer 2
//!     v1 ------- .
//!     |  layer 1
//!     w ======== .  wall
//! ```
//!
//! A column rises from a wall vertex along the normal of the wall, edge by edge, each much shorter than the
//! edges of the wall. A tet belongs to a layer if its vertices stand in the columns of one wall facet, at
//! most one level apart. It is well shaped if it is so after it has been stretched along the normal to the
//! width of the facet.
//!
//! If a mesh has layers, most of its low-quality tets are thin on purpose; if only a minority of them are,
//! the mesh is taken to have no layers. Slivers in a mesh without layers have no short edge, and the short
//! edges of needles do not stand side by side in columns, so neither is mistaken for a layer tet.

use crate::base::{Csr, MaybeId, Point, VertexId};
use crate::geometry::quality::eas;
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{add, dot, norm, scale, sub};

/// A column's edges are shorter than this fraction of the mean length of the wall edges at its foot.
const MAX_EDGE_RATIO: f64 = 0.6;
/// Cosine of 35 degrees: a column leans by less from the normal of the wall, and each edge of it from the one
/// below.
const MIN_COS_LEAN: f64 = 0.82;
/// An edge of a column is at most this many times as long as the edge below it.
const GROWTH: f64 = 3.0;
/// Layers are looked for only if at least this fraction of the sampled wall vertices has a column.
const MIN_COLUMN_FRACTION: f64 = 0.4;
/// Largest number of wall vertices that are sampled for this test.
const SAMPLE: usize = 256;
/// Columns have fewer levels than this.
const MAX_LEVELS: u32 = 64;

/// For each tet in `low` (indices into `tets`), whether it belongs to a boundary layer; all `false` if fewer
/// than half of them do. `low` lists the tets whose EAS is below `min_eas`, `tets` are oriented, and `walls`
/// are the facets on the boundary, between regions, and with a triangle.
pub(crate) fn are_layers(
    points: &[Point],
    tets: &[[VertexId; 4]],
    walls: &[[VertexId; 3]],
    low: &[usize],
    min_eas: f64,
) -> Vec<bool> {
    let layers = if low.is_empty() { None } else { Layers::of(points, tets, walls) };
    let is_thin =
        |&t: &usize| layers.as_ref().is_some_and(|layers| layers.is_layer_tet(points, tets[t], min_eas));
    let are_thin: Vec<bool> = low.iter().map(is_thin).collect();
    let n_thin = are_thin.iter().filter(|is| **is).count();
    if 2 * n_thin < low.len() { vec![false; low.len()] } else { are_thin }
}

/// The columns that the vertices stand in.
struct Layers {
    /// For each vertex, its place in a column.
    columns: Vec<InColumn>,
    /// For each foot, the unit direction in which its column rises; zero elsewhere.
    directions: Vec<Point>,
}

/// The place of a vertex in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct InColumn {
    /// The wall vertex at the foot of the column; none if the vertex stands in no column.
    foot: MaybeId<VertexId>,
    /// The number of edges between them.
    level: u32,
}

impl InColumn {
    /// The place of a vertex that stands in no column.
    const NONE: Self = Self { foot: MaybeId::NONE, level: 0 };

    fn new(foot: VertexId, level: u32) -> Self {
        Self { foot: foot.into(), level }
    }
}

impl Layers {
    /// The layers of oriented `tets` whose boundary, interfaces and labelled facets are `walls`; `None` if
    /// there are none.
    fn of(points: &[Point], tets: &[[VertexId; 4]], walls: &[[VertexId; 3]]) -> Option<Self> {
        let n = points.len();
        let mut at_walls = vec![Foot::default(); n];
        let mut normals = Vec::with_capacity(walls.len());
        for facet in walls {
            let corners = facet.map(|v| points[v.index()]);
            let normal = area_vector(corners);
            normals.push(scale(normal, 1.0 / norm(normal)));
            for i in 0..3 {
                let foot = &mut at_walls[facet[i].index()];
                foot.width +=
                    norm(sub(corners[(i + 1) % 3], corners[i])) + norm(sub(corners[(i + 2) % 3], corners[i]));
                foot.n_edges += 2;
            }
        }
        let vertex_to_walls = Csr::from_pairs(n, || {
            (0..).zip(walls).flat_map(|(wall, facet)| facet.map(|v| (v.index(), wall)))
        });
        let feet: Vec<VertexId> =
            (0..n).map(VertexId::new).filter(|v| at_walls[v.index()].n_edges > 0).collect();
        let sample: Vec<VertexId> = feet.iter().copied().step_by(feet.len() / SAMPLE + 1).collect();
        let vertex_to_tets = stars(n, tets, |v| sample.binary_search(&v).is_ok());
        let climber = Climber { points, tets, vertex_to_tets, normals, vertex_to_walls };
        let has_column = |v: &&VertexId| climber.first(**v, &at_walls[v.index()]).is_some();
        let n_columns = sample.iter().filter(has_column).count();
        if (n_columns as f64) < MIN_COLUMN_FRACTION * sample.len() as f64 || feet.is_empty() {
            return None;
        }
        let climber = Climber { vertex_to_tets: stars(n, tets, |_| true), ..climber };
        let mut columns = vec![InColumn::NONE; n];
        feet.iter().for_each(|&v| columns[v.index()] = InColumn::new(v, 0));
        let mut directions = vec![[0.0; 3]; n];
        for &foot in &feet {
            directions[foot.index()] = climber.climb(foot, &at_walls[foot.index()], &mut columns);
        }
        Some(Self { columns, directions })
    }

    /// Whether a tet belongs to a layer and is well shaped there: its EAS is at least `min_eas` after it has
    /// been stretched along the normal until it is as high as it is wide.
    fn is_layer_tet(&self, points: &[Point], vertices: [VertexId; 4], min_eas: f64) -> bool {
        let columns = vertices.map(|v| self.columns.get(v.index()).copied().unwrap_or(InColumn::NONE));
        let levels = columns.map(|c| c.level);
        let mut feet: Vec<VertexId> = columns.iter().filter_map(|c| c.foot.get()).collect();
        let are_in_columns = feet.len() == columns.len();
        feet.sort_unstable();
        feet.dedup();
        let step = levels.into_iter().max().unwrap_or(0) - levels.into_iter().min().unwrap_or(0);
        if !are_in_columns || feet.len() != 3 || step != 1 {
            return false;
        }
        let corners = vertices.map(|v| points[v.index()]);
        let normal = feet.iter().fold([0.0; 3], |sum, foot| add(sum, self.directions[foot.index()]));
        eas(corners) > 0.0 && stretched_eas(corners, scale(normal, 1.0 / norm(normal))) >= min_eas
    }
}

/// The tets around each of `n` vertices that satisfy `is_wanted`; an empty list for any other vertex.
fn stars(n: usize, tets: &[[VertexId; 4]], is_wanted: impl Fn(VertexId) -> bool) -> Csr<u32> {
    let is_wanted: Vec<bool> = (0..n).map(|v| is_wanted(VertexId::new(v))).collect();
    let all = || (0..).zip(tets).flat_map(|(t, tet)| tet.map(|v| (v.index(), t)));
    Csr::from_pairs(n, || all().filter(|(v, _)| is_wanted[*v]))
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

/// The wall around the foot of a column.
#[derive(Clone, Copy, Default)]
struct Foot {
    /// Sum of the lengths of the wall edges at the vertex, each counted once per wall facet.
    width: f64,
    n_edges: u32,
}

impl Foot {
    fn limit(&self) -> f64 {
        MAX_EDGE_RATIO * self.width / f64::from(self.n_edges)
    }
}

struct Climber<'a> {
    points: &'a [Point],
    tets: &'a [[VertexId; 4]],
    vertex_to_tets: Csr<u32>,
    /// The unit normal of each wall facet.
    normals: Vec<Point>,
    vertex_to_walls: Csr<u32>,
}

impl Climber<'_> {
    /// The far end of the shortest edge at `from` that is shorter than `limit` and satisfies `is_upright`,
    /// and the vector to it.
    fn above(
        &self,
        from: VertexId,
        limit: f64,
        is_upright: impl Fn(Point, f64) -> bool,
    ) -> Option<(VertexId, Point)> {
        let start = self.points[from.index()];
        let mut best: Option<(f64, VertexId, Point)> = None;
        let star = self.vertex_to_tets.list(from.index());
        for v in star.iter().flat_map(|&t| self.tets[t as usize]).filter(|&v| v != from) {
            let edge = sub(self.points[v.index()], start);
            let length = norm(edge);
            let is_shorter = best.is_none_or(|b| (length, v) < (b.0, b.1));
            if length < limit && is_shorter && is_upright(edge, length) {
                best = Some((length, v, edge));
            }
        }
        best.map(|(_, v, edge)| (v, edge))
    }

    /// The first vertex above a foot: upright on one of the wall facets there. It may itself lie on another
    /// wall, such as an inlet.
    fn first(&self, foot: VertexId, wall: &Foot) -> Option<(VertexId, Point)> {
        self.above(foot, wall.limit(), |edge, length| {
            let walls = self.vertex_to_walls.list(foot.index());
            walls.iter().any(|&wall| dot(edge, self.normals[wall as usize]).abs() > MIN_COS_LEAN * length)
        })
    }

    /// Follows the column of a wall vertex upward, level by level, until no short edge leads on, and records
    /// its vertices in `columns`. Returns the unit direction of its first edge; zero if there is none.
    fn climb(&self, foot: VertexId, wall: &Foot, columns: &mut [InColumn]) -> Point {
        let mut next = self.first(foot, wall);
        let first = next.map_or([0.0; 3], |(_, edge)| scale(edge, 1.0 / norm(edge)));
        for level in 1..MAX_LEVELS {
            let Some((vertex, up)) = next else { break };
            let column = &mut columns[vertex.index()];
            if *column != InColumn::NONE && *column != InColumn::new(vertex, 0) {
                break;
            }
            *column = InColumn::new(foot, level);
            let step = norm(up);
            next = self.above(vertex, (GROWTH * step).min(wall.limit()), |edge, length| {
                dot(edge, up) > MIN_COS_LEAN * length * step
            });
        }
        first
    }
}
