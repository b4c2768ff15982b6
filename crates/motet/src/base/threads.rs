//! How many threads a call may use, always the caller's choice and never a global pool; and the watch on the
//! call.

use std::ops::Range;

use rayon::prelude::*;

use crate::base::{Error, Result, Watch};

/// The least number of items per thread: fewer are done sooner than they are distributed.
const MIN_PART: usize = 4096;

/// A pool of threads that belongs to the caller. Results do not depend on its size.
#[derive(Debug, Default)]
pub struct Threads {
    pool: Option<rayon::ThreadPool>,
    watch: Watch,
}

impl Threads {
    /// Everything runs on the calling thread.
    pub fn single() -> Self {
        Self::default()
    }

    /// A pool of `n` threads, but no more than the machine has cores; 0 means one per core.
    ///
    /// # Errors
    /// When the operating system cannot start them.
    pub fn new(n: usize) -> Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let n = if n == 0 { cores } else { n.min(cores) };
        if n == 1 {
            return Ok(Self::single());
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
        pool.map(|pool| Self { pool: Some(pool), ..Self::default() }).map_err(|e| {
            Error::options(format!("{n} threads could not be started: {e}")).remedy("request fewer threads")
        })
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
        self.pool.as_ref().map_or(1, rayon::ThreadPool::current_num_threads)
    }

    /// `of(i)` for each `i` below `n`, in order.
    pub fn map<T: Send>(&self, n: usize, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        match &self.pool {
            None => (0..n).map(of).collect(),
            Some(pool) => pool.install(|| (0..n).into_par_iter().with_min_len(MIN_PART).map(of).collect()),
        }
    }

    /// Applies `of` to runs of up to `length` of the numbers below `n` and joins the results in order. One
    /// thread takes all numbers as a single run. `of` also gets a state, which is reused from run to run.
    pub fn in_runs<S: Default, T: Send>(
        &self,
        n: usize,
        length: usize,
        of: impl Fn(&mut S, Range<usize>) -> Vec<T> + Sync + Send,
    ) -> Vec<T> {
        match &self.pool {
            None => of(&mut S::default(), 0..n),
            Some(pool) => pool.install(|| {
                let runs =
                    (0..n.div_ceil(length)).into_par_iter().map(|k| k * length..n.min((k + 1) * length));
                let parts: Vec<Vec<T>> = runs.map_init(S::default, of).collect();
                parts.into_iter().flatten().collect()
            }),
        }
    }

    /// Applies `of` to each of a few expensive things; the results are in order.
    pub fn each<T: Send, U: Send>(&self, things: Vec<T>, of: impl Fn(T) -> U + Sync + Send) -> Vec<U> {
        match &self.pool {
            None => things.into_iter().map(of).collect(),
            Some(pool) => pool.install(|| things.into_par_iter().map(of).collect()),
        }
    }

    /// The pool, where there is more than one thread. Where it is `None`, use a plain loop, since a parallel
    /// iterator outside a pool would start the global one.
    pub fn pool(&self) -> Option<&rayon::ThreadPool> {
        self.pool.as_ref()
    }
}
