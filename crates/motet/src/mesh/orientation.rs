//! The orientation of tets, derived from their neighbours rather than from their volume.
//!
//! Writers differ in the orientation of their tets; some simply number the vertices in rising order. Two tets
//! that share a facet must see it from opposite sides. This distinguishes a tet that is only *numbered* the
//! other way around from one that a motion has turned inside out, which agrees with its neighbours but has a
//! negative volume.

use crate::base::{Point, TetId, VertexId};
use crate::geometry::predicates::orient3d;
use crate::geometry::tet::{FACETS, volume_6};

/// For a facet of a tet, the neighbour across it and the same facet there, all by index; `None` on the
/// boundary.
pub(crate) trait Across: Fn(usize, usize) -> Option<(usize, usize)> {}
impl<F: Fn(usize, usize) -> Option<(usize, usize)>> Across for F {}

/// Reorients `tets` so that neighbours agree and each connected part has a positive total volume; returns
/// which tets were reversed.
///
/// # Errors
/// A tet that cannot agree with all of its neighbours, if there is one, since the mesh is then not
/// orientable. No tet is changed in that case.
pub(crate) fn orient(
    tets: &mut [[VertexId; 4]],
    across: impl Across,
    points: &[Point],
) -> Result<Vec<bool>, TetId> {
    let mut is_reversed = vec![false; tets.len()];
    let mut is_seen = vec![false; tets.len()];
    let mut part = Vec::new();
    for start in 0..tets.len() {
        if is_seen[start] {
            continue;
        }
        part.clear();
        part.push(start);
        is_seen[start] = true;
        let mut volume = 0.0;
        let mut i = 0;
        while i < part.len() {
            let t = part[i];
            i += 1;
            let signed = volume_6(tets[t].map(|v| points[v.index()]));
            if signed.is_finite() {
                volume += if is_reversed[t] { -signed } else { signed };
            }
            for (f, (o, of_other)) in (0..4).filter_map(|f| Some((f, across(t, f)?))) {
                let agree = see_from_opposite_sides(facet(&tets[t], f), facet(&tets[o], of_other));
                let reversed = is_reversed[t] == agree;
                if !is_seen[o] {
                    is_seen[o] = true;
                    is_reversed[o] = reversed;
                    part.push(o);
                } else if is_reversed[o] != reversed {
                    return Err(TetId::new(o));
                }
            }
        }
        if volume < 0.0 {
            part.iter().for_each(|&t| is_reversed[t] = !is_reversed[t]);
        }
    }
    tets.iter_mut().zip(&is_reversed).filter(|(_, reversed)| **reversed).for_each(|(tet, _)| tet.swap(2, 3));
    Ok(is_reversed)
}

/// The tets that are folded over others, in rising order: as numbered in the file, they were positive like a
/// neighbour across a facet, but lay on the same side of that facet. `tets` are oriented by [`orient`].
///
/// If the file numbers tets now one way, now the other, such a tet cannot be distinguished from one that a
/// motion has inverted, and none is reported.
pub(crate) fn folded(
    tets: &[[VertexId; 4]],
    points: &[Point],
    is_reversed: &[bool],
    across: impl Across,
) -> Vec<TetId> {
    let is_positive = |t: usize| {
        let [a, b, c, d] = tets[t].map(|v| points[v.index()]);
        orient3d(a, b, c, d) > 0
    };
    let neighbors = |t: usize| [0, 1, 2, 3].map(|f| across(t, f)).into_iter().flatten().map(|(o, _)| o);
    let (mut is_folded, mut found) = (vec![false; tets.len()], Vec::new());
    for t in 0..tets.len() {
        for o in neighbors(t).filter(|&o| is_reversed[o] != is_reversed[t]) {
            match (is_positive(t), is_positive(o)) {
                (true, true) => return Vec::new(),
                (false, true) if !is_folded[t] => {
                    is_folded[t] = true;
                    found.push(t);
                }
                _ => {}
            }
        }
    }
    // Inverted neighbours that agree with a folded tet are folded with it.
    let mut next = 0;
    while let Some(&t) = found.get(next) {
        next += 1;
        for o in neighbors(t) {
            if !is_folded[o] && is_reversed[o] == is_reversed[t] && !is_positive(o) {
                is_folded[o] = true;
                found.push(o);
            }
        }
    }
    found.sort_unstable();
    found.into_iter().map(TetId::new).collect()
}

/// The index of a facet of a tet once [`orient`] has reversed the tet.
pub(crate) fn facet_after_turning(facet: usize) -> usize {
    [0, 1, 3, 2][facet]
}

pub(crate) fn facet(tet: &[VertexId; 4], i: usize) -> [VertexId; 3] {
    FACETS[i].map(|place| tet[place])
}

/// Whether two facets with the same vertices are odd permutations of each other.
pub(crate) fn see_from_opposite_sides(a: [VertexId; 3], b: [VertexId; 3]) -> bool {
    let start = b.iter().position(|&v| v == a[0]).unwrap_or(0);
    b[(start + 1) % 3] == a[2]
}
