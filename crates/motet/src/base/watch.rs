//! The progress of a call, for another thread to read; and a way to stop the call.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::base::{Error, ErrorKind, Result};

/// The progress of a call.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// What is being done; empty at first.
    pub stage: &'static str,
    /// How much of it is done.
    pub done: usize,
    /// How much there is to do, as far as is known by now; 0 where it is unknown. A stage may occur more than
    /// once.
    pub of: usize,
}

/// A channel between a call and whoever started it: the call reports its progress and checks from time to
/// time whether to stop; the other side reads the progress and may stop the call. Clones share one channel.
/// The default watch is connected to nobody and costs nothing.
///
/// ```
/// use motet::base::{Threads, Watch};
/// use motet::mesh::{history::Rules, shapes};
/// let watch = Watch::new();
/// let threads = Threads::single().watched(&watch);
/// watch.stop(); // from another thread, as a rule
/// let mesh = shapes::sphere_in_box(6, 4);
/// let ended = motet::remesh::remesh_mesh(&mesh, &Default::default(), &Rules::default(), &threads);
/// assert_eq!(ended.unwrap_err().kind(), motet::ErrorKind::Stopped);
/// watch.resume();
/// assert!(motet::remesh::remesh_mesh(&mesh, &Default::default(), &Rules::default(), &threads).is_ok());
/// ```
#[derive(Clone, Debug, Default)]
pub struct Watch(Option<Arc<Channel>>);

#[derive(Debug, Default)]
struct Channel {
    progress: Mutex<Progress>,
    is_stopped: AtomicBool,
}

impl Watch {
    /// A watch that records progress and can stop a call.
    pub fn new() -> Self {
        Self(Some(Arc::default()))
    }

    /// Stops the running call soon: it fails with [`ErrorKind::Stopped`] and leaves its input unchanged,
    /// unless the call is documented otherwise.
    pub fn stop(&self) {
        if let Some(channel) = &self.0 {
            channel.is_stopped.store(true, Ordering::Relaxed);
        }
    }

    /// Withdraws a request to stop, so that later calls with this watch run.
    pub fn resume(&self) {
        if let Some(channel) = &self.0 {
            channel.is_stopped.store(false, Ordering::Relaxed);
        }
    }

    /// The progress last reported.
    pub fn progress(&self) -> Progress {
        self.0.as_ref().map_or_else(Progress::default, |channel| {
            *channel.progress.lock().unwrap_or_else(PoisonError::into_inner)
        })
    }

    /// Reports progress; see [`Progress`]. It takes some 20 ns where somebody watches. Programs that call the
    /// library report their own work, such as reading files, in the same way.
    pub fn report(&self, stage: &'static str, done: usize, of: usize) {
        if let Some(channel) = &self.0 {
            *channel.progress.lock().unwrap_or_else(PoisonError::into_inner) = Progress { stage, done, of };
        }
    }

    /// Reports progress, and fails where a stop was requested.
    pub(crate) fn report_and_check(&self, stage: &'static str, done: usize, of: usize) -> Result<()> {
        self.report(stage, done, of);
        if self.0.as_ref().is_some_and(|channel| channel.is_stopped.load(Ordering::Relaxed)) {
            return Err(Error::new(ErrorKind::Stopped, format!("stopped on request while {stage}")));
        }
        Ok(())
    }
}
