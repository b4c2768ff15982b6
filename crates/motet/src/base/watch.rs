//! How far a call has come, for another thread to see; and the word of that thread that it is to end.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use crate::base::{Error, ErrorKind, Result};

/// How far a call has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Progress {
    /// What is being done; empty before anything is.
    pub stage: &'static str,
    /// How much of it is done.
    pub done: usize,
    /// How much there is to do, as far as that is known by now; 0 where it is not. Stages may come again.
    pub of: usize,
}

/// Two ends of one line: the work says now and then how far it is and asks whether it is to go on, whoever started it looks and may end it. Clones
/// are the same line. The default one has nobody at its other end, and costs nothing.
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
/// ```
#[derive(Clone, Debug, Default)]
pub struct Watch(Option<Arc<Line>>);

#[derive(Debug, Default)]
struct Line {
    progress: Mutex<Progress>,
    is_stopped: AtomicBool,
}

impl Watch {
    /// A line to look at.
    pub fn new() -> Self {
        Self(Some(Arc::default()))
    }

    /// Ends what is being done, soon: it fails with [`ErrorKind::Stopped`], and leaves what it was given as it was, where the call does not say otherwise.
    pub fn stop(&self) {
        if let Some(line) = &self.0 {
            line.is_stopped.store(true, Ordering::Relaxed);
        }
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        self.0.as_ref().map_or_else(Progress::default, |line| {
            *line.progress.lock().unwrap_or_else(PoisonError::into_inner)
        })
    }

    /// Says how far the work is; see [`Progress`]. It takes some 20 ns where somebody looks. Who calls the library says so of what it does itself, such as reading files.
    pub fn tell(&self, stage: &'static str, done: usize, of: usize) {
        if let Some(line) = &self.0 {
            *line.progress.lock().unwrap_or_else(PoisonError::into_inner) = Progress { stage, done, of };
        }
    }

    /// Says how far the work is, and fails where it is to end.
    pub(crate) fn go_on(&self, stage: &'static str, done: usize, of: usize) -> Result<()> {
        self.tell(stage, done, of);
        if self.0.as_ref().is_some_and(|line| line.is_stopped.load(Ordering::Relaxed)) {
            return Err(Error::new(ErrorKind::Stopped, format!("stopped while {stage}, on request")));
        }
        Ok(())
    }
}
