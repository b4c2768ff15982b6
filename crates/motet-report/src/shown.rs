//! What the page contains of a mesh or a series: facts of every frame, pictures of those that fit, and what
//! was left out.

use std::collections::BTreeMap;

use motet::Mesh;
use motet::base::Point;

use crate::arrays::{Array, EAS, Key};
use crate::input::{Meshes, name_of};
use crate::labels::Label;
use crate::numbers::{count, counted};
use crate::part::{Holds, InsidePart, SkinPart};
use crate::quality::Quality;
use crate::store::BlockId;

/// Everything that the page contains of a mesh or a series.
#[derive(Debug, Default)]
pub(crate) struct Shown {
    pub(crate) name: String,
    pub(crate) is_series: bool,
    pub(crate) keys: Vec<Key>,
    /// Names of labels, by array.
    pub(crate) names: Vec<BTreeMap<i32, String>>,
    /// Patches and regions of all frames.
    pub(crate) labels: Vec<Label>,
    pub(crate) facts: Vec<Facts>,
    /// The frames with a picture.
    pub(crate) frames: Vec<ShownFrame>,
    pub(crate) with_arrays: bool,
    /// What is not on the page, a sentence each.
    pub(crate) left_out: Vec<String>,
    pub(crate) notes: Vec<String>,
}

/// What is reported of every frame, with or without a picture.
#[derive(Clone, Debug)]
pub(crate) struct Facts {
    pub(crate) time: f64,
    pub(crate) points: usize,
    pub(crate) cells: Vec<(String, usize)>,
    pub(crate) quality: Option<Quality>,
    /// The smallest value of an array `gap`, and where it occurs.
    pub(crate) least_gap: Option<(f64, Point)>,
}

/// A frame with a picture.
#[derive(Debug)]
pub(crate) struct ShownFrame {
    pub(crate) frame: usize,
    pub(crate) skin: SkinPart,
    pub(crate) inside: Option<InsidePart>,
    pub(crate) n_solids: usize,
}

impl ShownFrame {
    pub(crate) fn blocks(&self, with_arrays: bool) -> Vec<BlockId> {
        let inside = self.inside.iter().flat_map(InsidePart::blocks);
        self.skin.blocks(with_arrays).into_iter().chain(inside).collect()
    }
}

impl Facts {
    pub(crate) fn of(time: f64, mesh: &Mesh, quality: Option<Quality>) -> Self {
        let cells = mesh.cells.counts().into_iter().map(|(kind, n)| (kind.label(), n)).collect();
        Self { time, points: mesh.points.len(), cells, quality, least_gap: least_gap(mesh) }
    }
}

fn least_gap(mesh: &Mesh) -> Option<(f64, Point)> {
    let gaps = mesh.point_field("gap").filter(|field| field.components == 1)?.values.to_f64()?;
    let finite = gaps.iter().copied().zip(&mesh.points).filter(|(gap, _)| gap.is_finite());
    finite.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(gap, place)| (gap, *place))
}

impl Shown {
    /// The state before reading, with the name only.
    pub(crate) fn of(input: &Meshes) -> Self {
        Self { name: name_of(&input.file), is_series: input.is_series, with_arrays: true, ..Self::default() }
    }

    /// The index of an array in the list of all arrays, by its name and whether it is on points or cells;
    /// added if missing.
    pub(crate) fn place_of(&mut self, array: &Array) -> usize {
        let is_it = |key: &Key| (&key.name, key.on) == (&array.key.name, array.key.on);
        let place = self.keys.iter().position(is_it).unwrap_or_else(|| {
            self.keys.push(array.key.clone());
            self.names.push(array.names.clone());
            self.keys.len() - 1
        });
        self.keys[place].is_label &= array.key.is_label;
        self.keys[place].is_vector |= array.key.is_vector;
        self.names[place].extend(array.names.iter().map(|(id, name)| (*id, name.clone())));
        place
    }

    /// Lists what is not on the page.
    pub(crate) fn note_left_out(&mut self) {
        let (n, m) = (self.facts.len(), self.frames.len());
        let mut sentences = Vec::new();
        if m < n {
            sentences.push(format!(
                "{} of {} frames have a picture: the first, the last and evenly chosen ones between. The others are in the charts and tables.",
                count(m),
                count(n)
            ));
        }
        if !self.with_arrays {
            sentences.push("Arrays are left out: pictures have one colour.".to_owned());
        }
        sentences.extend(self.insides_left_out());
        self.left_out = sentences;
        self.notes.iter_mut().filter(|note| !note.ends_with('.')).for_each(|note| note.push('.'));
    }

    fn insides_left_out(&self) -> Vec<String> {
        let solid: Vec<&ShownFrame> = self.frames.iter().filter(|frame| frame.n_solids > 0).collect();
        let with = |is: fn(&InsidePart) -> bool| {
            solid.iter().filter(|frame| frame.inside.as_ref().is_some_and(is)).count()
        };
        let all = with(|inside| inside.holds == Holds::All);
        let cut = with(|inside| matches!(inside.holds, Holds::Planes(_)));
        let mut sentences = Vec::new();
        if cut > 0 {
            sentences.push(format!(
                "For {}, the page contains only the cells that some planes cross; cuts are made at those \
                 planes.",
                self.so_many(cut)
            ));
        }
        if all + cut < solid.len() {
            sentences.push(format!(
                "For {}, the page contains only the surface (and bad tets); a cut shows a hollow body.",
                self.so_many(solid.len() - all - cut)
            ));
        }
        if self.with_arrays && all + cut > 0 && solid.iter().any(|frame| self.lacks_arrays(frame)) {
            sentences
                .push("Inside, cells have no colours of arrays other than quality and labels.".to_owned());
        }
        sentences
    }

    fn so_many(&self, frames: usize) -> String {
        if self.is_series { counted(frames, "frame") } else { "the mesh".to_owned() }
    }

    /// Whether arrays of the skin are missing inside.
    fn lacks_arrays(&self, frame: &ShownFrame) -> bool {
        let has_more = self.keys.iter().any(|key| !key.is_label && key.name != EAS);
        has_more
            && frame.inside.as_ref().is_some_and(|inside| inside.holds != Holds::Bad && !inside.with_arrays)
    }
}
