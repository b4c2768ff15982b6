//! Divides space into parts in which threads insert points at the same time.

use super::conflict::FROZEN;
use super::store::{FREE, Tets, is_ghost};
use crate::base::{Point, Threads};

/// Points of a sample for each part, by which space is divided.
const SAMPLE: usize = 256;

/// Slots that a thread looks at, at a time.
const RUN: usize = 1 << 16;
/// Of each part one tet of so many slots is listed as a hint, if the part has one there.
const HINT_RUN: u32 = 1 << 11;
/// The largest number of hints of a part.
const MOST_HINTS: usize = 256;

/// The part of each vertex. Parts are boxes: space is divided in two, and each side again, with about as many
/// of the points to insert on each side.
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

    /// Whether the neighbour of a frozen tet, given by its vertices, belongs to another part.
    #[cold]
    pub(super) fn is_beyond(self, vertices: [u32; 4]) -> bool {
        of_tet(self.of_vertex, vertices).is_some_and(|part| part != self.own)
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
}

/// The part to which at least three vertices of a tet belong; of a ghost, all three. So two tets that share
/// a facet never belong to different parts.
fn of_tet(of_vertex: &[u16], vertices: [u32; 4]) -> Option<u16> {
    let [a, b, c, d] = vertices.map(|v| of_vertex[v as usize]);
    if is_ghost(vertices) {
        (a == b && b == c).then_some(a)
    } else if a == b {
        (c == a || d == a).then_some(a)
    } else {
        (c == d && (c == a || c == b)).then_some(c)
    }
}

/// Divides a box that has the points of `sample` into `n` parts, numbered from `first`.
fn divide(sample: &mut [Point], first: usize, n: usize, splits: &mut Vec<Split>) -> Side {
    if n < 2 || sample.is_empty() {
        return Side::Part(first as u16);
    }
    let n_below_parts = n / 2;
    let (axis, middle) = sparsest(sample, sample.len() * n_below_parts / n);
    let (below, at, _) = sample.select_nth_unstable_by(middle, |p, q| p[axis].total_cmp(&q[axis]));
    let at = at[axis];
    let n_below = below.len();
    let split = splits.len();
    splits.push(Split { axis, at, sides: [Side::Part(0); 2] });
    let (below, above) = sample.split_at_mut(n_below);
    splits[split].sides = [
        divide(below, first, n_below_parts, splits),
        divide(above, first + n_below_parts, n - n_below_parts, splits),
    ];
    Side::Split(split)
}

/// The axis, and the place in the order along it, where a plane has few points close by: points near the
/// plane will be left, and those that are left lie near the planes of earlier parts. Places far from `middle`
/// need fewer points.
fn sparsest(sample: &[Point], middle: usize) -> (usize, usize) {
    let n = sample.len();
    let window = (n / 16).max(1);
    let (mut best, mut widest) = ((0, middle), -1.0);
    for axis in 0..3 {
        let mut values: Vec<f64> = sample.iter().map(|p| p[axis]).collect();
        values.sort_unstable_by(f64::total_cmp);
        for start in 0..n - window {
            let off_middle = (start + window / 2).abs_diff(middle) as f64 / n as f64;
            let width = (values[start + window] - values[start]) * (1.0 - 4.0 * off_middle);
            if width > widest {
                (best, widest) = ((axis, start + window / 2), width);
            }
        }
    }
    best
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
    /// For each part some of its tets that are not ghosts.
    pub(super) hints: Vec<Vec<u32>>,
}

impl Frozen {
    /// Marks tets in the first `n_used` slots.
    pub(super) fn new(tets: Tets, n_used: usize, parts: &Parts, threads: &Threads) -> Self {
        let runs = (0..n_used as u32).step_by(RUN).map(|from| from..(n_used as u32).min(from + RUN as u32));
        let found = threads.each(runs.collect(), |run| {
            let (mut frozen, mut hints) = (Vec::new(), vec![Vec::new(); parts.count]);
            for tet in run {
                let vertices = tets.vertices.get(tet);
                if vertices == FREE {
                    continue;
                }
                match of_tet(&parts.of_vertex, vertices) {
                    Some(part) if !is_ghost(vertices) => {
                        let hints: &mut Vec<u32> = &mut hints[usize::from(part)];
                        if hints.last().is_none_or(|last| last / HINT_RUN != tet / HINT_RUN) {
                            hints.push(tet);
                        }
                    }
                    Some(_) => {}
                    None => {
                        tets.gauges.set_mark(tet, FROZEN);
                        frozen.push(tet);
                    }
                }
            }
            (frozen, hints)
        });
        let hints_of = |part: usize| {
            let all: Vec<u32> = found.iter().flat_map(|(_, hints)| &hints[part]).copied().collect();
            all.iter().copied().step_by(all.len().div_ceil(MOST_HINTS).max(1)).collect()
        };
        let hints = (0..parts.count).map(hints_of).collect();
        Self { tets: found.into_iter().map(|f| f.0).collect(), hints }
    }

    /// Takes the marks away.
    pub(super) fn release(self, tets: Tets) {
        self.tets.iter().flatten().for_each(|&tet| tets.gauges.set_mark(tet, 0));
    }
}

#[cfg(test)]
mod tests {
    use super::super::store::INFINITY;
    use super::of_tet;

    #[test]
    fn neighbours_never_belong_to_different_parts() {
        let neighbours = [
            [[1, 2, 3, 4], [1, 3, 2, 5]],
            [[1, 2, 3, 4], [1, 3, 2, INFINITY]],
            [[1, 2, 3, INFINITY], [1, 4, 2, INFINITY]],
        ];
        for code in 0..3u16.pow(6) {
            // All ways to give five vertices, and the one at infinity, a part of three.
            let of_vertex = [0, 1, 2, 3, 4, 5].map(|v| code / 3u16.pow(v) % 3);
            for [one, other] in neighbours {
                if let (Some(one), Some(other)) = (of_tet(&of_vertex, one), of_tet(&of_vertex, other)) {
                    assert_eq!(one, other, "{of_vertex:?}");
                }
            }
            let most = (0..3).find(|&part| (1..5).filter(|&v| of_vertex[v] == part).count() >= 3);
            assert_eq!(of_tet(&of_vertex, [1, 2, 3, 4]), most, "{of_vertex:?}");
        }
    }
}
