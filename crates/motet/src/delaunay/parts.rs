//! Divides space into parts in which threads insert points at the same time.

use super::conflict::FROZEN;
use super::store::{FACETS, FREE, INFINITY, Tets, is_ghost};
use crate::base::{Point, Threads};

/// Points of a sample for each part, by which space is divided.
const SAMPLE: usize = 1024;

/// Slots that a thread looks at, at a time.
const RUN: usize = 1 << 16;

/// The part of each vertex. Parts are boxes: halves along the longest axis, halved again, with about as many
/// of the points to insert in each.
pub(super) struct Parts {
    of_vertex: Vec<u16>,
    count: usize,
}

/// The part of a thread.
#[derive(Clone, Copy)]
pub(super) struct Part<'a> {
    of_vertex: &'a [u16],
    own: u16,
}

impl Part<'static> {
    /// All of space.
    pub(super) const ALL: Self = Self { of_vertex: &[], own: 0 };
}

impl Part<'_> {
    /// Whether this is all of space, where no tet is frozen.
    pub(super) fn is_all(self) -> bool {
        self.of_vertex.is_empty()
    }

    /// Whether what lies behind a facet of a frozen tet belongs to another part, or may do so.
    #[cold]
    pub(super) fn is_beyond(self, vertices: [u32; 4], facet: usize) -> bool {
        let mut corners = FACETS[facet].into_iter().map(|i| vertices[i]).filter(|&v| v != INFINITY);
        corners.all(|v| self.of_vertex[v as usize] != self.own)
    }
}

/// What lies on one side of a plane.
#[derive(Clone, Copy)]
enum Side {
    Part(u16),
    Split(usize),
}

/// A plane across an axis.
struct Split {
    axis: usize,
    at: f64,
    sides: [Side; 2],
}

impl Parts {
    /// Divides space into `n_parts` parts, fewer than 2^16, for the insertion of `vertices`.
    pub(super) fn new(points: &[Point], vertices: &[u32], n_parts: usize, threads: &Threads) -> Self {
        let step = (vertices.len() / (SAMPLE * n_parts)).max(1);
        let mut sample: Vec<Point> = vertices.iter().step_by(step).map(|&v| points[v as usize]).collect();
        let mut splits = Vec::new();
        let root = divide(&mut sample, 0, n_parts, &mut splits);
        let of_vertex = threads.map(points.len(), |v| part(&splits, root, points[v]));
        Self { of_vertex, count: n_parts }
    }

    /// The part of a number.
    pub(super) fn get(&self, part: usize) -> Part<'_> {
        Part { of_vertex: &self.of_vertex, own: part as u16 }
    }

    /// Those of `vertices` that belong to a part.
    pub(super) fn own(&self, vertices: &[u32], part: usize) -> Vec<u32> {
        let is_own = |v: &u32| usize::from(self.of_vertex[*v as usize]) == part;
        vertices.iter().copied().filter(is_own).collect()
    }

    /// The part to which all vertices of a tet belong, the one at infinity aside.
    fn of_tet(&self, vertices: [u32; 4]) -> Option<u16> {
        let [a, b, c, d] = vertices.map(|v| self.of_vertex[v as usize]);
        (a == b && b == c && (c == d || is_ghost(vertices))).then_some(a)
    }
}

/// Divides a box that has the points of `sample` into `n` parts, numbered from `first`.
fn divide(sample: &mut [Point], first: usize, n: usize, splits: &mut Vec<Split>) -> Side {
    if n < 2 || sample.is_empty() {
        return Side::Part(first as u16);
    }
    let extent = |axis: usize| {
        let of = |range: [f64; 2], p: &Point| [range[0].min(p[axis]), range[1].max(p[axis])];
        let [low, high] = sample.iter().fold([f64::INFINITY, f64::NEG_INFINITY], of);
        high - low
    };
    let axis = (0..3).max_by(|&i, &j| extent(i).total_cmp(&extent(j))).unwrap_or(0);
    let middle = sample.len() * (n / 2) / n;
    let (below, at, _) = sample.select_nth_unstable_by(middle, |p, q| p[axis].total_cmp(&q[axis]));
    let at = at[axis];
    let n_below = below.len();
    let split = splits.len();
    splits.push(Split { axis, at, sides: [Side::Part(0); 2] });
    let (below, above) = sample.split_at_mut(n_below);
    splits[split].sides =
        [divide(below, first, n / 2, splits), divide(above, first + n / 2, n - n / 2, splits)];
    Side::Split(split)
}

fn part(splits: &[Split], root: Side, p: Point) -> u16 {
    let mut side = root;
    loop {
        match side {
            Side::Part(part) => return part,
            Side::Split(i) => side = splits[i].sides[usize::from(p[splits[i].axis] >= splits[i].at)],
        }
    }
}

/// The tets between parts, which are marked as [`FROZEN`].
pub(super) struct Frozen {
    tets: Vec<Vec<u32>>,
    /// For each part one of its tets that is not a ghost.
    pub(super) hints: Vec<Option<u32>>,
}

impl Frozen {
    /// Marks tets in the first `n_used` slots.
    pub(super) fn new(tets: Tets, n_used: usize, parts: &Parts, threads: &Threads) -> Self {
        let runs = (0..n_used as u32).step_by(RUN).map(|from| from..(n_used as u32).min(from + RUN as u32));
        let found = threads.each(runs.collect(), |run| {
            let (mut frozen, mut hints) = (Vec::new(), vec![None; parts.count]);
            for tet in run {
                let vertices = tets.vertices.get(tet);
                if vertices == FREE {
                    continue;
                }
                match parts.of_tet(vertices) {
                    Some(part) if !is_ghost(vertices) => hints[usize::from(part)] = Some(tet),
                    Some(_) => {}
                    None => {
                        tets.gauges.set_mark(tet, FROZEN);
                        frozen.push(tet);
                    }
                }
            }
            (frozen, hints)
        });
        let hint = |part: usize| found.iter().find_map(|(_, hints)| hints[part]);
        let hints = (0..parts.count).map(hint).collect();
        Self { tets: found.into_iter().map(|f| f.0).collect(), hints }
    }

    /// Takes the marks away.
    pub(super) fn release(self, tets: Tets) {
        self.tets.iter().flatten().for_each(|&tet| tets.gauges.set_mark(tet, 0));
    }
}
