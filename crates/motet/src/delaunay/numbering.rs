//! From the builder's arrays to the caller's, as in `finish`, but with tets numbered by their vertices.
//!
//! Which slot a tet has depends on the parts of space in which points were inserted, and so on the number of
//! threads. These numbers depend on the triangulation alone, but take three times as long.

use std::sync::atomic::{AtomicU32, Ordering};

use super::finish::{Finished, push_hull};
use super::store::is_ghost;
use crate::base::{Csr, TetId, Threads, VertexId};
use crate::spatial::OUTSIDE;

/// Numbers the tets by their vertices, the one that was inserted last first, and orders the vertices of each
/// tet in the same way, as far as its orientation allows. Arrays are the vertices and the links of all slots.
pub(super) fn by_vertices(arrays: [Vec<[u32; 4]>; 2], vertex_to_id: &[u32], threads: &Threads) -> Finished {
    let [vertices, links] = arrays;
    let Order { tets, slots, turns } = in_order(&vertices, vertex_to_id, threads);
    let tet_of = threads.map(vertices.len(), |_| AtomicU32::new(OUTSIDE.0));
    let n = slots.len();
    threads.each((0..n).step_by(RUN).collect(), |from| {
        for (tet, &slot) in (from..).zip(&slots[from..n.min(from + RUN)]) {
            tet_of[slot as usize].store(tet as u32, Ordering::Relaxed);
        }
    });
    let number = |link: u32| tet_of[(link >> 2) as usize].load(Ordering::Relaxed);
    // Memory that is there is faster than new memory.
    let mut neighbors = vertices;
    neighbors.truncate(n);
    let parts = neighbors.chunks_mut(RUN).enumerate().collect();
    let hull = threads.each(parts, |(part, neighbors): (usize, &mut [[u32; 4]])| {
        let mut hull = Vec::new();
        for (tet, neighbors) in (part * RUN..).zip(neighbors) {
            let [a, b, c, d] = turned(links[slots[tet] as usize], turns[tet]);
            *neighbors = [number(a), number(b), number(c), number(d)];
            push_hull(tet, tets[tet], *neighbors, &mut hull);
        }
        hull
    });
    Finished { tets: as_ids(tets, VertexId), neighbors: as_ids(neighbors, TetId), hull: hull.concat() }
}

/// Turns numbers into ids, in place: a vector collected from its own elements keeps its memory.
fn as_ids<T>(numbers: Vec<[u32; 4]>, id: impl Fn(u32) -> T) -> Vec<[T; 4]> {
    numbers.into_iter().map(|[a, b, c, d]| [id(a), id(b), id(c), id(d)]).collect()
}

/// The even permutations of four: those that begin with the first, the second, ...
const TURNS: [[usize; 4]; 12] = [
    [0, 1, 2, 3],
    [0, 2, 3, 1],
    [0, 3, 1, 2],
    [1, 0, 3, 2],
    [1, 3, 2, 0],
    [1, 2, 0, 3],
    [2, 3, 0, 1],
    [2, 0, 1, 3],
    [2, 1, 3, 0],
    [3, 2, 1, 0],
    [3, 1, 0, 2],
    [3, 0, 2, 1],
];

/// The place in [`TURNS`] of the permutation that puts the largest vertex first, the smallest next.
#[inline(always)]
fn turn([a, b, c, d]: [u32; 4]) -> u8 {
    let (first, [x, y, z]) = if a > b.max(c).max(d) {
        (0, [b, c, d])
    } else if b > c.max(d) {
        (1, [a, d, c])
    } else if c > d {
        (2, [d, a, b])
    } else {
        (3, [c, b, a])
    };
    // Which one is the smallest is unpredictable.
    3 * first + u8::from(y < x.min(z)) + 2 * u8::from(z < x.min(y))
}

/// What belongs to the vertices of a tet, turned with them. Spelled out: `map` was not inlined.
#[inline(always)]
fn turned(of_vertices: [u32; 4], turn: u8) -> [u32; 4] {
    let [i, j, k, l] = TURNS[usize::from(turn)];
    [of_vertices[i], of_vertices[j], of_vertices[k], of_vertices[l]]
}

/// Slots that a thread looks at, at a time.
const RUN: usize = 1 << 16;
/// The least number of vertices whose tets are put in order together, so that they fit into a cache.
const LEAST_SPAN: usize = 1 << 9;
/// The largest number of groups of such vertices.
const MOST_GROUPS: usize = 1 << 11;

/// Tets in the order of their turned vertices.
struct Order {
    /// The turned vertices under the caller's ids.
    tets: Vec<[u32; 4]>,
    slots: Vec<u32>,
    /// Places in [`TURNS`].
    turns: Vec<u8>,
}

/// Puts all tets in order: first by groups of last vertices, then each group.
fn in_order(vertices: &[[u32; 4]], vertex_to_id: &[u32], threads: &Threads) -> Order {
    let n_vertices = vertex_to_id.len();
    let span = n_vertices.div_ceil(MOST_GROUPS).max(LEAST_SPAN);
    let n_groups = n_vertices.div_ceil(span);
    let group = |slot: u32| {
        let vertices @ [a, b, c, d] = vertices[slot as usize];
        (!is_ghost(vertices)).then(|| a.max(b).max(c.max(d)) as usize / span)
    };
    let runs = threads.each((0..vertices.len()).step_by(RUN).collect(), |from| {
        let slots = from as u32..vertices.len().min(from + RUN) as u32;
        Csr::from_pairs(n_groups, || slots.clone().filter_map(|slot| Some((group(slot)?, slot))))
    });
    let n_tets = |group: usize| runs.iter().map(|run| run.list(group).len()).sum();
    let lengths: Vec<usize> = (0..n_groups).map(n_tets).collect();
    let n = lengths.iter().sum();
    let mut order = Order { tets: vec![[0; 4]; n], slots: vec![0; n], turns: vec![0; n] };
    threads.each(order.groups(&lengths), |group| {
        let number = group.number;
        let slots = runs.iter().flat_map(|run| run.list(number)).copied();
        group.fill(slots, span, vertices, vertex_to_id);
    });
    order
}

impl Order {
    /// The parts of the arrays for groups of these lengths.
    fn groups(&mut self, lengths: &[usize]) -> Vec<Group<'_>> {
        let Self { tets, slots, turns } = self;
        let (mut tets, mut slots, mut turns) = (&mut tets[..], &mut slots[..], &mut turns[..]);
        let mut groups = Vec::with_capacity(lengths.len());
        for (number, &length) in lengths.iter().enumerate() {
            let own = tets.split_off_mut(..length).zip(slots.split_off_mut(..length));
            let own = own.zip(turns.split_off_mut(..length));
            groups.extend(own.map(|((tets, slots), turns)| Group { number, tets, slots, turns }));
        }
        groups
    }
}

/// The tets of a group of last vertices.
struct Group<'a> {
    number: usize,
    tets: &'a mut [[u32; 4]],
    slots: &'a mut [u32],
    turns: &'a mut [u8],
}

#[derive(Clone, Copy, Default)]
struct Entry {
    last: u32,
    /// The second and the third turned vertex: together with the last one they are an oriented facet, which
    /// only one tet has.
    key: u64,
    fourth: u32,
    slot: u32,
    turn: u8,
}

impl Group<'_> {
    /// Puts the tets of `slots` in order; the group has `span` last vertices.
    fn fill(
        self,
        slots: impl Iterator<Item = u32>,
        span: usize,
        vertices: &[[u32; 4]],
        vertex_to_id: &[u32],
    ) {
        let mut entries = Vec::with_capacity(self.tets.len());
        for slot in slots {
            let vertices = vertices[slot as usize];
            let turn = turn(vertices);
            let [last, second, third, fourth] = turned(vertices, turn);
            entries.push(Entry { last, key: u64::from(second) << 32 | u64::from(third), fourth, slot, turn });
        }
        let mut of_last =
            Csr::from_pairs(span, || entries.iter().map(|entry| (entry.last as usize % span, *entry)));
        (0..span).for_each(|k| of_last.list_mut(k).sort_unstable_by_key(|entry| entry.key));
        let id = |v: u32| vertex_to_id[v as usize];
        for (k, &Entry { last, key, fourth, slot, turn }) in of_last.items().iter().enumerate() {
            self.tets[k] = [id(last), id((key >> 32) as u32), id(key as u32), id(fourth)];
            (self.slots[k], self.turns[k]) = (slot, turn);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_keeps_the_orientation_and_begins_with_the_last_vertex() {
        for even in TURNS {
            let inversions = (0..4).flat_map(|j| (0..j).map(move |i| (i, j)));
            assert_eq!(inversions.filter(|&(i, j)| even[i] > even[j]).count() % 2, 0, "{even:?}");
            // All orders of one tet become the same.
            let vertices = even.map(|i| [30, 10, 40, 20][i]);
            assert_eq!(turned(vertices, turn(vertices)), [40, 10, 20, 30]);
        }
    }
}
