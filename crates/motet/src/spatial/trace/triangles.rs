//! Rows of new triangles: each comes from the nearest removed triangle of its patch.

use std::collections::BTreeMap;

use super::{CellRow, Labelled, LocalChange};
use crate::base::{Error, Result, Threads, VertexId};
use crate::geometry::triangle;
use crate::spatial::NearestTriangle;

/// The row of each new triangle: the removed triangle of its patch that is nearest to its centroid.
pub(super) fn trace(change: &LocalChange<'_>) -> Result<Vec<CellRow>> {
    let mut by_patch: BTreeMap<i32, Vec<&Labelled<3>>> = BTreeMap::new();
    for triangle in change.removed_triangles {
        by_patch.entry(triangle.label).or_default().push(triangle);
    }
    let patches: BTreeMap<i32, (NearestTriangle, Vec<&Labelled<3>>)> = by_patch
        .into_iter()
        .map(|(patch, removed)| {
            let vertices: Vec<[VertexId; 3]> = removed.iter().map(|t| t.vertices).collect();
            (patch, (NearestTriangle::new(change.old_points, &vertices, &Threads::single()), removed))
        })
        .collect();
    let row = |new: &Labelled<3>| {
        let centre = triangle::centroid(new.vertices.map(|v| change.new_points[v.index()]));
        let nearest = patches
            .get(&new.label)
            .and_then(|(search, removed)| search.closest(centre).map(|found| removed[found.triangle].cell));
        let old = nearest.ok_or_else(|| no_source(new))?;
        Ok((new.cell, vec![(old, 1.0)], old))
    };
    change.new_triangles.iter().map(row).collect()
}

fn no_source(new: &Labelled<3>) -> Error {
    Error::input(format!("is new on patch {}, but no triangle of that patch was removed", new.label))
        .at(format!("cell {}", new.cell))
        .remedy("list the removed triangles that it replaces, on the same patch")
}
