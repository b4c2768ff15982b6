//! Ghost cells, which a part of a parallel run copies from its neighbours, and hidden cells: not part of the
//! mesh.

use crate::base::{CellId, VertexId};
use crate::io::format::Notes;
use crate::io::select::restricted_to_cells;
use crate::io::weld::keep_points;
use crate::mesh::Mesh;

/// VTK's arrays: flags in `vtkGhostType` (since VTK 7), layer number in `vtkGhostLevels` (before).
const TYPE: &str = "vtkGhostType";
const LEVELS: &str = "vtkGhostLevels";
/// The flags `DUPLICATECELL` and `HIDDENCELL`.
const GHOST_OR_HIDDEN: i64 = 1 | 32;

/// Removes ghost cells and the points that only they use, and adds a note.
pub(super) fn remove_ghosts(mesh: &mut Mesh, notes: &Notes) {
    let Some(is_ghost) = ghosts(mesh) else { return };
    let n = is_ghost.iter().filter(|&&is| is).count();
    if n == 0 {
        return;
    }
    let (n_points, n_cells) = (mesh.points.len(), mesh.cells.len());
    let [mut by_ghosts, mut by_others] = [vec![false; n_points], vec![false; n_points]];
    for (cell, _, vertices) in mesh.cells.iter() {
        let used = if is_ghost[cell.index()] { &mut by_ghosts } else { &mut by_others };
        vertices.iter().for_each(|v| used[v.index()] = true);
    }
    *mesh = restricted_to_cells(mesh, |cell: CellId| !is_ghost[cell.index()]);
    let kept: Vec<usize> = (0..n_points).filter(|&v| by_others[v] || !by_ghosts[v]).collect();
    let mut new = vec![VertexId::default(); n_points];
    kept.iter().enumerate().for_each(|(i, &v)| new[v] = VertexId::new(i));
    keep_points(mesh, &kept, &new);
    for fields in [&mut mesh.cell_data, &mut mesh.point_data] {
        fields.retain(|f| f.name != TYPE && f.name != LEVELS);
    }
    notes.add(format!(
        "{n} of {n_cells} cells are skipped: ghost cells of a neighbouring part, or hidden cells"
    ));
}

fn ghosts(mesh: &Mesh) -> Option<Vec<bool>> {
    let numbers = |name: &str| {
        let field = mesh.cell_field(name).filter(|f| f.components == 1)?;
        field.values.to_i64().filter(|numbers| numbers.len() == mesh.cells.len())
    };
    let by_type = numbers(TYPE).map(|bits| bits.iter().map(|b| b & GHOST_OR_HIDDEN != 0).collect());
    by_type.or_else(|| numbers(LEVELS).map(|levels| levels.iter().map(|&l| l > 0).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Field, shapes};

    #[test]
    fn ghost_cells_and_points_only_they_use_are_removed() {
        let whole = shapes::box_grid([2; 3], [[0.0; 3], [1.0; 3]]);
        let volume = |mesh: &Mesh| crate::mesh::Summary::of(mesh).volume;
        for (name, ghost) in [(TYPE, 1u8), (TYPE, 33), (LEVELS, 2)] {
            let mut mesh = whole.clone();
            let n = mesh.cells.len();
            let right = |vertices: &[VertexId]| vertices.iter().all(|v| whole.points[v.index()][0] >= 0.5);
            let flags: Vec<u8> =
                whole.cells.iter().map(|(_, _, v)| if right(v) { ghost } else { 8 }).collect();
            mesh.set_cell_field(Field::scalars(
                name,
                if name == TYPE { flags } else { flags.iter().map(|f| f & 2).collect() },
            ));
            mesh.set_cell_field(Field::scalars("id", (0..n as i64).collect::<Vec<_>>()));
            mesh.points.push([9.0; 3]);
            mesh.point_data = vec![Field::scalars("p", vec![0.5; mesh.points.len()])];
            let notes = Notes::default();
            remove_ghosts(&mut mesh, &notes);
            mesh.validate().unwrap();
            assert!((volume(&mesh) - 0.5).abs() < 1e-12, "{}", volume(&mesh));
            assert_eq!(
                mesh.points.last(),
                Some(&[9.0; 3]),
                "an unused point does not belong to a ghost cell"
            );
            assert_eq!(mesh.points.iter().filter(|p| p[0] > 0.5).count(), 1);
            assert!(mesh.cell_field("id").is_some() && mesh.cell_field(name).is_none());
            assert!(notes.into_vec()[0].contains("ghost cells"));
        }
    }

    #[test]
    fn without_ghosts_nothing_changes() {
        let mut mesh = shapes::box_grid([1; 3], [[0.0; 3], [1.0; 3]]);
        mesh.set_cell_field(Field::scalars(TYPE, vec![0u8; mesh.cells.len()]));
        let (before, notes) = (mesh.clone(), Notes::default());
        remove_ghosts(&mut mesh, &notes);
        assert_eq!(mesh, before);
        assert!(notes.into_vec().is_empty());
    }
}
