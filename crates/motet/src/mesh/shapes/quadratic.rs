//! Adds middle nodes to a mesh of tets and triangles.

use std::collections::BTreeMap;

use crate::base::{Point, VertexId};
use crate::geometry::vector::{add, scale};
use crate::mesh::{CellKind, Cells, Mesh};

/// Edges of a triangle and a tet in the order of VTK's middle nodes.
const TRIANGLE_EDGES: &[[usize; 2]] = &[[0, 1], [1, 2], [2, 0]];
const TET_EDGES: &[[usize; 2]] = &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];

/// The mesh with its tets and triangles made quadratic by a new vertex in the middle of each edge. Other
/// cells, labels and cell arrays stay; point arrays are dropped, since they have no values at the new
/// vertices.
pub fn quadratic(mesh: &Mesh) -> Mesh {
    let mut points = mesh.points.clone();
    let mut middles = BTreeMap::new();
    let mut cells = Cells::new();
    for (_, kind, vertices) in mesh.cells.iter() {
        let (new_kind, edges) = match kind {
            CellKind::TRIANGLE => (CellKind::QUADRATIC_TRIANGLE, TRIANGLE_EDGES),
            CellKind::TETRA => (CellKind::QUADRATIC_TETRA, TET_EDGES),
            _ => (kind, &[][..]),
        };
        let middle = |&[i, j]: &[usize; 2]| middle_of([vertices[i], vertices[j]], &mut middles, &mut points);
        let added: Vec<VertexId> = edges.iter().map(middle).collect();
        cells.push(new_kind, vertices.iter().copied().chain(added));
    }
    Mesh { points, cells, point_data: Vec::new(), ..mesh.clone() }
}

fn middle_of(
    [a, b]: [VertexId; 2],
    middles: &mut BTreeMap<[VertexId; 2], VertexId>,
    points: &mut Vec<Point>,
) -> VertexId {
    *middles.entry([a.min(b), a.max(b)]).or_insert_with(|| {
        points.push(scale(add(points[a.index()], points[b.index()]), 0.5));
        VertexId::new(points.len() - 1)
    })
}
