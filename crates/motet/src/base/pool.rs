//! A pool of threads: those of `rayon` with the feature `parallel`, none without.

#[cfg(feature = "parallel")]
pub(super) use parallel::Pool;
#[cfg(not(feature = "parallel"))]
pub(super) use serial::Pool;

#[cfg(feature = "parallel")]
mod parallel {
    use std::ops::Range;
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicU64, Ordering};

    use rayon::prelude::*;

    use crate::base::{Simulation, splitmix64};

    /// Simulated threads take this many parts each of what threads divide as they go.
    const SIMULATED_PARTS: usize = 8;

    /// Two threads or more. Its methods run on these, and return when all work is done.
    #[derive(Debug)]
    pub(in crate::base) struct Pool {
        workers: Workers,
        disorder: Option<Disorder>,
    }

    #[derive(Debug)]
    enum Workers {
        Threads(rayon::ThreadPool),
        Simulated(Simulation),
    }
    use Workers::{Simulated, Threads};

    /// An order of tasks that differs from call to call.
    #[derive(Debug)]
    struct Disorder(AtomicU64);

    impl Disorder {
        /// Tasks in another order, each with its number.
        fn shuffled<T>(&self, tasks: Vec<T>) -> Vec<(usize, T)> {
            let call = self.0.fetch_add(1, Ordering::Relaxed);
            let mut tasks: Vec<(usize, T)> = tasks.into_iter().enumerate().collect();
            tasks.sort_by_key(|(number, _)| splitmix64(call ^ splitmix64(*number as u64)));
            tasks
        }
    }

    impl Pool {
        /// Starts `n` threads; `None` if a pool has no use.
        ///
        /// # Errors
        /// The cause, if the operating system does not start them.
        pub(in crate::base) fn new(n: usize) -> Result<Option<Self>, String> {
            if n < 2 {
                return Ok(None);
            }
            let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
            pool.map(|threads| Some(Self { workers: Threads(threads), disorder: None }))
                .map_err(|e| e.to_string())
        }

        /// Threads of a simulation; `None` if a pool has no use.
        pub(in crate::base) fn simulated(simulation: &Simulation) -> Option<Self> {
            (simulation.count() > 1).then(|| Self { workers: Simulated(simulation.clone()), disorder: None })
        }

        /// A pool that begins the tasks of a call in an order chosen by `seed`, another one in each call.
        /// Items that one function is applied to are not tasks.
        pub(in crate::base) fn shuffled(self, seed: u64) -> Self {
            Self { disorder: Some(Disorder(AtomicU64::new(splitmix64(seed)))), ..self }
        }

        pub(in crate::base) fn count(&self) -> usize {
            match &self.workers {
                Threads(threads) => threads.current_num_threads(),
                Simulated(simulation) => simulation.count(),
            }
        }

        /// `of(i)` for each `i` below `n`, in order; a thread takes at least `min_part` at a time.
        pub(in crate::base) fn map<T: Send>(
            &self,
            n: usize,
            min_part: usize,
            of: impl Fn(usize) -> T + Sync + Send,
        ) -> Vec<T> {
            let mut list = Vec::new();
            self.append(&mut list, n, min_part, of);
            list
        }

        /// Appends `of(i)` for each `i` below `n`, in order; a thread takes at least `min_part` at a time.
        pub(in crate::base) fn append<T: Send>(
            &self,
            list: &mut Vec<T>,
            n: usize,
            min_part: usize,
            of: impl Fn(usize) -> T + Sync + Send,
        ) {
            match &self.workers {
                Threads(threads) => {
                    let items = (0..n).into_par_iter().with_min_len(min_part).map(of);
                    threads.install(|| list.par_extend(items));
                }
                Simulated(simulation) => {
                    list.reserve(n);
                    let (length, mut tasks) = (self.simulated_part(n, min_part), simulation.call());
                    for start in (0..n).step_by(length) {
                        tasks.take(|| list.extend((start..n.min(start + length)).map(&of)));
                    }
                }
            }
        }

        fn simulated_part(&self, n: usize, min_part: usize) -> usize {
            n.div_ceil(SIMULATED_PARTS * self.count()).max(min_part).max(1)
        }

        /// Applies `of` to each item, with its place; a thread takes at least `min_part` at a time.
        pub(in crate::base) fn update<T: Send>(
            &self,
            list: &mut [T],
            min_part: usize,
            of: impl Fn(usize, &mut T) + Sync + Send,
        ) {
            match &self.workers {
                Threads(threads) => {
                    let items = list.par_iter_mut().with_min_len(min_part).enumerate();
                    threads.install(|| items.for_each(|(i, item)| of(i, item)));
                }
                Simulated(simulation) => {
                    let (length, mut tasks) = (self.simulated_part(list.len(), min_part), simulation.call());
                    for (k, part) in list.chunks_mut(length).enumerate() {
                        tasks.take(|| part.iter_mut().zip(k * length..).for_each(|(item, i)| of(i, item)));
                    }
                }
            }
        }

        /// The results for each of some ranges, in order, with a state that ranges of one thread share.
        pub(in crate::base) fn in_ranges<S: Default, T: Send>(
            &self,
            ranges: Vec<Range<usize>>,
            of: impl Fn(&mut S, Range<usize>) -> T + Sync + Send,
        ) -> Vec<T> {
            match &self.workers {
                _ if self.disorder.is_some() => self.each(ranges, |range| of(&mut S::default(), range)),
                Threads(threads) => {
                    threads.install(|| ranges.into_par_iter().map_init(S::default, of).collect())
                }
                Simulated(simulation) => {
                    let (mut state, mut tasks) = (S::default(), simulation.call());
                    ranges.into_iter().map(|range| tasks.take(|| of(&mut state, range))).collect()
                }
            }
        }

        pub(in crate::base) fn each<T: Send, U: Send>(
            &self,
            items: Vec<T>,
            of: impl Fn(T) -> U + Sync + Send,
        ) -> Vec<U> {
            let Some(disorder) = &self.disorder else {
                return self.in_order(items, of);
            };
            let tasks = disorder.shuffled(items);
            let mut results = self.in_order(tasks, |(number, item)| (number, of(item)));
            results.sort_by_key(|(number, _)| *number);
            results.into_iter().map(|(_, result)| result).collect()
        }

        fn in_order<T: Send, U: Send>(&self, items: Vec<T>, of: impl Fn(T) -> U + Sync + Send) -> Vec<U> {
            match &self.workers {
                Threads(threads) => threads.install(|| items.into_par_iter().map(of).collect()),
                Simulated(simulation) => {
                    let mut tasks = simulation.call();
                    items.into_iter().map(|item| tasks.take(|| of(item))).collect()
                }
            }
        }

        pub(in crate::base) fn any<T: Send>(
            &self,
            items: Vec<T>,
            is_such: impl Fn(T) -> bool + Sync + Send,
        ) -> bool {
            match &self.workers {
                Threads(threads) => threads.install(|| items.into_par_iter().any(is_such)),
                Simulated(simulation) => {
                    let mut tasks = simulation.call();
                    items.into_iter().any(|item| tasks.take(|| is_such(item)))
                }
            }
        }

        pub(in crate::base) fn join<A: Send, B: Send>(
            &self,
            first: impl FnOnce() -> A + Send,
            second: impl FnOnce() -> B + Send,
        ) -> (A, B) {
            match &self.workers {
                Threads(threads) => threads.join(first, second),
                Simulated(simulation) => {
                    let mut tasks = simulation.call();
                    (tasks.take(first), tasks.take(second))
                }
            }
        }

        /// Applies `of` to parts of up to `length` items of a list, with the place of the first and the state
        /// of its thread. The calling thread and all but one of the pool take part after part.
        pub(in crate::base) fn in_parts<S, T: Send>(
            &self,
            list: &mut [T],
            length: usize,
            state: impl Fn() -> S + Sync,
            of: impl Fn(&S, usize, &mut [T]) + Sync,
        ) {
            let parts = list.chunks_mut(length);
            let parts: Box<dyn Iterator<Item = (usize, &mut [T])> + Send> = match &self.disorder {
                None => Box::new(parts.enumerate()),
                Some(disorder) => Box::new(disorder.shuffled(parts.collect()).into_iter()),
            };
            match &self.workers {
                Threads(threads) => {
                    let parts = Mutex::new(parts);
                    let next = || parts.lock().ok()?.next();
                    let work = &|| {
                        let state = state();
                        while let Some((k, part)) = next() {
                            of(&state, k * length, part);
                        }
                    };
                    threads.in_place_scope(|scope| {
                        (1..self.count()).for_each(|_| scope.spawn(|_| work()));
                        work();
                    });
                }
                Simulated(simulation) => {
                    let (state, mut tasks) = (state(), simulation.call());
                    parts.for_each(|(k, part)| tasks.take(|| of(&state, k * length, part)));
                }
            }
        }
    }
}

#[cfg(not(feature = "parallel"))]
mod serial {
    use std::ops::Range;

    /// A pool that cannot be made: everything runs on the calling thread.
    #[derive(Debug)]
    pub(in crate::base) enum Pool {}

    #[allow(clippy::unused_self, reason = "there is no such value")]
    impl Pool {
        pub(in crate::base) fn new(_: usize) -> Result<Option<Self>, String> {
            Ok(None)
        }

        pub(in crate::base) fn simulated(_: &crate::base::Simulation) -> Option<Self> {
            None
        }

        pub(in crate::base) fn shuffled(self, _: u64) -> Self {
            match self {}
        }

        pub(in crate::base) fn count(&self) -> usize {
            match *self {}
        }

        pub(in crate::base) fn map<T>(&self, _: usize, _: usize, _: impl Fn(usize) -> T) -> Vec<T> {
            match *self {}
        }

        pub(in crate::base) fn append<T>(&self, _: &mut Vec<T>, _: usize, _: usize, _: impl Fn(usize) -> T) {
            match *self {}
        }

        pub(in crate::base) fn update<T>(&self, _: &mut [T], _: usize, _: impl Fn(usize, &mut T)) {
            match *self {}
        }

        pub(in crate::base) fn in_ranges<S, T>(
            &self,
            _: Vec<Range<usize>>,
            _: impl Fn(&mut S, Range<usize>) -> T,
        ) -> Vec<T> {
            match *self {}
        }

        pub(in crate::base) fn each<T, U>(&self, _: Vec<T>, _: impl Fn(T) -> U) -> Vec<U> {
            match *self {}
        }

        pub(in crate::base) fn any<T>(&self, _: Vec<T>, _: impl Fn(T) -> bool) -> bool {
            match *self {}
        }

        pub(in crate::base) fn join<A, B>(&self, _: impl FnOnce() -> A, _: impl FnOnce() -> B) -> (A, B) {
            match *self {}
        }

        pub(in crate::base) fn in_parts<S, T>(
            &self,
            _: &mut [T],
            _: usize,
            _: impl Fn() -> S,
            _: impl Fn(&S, usize, &mut [T]),
        ) {
            match *self {}
        }
    }
}
