//! Cells with more points than their kind has, as some writers produce them: quads with eight ids from a
//! mesher that pads, lines with a third point for their orientation. VTK ignores surplus points; they are
//! removed with a note.

use crate::base::VertexId;
use crate::io::format::Notes;
use crate::mesh::CellKind;

/// Truncates the lists of such cells. Invalid offsets are left to later checks.
pub(super) fn trim(kinds: &[CellKind], offsets: &mut Vec<u32>, vertices: &mut Vec<VertexId>, notes: &Notes) {
    let too_long = |kind: CellKind, n: u32| kind.n_vertices().filter(|&most| n as usize > most);
    let is_too_long = |(&kind, w): (&CellKind, &[u32])| too_long(kind, w[1].saturating_sub(w[0])).is_some();
    let ascends = offsets.windows(2).all(|w| w[0] <= w[1]);
    if !kinds.iter().zip(offsets.windows(2)).any(is_too_long)
        || !ascends
        || offsets.last().is_none_or(|&end| end as usize > vertices.len())
    {
        return;
    }
    let mut short = vec![0u32];
    let mut kept = Vec::with_capacity(vertices.len());
    for (&kind, ends) in kinds.iter().zip(offsets.windows(2)) {
        let (start, end) = (ends[0], ends[1]);
        let most = too_long(kind, end - start);
        if let Some(most) = most {
            let (label, n) = (kind.label(), end - start);
            notes.add(format!("{label} cells have {n} points: only the first {most} are kept"));
        }
        let end = most.map_or(end, |most| start + most as u32);
        kept.extend_from_slice(&vertices[start as usize..end as usize]);
        short.push(kept.len() as u32);
    }
    (*offsets, *vertices) = (short, kept);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surplus_points_are_removed_and_reported() {
        let kinds = [CellKind::LINE, CellKind::POLYGON, CellKind::LINE];
        let mut offsets = vec![0, 3, 8, 10];
        let mut vertices: Vec<VertexId> = (0..10).map(VertexId).collect();
        let notes = Notes::default();
        trim(&kinds, &mut offsets, &mut vertices, &notes);
        assert_eq!(offsets, [0, 2, 7, 9]);
        assert_eq!(vertices, [0, 1, 3, 4, 5, 6, 7, 8, 9].map(VertexId));
        assert_eq!(notes.into_vec(), ["line cells have 3 points: only the first 2 are kept"]);
    }
}
