//! Lines and corners that a new surface keeps: borders of labels, rims, edges of more than two triangles,
//! creases.

use super::lines::{Line, Lines};
use super::original::is_thin;
use super::sheet::{Sheet, edges_of};
use crate::base::{Point, VertexId};
use crate::geometry::triangle::area_vector;
use crate::geometry::vector::{distance, dot, sub, unit};

/// A line runs straight through a vertex if it bends by less than this: cosine of 45 degrees.
const MIN_STRAIGHT: f64 = 0.707;

/// What may happen to a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// It moves on the surface.
    Free,
    /// It moves along its line.
    OnLine,
    /// It stays.
    Corner,
}

/// Lines, and the kind of each vertex.
#[derive(Clone, Debug)]
pub(super) struct Features {
    pub(super) lines: Lines,
    pub(super) kinds: Vec<Kind>,
    /// Whether a vertex stays, for the first vertices; the others do not have to.
    pub(super) held: Vec<bool>,
}

impl Features {
    /// The features of a sheet. Creases are edges whose triangles meet at more than `max_angle` degrees, if
    /// both are at least `least_height` high: the normals of lower ones say nothing.
    pub(super) fn of(sheet: &Sheet, max_angle: f64, least_height: f64) -> Self {
        let min_cosine = max_angle.to_radians().cos();
        let mut lines = Lines::new(sheet.points.len());
        for edge in sheet.edges() {
            let is_border = is_border(sheet, edge);
            if is_border || is_crease(sheet, edge, min_cosine, least_height) {
                lines.insert(edge, Line { places: Vec::new(), is_crease: !is_border });
            }
        }
        let mut features = Self { lines, kinds: vec![Kind::Free; sheet.points.len()], held: Vec::new() };
        (0..sheet.points.len()).for_each(|v| features.classify(sheet, VertexId::new(v)));
        features
    }

    fn classify(&mut self, sheet: &Sheet, v: VertexId) {
        self.kinds[v.index()] = match self.line_ends(sheet, v)[..] {
            _ if self.is_held(v) || !is_one_fan(sheet, v) => Kind::Corner,
            [] => Kind::Free,
            [a, b] if is_straight(sheet, [a, v, b]) => Kind::OnLine,
            _ => Kind::Corner,
        };
    }

    /// Whether a vertex has to stay.
    pub(super) fn is_held(&self, v: VertexId) -> bool {
        self.held.get(v.index()) == Some(&true)
    }

    /// Gives up the creases at a vertex. Returns whether there were any.
    pub(super) fn release(&mut self, sheet: &Sheet, v: VertexId) -> bool {
        let ends = self.line_ends(sheet, v);
        let creases = ends.into_iter().filter(|&u| self.lines.get([u, v]).is_some_and(|line| line.is_crease));
        let creases: Vec<VertexId> = creases.collect();
        for &u in &creases {
            self.lines.remove([u, v]);
            self.classify(sheet, u);
        }
        self.classify(sheet, v);
        !creases.is_empty()
    }

    /// Whether an edge is one of a line.
    pub(super) fn is_line(&self, edge: [VertexId; 2]) -> bool {
        self.lines.get(edge).is_some()
    }

    pub(super) fn kind(&self, v: VertexId) -> Kind {
        self.kinds[v.index()]
    }

    /// The other ends of the lines at a vertex.
    pub(super) fn line_ends(&self, sheet: &Sheet, v: VertexId) -> Vec<VertexId> {
        sheet.neighbours(v).into_iter().filter(|&u| self.is_line([u, v])).collect()
    }
}

/// Whether a surface ends, branches or changes its label or its side at an edge.
fn is_border(sheet: &Sheet, [u, v]: [VertexId; 2]) -> bool {
    let at: Vec<u32> = sheet.at_edge(u, v).collect();
    let &[s, t] = at.as_slice() else { return true };
    let runs = |t: u32| edges_of(sheet.triangle(t)).contains(&[u, v]);
    sheet.label(s) != sheet.label(t) || runs(s) == runs(t)
}

fn is_crease(sheet: &Sheet, [u, v]: [VertexId; 2], min_cosine: f64, least_height: f64) -> bool {
    let corners = sheet.at_edge(u, v).map(|t| sheet.corners(t));
    let normals: Vec<Point> = corners
        .filter(|corners| !is_thin(*corners, least_height))
        .filter_map(|corners| unit(area_vector(corners)))
        .collect();
    matches!(normals[..], [m, n] if dot(m, n) < min_cosine)
}

fn is_straight(sheet: &Sheet, ends: [VertexId; 3]) -> bool {
    let [a, v, b] = ends.map(|v| sheet.points[v.index()]);
    let towards = |from: Point, to: Point| unit(sub(to, from));
    towards(a, v).zip(towards(v, b)).is_none_or(|(m, n)| dot(m, n) > MIN_STRAIGHT)
}

/// Whether the triangles at a vertex are one fan between its lines: they are connected across its edges.
fn is_one_fan(sheet: &Sheet, v: VertexId) -> bool {
    let star = sheet.star(v);
    let Some(&first) = star.first() else { return true };
    let (mut reached, mut next) = (vec![first], vec![first]);
    while let Some(t) = next.pop() {
        for u in sheet.triangle(t).into_iter().filter(|u| *u != v) {
            for other in sheet.at_edge(v, u) {
                if !reached.contains(&other) {
                    reached.push(other);
                    next.push(other);
                }
            }
        }
    }
    reached.len() == star.len()
}

/// The length of an edge.
pub(super) fn length(sheet: &Sheet, [u, v]: [VertexId; 2]) -> f64 {
    distance(sheet.points[u.index()], sheet.points[v.index()])
}
