//! Long calls: their progress is told on the thread of the caller, and they are stopped on request.

use std::ffi::{c_char, c_void};
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use motet::base::{Progress, Threads, Watch};
use motet::{Error, ErrorKind, Result};

use crate::guard::{MotetError, guarded, or_default, text};
use crate::memory::{free, handle, out_handle, set_handle};

/// How often progress is told unless the program states it.
const EVERY: Duration = Duration::from_millis(50);

/// A watch as the program holds it. Handles made with it share its channel.
pub(crate) struct MotetWatch(Arc<Channel>);

/// What a watch and the calls that it watches share.
#[derive(Default)]
struct Channel {
    watch: Watch,
    /// Whether a call is being watched.
    is_taken: AtomicBool,
    listener: Mutex<Option<Listener>>,
}

/// See `motet_progress` in the header.
type Tell = unsafe extern "C" fn(*mut c_void, *const c_char, i64, i64) -> i32;

/// A function of the program that is told the progress.
#[derive(Clone, Copy)]
struct Listener {
    tell: Tell,
    data: *mut c_void,
    every: Duration,
}

// SAFETY: `data` is only passed on to `tell`, on the thread that made the call, as the header says.
unsafe impl Send for Listener {}

impl Listener {
    /// Tells the progress; returns whether the call is to be stopped.
    fn wants_stop(&self, progress: Progress) -> bool {
        let stage = text(progress.stage);
        // SAFETY: the header requires a function that may be called like this.
        unsafe { (self.tell)(self.data, stage.as_ptr(), progress.done as i64, progress.of as i64) != 0 }
    }

    /// Does the work on another thread and tells the progress meanwhile. Returns whether a stop was requested
    /// here, too.
    fn during<T: Send>(&self, watch: &Watch, work: impl FnOnce() -> T + Send) -> Result<(T, bool)> {
        thread::scope(|scope| {
            let (done, is_done) = channel::<()>();
            let worker = thread::Builder::new().spawn_scoped(scope, move || {
                let _done = done;
                work()
            });
            let worker = worker.map_err(|cause| {
                Error::options(format!("the thread of a watched call could not be started: {cause}"))
            })?;
            let mut is_stopped = false;
            while is_done.recv_timeout(self.every) == Err(RecvTimeoutError::Timeout) {
                if !is_stopped && self.wants_stop(watch.progress()) {
                    is_stopped = true;
                    watch.stop();
                }
            }
            let outcome = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            Ok((outcome, is_stopped))
        })
    }
}

impl Channel {
    fn listener(&self) -> std::sync::MutexGuard<'_, Option<Listener>> {
        self.listener.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A channel that watches one call until this is dropped.
struct Taken<'a>(&'a Channel);

impl<'a> Taken<'a> {
    fn new(channel: &'a Channel) -> Result<Self> {
        match channel.is_taken.swap(true, Ordering::Acquire) {
            false => Ok(Self(channel)),
            true => Err(Error::options("the watch already watches a call")
                .remedy("give each call that runs at the same time a watch of its own")),
        }
    }
}

impl Drop for Taken<'_> {
    fn drop(&mut self) {
        self.0.is_taken.store(false, Ordering::Release);
    }
}

/// Who watches the calls of a handle, or one call; nobody by default.
#[derive(Clone, Default)]
pub(crate) struct Watched(Option<Arc<Channel>>);

impl Watched {
    /// The watch of options; NULL for nobody.
    pub(crate) fn by(watch: *const MotetWatch) -> Self {
        Self(handle(watch, "watched_by").ok().map(|watch| Arc::clone(&watch.0)))
    }

    /// Makes a call with these threads: it reports to the watch, and a stop ends it.
    pub(crate) fn call<T: Send>(
        &self,
        threads: &mut Threads,
        work: impl FnOnce(&Threads) -> Result<T> + Send,
    ) -> Result<T> {
        let Some(channel) = &self.0 else { return work(threads) };
        let taken = Taken::new(channel)?;
        let watch = &taken.0.watch;
        watch.report("", 0, 0);
        let watched = std::mem::take(threads).watched(watch);
        let listener = *taken.0.listener();
        let ended = match listener {
            None => Ok((work(&watched), false)),
            Some(listener) => listener.during(watch, || work(&watched)),
        };
        *threads = watched.watched(&Watch::default());
        let (outcome, is_stopped) = ended?;
        // A request to stop is used up by the call that it stops.
        if is_stopped || outcome.as_ref().is_err_and(|error| error.kind() == ErrorKind::Stopped) {
            watch.resume();
        }
        outcome
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_watch_new(
    watch: *mut *mut MotetWatch,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let channel = Channel { watch: Watch::new(), ..Channel::default() };
        set_handle(out_handle(watch, "watch")?, MotetWatch(Arc::new(channel)));
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_watch_free(watch: *mut MotetWatch) {
    // Handles may still have the channel: nobody is told anything any longer, and nothing is stopped.
    or_default((), || {
        let MotetWatch(channel) = handle(watch, "watch").ok()?;
        *channel.listener() = None;
        channel.watch.resume();
        Some(())
    });
    free(watch);
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_watch_on_progress(
    watch: *mut MotetWatch,
    tell: Option<Tell>,
    data: *mut c_void,
    every: f64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let MotetWatch(channel) = handle(watch, "watch")?;
        let every = match Duration::try_from_secs_f64(every) {
            Ok(Duration::ZERO) => EVERY,
            Ok(every) => every,
            Err(_) => {
                return Err(Error::options(format!("progress every {every} seconds, expected 0 or more")));
            }
        };
        *channel.listener() = tell.map(|tell| Listener { tell, data, every });
        Ok(())
    })
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_watch_stop(watch: *const MotetWatch) {
    if let Ok(MotetWatch(channel)) = handle(watch, "watch") {
        channel.watch.stop();
    }
}

#[unsafe(no_mangle)]
pub(crate) unsafe extern "C" fn motet_watch_progress(
    watch: *const MotetWatch,
    stage: *mut c_char,
    n: i64,
    done: *mut i64,
    of: *mut i64,
    error: *mut *mut MotetError,
) -> i32 {
    guarded(error, || {
        let progress = handle(watch, "watch")?.0.watch.progress();
        let bytes = progress.stage.as_bytes();
        let space =
            crate::memory::values_mut(stage.cast::<u8>(), crate::memory::count(n, "bytes")?, "stage")?;
        if let Some(last) = space.len().checked_sub(1) {
            let k = bytes.len().min(last);
            space[..k].copy_from_slice(&bytes[..k]);
            space[k] = 0;
        }
        for (place, number) in [(done, progress.done), (of, progress.of)] {
            // SAFETY: the header requires NULL or a place for a number.
            if let Some(place) = unsafe { place.as_mut() } {
                *place = number as i64;
            }
        }
        Ok(())
    })
}
