//! The rigid layer: vertices near a wall that keep their position relative to it.
//!
//! ```text
//!     x            A vertex x of the layer has its foot f on the nearest facet of
//!     |  o         the wall, with weights b, and its offset o = x - f. The wall
//!  ---f------      moves: the foot goes along with the facet, f' = f + sum b d,
//!                  and the offset turns with the wall at the foot, x' = f' + R o.
//! ```
//!
//! R is blended from the rotations of the facet's vertices (see `rotation`). The facet's own rotation would
//! jump where the foot passes from one facet to the next, and shear thin cells that stand across the edge.
//! Rotations keep lengths, so every vertex keeps its distance from its foot. The distance between two
//! vertices of the layer is not kept where the wall stretches or bends: there the cells of the layer stretch
//! along with the wall.
//!
//! Where the wall has a crease, neighbours may have their feet on different sides of it. Each would move with
//! its own side, so both are left to the graph.

use crate::base::{Error, Point, Result, Threads, VertexId};
use crate::geometry::triangle;
use crate::geometry::vector::{add, distance, sub};
use crate::mesh::Cells;
use crate::motion::options::{Extent, FacetSet};
use crate::motion::rotation::{Wall, mean, rotation_change};
use crate::spatial::NearestTriangle;

/// Largest distance between the feet of neighbours, relative to the distance between the neighbours. In a
/// vessel with branches, bent, twisted and widened, prisms of the layer keep at least 0.46 of their thickness
/// and cells invert where this is infinite; at 1.5, 2 and 3 none do, and 0.65, 0.69 and 0.66 are kept.
const MAX_FOOT_RATIO: f64 = 2.0;

/// One vertex of the layer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Member {
    pub(crate) vertex: VertexId,
    /// The nearest triangle of the wall, and the weights of its foot there.
    triangle: u32,
    weights: [f64; 3],
    offset: Point,
}

/// A wall and the vertices that move with it.
#[derive(Debug)]
pub(crate) struct Layer {
    wall: Wall,
    /// The node of each of the wall's vertices.
    wall_nodes: Vec<u32>,
    pub(crate) members: Vec<Member>,
}

impl Layer {
    /// Collects those of `candidates` that are within `extent` of the wall. `node` returns the driven node of
    /// a vertex.
    pub(crate) fn new(
        points: &[Point],
        cells: &Cells,
        wall: &FacetSet,
        extent: Extent,
        candidates: &[VertexId],
        node: impl Fn(VertexId) -> Option<u32>,
    ) -> Result<Self> {
        let mut vertices: Vec<VertexId> = wall.rings.items().to_vec();
        vertices.sort_unstable();
        vertices.dedup();
        if wall.triangles().next().is_none() {
            return Err(Error::options(format!("the wall {} of the rigid layer has no facets", wall.name)));
        }
        let wall_nodes = vertices.iter().map(|&v| {
            node(v).ok_or_else(|| {
                Error::input("is on the wall of the rigid layer, but its motion is not given")
                    .at(format!("vertex {v}"))
            })
        });
        let wall_nodes = wall_nodes.collect::<Result<Vec<u32>>>()?;
        let local = |v: VertexId| vertices.binary_search(&v).expect("collected from the same rings") as u32;
        let triangles: Vec<[VertexId; 3]> = wall.triangles().collect();
        let search = NearestTriangle::new(points, &triangles, &Threads::single());
        let triangles: Vec<[u32; 3]> = triangles.iter().map(|t| t.map(local)).collect();
        let wall_points: Vec<Point> = vertices.iter().map(|v| points[v.index()]).collect();
        let reach = match extent {
            Extent::Distance(distance) => distance,
            Extent::Cells(_) => f64::INFINITY,
        };
        let near = match extent {
            Extent::Distance(_) => None,
            Extent::Cells(n) => Some(within_cells(cells, points.len(), &vertices, n)),
        };
        let is_near = |v: VertexId| near.as_ref().is_none_or(|near| near[v.index()]);
        let mut members = Vec::new();
        for &vertex in candidates.iter().filter(|v| is_near(**v)) {
            let p = points[vertex.index()];
            if let Some(foot) = search.closest_within(p, reach) {
                let (triangle, weights, offset) = (foot.triangle as u32, foot.weights, sub(p, foot.point));
                members.push(Member { vertex, triangle, weights, offset });
            }
        }
        let between = spans_crease(points, cells, &vertices, &members);
        members.retain(|m| !between[m.vertex.index()]);
        Ok(Self { wall: Wall::new(&wall_points, triangles), wall_nodes, members })
    }

    /// Displacements of all members, given those of the driven nodes.
    pub(crate) fn displacements(&self, driven: &[Point], threads: &Threads) -> Vec<MemberMotion> {
        let of_wall = |v: u32| driven[self.wall_nodes[v as usize] as usize];
        let rotations = self.wall.rotations(of_wall, threads);
        threads.map(self.members.len(), |i| {
            let m = &self.members[i];
            let corners = self.wall.triangle(m.triangle as usize);
            let foot = triangle::at(corners.map(of_wall), m.weights);
            let parts = corners.iter().zip(m.weights).map(|(&v, w)| (w, rotations[v as usize]));
            MemberMotion { foot, rotation: rotation_change(mean(parts), m.offset) }
        })
    }

    /// The value at the foot of each member, given the values at the driven nodes.
    pub(crate) fn at_feet(&self, driven: &[Point]) -> Vec<Point> {
        let of_wall = |v: u32| driven[self.wall_nodes[v as usize] as usize];
        let foot = |m: &Member| triangle::at(self.wall.triangle(m.triangle as usize).map(of_wall), m.weights);
        self.members.iter().map(foot).collect()
    }

    /// Whether each member is an outer one, which shares a cell with a vertex that is neither a member nor
    /// driven.
    pub(crate) fn outer(
        &self,
        cells: &Cells,
        is_driven: impl Fn(VertexId) -> bool,
        n_points: usize,
    ) -> Vec<bool> {
        let mut is_member = vec![false; n_points];
        self.members.iter().for_each(|m| is_member[m.vertex.index()] = true);
        let mut is_outer = vec![false; n_points];
        for (_, _, vertices) in cells.iter() {
            if vertices.iter().any(|&v| !is_member[v.index()] && !is_driven(v)) {
                vertices.iter().for_each(|v| is_outer[v.index()] = true);
            }
        }
        self.members.iter().map(|m| is_outer[m.vertex.index()]).collect()
    }
}

/// How a member of the layer has moved, in two parts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MemberMotion {
    /// The displacement of its foot.
    pub(crate) foot: Point,
    /// The change of its offset by rotation.
    pub(crate) rotation: Point,
}

impl MemberMotion {
    pub(crate) fn total(self) -> Point {
        add(self.foot, self.rotation)
    }
}

/// Which vertices share a cell with another one whose foot is more than [`MAX_FOOT_RATIO`] times as far from
/// theirs as they are from each other. Where the wall has a crease, each would follow another side, and the
/// cells between would be crushed: they are left to the graph.
fn spans_crease(points: &[Point], cells: &Cells, wall: &[VertexId], members: &[Member]) -> Vec<bool> {
    let mut foot = vec![None; points.len()];
    wall.iter().for_each(|v| foot[v.index()] = Some(points[v.index()]));
    members.iter().for_each(|m| foot[m.vertex.index()] = Some(sub(points[m.vertex.index()], m.offset)));
    let mut between = vec![false; points.len()];
    for (_, _, vertices) in cells.iter() {
        for (i, &a) in vertices.iter().enumerate() {
            for &b in &vertices[..i] {
                let (Some(foot_a), Some(foot_b)) = (foot[a.index()], foot[b.index()]) else { continue };
                if distance(foot_a, foot_b) > MAX_FOOT_RATIO * distance(points[a.index()], points[b.index()])
                {
                    between[a.index()] = true;
                    between[b.index()] = true;
                }
            }
        }
    }
    between
}

/// Which vertices are at most `n` cells away from any of `from`. Every ring is a pass over all cells: for the
/// few rings of a layer, this is cheaper than listing the cells of each vertex.
fn within_cells(cells: &Cells, n_points: usize, from: &[VertexId], n: usize) -> Vec<bool> {
    let mut near = vec![false; n_points];
    from.iter().for_each(|v| near[v.index()] = true);
    for _ in 0..n {
        let before = near.clone();
        for (_, kind, vertices) in cells.iter() {
            if vertices.iter().any(|v| before[v.index()]) && kind.dim() == Some(3) {
                vertices.iter().for_each(|v| near[v.index()] = true);
            }
        }
        if near == before {
            break;
        }
    }
    near
}
