//! Nodes of the tree on the stack of a search, the nearest on top.

/// The size of the stack. A tree over 2^31 triangles has eleven levels, each of which leaves up to seven
/// boxes behind.
pub(super) const STACK_SIZE: usize = 8 * 12;

/// A node of the tree, or the place of a triangle, with a lower bound of its squared distance.
pub(super) struct Node(pub(super) u32, pub(super) f32);

impl Node {
    /// Packs the node into an integer, ordered by the bound: bits of positive numbers rise as the numbers do.
    #[inline(always)]
    pub(super) fn packed(self) -> u64 {
        u64::from(self.1.to_bits()) << 32 | u64::from(self.0)
    }

    #[inline(always)]
    pub(super) fn of(packed: u64) -> Self {
        Self(packed as u32, f32::from_bits((packed >> 32) as u32))
    }
}

/// Moves the nearest node to the end; each of the others moves by at most one place.
#[inline(always)]
pub(super) fn put_nearest_on_top(nodes: &mut [u64]) {
    for i in 1..nodes.len() {
        let (x, y) = (nodes[i - 1], nodes[i]);
        (nodes[i - 1], nodes[i]) = (x.max(y), x.min(y));
    }
}
