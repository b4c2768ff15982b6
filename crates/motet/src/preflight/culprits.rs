//! The faults of surfaces as a mesh of their own, for display.

use super::fault::{Fault, FaultKind};
use super::report::Preflight;
use crate::base::{Point, VertexId};
use crate::geometry::vector::in_range;
use crate::mesh::{CellKind, Cells, Field, Mesh};

/// The value of the array `triangle` for a vertex or an edge.
const NO_TRIANGLE: i32 = -1;

/// One cell of the mesh of faults.
struct Cell {
    vertices: Vec<VertexId>,
    triangle: i32,
    fault: usize,
}

/// A mesh of the vertices, edges and triangles with faults: vertex, line and triangle cells, in this order,
/// over the points that they use.
///
/// Arrays on cells: `fault`, the index in [`Preflight::faults`]; `kind`, its [code](FaultKind::code),
/// explained by the field data `kind:NAME`; `fatal`, 1 or 0; `surface`; `triangle`, the id of the given
/// triangle, -1 for vertices and lines. On points: `vertex`, the given ids. Points that are not finite cannot
/// be shown; the other corners of their triangles are.
///
/// Panics if the report is about other triangles.
pub fn culprits(points: &[Point], triangles: &[[VertexId; 3]], report: &Preflight) -> Mesh {
    let mut cells: Vec<Cell> =
        (0..).zip(&report.faults).flat_map(|(i, fault)| cells_of(points, triangles, i, fault)).collect();
    cells.sort_by_key(|cell| cell.vertices.len());
    let mut used: Vec<VertexId> = cells.iter().flat_map(|cell| &cell.vertices).copied().collect();
    used.sort_unstable();
    used.dedup();
    let mut mesh = Mesh::new(used.iter().map(|v| points[v.index()]).collect(), connected(&cells, &used));
    mesh.set_point_field(Field::scalars("vertex", used.iter().map(|v| v.0).collect::<Vec<u32>>()));
    let of_faults = |of: &dyn Fn(&Fault) -> i32| -> Vec<i32> {
        cells.iter().map(|cell| of(&report.faults[cell.fault])).collect()
    };
    let mut put = |name: &str, values: Vec<i32>| mesh.set_cell_field(Field::scalars(name, values));
    put("fault", cells.iter().map(|cell| i32::try_from(cell.fault).unwrap_or(i32::MAX)).collect());
    put("kind", of_faults(&|fault| fault.kind.code()));
    put("fatal", of_faults(&|fault| fault.is_fatal.into()));
    put("surface", of_faults(&|fault| fault.surface as i32));
    put("triangle", cells.iter().map(|cell| cell.triangle).collect());
    let code = |kind: &FaultKind| Field::scalars(format!("kind:{}", kind.name()), vec![kind.code()]);
    mesh.field_data = FaultKind::ALL.iter().map(code).collect();
    mesh
}

/// The cells, renumbered to the points in use.
fn connected(cells: &[Cell], used: &[VertexId]) -> Cells {
    let place = |v: &VertexId| VertexId::new(used.partition_point(|u| u < v));
    let mut connected = Cells::new();
    for cell in cells {
        let kind = [CellKind::VERTEX, CellKind::LINE, CellKind::TRIANGLE][cell.vertices.len() - 1];
        connected.push(kind, cell.vertices.iter().map(place));
    }
    connected
}

/// The cells that show a fault.
fn cells_of(points: &[Point], triangles: &[[VertexId; 3]], i: usize, fault: &Fault) -> Vec<Cell> {
    let lone = |vertices: &[VertexId]| Cell { vertices: vertices.to_vec(), triangle: NO_TRIANGLE, fault: i };
    let corners = || fault.triangles.iter().flat_map(|&t| triangles[t as usize]);
    let finite = |v: &VertexId| in_range(points[v.index()]);
    match fault.kind {
        FaultKind::EmptySurface => Vec::new(),
        _ if !corners().all(|v| finite(&v)) => {
            let mut shown: Vec<VertexId> = corners().filter(finite).collect();
            shown.sort_unstable();
            shown.dedup();
            shown.iter().map(|v| lone(&[*v])).collect()
        }
        FaultKind::OpenEdge | FaultKind::NonManifoldEdge | FaultKind::MisorientedEdge => {
            vec![lone(&fault.vertices)]
        }
        FaultKind::NonManifoldVertex => vec![lone(&fault.vertices)],
        _ => {
            let of =
                |&t: &u32| Cell { vertices: triangles[t as usize].to_vec(), triangle: t as i32, fault: i };
            fault.triangles.iter().map(of).collect()
        }
    }
}
