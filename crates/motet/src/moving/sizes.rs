//! The lengths that edges had, remembered beside the walls: near a body they go with the body, whatever has become of the mesh.
//!
//! A size that a vertex carries is lost with the vertex, and mixed where one is inserted between others: while a body with fine edges turned once, a fifth more vertices came. So sizes
//! are asked of the place. A place belongs to the wall nearest to it; taken back with that wall to where it was at first, it has the size that the mesh had there.

use std::sync::{Arc, OnceLock};

use crate::base::{Point, Sets, Threads, VertexId};
use crate::geometry::rigid::Rigid;
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::distance_squared;
use crate::mesh::{Mesh, mean_edge_lengths};
use crate::moving::now::Now;
use crate::moving::options::Options;
use crate::moving::wall::{NO_NODE, Wall, wall_triangles};
use crate::spatial::{BoxTree, NearestTriangle};

/// The lengths of edges at first, and those that edges are to have now: the same but where the mesh was refined since.
#[derive(Clone, Debug)]
pub(super) struct Sizes {
    pub(super) first: Arc<Remembered>,
    pub(super) now: Arc<Remembered>,
}

impl Sizes {
    /// Of a mesh in its first place.
    pub(super) fn at_first(mesh: &Mesh) -> Self {
        let first = Arc::new(Remembered::new(mesh.points.clone(), lengths(mesh)));
        Self { now: first.clone(), first }
    }
}

/// How long edges are at each vertex of tets; 0 at others.
pub(super) fn lengths(mesh: &Mesh) -> Vec<f64> {
    mean_edge_lengths(&mesh.points, mesh.cells.tets().map(|(_, tet)| tet))
}

/// Sizes at places.
#[derive(Clone, Debug)]
pub(super) struct Remembered {
    /// With the walls where they were at first.
    pub(super) places: Vec<Point>,
    /// 0: none.
    pub(super) sizes: Vec<f64>,
    /// By part of the walls; made when it is asked for first.
    parts: OnceLock<Parts>,
}

/// Which place belongs to which part of the walls: those that hang together are one.
#[derive(Clone, Debug)]
struct Parts {
    /// The part of each node.
    of_node: Vec<u32>,
    near: Vec<Near>,
}

/// What belongs to one part of the walls.
#[derive(Clone, Debug)]
struct Near {
    places: Vec<Point>,
    sizes: Vec<f64>,
    tree: BoxTree,
}

impl Near {
    fn new(known: Vec<(Point, f64)>) -> Self {
        let (places, sizes): (Vec<Point>, Vec<f64>) = known.into_iter().unzip();
        let boxes: Vec<_> = places.iter().map(|&p| [p, p]).collect();
        Self { places, sizes, tree: BoxTree::new(&boxes) }
    }

    /// The squared distance of the nearest vertex from a place, and the size there: the mean over the vertices within an edge of that one, the nearer the more. Each counts as
    /// the volume that it stands for, or fine sizes, of which there are many, would win wherever they border on coarse ones.
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
    fn of(remembered: &Remembered, wall: &Wall, threads: &Threads) -> Self {
        let mut sets = Sets::new(wall.places.len());
        join(&mut sets, &wall.triangles);
        let mut number = vec![u32::MAX; wall.places.len()];
        let mut n_parts = 0;
        let mut of = |root: u32| {
            let number = &mut number[root as usize];
            if *number == u32::MAX {
                (*number, n_parts) = (n_parts, n_parts + 1);
            }
            *number
        };
        let of_node: Vec<u32> = (0..wall.places.len() as u32).map(|node| of(sets.root(node))).collect();
        let mut known = vec![Vec::new(); (n_parts as usize).max(1)];
        let tree = NearestTriangle::new(&wall.places, &wall.triangles, threads);
        let nearest = tree.closest_all(&remembered.places, None, threads);
        for ((place, size), nearest) in remembered.places.iter().zip(&remembered.sizes).zip(nearest) {
            let part = nearest.map_or(0, |nearest| of_node[wall.triangles[nearest.triangle][0].index()]);
            if *size > 0.0 {
                known[part as usize].push((*place, *size));
            }
        }
        Self { of_node, near: known.into_iter().map(Near::new).collect() }
    }

    /// The size at a place that belongs to a part; where that has none, or is not known, of whatever is nearest.
    fn at(&self, part: Option<u32>, p: Point) -> f64 {
        let of_part = part.and_then(|part| self.near[part as usize].at(p));
        let nearest = || self.near.iter().filter_map(|near| near.at(p)).min_by(|a, b| a.0.total_cmp(&b.0));
        of_part.or_else(nearest).map_or(0.0, |(_, size)| size)
    }
}

impl Remembered {
    pub(super) fn new(places: Vec<Point>, sizes: Vec<f64>) -> Self {
        Self { places, sizes, parts: OnceLock::new() }
    }

    /// Of a mesh as it is, wherever its walls are.
    pub(super) fn anew(now: &Now, options: &Options, threads: &Threads) -> Self {
        let points = &now.mesh.points;
        let back = WayBack::of(now, points, options, threads);
        Self::new(back.places.into_iter().map(|(_, place)| place).collect(), lengths(&now.mesh))
    }

    /// The size at each vertex of a mesh whose vertices are at `points`; 0 where none is known anywhere.
    pub(super) fn at_vertices(
        &self,
        (now, points): (&Now, &[Point]),
        wall: &Wall,
        options: &Options,
        threads: &Threads,
    ) -> Vec<f64> {
        let parts = self.parts.get_or_init(|| Parts::of(self, wall, threads));
        let WayBack { node, places } = WayBack::of(now, points, options, threads);
        let part = |component: u32| node.get(component as usize).filter(|node| **node != NO_NODE);
        threads.map(places.len(), |v| {
            let (component, place) = places[v];
            parts.at(part(component).map(|node| parts.of_node[*node as usize]), place)
        })
    }
}

/// Where vertices were when walls were at first: each as if it were fixed to the wall nearest to it.
struct WayBack {
    /// By the first vertex of what hangs together: a node of it, or [`NO_NODE`].
    node: Vec<u32>,
    /// Of each vertex: what hangs together with the wall nearest to it, and its place.
    places: Vec<(u32, Point)>,
}

/// Stands for no wall.
const NO_WALL: u32 = u32::MAX;

impl WayBack {
    fn of(now: &Now, points: &[Point], options: &Options, threads: &Threads) -> Self {
        let first = &now.known.first;
        let mut triangles = wall_triangles(&now.mesh, options);
        let mut is_driven = vec![false; points.len()];
        now.mover.boundary().iter().for_each(|v| is_driven[v.index()] = true);
        let area = |t: &[_; 3]| area_vector(t.map(|v: VertexId| points[v.index()]));
        triangles.retain(|t| t.iter().all(|v| is_driven[v.index()]) && area(t) != [0.0; 3]);
        let mut sets = Sets::new(points.len());
        join(&mut sets, &triangles);
        let mut node = vec![NO_NODE; points.len()];
        for (v, &its) in (0..).zip(&now.known.node).filter(|(_, node)| **node != NO_NODE) {
            node[sets.root(v) as usize] = its;
        }
        let back: Vec<Rigid> =
            triangles.iter().map(|t| Rigid::fit(&t.map(|v| (points[v.index()], first[v.index()])))).collect();
        let component: Vec<u32> = triangles.iter().map(|t| sets.root(t[0].0)).collect();
        let tree = NearestTriangle::new(points, &triangles, threads);
        let nearest = tree.closest_all(points, None, threads);
        let places = threads.map(points.len(), |v| match nearest[v] {
            Some(nearest) => (component[nearest.triangle], back[nearest.triangle].apply(points[v])),
            None => (NO_WALL, first[v]),
        });
        Self { node, places }
    }
}

fn join(sets: &mut Sets, triangles: &[[VertexId; 3]]) {
    for [a, b, c] in triangles {
        sets.join(a.0, b.0);
        sets.join(a.0, c.0);
    }
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
            sizes.first.at_vertices((now, points), wall, options, &Threads::single())
        };
        let first = of(&mesh.points);
        let radius = mesh.points.iter().map(|p| norm(*p)).fold(f64::INFINITY, f64::min);
        // The sphere and what is near it turn and shift.
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
        let at = sizes.now.at_vertices((now, &mesh.points), wall, options, &Threads::single());
        let ratios: Vec<f64> = at.iter().zip(lengths(&mesh)).map(|(size, length)| size / length).collect();
        assert!(ratios.iter().all(|ratio| (0.6..1.6).contains(ratio)), "{ratios:?}");
        let mean = ratios.iter().sum::<f64>() / ratios.len() as f64;
        assert!((mean - 1.0).abs() < 0.05, "{mean}");
    }
}
