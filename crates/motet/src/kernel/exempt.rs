//! Exemption of tets that walls force: they count as good.
//!
//! Where two walls meet at an angle, the tet between them has that dihedral angle, whatever is done; a tet on
//! a narrow wall has its narrow angle. Nothing can raise the quality of such a tet, and as the worst of every
//! cavity around it, it would block each change that helps a neighbour. So such tets are exempted, each by
//! its id. A tet that replaces exempt ones is judged anew, by the walls it will have. The quality alone
//! exempts nothing: another tet elsewhere can have the same value and need repair.

use crate::base::{Point, TetId, VertexId, sorted_ids};
use crate::geometry::quality::{dihedral, highest_eas};
use crate::geometry::tet::{EDGES, FACETS};
use crate::geometry::triangle;
use crate::kernel::complex::Complex;
use crate::kernel::link::HalfFacet;
use crate::kernel::qualities::EXEMPT;

/// A tet below this EAS is nearly flat, and never counts as good: two of its walls may come to lie on each
/// other.
pub const FLATTEST: f64 = 1e-6;

/// A quality within this of the highest that walls allow counts as reaching it.
const NEARLY: f64 = 1e-6;

/// Whether `quality` reaches the highest quality `best` that walls allow.
pub fn is_reached(quality: f64, best: f64) -> bool {
    quality > 0.0 && best - quality < NEARLY
}

/// The role of a facet in judging the quality of its tet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Side {
    /// No wall.
    Inside,
    /// A wall whose angles may change.
    Wall,
    /// A wall whose angles stay: any wall of a surface that is kept, otherwise a wall of an exempt tet.
    Firm,
}

impl Complex {
    /// Exempts `tets`, which count as good from now on. New tets are exempt, too, if their quality is below
    /// `limit`, not below the worst of `tets`, and as high as two walls on both sides of the tet, or the
    /// angles of a wall that is [`Side::Firm`], allow. Ends with [`Self::end_exemptions`].
    ///
    /// Cannot be undone by [`Self::undo`].
    pub fn exempt(&mut self, tets: &[TetId], limit: f64) {
        let worst = tets.iter().map(|&tet| self.measure(self.corners(tet))).fold(f64::INFINITY, f64::min);
        self.qualities.exempt(tets, worst.max(FLATTEST)..limit);
        self.forget();
    }

    /// Ends all exemptions: every tet is judged by its quality again.
    ///
    /// Cannot be undone by [`Self::undo`].
    pub fn end_exemptions(&mut self) {
        self.qualities.end_exemptions();
        self.forget();
    }

    /// How many tets are exempt.
    pub fn n_exempt(&self) -> usize {
        match self.qualities.exempts() {
            true => self.tets().filter(|&tet| self.is_exempt(tet)).count(),
            false => 0,
        }
    }

    pub(super) fn is_exempt(&self, tet: TetId) -> bool {
        self.qualities.is_exempt(tet)
    }

    /// What a new tet whose facets will be `sides` counts as: its EAS, or infinity if walls force it and such
    /// tets are exempt.
    #[inline]
    pub fn judge(&self, corners: [Point; 4], sides: impl Fn(usize) -> Side) -> f64 {
        let quality = self.measure(corners);
        let may_be_exempt = self.qualities.may_be_exempt(quality);
        if may_be_exempt && is_forced(corners, quality, sides) { EXEMPT } else { quality }
    }

    /// The role of facet `i` of a tet.
    pub fn side(&self, tet: TetId, i: usize) -> Side {
        match self.is_wall(tet, i) {
            false => Side::Inside,
            true if self.keeps_surface() || self.is_exempt(tet) => Side::Firm,
            true => Side::Wall,
        }
    }

    /// The role of the facet with these sorted vertices for those of `tets` that have it.
    pub fn side_of(&self, tets: &[TetId], vertices: [VertexId; 3]) -> Side {
        // Loops, not an iterator over iterators: where those are not inlined, a repair takes 3 % longer.
        let mut side = Side::Inside;
        for &tet in tets {
            for i in 0..4 {
                if self.is_wall(tet, i) && sorted_ids(self.facet(HalfFacet::new(tet, i))) == vertices {
                    side = side.max(self.side(tet, i));
                }
            }
        }
        side
    }
}

/// Whether the angle between two walls of a tet, or an angle of a firm one, determines its quality.
fn is_forced(corners: [Point; 4], quality: f64, sides: impl Fn(usize) -> Side) -> bool {
    let sides = [0, 1, 2, 3].map(sides);
    if sides == [Side::Inside; 4] {
        return false;
    }
    let angles = dihedral::angles(corners);
    // The facets at an edge are those opposite the two other vertices.
    let is_between = |edge: usize| EDGES[5 - edge].into_iter().all(|i| sides[i] != Side::Inside);
    let is_narrow = |i: usize| {
        let wall = FACETS[i].map(|corner| corners[corner]);
        (0..3).any(|corner| is_reached(quality, highest_eas(triangle::angle_at(wall, corner).to_degrees())))
    };
    (0..6).any(|edge| is_reached(quality, angles[edge] / dihedral::REGULAR) && is_between(edge))
        || (0..4).any(|i| sides[i] == Side::Firm && is_narrow(i))
}
