//! The first edge lengths, stored relative to the walls: near a body they move with the body, whatever has
//! become of the mesh.
//!
//! A size carried by a vertex is lost with the vertex, and mixed where one is inserted between others: while
//! a body with fine edges turned once, a fifth more vertices were inserted than removed. So the size is a
//! function of position. A point belongs to the wall nearest to it; pulled back with that wall to its first
//! position, it has the size that the mesh had there.

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use crate::base::{DisjointSets, Point, Threads, VertexId};
use crate::geometry::rigid::Rigid;
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::distance_squared;
use crate::mesh::{Mesh, mean_edge_lengths};
use crate::moving::current::Current;
use crate::moving::options::Options;
use crate::moving::wall::{NO_NODE, Wall, wall_triangles};
use crate::spatial::{BoxTree, NearestTriangle};

/// A thread fits rigid motions to at least this many triangles.
const MIN_PART: usize = 256;

/// The first edge lengths, and those that edges should have now: the same unless the mesh has been refined.
#[derive(Clone, Debug)]
pub(super) struct Sizes {
    pub(super) first: Arc<SizeMap>,
    pub(super) now: Arc<SizeMap>,
}

impl Sizes {
    /// The sizes of a mesh in its first position.
    pub(super) fn at_first(mesh: &Mesh) -> Self {
        let first = Arc::new(SizeMap::new(mesh.points.clone(), lengths(mesh)));
        Self { now: first.clone(), first }
    }
}

/// The mean edge length at each vertex of tets; 0 at others.
pub(super) fn lengths(mesh: &Mesh) -> Vec<f64> {
    mean_edge_lengths(&mesh.points, mesh.cells.tets().map(|(_, tet)| tet))
}

/// Sizes at places.
#[derive(Clone, Debug)]
pub(super) struct SizeMap {
    /// Places when the walls were at their first position.
    pub(super) places: Vec<Point>,
    /// The size at each place; 0 if there is none.
    pub(super) sizes: Vec<f64>,
    /// Built on first use.
    parts: OnceLock<Parts>,
}

/// The places, grouped by connected part of the walls: each belongs to the part nearest to it.
#[derive(Clone, Debug)]
struct Parts {
    /// The part of each node, identified by one of its nodes.
    of_node: Vec<u32>,
    regions: BTreeMap<u32, Region>,
}

/// The places that belong to one part of the walls.
#[derive(Clone, Debug)]
struct Region {
    places: Vec<Point>,
    sizes: Vec<f64>,
    tree: BoxTree,
}

impl Region {
    fn new(known: Vec<(Point, f64)>) -> Self {
        let (places, sizes): (Vec<Point>, Vec<f64>) = known.into_iter().unzip();
        let boxes: Vec<_> = places.iter().map(|&p| [p, p]).collect();
        Self { places, sizes, tree: BoxTree::new(&boxes) }
    }

    /// The squared distance from `p` to the nearest vertex, and the size there: a mean over the vertices
    /// within an edge length of that one, with weights that decrease with distance. Each is weighted by the
    /// volume that it stands for; otherwise fine sizes, of which there are many, would dominate wherever they
    /// border on coarse ones.
    fn at(&self, p: Point) -> Option<(f64, f64)> {
        let squared = |i: u32| distance_squared(p, self.places[i as usize]);
        let (nearest_squared, nearest, ()) = self.tree.nearest(p, |i| Some((squared(i), ())))?;
        let length = self.sizes[nearest as usize];
        let reach = nearest_squared.sqrt() + length;
        let mut found = Vec::new();
        self.tree.touching([p.map(|x| x - reach), p.map(|x| x + reach)], &mut found);
        let (mut sum, mut weights) = (0.0, 0.0);
        for i in found {
            let part = squared(i) / (reach * reach);
            let weight = (1.0 - part).max(0.0).powi(2) * (self.sizes[i as usize] / length).powi(3);
            (sum, weights) = (sum + weight * self.sizes[i as usize], weights + weight);
        }
        Some((nearest_squared, sum / weights))
    }
}

impl Parts {
    fn of(map: &SizeMap, wall: &Wall, threads: &Threads) -> Self {
        let mut sets = DisjointSets::new(wall.places.len());
        sets.join_all(wall.triangles.iter().map(|t| t.as_slice()));
        let of_node = sets.roots();
        let tree = NearestTriangle::new(&wall.places, &wall.triangles, threads);
        let nearest = tree.closest_all(&map.places, None, threads);
        let mut known: BTreeMap<u32, Vec<_>> = BTreeMap::new();
        for ((place, size), nearest) in map.places.iter().zip(&map.sizes).zip(nearest) {
            let part =
                nearest.map_or(NO_NODE, |nearest| of_node[wall.triangles[nearest.triangle][0].index()]);
            if *size > 0.0 {
                known.entry(part).or_default().push((*place, *size));
            }
        }
        let regions = known.into_iter().map(|(part, known)| (part, Region::new(known))).collect();
        Self { of_node, regions }
    }

    /// The size at a place that belongs to the part of a node; if that part has no sizes, from the nearest
    /// place of any part.
    fn at(&self, node: u32, p: Point) -> f64 {
        let region = self.of_node.get(node as usize).and_then(|part| self.regions.get(part));
        let nearest =
            || self.regions.values().filter_map(|region| region.at(p)).min_by(|a, b| a.0.total_cmp(&b.0));
        region.and_then(|region| region.at(p)).or_else(nearest).map_or(0.0, |(_, size)| size)
    }
}

impl SizeMap {
    pub(super) fn new(places: Vec<Point>, sizes: Vec<f64>) -> Self {
        Self { places, sizes, parts: OnceLock::new() }
    }

    /// The sizes of a mesh as it is, wherever its walls are.
    pub(super) fn anew(now: &Current, options: &Options, threads: &Threads) -> Self {
        let vertices: Vec<VertexId> = (0..now.mesh.points.len()).map(VertexId::new).collect();
        let places = pulled_back(now, &now.mesh.points, &vertices, options, threads);
        Self::new(places.into_iter().map(|(_, place)| place).collect(), lengths(&now.mesh))
    }

    /// The size at some vertices of a mesh whose vertices are at `points`; 0 if no size is known anywhere.
    pub(super) fn at_vertices(
        &self,
        now: &Current,
        points: &[Point],
        vertices: &[VertexId],
        wall: &Wall,
        options: &Options,
        threads: &Threads,
    ) -> Vec<f64> {
        let parts = self.parts.get_or_init(|| Parts::of(self, wall, threads));
        let places = pulled_back(now, points, vertices, options, threads);
        threads.map(places.len(), |v| parts.at(places[v].0, places[v].1))
    }
}

/// Where some vertices of a mesh were when the walls were at their first position, as if each were fixed
/// to the wall triangle nearest to it; with a node of the part of the walls it belongs to, or [`NO_NODE`].
fn pulled_back(
    now: &Current,
    points: &[Point],
    vertices: &[VertexId],
    options: &Options,
    threads: &Threads,
) -> Vec<(u32, Point)> {
    let first = &now.records.first;
    let mut is_driven = vec![false; points.len()];
    now.mover.boundary().iter().for_each(|v| is_driven[v.index()] = true);
    let has_area = |t: &[VertexId; 3]| area_vector(t.map(|v| points[v.index()])) != [0.0; 3];
    let mut triangles = wall_triangles(&now.mesh, &now.mover, options);
    triangles.retain(|t| t.iter().all(|v| is_driven[v.index()]) && has_area(t));
    let mut sets = DisjointSets::new(points.len());
    sets.join_all(triangles.iter().map(|t| t.as_slice()));
    let roots = sets.roots();
    let mut node = vec![NO_NODE; points.len()];
    for (root, its) in roots.iter().zip(&now.records.node).filter(|(_, its)| **its != NO_NODE) {
        node[*root as usize] = *its;
    }
    let tree = NearestTriangle::new(points, &triangles, threads);
    let places: Vec<Point> = vertices.iter().map(|v| points[v.index()]).collect();
    let nearest = tree.closest_all(&places, None, threads);
    let mut used: Vec<usize> = nearest.iter().flatten().map(|nearest| nearest.triangle).collect();
    used.sort_unstable();
    used.dedup();
    let back = |i: usize| Rigid::fit(&triangles[used[i]].map(|v| (points[v.index()], first[v.index()])));
    let back: Vec<Rigid> = threads.map_parts(used.len(), MIN_PART, back);
    threads.map(places.len(), |i| match nearest[i].map(|nearest| nearest.triangle) {
        Some(t) => {
            let back = &back[used.partition_point(|other| *other < t)];
            (node[roots[triangles[t][0].index()] as usize], back.apply(places[i]))
        }
        None => (NO_NODE, first[vertices[i].index()]),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::vector::norm;
    use crate::mesh::shapes::sphere_in_box;
    use crate::moving::MovingMesh;

    #[test]
    fn sizes_go_with_the_wall_that_is_nearest() {
        let mesh = sphere_in_box(6, 6);
        let moving = MovingMesh::new(&mesh, Options::default(), &Threads::single()).unwrap();
        let of = |points: &[Point]| {
            let MovingMesh { now, wall, options, sizes, .. } = &moving;
            let all: Vec<VertexId> = (0..points.len()).map(VertexId::new).collect();
            sizes.first.at_vertices(now, points, &all, wall, options, &Threads::single())
        };
        let first = of(&mesh.points);
        let radius = mesh.points.iter().map(|p| norm(*p)).fold(f64::INFINITY, f64::min);
        // The sphere and the vertices near it turn and shift.
        let is_near = |p: &Point| norm(*p) < 1.3 * radius;
        let moved = |p: Point| [0.05 - p[1], p[0], p[2] + 0.02];
        let points: Vec<Point> =
            mesh.points.iter().map(|p| if is_near(p) { moved(*p) } else { *p }).collect();
        let is_wall = |v: usize| moving.wall.places.contains(&mesh.points[v]);
        let (mut n_near, mut n_walls) = (0, 0);
        for (v, (size, was)) in of(&points).into_iter().zip(first).enumerate() {
            if is_near(&mesh.points[v]) || is_wall(v) {
                assert!((size / was - 1.0).abs() < 1e-9, "{v}: {size} was {was}");
                (n_near, n_walls) =
                    (n_near + usize::from(is_near(&mesh.points[v])), n_walls + usize::from(is_wall(v)));
            }
        }
        assert!(n_near > 100 && n_walls > 100);
    }

    #[test]
    fn where_nothing_moved_sizes_are_about_the_lengths_of_edges() {
        let mesh = sphere_in_box(6, 6);
        let moving = MovingMesh::new(&mesh, Options::default(), &Threads::single()).unwrap();
        let MovingMesh { now, wall, options, sizes, .. } = &moving;
        let all: Vec<VertexId> = (0..mesh.points.len()).map(VertexId::new).collect();
        let at = sizes.now.at_vertices(now, &mesh.points, &all, wall, options, &Threads::single());
        let ratios: Vec<f64> = at.iter().zip(lengths(&mesh)).map(|(size, length)| size / length).collect();
        assert!(ratios.iter().all(|ratio| (0.6..1.6).contains(ratio)), "{ratios:?}");
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        assert!((mean - 1.0).abs() < 0.05, "{mean}");
    }
}
