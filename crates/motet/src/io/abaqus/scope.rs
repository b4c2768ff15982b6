//! The contents of one numbering: a flat file, a part, or an instance.

use std::collections::{HashMap, HashSet};

use super::line::{Label, Reference};
use crate::mesh::CellKind;

/// Nodes, elements, sets and surfaces with their own numbers and names.
#[derive(Clone, Default)]
pub(super) struct Scope {
    /// The name of a part or instance.
    pub(super) name: Option<Label>,
    pub(super) node_ids: Vec<u64>,
    pub(super) points: Vec<[f64; 3]>,
    pub(super) element_ids: Vec<u64>,
    pub(super) kinds: Vec<CellKind>,
    /// Node numbers of all elements, one element after another, in VTK's order.
    pub(super) nodes: Vec<u64>,
    pub(super) node_sets: Sets,
    pub(super) element_sets: Sets,
    pub(super) surfaces: Vec<SurfaceDefinition>,
    /// Keys of the element sets that have a section.
    pub(super) with_section: HashSet<String>,
    pub(super) placement: Placement,
}

/// Node sets or element sets, as defined in the file.
#[derive(Clone, Default)]
pub(super) struct Sets {
    pub(super) all: Vec<Set>,
    by_key: HashMap<String, usize>,
    /// Which entry goes into which set, in the order of the file.
    pub(super) entries: Vec<(usize, Entry)>,
}

#[derive(Clone)]
pub(super) struct Set {
    pub(super) label: Label,
    /// Whether the preprocessor made the set for its own use.
    pub(super) is_internal: bool,
    /// Whether the set has a keyword of its own.
    pub(super) is_declared: bool,
}

/// A part of a set.
#[derive(Clone)]
pub(super) enum Entry {
    /// Numbers from `first` to `last` with a step of `step`, in an instance or in this scope.
    Ids { first: u64, last: u64, step: u64, instance: Option<String> },
    /// Another set of the same kind.
    Set(Reference),
    /// The nodes of a set of elements.
    NodesOf(String),
}

impl Sets {
    /// The index of the set with this name, which is created if necessary.
    pub(super) fn named(&mut self, label: Label) -> usize {
        let next = self.all.len();
        let place = *self.by_key.entry(label.key.clone()).or_insert(next);
        if place == next {
            self.all.push(Set { label, is_internal: false, is_declared: false });
        }
        place
    }

    pub(super) fn find(&self, key: &str) -> Option<usize> {
        self.by_key.get(key).copied()
    }

    /// Adds a number to a set, extending the last range where possible.
    pub(super) fn add(&mut self, set: usize, id: u64, in_instance: Option<String>) {
        if let Some((of, Entry::Ids { last, step: 1, instance, .. })) = self.entries.last_mut()
            && *of == set
            && *last + 1 == id
            && *instance == in_instance
        {
            *last = id;
            return;
        }
        self.entries.push((set, Entry::Ids { first: id, last: id, step: 1, instance: in_instance }));
    }
}

/// A surface as defined in the file: elements or element sets, each with the name of a face.
#[derive(Clone)]
pub(super) struct SurfaceDefinition {
    pub(super) label: Label,
    pub(super) is_internal: bool,
    pub(super) faces: Vec<(Reference, String)>,
}

/// The placement of an instance: a translation, then a rotation about an axis.
#[derive(Clone, Copy, Default)]
pub(super) struct Placement {
    pub(super) translation: [f64; 3],
    /// Two points of the axis and the angle in degrees, right-handed about the direction from the first to
    /// the second.
    pub(super) rotation: Option<([f64; 3], [f64; 3], f64)>,
}

impl Placement {
    pub(super) fn apply(&self, p: [f64; 3]) -> [f64; 3] {
        // Adding zero would change the sign of a negative zero.
        let is_shifted = self.translation != [0.0; 3];
        let p = if is_shifted { std::array::from_fn(|i| p[i] + self.translation[i]) } else { p };
        let Some((a, b, degrees)) = self.rotation else { return p };
        let axis: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
        let length = dot(axis, axis).sqrt();
        let k = axis.map(|x| x / length);
        let v: [f64; 3] = std::array::from_fn(|i| p[i] - a[i]);
        let cross = [k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0]];
        let (sin, cos) = degrees.to_radians().sin_cos();
        let along = dot(k, v) * (1.0 - cos);
        // Rodrigues' formula.
        std::array::from_fn(|i| a[i] + v[i] * cos + cross[i] * sin + k[i] * along)
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Scope {
    /// Approximate memory of a copy, in bytes.
    pub(super) fn n_bytes(&self) -> usize {
        let entries = self.node_sets.entries.len() + self.element_sets.entries.len();
        let sets = self.node_sets.all.len() + self.element_sets.all.len();
        let faces: usize = self.surfaces.iter().map(|s| s.faces.len() + 1).sum();
        32 * self.node_ids.len()
            + 9 * self.element_ids.len()
            + 8 * self.nodes.len()
            + 100 * (entries + sets + faces)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instance_is_translated_and_then_rotated_by_the_right_hand_rule() {
        let rotation = Some(([1.0, 0.0, 0.0], [1.0, 0.0, 2.0], 90.0));
        let p = Placement { translation: [0.0, 0.0, 5.0], rotation }.apply([2.0, 0.0, 0.0]);
        for (x, y) in p.into_iter().zip([1.0, 1.0, 5.0]) {
            assert!((x - y).abs() < 1e-15, "{p:?}");
        }
    }
}
