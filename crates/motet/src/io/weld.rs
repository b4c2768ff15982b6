//! Merges points where pieces of one mesh touch.

use crate::base::VertexId;
use crate::io::format::Notes;
use crate::mesh::{Mesh, firsts_at_place};

/// Merges points of different pieces at exactly the same place; the pieces begin at the points `starts`. The
/// first of the points is kept, with its values. A place where a single piece has several points, such as
/// both sides of a slit, is left unchanged, since the correspondence is unknown.
pub(super) fn weld(mesh: &mut Mesh, starts: &[usize], notes: &Notes) {
    let n = mesh.points.len();
    let mut starts: Vec<usize> = starts.iter().copied().filter(|&start| start < n).collect();
    starts.sort_unstable();
    starts.dedup();
    if starts.len() < 2 {
        return;
    }
    let mut firsts = firsts_at_place(&mesh.points);
    let n_split = split_ambiguous(&mut firsts, &starts);
    if n_split > 0 {
        notes.add(format!("pieces are not joined at {n_split} places where a piece has several points"));
    }
    let kept: Vec<usize> = (0..n).filter(|&v| firsts[v].index() == v).collect();
    if kept.len() == n {
        return;
    }
    notes.add(format!(
        "pieces are joined: {} points are merged with others at the same place",
        n - kept.len()
    ));
    let mut new = vec![VertexId::default(); n];
    kept.iter().enumerate().for_each(|(i, &v)| new[v] = VertexId::new(i));
    (0..n).for_each(|v| new[v] = new[firsts[v].index()]);
    keep_points(mesh, &kept, &new);
}

/// Restricts the mesh to the points `kept`, and replaces each vertex `v` of its cells by `new[v]`.
pub(super) fn keep_points(mesh: &mut Mesh, kept: &[usize], new: &[VertexId]) {
    mesh.cells = mesh.cells.renumbered(new);
    mesh.points = kept.iter().map(|&v| mesh.points[v]).collect();
    mesh.point_data = mesh.point_data.iter().map(|f| f.pick(kept.iter().copied())).collect();
}

/// Separates the points of places where a piece has several; returns the number of such places shared by
/// pieces.
fn split_ambiguous(firsts: &mut [VertexId], starts: &[usize]) -> usize {
    let mut last_piece = vec![usize::MAX; firsts.len()];
    let mut is_ambiguous = vec![false; firsts.len()];
    let mut piece = 0;
    for (v, first) in firsts.iter().map(|first| first.index()).enumerate() {
        while starts.get(piece).is_some_and(|&start| start <= v) {
            piece += 1;
        }
        is_ambiguous[first] |= last_piece[first] == piece;
        last_piece[first] = piece;
    }
    // If all points of a place belong to one piece, there was nothing to merge.
    let mut is_shared = vec![false; firsts.len()];
    (0..firsts.len())
        .for_each(|v| is_shared[firsts[v].index()] |= last_piece[firsts[v].index()] != piece_of(starts, v));
    let n = (0..firsts.len()).filter(|&v| is_ambiguous[v] && is_shared[v]).count();
    for (v, first) in firsts.iter_mut().enumerate().filter(|(_, first)| is_ambiguous[first.index()]) {
        *first = VertexId::new(v);
    }
    n
}

fn piece_of(starts: &[usize], v: usize) -> usize {
    starts.partition_point(|&start| start <= v)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{CellKind, Cells, Field};

    /// A mesh of points at these places on a line, each with a vertex cell.
    fn on_a_line(places: &[f64]) -> Mesh {
        let mut cells = Cells::new();
        (0..places.len()).for_each(|v| cells.push(CellKind::VERTEX, [VertexId::new(v)]));
        let mut mesh = Mesh::new(places.iter().map(|&x| [x, 0.0, 0.0]).collect(), cells);
        mesh.set_point_field(Field::scalars("at", places.to_vec()));
        mesh
    }

    fn welded(places: &[f64], starts: &[usize]) -> (Vec<f64>, Vec<u32>, Vec<String>) {
        let (mut mesh, notes) = (on_a_line(places), Notes::default());
        weld(&mut mesh, starts, &notes);
        mesh.validate().unwrap();
        let ids = mesh.cells.connectivity().items().iter().map(|v| v.0).collect();
        (mesh.points.iter().map(|p| p[0]).collect(), ids, notes.into_vec())
    }

    #[test]
    fn points_shared_by_pieces_are_merged() {
        let (places, ids, notes) = welded(&[0.0, 1.0, 1.0, 2.0, 2.0, -0.0], &[0, 2, 4]);
        assert_eq!((places, ids), (vec![0.0, 1.0, 2.0], vec![0, 1, 1, 2, 2, 0]));
        assert!(notes[0].contains("3 points"), "{notes:?}");
    }

    #[test]
    fn a_slit_of_one_piece_stays_open() {
        let (places, ids, notes) = welded(&[0.0, 1.0, 1.0, 2.0, 2.0, 3.0], &[0, 4]);
        assert_eq!((places, ids), (vec![0.0, 1.0, 1.0, 2.0, 3.0], vec![0, 1, 2, 3, 3, 4]));
        assert_eq!(notes.len(), 1, "a slit within a piece is not reported: {notes:?}");
        let (places, _, notes) = welded(&[1.0, 1.0, 1.0, 1.0], &[0, 2]);
        assert_eq!(places.len(), 4);
        assert!(notes[0].contains("at 1 places"), "{notes:?}");
        assert_eq!(welded(&[1.0, 1.0], &[0]).0, [1.0, 1.0]);
        assert_eq!(welded(&[f64::NAN, f64::NAN], &[0, 1]).0.len(), 2);
    }
}
