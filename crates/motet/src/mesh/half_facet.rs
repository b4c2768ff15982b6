//! A facet of a tet, in one number.

use crate::base::TetId;

/// Tet ids are below this.
pub(crate) const MAX_TETS: u32 = (1 << 29) - 1;

/// One facet of one tet: facet `i` lies opposite vertex `i`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct HalfFacet(pub(crate) u32);

impl HalfFacet {
    /// No facet: what lies beyond the boundary.
    pub const NONE: Self = Self(u32::MAX >> 1);

    /// Facet `i` of a tet.
    #[inline(always)]
    pub fn new(tet: TetId, i: usize) -> Self {
        debug_assert!(tet.0 < MAX_TETS && i < 4);
        Self(tet.0 << 2 | i as u32)
    }

    /// The tet.
    #[inline(always)]
    pub fn tet(self) -> TetId {
        TetId(self.0 >> 2)
    }

    /// The number of the facet in its tet.
    #[inline(always)]
    pub fn facet(self) -> usize {
        (self.0 & 3) as usize
    }

    /// Whether this is [`Self::NONE`].
    #[inline(always)]
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }
}
