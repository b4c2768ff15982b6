//! Limits the memory for the decompressed content of a file.
//!
//! Data may decompress to a thousand times their size, so a file of a few megabytes could exhaust the memory.
//! The size is known before decompression, and no mesh compresses that well: content beyond the limit is
//! rejected.

use std::collections::HashSet;
use std::sync::{Mutex, PoisonError};

use crate::base::{Error, Result};

/// The environment variable that overrides the limit, in bytes or with a unit: `MOTET_READ_LIMIT=16G`.
const VARIABLE: &str = "MOTET_READ_LIMIT";
/// Bytes allowed for any file, since constant values compress well.
const BASE_LIMIT: u64 = 256 << 20;
/// Further bytes allowed per byte of the file.
const LIMIT_PER_BYTE: u64 = 64;

/// The memory budget for reading a mesh.
#[derive(Debug)]
pub(super) struct MemoryBudget {
    state: Mutex<State>,
    requested: Option<u64>,
}

#[derive(Debug, Default)]
struct State {
    file_bytes: u64,
    taken: u64,
    known: HashSet<String>,
}

impl MemoryBudget {
    /// The budget for a file of this size.
    pub(super) fn of(file_bytes: u64) -> Self {
        let requested = std::env::var(VARIABLE).ok().and_then(|text| bytes(&text));
        Self { state: Mutex::new(State { file_bytes, ..State::default() }), requested }
    }

    /// Extends the budget by another file of the same mesh; each name counts only once.
    pub(super) fn add_file(&self, name: &str, file_bytes: u64) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        if state.known.insert(name.to_owned()) {
            state.file_bytes = state.file_bytes.saturating_add(file_bytes);
        }
    }

    /// Reserves bytes before they are allocated.
    ///
    /// Fails if the total exceeds the limit.
    pub(super) fn take(&self, bytes: u64) -> Result<()> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        state.taken = state.taken.saturating_add(bytes);
        let limit = self.limit(&state);
        if state.taken <= limit { Ok(()) } else { Err(refused(state.taken, &state, limit)) }
    }

    /// Reserves bytes like [`take`](Self::take), but only once for each name.
    ///
    /// Fails if the total exceeds the limit.
    pub(super) fn take_once(&self, name: &str, bytes: u64) -> Result<()> {
        let is_new = self.state.lock().unwrap_or_else(PoisonError::into_inner).known.insert(name.to_owned());
        if is_new { self.take(bytes) } else { Ok(()) }
    }

    /// Number of bytes left.
    pub(super) fn remaining(&self) -> u64 {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        self.limit(&state).saturating_sub(state.taken)
    }

    /// The error for a stream that exceeds the budget.
    pub(super) fn exceeded(&self) -> Error {
        let state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let limit = self.limit(&state);
        refused(limit.saturating_add(1), &state, limit)
    }

    fn limit(&self, state: &State) -> u64 {
        self.requested
            .unwrap_or_else(|| BASE_LIMIT.saturating_add(state.file_bytes.saturating_mul(LIMIT_PER_BYTE)))
    }
}

fn refused(needed: u64, state: &State, limit: u64) -> Error {
    Error::input(format!(
        "decompresses to {needed} bytes or more; the limit for a file of {} bytes is {limit}",
        state.file_bytes
    ))
    .remedy(format!(
        "if the file is valid, raise the limit with the environment variable {VARIABLE}, such as {VARIABLE}=16G"
    ))
}

/// Parses a number of bytes with an optional unit `K`, `M`, `G` or `T`, each 1024 times the previous one.
fn bytes(text: &str) -> Option<u64> {
    let text = text.trim().to_ascii_uppercase();
    let text = text.trim_end_matches('B').trim_end_matches('I');
    let unit = text.chars().last().and_then(|unit| "KMGT".find(unit));
    let (number, shift) = unit.map_or((text, 0), |i| (&text[..text.len() - 1], 10 * (i + 1)));
    number.trim().parse::<u64>().ok()?.checked_mul(1 << shift)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reservation_counts_and_each_name_once() {
        let budget = MemoryBudget { state: Mutex::default(), requested: Some(100) };
        budget.take(60).unwrap();
        budget.take_once("a", 40).unwrap();
        budget.take_once("a", 40).unwrap();
        assert_eq!(budget.remaining(), 0);
        let message = budget.take(1).unwrap_err().to_string();
        assert!(
            message.contains("decompresses to 101 bytes") && message.contains("MOTET_READ_LIMIT=16G"),
            "{message}"
        );
    }

    #[test]
    fn the_limit_grows_with_the_files() {
        let budget = MemoryBudget { state: Mutex::default(), requested: None };
        let before = budget.remaining();
        budget.add_file("b", 1000);
        budget.add_file("b", 1000);
        assert_eq!(budget.remaining(), before + 1000 * LIMIT_PER_BYTE);
    }

    #[test]
    fn units_are_powers_of_1024() {
        assert_eq!(
            ["7", "2K", "3 mb", "1GiB", "x", "-1", ""].map(bytes),
            [Some(7), Some(2048), Some(3 << 20), Some(1 << 30), None, None, None]
        );
    }
}
