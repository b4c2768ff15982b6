//! Enlarges cavities at the surface that have no space for a point.
//!
//! Vertices inside may lie as close to the surface as floating-point numbers allow; then no point between
//! them and the surface sees both the surface and the facets of the cavity. Starting from a point farther
//! away, the tet behind each facet that the point does not see is added, until the point sees all facets. The
//! cavity is then star-shaped with respect to the point, so tets from it to the facets fill the cavity (as in
//! Bowyer 1981 and Watson 1981).

use hashbrown::{HashMap, HashSet};

use super::refill::{Side, is_seen, makes_flat};
use super::repair::SurfaceRepair;
use crate::base::{Point, VertexId, sorted_ids};
use crate::geometry::vector::{add, scale};
use crate::kernel::Tets;

/// The largest number of tets in one cavity.
const MAX_TETS: usize = 1024;

/// Distances of the point from the surface to try, as fractions of the distance to the facets around.
const FRACTIONS: [f64; 8] = [0.3, 0.15, 0.6, 0.06, 0.02, 5e-3, 1e-3, 1e-4];

impl SurfaceRepair<'_> {
    /// Finds a point near `middle` that sees all facets of the cavity `sides[i]`; a cavity without such a
    /// point gets more tets. All tets from the point to the facets have a volume in the digits of their
    /// coordinates; where that is impossible and they `may_be_flat`, they are merely positive.
    pub(super) fn find_apex(
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
        if self.n_failures_left > 0 {
            let (directions, _) = sides[i].directions(self.sites, middle);
            let points = FRACTIONS
                .iter()
                .flat_map(|&way| directions.map(|direction| add(middle, scale(direction, way))));
            if let Some((side, p)) = points.filter_map(|p| Some((self.enlarged(sides, i, p)?, p))).next() {
                self.n_failures_left += 1;
                sides[i] = side;
                return Some(p);
            }
            self.n_failures_left -= 1;
        }
        place.filter(|_| may_be_flat)
    }

    /// The cavity `sides[i]` with the tets added that make it star-shaped with respect to `p`. `None` where
    /// it reaches the surface first, or becomes too large.
    fn enlarged(&self, sides: &[Side], i: usize, p: Point) -> Option<Side> {
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
            let may_be_added = !behind.is_none()
                && self.bodies.of_slot[behind.tet().index()] == body
                && self.wall(behind).is_none()
                && !side.tets.contains(&behind.tet());
            if !may_be_added || side.tets.len() == MAX_TETS {
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

    /// Whether the facets of a cavity, with the new ones of the surface, meet in pairs at their edges, and
    /// contain all its vertices except Steiner points inside.
    fn is_closed(&self, side: &Side) -> bool {
        let mut edges: HashMap<[VertexId; 2], u32> = HashMap::new();
        for [a, b, c] in side.faces() {
            for edge in [[a, b], [b, c], [c, a]] {
                *edges.entry(sorted_ids(edge)).or_default() += 1;
            }
        }
        let around: HashSet<VertexId> = edges.keys().flatten().copied().collect();
        let is_kept_or_removable = |v: VertexId| around.contains(&v) || self.sites.is_steiner_inside(v);
        edges.values().all(|&n| n == 2)
            && side.tets.iter().flat_map(|&tet| self.tets.vertices(tet)).all(is_kept_or_removable)
    }

    /// Whether no other cavity of `sides` has a tet of this one, or a tet behind its facets.
    fn is_apart(&self, side: &Side, sides: &[Side], i: usize) -> bool {
        let others = || sides.iter().enumerate().filter(|&(k, _)| k != i).flat_map(|(_, other)| &other.tets);
        let behind = |tet| side.shell.iter().any(|(half, _)| !half.is_none() && half.tet() == tet);
        others().all(|&tet| !side.tets.contains(&tet) && !behind(tet))
    }
}
