//! Changes that only move a vertex: their tets are joined as before.

use crate::base::TetId;
use crate::kernel::change::{Change, Fill, VertexChange};
use crate::kernel::check::{Checked, FillFacet, Joint};
use crate::kernel::complex::Complex;
use crate::kernel::link::{Behind, HalfFacet};

impl Complex {
    /// Whether a change only moves a vertex: the fill repeats each tet of the cavity.
    pub(super) fn is_move(&self, change: &Change) -> bool {
        let is_same = |(&tet, fill): (&TetId, &Fill)| {
            self.vertices(tet) == fill.vertices && self.region(tet) == fill.region
        };
        matches!(change.vertex, VertexChange::Move(..))
            && change.walls.is_empty()
            && change.lines.is_empty()
            && change.cavity.len() == change.fill.len()
            && change.cavity.iter().zip(&change.fill).all(is_same)
    }

    /// Joins the tets of a change that only moves a vertex as they are joined now: [`Self::join`] took a
    /// fifth of the time of improving a mesh.
    pub(super) fn join_as_before<'a>(&self, change: &'a Change) -> Checked<'a> {
        let mut joints = Vec::with_capacity(3 * change.cavity.len());
        let place_of = |half: HalfFacet| match half.is_none() {
            true => None,
            false => change.cavity.iter().position(|&t| t == half.tet()),
        };
        let fill = |place: usize, facet: usize| FillFacet { tet: place as u32, facet: facet as u8 };
        for (place, &tet) in change.cavity.iter().enumerate() {
            for facet in 0..4 {
                let half = HalfFacet::new(tet, facet);
                let here = fill(place, facet);
                match self.behind(tet, facet) {
                    Behind::Tet(other) => match place_of(other) {
                        None => joints.push(Joint::Outer(here, other)),
                        Some(beside) if beside < place => {}
                        Some(beside) => joints.push(Joint::Inner([here, fill(beside, other.facet())])),
                    },
                    Behind::Wall(id) => {
                        let wall = self.wall(id);
                        let other = wall.other(half);
                        match place_of(other) {
                            None => joints.push(Joint::AtWall(here, id, half)),
                            Some(beside) if wall.sides[0] == half => {
                                joints.push(Joint::InnerWall([here, fill(beside, other.facet())], id));
                            }
                            Some(_) => {}
                        }
                    }
                }
            }
        }
        Checked { change, joints, lost_walls: Vec::new(), lost_lines: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::VertexId;
    use crate::kernel::Star;
    use crate::mesh::TetPart;
    use crate::mesh::shapes::box_grid;

    /// The joints of a change, in canonical order.
    fn joined(checked: &Checked) -> Vec<String> {
        let mut joints: Vec<String> = checked
            .joints
            .iter()
            .map(|joint| match joint {
                Joint::Inner(sides) => {
                    let mut sides = *sides;
                    sides.sort_unstable_by_key(|side| (side.tet, side.facet));
                    format!("{:?}", Joint::Inner(sides))
                }
                other => format!("{other:?}"),
            })
            .collect();
        joints.sort_unstable();
        joints
    }

    #[test]
    fn every_star_is_joined_as_the_general_way_joins_it() {
        let mut mesh = TetPart::of(&box_grid([3; 3], [[0.0; 3], [1.0; 3]])).unwrap().mesh;
        // Two regions, so that some stars contain walls and some have them at their rim.
        let is_low = |tet: &[VertexId; 4]| tet.iter().all(|v| mesh.points[v.index()][2] < 0.34);
        mesh.regions = mesh.tets.iter().map(|tet| i32::from(is_low(tet))).collect();
        let complex = Complex::new(&mesh).unwrap();
        let (mut star, mut change) = (Star::default(), Change::default());
        for vertex in (0..mesh.points.len()).map(VertexId::new) {
            star.gather(&complex, vertex);
            change.clear();
            change.vertex = VertexChange::Move(vertex, complex.point(vertex));
            change.cavity.extend_from_slice(&star.tets);
            star.tets.iter().for_each(|&t| change.push(&complex, complex.vertices(t), complex.region(t)));
            assert!(complex.is_move(&change));
            assert_eq!(joined(&complex.join_as_before(&change)), joined(&complex.join(&change).unwrap()));
        }
    }
}
