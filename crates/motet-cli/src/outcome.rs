//! What a verb reached, and how long it took.

use serde::Serialize;

/// The seconds that a verb took: for reading, for writing, and in total.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Seconds {
    pub(crate) read: f64,
    pub(crate) write: f64,
    pub(crate) total: f64,
}

/// The outcome of a verb that did not fail.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// Everything that was requested.
    Done,
    /// Less than was requested, with the reason; what was reached is written and reported.
    NotReached(String),
}

impl Outcome {
    /// The outcome for the reason why the requested result was not reached; `None` means that it was.
    pub(crate) fn of(not_reached: Option<String>) -> Self {
        not_reached.map_or(Self::Done, Self::NotReached)
    }

    /// Why the requested result was not reached.
    pub(crate) fn not_reached(&self) -> Option<&str> {
        match self {
            Self::Done => None,
            Self::NotReached(why) => Some(why),
        }
    }
}
