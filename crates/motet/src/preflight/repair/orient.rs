//! Reverses triangles so that neighbours face the same side, and closed parts outward.

use super::Repairs;
use super::report::RepairKind;
use super::work::Work;
use crate::base::{Csr, VertexId};
use crate::geometry::triangle::centroid;
use crate::preflight::parts::Parts;
use crate::preflight::sides::{Side, edges};
use crate::spatial::WindingNumber;

pub(super) fn orient(work: &mut Work, repairs: &Repairs) {
    let lists = work.lists();
    let sides = work.sides(&lists);
    let parts = Parts::new(work.pieces.len(), &sides);
    let mut reversals = Reversals::new(work.pieces.len(), &sides);
    for (part, _) in parts.iter() {
        match reversals.of_part(&part) {
            Some(reversed) => reversed.into_iter().for_each(|t| work.reverse(t)),
            None => {
                let (old, vertices) = (work.old(part[0]), work.pieces[part[0] as usize].vertices.to_vec());
                work.record(RepairKind::LeftOneSided, vec![old], vertices);
            }
        }
    }
    if !repairs.keep_inward {
        orient_outward(work, repairs.unite || repairs.wrap.is_some());
    }
}

/// Turns closed parts outward; with `keep_voids` only those that do not lie inside the rest.
fn orient_outward(work: &mut Work, keep_voids: bool) {
    let lists = work.lists();
    let sides = work.sides(&lists);
    let inward = Parts::new(work.pieces.len(), &sides).inward(&lists.surfaces(work));
    let is_void = |part: &Vec<u32>| {
        let of = |t: u32| work.pieces[t as usize].vertices;
        let rest = (0..work.pieces.len() as u32).filter(|t| part.binary_search(t).is_err());
        let rest: Vec<[VertexId; 3]> = rest.map(of).collect();
        let at = centroid(of(part[0]).map(|v| work.points[v.index()]));
        WindingNumber::new(work.points, &rest).at(at) > 0.5
    };
    let turned: Vec<Vec<u32>> = inward.into_iter().filter(|part| !keep_voids || !is_void(part)).collect();
    turned.into_iter().flatten().for_each(|t| work.reverse(t));
}

/// Which triangles have to be reversed, found by going from neighbour to neighbour.
struct Reversals {
    /// The neighbours of each triangle, and whether they face different sides.
    neighbors: Csr<(u32, bool)>,
    /// For each triangle that was reached: whether it has to be reversed if the first one of its part is not.
    is_reversed: Vec<Option<bool>>,
}

impl Reversals {
    fn new(n_triangles: usize, sides: &[Side]) -> Self {
        let pairs = || {
            edges(sides).filter(|same| same.len() == 2).flat_map(|same| {
                let differs = same[0].is_forward == same[1].is_forward;
                let [x, y] = [same[0].triangle, same[1].triangle];
                [(x as usize, (y, differs)), (y as usize, (x, differs))]
            })
        };
        Self { neighbors: Csr::from_pairs(n_triangles, pairs), is_reversed: vec![None; n_triangles] }
    }

    /// The fewest triangles of a part that have to be reversed so that all face the same side; `None` if that
    /// is impossible.
    fn of_part(&mut self, part: &[u32]) -> Option<Vec<u32>> {
        let mut open = vec![part[0]];
        self.is_reversed[part[0] as usize] = Some(false);
        while let Some(t) = open.pop() {
            let own = self.is_reversed[t as usize] == Some(true);
            for &(next, differs) in self.neighbors.list(t as usize) {
                match self.is_reversed[next as usize] {
                    None => {
                        self.is_reversed[next as usize] = Some(own != differs);
                        open.push(next);
                    }
                    Some(reversed) if reversed != (own != differs) => return None,
                    Some(_) => {}
                }
            }
        }
        let all = |reversed: bool| -> Vec<u32> {
            part.iter().copied().filter(|&t| self.is_reversed[t as usize] == Some(reversed)).collect()
        };
        let reversed = all(true);
        Some(if 2 * reversed.len() <= part.len() { reversed } else { all(false) })
    }
}
