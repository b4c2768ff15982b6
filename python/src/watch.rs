//! Long calls: the work runs on a thread of its own, while the calling thread listens for Ctrl-C and reports
//! progress.

use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use motet::base::{Progress, Threads, Watch};
use pyo3::prelude::*;

use crate::error::{OrRaise, internal_error};
use crate::words::threads;

/// How often it checks.
const EVERY: Duration = Duration::from_millis(50);

/// Runs `work` with `n_threads` watched threads and returns its result. Meanwhile other threads of Python
/// continue, and `progress` is called with the stage, the amount done and the total amount. An exception from
/// `progress` or from a signal handler ends the work and is raised.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    n_threads: usize,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Threads) -> motet::Result<T> + Send,
) -> PyResult<T> {
    let watch = Watch::new();
    run_watched(py, &watch, threads(n_threads)?.watched(&watch), progress, |threads| work(threads)).1
}

/// Runs `work` with the given threads, watched through `watch`, and returns them with its result.
pub(crate) fn run_watched<T: Send>(
    py: Python<'_>,
    watch: &Watch,
    threads: Threads,
    progress: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(&Threads) -> motet::Result<T> + Send,
) -> (Threads, PyResult<T>) {
    let progress = progress.map(|progress| progress.clone().unbind());
    py.detach(|| {
        thread::scope(|scope| {
            let (done, is_done) = channel::<()>();
            let worker = scope.spawn(move || {
                let _done = done;
                let outcome = work(&threads);
                (threads, outcome)
            });
            let (mut raised, mut last) = (None, Progress::default());
            while is_done.recv_timeout(EVERY) == Err(RecvTimeoutError::Timeout) {
                if raised.is_none() {
                    raised = Python::attach(|py| listen(py, progress.as_ref(), watch, &mut last)).err();
                    raised.iter().for_each(|_| watch.stop());
                }
            }
            let (threads, outcome) = match worker.join() {
                Ok((threads, outcome)) => (threads, outcome.or_raise()),
                Err(panic) => (Threads::single(), Err(internal_error(&*panic))),
            };
            (threads, raised.map_or(outcome, Err))
        })
    })
}

/// Handles signals, and reports the progress if it has changed.
fn listen(py: Python<'_>, progress: Option<&Py<PyAny>>, watch: &Watch, last: &mut Progress) -> PyResult<()> {
    py.check_signals()?;
    let now = watch.progress();
    if let Some(progress) = progress.filter(|_| now != *last) {
        *last = now;
        progress.call1(py, (now.stage, now.done, now.of))?;
    }
    Ok(())
}
