//! The segments of centre lines in a mesh, and the radius at both ends of each.

use super::options::{Options, Radius};
use crate::base::{CellId, Error, Point, Result, VertexId};
use crate::geometry::vector::{LARGEST, distance, in_range};
use crate::mesh::{CellKind, Field, Mesh, firsts_at_place};

/// Segments of centre lines.
#[derive(Clone, Debug, Default)]
pub(super) struct CentreLines {
    pub(super) points: Vec<Point>,
    pub(super) segments: Vec<[VertexId; 2]>,
    /// The radius at both ends of each segment.
    pub(super) radii: Vec<[f64; 2]>,
    /// Segments that were left out.
    pub(super) left_out: usize,
    /// Cells that are no lines.
    pub(super) other_cells: usize,
}

impl CentreLines {
    /// The line cells of a mesh: straight ones, polylines, and curves of higher order through their nodes.
    ///
    /// # Errors
    /// When there is no line cell, no such array, a point or radius is not finite, or a segment has no
    /// length, unless such segments are to be left out.
    pub(super) fn of(mesh: &Mesh, options: &Options) -> Result<Self> {
        let radius = RadiusOf::new(mesh, &options.radius)?;
        let firsts = options.repair.then(|| firsts_at_place(&mesh.points));
        let mut lines = Self { points: mesh.points.clone(), ..Self::default() };
        for (cell, kind, vertices) in mesh.cells.iter() {
            let Some(order) = along(kind, vertices) else {
                lines.other_cells += 1;
                continue;
            };
            for pair in order.windows(2) {
                let ends = [pair[0], pair[1]].map(|v| firsts.as_ref().map_or(v, |firsts| firsts[v.index()]));
                let radii = [pair[0], pair[1]].map(|v| radius.at(v, cell));
                match fault(mesh, [pair[0], pair[1]], radii, &options.radius) {
                    None => {
                        lines.segments.push(ends);
                        lines.radii.push(radii);
                    }
                    Some(_) if options.repair => lines.left_out += 1,
                    Some(error) => return Err(error.at(format!("cell {cell}"))),
                }
            }
        }
        if lines.segments.is_empty() {
            let what = match lines.left_out {
                0 => "the mesh has no line cells to make tubes of".to_owned(),
                n => format!("all {n} segments of the lines have no length or are not finite"),
            };
            return Err(Error::input(what).remedy("give centre lines: line or polyline cells"));
        }
        Ok(lines)
    }

    /// The smallest and the largest radius.
    pub(super) fn extremes(&self) -> [f64; 2] {
        let all = || self.radii.as_flattened().iter().copied();
        [all().fold(f64::INFINITY, f64::min), all().fold(0.0, f64::max)]
    }
}

/// The vertices of a line cell in their order along it; `None` for other cells.
fn along(kind: CellKind, vertices: &[VertexId]) -> Option<Vec<VertexId>> {
    match kind {
        CellKind::LINE | CellKind::POLY_LINE => Some(vertices.to_vec()),
        // The ends come first.
        CellKind::QUADRATIC_LINE | CellKind::CUBIC_LINE | CellKind::LAGRANGE_CURVE => {
            let (ends, inner) = vertices.split_at(vertices.len().min(2));
            let [first, last] = ends else { return Some(vertices.to_vec()) };
            Some([*first].into_iter().chain(inner.iter().copied()).chain([*last]).collect())
        }
        _ => None,
    }
}

/// What is wrong with a segment, if anything.
fn fault(mesh: &Mesh, ends: [VertexId; 2], radii: [f64; 2], radius: &Radius) -> Option<Error> {
    let remedy = "correct it, or ask for a repair, which leaves such segments out";
    let [a, b] = ends.map(|v| mesh.points[v.index()]);
    if let Some(k) = [a, b].into_iter().position(|p| !in_range(p)) {
        let v = ends[k];
        let what = format!(
            "a line goes to point {v}, whose coordinates {:?} are not finite or too large",
            [a, b][k]
        );
        return Some(Error::input(what).remedy(remedy));
    }
    if let Some(k) = radii.into_iter().position(|r| !(r > 0.0 && r <= LARGEST)) {
        let of = match radius {
            Radius::Same(_) => String::new(),
            Radius::Array(name) => format!(" of array `{name}`"),
        };
        let what = format!(
            "the radius{of} at point {} is {}: it must be above 0 and at most {LARGEST:.0e}",
            ends[k], radii[k]
        );
        return Some(Error::input(what).remedy(remedy));
    }
    (distance(a, b) == 0.0).then(|| {
        let what = format!("the segment from point {} to point {} has no length", ends[0], ends[1]);
        Error::input(what).remedy(remedy)
    })
}

/// Where radii come from.
enum RadiusOf {
    Same(f64),
    Points(Vec<f64>),
    Cells(Vec<f64>),
}

impl RadiusOf {
    fn new(mesh: &Mesh, radius: &Radius) -> Result<Self> {
        let name = match radius {
            Radius::Same(radius) if *radius > 0.0 && *radius <= LARGEST => return Ok(Self::Same(*radius)),
            Radius::Same(radius) => {
                return Err(Error::options(format!("the radius of tubes cannot be {radius}"))
                    .remedy("give a length above 0, in the unit of the points, or the name of an array"));
            }
            Radius::Array(name) => name,
        };
        let values = |field: &Field| match field.values.to_f64() {
            Some(values) if field.components == 1 => Ok(values),
            _ => Err(Error::input(format!("the array `{name}` does not have one number a row"))
                .remedy("give an array of radii")),
        };
        match (mesh.point_field(name), mesh.cell_field(name)) {
            (Some(field), _) => values(field).map(Self::Points),
            (None, Some(field)) => values(field).map(Self::Cells),
            (None, None) => {
                let names = |fields: &[Field]| match fields.len() {
                    0 => "none".to_owned(),
                    _ => fields.iter().map(|field| field.name.clone()).collect::<Vec<_>>().join(", "),
                };
                let what = format!("there is no array `{name}` that could hold radii");
                let remedy = format!(
                    "point arrays: {}; cell arrays: {}",
                    names(&mesh.point_data),
                    names(&mesh.cell_data)
                );
                Err(Error::input(what).remedy(remedy))
            }
        }
    }

    fn at(&self, v: VertexId, cell: CellId) -> f64 {
        match self {
            Self::Same(radius) => *radius,
            Self::Points(values) => values[v.index()],
            Self::Cells(values) => values[cell.index()],
        }
    }
}
