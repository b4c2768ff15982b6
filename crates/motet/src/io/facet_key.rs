//! Facets known by their corners.

use crate::base::VertexId;

/// The corners of a facet in ascending order, which identify it.
pub(super) type FacetKey = [u32; 4];

pub(super) fn facet_key(corners: impl IntoIterator<Item = VertexId>) -> FacetKey {
    let mut key = [u32::MAX; 4];
    key.iter_mut().zip(corners).for_each(|(slot, v)| *slot = v.0);
    key.sort_unstable();
    key
}

/// Whether two rings of the same vertices have the same orientation.
pub(super) fn have_same_orientation<T: PartialEq>(a: &[T], b: &[T]) -> bool {
    b.iter().position(|v| *v == a[0]).is_some_and(|at| b[(at + 1) % b.len()] == a[1])
}
