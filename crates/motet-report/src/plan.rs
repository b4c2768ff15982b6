//! Which frames of an input go onto the page, and how much of each: the skins of as many frames as fit, then
//! their insides.

use std::collections::BTreeSet;
use std::rc::Rc;

use motet::{Mesh, Result};

use crate::arrays::{self, Array};
use crate::input::Meshes;
use crate::labels;
use crate::layout::Layout;
use crate::layouts::Layouts;
use crate::numbers::{count, counted};
use crate::part::{Frame, Holds, InsidePart, grid};
use crate::quality::{self, Quality};
use crate::shown::{Facts, Shown, ShownFrame};
use crate::store::{BlockId, Store};

/// Levels of detail for insides, the best first: which cells, and whether with all arrays.
const LEVELS: [(Holds, bool); 7] = [
    (Holds::All, true),
    (Holds::All, false),
    (Holds::Planes(31), false),
    (Holds::Planes(15), false),
    (Holds::Planes(7), false),
    (Holds::Planes(3), false),
    (Holds::Planes(1), false),
];

/// Reads an input and packs it into `budget` bytes of the page; blocks in `paid` cost nothing.
pub(crate) fn shown(
    input: &Meshes,
    budget: usize,
    store: &mut Store,
    paid: &mut BTreeSet<BlockId>,
) -> Result<Shown> {
    let mut plan = Plan { input, budget, store, paid, reader: Reader::default(), shown: Shown::of(input) };
    plan.skins()?;
    plan.choose_frames();
    plan.insides()?;
    let mut shown = plan.shown;
    shown.note_left_out();
    paid.extend(shown.frames.iter().flat_map(|frame| frame.blocks(shown.with_arrays)));
    Ok(shown)
}

/// The last mesh read, with the layouts that meshes of the same cells share.
#[derive(Default)]
struct Reader {
    frame: Option<usize>,
    mesh: Mesh,
    layouts: Layouts,
    layout: Rc<Layout>,
    by_cell: quality::ByCell,
    quality: Option<Quality>,
    notes: Vec<String>,
}

impl Reader {
    fn go_to(&mut self, input: &Meshes, frame: usize) -> Result<()> {
        if self.frame == Some(frame) {
            return Ok(());
        }
        let (mesh, notes) = input.read(frame)?;
        self.layout = self.layouts.of(input, frame, &mesh)?;
        (self.quality, self.by_cell) = quality::of(&mesh);
        (self.mesh, self.notes, self.frame) = (mesh, notes, Some(frame));
        Ok(())
    }

    fn arrays(&self, shown: &mut Shown) -> Vec<(usize, Array)> {
        arrays::of(&self.mesh, &self.by_cell.eas)
            .into_iter()
            .map(|array| (shown.place_of(&array), array))
            .collect()
    }

    fn frame<'a>(&'a self, arrays: &'a [(usize, Array)]) -> Frame<'a> {
        Frame {
            mesh: &self.mesh,
            layout: &self.layout,
            arrays,
            bad: &self.by_cell.bad,
            grid: grid(&self.mesh),
        }
    }
}

/// The packing of one input.
struct Plan<'a> {
    input: &'a Meshes,
    budget: usize,
    store: &'a mut Store,
    paid: &'a BTreeSet<BlockId>,
    reader: Reader,
    shown: Shown,
}

impl Plan<'_> {
    /// Packs the skin of every frame, and its whole inside as long as everything fits.
    fn skins(&mut self) -> Result<()> {
        let mut spent = self.paid.clone();
        let mut left = self.budget;
        for (frame, (time, _)) in self.input.frames.iter().enumerate() {
            self.reader.go_to(self.input, frame)?;
            let reader = &self.reader;
            self.shown.facts.push(Facts::of(*time, &reader.mesh, reader.quality.clone()));
            self.note();
            let arrays = self.reader.arrays(&mut self.shown);
            let packed = self.reader.frame(&arrays);
            labels::add(&mut self.shown.labels, &packed);
            let (n_solids, skin) = (packed.n_solids(), packed.skin(self.store));
            let mut shown_frame = ShownFrame { frame, skin, inside: None, n_solids };
            if left > 0 && n_solids > 0 {
                shown_frame.inside = packed.inside(Holds::All, true, self.store);
            }
            let blocks = shown_frame.blocks(true);
            left = left.saturating_sub(self.store.cost(&blocks, &spent));
            spent.extend(blocks);
            self.shown.frames.push(shown_frame);
        }
        if left == 0 {
            self.shown.frames.iter_mut().for_each(|shown_frame| shown_frame.inside = None);
        }
        Ok(())
    }

    fn note(&mut self) {
        let reader = &self.reader;
        let mut notes = reader.notes.clone();
        if reader.layout.not_finite > 0 {
            let n = counted(reader.layout.not_finite, "triangle or cell");
            notes.push(format!("{n} have points that are not finite, and are not in the picture."));
        }
        if reader.layout.not_known > 0 {
            let n = count(reader.layout.not_known);
            notes.push(format!(
                "{n} volume cells are of kinds with unknown facets, and are not in the picture."
            ));
        }
        notes.retain(|note| !self.shown.notes.contains(note));
        self.shown.notes.extend(notes);
    }

    fn cost(&self, frames: &[usize], with_arrays: bool) -> usize {
        let blocks = frames.iter().flat_map(|&i| self.shown.frames[i].skin.blocks(with_arrays));
        self.store.cost(&blocks.collect::<Vec<_>>(), self.paid)
    }

    /// Keeps as many skins as fit, evenly chosen; if not even two fit, without arrays.
    fn choose_frames(&mut self) {
        let n = self.shown.frames.len();
        let least = n.min(2);
        let with_arrays = self.cost(&even(n, least), true) <= self.budget;
        self.shown.with_arrays = with_arrays;
        let fits = |m: usize| self.cost(&even(n, m), with_arrays) <= self.budget;
        let (mut low, mut high) = (least, n);
        while low < high {
            let middle = (low + high).div_ceil(2);
            if fits(middle) { low = middle } else { high = middle - 1 }
        }
        let kept = even(n, low);
        if !with_arrays {
            self.shown.frames.iter_mut().for_each(|frame| frame.skin.clear_arrays());
        }
        let mut frame = 0..;
        self.shown.frames.retain(|_| frame.next().is_some_and(|i| kept.contains(&i)));
    }

    /// Packs the insides where some are missing: at the best level that all frames can have.
    fn insides(&mut self) -> Result<()> {
        if self.shown.frames.iter().all(|frame| frame.inside.is_some() || frame.n_solids == 0) {
            return Ok(());
        }
        self.shown.frames.iter_mut().for_each(|frame| frame.inside = None);
        let mut spent = self.paid.clone();
        let skins = self.shown.frames.iter().flat_map(|f| f.skin.blocks(true)).collect::<Vec<_>>();
        let mut left = self.budget.saturating_sub(self.store.cost(&skins, &spent));
        spent.extend(skins);
        let order = spread(self.shown.frames.len());
        let mut level = 0;
        for (done, &place) in order.iter().enumerate() {
            // The first frame may take only its share of the budget left, so that all frames get the same
            // level; after it, shared blocks are paid for.
            let share = if done == 0 { left / order.len() } else { left };
            let (inside, reached) = self.inside(place, level, left, share, &spent)?;
            level = reached;
            if let Some(inside) = inside {
                left = left.saturating_sub(self.store.cost(&inside.blocks(), &spent));
                spent.extend(inside.blocks());
                self.shown.frames[place].inside = Some(inside);
            }
        }
        Ok(())
    }

    /// Packs the inside of one frame at the first level from `level` on that fits; otherwise its bad tets,
    /// where those fit.
    fn inside(
        &mut self,
        place: usize,
        level: usize,
        left: usize,
        share: usize,
        spent: &BTreeSet<BlockId>,
    ) -> Result<(Option<InsidePart>, usize)> {
        self.reader.go_to(self.input, self.shown.frames[place].frame)?;
        let arrays = self.reader.arrays(&mut self.shown);
        let frame = self.reader.frame(&arrays);
        for (i, (holds, with_arrays)) in LEVELS.iter().enumerate().skip(level) {
            let inside = frame.inside(*holds, *with_arrays && self.shown.with_arrays, self.store);
            if let Some(inside) = inside.filter(|x| self.store.cost(&x.blocks(), spent) <= share) {
                return Ok((Some(inside), i));
            }
        }
        let bad = frame.inside(Holds::Bad, false, self.store);
        Ok((bad.filter(|x| self.store.cost(&x.blocks(), spent) <= left), LEVELS.len()))
    }
}

/// `m` of `n` indices: the first, the last, and evenly chosen ones between.
fn even(n: usize, m: usize) -> Vec<usize> {
    match m {
        0 => Vec::new(),
        1 => vec![0],
        _ => (0..m).map(|i| i * (n - 1) / (m - 1)).collect(),
    }
}

/// All indices in an order in which the early ones lie far apart: the first, the last, those in the middle.
fn spread(n: usize) -> Vec<usize> {
    let mut order = Vec::new();
    let mut m = 1;
    while order.len() < n {
        order.extend(even(n, m.min(n)).into_iter().filter(|i| !order.contains(i)).collect::<Vec<_>>());
        m = if m == 1 { 2 } else { 2 * m - 1 };
    }
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_chosen_evenly_with_both_ends() {
        assert_eq!(even(11, 3), [0, 5, 10]);
        assert_eq!(even(5, 5), [0, 1, 2, 3, 4]);
        assert_eq!(spread(5), [0, 4, 2, 1, 3]);
        for n in 1..40 {
            let mut all = spread(n);
            all.sort_unstable();
            assert_eq!(all, (0..n).collect::<Vec<_>>());
        }
    }
}
