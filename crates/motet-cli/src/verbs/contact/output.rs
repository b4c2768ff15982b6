//! The surfaces with their gaps, as a mesh to write.

use motet::Mesh;
use motet::base::VertexId;
use motet::contact::{Ahead, Gaps};
use motet::mesh::{CellKind, Cells, Field, Values};

use super::frames::Frame;

/// The mesh of all bodies: the points of each body separately, one body after another; triangles in the order
/// of the bodies.
pub(crate) fn mesh(frame: &Frame, gaps: &Gaps, ahead: Option<&Ahead>) -> Mesh {
    let (mut points, mut cells) = (Vec::new(), Vec::new());
    let (mut body_of, mut cell_of, mut point_of) = (Vec::new(), Vec::new(), Vec::new());
    let mut first_cells = Vec::new();
    for (id, ((body, gaps), source)) in (1..).zip(frame.bodies.iter().zip(&gaps.bodies).zip(&frame.sources)) {
        first_cells.push(cells.len() / 3);
        let first = points.len();
        let new = |v: &VertexId| VertexId::new(first + gaps.vertices.binary_search(v).unwrap_or_default());
        cells.extend(body.triangles.as_flattened().iter().map(new));
        points.extend(gaps.vertices.iter().map(|v| frame.points[v.index()]));
        point_of.extend(gaps.vertices.iter().map(|v| (v.index() - source.first_point) as i64));
        cell_of.extend(source.cells.iter().map(|cell| cell.index() as i64));
        body_of.resize(cells.len() / 3, id);
    }
    // Cannot fail: there are three vertices per triangle.
    let cells = Cells::uniform(CellKind::TRIANGLE, cells).unwrap_or_default();
    let mut mesh = Mesh::new(points, cells);
    let finite = |x: f64| if x.is_finite() { x } else { f64::NAN };
    let all = || gaps.bodies.iter();
    let gap: Vec<f64> = all().flat_map(|body| &body.gap).map(|&gap| finite(gap)).collect();
    let normal: Vec<_> = all().flat_map(|body| &body.normal).copied().collect();
    let warning: Vec<i32> = all().flat_map(|body| &body.warning).map(|&warns| i32::from(warns)).collect();
    let closest_body: Vec<i32> =
        all().flat_map(|b| &b.closest_body).map(|b| b.get().map_or(0, |b| b.0 as i32 + 1)).collect();
    let closest_cell: Vec<i64> = all()
        .flat_map(|body| body.closest_body.iter().zip(&body.closest_triangle))
        .map(|(body, triangle)| Some(first_cells.get(body.get()?.index())? + triangle.get()?.index()))
        .map(|cell| cell.map_or(-1, |cell| cell as i64))
        .collect();
    for field in [
        Field::scalars("gap", gap),
        Field::vectors("gap_normal", &normal),
        Field::scalars("closest_body", closest_body),
        Field::scalars("closest_cell", closest_cell),
        Field::scalars("warning", warning),
        Field::scalars("point", point_of),
    ] {
        mesh.set_point_field(field);
    }
    if let Some(ahead) = ahead {
        let times: Vec<f64> = ahead.times.iter().flatten().map(|&time| finite(time)).collect();
        mesh.set_point_field(Field::scalars("time_to_contact", times));
    }
    mesh.set_cell_field(Field::scalars("body", Values::from(body_of)));
    mesh.set_cell_field(Field::scalars("cell", Values::from(cell_of)));
    mesh
}

/// Adds the array of the error of each gap.
pub(crate) fn add_errors(mesh: &mut Mesh, errors: Vec<f64>) {
    let finite = errors.into_iter().map(|error| if error.is_finite() { error } else { f64::NAN });
    mesh.set_point_field(Field::scalars("gap_error", finite.collect::<Vec<f64>>()));
}
