//! Merges vertices that are near each other.

use super::report::RepairKind;
use super::work::Work;
use crate::base::VertexId;
use crate::geometry::vector::{distance, in_range};
use crate::mesh::firsts_at_place;
use crate::spatial::{Bounds, BoxTree};

/// Merges the vertices that triangles use. Returns for each vertex the one that stands for it.
pub(super) fn merge(work: &mut Work, within: f64) -> Vec<VertexId> {
    let mut is_used = vec![false; work.points.len()];
    work.pieces.iter().flat_map(|piece| piece.vertices).for_each(|v| is_used[v.index()] = true);
    let kept = if within > 0.0 { near(work, &is_used, within) } else { at_one_place(work, &is_used) };
    for v in (0..kept.len()).map(VertexId::new).filter(|v| kept[v.index()] != *v) {
        work.record(RepairKind::MergedVertex, Vec::new(), vec![v, kept[v.index()]]);
    }
    work.pieces.iter_mut().for_each(|piece| piece.vertices = piece.vertices.map(|v| kept[v.index()]));
    kept
}

/// For each vertex in use, the first vertex in use at its place; other vertices stand for themselves.
fn at_one_place(work: &Work, is_used: &[bool]) -> Vec<VertexId> {
    let mut kept = firsts_at_place(work.points);
    let mut first_in_use = vec![None; kept.len()];
    for v in (0..kept.len()).map(VertexId::new) {
        let place = kept[v.index()];
        kept[v.index()] = if is_used[v.index()] { *first_in_use[place.index()].get_or_insert(v) } else { v };
    }
    kept
}

/// Goes through the vertices in order: each that is not merged yet absorbs all later ones that are near.
/// Those that remain are apart, so each vertex is near only a few of them.
fn near(work: &Work, is_used: &[bool], within: f64) -> Vec<VertexId> {
    let points = work.points;
    let around = |v: usize| -> Bounds {
        let p = points[v];
        [p.map(|x| x - within), p.map(|x| x + within)]
    };
    let of = |v: usize| if is_used[v] { [points[v]; 2] } else { [[f64::NAN; 3]; 2] };
    let tree = BoxTree::new(&(0..points.len()).map(of).collect::<Vec<_>>());
    let mut kept: Vec<VertexId> = (0..points.len()).map(VertexId::new).collect();
    let mut found = Vec::new();
    for v in (0..points.len()).filter(|&v| is_used[v] && in_range(points[v])) {
        if kept[v].index() != v {
            continue;
        }
        tree.touching(around(v), &mut found);
        for &u in found.iter().filter(|&&u| u as usize > v) {
            let is_alone = kept[u as usize].0 == u;
            if is_alone && distance(points[v], points[u as usize]) < within {
                kept[u as usize] = VertexId::new(v);
            }
        }
    }
    kept
}
