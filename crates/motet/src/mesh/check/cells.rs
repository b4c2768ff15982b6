//! Cells that are inverted, flat, folded inside, or name a vertex twice.

use std::cmp::Ordering;

use crate::base::{CellId, Point, VertexId};
use crate::geometry::predicates::{collinear, orient3d};
use crate::geometry::vector::in_range;
use crate::mesh::adjacency::Facets;
use crate::mesh::boundary::corners;
use crate::mesh::check::defect::{Defect, DefectKind, Example};
use crate::mesh::curved::{Jacobian, is_curved_kind, is_upright};
use crate::mesh::facets::facet_shapes;
use crate::mesh::{Boundary, CellKind, Mesh, cell_volume};

/// The defects of single cells. `are_reversed` states for each cell whether the sign of its volume is
/// reversed: see [`OrientedTets`](crate::mesh::OrientedTets).
pub(super) fn defects(mesh: &Mesh, boundary: &Boundary, are_reversed: &[bool]) -> Vec<Defect> {
    let facets = Facets::of(&mesh.cells);
    let mut repeated = Defect::empty(DefectKind::RepeatedVertex);
    let mut inverted = Defect::empty(DefectKind::InvertedCell);
    let mut flat = Defect::empty(DefectKind::FlatCell);
    let mut folded = Defect::empty(DefectKind::FoldedCell);
    let mut zero_area = Defect::empty(DefectKind::ZeroAreaCell);
    let mut unknown = Defect::empty(DefectKind::UnknownKind);
    for (cell, kind, vertices) in mesh.cells.iter() {
        let example = || Example::new(&[cell], vertices, &mesh.points);
        if kind.dim() >= Some(2) && has_repeated_vertex(vertices) {
            repeated.add(example);
        }
        if boundary.n_unknown > 0 && is_unknown(kind) {
            unknown.add(example);
        }
        if is_curved_kind(kind) {
            match curved(kind, vertices, &mesh.points, are_reversed[cell.index()]) {
                CurvedState::Sound => {}
                CurvedState::Inverted => inverted.add(example),
                CurvedState::Flat => flat.add(example),
                CurvedState::Folded(at) => folded.add(|| Example { at: Some(at), ..example() }),
            }
            continue;
        }
        let as_oriented = |sign: Ordering| if are_reversed[cell.index()] { sign.reverse() } else { sign };
        let measure = measure(&facets, cell, kind, vertices, &mesh.points);
        match measure.map(|(dim, sign)| (dim, as_oriented(sign))) {
            Some((3, Ordering::Less)) => inverted.add(example),
            Some((3, Ordering::Equal)) => flat.add(example),
            Some((2, Ordering::Equal)) => zero_area.add(example),
            _ => {}
        }
    }
    vec![unknown, repeated, inverted, flat, folded, zero_area]
}

/// The sign of the Jacobian determinant of a quadratic cell.
enum CurvedState {
    /// Positive everywhere, or undetermined since a point is not finite.
    Sound,
    /// Negative everywhere.
    Inverted,
    /// Zero everywhere.
    Flat,
    /// Not of one sign; the place where it is least.
    Folded(Point),
}

/// Judges a quadratic cell; if `is_reversed`, the determinant counts with the opposite sign.
fn curved(kind: CellKind, vertices: &[VertexId], points: &[Point], is_reversed: bool) -> CurvedState {
    let nodes: Vec<Point> = vertices.iter().map(|v| points[v.index()]).collect();
    if !nodes.iter().all(|&p| in_range(p)) || is_upright(kind, &nodes, is_reversed) {
        return CurvedState::Sound;
    }
    if is_upright(kind, &nodes, !is_reversed) {
        return CurvedState::Inverted;
    }
    match Jacobian::of(kind, &nodes) {
        None => CurvedState::Sound,
        Some(jacobian) if jacobian.is_zero() => CurvedState::Flat,
        Some(jacobian) => CurvedState::Folded(jacobian.least().place),
    }
}

fn has_repeated_vertex(vertices: &[VertexId]) -> bool {
    if vertices.len() > 32 {
        let mut sorted = vertices.to_vec();
        sorted.sort_unstable();
        return sorted.windows(2).any(|w| w[0] == w[1]);
    }
    (1..vertices.len()).any(|i| vertices[..i].contains(&vertices[i]))
}

fn is_unknown(kind: CellKind) -> bool {
    kind.dim() == Some(3) && kind != CellKind::POLYHEDRON && facet_shapes(kind).is_none()
}

/// The dimension of a cell and the sign of its measure; `None` if it has no measure, or a point is not
/// finite. Exact for tets and surface cells.
fn measure(
    facets: &Facets,
    cell: CellId,
    kind: CellKind,
    vertices: &[VertexId],
    points: &[Point],
) -> Option<(usize, Ordering)> {
    let dim = kind.dim().filter(|dim| *dim >= 2 && !is_unknown(kind))?;
    if !vertices.iter().all(|v| in_range(points[v.index()])) {
        return None;
    }
    let sign = |x: f64| x.total_cmp(&0.0).then(Ordering::Equal);
    match (kind, vertices) {
        (CellKind::TETRA, &[a, b, c, d]) => Some((3, orientation([a, b, c, d].map(|v| points[v.index()])))),
        _ if dim == 3 => Some((3, sign(cell_volume(facets, cell, points) + 0.0))),
        (CellKind::TRIANGLE_STRIP, _) => None,
        _ if is_line(corners(kind, vertices), points) => Some((2, Ordering::Equal)),
        _ => Some((2, Ordering::Greater)),
    }
}

/// The exact sign of the volume of a tet.
fn orientation([a, b, c, d]: [Point; 4]) -> Ordering {
    orient3d(a, b, c, d).cmp(&0)
}

/// Whether a ring has no area, by an exact test: every triangle of its fan is collinear.
fn is_line(ring: &[VertexId], points: &[Point]) -> bool {
    let Some(&first) = ring.first() else { return true };
    let at = |v: VertexId| points[v.index()];
    ring.windows(2).all(|w| collinear(at(first), at(w[0]), at(w[1])))
}
