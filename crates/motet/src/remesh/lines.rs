//! Lines as they were given, and how far they may stray: as walls do from their patches, lines stay within a
//! distance of the lines of their label.

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

    /// Whether the lines that a change inserts or moves stay within `reach` of the first ones of their label,
    /// and the place that a vertex leaves lies within `reach` of the new ones.
    pub(super) fn accepts(&self, complex: &Complex, change: &Change, reach: f64) -> bool {
        let lines = lines_after(complex, change);
        let covers = |left: Point| lines.iter().any(|(_, ends)| distance(on(*ends, left), left) <= reach);
        lines.iter().all(|(label, ends)| self.is_near(*label, *ends, reach))
            && (lines.is_empty() || left_behind(complex, change).is_none_or(covers))
    }

    /// Whether a segment is near the lines of its label, sampled at its ends, its midpoint and the midpoints
    /// of its halves.
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

/// The point of a segment closest to `p`.
fn on([a, b]: [Point; 2], p: Point) -> Point {
    add(a, scale(sub(b, a), segment::closest([a, b], p)))
}

/// The place from which a change moves or removes a vertex.
fn left_behind(complex: &Complex, change: &Change) -> Option<Point> {
    match change.vertex {
        VertexChange::Move(v, _) | VertexChange::Remove(v) => Some(complex.point(v)),
        VertexChange::None | VertexChange::Insert(..) => None,
    }
}

/// The lines that a change inserts, and the lines of a vertex that it moves, at their new place.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{TetId, VertexId};
    use crate::kernel::{NewLine, Star};
    use crate::mesh::TetMesh;

    /// A fan of tets around a line from (0, 0, 0) to (1, 0, 0) whose evenly spaced inner vertices have these
    /// heights; label 1.
    fn fan(heights: &[f64]) -> Complex {
        let n = heights.len() + 1;
        let height = |i: usize| if i == 0 || i == n { 0.0 } else { heights[i - 1] };
        let mut points: Vec<Point> = (0..=n).map(|i| [i as f64 / n as f64, height(i), 0.0]).collect();
        points.extend([[0.5, -2.0, 0.0], [0.5, 1.0, 2.0], [0.5, 1.0, -2.0]]);
        let mut mesh = TetMesh::new(
            points,
            (0..n)
                .flat_map(|i| {
                    [[n + 1, n + 2], [n + 2, n + 3], [n + 3, n + 1]]
                        .map(|[a, b]| [i, i + 1, a, b].map(VertexId::new))
                })
                .collect(),
        );
        mesh.lines = (0..n).map(|i| [i, i + 1].map(VertexId::new)).collect();
        mesh.line_labels = vec![1; n];
        let mut complex = Complex::new(&mesh).unwrap();
        complex.adapt_surface();
        complex
    }

    fn label(complex: &Complex) -> u32 {
        complex.line_label(complex.lines()[0].1.source)
    }

    #[test]
    fn a_segment_is_near_where_all_of_it_is_near_to_lines_of_its_label() {
        let straight = fan(&[0.0]);
        let (first, label) = (FirstLines::of(&straight), label(&straight));
        let ends = [[0.0; 3], [1.0, 0.0, 0.0]];
        assert!(first.is_near(label, ends, 1e-12) && !first.is_near(label + 1, ends, 1.0));
        for end in 0..2 {
            let mut off = ends;
            off[end][2] = 0.1;
            assert!(first.is_near(label, off, 0.1 + 1e-12) && !first.is_near(label, off, 0.099));
        }
        // The midpoint of the segment, or that of one of its halves, is away from a line that bends.
        for heights in [[0.0, 0.2, 0.0], [0.2, 0.0, 0.0], [0.0, 0.0, 0.2]] {
            let first = FirstLines::of(&fan(&heights));
            assert!(first.is_near(label, ends, 0.2) && !first.is_near(label, ends, 0.1), "{heights:?}");
        }
    }

    #[test]
    fn a_moved_vertex_takes_its_lines_along() {
        let complex = fan(&[0.0]);
        let first = FirstLines::of(&complex);
        let mut star = Star::default();
        star.gather(&complex, VertexId(1));
        let accepts = |to: Point, reach: f64| {
            let mut change = Change::default();
            change.cavity.extend(&star.tets);
            change.vertex = VertexChange::Move(VertexId(1), to);
            first.accepts(&complex, &change, reach)
        };
        assert!(accepts([0.3, 0.0, 0.0], 1e-12), "along the line");
        assert!(!accepts([0.3, 0.1, 0.0], 0.09) && accepts([0.3, 0.1, 0.0], 0.11));
        // The midpoints of the two lines are near, their common end is not.
        assert!(!accepts([0.5, 0.0, 0.16], 0.15));
    }

    #[test]
    fn the_end_of_a_spike_is_not_left_behind() {
        // Both legs of the spike are near the line that joins their feet; its tip is not.
        let mut complex = fan(&[0.0]);
        let mut change = Change::default();
        change
            .lines
            .push(NewLine { vertices: [VertexId(0), VertexId(2)], source: complex.lines()[0].1.source });
        let first = FirstLines::of(&complex);
        assert!(first.accepts(&complex, &change, 0.1));
        change.vertex = VertexChange::Remove(VertexId(1));
        assert!(first.accepts(&complex, &change, 0.1), "it lies on what comes");
        complex = fan(&[0.3]);
        assert!(!first.accepts(&complex, &change, 0.1) && first.accepts(&complex, &change, 0.31));
        change.vertex = VertexChange::Move(VertexId(1), [0.5, 0.0, 0.0]);
        assert!(!first.accepts(&complex, &change, 0.1));
        change.lines.clear();
        change.cavity = vec![TetId(0)];
        change.vertex = VertexChange::Remove(VertexId(1));
        assert!(first.accepts(&complex, &change, 0.0), "where no line comes, none is looked for");
    }
}
