//! Boxes that are added and removed one by one, found by a point or a box: a hierarchical hash table.
//!
//! A box is stored in the cells that it touches of a grid whose cells are hardly larger than the box: the
//! smallest power of two. There is a grid for each such size, so boxes of all sizes take at most eight cells
//! (Overmars 1992, *Point location in fat subdivisions*). A tree over all boxes costs more than it saves
//! where few of them are ever asked for.

use std::collections::BTreeMap;

use hashbrown::HashMap;

use crate::base::Point;
use crate::spatial::boxes::{Bounds, squared_distance_to_box, touch};

/// Boxes with an id each; an id may be added more than once.
#[derive(Clone, Debug, Default)]
pub(crate) struct GrowingBoxes {
    /// By the binary exponent of the size of cells.
    grids: BTreeMap<i32, Grid>,
}

#[derive(Clone, Debug, Default)]
struct Grid {
    boxes: Vec<(u32, Bounds)>,
    /// Places in the list that are not in use.
    unused: Vec<u32>,
    /// The boxes that touch a cell, by their places in the list.
    cells: HashMap<[i64; 3], Vec<u32>>,
}

/// The lowest squared distance so far, with the id that has it.
type Best<T> = Option<(f64, u32, T)>;

impl GrowingBoxes {
    /// Adds a box.
    pub(crate) fn add(&mut self, id: u32, [low, high]: Bounds) {
        let level = level_of([low, high]);
        let grid = self.grids.entry(level).or_default();
        let place = grid.unused.pop().unwrap_or(grid.boxes.len() as u32);
        if place as usize == grid.boxes.len() {
            grid.boxes.push((id, [low, high]));
        }
        grid.boxes[place as usize] = (id, [low, high]);
        for_each_cell(level, [low, high], |cell| grid.cells.entry(cell).or_default().push(place));
    }

    /// Removes a box that was added with this id.
    pub(crate) fn remove(&mut self, id: u32, bounds: Bounds) {
        let level = level_of(bounds);
        let Some(grid) = self.grids.get_mut(&level) else { return };
        let mut removed = None;
        for_each_cell(level, bounds, |cell| {
            let Some(places) = grid.cells.get_mut(&cell) else { return };
            let boxes = &grid.boxes;
            let is_it = |&place: &u32| boxes[place as usize] == (id, bounds);
            if let Some(k) =
                places.iter().position(|place| removed.map_or_else(|| is_it(place), |r| r == *place))
            {
                removed = Some(places.swap_remove(k));
            }
        });
        if let Some(place) = removed {
            grid.boxes[place as usize].1 = NOWHERE;
            grid.unused.push(place);
        }
    }

    /// Appends the ids of all boxes that touch a box to `found`; an id may be appended more than once.
    pub(crate) fn touching(&self, bounds: Bounds, found: &mut Vec<u32>) {
        for (&level, grid) in &self.grids {
            let mut look = |&(id, other): &(u32, Bounds)| {
                if touch(other, bounds) {
                    found.push(id);
                }
            };
            if !grid.has_fewer_cells(level, bounds) {
                grid.boxes.iter().for_each(look);
                continue;
            }
            for_each_cell(level, bounds, |cell| {
                let places = grid.cells.get(&cell).into_iter().flatten();
                places.for_each(|&place| look(&grid.boxes[place as usize]));
            });
        }
    }

    /// The id with the lowest measure, the lowest among equals, and what `measure` returned with it. The
    /// measure is the squared distance of `point` from what lies in the box, or `None`; it is not below that
    /// from the box.
    pub(crate) fn nearest<T>(
        &self,
        point: Point,
        measure: impl Fn(u32) -> Option<(f64, T)>,
    ) -> Option<(f64, u32, T)> {
        let mut best = None;
        for (&level, grid) in &self.grids {
            grid.look_around(level, [point, point], point, &measure, &mut best);
        }
        // Other cells, or all boxes where none was found, may hold something nearer.
        let reach = best.as_ref().map_or(f64::INFINITY, |best| best.0.sqrt());
        if reach > 0.0 {
            let around = [point.map(|x| x - reach), point.map(|x| x + reach)];
            for (&level, grid) in &self.grids {
                grid.look_around(level, around, point, &measure, &mut best);
            }
        }
        best
    }
}

/// The box of what is removed: it touches nothing.
const NOWHERE: Bounds = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];

/// The grid that holds a box.
fn level_of([low, high]: Bounds) -> i32 {
    let extent = (0..3).map(|k| high[k] - low[k]).fold(0.0, f64::max);
    // Cells so small that coordinates in units of them are no longer exact are of no use.
    let largest = low.iter().chain(&high).fold(f64::MIN_POSITIVE, |most, x| most.max(x.abs()));
    exponent(extent.max(largest * f64::EPSILON))
}

impl Grid {
    /// Whether a box touches fewer cells than there are boxes, about.
    fn has_fewer_cells(&self, level: i32, [low, high]: Bounds) -> bool {
        let n_cells: f64 = (0..3).map(|k| (high[k] - low[k]) * scale(level) + 2.0).product();
        n_cells < 8.0 + self.boxes.len() as f64
    }

    /// Measures the boxes in the cells that a box around a point touches.
    fn look_around<T>(
        &self,
        level: i32,
        around: Bounds,
        point: Point,
        measure: &impl Fn(u32) -> Option<(f64, T)>,
        best: &mut Best<T>,
    ) {
        if !self.has_fewer_cells(level, around) {
            return self.boxes.iter().for_each(|&of| improve(of, point, measure, best));
        }
        for_each_cell(level, around, |cell| {
            let places = self.cells.get(&cell).into_iter().flatten();
            places.for_each(|&place| improve(self.boxes[place as usize], point, measure, best));
        });
    }
}

/// Measures a box, if it can be better than the best so far.
fn improve<T>(
    (id, bounds): (u32, Bounds),
    point: Point,
    measure: &impl Fn(u32) -> Option<(f64, T)>,
    best: &mut Best<T>,
) {
    let least = squared_distance_to_box(point, bounds);
    if bounds == NOWHERE || best.as_ref().is_some_and(|best| least > best.0 || best.1 == id) {
        return;
    }
    if let Some((squared, with)) = measure(id)
        && best.as_ref().is_none_or(|best| squared < best.0 || squared == best.0 && id < best.1)
    {
        *best = Some((squared, id, with));
    }
}

/// The exponent of the smallest power of two above a positive number.
fn exponent(x: f64) -> i32 {
    (((x.to_bits() >> 52) & 0x7ff) as i32 - 1022).clamp(-1000, 1000)
}

/// One divided by the size of cells.
fn scale(level: i32) -> f64 {
    2f64.powi(-level)
}

fn for_each_cell(level: i32, [low, high]: Bounds, mut act: impl FnMut([i64; 3])) {
    let scale = scale(level);
    let [low, high] = [low, high].map(|corner| corner.map(|x| (x * scale).floor() as i64));
    for x in low[0]..=high[0] {
        for y in low[1]..=high[1] {
            for z in low[2]..=high[2] {
                act([x, y, z]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::splitmix64;

    fn unit(state: &mut u64) -> f64 {
        *state += 1;
        (splitmix64(*state) >> 11) as f64 / (1u64 << 53) as f64
    }

    #[test]
    fn the_nearest_box_is_that_of_a_search_through_all() {
        for (shift, size) in [(0.0, 1.0), (1e6, 1e-3), (-40.0, 1e3)] {
            let (mut state, mut boxes, mut all) = (3, GrowingBoxes::default(), Vec::new());
            for id in 0..400u32 {
                // From needles to boxes as large as everything.
                let extent = size * 10f64.powf(-4.0 * unit(&mut state));
                let low = [(); 3].map(|()| shift + size * unit(&mut state));
                let high = low.map(|x| x + extent * unit(&mut state));
                boxes.add(id, [low, high]);
                all.push([low, high]);
                if id % 4 > 0 {
                    continue;
                }
                // Within, beside and far away.
                let spread = [1.0, 3.0, 1e4][id as usize / 4 % 3];
                let point = [(); 3].map(|()| shift + size * spread * (unit(&mut state) - 0.2));
                let measure = |id: u32| Some((squared_distance_to_box(point, all[id as usize]), ()));
                let found = boxes.nearest(point, measure).map(|(squared, id, ())| (squared, id));
                let least = (0..=id).map(|id| (squared_distance_to_box(point, all[id as usize]), id));
                let least = least.min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                assert_eq!(found, least, "{point:?}");
            }
        }
    }

    #[test]
    fn points_are_boxes_and_nothing_is_found_in_nothing() {
        let mut boxes = GrowingBoxes::default();
        let measure = |_: u32| Some((0.0, ()));
        assert!(boxes.nearest([0.0; 3], measure).is_none());
        for x in [0.0, 1e300, -1e-300] {
            boxes.add(7, [[x; 3]; 2]);
            assert!(boxes.nearest([x; 3], measure).is_some_and(|found| found.1 == 7));
        }
        assert!(boxes.nearest([1e10, 0.0, 0.0], |_| None::<(f64, ())>).is_none());
    }
}
