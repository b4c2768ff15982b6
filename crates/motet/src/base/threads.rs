//! How many threads a call may use, always the caller's choice and never a global pool; and the watch on the
//! call.

use std::mem::MaybeUninit;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};

use crate::base::pool::Pool;
use crate::base::{Error, Result, Simulation, Watch};

/// The least number of items per thread: fewer are done sooner than they are distributed.
const MIN_PART: usize = 4096;

/// A pool of threads that belongs to the caller. Results do not depend on its size.
#[derive(Debug, Default)]
pub struct Threads {
    pool: Option<Pool>,
    watch: Watch,
}

impl Threads {
    /// Everything runs on the calling thread.
    pub fn single() -> Self {
        Self::default()
    }

    /// A pool of `n` threads, but no more than the machine has cores; 0 means one per core. Without the
    /// feature `parallel`, everything runs on the calling thread.
    ///
    /// # Errors
    /// When the operating system cannot start them.
    pub fn new(n: usize) -> Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        Self::exactly(if n == 0 { cores } else { n.min(cores) })
    }

    /// A pool of exactly `n` threads, even if the machine has fewer cores: for tests that results do not
    /// depend on the number.
    ///
    /// # Errors
    /// When the operating system cannot start them.
    pub fn exactly(n: usize) -> Result<Self> {
        let pool = Pool::new(n).map_err(|cause| {
            Error::options(format!("{n} threads could not be started: {cause}"))
                .remedy("request fewer threads")
        })?;
        Ok(Self { pool, ..Self::default() })
    }

    /// Threads whose work the calling thread does, part after part, while the clock of a simulation shows
    /// when they would have ended. Without the feature `parallel`, a single thread.
    pub fn simulated(simulation: &Simulation) -> Self {
        Self { pool: Pool::simulated(simulation), ..Self::default() }
    }

    /// Threads that begin the tasks of a call in an order chosen by `seed`, another one in each call: for
    /// tests that no result depends on it. A single thread keeps its order.
    #[must_use]
    pub fn shuffled(self, seed: u64) -> Self {
        Self { pool: self.pool.map(|pool| pool.shuffled(seed)), ..self }
    }

    /// Attaches a watch: work on these threads reports its progress, and stops on request.
    #[must_use]
    pub fn watched(self, watch: &Watch) -> Self {
        Self { watch: watch.clone(), ..self }
    }

    /// The watch on the work of these threads.
    pub fn watch(&self) -> &Watch {
        &self.watch
    }

    /// The number of threads.
    pub fn count(&self) -> usize {
        self.pool.as_ref().map_or(1, Pool::count)
    }

    /// `of(i)` for each `i` below `n`, in order.
    pub fn map<T: Send>(&self, n: usize, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        self.map_parts(n, MIN_PART, of)
    }

    /// `of(i)` for each `i` below `n`, in order; a thread takes at least `min_part` of them at a time.
    pub fn map_parts<T: Send>(
        &self,
        n: usize,
        min_part: usize,
        of: impl Fn(usize) -> T + Sync + Send,
    ) -> Vec<T> {
        let mut list = Vec::new();
        self.append(&mut list, n, min_part, of);
        list
    }

    /// Appends `of(i)` for each `i` below `n` to a list, in order; a thread takes at least `min_part` of them
    /// at a time. New memory is first written by the thread that computes what goes there.
    #[allow(unsafe_code, reason = "a list that grows has no places that several threads can write")]
    pub fn append<T: Send>(
        &self,
        list: &mut Vec<T>,
        n: usize,
        min_part: usize,
        of: impl Fn(usize) -> T + Sync + Send,
    ) {
        let write = |start: usize, part: &mut [MaybeUninit<T>]| {
            part.iter_mut().zip(start..).for_each(|(place, i)| {
                place.write(of(i));
            });
        };
        list.reserve(n);
        self.in_parts(&mut list.spare_capacity_mut()[..n], min_part, &write);
        // SAFETY: there is room for `n` more items. Each of their places was in one of the parts, all of
        // which were written; otherwise a call has panicked.
        unsafe { list.set_len(list.len() + n) };
    }

    /// Applies `of` to each item of a list, with its place; a thread takes at least `min_part` at a time.
    pub fn update<T: Send>(&self, list: &mut [T], min_part: usize, of: impl Fn(usize, &mut T) + Sync + Send) {
        let each = |start: usize, part: &mut [T]| {
            part.iter_mut().zip(start..).for_each(|(item, i)| of(i, item));
        };
        self.in_parts(list, min_part, &each);
    }

    /// Applies `of` to parts of at least `min_part` items that a list is divided into, with the place of the
    /// first item of each.
    fn in_parts<T: Send>(&self, list: &mut [T], min_part: usize, of: &(dyn Fn(usize, &mut [T]) + Sync)) {
        match &self.pool {
            Some(pool) if list.len() > min_part => pool.in_parts(list, pool.part(list.len(), min_part), of),
            _ => of(0, list),
        }
    }

    /// Applies `of` to runs of up to `length` of the numbers below `n` and joins the results in order. One
    /// thread takes all numbers as a single run. `of` also gets a state, which is reused from run to run.
    pub fn in_runs<S: Default + Send, T: Send>(
        &self,
        n: usize,
        length: usize,
        of: impl Fn(&mut S, Range<usize>) -> Vec<T> + Sync + Send,
    ) -> Vec<T> {
        let of: &(dyn Fn(&mut S, Range<usize>) -> Vec<T> + Sync) = &of;
        let Some(pool) = &self.pool else {
            return of(&mut S::default(), 0..n);
        };
        let runs = (0..n).step_by(length).map(|start| start..n.min(start + length)).collect();
        let states = States::default();
        let results = pool.each(runs, &|run| states.with(S::default, |state| of(state, run)));
        let mut all = Vec::with_capacity(results.iter().map(Vec::len).sum());
        results.into_iter().for_each(|some| all.extend(some));
        all
    }

    /// Applies `of` to each of a few expensive things; the results are in order.
    pub fn each<T: Send, U: Send>(&self, things: Vec<T>, of: impl Fn(T) -> U + Sync + Send) -> Vec<U> {
        let of: &(dyn Fn(T) -> U + Sync) = &of;
        match &self.pool {
            None => things.into_iter().map(of).collect(),
            Some(pool) => pool.each(things, of),
        }
    }

    /// Whether `is_such` is true of any of these things; the others need not be looked at.
    pub fn any<T: Send>(&self, things: Vec<T>, is_such: impl Fn(T) -> bool + Sync + Send) -> bool {
        let is_such: &(dyn Fn(T) -> bool + Sync) = &is_such;
        match &self.pool {
            None => things.into_iter().any(is_such),
            Some(pool) => pool.any(things, is_such),
        }
    }

    /// The results of two calls, which may run at the same time.
    pub fn join<A: Send, B: Send>(
        &self,
        first: impl FnOnce() -> A + Send,
        second: impl FnOnce() -> B + Send,
    ) -> (A, B) {
        match &self.pool {
            None => (first(), second()),
            Some(pool) => pool.join(first, second),
        }
    }

    /// Fills `out`: `of` gets parts of up to `length` items, with the index of the first. Each thread makes a
    /// state first, which its parts share.
    pub(crate) fn fill<S: Send, T: Send>(
        &self,
        out: &mut [T],
        length: usize,
        state: impl Fn() -> S + Sync,
        of: impl Fn(&S, usize, &mut [T]) + Sync,
    ) {
        let states = States::default();
        let each: &(dyn Fn(usize, &mut [T]) + Sync) =
            &|start, part| states.with(&state, |state| of(state, start, part));
        match &self.pool {
            Some(pool) if length < out.len() => pool.in_parts(out, length, each),
            _ => each(0, out),
        }
    }
}

/// States that tasks use one after another: as many as tasks ever run at the same time.
struct States<S>(Mutex<Vec<S>>);

impl<S> Default for States<S> {
    fn default() -> Self {
        Self(Mutex::default())
    }
}

impl<S> States<S> {
    fn with<R>(&self, new: impl Fn() -> S, of: impl FnOnce(&mut S) -> R) -> R {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let mut state = kept.unwrap_or_else(new);
        let result = of(&mut state);
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push(state);
        result
    }
}
