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
pub trait Id: Copy + Ord + fmt::Display + fmt::Debug + Default {
    /// The value that stands for no id.
    const NONE: Self;

    /// The id of place `index` in an array.
    ///
    /// Panics when `index` does not fit.
    fn of(index: usize) -> Self;

    /// The place in an array.
    fn place(self) -> usize;
}

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(
            Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash,
            bytemuck::Pod, bytemuck::Zeroable, serde::Serialize, serde::Deserialize,
        )]
        #[repr(transparent)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl $name {
            /// The id of place `index` in an array.
            ///
            /// Panics when `index` does not fit: arrays are checked against
            /// [`Self::MAX_COUNT`] where they enter the library.
            #[inline]
            pub fn new(index: usize) -> Self {
                Self(u32::try_from(index).expect("arrays are checked against MAX_COUNT on entry"))
            }

            /// The place in an array.
            #[inline]
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// How many of these one mesh may hold.
            pub const MAX_COUNT: usize = (u32::MAX - 1) as usize;
        }

        impl Id for $name {
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

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                self.0.fmt(f)
            }
        }
    };
}

id!(
    /// A vertex: the place of its point in the array of points.
    VertexId
);
id!(
    /// A cell of any kind, in the order of the file.
    CellId
);
id!(
    /// A tetrahedron.
    TetId
);
