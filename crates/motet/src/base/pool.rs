//! A pool of threads: those of `rayon` with the feature `parallel`, none without.
//!
//! All ways to divide work come to one, numbered tasks ([`Pool::run`]), by references to functions: so little
//! is compiled for each call of [`Threads`](crate::base::Threads).

#[cfg(feature = "parallel")]
pub(super) use parallel::Pool;
#[cfg(not(feature = "parallel"))]
pub(super) use serial::Pool;

#[cfg(feature = "parallel")]
mod parallel {
    use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
    use std::sync::{Mutex, PoisonError};

    use crate::base::{Simulation, splitmix64};

    /// What is divided evenly is divided into this many parts a thread, so that none waits long for the last.
    const PARTS: usize = 8;

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
        /// The numbers below `n` in another order.
        fn shuffled(&self, n: usize) -> Vec<usize> {
            let call = self.0.fetch_add(1, Ordering::Relaxed);
            let mut numbers: Vec<usize> = (0..n).collect();
            numbers.sort_by_key(|&number| splitmix64(call ^ splitmix64(number as u64)));
            numbers
        }
    }

    /// A thing that one task takes, or puts there.
    struct Slot<T>(Mutex<Option<T>>);

    impl<T> Slot<T> {
        fn of(thing: T) -> Self {
            Self(Mutex::new(Some(thing)))
        }

        fn empty() -> Self {
            Self(Mutex::new(None))
        }

        fn take(&self) -> Option<T> {
            self.0.lock().unwrap_or_else(PoisonError::into_inner).take()
        }

        fn put(&self, thing: T) {
            *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(thing);
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
        pub(in crate::base) fn shuffled(self, seed: u64) -> Self {
            Self { disorder: Some(Disorder(AtomicU64::new(splitmix64(seed)))), ..self }
        }

        pub(in crate::base) fn count(&self) -> usize {
            match &self.workers {
                Threads(threads) => threads.current_num_threads(),
                Simulated(simulation) => simulation.count(),
            }
        }

        /// The length of parts of `n` items, at least `min_part`.
        pub(in crate::base) fn part(&self, n: usize, min_part: usize) -> usize {
            n.div_ceil(PARTS * self.count()).max(min_part).max(1)
        }

        /// Does all tasks below `n`, each once. The calling thread and all but one of the pool each take the
        /// next number that is left: tasks need not take equally long, and the caller begins while the
        /// others, which sleep between calls, wake up.
        fn run(&self, n: usize, task: &(dyn Fn(usize) + Sync)) {
            let order = self.disorder.as_ref().map(|disorder| disorder.shuffled(n));
            let number = |k: usize| order.as_ref().map_or(k, |order| order[k]);
            match &self.workers {
                Threads(threads) => {
                    let next = AtomicUsize::new(0);
                    let work = &|| {
                        let numbers = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&k| k < n);
                        std::iter::from_fn(numbers).for_each(|k| task(number(k)));
                    };
                    threads.in_place_scope(|scope| {
                        (1..self.count().min(n)).for_each(|_| scope.spawn(|_| work()));
                        work();
                    });
                }
                Simulated(simulation) => {
                    let mut tasks = simulation.call();
                    (0..n).for_each(|k| tasks.take(|| task(number(k))));
                }
            }
        }

        /// Applies `of` to each item; the results are in order.
        pub(in crate::base) fn each<T: Send, U: Send>(
            &self,
            items: Vec<T>,
            of: &(dyn Fn(T) -> U + Sync),
        ) -> Vec<U> {
            let items: Vec<Slot<T>> = items.into_iter().map(Slot::of).collect();
            let results: Vec<Slot<U>> = items.iter().map(|_| Slot::empty()).collect();
            self.run(items.len(), &|k| {
                if let Some(item) = items[k].take() {
                    results[k].put(of(item));
                }
            });
            results.iter().filter_map(Slot::take).collect()
        }

        /// Whether `is_such` is true of any of these things; those left when one is found are not looked at.
        pub(in crate::base) fn any<T: Send>(
            &self,
            items: Vec<T>,
            is_such: &(dyn Fn(T) -> bool + Sync),
        ) -> bool {
            let items: Vec<Slot<T>> = items.into_iter().map(Slot::of).collect();
            let is_found = AtomicBool::new(false);
            self.run(items.len(), &|k| {
                if !is_found.load(Ordering::Relaxed) && items[k].take().is_some_and(is_such) {
                    is_found.store(true, Ordering::Relaxed);
                }
            });
            is_found.into_inner()
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

        /// Applies `of` to all parts of up to `length` items of a list, each once, with the place of its
        /// first item.
        pub(in crate::base) fn in_parts<T: Send>(
            &self,
            list: &mut [T],
            length: usize,
            of: &(dyn Fn(usize, &mut [T]) + Sync),
        ) {
            let parts: Vec<Slot<&mut [T]>> = list.chunks_mut(length).map(Slot::of).collect();
            self.run(parts.len(), &|k| {
                if let Some(part) = parts[k].take() {
                    of(k * length, part);
                }
            });
            assert!(parts.iter().all(|part| part.take().is_none()), "all parts are done");
        }
    }
}

#[cfg(not(feature = "parallel"))]
mod serial {
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

        pub(in crate::base) fn part(&self, _: usize, _: usize) -> usize {
            match *self {}
        }

        pub(in crate::base) fn each<T, U>(&self, _: Vec<T>, _: &(dyn Fn(T) -> U + Sync)) -> Vec<U> {
            match *self {}
        }

        pub(in crate::base) fn any<T>(&self, _: Vec<T>, _: &(dyn Fn(T) -> bool + Sync)) -> bool {
            match *self {}
        }

        pub(in crate::base) fn join<A, B>(&self, _: impl FnOnce() -> A, _: impl FnOnce() -> B) -> (A, B) {
            match *self {}
        }

        pub(in crate::base) fn in_parts<T>(
            &self,
            _: &mut [T],
            _: usize,
            _: &(dyn Fn(usize, &mut [T]) + Sync),
        ) {
            match *self {}
        }
    }
}
