//! Shapes that tets share. Of the eight parts of a tet four have its shape, and the others two more, each of them twice (the congruence classes of Bey 1995). So what
//! follows from the shape alone, such as how a tet is divided best, is found once for many.
//!
//! A class is named by the way down to the first tet of it from a root: steps to parts at corners change nothing, and are left out.

use super::eight::{INNER, eight};
use super::{Forest, NONE, with_middles};
use crate::base::Point;
use crate::geometry::quality::eas;

/// The class of a tet, and whether that is as in a mirror.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::refine) struct Shape(u32);

impl Shape {
    pub(in crate::refine) fn new(class: u32, is_mirrored: bool) -> Self {
        Self(class << 1 | u32::from(is_mirrored))
    }

    #[inline]
    pub(in crate::refine) fn class(self) -> u32 {
        self.0 >> 1
    }

    #[inline]
    pub(in crate::refine) fn is_mirrored(self) -> bool {
        self.0 & 1 == 1
    }

    pub(in crate::refine) fn of_class(self, class: u32) -> Self {
        Self::new(class, self.is_mirrored())
    }

    pub(in crate::refine) fn mirrored(self) -> Self {
        Self(self.0 ^ 1)
    }
}

/// Tets of one shape.
#[derive(Clone, Copy, Debug)]
pub(in crate::refine) struct Class {
    /// The class of those whose parts these are; [`NONE`] for that of a root, which has the root's id.
    above: u32,
    /// As parts of which way.
    way: u8,
    /// And which of [`INNER`].
    inner: u8,
    /// The way that is best for these.
    pub(in crate::refine) best: Option<u8>,
    /// The EAS in the reference, however tets are numbered.
    pub(in crate::refine) eas: f64,
    /// That of the root that these are parts of.
    pub(in crate::refine) root_eas: f64,
    /// Of each way to divide, the first of the two classes inside, which follow each other, where there ever were some.
    below: [u32; 3],
}

impl Class {
    pub(in crate::refine) fn of_root(corners: [Point; 4]) -> Self {
        let eas = eas(corners).abs();
        Self { above: NONE, way: 0, inner: 0, best: None, eas, root_eas: eas, below: [NONE; 3] }
    }

    /// One of the two inner parts of this class, divided in a way; `above` is its own id.
    fn part(&self, above: u32, [way, inner]: [u8; 2], eas: f64) -> Self {
        Self { above, way, inner, best: None, eas, root_eas: self.root_eas, below: [NONE; 3] }
    }
}

impl Forest {
    /// The corners of the first tet of a class.
    pub(in crate::refine) fn corners_of_class(&self, class: u32) -> [Point; 4] {
        let Class { above, way, inner, .. } = self.classes[class as usize];
        if above == NONE {
            return self.corners(class);
        }
        let places = with_middles(self.corners_of_class(above));
        corners_at(&places, inner_part(usize::from(way), usize::from(inner)))
    }

    /// The two classes inside, if tets of a class are divided in a way; the first is given.
    pub(in crate::refine) fn make_classes(&mut self, class: u32, way: usize) -> u32 {
        let known = self.classes[class as usize].below[way];
        if known != NONE {
            return known;
        }
        let places = with_middles(self.corners_of_class(class));
        self.add_classes(class, way, [0, 1].map(|k| eas(corners_at(&places, inner_part(way, k))).abs()))
    }

    /// The same, where their EAS is known.
    pub(in crate::refine) fn add_classes(&mut self, class: u32, way: usize, eas: [f64; 2]) -> u32 {
        let known = self.classes[class as usize].below[way];
        if known != NONE {
            return known;
        }
        let first = self.classes.len() as u32;
        let whole = self.classes[class as usize];
        self.classes.extend([0, 1].map(|k| whole.part(class, [way as u8, k as u8], eas[k])));
        self.classes[class as usize].below[way] = first;
        first
    }

    /// The two classes inside, if tets of a class are divided in the way that is best, where that is known.
    pub(in crate::refine) fn best_classes(&self, class: u32) -> Option<[&Class; 2]> {
        let Class { best, below, .. } = self.classes[class as usize];
        let first = below[usize::from(best?)] as usize;
        Some([&self.classes[first], &self.classes[first + 1]])
    }

    /// Of a class, the steps down to it: ways, and which of [`INNER`].
    pub(in crate::refine) fn steps_to_class(&self, mut class: u32) -> Vec<(usize, usize)> {
        let mut steps = Vec::new();
        while let Class { above, way, inner, .. } = self.classes[class as usize]
            && above != NONE
        {
            steps.push((usize::from(way), usize::from(inner)));
            class = above;
        }
        steps.reverse();
        steps
    }
}

/// One of the two parts inside that have shapes of their own.
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
