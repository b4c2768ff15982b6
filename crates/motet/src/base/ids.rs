//! Typed ids: a `u32` that says what it counts.

use std::fmt;

/// The ids in rising order: a key for an edge or a facet that is the same from either side.
#[inline]
pub(crate) fn sorted_ids<T: Ord, const N: usize>(mut ids: [T; N]) -> [T; N] {
    ids.sort_unstable();
    ids
}

/// The ids in rising order: a key for a facet with any number of corners.
pub fn rising_list<T: Ord + Clone>(ids: &[T]) -> Vec<T> {
    let mut ids = ids.to_vec();
    ids.sort_unstable();
    ids
}

/// Whether two triangles with the same vertices have the same orientation.
pub(crate) fn same_orientation<T: PartialEq + Copy>(first: [T; 3], second: [T; 3]) -> bool {
    let [a, b, c] = first;
    [[a, b, c], [b, c, a], [c, a, b]].contains(&second)
}

/// What all ids have in common, for code that is generic over them.
pub trait Id: Copy + Ord + fmt::Display + fmt::Debug + Default + Send + Sync {
    /// The value that stands for no id.
    const NONE: Self;

    /// The id of place `index` in an array.
    ///
    /// Panics when `index` does not fit.
    fn of(index: usize) -> Self;

    /// The place in an array.
    fn place(self) -> usize;
}

/// An id, or none, in the space of an id. None comes last in the order.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
#[repr(transparent)]
pub struct MaybeId<I>(I);

impl<I: Id> MaybeId<I> {
    /// No id.
    pub const NONE: Self = Self(I::NONE);

    /// The id, if there is one.
    #[inline]
    pub fn get(self) -> Option<I> {
        if self.is_none() { None } else { Some(self.0) }
    }

    /// Whether there is no id.
    #[inline]
    pub fn is_none(self) -> bool {
        self.0 == I::NONE
    }

    /// Whether there is an id.
    #[inline]
    pub fn is_some(self) -> bool {
        !self.is_none()
    }

    /// The id; a new one if there is none.
    pub(crate) fn get_or_insert_with(&mut self, new: impl FnOnce() -> I) -> I {
        if self.is_none() {
            self.0 = new();
        }
        self.0
    }
}

/// The places in a list at which there is no id, in rising order, as ids.
pub(crate) fn absent<I: Id>(list: &[MaybeId<I>]) -> Vec<I> {
    (0..list.len()).filter(|&place| list[place].is_none()).map(I::of).collect()
}

impl<I> From<I> for MaybeId<I> {
    #[inline]
    fn from(id: I) -> Self {
        Self(id)
    }
}

impl<I: Id> From<Option<I>> for MaybeId<I> {
    #[inline]
    fn from(id: Option<I>) -> Self {
        id.map_or(Self::NONE, Self)
    }
}

impl<I: Id> fmt::Debug for MaybeId<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.get().fmt(f)
    }
}

/// Defines an id: an index of 32 bits with a name of its own.
macro_rules! id {
    ($(#[$doc:meta])* $vis:vis $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[cfg_attr(feature = "bytemuck", derive(bytemuck::Pod, bytemuck::Zeroable))]
        #[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(transparent))]
        #[repr(transparent)]
        $vis struct $name($vis u32);

        impl $name {
            /// The id of place `index` in an array.
            ///
            /// Panics when `index` does not fit: arrays are checked against
            /// `MAX_COUNT` where they enter the library.
            #[inline]
            $vis fn new(index: usize) -> Self {
                Self(u32::try_from(index).expect("arrays are checked against MAX_COUNT on entry"))
            }

            /// The place in an array.
            #[inline]
            $vis const fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl $crate::base::Id for $name {
            const NONE: Self = Self(u32::MAX);

            #[inline]
            fn of(index: usize) -> Self {
                Self::new(index)
            }

            #[inline]
            fn place(self) -> usize {
                self.index()
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                std::fmt::Display::fmt(&self.0, f)
            }
        }
    };
}
pub(crate) use id;

macro_rules! max_count {
    ($($name:ident),*) => {$(
        impl $name {
            /// How many of these one mesh may hold.
            pub const MAX_COUNT: usize = (u32::MAX - 1) as usize;
        }
    )*};
}

id!(
    /// A vertex: the place of its point in the array of points.
    pub VertexId
);
id!(
    /// A cell of any kind, in the order of the file.
    pub CellId
);
id!(
    /// A tetrahedron.
    pub TetId
);
max_count!(VertexId, CellId, TetId, BodyId);

id!(
    /// A triangle of a surface, or of a mesh of tets.
    pub TriangleId
);
id!(
    /// A body of a contact: a surface that may touch others.
    pub BodyId
);
id!(
    /// A labelled line of a mesh of tets.
    pub(crate) LineId
);
id!(
    /// A tet of a forest: of the first mesh, or one of eight that a tet was divided into.
    pub(crate) NodeId
);
id!(
    /// An edge of tets of a forest.
    pub(crate) EdgeId
);
id!(
    /// A vertex of a forest: those of the first mesh, then middles of edges.
    pub(crate) ForestVertexId
);
