//! Which vertex of a mesh each point of a surface file is, and how far the point has moved.
//!
//! A surface that was cut out of a mesh carries the ids of its points (`GlobalNodeID` counts from one,
//! `vtkOriginalPointIds` from zero). Where it carries none, a point is the vertex at its position.

use std::collections::HashMap;

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::vector::{norm, sub};
use crate::mesh::{Mesh, bounds};

/// An array of vertex ids, and the id of the first vertex of a mesh that has no such array.
struct IdArray {
    name: &'static str,
    first: i64,
}

const GLOBAL_NODE_ID: IdArray = IdArray { name: "GlobalNodeID", first: 1 };

/// In the order in which they are tried.
const ID_ARRAYS: [IdArray; 2] = [GLOBAL_NODE_ID, IdArray { name: "vtkOriginalPointIds", first: 0 }];

/// Names of the vector array on a surface that holds its displacement, first choice first.
const DISPLACEMENT_ARRAYS: &[&str] = &["displacement", "Displacement", "u", "U", "disp"];

/// Two points are the same where they are closer than this fraction of the bounding box's diagonal: single
/// precision keeps 1.2e-7 of a coordinate.
const RELATIVE_TOLERANCE: f64 = 1e-6;

/// The vertex of `mesh` that each point of `surface`, which lies on the undeformed mesh, is: by position, or
/// by its ids where that fails.
///
/// # Errors
/// When points lie on no vertex and carry no ids; reports how many they are, which is the first, and how far
/// it is from the mesh. When an id belongs to no vertex.
pub fn match_patch(mesh: &Mesh, surface: &Mesh) -> Result<Vec<VertexId>> {
    match_by_position(mesh, surface).or_else(|error| match_by_id(mesh, surface)?.ok_or(error))
}

/// The vertices that belong to the surface's own ids; `None` where it carries none.
fn match_by_id(mesh: &Mesh, surface: &Mesh) -> Result<Option<Vec<VertexId>>> {
    for array in &ID_ARRAYS {
        let Some(ids) = array.of(surface) else { continue };
        return array.vertices(mesh, &ids).map(Some);
    }
    Ok(None)
}

/// The vertices with these ids: by the mesh's own `GlobalNodeID`, or counted from 1 where it has none.
///
/// # Errors
/// When an id belongs to no vertex; reports which.
pub fn match_ids(mesh: &Mesh, ids: &[i64]) -> Result<Vec<VertexId>> {
    GLOBAL_NODE_ID.vertices(mesh, ids)
}

/// The id of each vertex, as [`match_ids`] finds it.
pub fn node_ids(mesh: &Mesh) -> Vec<i64> {
    GLOBAL_NODE_ID.of(mesh).unwrap_or_else(|| GLOBAL_NODE_ID.counted(mesh).collect())
}

impl IdArray {
    fn of(&self, mesh: &Mesh) -> Option<Vec<i64>> {
        mesh.point_field(self.name).filter(|f| f.components == 1)?.values.to_i64()
    }

    fn counted(&self, mesh: &Mesh) -> impl Iterator<Item = i64> {
        let first = self.first;
        (0..mesh.points.len()).map(move |vertex| vertex as i64 + first)
    }

    fn vertices(&self, mesh: &Mesh, ids: &[i64]) -> Result<Vec<VertexId>> {
        let own: HashMap<i64, usize> = match self.of(mesh) {
            Some(own) => own.into_iter().enumerate().map(|(vertex, id)| (id, vertex)).collect(),
            None => self.counted(mesh).enumerate().map(|(vertex, id)| (id, vertex)).collect(),
        };
        let vertices = ids.iter().enumerate().map(|(point, id)| match own.get(id) {
            Some(&vertex) => Ok(VertexId::new(vertex)),
            None => Err(Error::input(format!("no point of the mesh has {} {id}", self.name))
                .at(format!("point {point}"))
                .remedy("give a surface that belongs to this mesh")),
        });
        vertices.collect()
    }
}

fn match_by_position(mesh: &Mesh, surface: &Mesh) -> Result<Vec<VertexId>> {
    let grid = Grid::new(&mesh.points);
    let found: Vec<_> = surface.points.iter().map(|&p| grid.vertex_at(p)).collect();
    let unmatched: Vec<usize> = (0..found.len()).filter(|&i| found[i].is_none()).collect();
    let Some(&first) = unmatched.first() else {
        return Ok(found.into_iter().flatten().collect());
    };
    let [x, y, z] = surface.points[first];
    let distance =
        mesh.points.iter().map(|&p| norm(sub(p, surface.points[first]))).fold(f64::INFINITY, f64::min);
    Err(Error::input(format!(
        "{} of the surface's {} points lie on no vertex of the mesh; this one, ({x}, {y}, {z}), is {distance:.3e} \
         from the nearest",
        unmatched.len(),
        found.len()
    ))
    .at(format!("point {first}"))
    .remedy(
        "give the surface a point array GlobalNodeID (from 1) or vtkOriginalPointIds (from 0), or give the \
         undeformed surface with a vector array `displacement`",
    ))
}

/// Vertices by position, in grid cells as wide as the distance below which two points are the same.
struct Grid<'a> {
    points: &'a [Point],
    low: Point,
    width: f64,
    cells: HashMap<[i64; 3], Vec<u32>>,
}

impl<'a> Grid<'a> {
    fn new(points: &'a [Point]) -> Self {
        let [low, high] = bounds(points).unwrap_or_default();
        let width = (norm(sub(high, low)) * RELATIVE_TOLERANCE).max(f64::MIN_POSITIVE);
        let mut grid = Self { points, low, width, cells: HashMap::new() };
        for (vertex, &p) in points.iter().enumerate() {
            grid.cells.entry(grid.cell(p)).or_default().push(vertex as u32);
        }
        grid
    }

    fn cell(&self, p: Point) -> [i64; 3] {
        [0, 1, 2].map(|i| ((p[i] - self.low[i]) / self.width).floor() as i64)
    }

    /// The nearest vertex within the width of a grid cell; the first of equally near ones.
    fn vertex_at(&self, p: Point) -> Option<VertexId> {
        let [i, j, k] = self.cell(p);
        let mut nearest: Option<(f64, u32)> = None;
        for n in 0..27 {
            let cell =
                [i.saturating_add(n / 9 - 1), j.saturating_add(n / 3 % 3 - 1), k.saturating_add(n % 3 - 1)];
            for &vertex in self.cells.get(&cell).map_or(&[][..], Vec::as_slice) {
                let candidate = (norm(sub(self.points[vertex as usize], p)), vertex);
                if candidate.0 <= self.width && nearest.is_none_or(|n| candidate < n) {
                    nearest = Some(candidate);
                }
            }
        }
        nearest.map(|(_, vertex)| VertexId(vertex))
    }
}

/// How the points of a surface are found among those of the mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Matching {
    /// By the ids that the surface carries; by position where it carries none.
    #[default]
    Id,
    /// By position, even where the surface carries ids: for a surface with the ids of another mesh, such as
    /// the solid around a fluid.
    Position,
}

/// Reads the displacements of a mesh's vertices from a displaced surface, or from a series of surfaces.
///
/// Where a surface lies away from the undeformed mesh, its points give the displacement. Where it lies on the
/// mesh, its vector array `displacement` does; without such an array nothing has moved. A series without ids
/// must begin with the undeformed surface; those after it have the same points in the same order.
#[derive(Debug)]
pub struct SurfaceMotion<'a> {
    mesh: &'a Mesh,
    matching: Matching,
    /// The vertices that the points of the previous surface are.
    vertices: Option<Vec<VertexId>>,
}

impl<'a> SurfaceMotion<'a> {
    /// A reader that has read no surface yet.
    pub fn new(mesh: &'a Mesh, matching: Matching) -> Self {
        Self { mesh, matching, vertices: None }
    }

    /// The vertices of the next surface, each once, and their displacements from their positions in the mesh.
    ///
    /// # Errors
    /// When a point is no vertex of the mesh, as in [`match_patch`]; when two points of one vertex move
    /// apart; when a displacement is not finite.
    pub fn next(&mut self, surface: &Mesh) -> Result<Vec<(VertexId, Point)>> {
        let vertices = self.vertices_of(surface)?;
        let moved = self.displacements(surface, &vertices)?;
        if let Some(i) = moved.iter().position(|d| d.iter().any(|x| !x.is_finite())) {
            return Err(Error::input("the displacement is not finite").at(format!("point {i}")));
        }
        let pairs = self.merged(&vertices, &moved)?;
        self.vertices = Some(vertices);
        Ok(pairs)
    }

    fn vertices_of(&self, surface: &Mesh) -> Result<Vec<VertexId>> {
        if self.matching == Matching::Id
            && let Some(vertices) = match_by_id(self.mesh, surface)?
        {
            return Ok(vertices);
        }
        match &self.vertices {
            Some(before) if before.len() == surface.points.len() => Ok(before.clone()),
            Some(before) => Err(Error::input(format!(
                "has {} points, but the previous surface has {}; without ids the points must be the same",
                surface.points.len(),
                before.len()
            ))
            .remedy("give the surfaces a point array GlobalNodeID (from 1)")),
            None => match_by_position(self.mesh, surface),
        }
    }

    fn displacements(&self, surface: &Mesh, vertices: &[VertexId]) -> Result<Vec<Point>> {
        let points = vertices.iter().zip(&surface.points);
        let moved: Vec<Point> = points.map(|(v, &p)| sub(p, self.mesh.points[v.index()])).collect();
        let tolerance = self.tolerance();
        // Tests what must hold, since a coordinate that is not a number must not pass for unmoved.
        let unmoved = moved.iter().all(|&d| norm(d) <= tolerance);
        if !unmoved {
            return Ok(moved);
        }
        let field = DISPLACEMENT_ARRAYS.iter().find_map(|name| surface.point_field(name));
        match field.filter(|f| f.components == 3) {
            Some(field) => field.to_vectors(),
            None => Ok(vec![[0.0; 3]; vertices.len()]),
        }
    }

    fn tolerance(&self) -> f64 {
        self.mesh.bounds().map_or(0.0, |[low, high]| norm(sub(high, low)) * RELATIVE_TOLERANCE)
    }

    /// Merges points of several faces that are one vertex.
    fn merged(&self, vertices: &[VertexId], moved: &[Point]) -> Result<Vec<(VertexId, Point)>> {
        let tolerance = self.tolerance();
        let mut order: Vec<usize> = (0..vertices.len()).collect();
        order.sort_by_key(|&i| vertices[i]);
        let mut pairs: Vec<(VertexId, Point)> = Vec::with_capacity(order.len());
        for i in order {
            match pairs.last() {
                Some((vertex, d)) if *vertex == vertices[i] => {
                    let apart = norm(sub(*d, moved[i]));
                    if apart > tolerance {
                        return Err(Error::input(format!(
                            "is vertex {vertex}, as is another point, but their displacements differ by {apart:.3e}"
                        ))
                        .at(format!("point {i}"))
                        .remedy("give the vertex one displacement"));
                    }
                }
                _ => pairs.push((vertices[i], moved[i])),
            }
        }
        Ok(pairs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Cells, Field};

    fn mesh() -> Mesh {
        let points = (0..27).map(|i| [i / 9, i / 3 % 3, i % 3].map(f64::from)).collect();
        Mesh::new(points, Cells::new())
    }

    /// Every other vertex of the mesh, last first, moved by `by`.
    fn surface(by: Point) -> (Mesh, Vec<VertexId>) {
        let vertices: Vec<_> = (0..27).rev().step_by(2).map(VertexId).collect();
        let points =
            vertices.iter().map(|v| mesh().points[v.index()]).map(|p| [0, 1, 2].map(|i| p[i] + by[i]));
        (Mesh::new(points.collect(), Cells::new()), vertices)
    }

    #[test]
    fn points_are_found_by_position_within_single_precision() {
        let (mut s, vertices) = surface([0.0; 3]);
        s.points.iter_mut().flatten().for_each(|x| *x += 1e-7);
        assert_eq!(match_patch(&mesh(), &s).unwrap(), vertices);
    }

    #[test]
    fn ids_name_points_that_moved_and_follow_the_numbers_of_the_mesh() {
        let (mut s, vertices) = surface([0.3, 0.0, 0.0]);
        let ids: Vec<i64> = vertices.iter().map(|v| i64::from(v.0) + 1).collect();
        s.set_point_field(Field::scalars("GlobalNodeID", ids.clone()));
        assert_eq!(match_patch(&mesh(), &s).unwrap(), vertices);
        let mut numbered = mesh();
        numbered.set_point_field(Field::scalars("GlobalNodeID", (1..=27i64).rev().collect::<Vec<_>>()));
        let mirrored: Vec<_> = vertices.iter().map(|v| VertexId(26 - v.0)).collect();
        assert_eq!(match_patch(&numbered, &s).unwrap(), mirrored);
    }

    #[test]
    fn points_that_lie_nowhere_are_counted_and_the_first_is_reported() {
        let (mut s, _) = surface([0.0; 3]);
        s.points[3][1] += 0.25;
        s.points[7][2] -= 0.5;
        let error = match_patch(&mesh(), &s).unwrap_err().to_string();
        assert!(error.starts_with("point 3: 2 of the surface's 14 points"), "{error}");
        assert!(error.contains("2.500e-1"), "{error}");
    }

    #[test]
    fn a_series_without_ids_keeps_the_order_of_its_first_surface() {
        let mesh = mesh();
        let mut motion = SurfaceMotion::new(&mesh, Matching::Id);
        assert!(motion.next(&surface([0.0; 3]).0).unwrap().iter().all(|(_, d)| *d == [0.0; 3]));
        let second = motion.next(&surface([0.5, 0.0, 0.0]).0).unwrap();
        assert_eq!(second.len(), 14);
        assert!(second.iter().all(|(v, d)| v.0 % 2 == 0 && *d == [0.5, 0.0, 0.0]));
        let mut shorter = surface([0.5, 0.0, 0.0]).0;
        shorter.points.pop();
        assert!(motion.next(&shorter).is_err());
    }

    #[test]
    fn ids_of_another_mesh_can_be_passed_over() {
        let mesh = mesh();
        let (mut s, vertices) = surface([0.0; 3]);
        s.set_point_field(Field::scalars("GlobalNodeID", (1..=14i64).collect::<Vec<_>>()));
        let mut motion = SurfaceMotion::new(&mesh, Matching::Position);
        let mut found: Vec<_> = motion.next(&s).unwrap().into_iter().map(|(v, _)| v).collect();
        found.reverse();
        assert_eq!(found, vertices);
        s.points.iter_mut().for_each(|p| p[0] += 0.5);
        assert!(motion.next(&s).unwrap().iter().all(|(_, d)| *d == [0.5, 0.0, 0.0]));
    }

    #[test]
    fn an_array_tells_the_displacement_of_a_surface_in_its_first_place() {
        let mesh = mesh();
        let (mut s, _) = surface([0.0; 3]);
        s.set_point_field(Field::vectors("displacement", &[[0.0, 0.1, 0.0]; 14]));
        let moved = SurfaceMotion::new(&mesh, Matching::Id).next(&s).unwrap();
        assert!(moved.iter().all(|(_, d)| *d == [0.0, 0.1, 0.0]));
    }

    #[test]
    fn one_vertex_cannot_go_two_ways() {
        let mesh = mesh();
        let (mut s, vertices) = surface([0.0; 3]);
        let mut ids: Vec<i64> = vertices.iter().map(|v| i64::from(v.0)).collect();
        ids[5] = ids[2];
        s.set_point_field(Field::scalars("vtkOriginalPointIds", ids));
        let error = SurfaceMotion::new(&mesh, Matching::Id).next(&s).unwrap_err().to_string();
        assert!(error.contains("differ by"), "{error}");
    }

    #[test]
    fn what_is_not_finite_is_refused() {
        let mesh = mesh();
        let (mut s, vertices) = surface([0.0; 3]);
        let ids: Vec<i64> = vertices.iter().map(|v| i64::from(v.0) + 1).collect();
        s.set_point_field(Field::scalars("GlobalNodeID", ids));
        s.points[4] = [f64::NAN, 0.0, 0.0];
        assert!(
            SurfaceMotion::new(&mesh, Matching::Id)
                .next(&s)
                .unwrap_err()
                .to_string()
                .starts_with("point 4: ")
        );
    }
}
