//! More tets are made anew, where those at the surface leave no room for a point.
//!
//! Vertices inside may lie as near to the surface as digits go; then no point on that side of them sees both the surface and the facets around.
//! From a point farther away, each facet that it does not see is passed, and the tet behind it goes as well, until all facets around are
//! seen. They bound a room that is a star about the point, so tets to them fill it (as in the cavities of Bowyer 1981 and Watson 1981).

use hashbrown::HashMap;

use super::keep::Keep;
use super::recone::{Side, is_seen, makes_flat};
use super::tets::Tets;
use crate::base::{Point, VertexId, rising};
use crate::geometry::vector::{add, scale};

/// So many tets may go on one side.
const MOST: usize = 1024;

/// So often in vain, and once more for each time that it helped: where walls are as near to each other as digits go, nothing helps.
pub(super) const PATIENCE: usize = 128;

/// How far from the surface the point may be, as a share of the way to the facets around.
const WAYS: [f64; 8] = [0.3, 0.15, 0.6, 0.06, 0.02, 5e-3, 1e-3, 1e-4];

impl Keep<'_> {
    /// A point near `middle` that sees all facets around the side `i`, to which tets are added where it has no room otherwise. Tets from the point to the facets
    /// have a volume where that can be, or else if they `may_be_flat` not.
    pub(super) fn room(
        &mut self,
        sides: &mut [Side],
        i: usize,
        middle: Point,
        may_be_flat: bool,
    ) -> Option<Point> {
        let place = sides[i].place(self.sites, middle);
        if let Some(p) = place.filter(|&p| !sides[i].is_flat_from(self.sites, p)) {
            return Some(p);
        }
        if self.patience > 0 {
            let (directions, _) = sides[i].directions(self.sites, middle);
            let points =
                WAYS.iter().flat_map(|&way| directions.map(|direction| add(middle, scale(direction, way))));
            if let Some((grown, p)) = points.filter_map(|p| Some((self.grown_to(sides, i, p)?, p))).next() {
                self.patience += 1;
                sides[i] = grown;
                return Some(p);
            }
            self.patience -= 1;
        }
        place.filter(|_| may_be_flat)
    }

    fn grown_to(&self, sides: &[Side], i: usize, p: Point) -> Option<Side> {
        let is_good = |face| is_seen(self.sites, face, p) && !makes_flat(self.sites, face, p);
        let mut side = sides[i].clone();
        if !side.base.iter().all(|&face| is_good(face)) {
            return None;
        }
        let body = self.bodies.of_slot[side.tets[0].index()];
        let mut n_good = 0;
        while let Some(&(behind, face)) = side.shell.get(n_good) {
            if is_good(face) {
                n_good += 1;
                continue;
            }
            let is_free = !behind.is_none()
                && self.bodies.of_slot[behind.tet().index()] == body
                && self.wall(behind).is_none()
                && !side.tets.contains(&behind.tet());
            if !is_free || side.tets.len() == MOST {
                return None;
            }
            side.tets.push(behind.tet());
            for half in Tets::facets(behind.tet()) {
                match side.shell.iter().position(|shell| shell.0 == half) {
                    Some(k) => {
                        side.shell.remove(k);
                        n_good -= usize::from(k < n_good);
                    }
                    None => side.shell.push((self.tets.across(half), self.tets.inward(half))),
                }
            }
        }
        (self.is_closed(&side) && self.is_apart(&side, sides, i)).then_some(side)
    }

    /// Whether the facets around, with the new ones of the surface, are one closed surface that all vertices are on but those that nobody misses.
    fn is_closed(&self, side: &Side) -> bool {
        let mut edges: HashMap<[VertexId; 2], u32> = HashMap::new();
        for [a, b, c] in side.faces() {
            for edge in [[a, b], [b, c], [c, a]] {
                *edges.entry(rising(edge)).or_default() += 1;
            }
        }
        let is_around = |v: &VertexId| side.faces().any(|face| face.contains(v));
        edges.values().all(|&n| n == 2)
            && side
                .tets
                .iter()
                .flat_map(|&tet| self.tets.vertices(tet))
                .all(|v| self.sites.is_free(v) || is_around(&v))
    }

    /// Whether no other side has a tet of this one, or behind it.
    fn is_apart(&self, side: &Side, sides: &[Side], i: usize) -> bool {
        let others = || sides.iter().enumerate().filter(|&(k, _)| k != i).flat_map(|(_, other)| &other.tets);
        let behind = |tet| side.shell.iter().any(|(half, _)| !half.is_none() && half.tet() == tet);
        others().all(|&tet| !side.tets.contains(&tet) && !behind(tet))
    }
}
