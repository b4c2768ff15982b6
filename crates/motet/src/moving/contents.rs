//! Cell arrays that are densities of contents: these stay in the cell while it moves, and are passed on where
//! cells change.

use crate::base::{CellId, Point};
use crate::geometry::tet;
use crate::geometry::vector::distance;
use crate::mesh::history::{History, Row};
use crate::mesh::{CellKind, Field, Labels, Mesh, Values};

/// Moves the vertices of a mesh to `points`. The cell arrays named in `contents` are densities of what stays
/// in its cell.
pub(super) fn move_points(mesh: &mut Mesh, points: &[Point], contents: &[String]) {
    for field in mesh.cell_data.iter_mut().filter(|field| contents.contains(&field.name)) {
        let n = field.components;
        for (cell, corners) in mesh.cells.tets() {
            let of = |points: &[Point]| tet::volume(corners.map(|v| points[v.index()])).abs();
            let grown = of(points) / of(&mesh.points);
            let is_number = grown > 0.0 && grown.is_finite();
            if grown == 1.0 || !is_number {
                continue;
            }
            for i in cell.index() * n..(cell.index() + 1) * n {
                if let Some(value) = field.values.get_f64(i) {
                    put(&mut field.values, i, value / grown);
                }
            }
        }
    }
    mesh.points.copy_from_slice(points);
}

/// After a change, passes the contents of removed tets to new ones: each gives all of it to the new tets that
/// overlap it, in proportion to the overlap. If vertices moved between a division and its reversal, a
/// restored tet does not have quite the volume of its parts, and a mean over what it overlaps would lose
/// some.
pub(super) fn pass_contents(before: &Mesh, after: &mut Mesh, history: &History, contents: &[String]) {
    let fields: Vec<&Field> = contents.iter().filter_map(|name| before.cell_field(name)).collect();
    if fields.is_empty() {
        return;
    }
    let heirs = Heirs::of(before, after, history);
    for field in fields {
        let Some(new) = after.cell_data.iter_mut().find(|new| new.name == field.name) else { continue };
        for i in 0..field.components {
            let place = |cell: CellId| cell.index() * field.components + i;
            let held = |old: CellId| field.values.get_f64(place(old)).unwrap_or(0.0) * volume(before, old);
            for (cell, row) in &heirs.rows {
                let parts = row.from.iter().zip(row.shares).filter(|(old, _)| heirs.taken[old.index()] > 0.0);
                let density = parts.map(|(&old, share)| held(old) * share / heirs.taken[old.index()]).sum();
                put(&mut new.values, place(*cell), density);
            }
            for &(old, heir, volume) in &heirs.of_lost {
                let density = new.values.get_f64(place(heir)).unwrap_or(0.0) + held(old) / volume;
                put(&mut new.values, place(heir), density);
            }
        }
    }
}

/// Stores a density. One beyond the range of single precision becomes infinite there, so that it shows.
fn put(values: &mut Values, i: usize, density: f64) {
    let is_set = values.set_f64(i, density);
    if let Values::F32(values) = values
        && !is_set
    {
        values[i] = density as f32;
    }
}

/// Who takes over from whom in a change.
struct Heirs<'a> {
    /// The rows of the new tets.
    rows: Vec<(CellId, Row<'a, CellId>)>,
    /// For each removed cell, the volume of new cells that is assigned to it.
    taken: Vec<f64>,
    /// For each removed tet that nothing overlaps, the nearest new one in its region, and the volume of that
    /// one.
    of_lost: Vec<(CellId, CellId, f64)>,
}

impl<'a> Heirs<'a> {
    fn of(before: &Mesh, after: &Mesh, history: &'a History) -> Self {
        let changed = history.cells.changed();
        let rows = changed.ids().iter().copied().zip(changed.iter());
        let rows: Vec<_> = rows.filter(|(cell, _)| after.cells.kind(*cell) == CellKind::TETRA).collect();
        let mut is_kept = vec![false; before.cells.len()];
        let kept = history.cells.kept().iter().filter_map(|old| old.get());
        kept.for_each(|old| is_kept[old.index()] = true);
        let mut taken = vec![0.0; before.cells.len()];
        for (cell, row) in &rows {
            let all = volume(after, *cell);
            let parts = row.from.iter().zip(row.shares).filter(|(old, _)| !is_kept[old.index()]);
            parts.for_each(|(old, share)| taken[old.index()] += all * share);
        }
        let mut lost: Vec<CellId> = before.cells.tets().map(|(cell, _)| cell).collect();
        lost.retain(|old| !is_kept[old.index()] && taken[old.index()] == 0.0);
        let of_lost = if lost.is_empty() { Vec::new() } else { heirs_of_lost(before, &lost, after, &rows) };
        Self { rows, taken, of_lost }
    }
}

fn heirs_of_lost(
    before: &Mesh,
    lost: &[CellId],
    after: &Mesh,
    new_tets: &[(CellId, Row<'_, CellId>)],
) -> Vec<(CellId, CellId, f64)> {
    let [was, is] = [before, after].map(Mesh::regions);
    let region =
        |labels: &Option<Labels>, cell: CellId| labels.as_ref().map(|labels| labels.ids[cell.index()]);
    let heir = |&old: &CellId| {
        let (place, of_old) = (centre(before, old), region(&was, old));
        let far = |cell: &CellId| distance(centre(after, *cell), place);
        let alike = new_tets.iter().map(|(cell, _)| *cell).filter(|cell| region(&is, *cell) == of_old);
        let heir = alike.min_by(|x, y| far(x).total_cmp(&far(y)))?;
        Some((old, heir, volume(after, heir)))
    };
    lost.iter().filter_map(heir).collect()
}

fn corners(mesh: &Mesh, cell: CellId) -> [Point; 4] {
    let vertices = mesh.cells.vertices(cell);
    [0, 1, 2, 3].map(|k| vertices.get(k).map_or([0.0; 3], |v| mesh.points[v.index()]))
}

fn volume(mesh: &Mesh, cell: CellId) -> f64 {
    tet::volume(corners(mesh, cell)).abs()
}

fn centre(mesh: &Mesh, cell: CellId) -> Point {
    tet::centroid(corners(mesh, cell))
}
