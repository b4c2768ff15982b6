//! Shapes that tets share. Of the eight parts of a tet four have its shape, and the others have two more,
//! each of them twice (the congruence classes of Bey 1995). So whatever follows from the shape alone, such as
//! the best way to divide a tet, is computed once for many tets.
//!
//! A class is identified by the path from a root to its first tet; steps to corner parts change nothing and
//! are left out.

use super::eight::{INNER, eight};
use super::{Forest, with_middles};
use crate::base::{MaybeId, NodeId, Point, id};
use crate::geometry::quality::eas;

id!(
    /// A class of tets of one shape. The class of a root has the root's number.
    pub(in crate::refine) ClassId
);

/// The class of a tet, and whether the tet is a mirror image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::refine) struct Shape(u32);

impl Shape {
    pub(in crate::refine) fn new(class: ClassId, is_mirrored: bool) -> Self {
        Self(class.0 << 1 | u32::from(is_mirrored))
    }

    #[inline]
    pub(in crate::refine) fn class(self) -> ClassId {
        ClassId(self.0 >> 1)
    }

    #[inline]
    pub(in crate::refine) fn is_mirrored(self) -> bool {
        self.0 & 1 == 1
    }

    pub(in crate::refine) fn of_class(self, class: ClassId) -> Self {
        Self::new(class, self.is_mirrored())
    }

    pub(in crate::refine) fn mirrored(self) -> Self {
        Self(self.0 ^ 1)
    }
}

/// A class of tets of one shape.
#[derive(Clone, Copy, Debug)]
pub(in crate::refine) struct Class {
    /// The class of the tets that these are parts of; none for the class of a root, which has the root's id.
    above: MaybeId<ClassId>,
    /// The way in which these were divided.
    way: u8,
    /// Which of [`INNER`] these are.
    inner: u8,
    /// The best way to divide tets of this class, once known.
    pub(in crate::refine) best: Option<u8>,
    /// The EAS in the reference, regardless of orientation.
    pub(in crate::refine) eas: f64,
    /// The EAS of the root that these are parts of.
    pub(in crate::refine) root_eas: f64,
    /// For each way to divide, the first of the two consecutive inner classes; none if they do not exist yet.
    below: [MaybeId<ClassId>; 3],
}

impl Class {
    pub(in crate::refine) fn of_root(corners: [Point; 4]) -> Self {
        let eas = eas(corners).abs();
        let (above, below) = (MaybeId::NONE, [MaybeId::NONE; 3]);
        Self { above, way: 0, inner: 0, best: None, eas, root_eas: eas, below }
    }

    /// One of the two inner parts of this class when divided in a way; `above` is this class's own id.
    fn part(&self, above: ClassId, [way, inner]: [u8; 2], eas: f64) -> Self {
        let (above, below) = (above.into(), [MaybeId::NONE; 3]);
        Self { above, way, inner, best: None, eas, root_eas: self.root_eas, below }
    }
}

impl Forest {
    /// The corners of the first tet of a class.
    pub(in crate::refine) fn corners_of_class(&self, class: ClassId) -> [Point; 4] {
        let Class { above, way, inner, .. } = self.classes[class.index()];
        let Some(above) = above.get() else { return self.corners(NodeId(class.0)) };
        let places = with_middles(self.corners_of_class(above));
        corners_at(&places, inner_part(usize::from(way), usize::from(inner)))
    }

    /// Makes the two inner classes of a class divided in a way; returns the first.
    pub(in crate::refine) fn make_classes(&mut self, class: ClassId, way: usize) -> ClassId {
        if let Some(known) = self.classes[class.index()].below[way].get() {
            return known;
        }
        let places = with_middles(self.corners_of_class(class));
        self.add_classes(class, way, [0, 1].map(|k| eas(corners_at(&places, inner_part(way, k))).abs()))
    }

    /// Adds the two inner classes of a class divided in a way, given their EAS; returns the first.
    pub(in crate::refine) fn add_classes(&mut self, class: ClassId, way: usize, eas: [f64; 2]) -> ClassId {
        if let Some(known) = self.classes[class.index()].below[way].get() {
            return known;
        }
        let first = ClassId::new(self.classes.len());
        let whole = self.classes[class.index()];
        self.classes.extend([0, 1].map(|k| whole.part(class, [way as u8, k as u8], eas[k])));
        self.classes[class.index()].below[way] = first.into();
        first
    }

    /// The two inner classes of a class divided in its best way, if that is known.
    pub(in crate::refine) fn best_classes(&self, class: ClassId) -> Option<[&Class; 2]> {
        let Class { best, below, .. } = self.classes[class.index()];
        let first = below[usize::from(best?)].get()?.index();
        Some([&self.classes[first], &self.classes[first + 1]])
    }

    /// The steps from the root down to a class: ways, and which of [`INNER`].
    pub(in crate::refine) fn steps_to_class(&self, mut class: ClassId) -> Vec<(usize, usize)> {
        let mut steps = Vec::new();
        while let Class { above, way, inner, .. } = self.classes[class.index()]
            && let Some(above) = above.get()
        {
            steps.push((usize::from(way), usize::from(inner)));
            class = above;
        }
        steps.reverse();
        steps
    }
}

/// One of the two inner parts that have shapes of their own.
pub(in crate::refine) fn inner_part(way: usize, inner: usize) -> &'static [u8; 4] {
    &eight(way)[INNER[inner]]
}

pub(in crate::refine) fn corners_at(places: &[Point; 10], tet: &[u8; 4]) -> [Point; 4] {
    let mut corners = [[0.0; 3]; 4];
    for (corner, v) in corners.iter_mut().zip(tet) {
        *corner = places[usize::from(*v)];
    }
    corners
}
