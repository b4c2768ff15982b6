//! Where the points and triangles of a new surface come from: places on the given one, through what was
//! repaired.

use super::super::compact::used_vertices;
use super::super::surfaces::Surfaces;
use crate::base::{CellId, MaybeId, Result, Threads, VertexId, sorted_ids};
use crate::mesh::history::{History, Ledger, Origins, Rows};
use crate::mesh::{CellKind, Mesh, Surface};
use crate::preflight::Repaired;
use crate::surface::{Place, Places, places};

/// A given surface on its way to be made even.
pub(super) struct Given<'a> {
    pub(super) mesh: &'a Mesh,
    /// The surface of the mesh.
    pub(super) given: &'a Surface,
    /// What its repair did.
    pub(super) repaired: &'a Repaired,
    /// The surface as repaired and smoothed.
    pub(super) surfaces: &'a Surfaces,
}

/// The history from the given mesh to the mesh of the triangles of a new surface and the points that they
/// use. Points of the new surface with the ids of given ones are those, or were.
///
/// # Errors
/// Never, for surfaces that belong together.
pub(super) fn history(from: &Given<'_>, new: &Surfaces, threads: &Threads) -> Result<History> {
    let (old, new_labels) = (from.surfaces, numbers(&new.patches));
    let old_labels = numbers(&old.patches);
    let places = places(
        (&old.points, &old.triangles, &old_labels),
        (&new.points, &new.triangles, &new_labels),
        threads,
    );
    let points = from.mesh.points.as_slice();
    let is_kept = |v: VertexId| points.get(v.index()) == Some(&new.points[v.index()]);
    let on_repaired = vertices(old, new, &places, is_kept)?;
    Ok(History {
        vertices: repair(from)?.then(&on_repaired),
        cells: cells(from, new, &places, is_kept)?,
        ledger: Ledger::default(),
    })
}

/// The origins of the points that triangles of the new surface use.
fn vertices(
    old: &Surfaces,
    new: &Surfaces,
    places: &Places,
    is_kept: impl Fn(VertexId) -> bool,
) -> Result<Origins<VertexId>> {
    let is_used = used_vertices(new.points.len(), new.triangles.as_flattened().iter());
    let (mut kept, mut rows) = (Vec::new(), Rows::new());
    for v in (0..new.points.len()).map(VertexId::new).filter(|v| is_used[v.index()]) {
        match places.points[v.index()] {
            Some(place) if !is_kept(v) => {
                let (parts, main) = row(old, &place);
                rows.push(VertexId::new(kept.len()), &parts, main);
                kept.push(MaybeId::NONE);
            }
            _ => kept.push(v.into()),
        }
    }
    Origins::new(old.points.len(), kept, rows)
}

/// The corners of the triangle of a place, with their weights, and the corner with the largest one.
fn row(old: &Surfaces, place: &Place) -> ([(VertexId, f64); 3], VertexId) {
    let corners = old.triangles[place.triangle];
    let parts = [0, 1, 2].map(|k| (corners[k], place.weights[k]));
    let main = (1..3).fold(0, |best, k| if parts[k].1 > parts[best].1 { k } else { best });
    (parts, corners[main])
}

/// The origins of the points of the repaired surface: the given ones, and new ones where triangles were
/// divided.
fn repair(from: &Given<'_>) -> Result<Origins<VertexId>> {
    let n = from.mesh.points.len();
    let mut kept: Vec<MaybeId<VertexId>> = (0..n).map(|v| VertexId::new(v).into()).collect();
    let mut rows = Rows::new();
    for (corners, weights) in &from.repaired.new_points {
        let parts = [0, 1, 2].map(|k| (corners[k], weights[k]));
        rows.push(VertexId::new(kept.len()), &parts, corners[0]);
        kept.push(MaybeId::NONE);
    }
    Origins::new(n, kept, rows)
}

/// The origins of the triangles: the nearest given ones of the same patch.
fn cells(
    from: &Given<'_>,
    new: &Surfaces,
    places: &Places,
    is_kept: impl Fn(VertexId) -> bool,
) -> Result<Origins<CellId>> {
    let (mut kept, mut rows) = (Vec::new(), Rows::new());
    for (k, (triangle, &nearest)) in new.triangles.iter().zip(&places.triangles).enumerate() {
        let given = from.repaired.takes_after[nearest] as usize;
        let cell = from.given.triangle_to_cell[given];
        let is_same = from.mesh.cells.kind(cell) == CellKind::TRIANGLE
            && sorted_ids(*triangle) == sorted_ids(from.given.triangles[given])
            && triangle.iter().all(|v| is_kept(*v));
        match is_same {
            true => kept.push(cell.into()),
            false => {
                rows.push(CellId::new(k), &[(cell, 1.0)], cell);
                kept.push(MaybeId::NONE);
            }
        }
    }
    Origins::new(from.mesh.cells.len(), kept, rows)
}

/// Patches as numbers from 0 on, by rising label.
pub(super) fn numbers(patches: &[i32]) -> Vec<u32> {
    let mut used = patches.to_vec();
    used.sort_unstable();
    used.dedup();
    patches.iter().map(|patch| used.partition_point(|other| other < patch) as u32).collect()
}
