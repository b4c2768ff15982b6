//! Which tets share which facet, in a mesh of tets alone: the basis for walking from tet to tet.
//!
//! Facets are put into buckets by their lowest vertex, about twenty in each. Buckets are not sorted: a small
//! hash table detects equal facets, in a third of the time of a linear search and a sixth of the time of
//! sorting. Only a bucket too large for the table is sorted.

use std::ops::Range;

use crate::base::{MaybeId, TetId, Threads, VertexId};

/// The cells that share a facet: at most two tets in a sound mesh, and the triangles with the same three
/// vertices.
#[derive(Clone, Copy, Debug)]
pub struct Sharing<'a> {
    /// Each tet, and the index of the facet in it: facet `i` lies opposite vertex `i`.
    pub tets: &'a [(TetId, usize)],
    /// The triangles, in rising order.
    pub triangles: &'a [u32],
}

impl Sharing<'_> {
    /// Whether the facet lies on the boundary of the tets, separates two regions, or has a triangle; `true`
    /// if more than two tets share it, `false` if no tet has it.
    pub fn is_wall(&self, regions: &[i32]) -> bool {
        match *self.tets {
            [] => false,
            [(x, _), (y, _)] => !self.triangles.is_empty() || regions[x.index()] != regions[y.index()],
            _ => true,
        }
    }
}

/// Calls `see` once for every distinct facet of `tets` and `triangles`, with all tets and triangles that have
/// it, in the order of the lowest vertex.
///
/// Facets and triangles that name a vertex twice do not count. Panics if there are 2^29 tets and triangles or
/// more.
pub fn for_each_tet_facet(tets: &[[VertexId; 4]], triangles: &[[VertexId; 3]], see: impl FnMut(Sharing)) {
    for_each_of_part(tets, triangles, &(0..n_vertices(tets, triangles)), see);
}

/// Calls `see` once for every distinct facet as [`for_each_tet_facet`] does, on several threads: each takes
/// the facets of a range of lowest vertices, and gathers what it sees. Returns what was gathered, in the
/// order of the lowest vertices; into how many parts it is divided depends on the number of threads.
///
/// Panics as [`for_each_tet_facet`] does.
pub(crate) fn tet_facets_in_parts<T: Default + Send>(
    tets: &[[VertexId; 4]],
    triangles: &[[VertexId; 3]],
    threads: &Threads,
    see: impl Fn(&mut T, Sharing) + Sync,
) -> Vec<T> {
    let n_vertices = n_vertices(tets, triangles);
    let n_parts = if tets.len() < MIN_TETS { 1 } else { threads.count() };
    let part = |range: Range<usize>| {
        let mut gathered = T::default();
        for_each_of_part(tets, triangles, &range, |sharing| see(&mut gathered, sharing));
        gathered
    };
    threads.each(parts_of_vertices(tets, n_vertices, n_parts), part)
}

/// Fewer tets are not divided among threads.
const MIN_TETS: usize = 1 << 13;
/// One tet in so many tells how many facets each range of vertices has.
const SAMPLE: usize = 64;

/// Divides the vertices into ranges with about as many facets each.
fn parts_of_vertices(tets: &[[VertexId; 4]], n_vertices: usize, n_parts: usize) -> Vec<Range<usize>> {
    let lowest = |tet: &[VertexId; 4]| tet.iter().min().map_or(0, |v| v.index());
    let mut sample: Vec<usize> = match n_parts {
        1 => Vec::new(),
        _ => tets.iter().step_by(SAMPLE).map(lowest).collect(),
    };
    sample.sort_unstable();
    let end = |part: usize| sample.get(part * sample.len() / n_parts).map_or(n_vertices, |&v| v);
    (0..n_parts).map(|i| if i == 0 { 0 } else { end(i) }..end(i + 1)).collect()
}

fn n_vertices(tets: &[[VertexId; 4]], triangles: &[[VertexId; 3]]) -> usize {
    let all_ids = tets.as_flattened().iter().chain(triangles.as_flattened());
    all_ids.map(|v| v.index() + 1).max().unwrap_or(0)
}

/// Calls `see` once for every distinct facet whose lowest vertex is in a range.
fn for_each_of_part(
    tets: &[[VertexId; 4]],
    triangles: &[[VertexId; 3]],
    range: &Range<usize>,
    mut see: impl FnMut(Sharing),
) {
    assert!(tets.len() + triangles.len() < 1 << 29, "too many tets to number their facets");
    let buckets = Buckets::fill(tets, triangles, range);
    let n_tets = tets.len() as u32;
    let (mut of_tets, mut of_triangles) = (Vec::new(), Vec::new());
    buckets.for_each_run(|run| {
        of_tets.clear();
        of_triangles.clear();
        for &id in run {
            match id >> 2 {
                tet if tet < n_tets => of_tets.push((TetId(tet), (id & 3) as usize)),
                triangle => of_triangles.push(triangle - n_tets),
            }
        }
        see(Sharing { tets: &of_tets, triangles: &of_triangles });
    });
}

/// The neighbour of each tet across each of its facets: `[t][i]` for the facet opposite vertex `i` of tet
/// `t`; none on the boundary, and where more than two tets share the facet, so that the neighbour is
/// ambiguous.
pub fn tet_neighbors(tets: &[[VertexId; 4]]) -> Vec<[MaybeId<TetId>; 4]> {
    let mut neighbors = vec![[MaybeId::NONE; 4]; tets.len()];
    for_each_tet_facet(tets, &[], |sharing| {
        if let &[(x, i), (y, j)] = sharing.tets {
            neighbors[x.index()][i] = y.into();
            neighbors[y.index()][j] = x.into();
        }
    });
    neighbors
}

/// Buckets with more facets than this are sorted.
const LARGEST_UNSORTED: usize = 96;

/// Facets grouped by their lowest vertex: keys that pack the other two, and the tet (with the index of the
/// facet) or triangle of each.
struct Buckets {
    offsets: Vec<u32>,
    keys: Vec<u64>,
    ids: Vec<u32>,
}

impl Buckets {
    /// The facets whose lowest vertex is in a range.
    fn fill(tets: &[[VertexId; 4]], triangles: &[[VertexId; 3]], range: &Range<usize>) -> Self {
        let start = range.start as u32;
        let mut offsets = vec![0u32; range.len() + 1];
        for_each_keyed_facet(tets, triangles, range, |first, _, _| {
            offsets[(first - start) as usize + 1] += 1
        });
        for i in 0..range.len() {
            offsets[i + 1] += offsets[i];
        }
        let n = offsets[range.len()] as usize;
        let mut next = offsets.clone();
        let (mut keys, mut ids) = (vec![0u64; n], vec![0u32; n]);
        for_each_keyed_facet(tets, triangles, range, |first, key, id| {
            let place = &mut next[(first - start) as usize];
            keys[*place as usize] = key;
            ids[*place as usize] = id;
            *place += 1;
        });
        Self { offsets, keys, ids }
    }

    fn for_each_run(&self, mut see: impl FnMut(&[u32])) {
        let mut pairing = Pairing::default();
        let mut sorted = Vec::new();
        let mut run = Vec::new();
        for bucket in self.offsets.windows(2) {
            let bucket = bucket[0] as usize..bucket[1] as usize;
            let (keys, ids) = (&self.keys[bucket.clone()], &self.ids[bucket]);
            if keys.len() <= LARGEST_UNSORTED {
                pairing.find(keys);
                pairing.for_each_run(ids, &mut run, &mut see);
                continue;
            }
            sorted.clear();
            sorted.extend(keys.iter().copied().zip(ids.iter().copied()));
            sorted.sort_unstable();
            for same in sorted.chunk_by(|x, y| x.0 == y.0) {
                run.clear();
                run.extend(same.iter().map(|entry| entry.1));
                see(&run);
            }
        }
    }
}

const N_SLOTS: usize = 256;
const NOTHING: u8 = u8::MAX;

/// Groups the equal facets of a bucket, by their indices in it.
struct Pairing {
    /// A hash table: the last facet seen of each key.
    slots: [u8; N_SLOTS],
    /// The first facet of each key.
    firsts: [u8; LARGEST_UNSORTED],
    n_firsts: usize,
    /// For each facet, the next one with the same key. The extra entry takes the writes for facets that have
    /// no predecessor.
    next: [u8; LARGEST_UNSORTED + 1],
}

impl Default for Pairing {
    fn default() -> Self {
        Self {
            slots: [NOTHING; N_SLOTS],
            firsts: [NOTHING; LARGEST_UNSORTED],
            n_firsts: 0,
            next: [NOTHING; LARGEST_UNSORTED + 1],
        }
    }
}

impl Pairing {
    /// Links equal facets. Whether a facet is the first of its key is unpredictable, so that case is handled
    /// without a branch.
    #[inline(always)]
    fn find(&mut self, keys: &[u64]) {
        self.slots.fill(NOTHING);
        self.n_firsts = 0;
        for (i, &key) in keys.iter().enumerate() {
            let mut slot = hash(key);
            let mut last = self.slots[slot];
            while last != NOTHING && keys[usize::from(last)] != key {
                slot = (slot + 1) % N_SLOTS;
                last = self.slots[slot];
            }
            self.slots[slot] = i as u8;
            self.next[i] = NOTHING;
            self.next[usize::from(last).min(LARGEST_UNSORTED)] = i as u8;
            self.firsts[self.n_firsts] = i as u8;
            self.n_firsts += usize::from(last == NOTHING);
        }
    }

    #[inline(always)]
    fn for_each_run(&self, ids: &[u32], run: &mut Vec<u32>, see: &mut impl FnMut(&[u32])) {
        for &first in &self.firsts[..self.n_firsts] {
            run.clear();
            let mut place = first;
            while place != NOTHING {
                run.push(ids[usize::from(place)]);
                place = self.next[usize::from(place)];
            }
            see(run);
        }
    }
}

/// Multiplication by 2^64 over the golden ratio (Knuth 1998, volume 3, 6.4).
#[inline(always)]
fn hash(key: u64) -> usize {
    (key.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 56) as usize
}

/// Calls `see` with the lowest vertex, the key and the id of each facet whose lowest vertex is in a range,
/// leaving out those that name a vertex twice.
#[inline(always)]
fn for_each_keyed_facet(
    tets: &[[VertexId; 4]],
    triangles: &[[VertexId; 3]],
    range: &Range<usize>,
    mut see: impl FnMut(u32, u64, u32),
) {
    let (start, end) = (range.start as u32, range.end as u32);
    let is_within = |v: u32| start <= v && v < end;
    for (t, tet) in (0u32..).zip(tets) {
        let [a, b, c, d] = sorted(*tet);
        let vertices = [a, b, c, d].map(|packed| (packed >> 2) as u32);
        let id = |left_out: u64| t << 2 | (left_out & 3) as u32;
        let [va, vb, vc, vd] = vertices;
        if va < vb && vb < vc && vc < vd {
            if is_within(va) {
                see(va, pack(vb, vc), id(d));
                see(va, pack(vb, vd), id(c));
                see(va, pack(vc, vd), id(b));
            }
            if is_within(vb) {
                see(vb, pack(vc, vd), id(a));
            }
            continue;
        }
        for ([x, y, z], left_out) in
            [([va, vb, vc], d), ([va, vb, vd], c), ([va, vc, vd], b), ([vb, vc, vd], a)]
        {
            if x < y && y < z && is_within(x) {
                see(x, pack(y, z), id(left_out));
            }
        }
    }
    for (t, triangle) in (tets.len() as u32..).zip(triangles) {
        let mut corners = triangle.map(|v| v.0);
        corners.sort_unstable();
        let [x, y, z] = corners;
        if x < y && y < z && is_within(x) {
            see(x, pack(y, z), t << 2);
        }
    }
}

fn pack(middle: u32, last: u32) -> u64 {
    u64::from(middle) << 32 | u64::from(last)
}

/// The vertices in rising order, each with its local index in the lowest two bits, by five branch-free
/// compare-exchanges.
#[inline(always)]
fn sorted(tet: [VertexId; 4]) -> [u64; 4] {
    let packed = |place: usize| u64::from(tet[place].0) << 2 | place as u64;
    let [a, b, c, d] = [packed(0), packed(1), packed(2), packed(3)];
    let (a, b) = (a.min(b), a.max(b));
    let (c, d) = (c.min(d), c.max(d));
    let (a, c) = (a.min(c), a.max(c));
    let (b, d) = (b.min(d), b.max(d));
    [a, b.min(c), b.max(c), d]
}
