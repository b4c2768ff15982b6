//! Lines as they came, and how far they may stray: as walls do from their patches, lines stay within a distance of those of their label.

use std::collections::BTreeMap;

use crate::base::Point;
use crate::geometry::segment;
use crate::geometry::vector::{add, distance, scale, sub};
use crate::kernel::{Change, Complex, VertexChange};
use crate::mesh::bounds;
use crate::spatial::BoxTree;

/// The lines of the first mesh, label by label.
pub(super) struct FirstLines {
    labels: BTreeMap<u32, OfLabel>,
}

struct OfLabel {
    tree: BoxTree,
    segments: Vec<[Point; 2]>,
}

impl FirstLines {
    pub(super) fn of(complex: &Complex) -> Self {
        let mut labels: BTreeMap<u32, Vec<[Point; 2]>> = BTreeMap::new();
        for (edge, line) in complex.lines() {
            labels.entry(complex.line_label(line.source)).or_default().push(edge.map(|v| complex.point(v)));
        }
        let of_label = |segments: Vec<[Point; 2]>| {
            let boxes: Vec<_> = segments.iter().map(|&ends| bounds(&ends).unwrap_or_default()).collect();
            OfLabel { tree: BoxTree::new(&boxes), segments }
        };
        Self { labels: labels.into_iter().map(|(label, segments)| (label, of_label(segments))).collect() }
    }

    /// Whether the lines that a change brings or moves stay within `reach` of those that were there, and what a vertex leaves behind stays within `reach` of them.
    pub(super) fn accepts(&self, complex: &Complex, change: &Change, reach: f64) -> bool {
        let lines = lines_after(complex, change);
        let covers = |left: Point| lines.iter().any(|(_, ends)| distance(on(*ends, left), left) <= reach);
        lines.iter().all(|(label, ends)| self.is_near(*label, *ends, reach))
            && (lines.is_empty() || left_behind(complex, change).is_none_or(covers))
    }

    /// Looks at the ends, the middle and the middles of the halves.
    fn is_near(&self, label: u32, [a, b]: [Point; 2], reach: f64) -> bool {
        let Some(OfLabel { tree, segments }) = self.labels.get(&label) else { return false };
        [0.0, 0.25, 0.5, 0.75, 1.0].into_iter().all(|share| {
            let p = add(scale(a, 1.0 - share), scale(b, share));
            let away = |id: u32| {
                let off = distance(on(segments[id as usize], p), p);
                Some((off * off, ()))
            };
            tree.nearest(p, away).is_some_and(|(squared, _, ())| squared <= reach * reach)
        })
    }
}

/// The place of a segment closest to a point.
fn on([a, b]: [Point; 2], p: Point) -> Point {
    add(a, scale(sub(b, a), segment::closest([a, b], p)))
}

/// The place that a change takes a vertex from.
fn left_behind(complex: &Complex, change: &Change) -> Option<Point> {
    match change.vertex {
        VertexChange::Move(v, _) | VertexChange::Remove(v) => Some(complex.point(v)),
        VertexChange::None | VertexChange::Insert(..) => None,
    }
}

/// The lines that a change brings, and those of a vertex that it moves, where they are then.
fn lines_after(complex: &Complex, change: &Change) -> Vec<(u32, [Point; 2])> {
    let mut lines: Vec<(u32, [Point; 2])> = Vec::new();
    for new in &change.lines {
        lines.push((complex.line_label(new.source), change.corners(complex, new.vertices)));
    }
    if let VertexChange::Move(moved, _) = change.vertex {
        for other in complex.line_neighbors(&change.cavity, moved) {
            let Some(line) = complex.line(moved, other) else { continue };
            lines.push((complex.line_label(line.source), change.corners(complex, [moved, other])));
        }
    }
    lines
}
