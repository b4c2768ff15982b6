//! A pool of threads: those of `rayon` with the feature `parallel`, none without.

#[cfg(feature = "parallel")]
pub(super) use parallel::Pool;
#[cfg(not(feature = "parallel"))]
pub(super) use serial::Pool;

#[cfg(feature = "parallel")]
mod parallel {
    use std::ops::Range;
    use std::sync::atomic::{AtomicU64, Ordering};

    use rayon::prelude::*;

    use crate::base::splitmix64;

    /// Two threads or more. Its methods run on these, and return when all work is done.
    #[derive(Debug)]
    pub(in crate::base) struct Pool {
        threads: rayon::ThreadPool,
        disorder: Option<Disorder>,
    }

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
            pool.map(|threads| Some(Self { threads, disorder: None })).map_err(|e| e.to_string())
        }

        /// A pool that begins the tasks of a call in an order chosen by `seed`, another one in each call.
        /// Items that one function is applied to are not tasks.
        pub(in crate::base) fn shuffled(self, seed: u64) -> Self {
            Self { disorder: Some(Disorder(AtomicU64::new(splitmix64(seed)))), ..self }
        }

        pub(in crate::base) fn count(&self) -> usize {
            self.threads.current_num_threads()
        }

        /// `of(i)` for each `i` below `n`, in order; a thread takes at least `min_part` at a time.
        pub(in crate::base) fn map<T: Send>(
            &self,
            n: usize,
            min_part: usize,
            of: impl Fn(usize) -> T + Sync + Send,
        ) -> Vec<T> {
            self.threads.install(|| (0..n).into_par_iter().with_min_len(min_part).map(of).collect())
        }

        /// Appends `of(i)` for each `i` below `n`, in order; a thread takes at least `min_part` at a time.
        pub(in crate::base) fn append<T: Send>(
            &self,
            list: &mut Vec<T>,
            n: usize,
            min_part: usize,
            of: impl Fn(usize) -> T + Sync + Send,
        ) {
            self.threads.install(|| list.par_extend((0..n).into_par_iter().with_min_len(min_part).map(of)));
        }

        /// Applies `of` to each item, with its place; a thread takes at least `min_part` at a time.
        pub(in crate::base) fn update<T: Send>(
            &self,
            list: &mut [T],
            min_part: usize,
            of: impl Fn(usize, &mut T) + Sync + Send,
        ) {
            let items = list.par_iter_mut().with_min_len(min_part).enumerate();
            self.threads.install(|| items.for_each(|(i, item)| of(i, item)));
        }

        /// The results for each of some ranges, in order, with a state that ranges of one thread share.
        pub(in crate::base) fn in_ranges<S: Default, T: Send>(
            &self,
            ranges: Vec<Range<usize>>,
            of: impl Fn(&mut S, Range<usize>) -> T + Sync + Send,
        ) -> Vec<T> {
            if self.disorder.is_some() {
                return self.each(ranges, |range| of(&mut S::default(), range));
            }
            self.threads.install(|| ranges.into_par_iter().map_init(S::default, of).collect())
        }

        pub(in crate::base) fn each<T: Send, U: Send>(
            &self,
            items: Vec<T>,
            of: impl Fn(T) -> U + Sync + Send,
        ) -> Vec<U> {
            let Some(disorder) = &self.disorder else {
                return self.threads.install(|| items.into_par_iter().map(of).collect());
            };
            let tasks = disorder.shuffled(items);
            let task = |(number, item)| (number, of(item));
            let mut results: Vec<(usize, U)> =
                self.threads.install(|| tasks.into_par_iter().map(task).collect());
            results.sort_by_key(|(number, _)| *number);
            results.into_iter().map(|(_, result)| result).collect()
        }

        pub(in crate::base) fn any<T: Send>(
            &self,
            items: Vec<T>,
            is_such: impl Fn(T) -> bool + Sync + Send,
        ) -> bool {
            self.threads.install(|| items.into_par_iter().any(is_such))
        }

        pub(in crate::base) fn join<A: Send, B: Send>(
            &self,
            first: impl FnOnce() -> A + Send,
            second: impl FnOnce() -> B + Send,
        ) -> (A, B) {
            self.threads.join(first, second)
        }

        /// The parts of up to `length` items of a list, each with its number, in the order in which they are
        /// to be begun.
        pub(in crate::base) fn parts<'a, T>(
            &self,
            list: &'a mut [T],
            length: usize,
        ) -> Box<dyn Iterator<Item = (usize, &'a mut [T])> + Send + 'a>
        where
            T: Send,
        {
            match &self.disorder {
                None => Box::new(list.chunks_mut(length).enumerate()),
                Some(disorder) => Box::new(disorder.shuffled(list.chunks_mut(length).collect()).into_iter()),
            }
        }

        /// Runs `work` once on the calling thread, and at the same time on all threads but one of the pool.
        pub(in crate::base) fn on_all(&self, work: impl Fn() + Sync) {
            let work = &work;
            self.threads.in_place_scope(|scope| {
                (1..self.count()).for_each(|_| scope.spawn(|_| work()));
                work();
            });
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

        pub(in crate::base) fn parts<'a, T>(
            &self,
            _: &'a mut [T],
            _: usize,
        ) -> std::iter::Empty<(usize, &'a mut [T])> {
            match *self {}
        }

        pub(in crate::base) fn on_all(&self, _: impl Fn()) {
            match *self {}
        }
    }
}
