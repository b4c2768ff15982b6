//! What lies behind a facet of a tet: another tet, or a wall.
//!
//! ```text
//!     links[tet][i]  ->  31 .. 2   1 0        a tet, and which of its facets it is
//!                        tet       facet
//!                        all ones but bit 31: see below
//!     bit 31 set     ->  a wall, which knows the tets on its two sides
//! ```
//! Nearly all facets of a mesh are plain and need no more than this; walls are stored in a list of their own.

pub use crate::mesh::HalfFacet;

/// A wall, by its index in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct WallId(pub u32);

impl WallId {
    #[inline(always)]
    pub(super) fn index(self) -> usize {
        self.0 as usize
    }
}

/// A facet that must stay: on the boundary, between two regions, or labelled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wall {
    /// The facets of the tets on its sides; on the boundary the second is [`HalfFacet::NONE`].
    pub sides: [HalfFacet; 2],
    /// The patch of the wall; 0 without a label.
    pub patch: i32,
    /// The triangle of the first mesh that the wall is, or is part of; `u32::MAX` if there was none.
    pub triangle: u32,
    /// Whether the wall is not one of the first mesh.
    pub is_new: bool,
}

/// Marks a wall without a triangle in the mesh.
pub(crate) const NO_TRIANGLE: u32 = u32::MAX;

impl Wall {
    pub(super) const FREE: Self =
        Self { sides: [HalfFacet::NONE; 2], patch: 0, triangle: NO_TRIANGLE, is_new: false };

    /// The side opposite `side`.
    #[inline(always)]
    pub fn other(&self, side: HalfFacet) -> HalfFacet {
        if self.sides[0] == side { self.sides[1] } else { self.sides[0] }
    }
}

/// What a facet leads to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Behind {
    /// The facet of another tet.
    Tet(HalfFacet),
    /// A wall.
    Wall(WallId),
}

/// [`Behind`], packed into four bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Link(pub(super) u32);

const WALL: u32 = 1 << 31;

impl Link {
    #[inline(always)]
    pub(super) fn tet(half: HalfFacet) -> Self {
        Self(half.0)
    }

    #[inline(always)]
    pub(super) fn wall(wall: WallId) -> Self {
        Self(wall.0 | WALL)
    }

    #[inline(always)]
    pub(super) fn is_wall(self) -> bool {
        self.0 & WALL != 0
    }

    /// The facet of another tet; only where there is no wall.
    #[inline(always)]
    pub(super) fn half(self) -> HalfFacet {
        debug_assert!(!self.is_wall());
        HalfFacet(self.0)
    }

    #[inline(always)]
    pub(super) fn behind(self) -> Behind {
        match self.is_wall() {
            true => Behind::Wall(WallId(self.0 & !WALL)),
            false => Behind::Tet(HalfFacet(self.0)),
        }
    }
}
