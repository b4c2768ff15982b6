//! How many threads a call may use: always the caller's choice, never a global pool; and who watches it.

use std::ops::Range;

use rayon::prelude::*;

use crate::base::{Error, Result, Watch};

/// What a thread takes at least in one go: less is done sooner than shared out.
const SMALLEST_PART: usize = 4096;

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

    /// `n` threads, but no more than the machine offers cores; 0 means one for each.
    ///
    /// # Errors
    /// When the operating system will not start them.
    pub fn new(n: usize) -> Result<Self> {
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let n = if n == 0 { cores } else { n.min(cores) };
        if n == 1 {
            return Ok(Self::single());
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n).build();
        pool.map(|pool| Self { pool: Some(pool), ..Self::default() }).map_err(|e| {
            Error::options(format!("{n} threads could not be started: {e}")).remedy("ask for fewer")
        })
    }

    /// The same, watched: what runs on them says how far it is, and ends when the other side asks for it.
    #[must_use]
    pub fn watched(self, watch: &Watch) -> Self {
        Self { watch: watch.clone(), ..self }
    }

    /// Who watches.
    pub fn watch(&self) -> &Watch {
        &self.watch
    }

    /// How many threads work.
    pub fn count(&self) -> usize {
        self.pool.as_ref().map_or(1, rayon::ThreadPool::current_num_threads)
    }

    /// `of` each number below `n`, in their order.
    pub fn map<T: Send>(&self, n: usize, of: impl Fn(usize) -> T + Sync + Send) -> Vec<T> {
        match &self.pool {
            None => (0..n).map(of).collect(),
            Some(pool) => {
                pool.install(|| (0..n).into_par_iter().with_min_len(SMALLEST_PART).map(of).collect())
            }
        }
    }

    /// What `of` says of each run of so many of the numbers below `n`, joined in their order. It works on a state that is kept for the next run.
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

    /// `of` each of a few things that take long, in their order.
    pub fn each<T: Send, U: Send>(&self, things: Vec<T>, of: impl Fn(T) -> U + Sync + Send) -> Vec<U> {
        match &self.pool {
            None => things.into_iter().map(of).collect(),
            Some(pool) => pool.install(|| things.into_par_iter().map(of).collect()),
        }
    }

    /// The pool, where there is more than one thread. `None`: use a plain loop,
    /// since a parallel iterator outside a pool would start the global one.
    pub fn pool(&self) -> Option<&rayon::ThreadPool> {
        self.pool.as_ref()
    }
}
