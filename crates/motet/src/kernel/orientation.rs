//! Which way each tet is turned: by its neighbours, not by its volume.
//!
//! Some writers number the vertices of a tet in rising order, some the other way round than others. Two tets that share a facet
//! must see it from opposite sides: that tells one that is only *numbered* the other way from one that the motion has turned inside
//! out, which keeps the orientation of its neighbours and has a negative volume.

use crate::base::{Error, Point, Result, VertexId};
use crate::geometry::tet::{FACETS, volume_6};
use crate::kernel::link::HalfFacet;

/// Turns `tets` so that neighbours agree and each connected part has a positive volume in all; returns how many it turned.
/// `across` has the facet behind each facet.
pub(super) fn orient(
    tets: &mut [[VertexId; 4]],
    across: &[[HalfFacet; 4]],
    points: &[Point],
) -> Result<usize> {
    let mut is_turned = vec![false; tets.len()];
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
            volume += if is_turned[t] { -signed } else { signed };
            for (f, &other) in across[t].iter().enumerate() {
                if other.is_none() {
                    continue;
                }
                let o = other.tet().index();
                let agree = see_from_opposite_sides(facet(&tets[t], f), facet(&tets[o], other.facet()));
                let turned = is_turned[t] == agree;
                if !is_seen[o] {
                    is_seen[o] = true;
                    is_turned[o] = turned;
                    part.push(o);
                } else if is_turned[o] != turned {
                    return Err(Error::input("the tets around it cannot all be turned the same way")
                        .at(format!("tet {o}"))
                        .remedy("the mesh is one-sided: mesh it again"));
                }
            }
        }
        if volume < 0.0 {
            part.iter().for_each(|&t| is_turned[t] = !is_turned[t]);
        }
    }
    tets.iter_mut().zip(&is_turned).filter(|(_, turned)| **turned).for_each(|(tet, _)| tet.swap(2, 3));
    Ok(is_turned.iter().filter(|turned| **turned).count())
}

pub(super) fn facet(tet: &[VertexId; 4], i: usize) -> [VertexId; 3] {
    FACETS[i].map(|place| tet[place])
}

/// Whether one is an odd permutation of the other.
pub(super) fn see_from_opposite_sides(a: [VertexId; 3], b: [VertexId; 3]) -> bool {
    let start = b.iter().position(|&v| v == a[0]).unwrap_or(0);
    b[(start + 1) % 3] == a[2]
}
