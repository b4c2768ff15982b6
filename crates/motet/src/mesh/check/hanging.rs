//! Boundary vertices that lie on a boundary facet of which they are not a corner.
//!
//! Where one side of a wall is divided and the other is not, both sides are boundary, and vertices of the one
//! hang on the other.

use crate::base::{Csr, Point, VertexId};
use crate::geometry::triangle;
use crate::geometry::vector::distance;
use crate::geometry::vector::in_range;
use crate::mesh::check::defect::{Defect, DefectKind, Example};
use crate::mesh::{Boundary, Mesh, bounds, triangulate};

/// A vertex within this fraction of the longest edge of a facet lies on it: enough for the rounding of
/// double-precision coordinates, and for nothing coarser.
const TOLERANCE: f64 = 1e-12;

/// The search stops after this many pairs and grid cells, plus the second number per facet. Only a tangle of
/// facets each as large as the mesh needs more, and it has other defects to report.
const BUDGET: usize = 20_000_000;
const BUDGET_PER_FACET: usize = 200;

/// A boundary vertex that lies on a boundary facet of which it is not a corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HangingVertex {
    /// The vertex.
    pub vertex: VertexId,
    /// Index of the facet in the boundary.
    pub facet: usize,
    /// The triangle of the facet that it lies on.
    pub triangle: [VertexId; 3],
    /// The barycentric weights of the vertex in that triangle.
    pub weights: [f64; 3],
}

impl HangingVertex {
    /// The distance of the vertex from its place on the triangle, with vertices at `points`.
    ///
    /// # Panics
    /// If there are fewer points than the mesh has.
    pub fn opening(&self, points: &[Point]) -> f64 {
        distance(
            points[self.vertex.index()],
            triangle::at(self.triangle.map(|v| points[v.index()]), self.weights),
        )
    }
}

pub(super) fn defects(mesh: &Mesh, boundary: &Boundary) -> Defect {
    let mut defect = Defect::empty(DefectKind::HangingVertex);
    for HangingVertex { vertex, facet, .. } in hanging_vertices(mesh, boundary) {
        defect.add(|| Example::new(&[boundary.cells[facet]], &[vertex], &mesh.points));
    }
    defect
}

/// The boundary vertices that hang on facets, each with one such facet, in rising order.
pub fn hanging_vertices(mesh: &Mesh, boundary: &Boundary) -> Vec<HangingVertex> {
    let mut found: Vec<HangingVertex> = Vec::new();
    let Some(grid) = Grid::of(&boundary.vertices, &mesh.points) else { return found };
    let mut budget = BUDGET + BUDGET_PER_FACET * boundary.len();
    for (i, facet) in boundary.facets.iter().enumerate() {
        triangulate(boundary.kinds[i], facet, &mesh.points, &mut |corners| {
            let at = corners.map(|v| mesh.points[v.index()]);
            if at.iter().all(|p| in_range(*p)) && budget > 0 {
                grid.for_each_near(at, &mut budget, |v| {
                    if facet.contains(&v) {
                        return;
                    }
                    if let Some(weights) = weights_on_triangle(at, mesh.points[v.index()]) {
                        found.push(HangingVertex { vertex: v, facet: i, triangle: corners, weights });
                    }
                });
            }
        });
    }
    found.sort_by_key(|hanging| (hanging.vertex, hanging.facet));
    found.dedup_by_key(|hanging| hanging.vertex);
    found
}

/// The barycentric weights of a point on the triangle; `None` if it is off the triangle, or at a corner,
/// since two vertices at one place are another defect.
fn weights_on_triangle(corners: [Point; 3], p: Point) -> Option<[f64; 3]> {
    let longest = (0..3).map(|i| distance(corners[i], corners[(i + 1) % 3])).fold(0.0, f64::max);
    let near = |q: Point| distance(p, q) <= TOLERANCE * longest;
    let weights = triangle::closest(corners, p);
    (!corners.iter().any(|&corner| near(corner)) && near(triangle::at(corners, weights))).then_some(weights)
}

/// Vertices in the cells of a regular grid, about one to a cell.
struct Grid {
    low: Point,
    cell: Point,
    n: [usize; 3],
    vertices: Csr<VertexId>,
}

impl Grid {
    fn of(vertices: &[VertexId], points: &[Point]) -> Option<Self> {
        let places: Vec<Point> = vertices.iter().map(|v| points[v.index()]).collect();
        let [low, high] = bounds(&places)?;
        let n = ((vertices.len() as f64).cbrt().ceil() as usize).clamp(1, 256);
        let cell = [0, 1, 2].map(|k| (high[k] - low[k]) / n as f64);
        let mut grid = Self { low, cell, n: [n; 3], vertices: Csr::default() };
        let index = |p: Point| grid.index(grid.place(p));
        let finite = || vertices.iter().zip(&places).filter(|(_, p)| in_range(**p));
        grid.vertices = Csr::from_pairs(n * n * n, || finite().map(|(&v, &p)| (index(p), v)));
        Some(grid)
    }

    fn place(&self, p: Point) -> [usize; 3] {
        [0, 1, 2].map(|k| {
            let steps = (p[k] - self.low[k]) / self.cell[k];
            // Points outside the grid, and all points of one without extent, are put into the end cells.
            if steps > 0.0 { (steps as usize).min(self.n[k] - 1) } else { 0 }
        })
    }

    fn index(&self, [i, j, k]: [usize; 3]) -> usize {
        i + self.n[0] * (j + self.n[1] * k)
    }

    fn for_each_near(&self, corners: [Point; 3], budget: &mut usize, mut see: impl FnMut(VertexId)) {
        let Some([low, high]) = bounds(&corners) else { return };
        let margin = TOLERANCE * distance(low, high);
        let [from, to] = [(low, -margin), (high, margin)].map(|(p, m)| self.place(p.map(|x| x + m)));
        for k in from[2]..=to[2] {
            for j in from[1]..=to[1] {
                for i in from[0]..=to[0] {
                    let here = self.vertices.list(self.index([i, j, k]));
                    *budget = budget.saturating_sub(1 + here.len());
                    here.iter().for_each(|&v| see(v));
                }
            }
        }
    }
}
