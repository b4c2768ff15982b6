//! One vertex joined to every facet round a cavity.

use crate::base::VertexId;
use crate::geometry::tet::FACETS;
use crate::kernel::{Behind, Change, Complex};

/// Fills the cavity of `change` with tets from `apex` to each facet of its boundary that does not have it. `false` when one of
/// them is not better than `bar`, or a wall lies within the cavity.
pub fn cone(complex: &Complex, apex: VertexId, bar: f64, change: &mut Change) -> bool {
    change.fill.clear();
    for i in 0..change.cavity.len() {
        let tet = change.cavity[i];
        let vertices = complex.vertices(tet);
        for (place, facet) in FACETS.into_iter().enumerate() {
            let is_inside = match complex.behind(tet, place) {
                Behind::Tet(half) => change.cavity.contains(&half.tet()),
                Behind::Wall(wall) => {
                    let other = complex.wall(wall).sides.iter().any(|side| {
                        !side.is_none() && side.tet() != tet && change.cavity.contains(&side.tet())
                    });
                    if other {
                        return false;
                    }
                    false
                }
            };
            let [a, b, c] = facet.map(|corner| vertices[corner]);
            if is_inside || a == apex || b == apex || c == apex {
                continue;
            }
            change.push(complex, [a, c, b, apex], complex.region(tet));
            if !(change.fill[change.fill.len() - 1].quality > bar) {
                return false;
            }
        }
    }
    true
}
