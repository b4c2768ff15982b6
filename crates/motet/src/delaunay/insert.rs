//! The insertion loop: find a tet in conflict, dig the cavity, fill it (Bowyer 1981; Watson 1981).
//!
//! Several threads insert points of different parts of space at the same time (as in Marot, Pellerin and
//! Remacle 2019, *One machine, one minute, three billion tetrahedra*). A tet of which three vertices belong
//! to one part may be changed by the thread of that part alone; the others are frozen. A tet of one part
//! never has a neighbour that belongs to another, so a thread that stops at frozen tets meets nothing that
//! others change. Points whose cavity reaches a frozen tet are left for later, when space is divided
//! elsewhere. There are as many parts as threads: the tets are those of the Delaunay triangulation in any
//! case, and how they are numbered does not depend on parts (`numbering`).
//!
//! The whole loop is compiled twice, for any machine and for one with AVX2 and FMA, and dispatched once per
//! thousands of points: everything it calls is inlined or dispatched with it. The signs are exact either way,
//! so the results agree.

use std::sync::atomic::{AtomicUsize, Ordering};

use super::cavity::Cavity;
use super::conflict::Newcomer;
use super::fill::Fill;
use super::gauge::LEAST;
use super::input::sides;
use super::parts::{Frozen, Part, Parts};
use super::start::first_tet;
use super::store::{MAX_TETS, Slots, Store, Tets, is_ghost};
use super::walk::walk;
use crate::base::{Point, Result, Threads, Watch};
use crate::geometry::predicates::pair::U;
use crate::geometry::vector::distance_squared;
use pulp::{Arch, Simd, WithSimd};

/// The watch is consulted each time this many points have been inserted.
const RUN: usize = 8192;

/// After this many points in a row that were left, the next walk starts at the hint that is nearest: frozen
/// tets can enclose the tet where the last ones started.
const PATIENCE: usize = 8;

/// Into how many parts space is divided.
#[derive(Clone, Copy)]
pub(super) struct Division {
    /// The least number of points of a set for which space is divided at all.
    pub(super) least: usize,
    /// The least number of points of a part. The smaller parts are, the more of their points lie near others,
    /// and are left.
    pub(super) least_of_part: usize,
}

impl Division {
    /// The largest number of parts: each has a table as long as all vertices, of which it touches the places
    /// of its own.
    const MOST: usize = 64;

    pub(super) const USUAL: Self = Self { least: 100_000, least_of_part: 8_000 };

    /// Whether a set of `n` points may be inserted in parts, on any number of threads.
    pub(super) fn applies(self, n: usize) -> bool {
        n >= self.least
    }

    /// The number of parts for the insertion of `n` points of a set for which space is divided.
    fn n_parts(self, n: usize, threads: &Threads) -> usize {
        (n / self.least_of_part).min(threads.count()).clamp(1, Self::MOST)
    }
}

/// The slots for each point that threads insert at the same time: a million uniform points give 6.77 tets per
/// point, and 1.01 ghosts per hull facet.
const SLOTS_PER_POINT: usize = 7;

/// Triangulates distinct points, of which the first four span a tet. Point 0 is not used: vertex 0 is the one
/// at infinity. `rounds` are the first vertices of the rounds after the first one; `filtered` states whether
/// floating-point filters may be trusted.
///
/// # Errors
/// When a stop was requested, and when there are more than [`MAX_TETS`] tets.
pub(super) fn triangulate(
    points: &[Point],
    rounds: &[u32],
    filtered: bool,
    division: Division,
    threads: &Threads,
) -> Result<Store> {
    let least = if filtered { LEAST } else { f32::INFINITY };
    let mut store = Store::with_slots((SLOTS_PER_POINT * points.len() + 64).min(MAX_TETS));
    store.slots.claim(&mut [0; 5]);
    first_tet(alone(&mut store), points, least);
    let mut builder = Builder {
        points,
        sure: if filtered { static_bound(points) } else { f64::INFINITY },
        least,
        store,
        scratches: Vec::new(),
        n_attempts: 0,
        hint: 0,
        n_done: AtomicUsize::new(0),
        division: Some(division).filter(|division| division.applies(points.len())),
        threads,
    };
    let n = points.len() as u32;
    let mut from = n.min(5);
    for until in rounds.iter().copied().chain([n]) {
        if until > from {
            builder.insert((from..until).collect())?;
            from = until;
        }
    }
    Ok(builder.store)
}

/// A view of the tets for one thread.
#[allow(unsafe_code, reason = "see `Shared`")]
fn alone(store: &mut Store) -> Tets<'_> {
    // SAFETY: all callers use it on the calling thread only.
    unsafe { store.tets() }
}

/// Bounds the error of any 3x3 determinant of differences within the box: 8 u times six products, doubled.
fn static_bound(points: &[Point]) -> f64 {
    let [x, y, z] = sides(&points[1..]);
    16.0 * U * 6.0 * (x * y * z) + f64::MIN_POSITIVE
}

/// The triangulation of the points inserted so far.
struct Builder<'a> {
    points: &'a [Point],
    sure: f64,
    least: f32,
    store: Store,
    /// One for each part.
    scratches: Vec<Scratch>,
    n_attempts: u32,
    /// The tet where the next walk starts.
    hint: u32,
    n_done: AtomicUsize,
    /// `None` once most points of a round were left: tets may reach from each part to all others.
    division: Option<Division>,
    threads: &'a Threads,
}

impl Builder<'_> {
    /// Inserts the vertices of a round.
    fn insert(&mut self, mut todo: Vec<u32>) -> Result<()> {
        while let Some(division) = self.division {
            let (n, n_parts) = (todo.len(), division.n_parts(todo.len(), self.threads));
            if n_parts == 1 {
                break;
            }
            todo = self.insert_in_parts(&todo, n_parts)?;
            self.division = Some(division).filter(|_| todo.len() < n / 2);
        }
        loop {
            todo = self.insert_one_by_one(&todo)?;
            if todo.is_empty() {
                return Ok(());
            }
            self.store.reserve(self.store.slots.len() + 1)?;
        }
    }

    /// Inserts vertices on the calling thread; returns those for which there are too few slots.
    fn insert_one_by_one(&mut self, vertices: &[u32]) -> Result<Vec<u32>> {
        self.provide_scratches(1);
        let mut worker = Worker {
            points: self.points,
            sure: self.sure,
            slots: std::mem::take(&mut self.store.slots),
            tets: alone(&mut self.store),
            scratch: &mut self.scratches[0],
            n_attempts: self.n_attempts,
            part: Part::ALL,
            hint: Some(self.hint),
            hints: &[],
        };
        let left = worker.insert(vertices, &self.n_done, self.threads.watch())?;
        let Worker { slots, n_attempts, hint, .. } = worker;
        self.n_attempts = n_attempts;
        self.hint = hint.unwrap_or(self.hint);
        self.store.slots = slots;
        Ok(left)
    }

    /// Inserts vertices in parts of space, at the same time; returns those left. Each part has slots of its
    /// own, so that the result does not depend on threads.
    #[allow(unsafe_code, reason = "see `Shared`")]
    fn insert_in_parts(&mut self, vertices: &[u32], n_parts: usize) -> Result<Vec<u32>> {
        let (points, threads) = (self.points, self.threads);
        // Where there are not as many slots, more vertices are left.
        _ = self.store.reserve((SLOTS_PER_POINT - 1) * vertices.len());
        self.provide_scratches(n_parts);
        let parts = Parts::new(points, vertices, n_parts, threads);
        let n_used = self.store.n_used();
        let mut slots = std::mem::take(&mut self.store.slots);
        let own: Vec<Vec<u32>> = threads.each((0..n_parts).collect(), |part| parts.own(vertices, part));
        let requested: Vec<usize> = own.iter().map(|own| SLOTS_PER_POINT * own.len()).collect();
        let part_slots = slots.split_off(&requested);
        // SAFETY: freezing changes each tet in the run of slots that has it, and reads no other; afterwards
        // the tets of a part, all of whose neighbours belong to the same part or are frozen, are changed by
        // its thread alone; and nothing changes or marks a frozen tet.
        let tets = unsafe { self.store.tets() };
        let frozen = Frozen::new(tets, n_used, &parts, threads);
        let all = part_slots.into_iter().zip(&mut self.scratches).zip(&frozen.hints).enumerate();
        let workers = all.map(|(part, ((slots, scratch), hints))| Worker {
            points,
            sure: self.sure,
            tets,
            slots,
            scratch,
            n_attempts: self.n_attempts,
            part: parts.get(part),
            hint: hints.first().copied(),
            hints,
        });
        let insert = |(part, mut worker): (usize, Worker)| -> Result<_> {
            let left = worker.insert(&own[part], &self.n_done, threads.watch())?;
            Ok((left, worker.slots, worker.n_attempts, worker.hint))
        };
        let done = threads.each(workers.enumerate().collect(), insert);
        frozen.release(tets);
        let mut left = Vec::new();
        for part in done.into_iter().rev() {
            let (own, own_slots, n_attempts, hint) = part?;
            left.extend(own);
            slots.put_back(own_slots);
            self.n_attempts = self.n_attempts.max(n_attempts);
            self.hint = hint.unwrap_or(self.hint);
        }
        self.store.slots = slots;
        left.sort_unstable();
        Ok(left)
    }

    fn provide_scratches(&mut self, n: usize) {
        while self.scratches.len() < n {
            self.scratches.push(Scratch::new(self.points.len(), self.least));
        }
    }
}

/// Buffers of a part, reused from one insertion to the next.
struct Scratch {
    cavity: Cavity,
    fill: Fill,
}

impl Scratch {
    fn new(n_points: usize, least: f32) -> Self {
        Self { cavity: Cavity::default(), fill: Fill::new(n_points, least) }
    }
}

/// What one thread works with.
struct Worker<'a> {
    points: &'a [Point],
    sure: f64,
    tets: Tets<'a>,
    slots: Slots,
    scratch: &'a mut Scratch,
    n_attempts: u32,
    part: Part<'a>,
    /// The tet where the next walk starts; `None` where no tet belongs to the part.
    hint: Option<u32>,
    /// Other tets of the part, or what has become of their slots.
    hints: &'a [u32],
}

impl Worker<'_> {
    /// Inserts vertices in order; returns those left: whose cavity reaches a frozen tet, and those from the
    /// one on for which there are too few slots.
    fn insert(&mut self, vertices: &[u32], n_done: &AtomicUsize, watch: &Watch) -> Result<Vec<u32>> {
        let Some(mut hint) = self.hint else { return Ok(vertices.to_vec()) };
        let (mut left, arch) = (Vec::new(), Arch::new());
        for (k, run) in vertices.chunks(RUN).enumerate() {
            let done = n_done.fetch_add(run.len(), Ordering::Relaxed);
            watch.report_and_check("triangulating points", done, self.points.len())?;
            let n_left = left.len();
            let n = arch.dispatch(Run { worker: self, vertices: run, left: &mut left, hint: &mut hint });
            let n_tried = k * RUN + n;
            // Where nearly all are left, trying the others would be in vain. The first ones can lie near a
            // corner of the part, where many are left.
            let is_last = n < run.len() || left.len() > n_tried / 8 * 7;
            if is_last {
                left.extend(&vertices[n_tried..]);
            }
            n_done.fetch_sub(run.len().min(left.len() - n_left), Ordering::Relaxed);
            if is_last {
                break;
            }
        }
        self.hint = Some(hint);
        Ok(left)
    }
}

/// A run of vertices to insert.
struct Run<'a, 'b> {
    worker: &'a mut Worker<'b>,
    vertices: &'a [u32],
    left: &'a mut Vec<u32>,
    hint: &'a mut u32,
}

impl WithSimd for Run<'_, '_> {
    type Output = usize;

    /// Returns the number of vertices that were inserted or left, all unless there are too few slots.
    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> usize {
        let Worker {
            points,
            sure,
            tets,
            part,
            hints,
            ref mut slots,
            ref mut scratch,
            ref mut n_attempts,
            ..
        } = *self.worker;
        let Scratch { cavity, fill } = scratch;
        let mut hint = *self.hint;
        let (mut n, mut n_failed) = (0, 0);
        for &vertex in self.vertices {
            *n_attempts += 1;
            let new = Newcomer { vertex, point: points[vertex as usize], attempt: *n_attempts };
            let first = walk(simd, tets, points, hint, new, part, sure);
            if first.is_some_and(|first| cavity.dig(simd, tets, points, first, new)) {
                let Some(made) = fill.fill(simd, tets, slots, points, cavity, new) else { break };
                hint = made;
                n_failed = 0;
            } else {
                n_failed += 1;
                if n_failed % PATIENCE == 0 {
                    hint = nearest(tets, points, hints, new.point).unwrap_or(hint);
                }
                assert!(!part.is_all(), "the points are distinct, so each is in conflict with a tet");
                self.left.push(vertex);
            }
            n += 1;
        }
        *self.hint = hint;
        n
    }
}

/// The hint whose tet has the nearest first vertex, if any of them still has a tet that is not a ghost.
#[cold]
fn nearest(tets: Tets, points: &[Point], hints: &[u32], place: Point) -> Option<u32> {
    let with_tet = hints.iter().copied().filter(|&hint| !is_ghost(tets.vertices.get(hint)));
    let away = |hint: &u32| distance_squared(points[tets.vertices.get(*hint)[0] as usize], place);
    with_tet.min_by(|x, y| away(x).total_cmp(&away(y)))
}
