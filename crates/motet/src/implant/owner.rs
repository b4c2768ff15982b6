//! What new tets and new triangles belong to.

/// What a body of new tets belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Owner {
    /// A region of the host.
    Host(i32),
    /// A device, by its number.
    Device(u32),
    /// No owner: tets of the host that stay, or nothing.
    Unfilled,
}

/// What a new triangle is a part of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Patch {
    /// The surface of a device.
    Device(u32),
    /// What a device and a wall of the host have in common.
    Contact(u32),
    /// A triangle of the host, by its patch.
    Host(i32),
    /// A wall of the host without triangles.
    Unlabelled,
}
