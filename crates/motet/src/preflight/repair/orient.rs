//! Reverses triangles so that neighbours face the same side, and closed parts outward.

use super::report::RepairKind;
use super::work::Work;
use crate::base::Csr;
use crate::preflight::parts::Parts;
use crate::preflight::sides::{Side, edges};

pub(super) fn orient(work: &mut Work, keep_inward: bool) {
    let lists = work.lists();
    let sides = work.sides(&lists);
    let parts = Parts::new(work.pieces.len(), &sides);
    let mut turns = Turns::new(work.pieces.len(), &sides);
    for (part, _) in parts.iter() {
        match turns.of_part(&part) {
            Some(turned) => turned.into_iter().for_each(|t| work.turn(t)),
            None => {
                let (old, vertices) = (work.old(part[0]), work.pieces[part[0] as usize].vertices.to_vec());
                work.tell(RepairKind::LeftOneSided, vec![old], vertices);
            }
        }
    }
    if !keep_inward {
        turn_outward(work);
    }
}

fn turn_outward(work: &mut Work) {
    let lists = work.lists();
    let sides = work.sides(&lists);
    let inward = Parts::new(work.pieces.len(), &sides).inward(&lists.surfaces(work));
    inward.into_iter().flatten().for_each(|t| work.turn(t));
}

/// Which triangles have to be reversed, found by going from neighbour to neighbour.
struct Turns {
    /// The neighbours of each triangle, and whether they face different sides.
    neighbors: Csr<(u32, bool)>,
    /// For each triangle that was reached: whether it has to be reversed if the first one of its part is not.
    is_turned: Vec<Option<bool>>,
}

impl Turns {
    fn new(n_triangles: usize, sides: &[Side]) -> Self {
        let pairs = || {
            edges(sides).filter(|same| same.len() == 2).flat_map(|same| {
                let differs = same[0].is_forward == same[1].is_forward;
                let [x, y] = [same[0].triangle, same[1].triangle];
                [(x as usize, (y, differs)), (y as usize, (x, differs))]
            })
        };
        Self { neighbors: Csr::from_pairs(n_triangles, pairs), is_turned: vec![None; n_triangles] }
    }

    /// The fewest triangles of a part that have to be reversed so that all face the same side; `None` if that
    /// is impossible.
    fn of_part(&mut self, part: &[u32]) -> Option<Vec<u32>> {
        let mut open = vec![part[0]];
        self.is_turned[part[0] as usize] = Some(false);
        while let Some(t) = open.pop() {
            let own = self.is_turned[t as usize] == Some(true);
            for &(next, differs) in self.neighbors.list(t as usize) {
                match self.is_turned[next as usize] {
                    None => {
                        self.is_turned[next as usize] = Some(own != differs);
                        open.push(next);
                    }
                    Some(turned) if turned != (own != differs) => return None,
                    Some(_) => {}
                }
            }
        }
        let all = |turned: bool| -> Vec<u32> {
            part.iter().copied().filter(|&t| self.is_turned[t as usize] == Some(turned)).collect()
        };
        let turned = all(true);
        Some(if 2 * turned.len() <= part.len() { turned } else { all(false) })
    }
}
