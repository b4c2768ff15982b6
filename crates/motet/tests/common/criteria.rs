//! A mesh with arrays, regions and patches for criteria, and helpers to check these.

use std::sync::Arc;

use motet::base::{Point, TetId, Threads, VertexId};
use motet::geometry::distance::triangle_triangle;
use motet::geometry::tet::{EDGES, FACETS, centroid, holds};
use motet::geometry::vector::{distance, norm};
use motet::mesh::shapes::sphere_in_box;
use motet::mesh::{CellKind, Cells, Field, Mesh, TetMesh, TetPart};
use motet::refine::Target;

pub(crate) fn corners(mesh: &TetMesh, t: usize) -> [Point; 4] {
    mesh.tets[t].map(|v| mesh.points[v.index()])
}

pub(crate) fn longest(corners: [Point; 4]) -> f64 {
    EDGES.map(|[i, j]| distance(corners[i], corners[j])).into_iter().fold(0.0, f64::max)
}

/// The tets for which `holds` is true.
pub(crate) fn tets_where(part: &TetPart, holds: impl Fn(usize) -> bool) -> Vec<TetId> {
    (0..part.mesh.tets.len()).filter(|&t| holds(t)).map(TetId::new).collect()
}

/// Tets and triangles as cells of a mesh: triangles first, so that tets get other numbers.
pub(crate) fn whole(tets: &TetMesh) -> Mesh {
    let mut cells = Cells::new();
    tets.triangles.iter().for_each(|t| cells.push(CellKind::TRIANGLE, *t));
    tets.tets.iter().for_each(|t| cells.push(CellKind::TETRA, *t));
    let mut mesh = Mesh::new(tets.points.clone(), cells);
    let zeros = |n: usize| vec![0; n].into_iter();
    let [n, m] = [tets.tets.len(), tets.triangles.len()];
    let regions: Vec<i32> = zeros(m).chain(tets.regions.iter().copied()).collect();
    let patches: Vec<i32> = tets.patches.iter().copied().chain(zeros(n)).collect();
    mesh.set_cell_field(Field::scalars("region", regions));
    mesh.set_cell_field(Field::scalars("patch", patches));
    mesh
}

pub(crate) fn speed(p: &Point) -> Point {
    [p[1] * p[2], (2.0 * p[0]).sin(), p[0] - p[1] * p[1]]
}

pub(crate) fn pressure(p: &Point) -> f64 {
    (1.5 * p[0]).tanh() + 0.3 * p[1] * p[2]
}

/// Adds fields by formula, on points and on cells.
pub(crate) fn with_fields(mut mesh: Mesh) -> Mesh {
    let v: Vec<Point> = mesh.points.iter().map(speed).collect();
    mesh.set_point_field(Field::vectors("v", &v));
    mesh.set_point_field(Field::scalars("p", mesh.points.iter().map(pressure).collect::<Vec<_>>()));
    let size: Vec<f64> = mesh.points.iter().map(|p| 0.6 + 0.35 * norm(*p)).collect();
    mesh.set_point_field(Field::scalars("h", size));
    let middle = |vertices: &[VertexId]| {
        vertices.iter().map(|v| mesh.points[v.index()][0]).sum::<f64>() / vertices.len() as f64
    };
    let on_cells: Vec<f64> = mesh.cells.iter().map(|(_, _, vertices)| middle(vertices)).collect();
    mesh.set_cell_field(Field::scalars("x", on_cells));
    mesh
}

/// A ball in a box, in two regions, with fields; and its tets.
pub(crate) fn case() -> (Mesh, TetPart) {
    let mut tets = TetPart::of(&sphere_in_box(3, 4)).unwrap().mesh;
    let labels: Vec<i32> =
        (0..tets.tets.len()).map(|t| if centroid(corners(&tets, t))[0] < 0.5 { 3 } else { 7 }).collect();
    tets.regions = labels;
    let mut mesh = with_fields(whole(&tets));
    mesh.label_names.regions.insert(7, "right".into());
    mesh.label_names.patches.insert(1, "sphere".into());
    let part = TetPart::of(&mesh).unwrap();
    (mesh, part)
}

/// Two plates, and a closed surface that lies within a single tet.
pub(crate) fn target(threads: &Threads) -> Arc<Target> {
    let mut points = vec![[1.2, -1.0, -1.0], [3.0, 0.5, 1.0], [1.5, 2.0, 0.3], [-2.0, 0.0, 2.0]];
    let mut triangles = vec![[0, 1, 2].map(VertexId), [1, 2, 3].map(VertexId)];
    let first = points.len() as u32;
    let small = [[0.0; 3], [1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0], [0.0, 0.0, 1e-3]];
    points.extend(small.map(|p: Point| [p[0] - 4.1, p[1] - 3.9, p[2] + 4.2]));
    triangles.extend(FACETS.map(|facet| facet.map(|i| VertexId(first + i as u32))));
    Arc::new(Target::new(points, triangles, threads).unwrap())
}

pub(crate) fn target_triangles(target: &Target) -> Vec<[Point; 3]> {
    target.triangles().iter().map(|t| t.map(|v| target.points()[v.index()])).collect()
}

/// The distance of a tet from triangles, by brute force.
pub(crate) fn from_triangles(corners: [Point; 4], triangles: &[[Point; 3]]) -> f64 {
    let from = |triangle: &[Point; 3]| {
        let facets = FACETS.map(|facet| {
            triangle_triangle::closest(facet.map(|i| corners[i]), *triangle).distance_squared.sqrt()
        });
        if holds(corners, triangle[0]) { 0.0 } else { facets.into_iter().fold(f64::INFINITY, f64::min) }
    };
    triangles.iter().map(from).fold(f64::INFINITY, f64::min)
}
