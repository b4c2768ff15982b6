//! Order of recovery: a part that could not be made is made first the next time, or last. What blocks it may
//! exist only because it was made earlier, or may not exist yet.

use crate::base::{Error, Threads, VertexId, Watch};

/// An edge or a triangle of the surface that could not be made, and why.
#[derive(Debug)]
pub(super) struct Unrecovered {
    /// The part; `None` where the work was merely stopped by the watch or by another error.
    pub(super) what: Option<Part>,
    pub(super) error: Error,
}

impl From<Error> for Unrecovered {
    fn from(error: Error) -> Self {
        Self { what: None, error }
    }
}

/// A part of the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    /// An edge by its ends, smaller one first.
    Edge([VertexId; 2]),
    /// A triangle by its number.
    Triangle(u32),
}

/// Parts that are made out of turn, and the threads.
#[derive(Debug)]
pub(super) struct Order<'a> {
    /// Parts made before all others, latest failure first.
    first: Vec<Part>,
    /// Parts made after all others.
    last: Vec<Part>,
    pub(super) threads: &'a Threads,
}

impl<'a> Order<'a> {
    /// Repeats `work`, moving each part that could not be made to the front of the line, then to its end,
    /// until all are made. Gives up after `max_retries` repetitions, or when a part could be made neither
    /// first nor last.
    ///
    /// # Errors
    /// The last failure.
    pub(super) fn with_retries<T>(
        max_retries: usize,
        threads: &'a Threads,
        mut work: impl FnMut(&Self) -> Result<T, Unrecovered>,
    ) -> Result<T, Unrecovered> {
        let mut order = Self { first: Vec::new(), last: Vec::new(), threads };
        let mut n_retries = 0;
        loop {
            let unrecovered = match work(&order) {
                Ok(done) => return Ok(done),
                Err(unrecovered) => unrecovered,
            };
            let is_hopeless = |what: &Part| n_retries == max_retries || order.last.contains(what);
            let Some(what) = unrecovered.what.filter(|what| !is_hopeless(what)) else {
                return Err(unrecovered);
            };
            let was_first = order.first.first() == Some(&what);
            order.first.retain(|part| *part != what);
            if was_first {
                order.last.push(what);
            } else {
                order.first.insert(0, what);
            }
            n_retries += 1;
        }
    }

    /// The watch on the work.
    pub(super) fn watch(&self) -> &Watch {
        self.threads.watch()
    }

    /// The position of a part in line; all parts without a special place share one.
    pub(super) fn rank(&self, is_it: impl Fn(Part) -> bool) -> usize {
        let place = |list: &[Part]| list.iter().position(|&part| is_it(part));
        let n = self.first.len();
        place(&self.first).or_else(|| place(&self.last).map(|i| n + 1 + i)).unwrap_or(n)
    }
}
