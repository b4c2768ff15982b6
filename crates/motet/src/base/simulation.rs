//! Several threads simulated on one: what a machine with more cores could gain, from the seconds of each
//! task.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// A clock that runs as if tasks were done by several threads, while one thread does them one after another.
///
/// The tasks of a call are taken in order, each by the thread that is free first (list scheduling: Graham
/// 1969), and the call ends with the last of them; whatever is not done in tasks takes its time. Tasks of a
/// call within a task find all threads free. Neither the waking of threads counts, nor that cores share
/// caches and memory. Clones share one clock.
///
/// ```
/// use motet::base::{Simulation, Threads};
/// let simulation = Simulation::new(16);
/// let squares = Threads::simulated(&simulation).map(100_000, |i| i * i);
/// assert_eq!(squares[300], 90_000);
/// assert!(simulation.saved() < std::time::Duration::from_secs(60));
/// ```
#[derive(Clone, Debug)]
pub struct Simulation(Arc<Clock>);

#[derive(Debug)]
struct Clock {
    n_threads: usize,
    origin: Instant,
    /// Nanoseconds by which the simulated clock is behind the real one.
    saved: AtomicU64,
}

/// The largest number of simulated threads.
const MOST: usize = 4096;

impl Simulation {
    /// A clock for `n_threads` threads, but at least one and at most 4096.
    pub fn new(n_threads: usize) -> Self {
        Self(Arc::new(Clock {
            n_threads: n_threads.clamp(1, MOST),
            origin: Instant::now(),
            saved: AtomicU64::new(0),
        }))
    }

    /// The number of simulated threads.
    pub fn count(&self) -> usize {
        self.0.n_threads
    }

    /// How much less time the threads would have taken than the one that did their work.
    pub fn saved(&self) -> Duration {
        Duration::from_nanos(self.0.saved.load(Ordering::Relaxed))
    }

    fn now(&self) -> Duration {
        self.0.origin.elapsed().saturating_sub(self.saved())
    }

    /// Begins a call whose tasks may be done at the same time.
    pub(in crate::base) fn call(&self) -> Tasks<'_> {
        Tasks { simulation: self, begin: self.now(), busy: vec![Duration::ZERO; self.count()] }
    }
}

/// The tasks of a call; when dropped, the simulated clock shows the end of the last of them.
pub(in crate::base) struct Tasks<'a> {
    simulation: &'a Simulation,
    begin: Duration,
    /// For each thread, how long it has been busy.
    busy: Vec<Duration>,
}

impl Tasks<'_> {
    /// Does a task.
    pub(in crate::base) fn take<R>(&mut self, task: impl FnOnce() -> R) -> R {
        let begin = self.simulation.now();
        let result = task();
        let took = self.simulation.now().saturating_sub(begin);
        if let Some(least) = self.busy.iter_mut().min() {
            *least += took;
        }
        result
    }
}

impl Drop for Tasks<'_> {
    fn drop(&mut self) {
        let end = self.begin + self.busy.iter().max().copied().unwrap_or_default();
        let ahead = self.simulation.now().saturating_sub(end);
        let nanoseconds = u64::try_from(ahead.as_nanos()).unwrap_or(u64::MAX);
        self.simulation.0.saved.fetch_add(nanoseconds, Ordering::Relaxed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn busy(milliseconds: u64) {
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_millis(milliseconds) {
            std::hint::spin_loop();
        }
    }

    #[test]
    fn each_task_goes_to_the_thread_that_is_free_first() {
        let simulation = Simulation::new(2);
        {
            let mut tasks = simulation.call();
            [30, 10, 10].into_iter().for_each(|some| tasks.take(|| busy(some)));
        }
        // 30 beside 10 and 10: 20 of 50 are saved, no matter how long the machine held up a task.
        assert!(simulation.saved() >= Duration::from_millis(20));
        assert!(simulation.now() >= Duration::from_millis(30));
    }

    #[test]
    fn tasks_within_a_task_save_time_too() {
        let simulation = Simulation::new(2);
        {
            let mut outer = simulation.call();
            outer.take(|| {
                let mut inner = simulation.call();
                inner.take(|| busy(10));
                inner.take(|| busy(10));
            });
            outer.take(|| busy(10));
        }
        assert!(simulation.saved() >= Duration::from_millis(20));
        assert!(simulation.now() >= Duration::from_millis(10));
    }

    #[test]
    fn one_thread_saves_nothing_but_what_lies_between_tasks() {
        let simulation = Simulation::new(0);
        {
            let mut tasks = simulation.call();
            tasks.take(|| busy(5));
            tasks.take(|| busy(5));
        }
        assert_eq!(simulation.count(), 1);
        assert_eq!(Simulation::new(usize::MAX).count(), MOST);
        assert!(simulation.now() >= Duration::from_millis(10));
    }
}
